//! The hero scene: an anvil on a stump, a planishing hammer laid across it, and the jug and the bowl that they made.
//!
//! It is meant to be seen with `--eye 4.3,3.7,5.4 --target 0.25,1.1,0.35 --fov 32` in a picture of 16:9.
//!
//! All bodies but the backdrop are surfaces of lattices of cells, bent into shape. Edges are kept tight by thin cells
//! alone: nothing is creased. Units are about 40 centimetres; the ground is y = 0.
mod anvil;
mod backdrop;
mod hammer;
mod shape;
mod stump;
mod vessel;

use glam::DVec3;

pub(crate) use shape::{profile, smooth_step};

use crate::cage::Cage;

/// How deep the anvil has sunk into the stump.
const SUNK: f64 = 0.01;

/// The whole scene in one mesh.
pub fn scene() -> Cage {
    let mut scene = backdrop::sheet();
    scene.append(&stump::trunk());
    scene.append(&stump::band(0.3));
    scene.append(&stump::band(0.86));
    scene.append(&anvil::anvil().moved(DVec3::Y * (stump::HEIGHT - SUNK)));
    scene.append(&resting_hammer());
    scene.append(&vessel::bowl().moved(DVec3::new(1.95, 0.0, -0.36)));
    scene.append(&vessel::jug().turned(DVec3::Y, 12.0).moved(DVec3::new(-0.80, 0.0, 1.92)));
    scene
}

/// The hammer as it lies across the anvil's face: its handle over the edge, a little lower than the head.
fn resting_hammer() -> Cage {
    let face = stump::HEIGHT - SUNK + anvil::HEIGHT;
    hammer::hammer().turned(DVec3::X, -86.0).turned(DVec3::Y, -32.0).moved(DVec3::new(
        -0.05,
        face + hammer::REST_HEIGHT,
        -0.02,
    ))
}
