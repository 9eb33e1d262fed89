//! The tree stump that the anvil stands on, and its iron bands.
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::shape::{profile, rounded};
use crate::cage::Cage;
use crate::lattice::surface;
use crate::solids::tube;

/// Height of the stump's top.
pub const HEIGHT: f64 = 1.15;

/// Lattice columns and layers of the trunk.
const SIDE: i32 = 6;
/// Height of the trunk's rows, and its radius.
const ROWS: [(f64, f64); 9] = [
    (-0.05, 1.22),
    (0.06, 1.17),
    (0.22, 1.03),
    (0.45, 0.95),
    (0.70, 0.92),
    (0.95, 0.91),
    (1.09, 0.91),
    (1.14, 0.895),
    (HEIGHT, 0.86),
];

/// The trunk: round, with roots and furrows that fade towards the top.
pub fn trunk() -> Cage {
    surface(
        [SIDE, ROWS.len() as i32 - 1, SIDE],
        |_| true,
        |[i, j, k]| {
            let half = f64::from(SIDE) / 2.0;
            let disc = rounded(DVec2::new(f64::from(i) - half, f64::from(k) - half) / half, 1.0);
            let (height, radius) = ROWS[j as usize];
            let section = disc * radius * furrows(disc.to_angle(), height);
            DVec3::new(section.x, height, section.y)
        },
    )
}

/// A flat iron ring around the trunk at a height.
pub fn band(height: f64) -> Cage {
    // Corners of the band's section: outwards from the trunk and up.
    const SECTION: [(f64, f64); 6] =
        [(0.045, -0.05), (0.045, 0.05), (0.03, 0.06), (-0.04, 0.05), (-0.04, -0.05), (0.03, -0.06)];
    tube(24, SECTION.len() as u32, true, |u, v| {
        let (outwards, up) = SECTION[(v * SECTION.len() as f64).round() as usize];
        let angle = TAU * u;
        let y = height + up;
        let radius = profile(&ROWS, y) * furrows(-angle, height) + outwards;
        DVec3::new(radius * angle.cos(), y, -radius * angle.sin())
    })
}

/// How far the bark stands out at an angle, as a factor of the radius.
fn furrows(angle: f64, height: f64) -> f64 {
    let roots = profile(&[(0.0, 0.12), (0.4, 0.02), (1.0, 0.012)], height);
    1.0 + roots * (5.0 * angle + 0.6).sin() + 0.012 * (3.0 * angle + 2.0).sin()
}
