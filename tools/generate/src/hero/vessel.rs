//! Raised vessels, a bowl and a jug: lattice boxes with a hollow, bent round. The jug has a handle and a lip.
use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::shape::{profile, rounded};
use crate::cage::Cage;
use crate::lattice::surface;

/// Lattice columns and layers of the box.
const SIDE: i32 = 8;
/// Lattice columns of a handle: its arms reach out from the box to the grip.
const ARMS: std::ops::Range<i32> = SIDE..SIDE + 2;
const GRIP: std::ops::Range<i32> = SIDE + 2..SIDE + 4;
/// Lattice layers of a handle.
const HANDLE_LAYERS: std::ops::Range<i32> = 3..5;
/// Half a handle's breadth, and the grip's thickness.
const HANDLE_HALF_BREADTH: f64 = 0.055;
const GRIP_THICKNESS: f64 = 0.07;

/// A vessel's measures.
struct Vessel {
    /// Height and radius of the outside, by row.
    outside: &'static [(f64, f64)],
    /// The hollow's lowest row, its radius and its height.
    floor: (i32, f64, f64),
    /// Thickness of the wall.
    wall: f64,
    /// Lowest rows of the lower and the upper arm of the handle, and how far the grip stands off the axis.
    handle: Option<([i32; 2], f64)>,
    /// How far the rim is drawn out into a lip, opposite to the handle.
    lip: f64,
}

/// A wide bowl on a foot.
pub fn bowl() -> Cage {
    Vessel {
        outside: &[
            (0.0, 0.27),
            (0.02, 0.30),
            (0.07, 0.27),
            (0.14, 0.40),
            (0.26, 0.56),
            (0.40, 0.645),
            (0.54, 0.66),
            (0.60, 0.70),
            (0.62, 0.715),
        ],
        floor: (2, 0.30, 0.11),
        wall: 0.035,
        handle: None,
        lip: 0.0,
    }
    .cage()
}

/// A jug with a handle towards +x.
pub fn jug() -> Cage {
    Vessel {
        outside: &[
            (0.0, 0.27),
            (0.03, 0.30),
            (0.09, 0.26),
            (0.20, 0.38),
            (0.38, 0.47),
            (0.56, 0.46),
            (0.74, 0.37),
            (0.90, 0.26),
            (1.04, 0.205),
            (1.14, 0.20),
            (1.24, 0.225),
            (1.36, 0.29),
            (1.39, 0.31),
        ],
        floor: (2, 0.22, 0.13),
        wall: 0.03,
        handle: Some(([4, 9], 0.66)),
        lip: 0.42,
    }
    .cage()
}

impl Vessel {
    fn cage(&self) -> Cage {
        let rows = self.outside.len() as i32 - 1;
        surface([GRIP.end, rows, SIDE], |cell| self.is_solid(cell), |point| self.position(point))
    }

    fn is_solid(&self, [i, j, k]: [i32; 3]) -> bool {
        if i < SIDE {
            let hollow = 1..SIDE - 1;
            return !(j >= self.floor.0 && hollow.contains(&i) && hollow.contains(&k));
        }
        self.handle.is_some_and(|([lower, upper], _)| {
            let on_arm = (lower..lower + 2).contains(&j) || (upper..upper + 2).contains(&j);
            HANDLE_LAYERS.contains(&k) && (lower..upper + 2).contains(&j) && (on_arm || GRIP.contains(&i))
        })
    }

    fn position(&self, [i, j, k]: [i32; 3]) -> DVec3 {
        if let (Some(([lower, upper], reach)), true) = (self.handle, i > SIDE) {
            return self.handle_position([i, j, k], [lower, upper], reach);
        }
        let half = f64::from(SIDE) / 2.0;
        let square = DVec2::new(f64::from(i) - half, f64::from(k) - half);
        let (height, radius) = self.outside[j as usize];
        if j == 0 || square.abs().max_element() == half {
            let disc = rounded(square / half, 1.0);
            // The foot's underside is hollow.
            let y = height + if j == 0 { 0.02 * (1.0 - disc.length_squared()) } else { 0.0 };
            return self.drawn_out(disc * radius, y, j);
        }
        let disc = rounded(square / (half - 1.0), 1.0);
        let (floor_row, floor_radius, floor_height) = self.floor;
        if j == floor_row {
            let y = floor_height + 0.03 * disc.length_squared();
            return DVec3::new(disc.x * floor_radius, y, disc.y * floor_radius);
        }
        self.drawn_out(disc * (radius - self.wall), height, j)
    }

    /// A point of the wall, moved outwards and up near the rim where the lip is.
    fn drawn_out(&self, section: DVec2, height: f64, j: i32) -> DVec3 {
        let below_rim = self.outside.len() as i32 - 1 - j;
        let nearness = profile(&[(0.0, 1.0), (1.0, 0.95), (2.0, 0.4), (3.0, 0.0)], f64::from(below_rim));
        let from_lip = (section.to_angle().abs() - PI).abs();
        let lip = self.lip * nearness * (-(from_lip / 0.45).powi(2)).exp();
        let section = section * DVec2::new(1.0 + lip, 1.0 - 0.3 * lip);
        DVec3::new(section.x, height + 0.25 * lip, section.y)
    }

    /// A point of the handle: its arms start at the wall and end at the grip.
    fn handle_position(&self, [i, j, k]: [i32; 3], [lower, upper]: [i32; 2], reach: f64) -> DVec3 {
        let (height, radius) = self.outside[j as usize];
        let grip_x = reach + f64::from(i - GRIP.start) * GRIP_THICKNESS / 2.0;
        let rise = f64::from(j - lower) / f64::from(upper + 2 - lower);
        // The grip leans with the jug and bows outwards in its upper half.
        let bow = 0.16 * (PI * rise).sin() - 0.10 * rise;
        let arm_share = f64::from(i - ARMS.start) / f64::from(GRIP.start - ARMS.start);
        let x = if i < GRIP.start { radius + (reach + bow - radius) * arm_share } else { grip_x + bow };
        let middle = if j < (lower + upper) / 2 + 1 { lower + 1 } else { upper + 1 };
        let narrowing = if i > SIDE && (j - middle).abs() <= 1 { 0.55 } else { 1.0 };
        let middle_height = self.outside[middle as usize].0;
        let y = middle_height + (height - middle_height) * narrowing + 0.06 * arm_share.min(1.0) * (1.0 - 2.0 * rise);
        DVec3::new(x, y, f64::from(k - HANDLE_LAYERS.start - 1) * HANDLE_HALF_BREADTH)
    }
}
