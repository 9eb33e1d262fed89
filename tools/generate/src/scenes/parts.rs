//! Meshes that several files tag.
use std::f64::consts::TAU;

use glam::DVec3;

use crate::cage::Cage;
use crate::{lattice, sectors, sheets};

/// Between the middles of discs that lie side by side.
const DISC_SPACING: f64 = 6.0;
/// Lattice cells of a block.
const BLOCK: [i32; 3] = [3, 2, 3];

/// A block of 42 quads whose upper rim has creases with these values of sharpness in turn.
pub fn creased_rim(sharpness: &[f64]) -> Cage {
    let size = BLOCK.map(f64::from);
    let on_rim = |p: DVec3| p.y == size[1] && (p.x == 0.0 || p.x == size[0] || p.z == 0.0 || p.z == size[2]);
    let block = lattice::surface(BLOCK, |_| true, |point| DVec3::from(point.map(f64::from)));
    let rim = block.edges_where(on_rim);
    block.creased_edges(&rim, sharpness).map(twisted)
}

/// The block's points centred, tapered and twisted about the y axis, so that no two edges are parallel.
fn twisted(p: DVec3) -> DVec3 {
    let (x, z) = (p.x - 1.5, p.z - 1.5);
    let (sin, cos) = (0.2 * p.y + 0.1 * x).sin_cos();
    let scale = 1.0 - 0.1 * p.y;
    DVec3::new(scale * (x * cos + z * sin), 1.2 * p.y - 1.2 + 0.05 * x * z, scale * (z * cos - x * sin))
}

/// A waved sheet of 6 x 6 quads of side 1 about the origin; its vertices have whole coordinates x and z.
pub fn sheet() -> Cage {
    sheets::waved_grid(6, 6)
}

/// Discs around vertices of these valences, side by side along x.
pub fn discs(valences: &[u32]) -> Cage {
    let mut cage = Cage::default();
    for (place, &valence) in (0..).zip(valences) {
        cage.append(&sectors::disc(valence).moved(DVec3::new(disc_center(place), 0.0, 0.0)));
    }
    cage
}

/// x of the middle of a disc of [`discs`].
pub fn disc_center(place: u32) -> f64 {
    DISC_SPACING * f64::from(place)
}

/// The points along an edge from the middle of a disc of [`discs`] to its boundary.
pub fn spoke(place: u32, valence: u32, index: u32) -> [[f64; 2]; 3] {
    let (sin, cos) = (TAU * f64::from(index) / f64::from(valence)).sin_cos();
    [0.0, 1.0, 2.0].map(|radius| [disc_center(place) + radius * cos, radius * sin])
}

/// Discs side by side, each with creases from its middle to its boundary, spread as evenly as its edges let them.
pub fn stars(valences: &[u32], arms: &[f64]) -> Cage {
    let arm_count = arms.len() as u32;
    let mut cage = discs(valences);
    for (place, &valence) in (0..).zip(valences) {
        for (arm, &sharpness) in (0..).zip(arms) {
            cage = cage.creased_above(&spoke(place, valence, arm * valence / arm_count), sharpness);
        }
    }
    cage
}
