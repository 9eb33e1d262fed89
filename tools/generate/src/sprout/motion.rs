//! Two seconds that repeat: the stalk sways, the head puffs, leaves flap, eyes blink.
use std::f64::consts::TAU;

use glam::DQuat;
use serde_json::{Value, json};

use super::Moving;
use crate::gltf_text::GltfText;

/// Length of the animation, seconds.
const LENGTH: f64 = 2.0;
/// Keys of what moves along straight lines: 12 a second.
const KEYS: u32 = 24;
/// Keys of what moves along splines.
const SPLINE_KEYS: u32 = 8;
/// Step of the differences that tangents are made of, seconds.
const STEP: f64 = 1e-3;

/// Adds the animation `sway`.
pub fn add(text: &mut GltfText, moving: &Moving) {
    let mut clip = Clip { samplers: Vec::new(), channels: Vec::new() };
    let times = keys(KEYS);
    let input = text.scalars(&times);
    for (number, &joint) in moving.joints.iter().enumerate().skip(1) {
        let turns: Vec<[f64; 4]> = times.iter().map(|&time| sway(number, time).to_array()).collect();
        clip.channel(joint, "rotation", "LINEAR", input, text.floats(&turns));
    }
    let weights: Vec<f64> = times.iter().flat_map(|&time| [wave(time, 1.0, 0.2), wave(time, 2.0, 0.5)]).collect();
    clip.channel(moving.sprout, "weights", "LINEAR", input, text.scalars(&weights));
    let times = keys(SPLINE_KEYS);
    let input = text.scalars(&times);
    for (leaf, turn) in moving.leaves.into_iter().zip([2.8, -0.25]) {
        let spline: Vec<[f64; 4]> = times.iter().flat_map(|&time| spline_key(|time| flap(turn, time), time)).collect();
        clip.channel(leaf, "rotation", "CUBICSPLINE", input, text.floats(&spline));
    }
    let (open, shut) = ([1.0; 3], [1.15, 0.12, 1.0]);
    let input = text.scalars(&[0.0, 1.25, 1.375, LENGTH]);
    let lids = text.floats(&[open, shut, open, open]);
    moving.eyes.iter().for_each(|&eye| clip.channel(eye, "scale", "STEP", input, lids));
    text.add("animations", json!({ "name": "sway", "samplers": clip.samplers, "channels": clip.channels }));
}

struct Clip {
    samplers: Vec<Value>,
    channels: Vec<Value>,
}

impl Clip {
    fn channel(&mut self, node: usize, path: &str, interpolation: &str, input: usize, output: usize) {
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": path } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
    }
}

/// So many spans of the same length.
fn keys(count: u32) -> Vec<f64> {
    (0..=count).map(|key| LENGTH * f64::from(key) / f64::from(count)).collect()
}

/// From 0 to 1 and back so often in the length of the animation.
fn wave(time: f64, often: f64, phase: f64) -> f64 {
    0.5 + 0.5 * (TAU * (often * time / LENGTH + phase)).sin()
}

/// How a joint bends: each a little after the one below.
fn sway(joint: usize, time: f64) -> DQuat {
    let phase = -0.08 * joint as f64;
    let side = 0.12 * (2.0 * wave(time, 1.0, phase) - 1.0);
    let nod = 0.06 * (2.0 * wave(time, 2.0, phase + 0.25) - 1.0);
    DQuat::from_rotation_z(side) * DQuat::from_rotation_x(nod)
}

/// How a leaf that grows in a direction is turned.
fn flap(turn: f64, time: f64) -> DQuat {
    DQuat::from_rotation_y(turn) * DQuat::from_rotation_z(0.3 + 0.5 * wave(time, 2.0, turn))
}

/// A key of a spline: the tangent that arrives, the value, and the tangent that leaves.
fn spline_key(value: impl Fn(f64) -> DQuat, time: f64) -> [[f64; 4]; 3] {
    let tangent = ((value(time + STEP) - value(time - STEP)) * (0.5 / STEP)).to_array();
    [tangent, value(time).to_array(), tangent]
}
