//! Nothing that a file holds makes the reader panic, take long or take much memory, and what it returns can be drawn.
use std::time::{Duration, Instant};

use crate::common::{File, SQUARE, keep_ngons};
use planish_scene::{LoadOptions, read_gltf};
use proptest::prelude::*;
use serde_json::{Value, json};

/// Longest time that a file may take.
const LIMIT: Duration = Duration::from_secs(2);

/// A small file that has everything.
fn everything() -> File {
    let mut file = File::new();
    let mesh = file.mesh(&SQUARE, &[0, 1, 2, 0, 2, 3]);
    keep_ngons(&mut file, mesh);
    let uv = file.floats(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let colors = file.floats(&[[0.5f32; 3]; 4]);
    let joints = file.joints(&[[0, 1, 0, 0]; 4]);
    let weights = file.floats(&[[0.5, 0.5, 0.0, 0.0]; 4]);
    let (indices, values) = (file.view(&[1, 3]), file.view(&[1.0f32.to_le_bytes(); 6].concat()));
    let sparse = json!({ "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values } });
    let offsets = file.add("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse }));
    let primitive = file.primitive(mesh);
    primitive["attributes"]["TEXCOORD_0"] = json!(uv);
    primitive["attributes"]["COLOR_0"] = json!(colors);
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    primitive["targets"] = json!([{ "POSITION": offsets }]);
    primitive["material"] = json!(0);
    let tags = json!({ "creases": [[0, 1, 2]], "corners": [[2, 1]], "holes": [], "interpolateBoundary": "edgeOnly" });
    file.json["meshes"][0]["extras"] = json!({ "planish": tags, "targetNames": ["a"] });
    let texture = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "rotation": 1 } } });
    let pbr = json!({ "baseColorTexture": texture, "metallicRoughnessTexture": texture });
    file.add("materials", json!({ "pbrMetallicRoughness": pbr, "normalTexture": texture, "alphaMode": "MASK" }));
    let image = file.view(b"image");
    file.add("images", json!({ "bufferView": image, "mimeType": "image/png" }));
    file.add("samplers", json!({ "wrapS": 33071 }));
    file.add("textures", json!({ "source": 0, "sampler": 0 }));
    file.add("cameras", json!({ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }));
    file.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": {} }] } });
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    file.root(json!({ "mesh": 0, "skin": 0, "weights": [0.5] }));
    file.root(json!({ "camera": 0, "extensions": light, "children": [2], "translation": [0, 0, 3] }));
    file.add("nodes", json!({ "mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 1] }));
    file.add("skins", json!({ "joints": [1, 2] }));
    let times = file.scalars(&[0.0, 1.0]);
    let (moves, weights) = (file.floats(&[[1.0f32; 3]; 6]), file.scalars(&[0.0, 1.0]));
    let samplers = json!([{ "input": times, "output": moves, "interpolation": "CUBICSPLINE" }, { "input": times, "output": weights }]);
    let channels = json!([{ "sampler": 0, "target": { "node": 1, "path": "translation" } },
        { "sampler": 1, "target": { "node": 2, "path": "weights" } }]);
    file.add("animations", json!({ "channels": channels, "samplers": samplers }));
    file
}

/// Reads bytes; whatever is accepted must be fit to be drawn, and errors must be one line.
fn read_and_check(bytes: &[u8]) {
    let started = Instant::now();
    for (repair, quads) in [(false, false), (true, true)] {
        match read_gltf("a.gltf", bytes, &LoadOptions { repair, quads, clip: None }) {
            Ok(scene) => {
                scene.meshes.iter().for_each(|mesh| mesh.control_mesh.validate().unwrap());
                let pose = scene.pose(0.5);
                scene.posed_bounds(&pose);
                assert!(!scene.instances.is_empty());
                for instance in &scene.instances {
                    assert!(instance.transform.is_finite() && instance.transform.matrix3.determinant() != 0.0);
                    assert_eq!(instance.materials.len(), scene.meshes[instance.mesh].slots.len());
                    assert!(instance.materials.iter().flatten().all(|&material| material < scene.materials.len()));
                }
                assert!(scene.textures.iter().all(|texture| texture.image < scene.images.len()));
                let mut used = scene.materials.iter().flat_map(|material| material.textures());
                assert!(used.all(|used| used.texture < scene.textures.len()));
            }
            Err(error) => assert!(!error.to_string().chars().any(char::is_control), "{error:?}"),
        }
    }
    assert!(started.elapsed() < LIMIT, "{:?}", started.elapsed());
}

#[test]
fn the_file_with_everything_is_read() {
    let scene = everything().scene();
    assert_eq!((scene.meshes.len(), scene.instances.len(), scene.nodes.len()), (2, 2, 3));
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.materials.len()), (1, 1, 1));
    assert_eq!(scene.meshes[0].control_mesh.face_sizes, [4]);
    assert!(scene.is_animated());
}

#[test]
fn files_cut_at_any_byte_are_read_or_refused() {
    for bytes in [everything().to_gltf(), everything().to_glb()] {
        (0..bytes.len()).for_each(|end| read_and_check(&bytes[..end]));
    }
}

#[test]
fn files_with_any_byte_replaced_are_read_or_refused() {
    let bytes = everything().to_glb();
    for at in 0..bytes.len() {
        for byte in [0, b'9', b'"', b'[', b'-', 0x7f, 0xff] {
            let mut bytes = bytes.clone();
            bytes[at] = byte;
            read_and_check(&bytes);
        }
    }
}

/// All places of a file's JSON.
fn places(value: &Value, place: &str, found: &mut Vec<String>) {
    found.push(place.to_owned());
    match value {
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| places(value, &format!("{place}/{i}"), found))
        }
        Value::Object(fields) => {
            fields.iter().for_each(|(name, value)| places(value, &format!("{place}/{name}"), found))
        }
        _ => {}
    }
}

#[test]
fn files_with_any_value_replaced_are_read_or_refused() {
    let file = everything();
    let mut all = Vec::new();
    places(&file.json, "", &mut all);
    let others = [
        json!(null),
        json!(0),
        json!(1),
        json!(2),
        json!(-1),
        json!(255),
        json!(0.5),
        json!(-1e38),
        json!(1e39),
        json!(4_294_967_295u32),
        json!(4_294_967_296u64),
        json!(u64::MAX),
        json!(""),
        json!("../x"),
        json!([]),
        json!({}),
        json!([0, 0]),
        json!(true),
    ];
    for place in all {
        for other in &others {
            let mut changed = file.clone();
            *changed.json.pointer_mut(&place).unwrap() = other.clone();
            if !changed.json.is_object() {
                continue;
            }
            read_and_check(&changed.to_glb());
        }
    }
}

#[test]
fn a_small_file_never_takes_much_memory() {
    // Every primitive and every skinned node asks for as much again as the file has bytes.
    let mut file = everything();
    let mesh = file.json["meshes"][0]["primitives"][0].clone();
    file.json["meshes"][0]["primitives"] = json!(vec![mesh; 20_000]);
    let nodes: Vec<usize> = (0..20_000).map(|_| file.add("nodes", json!({ "mesh": 0, "skin": 0 }))).collect();
    file.json["scenes"][0]["nodes"] = json!(nodes);
    read_and_check(&file.to_glb());
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return };
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).expect("the peak of resident memory");
    let peak: u64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
    assert!(peak < 512 << 10, "{peak} KiB");
}

#[test]
fn long_chains_of_nodes_and_deep_json_are_read_or_refused() {
    let mut file = everything();
    let first = file.json["nodes"].as_array().unwrap().len();
    let count = 50_000;
    for node in 0..count {
        let children = if node + 1 < count { json!([first + node + 1]) } else { json!([]) };
        file.json["nodes"].as_array_mut().unwrap().push(json!({ "children": children, "mesh": 0 }));
    }
    file.json["scenes"][0]["nodes"] = json!([first]);
    read_and_check(&file.to_glb());
    for (open, close) in [("[", "]"), ("{\"a\":", "}")] {
        let deep = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        read_and_check(deep.as_bytes());
        read_and_check(format!(r#"{{"asset":{{"version":"2.0"}},"extras":{deep}}}"#).as_bytes());
        read_and_check(format!(r#"{{"asset":{{"version":"2.0"}},"extensions":{{"a":{deep}}}}}"#).as_bytes());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..500)) {
        read_and_check(&bytes);
        read_and_check(&[b"glTF\x02\0\0\0".as_slice(), &bytes].concat());
    }

    #[test]
    fn files_with_some_bytes_replaced_are_read_or_refused(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = everything().to_glb();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        read_and_check(&bytes);
    }
}
