//! The ground, which rises behind the scene as a photographer's backdrop does.
use glam::DVec3;

use crate::cage::Cage;
use crate::sheets::grid;

/// Quads across the line of sight.
const ACROSS: u32 = 12;
/// Distance along the line of sight, height and half the width of the rows, from the far upper edge to the near one. The
/// sheet narrows towards the viewer as the picture does.
const ROWS: [(f64, f64, f64); 14] = [
    (-3.40, 3.40, 5.35),
    (-3.38, 2.70, 5.35),
    (-3.34, 2.05, 5.35),
    (-3.22, 1.40, 5.35),
    (-2.98, 0.85, 5.30),
    (-2.60, 0.42, 5.20),
    (-2.10, 0.16, 5.05),
    (-1.55, 0.03, 4.85),
    (-0.90, 0.00, 4.60),
    (-0.20, 0.00, 4.35),
    (0.55, 0.00, 4.05),
    (1.30, 0.00, 3.75),
    (2.10, 0.00, 3.45),
    (2.90, 0.00, 3.15),
];

/// The sheet. It faces the direction (1, 0, 1.2), from which the default view looks.
pub fn sheet() -> Cage {
    let towards_viewer = DVec3::new(1.0, 0.0, 1.2).normalize();
    let right = DVec3::Y.cross(towards_viewer);
    grid(ACROSS, ROWS.len() as u32 - 1, |i, j| {
        let (along, height, half_width) = ROWS[j as usize];
        let across = half_width * (2.0 * f64::from(i) / f64::from(ACROSS) - 1.0);
        right * across + towards_viewer * along + DVec3::Y * height
    })
}
