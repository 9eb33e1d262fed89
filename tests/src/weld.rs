//! A dump as one connected mesh: corners that lie within a tolerance of each other are one point.
//!
//! A T-junction, a gap or a missing triangle leaves an edge of one triangle where the limit surface does not end.

use std::collections::{HashMap, HashSet};

use crate::cage::{Cage, Side};
use crate::ply::Vertex;

/// Largest distance of corners that are the same point, over the larger of the cage's diagonal and coordinates.
const TOLERANCE: f64 = 1e-6;
/// How far the open edges along a side of a Ptex face may be from covering it once.
const COVERAGE_TOLERANCE: f64 = 1e-5;
/// Side of a cell of the grid in which points are found, in tolerances.
const CELL_SIZE: f64 = 16.0;

/// The edges of a welded dump.
struct Edges {
    /// Triangle and its corner at which each directed edge begins.
    at: HashMap<[u32; 2], (usize, usize)>,
    faults: Vec<String>,
}

/// All that is wrong with how a dump's triangles hang together: they must meet edge to edge, the same way round, and end
/// exactly where the cage's limit surface does.
pub fn faults(vertices: &[Vertex], cage: &Cage) -> Vec<String> {
    let largest = vertices.iter().flat_map(|vertex| vertex.position).fold(0.0, |a: f32, b| a.max(b.abs()));
    let points = weld(vertices, TOLERANCE * cage.diagonal().max(f64::from(largest)));
    if !cage.is_manifold() {
        return multiplicity_faults(&points, vertices, cage);
    }
    let mut edges = Edges { at: HashMap::new(), faults: Vec::new() };
    for (triangle, corners) in points.as_chunks::<3>().0.iter().enumerate() {
        edges.add(triangle, *corners, vertices);
    }
    let open: Vec<[u32; 2]> = edges.at.keys().copied().filter(|&[a, b]| !edges.at.contains_key(&[b, a])).collect();
    let (sides, loop_count) = cage.boundary();
    let mut covered: HashMap<Side, f64> = sides.iter().map(|&side| (side, 0.0)).collect();
    for edge in &open {
        let (triangle, corner) = edges.at[edge];
        let ends = [corner, (corner + 1) % 3].map(|corner| vertices[3 * triangle + corner]);
        match sides_of(ends).find(|(side, _)| sides.contains(side)) {
            Some((side, length)) => *covered.entry(side).or_default() += length,
            None => edges.faults.push(format!("an open edge inside: {}", told(ends))),
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

/// The same for a cage that is not manifold: every edge has two triangles, or as many as the cage's edge that it lies on
/// has faces.
fn multiplicity_faults(points: &[u32], vertices: &[Vertex], cage: &Cage) -> Vec<String> {
    let sides = cage.side_counts();
    let mut edges: HashMap<[u32; 2], Vec<[usize; 2]>> = HashMap::new();
    for first in (0..points.len()).step_by(3) {
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
        for corner in 0..3 {
            let edge = [corners[corner], corners[(corner + 1) % 3]];
            let ends = || told([corner, (corner + 1) % 3].map(|corner| vertices[3 * triangle + corner]));
            if edge[0] == edge[1] {
                self.faults.push(format!("an edge of no length: {}", ends()));
            } else if self.at.insert(edge, (triangle, corner)).is_some() {
                self.faults.push(format!("two triangles on the same side of an edge: {}", ends()));
            }
        }
    }
}

fn told(ends: [Vertex; 2]) -> String {
    let [a, b] = ends.map(|Vertex { face, uv: [u, v], level, kind, position: [x, y, z], .. }| {
        format!("face {face} ({u}, {v}) level {level} kind {kind} at ({x}, {y}, {z})")
    });
    format!("{a} to {b}")
}

/// The sides of the Ptex face on which both ends lie, with the length of the edge in its parameter.
fn sides_of([a, b]: [Vertex; 2]) -> impl Iterator<Item = (Side, f64)> {
    (0..4u8).filter_map(move |index| {
        let (across, along) = if index % 2 == 0 { (1, 0) } else { (0, 1) };
        let value = if index == 1 || index == 2 { 1.0 } else { 0.0 };
        let is_on = a.uv[across] == value && b.uv[across] == value;
        let length = (f64::from(b.uv[along]) - f64::from(a.uv[along])).abs();
        is_on.then_some((Side { face: a.face, index }, length))
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

/// The point that each vertex is: the first one within the tolerance.
fn weld(vertices: &[Vertex], tolerance: f64) -> Vec<u32> {
    let cell_size = CELL_SIZE * tolerance;
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let cell = |position: [f64; 3]| position.map(|coordinate| (coordinate / cell_size).floor() as i64);
    let mut point_of = |position: [f64; 3]| {
        let [first, last] = [-tolerance, tolerance].map(|shift| cell(position.map(|coordinate| coordinate + shift)));
        for x in first[0]..=last[0] {
            for y in first[1]..=last[1] {
                for z in first[2]..=last[2] {
                    let candidates = cells.get(&[x, y, z]).into_iter().flatten();
                    let is_near = |&&point: &&u32| distance(points[point as usize], position) <= tolerance;
                    if let Some(&point) = candidates.clone().find(is_near) {
                        return point;
                    }
                }
            }
        }
        let point = points.len() as u32;
        points.push(position);
        cells.entry(cell(position)).or_default().push(point);
        point
    };
    vertices.iter().map(|vertex| point_of(vertex.position.map(f64::from))).collect()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
