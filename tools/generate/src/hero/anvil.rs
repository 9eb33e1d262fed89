//! The anvil: feet, waist, body with heel and hardy hole, horn. It stands on y = 0, its horn points to +x.
use glam::{DVec2, DVec3};

use super::shape::{profile, rounded, smooth_step};
use crate::cage::Cage;
use crate::lattice::surface;

/// Height of the face.
pub const HEIGHT: f64 = 1.06;

/// Lattice columns, from the heel's end to the horn's tip: where the waist begins and ends, where the horn begins.
const COLUMNS: i32 = 20;
const WAIST: std::ops::Range<i32> = 5..11;
const HORN: i32 = 13;
/// Lattice rows: feet and waist below, the body above.
const ROWS: i32 = 9;
const BODY: i32 = 6;
/// Lattice layers across.
const LAYERS: i32 = 6;

/// Height of the rows of feet and waist, and their breadth as a share of the feet's.
const WAIST_ROWS: [(f64, f64); 7] =
    [(0.0, 1.0), (0.04, 1.01), (0.17, 0.98), (0.24, 0.84), (0.40, 0.60), (0.55, 0.60), (0.66, 0.74)];
/// Half the feet's length and breadth.
const FEET: DVec2 = DVec2::new(0.66, 0.46);
/// Half the body's breadth.
const BODY_HALF_BREADTH: f64 = 0.30;
/// Layers of the lattice, from -1 to 1; the outer ones are thin, which keeps the edges tight.
const LAYER_PLACES: [f64; 7] = [-1.0, -0.90, -0.36, 0.0, 0.36, 0.90, 1.0];
/// Rows of the body, from -1 at its underside to 1 at the face.
const BODY_PLACES: [f64; 4] = [-1.0, -0.55, 0.80, 1.0];
/// Columns of the body, from the heel to the horn's tip.
const COLUMN_PLACES: [f64; 21] = [
    -1.16, -1.12, -0.90, -0.74, -0.56, -0.44, -0.30, -0.10, 0.10, 0.30, 0.44, 0.52, 0.56, 0.64, 0.70, 0.86, 1.04, 1.22,
    1.38, 1.50, 1.56,
];

/// The anvil.
pub fn anvil() -> Cage {
    let inside = |[i, j, k]: [i32; 3]| {
        let hardy_hole = i == 2 && (k == 2 || k == 3);
        if j < BODY { WAIST.contains(&i) } else { !hardy_hole }
    };
    surface([COLUMNS, ROWS, LAYERS], inside, position)
}

fn position([i, j, k]: [i32; 3]) -> DVec3 {
    let layer = LAYER_PLACES[k as usize];
    if j < BODY { waist_position(i, j, layer) } else { body_position(i, j, layer) }
}

/// Feet and waist: a box whose breadth follows the rows, with the feet's outline drawn in between its corners.
fn waist_position(i: i32, j: i32, layer: f64) -> DVec3 {
    let (height, breadth) = WAIST_ROWS[j as usize];
    let along = f64::from(2 * (i - WAIST.start) - (WAIST.end - WAIST.start)) / f64::from(WAIST.end - WAIST.start);
    let foot = 1.0 - smooth_step(0.1, 0.5, height);
    // The middle of each side is drawn in: more so at the feet than at the waist.
    let drawn_in = |other: f64| 1.0 - 0.16 * foot * (1.0 - other * other);
    let square = rounded(DVec2::new(along, layer), 0.55 * (1.0 - foot));
    let x = square.x * FEET.x * breadth * drawn_in(layer);
    let z = square.y * FEET.y * breadth * drawn_in(along);
    DVec3::new(x, height, z)
}

/// Heel, body, step and horn: the cross-section's height, breadth and roundness follow the column.
fn body_position(i: i32, j: i32, layer: f64) -> DVec3 {
    let x = COLUMN_PLACES[i as usize];
    let horn = x - COLUMN_PLACES[HORN as usize];
    let roundness = smooth_step(-0.1, 0.35, horn);
    let top = profile(&[(0.52, HEIGHT), (0.57, HEIGHT - 0.10), (0.9, HEIGHT - 0.09), (1.56, HEIGHT - 0.10)], x);
    let bottom = profile(
        &[
            (-1.16, 0.86),
            (-0.9, 0.82),
            (-0.44, 0.70),
            (0.44, 0.68),
            (0.64, 0.60),
            (1.0, 0.68),
            (1.38, 0.82),
            (1.56, 0.91),
        ],
        x,
    );
    let half_breadth = profile(
        &[
            (-1.16, 0.27),
            (-0.44, BODY_HALF_BREADTH),
            (0.52, BODY_HALF_BREADTH),
            (0.57, 0.27),
            (0.8, 0.25),
            (1.2, 0.15),
            (1.5, 0.055),
            (1.56, 0.03),
        ],
        x,
    );
    let section = rounded(DVec2::new(layer, BODY_PLACES[(j - BODY) as usize]), roundness);
    let y = (top + bottom) / 2.0 + section.y * (top - bottom) / 2.0;
    DVec3::new(x, y, section.x * half_breadth)
}
