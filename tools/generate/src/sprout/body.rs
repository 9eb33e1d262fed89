//! Stalk and head in one cage, on joints.
use std::f64::consts::TAU;

use glam::DVec3;
use serde_json::{Value, json};

use super::EARTH;
use crate::cage::Cage;
use crate::gltf_text::{GltfText, rounded_vector};
use crate::hero::smooth_step;

/// Heights above the earth of the joints; the last is the head's.
const JOINTS: [f64; 5] = [0.0, 0.2, 0.4, 0.58, 0.74];
/// How many joints there are.
pub const JOINT_COUNT: usize = JOINTS.len();
/// Vertices around the stalk.
const SIDES: u32 = 8;
/// Radius and height above the earth of the rings, from below.
const RINGS: [(f64, f64); 14] = [
    (0.1, -0.06),
    (0.085, 0.04),
    (0.07, 0.18),
    (0.062, 0.32),
    (0.058, 0.46),
    (0.06, 0.6),
    (0.075, 0.7),
    (0.24, 0.73),
    (0.39, 0.88),
    (0.41, 1.06),
    (0.33, 1.24),
    (0.13, 1.34),
    (0.055, 1.4),
    (0.035, 1.52),
];

/// A cage of rings around the y axis, whose last is closed by a polygon.
pub fn rings(sides: u32, rings: &[(f64, f64)]) -> Cage {
    let mut cage = Cage::default();
    for &(radius, height) in rings {
        for side in 0..sides {
            let (sin, cos) = (f64::from(side) / f64::from(sides) * TAU).sin_cos();
            cage.vertex(DVec3::new(radius * sin, height, radius * cos));
        }
    }
    let vertex = |ring: u32, side: u32| ring * sides + side % sides;
    for ring in 0..rings.len() as u32 - 1 {
        for side in 0..sides {
            cage.face(&[
                vertex(ring, side),
                vertex(ring, side + 1),
                vertex(ring + 1, side + 1),
                vertex(ring + 1, side),
            ]);
        }
    }
    let last = rings.len() as u32 - 1;
    cage.face(&(0..sides).map(|side| vertex(last, side)).collect::<Vec<_>>());
    cage
}

/// Adds the mesh, with targets that puff the head up and stretch its tip.
pub fn mesh(text: &mut GltfText, material: usize) -> usize {
    let cage = rings(SIDES, &RINGS).moved(DVec3::Y * EARTH);
    let (mut primitive, vertices) = text.primitive(&cage, material);
    let positions: Vec<DVec3> =
        vertices.iter().map(|&vertex| cage.positions[vertex as usize] - DVec3::Y * EARTH).collect();
    let (joints, weights): (Vec<[u8; 4]>, Vec<[f64; 4]>) =
        positions.iter().map(|position| influences(position.y)).unzip();
    primitive["attributes"]["JOINTS_0"] = json!(text.joints(&joints));
    primitive["attributes"]["WEIGHTS_0"] = json!(text.floats(&weights));
    // The face stays where the eyes are.
    let puff = |p: &DVec3| {
        let share =
            smooth_step(0.72, 0.9, p.y) * (1.0 - smooth_step(1.15, 1.35, p.y)) * (1.0 - smooth_step(0.1, 0.25, p.z));
        (DVec3::new(p.x, 0.0, p.z) * 0.2 * share).to_array()
    };
    let stretch = |p: &DVec3| [0.0, 0.22 * smooth_step(1.2, 1.5, p.y), 0.0];
    let puff = text.floats(&positions.iter().map(puff).collect::<Vec<_>>());
    let stretch = text.floats(&positions.iter().map(stretch).collect::<Vec<_>>());
    primitive["targets"] = json!([{ "POSITION": puff }, { "POSITION": stretch }]);
    let extras = json!({ "targetNames": ["puff", "stretch"] });
    text.add("meshes", json!({ "name": "sprout", "primitives": [primitive], "weights": [0, 0], "extras": extras }))
}

/// The joints that a height hangs on: the one below it and the one above, or the last alone.
fn influences(height: f64) -> ([u8; 4], [f64; 4]) {
    let above = JOINTS.iter().position(|&joint| joint > height).unwrap_or(JOINT_COUNT);
    if above == 0 || above == JOINT_COUNT {
        return ([above.saturating_sub(1) as u8, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]);
    }
    let share = smooth_step(JOINTS[above - 1], JOINTS[above], height);
    ([above as u8 - 1, above as u8, 0, 0], [1.0 - share, share, 0.0, 0.0])
}

/// Adds a chain of joints, with further nodes on some of them: pairs of a joint and a node.
pub fn add_joints(text: &mut GltfText, hanging: &[(usize, usize)]) -> Vec<usize> {
    let mut joints = vec![0; JOINT_COUNT];
    for joint in (0..JOINT_COUNT).rev() {
        let mut children: Vec<usize> = hanging.iter().filter(|(on, _)| *on == joint).map(|&(_, node)| node).collect();
        children.extend(joints.get(joint + 1));
        let below = if joint == 0 { -EARTH } else { JOINTS[joint - 1] };
        let mut node = json!({ "name": format!("joint {joint}"), "translation": rounded_vector(DVec3::Y * (JOINTS[joint] - below)) });
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        joints[joint] = text.add("nodes", node);
    }
    joints
}

/// Adds the skin.
pub fn add_skin(text: &mut GltfText, joints: &[usize]) -> usize {
    let inverse_bind = |height: &f64| {
        let mut columns = [0.0; 16];
        [0, 5, 10, 15].iter().for_each(|&i| columns[i] = 1.0);
        columns[13] = -(EARTH + height);
        columns
    };
    let binds = text.floats(&JOINTS.iter().map(inverse_bind).collect::<Vec<_>>());
    let skin: Value = json!({ "joints": joints, "inverseBindMatrices": binds });
    text.add("skins", skin)
}
