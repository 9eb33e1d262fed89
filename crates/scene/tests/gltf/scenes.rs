//! Nodes, instances, cameras, lights, and where buffers come from.
use std::f32::consts::FRAC_PI_2;

use crate::common::{File, square};
use glam::{DVec3, Vec3};
use planish_scene::{Light, LightKind, LoadOptions, Scene, load, read_gltf};
use serde_json::json;

#[test]
fn instances_stand_where_their_nodes_are_and_share_meshes() {
    let mut file = square();
    let child = file.add("nodes", json!({ "mesh": 0, "name": "child", "scale": [-2, 2, 2], "translation": [0, 1, 0] }));
    let turn = [0.0, 0.0, 0.5f32.sqrt(), 0.5f32.sqrt()];
    file.root(json!({ "children": [child], "rotation": turn, "name": "parent" }));
    file.root(json!({ "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1] }));
    file.json["meshes"][0]["name"] = json!("square");
    file.add("nodes", json!({ "mesh": 0, "name": "of no scene" }));
    let scene = file.scene();
    assert_eq!(scene.meshes.len(), 1);
    let names: Vec<_> = scene.instances.iter().map(|instance| instance.name.as_str()).collect();
    assert_eq!(names, ["square", "child", "square"]);
    let at = |instance: usize| scene.instances[instance].transform.transform_point3(Vec3::X);
    assert_eq!((at(0), at(2)), (Vec3::X, Vec3::new(8.0, 8.0, 9.0)));
    assert!((at(1) - Vec3::new(-1.0, -2.0, 0.0)).length() < 1e-6, "{}", at(1));
    assert!(scene.instances[1].is_mirrored());
    for (instance, pose) in scene.instances.iter().zip(scene.pose(0.0).instances) {
        assert_eq!((pose.transform, pose.is_visible), (instance.transform, true));
        assert_eq!(scene.meshes[instance.mesh].name, "square");
    }
    assert_eq!(scene.nodes[scene.instances[1].node.unwrap()].parent, Some(1));
}

#[test]
fn the_default_scene_is_shown_else_the_first_else_everything() {
    let mut file = square();
    file.add("nodes", json!({ "mesh": 0, "name": "second" }));
    file.add("scenes", json!({ "nodes": [1] }));
    let names =
        |file: &File| -> Vec<String> { file.scene().instances.into_iter().map(|instance| instance.name).collect() };
    assert_eq!(names(&file), ["mesh 0"]);
    file.json["scene"] = json!(1);
    assert_eq!(names(&file), ["second"]);
    file.json.as_object_mut().unwrap().remove("scenes");
    file.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&file), ["mesh 0", "second"]);
}

fn with_camera(camera: serde_json::Value) -> File {
    let mut file = square();
    file.add("cameras", camera);
    file.root(json!({ "camera": 0, "name": "eye", "translation": [0, 0, 3] }));
    file
}

#[test]
fn cameras_hang_on_their_nodes_and_orthographic_ones_are_left_out() {
    let scene =
        with_camera(json!({ "type": "perspective", "perspective": { "yfov": FRAC_PI_2, "znear": 0.1 } })).scene();
    let camera = scene.camera(Some("eye")).unwrap();
    assert_eq!((camera.eye, camera.up), (Vec3::new(0.0, 0.0, 3.0), Vec3::Y));
    assert!((camera.fov_y_degrees - 90.0).abs() < 1e-4);
    assert!((camera.near - 1e-4 * 2f32.sqrt()).abs() < 1e-9);
    assert_eq!(camera.rig.as_ref().unwrap().node, 1);
    let orthographic = json!({ "xmag": 1, "ymag": 1, "zfar": 9, "znear": 1 });
    let file = with_camera(json!({ "type": "orthographic", "orthographic": orthographic }));
    assert_eq!(file.warnings(), ["cameras[0]: orthographic: left out"]);
    let message = with_camera(json!({ "type": "perspective", "perspective": { "yfov": 4, "znear": 1 } })).refusal();
    assert!(message.starts_with("cameras[0]: found camera: found a field of view of 229"), "{message}");
}

fn lights(lights: serde_json::Value) -> File {
    let mut file = square();
    for light in 0..lights.as_array().unwrap().len() {
        file.root(
            json!({ "name": format!("lamp {light}"), "extensions": { "KHR_lights_punctual": { "light": light } } }),
        );
    }
    file.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file
}

#[test]
fn lights_keep_their_numbers() {
    let spot = json!({ "type": "spot", "color": [1, 0.5, 0], "intensity": 20, "range": 9, "spot": { "innerConeAngle": 0.25 } });
    let scene = lights(json!([{ "type": "directional", "intensity": 3 }, { "type": "point" }, spot])).scene();
    let numbers = |light: &Light| (light.name.clone(), light.intensity.at(0.0), light.kind);
    let range = f32::INFINITY;
    assert_eq!(numbers(&scene.lights[0]), ("lamp 0".to_owned(), 3.0, LightKind::Distant { angle: 0.0 }));
    assert_eq!(numbers(&scene.lights[1]), ("lamp 1".to_owned(), 1.0, LightKind::Point { radius: 0.0, range }));
    let outer = std::f32::consts::FRAC_PI_4;
    let kind = LightKind::Spot { radius: 0.0, range: 9.0, inner: 0.25, outer };
    assert_eq!(numbers(&scene.lights[2]), ("lamp 2".to_owned(), 20.0, kind));
    assert_eq!(scene.pose(0.0).lights[2].radiance, [20.0, 10.0, 0.0]);
    for (light, expected) in [
        (json!({ "type": "point", "intensity": -1 }), "lights[0]: found -1 as colour or intensity, expected 0 or more"),
        (json!({ "type": "point", "range": 0 }), "lights[0]: found a range of 0, expected more than 0"),
        (json!({ "type": "spot" }), "lights[0]: found no spot, expected the angles of its cone"),
        (json!({ "type": "area" }), "lights[0]: found an unknown type, expected directional, point or spot"),
        (
            json!({ "type": "spot", "spot": { "innerConeAngle": 1, "outerConeAngle": 1 } }),
            "lights[0]: found a cone of 1 to 1 radians, expected 0 <= inner < outer <= pi / 2",
        ),
    ] {
        assert_eq!(lights(json!([light])).refusal(), expected);
    }
}

#[test]
fn buffers_are_embedded_or_in_a_chunk_or_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = square();
    file.json["nodes"][0]["translation"] = json!([1, 2, 3]);
    std::fs::write(folder.path().join("a b.bin"), [file.bytes.as_slice(), b"more"].concat()).unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("embedded.gltf"), file.to_gltf()).unwrap();
    std::fs::write(path("beside.GLTF"), file.to_gltf_beside("a%20b.bin")).unwrap();
    std::fs::write(path("binary.glb"), file.to_glb()).unwrap();
    let scenes: Vec<Scene> = ["embedded.gltf", "beside.GLTF", "binary.glb"]
        .map(|name| load(path(name), &LoadOptions::default()).unwrap())
        .into_iter()
        .collect();
    assert_eq!(scenes.iter().map(|scene| scene.name.as_str()).collect::<Vec<_>>(), ["embedded", "beside", "binary"]);
    for scene in &scenes[1..] {
        assert_eq!((&scene.meshes, &scene.instances), (&scenes[0].meshes, &scenes[0].instances));
    }
    let center = scenes[0].bounds().unwrap().center();
    assert_eq!(center, DVec3::new(1.5, 2.5, 3.0));
    for (uri, found) in [("missing.bin", "cannot be read"), (".", "not a plain file")] {
        let error =
            read_gltf(path("x.gltf"), &file.to_gltf_beside(uri), &LoadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("buffers[0]: found ") && error.contains(found), "{error}");
    }
    std::fs::write(path("short.bin"), &file.bytes[1..]).unwrap();
    let error = read_gltf(path("x.gltf"), &file.to_gltf_beside("short.bin"), &LoadOptions::default()).unwrap_err();
    assert!(error.to_string().ends_with("found 59 bytes, expected the 60 of byteLength"), "{error}");
}
