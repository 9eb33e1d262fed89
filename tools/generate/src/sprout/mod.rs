//! The glTF scene that shows all that the reader knows: a sprout in a pot that nods, blinks and flaps its leaves.
//!
//! | module | idea |
//! |---|---|
//! | `body` | stalk and head, on joints, with a morph target |
//! | `things` | pot, leaves, eyes and ground |
//! | `pictures` | textures |
//! | `motion` | two seconds of animation |
mod body;
mod motion;
mod pictures;
mod things;

use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use crate::gltf_text::{GltfText, rounded_vector};

/// Height of the earth in the pot, where the stalk begins.
const EARTH: f64 = 0.62;

/// The nodes that move, by their index.
struct Moving {
    joints: Vec<usize>,
    sprout: usize,
    leaves: [usize; 2],
    eyes: [usize; 2],
}

/// The scene.
pub fn scene() -> GltfText {
    let mut text = GltfText::new(&[
        "FB_ngon_encoding",
        "KHR_lights_punctual",
        "KHR_materials_clearcoat",
        "KHR_materials_emissive_strength",
        "KHR_texture_transform",
    ]);
    let materials = Materials::add(&mut text);
    let [ground, pot] = [things::ground(&mut text, &materials), things::pot(&mut text, &materials)];
    let [leaf, eye] = [things::leaf(&mut text, &materials), things::eye(&mut text, &materials)];
    let body = body::mesh(&mut text, materials.skin);
    let moving = nodes(&mut text, &[ground, pot, leaf, eye, body]);
    motion::add(&mut text, &moving);
    text
}

/// Materials by their index.
struct Materials {
    ground: usize,
    pot: usize,
    earth: usize,
    skin: usize,
    leaf: usize,
    eye: usize,
}

impl Materials {
    fn add(text: &mut GltfText) -> Self {
        let [tiles, glaze, veins] = pictures::add(text);
        let mut material = |name: &str, pbr: Value, more: Value| {
            let mut material = json!({ "name": name, "pbrMetallicRoughness": pbr });
            if let Value::Object(more) = more {
                more.into_iter().for_each(|(field, value)| material[field] = value);
            }
            text.add("materials", material)
        };
        let repeated = json!({ "index": tiles, "extensions": { "KHR_texture_transform": { "scale": [10, 10] } } });
        let coat = json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03 } });
        Self {
            ground: material(
                "ground",
                json!({ "baseColorTexture": repeated, "metallicFactor": 0, "roughnessFactor": 0.8 }),
                json!({}),
            ),
            pot: material(
                "pot",
                json!({ "baseColorTexture": { "index": glaze }, "metallicFactor": 0, "roughnessFactor": 0.35 }),
                json!({}),
            ),
            earth: material(
                "earth",
                json!({ "baseColorFactor": [0.07, 0.04, 0.025, 1], "metallicFactor": 0, "roughnessFactor": 1 }),
                json!({}),
            ),
            skin: material(
                "skin",
                json!({ "baseColorFactor": [0.32, 0.62, 0.16, 1], "metallicFactor": 0, "roughnessFactor": 0.45 }),
                json!({ "emissiveFactor": [0.02, 0.05, 0.01],
                    "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 1 } } }),
            ),
            leaf: material(
                "leaf",
                json!({ "baseColorTexture": { "index": veins }, "metallicFactor": 0, "roughnessFactor": 0.5 }),
                json!({ "doubleSided": true }),
            ),
            eye: material(
                "eye",
                json!({ "baseColorFactor": [0.01, 0.01, 0.012, 1], "metallicFactor": 0, "roughnessFactor": 0.25 }),
                json!({ "extensions": coat }),
            ),
        }
    }
}

/// Adds all nodes. `meshes`: ground, pot, leaf, eye and body.
fn nodes(text: &mut GltfText, &[ground, pot, leaf, eye, body]: &[usize; 5]) -> Moving {
    let ground = text.add("nodes", json!({ "name": "ground", "mesh": ground }));
    let pot = text.add("nodes", json!({ "name": "pot", "mesh": pot }));
    let mut leaf = |name: &str, height: f64, turn: f64, size: f64| {
        let rotation = (DQuat::from_rotation_y(turn) * DQuat::from_rotation_z(0.5)).to_array();
        text.add("nodes", json!({ "name": name, "mesh": leaf, "translation": [0, height, 0], "rotation": rotation.map(short), "scale": [size, size, size] }))
    };
    let leaves = [leaf("leaf left", 0.02, 2.8, 1.0), leaf("leaf right", 0.12, -0.25, 0.85)];
    let mut eye = |name: &str, x: f64| {
        text.add(
            "nodes",
            json!({ "name": name, "mesh": eye, "translation": rounded_vector(DVec3::new(x, 0.33, 0.315)) }),
        )
    };
    let eyes = [eye("eye left", 0.14), eye("eye right", -0.14)];
    let joints = body::add_joints(
        text,
        &[(2, leaves[0]), (2, leaves[1]), (body::JOINT_COUNT - 1, eyes[0]), (body::JOINT_COUNT - 1, eyes[1])],
    );
    let skin = body::add_skin(text, &joints);
    let sprout = text.add("nodes", json!({ "name": "sprout", "mesh": body, "skin": skin }));
    let camera = json!({ "type": "perspective", "name": "front", "perspective": { "yfov": 0.6, "znear": 0.05, "aspectRatio": 1.77778 } });
    let camera = text.add("cameras", camera);
    let camera =
        looking(text, "front", DVec3::new(1.0, 1.75, 4.5), DVec3::new(0.0, 0.98, 0.0), json!({ "camera": camera }));
    text.set(
        "extensions",
        json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "name": "sun", "color": [1, 0.95, 0.85], "intensity": 3 },
        { "type": "spot", "name": "lamp", "color": [0.6, 0.75, 1], "intensity": 14, "range": 12,
          "spot": { "innerConeAngle": 0.35, "outerConeAngle": 0.7 } },
    ] } }),
    );
    let light = |index: usize| json!({ "extensions": { "KHR_lights_punctual": { "light": index } } });
    let sun = looking(text, "sun", DVec3::new(2.5, 5.0, 3.5), DVec3::ZERO, light(0));
    let lamp = looking(text, "lamp", DVec3::new(-3.0, 2.6, 2.0), DVec3::new(0.0, 1.0, 0.0), light(1));
    text.set("scenes", json!([{ "name": "sprout", "nodes": [ground, pot, joints[0], sprout, camera, sun, lamp] }]));
    Moving { joints, sprout, leaves, eyes }
}

/// Adds a node at a place that looks at a target along its -z.
fn looking(text: &mut GltfText, name: &str, eye: DVec3, target: DVec3, more: Value) -> usize {
    let rotation = facing(target - eye).to_array().map(short);
    let mut node = json!({ "name": name, "translation": rounded_vector(eye), "rotation": rotation });
    if let Value::Object(more) = more {
        more.into_iter().for_each(|(field, value)| node[field] = value);
    }
    text.add("nodes", node)
}

/// The rotation that takes -z to a direction, and leaves x level.
fn facing(direction: DVec3) -> DQuat {
    let yaw = (-direction.x).atan2(-direction.z);
    let pitch = direction.y.atan2(direction.x.hypot(direction.z));
    DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch)
}

/// A number in seven decimals.
fn short(value: f64) -> f64 {
    (value * 1e7).round() / 1e7 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_faces_a_direction_looks_along_it_with_x_level() {
        for direction in [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, -1.0, 0.5), DVec3::Z] {
            let turn = facing(direction);
            assert!((turn * DVec3::NEG_Z - direction.normalize()).length() < 1e-12);
            assert!((turn * DVec3::X).y.abs() < 1e-12 && (turn * DVec3::Y).y >= 0.0);
        }
    }
}
