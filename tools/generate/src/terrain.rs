//! Hills, and a flight low through their valleys, as in figure 11 of Schaefer et al.: Dynamic Feature-Adaptive Subdivision, 2015.
use std::collections::HashSet;

use glam::DVec3;

use crate::cage::Cage;
use crate::random::{Random, noise};
use crate::rotate::{relax, rotate_random_edges};
use crate::sheets::grid;

/// Side of a square terrain; others have its area.
const SIDE: f64 = 10.0;
/// Greatest ratio of the sides of a terrain of exactly the faces asked for.
const MAX_ASPECT: f64 = 1.25;
/// Faces with an extraordinary vertex around one rotated edge among regular faces.
const FACES_PER_ROTATION: f64 = 12.0;
/// Times that the number of rotations is corrected by what the last made.
const CORRECTIONS: u32 = 4;
/// Rounds of relaxation after the rotations.
const RELAXATION_ROUNDS: u32 = 10;

/// Hills on a grid of about `face_count` quads, of which about `irregular_share` have an extraordinary vertex.
pub fn terrain(face_count: u32, irregular_share: f64) -> Cage {
    let flat = flat_sheet(face_count);
    let wanted = irregular_share * flat.faces.len() as f64;
    let mut rotation_count = wanted / FACES_PER_ROTATION;
    let mut best = flat.clone();
    for _ in 0..CORRECTIONS {
        let mut cage = flat.clone();
        rotate_random_edges(&mut cage, rotation_count.round() as usize, &mut Random::new(3));
        let distance = |cage: &Cage| (irregular_face_count(cage) as f64 - wanted).abs();
        rotation_count *= wanted / (irregular_face_count(&cage) as f64).max(1.0);
        if distance(&cage) < distance(&best) {
            best = cage;
        }
    }
    relax_within_boundary(&mut best);
    best.map(|p| DVec3::new(p.x, height(p.x, p.z), p.z))
}

/// How high the hills are at a place.
pub fn height(x: f64, z: f64) -> f64 {
    0.9 * noise(DVec3::new(x, 0.2 * (x + z), z), 6)
}

/// Sides along x and z of a terrain of about so many quads.
pub fn sides(face_count: u32) -> [f64; 2] {
    let (columns, rows) = lattice(face_count);
    let step = SIDE / (f64::from(columns) * f64::from(rows)).sqrt();
    [columns, rows].map(|count| f64::from(count) * step)
}

/// Columns and rows of exactly so many quads where they can be about as many, else of a few less.
fn lattice(face_count: u32) -> (u32, u32) {
    let side = face_count.isqrt().max(1);
    let least = (f64::from(side) / MAX_ASPECT.sqrt()).ceil() as u32;
    let rows = (least..=side).rev().find(|&rows| face_count.is_multiple_of(rows)).unwrap_or(side);
    ((face_count / rows).max(1), rows)
}

fn flat_sheet(face_count: u32) -> Cage {
    let (columns, rows) = lattice(face_count);
    let [width, depth] = sides(face_count);
    let step = width / f64::from(columns);
    grid(columns, rows, |i, j| DVec3::new(f64::from(i) * step - width / 2.0, 0.0, f64::from(j) * step - depth / 2.0))
}

/// Relaxes a sheet whose outline stays as it is.
fn relax_within_boundary(cage: &mut Cage) {
    let edges: HashSet<[u32; 2]> = directed_edges(cage).collect();
    let boundary = edges.iter().filter(|&&[from, to]| !edges.contains(&[to, from])).flatten();
    let fixed: Vec<(usize, DVec3)> = boundary.map(|&v| (v as usize, cage.positions[v as usize])).collect();
    for _ in 0..RELAXATION_ROUNDS {
        relax(cage, 1, |p| p);
        fixed.iter().for_each(|&(vertex, position)| cage.positions[vertex] = position);
    }
}

/// Faces of a sheet of quads with a vertex that has other than four faces inside, two at the border or one at a corner.
pub fn irregular_face_count(cage: &Cage) -> usize {
    let edges: HashSet<[u32; 2]> = directed_edges(cage).collect();
    let mut faces = vec![0; cage.positions.len()];
    let mut open = vec![false; cage.positions.len()];
    for [from, to] in directed_edges(cage) {
        faces[from as usize] += 1;
        if !edges.contains(&[to, from]) {
            (open[from as usize], open[to as usize]) = (true, true);
        }
    }
    let regular = |&vertex: &u32| match faces[vertex as usize] {
        4 => !open[vertex as usize],
        1 | 2 => open[vertex as usize],
        _ => false,
    };
    cage.faces.iter().filter(|face| !face.iter().all(regular)).count()
}

fn directed_edges(cage: &Cage) -> impl Iterator<Item = [u32; 2]> {
    cage.faces.iter().flat_map(|face| (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_have_exactly_the_faces_asked_for_where_they_can() {
        assert_eq!([1, 2, 17_136, 250_000, 17].map(lattice), [(1, 1), (2, 1), (136, 126), (500, 500), (4, 4)]);
    }

    #[test]
    fn outline_stays_where_it_is_and_faces_keep_their_side() {
        let cage = terrain(2500, 0.3);
        let [width, depth] = sides(2500);
        let outside = |p: &&DVec3| p.x.abs() > width / 2.0 + 1e-9 || p.z.abs() > depth / 2.0 + 1e-9;
        assert_eq!(cage.positions.iter().filter(outside).count(), 0);
        let corners = cage.positions.iter().filter(|p| p.x.abs() > 4.999 && p.z.abs() > 4.999).count();
        assert_eq!(corners, 4);
        for face in &cage.faces {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| cage.positions[face[i] as usize]);
            assert!((c - a).cross(d - b).y > 0.0, "{face:?}");
        }
    }
}
