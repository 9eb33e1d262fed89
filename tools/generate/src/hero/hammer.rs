//! The planishing hammer: a round head with two faces along x, on a handle that goes down from it along -y.
use glam::{DVec2, DVec3};

use super::shape::{profile, rounded};
use crate::cage::Cage;
use crate::lattice::surface;

/// Height of the head's middle above what the hammer lies on.
pub const REST_HEIGHT: f64 = 0.175;

/// Lattice columns along the head.
const COLUMNS: i32 = 12;
/// Columns of the handle, and its layers.
const HANDLE_COLUMNS: std::ops::Range<i32> = 5..7;
const HANDLE_LAYERS: std::ops::Range<i32> = 1..3;
/// Lattice rows: the handle, the head, and the handle's end above it.
const HEAD_ROWS: std::ops::Range<i32> = 9..13;
const ROWS: i32 = 15;
/// Lattice layers across.
const LAYERS: i32 = 4;

/// Place and radius of the columns, from the flat face to the domed one.
const HEAD: [(f64, f64); 13] = [
    (-0.44, 0.165),
    (-0.425, 0.18),
    (-0.34, 0.18),
    (-0.27, 0.115),
    (-0.14, 0.11),
    (-0.075, 0.15),
    (0.0, 0.155),
    (0.075, 0.15),
    (0.14, 0.11),
    (0.29, 0.10),
    (0.35, 0.155),
    (0.43, 0.155),
    (0.45, 0.13),
];
/// Height and half the thickness, along x and along z, of the rows of the handle below the head.
const HANDLE: [(f64, f64, f64); 10] = [
    (-2.05, 0.060, 0.045),
    (-2.02, 0.085, 0.066),
    (-1.85, 0.095, 0.072),
    (-1.55, 0.080, 0.062),
    (-1.25, 0.072, 0.056),
    (-0.95, 0.062, 0.048),
    (-0.65, 0.056, 0.044),
    (-0.40, 0.056, 0.044),
    (-0.20, 0.066, 0.052),
    (-0.13, 0.072, 0.056),
];

/// The hammer.
pub fn hammer() -> Cage {
    let inside =
        |[i, j, k]: [i32; 3]| HEAD_ROWS.contains(&j) || (HANDLE_COLUMNS.contains(&i) && HANDLE_LAYERS.contains(&k));
    surface([COLUMNS, ROWS, LAYERS], inside, position)
}

fn position([i, j, k]: [i32; 3]) -> DVec3 {
    if (HEAD_ROWS.start..=HEAD_ROWS.end).contains(&j) {
        return head_position(i, j, k);
    }
    let square = DVec2::new(f64::from(i - 6), f64::from(k - 2));
    let section = rounded(square, 0.9);
    if j < HEAD_ROWS.start {
        let (height, thick, thin) = HANDLE[j as usize];
        return DVec3::new(section.x * thick, height, section.y * thin);
    }
    let (height, share) = if j == ROWS { (0.215, 0.75) } else { (0.20, 0.95) };
    DVec3::new(section.x * 0.066 * share, height, section.y * 0.054 * share)
}

/// The head: round sections whose radius follows the columns, a little squarer where the handle goes through.
fn head_position(i: i32, j: i32, k: i32) -> DVec3 {
    let (x, radius) = HEAD[i as usize];
    let roundness = profile(&[(0.0, 0.55), (0.12, 0.8), (0.28, 1.0)], x.abs());
    let square = DVec2::new(f64::from(j - HEAD_ROWS.start - 2) / 2.0, f64::from(k - 2) / 2.0);
    let section = rounded(square, roundness) * radius;
    // The striking faces: one nearly flat, one domed.
    let height = if i == 0 {
        -0.012
    } else if i == COLUMNS {
        0.045
    } else {
        0.0
    };
    let bulge = height * (1.0 - square.length_squared() / 2.0);
    DVec3::new(x + bulge, section.x, section.y)
}
