//! A mesh' Gregory patches in f64, from the tables that the GPU reads.

use super::{
    Corner, EdgeFields, Normals, POINTS_PER_CORNER, SpokePoints, Vec3, evaluate_quad, evaluate_triangle,
    part_barycentric, part_points, quad_points, sum, triangle_points,
};
use crate::patch::SurfacePoint;
use crate::stencil::StencilRow;
use crate::tables::{GregoryFace, GregoryKind, ROWS_PER_CORNER, Tables};
use crate::topology::NONE;

/// The limit points and spokes of a mesh.
#[derive(Debug)]
pub struct GregorySurface<'a> {
    tables: &'a Tables,
    limits: Vec<[Vec3; 3]>,
    spokes: Vec<SpokePoints>,
}

/// The patch of an irregular face.
#[derive(Clone, Debug, PartialEq)]
pub struct GregoryPatch {
    kind: GregoryKind,
    /// 20 points, or 15.
    pub points: Vec<Vec3>,
    /// Of a quad its edges; of a part of a triangle those of the triangle; of a part of another face the outer two: before and after.
    pub edges: Vec<EdgeFields>,
}

impl<'a> GregorySurface<'a> {
    /// For these positions of the cage.
    ///
    /// # Panics
    /// If there are fewer positions than cage points.
    pub fn new(tables: &'a Tables, cage: &[[f32; 3]]) -> Self {
        Self::with_projection(tables, cage, true)
    }

    /// For values that are no positions, such as colours: nothing is projected into tangent planes.
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn of_values(tables: &'a Tables, cage: &[[f32; 3]]) -> Self {
        Self::with_projection(tables, cage, false)
    }

    fn with_projection(tables: &'a Tables, cage: &[[f32; 3]], is_projected: bool) -> Self {
        let mut points: Vec<Vec3> = cage[..tables.cage_point_count as usize].iter().map(|p| p.map(f64::from)).collect();
        points.resize(tables.point_count() as usize, [0.0; 3]);
        let stencils = &tables.stencils;
        for rows in tables.levels.iter().flat_map(|level| &level.dispatches) {
            for row in rows.clone() {
                let weights = |i: usize| [f64::from(stencils.weights[i]), 0.0, 0.0];
                let [made, ..] = weigh(&points, &stencils.indices, &stencils.rows[row as usize], weights);
                let origin = points[stencils.indices[stencils.rows[row as usize].first_index as usize] as usize];
                points[(tables.cage_point_count + row) as usize] = sum([(1.0, origin), (1.0, made)]);
            }
        }
        let of_limit = |row: &StencilRow| {
            let [p, a, b] = weigh(&points, &tables.limits.indices, row, |i| tables.limits.weights[i].map(f64::from));
            [sum([(1.0, points[tables.limits.indices[row.first_index as usize] as usize]), (1.0, p)]), a, b]
        };
        let limits: Vec<[Vec3; 3]> = tables.limits.rows.iter().map(of_limit).collect();
        let spokes = spokes(tables, &points, &limits, is_projected);
        Self { tables, limits, spokes }
    }

    /// Position and two tangents of a limit point.
    pub fn limit(&self, limit: u32) -> [Vec3; 3] {
        self.limits[limit as usize]
    }

    /// The patch of an irregular face; none if it is not drawn as one.
    pub fn patch(&self, irregular_face: u32) -> Option<GregoryPatch> {
        let face = &self.tables.gregory.faces[irregular_face as usize];
        let corners = |n: usize| -> Vec<Corner> { (0..n).map(|i| self.corner(face, i, i, (i + n - 1) % n)).collect() };
        let fields = |corners: &[Corner]| -> Vec<EdgeFields> {
            (0..corners.len()).map(|i| EdgeFields::new(&corners[i], &corners[(i + 1) % corners.len()])).collect()
        };
        let (points, edges) = match face.kind {
            GregoryKind::None => return None,
            GregoryKind::Quad => {
                let corners = corners(4);
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| corners[i]);
                (quad_points(&[a, b, c, d]), fields(&corners))
            }
            GregoryKind::PartOfTriangle(_) => {
                let corners = corners(3);
                let [a, b, c] = [0, 1, 2].map(|i| corners[i]);
                (triangle_points(&[a, b, c]), fields(&corners))
            }
            GregoryKind::PartOfNgon => {
                let previous = self.corner(face, 0, 0, 4);
                let own = self.corner(face, 1, 1, 0);
                let next = self.corner(face, 2, 4, 1);
                let mut centre = self.corner(face, 3, 2, 4);
                centre.into = self.spoke(face.first[3]);
                let edges = vec![EdgeFields::new(&previous, &own), EdgeFields::new(&own, &next)];
                (part_points(&previous, &own, &next, &centre), edges)
            }
        };
        Some(GregoryPatch { kind: face.kind, points, edges })
    }

    /// The control points of an irregular face by its stencils, and the four vectors across each edge; none if it has no stencils.
    /// The corners are the limit positions.
    pub fn stencil_points(&self, irregular_face: u32, cage: &[[f32; 3]]) -> Option<(Vec<Vec3>, Vec<Vec3>)> {
        let stencils = &self.tables.gregory.stencils;
        let face = stencils.faces.get(irregular_face as usize).filter(|face| !face.is_of_spokes())?;
        let table = stencils.connectivities[face.connectivity as usize];
        let corner_count = table.corner_count as usize;
        let ring = &stencils.rings[face.first_point as usize..][..table.point_count as usize];
        let at = |point: u32| cage[point as usize].map(f64::from);
        let row = |row: usize, corner: usize| {
            let origin = at(face.corners[corner]);
            ring.iter().filter(|[.., mask]| mask >> row & 1 != 0).fold([0.0; 3], |made, &[point, column, _]| {
                let place = table.first_weight as usize + column as usize * ROWS_PER_CORNER * corner_count + row;
                let weight = f64::from(stencils.weights[place]);
                sum([(1.0, made), (weight, at(point)), (-weight, origin)])
            })
        };
        let seats = self.tables.gregory.faces[irregular_face as usize].limits;
        let points =
            (0..POINTS_PER_CORNER * corner_count).map(|i| match (i / POINTS_PER_CORNER, i % POINTS_PER_CORNER) {
                (corner, 0) => self.limit(seats[corner])[0],
                (corner, which) => sum([(1.0, at(face.corners[corner])), (1.0, row(4 * corner + which - 1, corner))]),
            });
        let across = (0..4 * corner_count).map(|i| row(4 * corner_count + i, (i / 4 + i % 4 / 2) % corner_count));
        Some((points.collect(), across.collect()))
    }

    fn corner(&self, face: &GregoryFace, seat: usize, out: usize, into: usize) -> Corner {
        Corner {
            position: self.limits[face.limits[seat] as usize][0],
            cosine: f64::from(face.cosines[seat]),
            out: self.spoke(face.first.get(out).copied().unwrap_or(NONE)),
            into: self.spoke(face.last.get(into).copied().unwrap_or(NONE)),
        }
    }

    fn spoke(&self, spoke: u32) -> SpokePoints {
        self.spokes.get(spoke as usize).copied().unwrap_or_default()
    }
}

impl GregoryPatch {
    /// At (u, v) of its Ptex face; the derivatives are along u and v.
    pub fn evaluate(&self, u: f64, v: f64, normals: Normals) -> SurfacePoint {
        let GregoryKind::PartOfTriangle(part) = self.kind else { return evaluate_quad(&self.points, u, v, normals) };
        let part = usize::from(part);
        let point = evaluate_triangle(&self.points, part_barycentric(part, u, v), normals);
        // How the first two barycentric coordinates change along u and v: part_barycentric is bilinear.
        let at = |u: f64, v: f64| part_barycentric(part, u, v);
        let slope = |a: [f64; 3], b: [f64; 3]| sum([(b[0] - a[0], point.du), (b[1] - a[1], point.dv)]);
        SurfacePoint { position: point.position, du: slope(at(0.0, v), at(1.0, v)), dv: slope(at(u, 0.0), at(u, 1.0)) }
    }
}

fn spokes(tables: &Tables, points: &[Vec3], limits: &[[Vec3; 3]], is_projected: bool) -> Vec<SpokePoints> {
    let table = &tables.gregory;
    let mut spokes = vec![SpokePoints::default(); table.spokes.len()];
    for (&[first, count], [p, a, b]) in table.of_limit.iter().zip(limits) {
        let own = first as usize..(first + count) as usize;
        for i in own.clone() {
            let spoke = &table.spokes[i];
            let [along, across] = spoke.along.map(f64::from);
            let mut to_end = sum([(1.0, points[spoke.end as usize]), (-1.0, *p)]);
            let normal =
                SurfacePoint { position: *p, du: *a, dv: *b }.normal().filter(|_| is_projected && spoke.is_projected);
            if let Some(n) = normal {
                to_end = sum([(1.0, to_end), (-(n[0] * to_end[0] + n[1] * to_end[1] + n[2] * to_end[2]), n)]);
            }
            spokes[i].edge = sum([(1.0, *p), (along, *a), (across, *b), (f64::from(spoke.direct), to_end)]);
            let weight = |i: usize| [f64::from(table.weights[i]), 0.0, 0.0];
            [spokes[i].beside, ..] = weigh(points, &table.indices, &spoke.row, weight);
        }
        for i in own {
            let [before, after] = table.spokes[i].neighbours;
            if before != NONE && after != NONE {
                let (before, after) = (spokes[before as usize].edge, spokes[after as usize].edge);
                spokes[i].across = sum([(1.5, after), (-1.5, before)]);
            }
        }
    }
    spokes
}

/// Three sums of a row, relative to its first point.
pub(super) fn weigh(
    points: &[Vec3],
    indices: &[u32],
    row: &StencilRow,
    weights: impl Fn(usize) -> [f64; 3],
) -> [Vec3; 3] {
    let origin = points[indices[row.first_index as usize] as usize];
    let mut sums = [[0.0; 3]; 3];
    for i in 1..row.count {
        let point = points[indices[(row.first_index + i) as usize] as usize];
        for (sum, weight) in sums.iter_mut().zip(weights((row.first_weight + i) as usize)) {
            (0..3).for_each(|c| sum[c] += weight * (point[c] - origin[c]));
        }
    }
    sums
}
