//! Skins, morph targets, animations, and which nodes share a mesh.
use crate::common::{File, HALVES, SQUARE, square};
use glam::DVec3;
use planish_scene::{LoadOptions, Scene};
use serde_json::json;

/// The square with a morph target that lifts its last two vertices.
fn morphed() -> File {
    let mut file = square();
    let offsets = file.floats(&[[0.0; 3], [0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
    file.primitive(0)["targets"] = json!([{ "POSITION": offsets }]);
    file
}

/// The square on two joints: its left side on the first, which is a node's child, its right side on the second.
fn skinned() -> File {
    let mut file = square();
    let (joints, weights) =
        (file.joints(&[[0; 4], [1, 0, 0, 0], [1, 0, 0, 0], [0; 4]]), file.floats(&[[2.0, 0.0, 0.0, 0.0]; 4]));
    file.primitive(0)["attributes"]["JOINTS_0"] = json!(joints);
    file.primitive(0)["attributes"]["WEIGHTS_0"] = json!(weights);
    let mut bind = [0.0f32; 16];
    [0, 5, 10, 15].iter().for_each(|&i| bind[i] = 1.0);
    let mut moved = bind;
    moved[12] = -1.0;
    let binds = file.floats(&[bind, moved]);
    file.root(json!({ "children": [2], "translation": [0, 0, 5] }));
    file.add("nodes", json!({ "name": "left" }));
    let right = file.root(json!({ "name": "right", "translation": [1, 10, 0] }));
    file.add("skins", json!({ "joints": [2, right], "inverseBindMatrices": binds }));
    file.json["nodes"][0] = json!({ "mesh": 0, "skin": 0, "translation": [100, 100, 100], "name": "skinned" });
    file
}

/// Adds an animation of one channel.
fn animate(file: &mut File, name: &str, target: serde_json::Value, interpolation: &str, times: &[f32], output: usize) {
    let input = file.scalars(times);
    let sampler = json!({ "input": input, "output": output, "interpolation": interpolation });
    let channel = json!({ "sampler": 0, "target": target });
    file.add("animations", json!({ "name": name, "channels": [channel], "samplers": [sampler] }));
}

fn positions(scene: &Scene, mesh: usize, time: f64) -> Vec<[f32; 3]> {
    scene.posed_positions(mesh, &scene.pose(time))
}

#[test]
fn a_skin_moves_vertices_with_their_joints_whatever_their_node_does() {
    let scene = skinned().scene();
    let instance = &scene.instances[0];
    assert_eq!((instance.name.as_str(), instance.node), ("skinned", None));
    assert_eq!(instance.transform, glam::Affine3A::IDENTITY);
    let expected = [[0.0, 0.0, 5.0], [1.0, 10.0, 0.0], [1.0, 11.0, 0.0], [0.0, 1.0, 5.0]];
    assert_eq!(positions(&scene, 0, 0.0), expected);
    let skin = scene.meshes[0].deformation.as_ref().unwrap().skin.as_ref().unwrap();
    assert!(skin.influences.iter().all(|influence| influence.weight == 1.0));
    assert_eq!(scene.nodes[skin.joints[0].node].name, "left");
}

#[test]
fn further_sets_of_influences_count_too() {
    let mut file = skinned();
    let (joints, weights) = (file.joints(&[[1, 0, 0, 0]; 4]), file.floats(&[[6.0, 0.0, 0.0, 0.0]; 4]));
    file.primitive(0)["attributes"]["JOINTS_1"] = json!(joints);
    file.primitive(0)["attributes"]["WEIGHTS_1"] = json!(weights);
    assert_eq!(positions(&file.scene(), 0, 0.0)[0], [0.0, 7.5, 1.25]);
}

#[test]
fn every_skinned_node_has_a_mesh_of_its_own_of_the_same_cage() {
    let mut file = skinned();
    file.json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "skin": 0 }));
    file.json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0 }));
    file.json["scenes"][0]["nodes"] = json!([0, 1, 3, 4, 5]);
    let scene = file.scene();
    assert!(scene.meshes.iter().all(|mesh| mesh.control_mesh == scene.meshes[0].control_mesh));
    assert_eq!(scene.instances.iter().map(|instance| instance.mesh).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(scene.meshes[2].deformation, None);
}

#[test]
fn wrong_skins_are_refused() {
    let mut file = skinned();
    let zero = file.floats(&[[1.0, 0.0, 0.0, 0.0], [0.0; 4], [1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]);
    file.primitive(0)["attributes"]["WEIGHTS_0"] = json!(zero);
    assert_eq!(
        file.refusal(),
        "skins[0]: found vertex 1 of the cage without a weight, expected weights with a sum above 0"
    );
    let mut file = skinned();
    file.json["skins"][0]["joints"] = json!([2]);
    assert_eq!(file.refusal(), "skins[0]: found joints index 1, expected 0 to 0");
    file.json["skins"][0]["joints"] = json!([2, 3, 0]);
    assert_eq!(file.refusal(), "skins[0]: found 2 inverse bind matrices, expected one for each of 3 joints");
    file.json["skins"][0]["joints"] = json!([2, 9]);
    assert_eq!(file.refusal(), "skins[0]: found nodes index 9, expected 0 to 3");
    file.primitive(0)["attributes"].as_object_mut().unwrap().remove("WEIGHTS_0");
    assert_eq!(file.refusal(), "meshes[0].primitives[0]: found JOINTS_0, expected WEIGHTS_0, too");
}

#[test]
fn morph_targets_have_the_weights_of_the_node_else_of_the_mesh() {
    let mut file = morphed();
    file.json["meshes"][0]["extras"] = json!({ "targetNames": ["up"] });
    file.json["meshes"][0]["weights"] = json!([0.5]);
    let scene = file.scene();
    let morph = &scene.meshes[0].deformation.as_ref().unwrap().morphs[0];
    assert_eq!((morph.name.as_str(), morph.vertices.as_slice()), ("up", [2, 3].as_slice()));
    assert_eq!(positions(&scene, 0, 0.0)[3], [0.0, 1.0, 1.0]);
    file.root(json!({ "mesh": 0, "weights": [2] }));
    file.root(json!({ "mesh": 0, "weights": [0.5] }));
    let scene = file.scene();
    assert_eq!(scene.instances.iter().map(|instance| instance.mesh).collect::<Vec<_>>(), [0, 1, 0]);
    assert_eq!(positions(&scene, 1, 0.0)[3], [0.0, 1.0, 4.0]);
    file.json["nodes"][1]["weights"] = json!([1, 2]);
    assert_eq!(file.refusal(), "nodes[1].weights: found 2 weights, expected one for each of 1 morph targets");
}

#[test]
fn steps_lines_and_splines_move_nodes_and_weights() {
    let mut file = morphed();
    let output = file.scalars(&[9.0, 0.0, 3.0, 3.0, 8.0, 9.0]);
    animate(&mut file, "spline", json!({ "node": 0, "path": "weights" }), "CUBICSPLINE", &[1.0, 3.0], output);
    let scene = file.scene();
    // Hermite: the mean of the values, plus an eighth of the span times the difference of tangents, which are equal.
    assert_eq!(positions(&scene, 0, 2.0)[3], [0.0, 1.0, 8.0]);
    assert_eq!((scene.time_range, scene.clips.as_slice()), (Some([1.0, 3.0]), ["spline".to_owned()].as_slice()));

    let mut file = square();
    let output = file.floats(&[[0.0; 3], [4.0, 0.0, 8.0]]);
    animate(&mut file, "", json!({ "node": 0, "path": "translation" }), "LINEAR", &[0.5, 2.5], output);
    let input = file.scalars(&[1.0, 2.0]);
    let half = 0.5f32.sqrt();
    let turns = file.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]]);
    let channels = file.json["animations"][0]["channels"].as_array_mut().unwrap();
    channels.push(json!({ "sampler": 1, "target": { "node": 0, "path": "rotation" } }));
    let samplers = file.json["animations"][0]["samplers"].as_array_mut().unwrap();
    samplers.push(json!({ "input": input, "output": turns, "interpolation": "STEP" }));
    let scene = file.scene();
    let at = |time| scene.pose(time).instances[0].transform.transform_point3(glam::Vec3::X).as_dvec3();
    assert!((at(1.5) - DVec3::new(3.0, 0.0, 4.0)).length() < 1e-6);
    assert!((at(2.0) - DVec3::new(3.0, 1.0, 6.0)).length() < 1e-6);
    assert_eq!((scene.time_range, scene.clips.as_slice()), (Some([0.5, 2.5]), ["animation 0".to_owned()].as_slice()));
}

#[test]
fn an_animation_is_chosen_by_name_else_it_is_the_first() {
    let mut file = square();
    for (name, x) in [("walk", 1.0), ("run", 2.0)] {
        let output = file.floats(&[[x, 0.0, 0.0]]);
        animate(&mut file, name, json!({ "node": 0, "path": "translation" }), "LINEAR", &[x], output);
    }
    let read =
        |clip: Option<&str>| file.read_with(&LoadOptions { clip: clip.map(str::to_owned), ..LoadOptions::default() });
    let x = |clip| read(clip).unwrap().instances[0].transform.translation.x;
    assert_eq!([x(None), x(Some("walk")), x(Some("run"))], [1.0, 1.0, 2.0]);
    assert_eq!(read(Some("run")).unwrap().time_range, Some([2.0, 2.0]));
    let message = read(Some("fly")).unwrap_err().to_string();
    assert_eq!(message, "folder/name.gltf: animations: found the name \"fly\", expected one of \"walk\", \"run\"");
}

#[test]
fn wrong_animations_are_refused() {
    let refusal = |path: &str, times: &[f32], values: &[[f32; 3]]| {
        let mut file = morphed();
        let output = file.floats(values);
        animate(&mut file, "", json!({ "node": 0, "path": path }), "LINEAR", times, output);
        file.refusal()
    };
    let place = "animations[0].channels[0]";
    let one = [[1.0; 3]];
    assert_eq!(
        refusal("scale", &[0.0, 1.0], &one),
        format!("{place}: found 1 values for 2 keys, expected one value a key")
    );
    assert_eq!(refusal("scale", &[], &[]), format!("{place}: found no keys, expected 1 or more"));
    assert_eq!(
        refusal("scale", &[1.0, 1.0], &[[1.0; 3]; 2]),
        format!("{place}: found the time 1 after 1, expected times that ascend")
    );
    assert!(refusal("rotation", &[0.0], &one).starts_with("accessors[3]: found Vec3"));
    assert!(refusal("pointer", &[0.0], &one).starts_with(&format!("{place}: found an unknown path")));
    let mut file = morphed();
    let output = file.scalars(&[1.0, 2.0, 3.0]);
    animate(&mut file, "", json!({ "node": 0, "path": "weights" }), "LINEAR", &[0.0, 1.0], output);
    assert_eq!(file.refusal(), format!("{place}: found 3 weights at 2 keys, expected 1 a key for 1 morph targets"));
    file.json["animations"][0]["channels"][0]["target"]["node"] = json!(1);
    assert_eq!(file.refusal(), format!("{place}: found nodes index 1, expected 0 to 0"));
}

#[test]
fn what_grows_from_nothing_is_hidden_until_it_has_a_size() {
    let mut file = square();
    file.root(json!({ "mesh": 0 }));
    let output = file.floats(&[[0.0; 3], [1.0; 3]]);
    animate(&mut file, "", json!({ "node": 0, "path": "scale" }), "LINEAR", &[0.0, 1.0], output);
    let scene = file.scene();
    assert!(scene.instances.iter().all(|instance| instance.transform.matrix3.determinant() != 0.0));
    assert!(!scene.pose(0.0).instances[0].is_visible && scene.pose(0.5).instances[0].is_visible);
    let mut file = square();
    file.root(json!({ "mesh": 0, "scale": [1, 0, 1] }));
    assert_eq!(file.warnings(), ["nodes[1]: scaled to nothing: left out"]);
}

#[test]
fn vertices_that_morph_apart_are_not_welded() {
    let mut file = File::new();
    file.mesh(&[0, 1, 2, 0, 2, 3].map(|vertex| SQUARE[vertex]), &[0, 1, 2, 3, 4, 5]);
    file.root(json!({ "mesh": 0 }));
    let up = [0.0, 0.0, 1.0];
    let offsets = file.floats(&[up, [0.0; 3], [0.0; 3], up, up, [0.0; 3]]);
    file.primitive(0)["targets"] = json!([{ "POSITION": offsets }]);
    assert_eq!(file.scene().meshes[0].control_mesh.face_vertices, [0, 1, 2, 0, 3, 4]);
    assert_eq!(HALVES.len(), 6);
}
