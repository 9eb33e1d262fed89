//! A dump as one connected mesh: corners whose positions have the same bits are one point; or positions and normals.
//!
//! A T-junction, a gap or a missing triangle leaves an edge of one triangle where the limit surface does not end.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::cage::{Cage, Side};
use crate::ply::Vertex;

/// How far the open edges along a side of a Ptex face may be from covering it once.
const COVERAGE_TOLERANCE: f64 = 1e-5;
/// What must have the same bits for corners to be one point. Of zeros the sign does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weld {
    /// Positions.
    Position,
    /// Positions and normals: of surfaces without sharp edges.
    PositionAndNormal,
}

/// The edges of a welded dump.
struct Edges {
    /// Triangle and its corner at which each directed edge begins.
    at: HashMap<[u32; 2], (usize, usize)>,
    faults: Vec<String>,
}

/// All that is wrong with how a dump's triangles hang together: they must meet edge to edge, the same way round, and end
/// exactly where the cage's limit surface does. A triangle of fewer than three points is none: the tessellator makes such
/// around a patch-filling quad's fan, and where a piece of a cut patch has a single point of the patch's edge.
pub fn faults(vertices: &[Vertex], cage: &Cage, by: Weld) -> Vec<String> {
    let points = weld(vertices, by);
    if !cage.is_manifold() {
        return multiplicity_faults(&points, vertices, cage);
    }
    let mut edges = Edges { at: HashMap::new(), faults: Vec::new() };
    for (triangle, corners) in points.as_chunks::<3>().0.iter().enumerate() {
        edges.add(triangle, *corners, vertices);
    }
    let open: Vec<[u32; 2]> = edges.at.keys().copied().filter(|&[a, b]| !edges.at.contains_key(&[b, a])).collect();
    let (sides, loop_count) = cage.boundary();
    let places = places_on(&sides, &points, vertices);
    let mut covered: HashMap<Side, f64> = sides.iter().map(|&side| (side, 0.0)).collect();
    for edge in &open {
        let place = |end: u32, side: &Side| places.get(&end).and_then(|places| places.get(side));
        let length = |side: &Side| Some((place(edge[0], side)? - place(edge[1], side)?).abs());
        let on_side = places.get(&edge[0]).and_then(|at| at.keys().find_map(|side| Some((*side, length(side)?))));
        match on_side {
            Some((side, length)) => *covered.entry(side).or_default() += length,
            None => {
                let (triangle, corner) = edges.at[edge];
                let ends = [corner, (corner + 1) % 3].map(|corner| vertices[3 * triangle + corner]);
                edges.faults.push(format!("an open edge inside: {}", told(ends)));
            }
        }
    }
    let is_off = |&(_, length): &(&Side, &f64)| (length - 1.0).abs() > COVERAGE_TOLERANCE;
    let sides_off = covered.iter().filter(is_off);
    edges.faults.extend(sides_off.map(|(side, length)| format!("{side:?} of the boundary is covered {length} times")));
    match loops(&open) {
        Some(count) if count == loop_count => {}
        Some(count) => edges.faults.push(format!("{count} boundary loops, the cage has {loop_count}")),
        None => edges.faults.push("the boundary is no set of loops".to_owned()),
    }
    edges.faults
}

/// How many edges triangles run more often one way than the other, corners at one place being one point: none of a closed surface,
/// whichever of its points are rounded to the same place.
pub fn unbalanced_edge_count(vertices: &[Vertex]) -> usize {
    let points = weld(vertices, Weld::Position);
    let mut sums: HashMap<[u32; 2], i64> = HashMap::new();
    for corners in points.as_chunks::<3>().0 {
        for corner in 0..3 {
            let [a, b] = [corners[corner], corners[(corner + 1) % 3]];
            if a != b {
                *sums.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    sums.values().filter(|&&sum| sum != 0).count()
}

/// Where on these sides each point lies, in the side's parameter. Of corners that are one point, one at the side's end counts.
fn places_on(sides: &HashSet<Side>, points: &[u32], vertices: &[Vertex]) -> HashMap<u32, BTreeMap<Side, f64>> {
    let mut places: HashMap<u32, BTreeMap<Side, f64>> = HashMap::new();
    for (point, vertex) in points.iter().zip(vertices) {
        for (side, along) in sides_at(*vertex).filter(|(side, _)| sides.contains(side)) {
            let place = places.entry(*point).or_default().entry(side).or_insert(along);
            if along.fract() == 0.0 {
                *place = along;
            }
        }
    }
    places
}

/// The same for a cage that is not manifold: every edge has two triangles, or as many as the cage's edge that it lies on
/// has faces.
fn multiplicity_faults(points: &[u32], vertices: &[Vertex], cage: &Cage) -> Vec<String> {
    let sides = cage.side_counts();
    let mut edges: HashMap<[u32; 2], Vec<[usize; 2]>> = HashMap::new();
    for first in (0..points.len()).step_by(3).filter(|&first| is_triangle(&points[first..first + 3])) {
        for ends in [[first, first + 1], [first + 1, first + 2], [first + 2, first]] {
            let [a, b] = ends.map(|corner| points[corner]);
            edges.entry([a.min(b), a.max(b)]).or_default().push(ends);
        }
    }
    let mut faults = Vec::new();
    let mut covered: HashMap<Side, f64> = sides.keys().map(|&side| (side, 0.0)).collect();
    for triangles in edges.values() {
        let on_sides = triangles.iter().flat_map(|ends| sides_of(ends.map(|corner| vertices[corner])));
        let on_sides: Vec<(Side, f64)> = on_sides.filter(|(side, _)| sides.contains_key(side)).collect();
        let expected = on_sides.first().map_or(2, |(side, _)| sides[side]);
        if triangles.len() != expected {
            let ends = told(triangles[0].map(|corner| vertices[corner]));
            faults.push(format!("an edge of {} triangles, expected {expected}: {ends}", triangles.len()));
        }
        on_sides.into_iter().for_each(|(side, length)| *covered.entry(side).or_default() += length);
    }
    let off = covered.iter().filter(|&(_, length)| (length - 1.0).abs() > COVERAGE_TOLERANCE);
    faults.extend(off.map(|(side, length)| format!("{side:?} is covered {length} times")));
    faults
}

impl Edges {
    fn add(&mut self, triangle: usize, corners: [u32; 3], vertices: &[Vertex]) {
        for corner in (0..3).filter(|_| is_triangle(&corners)) {
            let edge = [corners[corner], corners[(corner + 1) % 3]];
            if self.at.insert(edge, (triangle, corner)).is_some() {
                let ends = told([corner, (corner + 1) % 3].map(|corner| vertices[3 * triangle + corner]));
                self.faults.push(format!("two triangles on the same side of an edge: {ends}"));
            }
        }
    }
}

fn is_triangle(corners: &[u32]) -> bool {
    corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]
}

fn told(ends: [Vertex; 2]) -> String {
    let [a, b] = ends.map(|Vertex { face, uv: [u, v], level, kind, position: [x, y, z], .. }| {
        format!("face {face} ({u}, {v}) level {level} kind {kind} at ({x}, {y}, {z})")
    });
    format!("{a} to {b}")
}

/// The sides of its Ptex face on which a corner lies, and where in the side's parameter.
fn sides_at(vertex: Vertex) -> impl Iterator<Item = (Side, f64)> {
    let Vertex { face, uv, .. } = vertex;
    (0..4u8).filter_map(move |index| {
        let (across, along) = if index % 2 == 0 { (1, 0) } else { (0, 1) };
        let value = if index == 1 || index == 2 { 1.0 } else { 0.0 };
        (uv[across] == value).then_some((Side { face, index }, f64::from(uv[along])))
    })
}

/// The sides of the Ptex face on which both ends lie, with the length of the edge in its parameter.
fn sides_of([a, b]: [Vertex; 2]) -> impl Iterator<Item = (Side, f64)> {
    let of_b: Vec<(Side, f64)> = sides_at(b).collect();
    sides_at(a).filter_map(move |(side, from)| {
        let (_, to) = of_b.iter().find(|(other, _)| *other == side)?;
        Some((side, (from - to).abs()))
    })
}

/// Number of loops that directed edges make; none where they do not.
fn loops(edges: &[[u32; 2]]) -> Option<usize> {
    let successor: HashMap<u32, u32> = edges.iter().map(|&[from, to]| (from, to)).collect();
    let targets: HashSet<u32> = successor.values().copied().collect();
    if successor.len() != edges.len() || targets.len() != edges.len() {
        return None;
    }
    let (mut seen, mut count) = (HashSet::new(), 0);
    for &start in successor.keys() {
        if !seen.insert(start) {
            continue;
        }
        count += 1;
        let mut vertex = *successor.get(&start)?;
        while vertex != start {
            seen.insert(vertex);
            vertex = *successor.get(&vertex)?;
        }
    }
    Some(count)
}

/// The point that each vertex is.
fn weld(vertices: &[Vertex], by: Weld) -> Vec<u32> {
    let mut points: HashMap<[[u32; 3]; 2], u32> = HashMap::new();
    let bits = |vector: [f32; 3]| vector.map(|value| if value == 0.0 { 0 } else { value.to_bits() });
    let point_of = |vertex: &Vertex| {
        let normal = if by == Weld::Position { [0; 3] } else { bits(vertex.normal) };
        let next = points.len() as u32;
        *points.entry([bits(vertex.position), normal]).or_insert(next)
    };
    vertices.iter().map(point_of).collect()
}
