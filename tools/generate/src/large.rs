//! Meshes of any number of faces, for measurements.
use glam::DVec3;

use crate::cage::Cage;
use crate::random::{Random, noise};
use crate::rotate::{relax, rotate_random_edges};
use crate::solids::cube_sphere;

/// Faces with an extraordinary vertex around one rotated edge among regular faces.
const FACES_PER_ROTATION: f64 = 12.0;
/// Rounds of relaxation after the rotations.
const RELAXATION_ROUNDS: u32 = 10;

/// A closed, lumpy blob of about `face_count` quads, of which about `irregular_share` have an extraordinary vertex.
pub fn blob(face_count: u32, irregular_share: f64) -> Cage {
    let mut cage = cube_sphere(side_count(face_count / 6));
    let rotation_count = irregular_share * cage.faces.len() as f64 / FACES_PER_ROTATION;
    rotate_random_edges(&mut cage, rotation_count.round() as usize, &mut Random::new(1));
    relax(&mut cage, RELAXATION_ROUNDS, DVec3::normalize);
    cage.map(|p| p * (1.0 + 0.25 * noise(p * 2.0, 5)))
}

/// A sphere so full of rotated edges that nearly all faces have extraordinary vertices, side by side, of valences 3 to 7.
pub fn crowded_sphere() -> Cage {
    // Among the first seeds, the one with the most valences and no narrow corner.
    const SEED: u64 = 29;
    let mut cage = cube_sphere(4);
    rotate_random_edges(&mut cage, 40, &mut Random::new(SEED));
    relax(&mut cage, 4, DVec3::normalize);
    cage
}

/// The largest n with n * n no more than `face_count`, and at least 1.
fn side_count(face_count: u32) -> u32 {
    face_count.isqrt().max(1)
}
