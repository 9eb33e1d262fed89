//! Deviations of points matched by (face, u, v).

use glam::DVec2;

use super::deviation::{Deviation, Place, Summary, Tally};
use super::soup::{Soup, SurfacePoint, Triangle};
use super::threads::map_on_all_cores;

/// What points matched by (face, u, v) say of A.
pub struct Parametric {
    pub summary: Summary,
    /// For each corner of A's triangles, in their order; none in faces that B lacks.
    pub deviations: Vec<Option<[Deviation; 3]>>,
    /// Ptex faces of both, of A alone, of B alone.
    pub faces: [usize; 3],
}

/// Compares every vertex of A with B's value at its (face, u, v). Each counts with a third of the area of its triangle.
pub fn compare(a: &Soup, b: &Soup) -> Parametric {
    let mut of_b = b.faces().peekable();
    let pairs: Vec<(&[Triangle], &[Triangle])> = a
        .faces()
        .map(|face| {
            while of_b.next_if(|other| other[0].face < face[0].face).is_some() {}
            (face, of_b.next_if(|other| other[0].face == face[0].face).unwrap_or_default())
        })
        .collect();
    let deviations = map_on_all_cores(&pairs, |&(face, other)| face_deviations(face, other)).concat();
    let mut tally = Tally::default();
    for (triangle, deviations) in a.triangles.iter().zip(&deviations) {
        let weight = triangle.area() / 3.0;
        for (corner, &deviation) in triangle.corners.iter().zip(deviations.iter().flatten()) {
            tally.add(weight, deviation, Place::new(triangle.face, corner.uv.as_dvec2()));
        }
    }
    let common = pairs.iter().filter(|(_, other)| !other.is_empty()).count();
    let faces = [common, pairs.len() - common, b.faces().count() - common];
    Parametric { summary: tally.summary(), deviations, faces }
}

fn face_deviations(face: &[Triangle], other: &[Triangle]) -> Vec<Option<[Deviation; 3]>> {
    let grid = Grid::new(other);
    let deviation = |triangle: &Triangle, weights| {
        let point = triangle.at(weights);
        Some(Deviation::between(&point, &grid.at(point.uv)?))
    };
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let deviations = |triangle| {
        let [a, b, c] = corners.map(|weights| deviation(triangle, weights));
        Some([a?, b?, c?])
    };
    face.iter().map(deviations).collect()
}

/// The triangles of a Ptex face by where they lie in its unit square.
struct Grid<'a> {
    triangles: &'a [Triangle],
    /// Cells along a side.
    side: usize,
    /// Row by row, the triangles that touch a cell.
    cells: Vec<Vec<u32>>,
}

impl<'a> Grid<'a> {
    fn new(triangles: &'a [Triangle]) -> Self {
        // As many cells as there are quads of two triangles.
        let side = ((triangles.len() as f64 / 2.0).sqrt().ceil() as usize).max(1);
        let mut grid = Self { triangles, side, cells: vec![Vec::new(); side * side] };
        for (index, triangle) in (0..).zip(triangles) {
            let [a, b, c] = triangle.uvs();
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            for row in grid.cell(low.y)..=grid.cell(high.y) {
                for column in grid.cell(low.x)..=grid.cell(high.x) {
                    grid.cells[row * side + column].push(index);
                }
            }
        }
        grid
    }

    fn cell(&self, parameter: f64) -> usize {
        ((parameter * self.side as f64) as usize).min(self.side - 1)
    }

    /// The surface's value at a place: in the triangle that contains it, or comes nearest to that where roundings leave
    /// a gap. None where there are no triangles.
    fn at(&self, uv: DVec2) -> Option<SurfacePoint> {
        let cell = &self.cells[self.cell(uv.y) * self.side + self.cell(uv.x)];
        let in_cell = cell.iter().map(|&index| &self.triangles[index as usize]);
        let found = innermost(in_cell, uv).or_else(|| innermost(self.triangles.iter(), uv));
        found.map(|(triangle, weights)| triangle.at(weights))
    }
}

/// The triangle in which the least of the place's weights is greatest, and the weights.
fn innermost<'a>(triangles: impl Iterator<Item = &'a Triangle>, uv: DVec2) -> Option<(&'a Triangle, [f64; 3])> {
    let least = |weights: &[f64; 3]| weights.iter().copied().fold(f64::INFINITY, f64::min);
    triangles
        .filter_map(|triangle| Some((triangle, weights_at(triangle, uv)?)))
        .max_by(|(_, a), (_, b)| least(a).total_cmp(&least(b)))
        .map(|(triangle, weights)| {
            let inside = weights.map(|weight| weight.max(0.0));
            let sum: f64 = inside.iter().sum();
            (triangle, inside.map(|weight| weight / sum))
        })
}

/// Barycentric coordinates: exactly 1, 0, 0 at a corner. None in a triangle without area.
fn weights_at(triangle: &Triangle, uv: DVec2) -> Option<[f64; 3]> {
    let [a, b, c] = triangle.uvs().map(|corner| corner - uv);
    let areas = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)];
    let sum: f64 = areas.iter().sum();
    (sum != 0.0).then(|| areas.map(|area| area / sum))
}
