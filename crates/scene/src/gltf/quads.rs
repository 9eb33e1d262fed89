//! Quads from triangles, where a file has nothing that says which were some (docs: formats).
//!
//! Two triangles may become one quad if they share an edge that they run along in opposite directions and no third face has,
//! are of one slot, no holes, not creased along the edge, and agree on all texture coordinates at its ends. The quad must be
//! near enough to a flat rectangle: the triangles' normals at most 45 degrees apart, and its four angles from 30 to 150 degrees,
//! which makes it convex, too. Of all pairs the best comes first, then the best of those that are left, and so on: the least cosine
//! of an angle away from 90 degrees, plus one less the cosine between the normals. Equally good ones come in the order of
//! their first triangle, then of its edge. All of it is sums, products, quotients and roots in double: the same on every machine.
use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::faces::Faces;
use super::weld::Welded;

/// Least cosine of the angle between the normals of two triangles: 45 degrees.
const LEAST_NORMAL_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Greatest cosine, either way, of an angle of a quad: 30 degrees.
const GREATEST_ANGLE_COSINE: f64 = 0.866_025_403_784_438_6;

/// What the faces are part of.
pub struct Around<'a> {
    pub welded: &'a Welded,
    /// Positions of the cage.
    pub positions: &'a [[f32; 3]],
    /// For each channel of texture coordinates, the value of every file vertex.
    pub channels: &'a [Vec<u32>],
    /// Creased edges, the lesser vertex first.
    pub creases: &'a HashSet<[u32; 2]>,
    /// Faces that are not drawn.
    pub holes: &'a HashSet<u32>,
}

/// Two triangles and what their quad would be.
struct Pair {
    cost: f64,
    /// The lesser comes first, and the quad stands where it stood.
    faces: [u32; 2],
    /// File vertices, from the first triangle's first corner on.
    corners: [u32; 4],
}

/// Pairs triangles. Returns the new index of every face; both of a pair have the same.
pub fn pair(faces: &mut Faces, around: &Around) -> Vec<u32> {
    let mut pairs = candidates(faces, around);
    // A stable sort: what is equally good stays in its order.
    pairs.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut quad_of: Vec<Option<[u32; 4]>> = vec![None; faces.sizes.len()];
    let mut joined_to: Vec<Option<u32>> = vec![None; faces.sizes.len()];
    for pair in &pairs {
        let [first, second] = pair.faces.map(|face| face as usize);
        let is_free = |face: usize| quad_of[face].is_none() && joined_to[face].is_none();
        if is_free(first) && is_free(second) {
            quad_of[first] = Some(pair.corners);
            joined_to[second] = Some(pair.faces[0]);
        }
    }
    let mut paired = Faces::default();
    let mut map: Vec<u32> = Vec::with_capacity(faces.sizes.len());
    for (face, corners) in faces.iter().enumerate() {
        if let Some(first) = joined_to[face] {
            map.push(map[first as usize]);
            continue;
        }
        map.push(paired.sizes.len() as u32);
        let corners = quad_of[face].as_ref().map_or(corners, |quad| quad.as_slice());
        paired.push(corners, faces.slots[face], faces.is_pairable[face]);
    }
    *faces = paired;
    map
}

/// All pairs that make good quads, in the order of their first triangle and its edges.
fn candidates(faces: &Faces, around: &Around) -> Vec<Pair> {
    // Every edge's uses: the face and its corner that the edge begins at.
    let mut uses: HashMap<[u32; 2], Vec<(u32, u32)>> = HashMap::new();
    for (face, corners) in faces.iter().enumerate() {
        for corner in 0..corners.len() {
            let ends = [corners[corner], corners[(corner + 1) % corners.len()]];
            uses.entry(edge(around.welded, ends)).or_default().push((face as u32, corner as u32));
        }
    }
    let starts: Vec<usize> =
        faces.sizes.iter().scan(0, |start, &size| Some(std::mem::replace(start, *start + size as usize))).collect();
    let triangle = |face: u32| -> Option<[u32; 3]> {
        let is_open =
            faces.is_pairable[face as usize] && faces.sizes[face as usize] == 3 && !around.holes.contains(&face);
        is_open.then(|| faces.corners[starts[face as usize]..][..3].try_into().ok()).flatten()
    };
    let mut pairs = Vec::new();
    for first in 0..faces.sizes.len() as u32 {
        let Some(a) = triangle(first) else { continue };
        for corner in 0..3 {
            let ends = [a[corner], a[(corner + 1) % 3]];
            let edge = edge(around.welded, ends);
            let &[one, other] = uses[&edge].as_slice() else { continue };
            let (second, second_corner) = if one.0 == first { other } else { one };
            if second <= first || around.creases.contains(&edge) {
                continue;
            }
            let Some(b) = triangle(second) else { continue };
            if faces.slots[first as usize] != faces.slots[second as usize] {
                continue;
            }
            let b_ends = [b[(second_corner as usize + 1) % 3], b[second_corner as usize]];
            if !ends.iter().zip(b_ends).all(|(&a, b)| agree(around, a, b)) {
                continue;
            }
            let opposite = b[(second_corner as usize + 2) % 3];
            let mut corners = a.to_vec();
            corners.insert(corner + 1, opposite);
            let Ok(corners) = <[u32; 4]>::try_from(corners) else { continue };
            pairs.extend(cost(around, &corners, corner).map(|cost| Pair { cost, faces: [first, second], corners }));
        }
    }
    pairs
}

fn edge(welded: &Welded, ends: [u32; 2]) -> [u32; 2] {
    let [a, b] = ends.map(|vertex| welded.vertex_of[vertex as usize]);
    [a.min(b), a.max(b)]
}

/// Whether two file vertices are one, texture coordinates included.
fn agree(around: &Around, a: u32, b: u32) -> bool {
    let [a, b] = [a, b].map(|vertex| vertex as usize);
    around.welded.vertex_of[a] == around.welded.vertex_of[b]
        && around.channels.iter().all(|values| values[a] == values[b])
}

/// How far a quad is from a flat rectangle; none if too far. Its diagonal runs between the corners next to `corner + 1`.
fn cost(around: &Around, corners: &[u32; 4], corner: usize) -> Option<f64> {
    let vertices = corners.map(|file_vertex| around.welded.vertex_of[file_vertex as usize]);
    if vertices.iter().enumerate().any(|(i, vertex)| vertices[..i].contains(vertex)) {
        return None;
    }
    let points = vertices.map(|vertex| DVec3::from(around.positions[vertex as usize].map(f64::from)));
    let point = |i: usize| points[i % 4];
    // The triangle at the quad's corner i, without the corner opposite.
    let normal = |i: usize| (point(i + 1) - point(i)).cross(point(i + 3) - point(i)).normalize_or_zero();
    let flatness = normal(corner + 1).dot(normal(corner + 3));
    let angle =
        |i: usize| (point(i + 1) - point(i)).normalize_or_zero().dot((point(i + 3) - point(i)).normalize_or_zero());
    let skewness = (0..4).map(|i| angle(i).abs()).fold(0.0, f64::max);
    // Every corner must turn the same way: a reflex angle has the cosine of a convex one.
    let turns_one_way = (1..4).all(|i| normal(i).dot(normal(0)) > 0.0);
    let is_good = flatness >= LEAST_NORMAL_COSINE && skewness <= GREATEST_ANGLE_COSINE && turns_one_way;
    is_good.then_some(skewness + 1.0 - flatness)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair_of(positions: &[[f32; 3]], triangles: &[[u32; 3]], creases: &[[u32; 2]], seams: &[u32]) -> Vec<Vec<u32>> {
        let mut faces = Faces::default();
        faces.add(triangles, 0, 0, false);
        let all: Vec<u32> = (0..positions.len() as u32).collect();
        let welded = Welded { vertex_of: all.clone(), first_of: all };
        let (creases, holes) = (creases.iter().copied().collect(), HashSet::new());
        let channels = if seams.is_empty() { vec![] } else { vec![seams.to_vec()] };
        let around = Around { welded: &welded, positions, channels: &channels, creases: &creases, holes: &holes };
        pair(&mut faces, &around);
        faces.iter().map(<[u32]>::to_vec).collect()
    }

    /// A grid of unit squares, each cut along a diagonal.
    fn grid(size: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let side = size + 1;
        let positions = (0..side * side).map(|i| [(i % side) as f32, (i / side) as f32, 0.0]).collect();
        let square = |i: u32| {
            let a = i / size * side + i % size;
            let [b, c, d] = [a + 1, a + side + 1, a + side];
            if i.is_multiple_of(3) { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] }
        };
        (positions, (0..size * size).flat_map(square).collect())
    }

    #[test]
    fn a_grid_becomes_quads_whatever_its_diagonals() {
        let (positions, triangles) = grid(5);
        let faces = pair_of(&positions, &triangles, &[], &[]);
        assert_eq!(faces.len(), 25);
        assert!(faces.iter().all(|face| face.len() == 4));
        // The first quad begins where its first triangle did and stands in its place.
        assert_eq!(faces[0], [0, 1, 7, 6]);
        assert_eq!(faces[1], [2, 8, 7, 1]);
    }

    #[test]
    fn a_crease_keeps_triangles_apart() {
        let (positions, triangles) = grid(1);
        assert_eq!(pair_of(&positions, &triangles, &[], &[]).len(), 1);
        assert_eq!(pair_of(&positions, &triangles, &[[0, 3]], &[]).len(), 2);
    }

    #[test]
    fn folded_skewed_and_reflex_pairs_stay_triangles() {
        let of = |points: [[f32; 3]; 4]| pair_of(&points, &[[0, 1, 2], [0, 2, 3]], &[], &[]).len();
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let with = |corner: usize, point| {
            let mut points = flat;
            points[corner] = point;
            of(points)
        };
        assert_eq!(of(flat), 1);
        assert_eq!(with(3, [0.3, 0.7, 0.8]), 2, "folded");
        assert_eq!(with(3, [-4.0, 1.0, 0.0]), 2, "skewed");
        assert_eq!(with(2, [0.4, 0.4, 0.0]), 2, "reflex");
        assert_eq!(with(3, [0.0, 0.0, 0.0]), 2, "of no area");
    }

    #[test]
    fn equally_good_pairs_are_taken_in_order() {
        // A strip of three equilateral triangles: the middle one fits both.
        let h = 0.75f32.sqrt();
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, h, 0.0], [1.5, h, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(
            pair_of(&positions, &[[0, 1, 2], [1, 3, 2], [1, 4, 3]], &[], &[]),
            [vec![0, 1, 3, 2], vec![1, 4, 3]]
        );
    }
}
