//! What is wrong is said in one line: which element, what was found, what was expected.
use crate::common::{File, square};
use planish_scene::{LoadOptions, read_gltf};
use serde_json::json;

/// Asserts the message for the square with one place of it set to something.
fn assert_refused(pointer: &str, value: serde_json::Value, message: &str) {
    let mut file = square();
    let (parent, field) = pointer.rsplit_once('/').unwrap();
    match file.json.pointer_mut(pointer) {
        Some(place) => *place = value,
        None => file.json.pointer_mut(parent).unwrap()[field] = value,
    }
    assert_eq!(file.refusal(), message, "{pointer}");
}

#[test]
fn extensions_that_are_required_are_named() {
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu"] {
        let mut file = square();
        file.json["extensionsRequired"] = json!([name, "KHR_lights_punctual"]);
        let message = file.refusal();
        assert!(
            message.starts_with(&format!("extensionsRequired: found {name}, expected none but KHR_lights_punctual, ")),
            "{message}"
        );
        file.json.as_object_mut().unwrap().remove("extensionsRequired");
        file.json["extensionsUsed"] = json!(["EXT_a", name, "KHR_texture_transform"]);
        assert_eq!(file.warnings(), [format!("extensions that are not understood: ignored: EXT_a, {name}")]);
    }
}

#[test]
fn indices_beyond_their_lists_are_refused() {
    assert_refused("/nodes/0/mesh", json!(1), "nodes[0].mesh: found meshes index 1, expected 0 to 0");
    assert_refused("/nodes/0/children", json!([1]), "nodes[0].children: found nodes index 1, expected 0 to 0");
    let own_parent = "scenes[].nodes: found node 0, a child, expected root nodes";
    assert_refused("/nodes/0/children", json!([0]), own_parent);
    assert_refused("/scene", json!(9), "scene: found scenes index 9, expected 0 to 0");
    assert_refused(
        "/nodes/0/camera",
        json!(0),
        "nodes[0].camera: found cameras index 0, expected none: the file has no cameras",
    );
    let primitive = "/meshes/0/primitives/0";
    let place = "meshes[0].primitives[0]";
    assert_refused(
        &format!("{primitive}/indices"),
        json!(2),
        &format!("{place}.indices: found accessors index 2, expected 0 to 1"),
    );
    assert_refused(
        &format!("{primitive}/attributes/POSITION"),
        json!(2),
        &format!("{place}: found accessors index 2, expected 0 to 1"),
    );
    assert_refused(&format!("{primitive}/attributes"), json!({}), &format!("{place}: found no POSITION, expected one"));
    assert_refused("/accessors/0/bufferView", json!(7), "accessors[0]: found bufferViews index 7, expected 0 to 1");
    assert_refused("/bufferViews/0/buffer", json!(1), "bufferViews[0]: found buffers index 1, expected 0 to 0");
}

#[test]
fn ranges_beyond_their_bytes_are_refused() {
    let huge = 1u64 << 62;
    assert_refused(
        "/bufferViews/0/byteLength",
        json!(61),
        "bufferViews[0]: found bytes 0 and 61 more, expected at most the 60 of buffer 0",
    );
    assert_refused(
        "/bufferViews/0/byteOffset",
        json!(u64::MAX),
        "bufferViews[0]: found bytes 18446744073709551615 and 48 more, expected at most the 60 of buffer 0",
    );
    assert_refused("/bufferViews/0/byteStride", json!(0), "bufferViews[0]: found a stride of 0, expected 4 to 252");
    assert_refused(
        "/bufferViews/0/byteStride",
        json!(8),
        "accessors[0]: found a stride of 8 bytes, expected 12 or more",
    );
    assert_refused(
        "/accessors/0/count",
        json!(5),
        "accessors[0]: found 5 elements of 12 bytes, 12 apart, from byte 0, expected no more than the 48 bytes of bufferViews[0]",
    );
    assert_refused("/accessors/0/count", json!(huge), &format!("accessors[0]: found {huge} elements, expected fewer"));
    let claim = "accessors[0]: found a claim of 60000000000 bytes, expected at most 67108864: the file is small";
    assert_refused("/accessors/0/count", json!(1_000_000_000u64), claim);
    assert_refused(
        "/accessors/0/byteOffset",
        json!(1),
        "accessors[0]: found 4 elements of 12 bytes, 12 apart, from byte 1, expected no more than the 48 bytes of bufferViews[0]",
    );
}

#[test]
fn claims_without_bytes_are_refused_before_they_are_met() {
    let mut file = square();
    let view = file.view(&[0; 16]);
    let part = json!({ "bufferView": view, "componentType": 5125 });
    let sparse = json!({ "count": 0, "indices": part, "values": part });
    let accessor = json!({ "componentType": 5126, "type": "VEC3", "count": 1_000_000_000_000u64, "sparse": sparse });
    file.json["accessors"][0] = accessor;
    assert!(file.refusal().starts_with("accessors[0]: found a claim of 60000000000000 bytes, expected at most 6"));
    file.json["accessors"][0]["count"] = json!(4);
    file.json["accessors"][0]["sparse"]["count"] = json!(5);
    assert_eq!(file.refusal(), "accessors[0].sparse: found 5 elements, expected at most the 4 of the accessor");
    // Not all 1000 of these may be made of the same few bytes.
    let mut file = square();
    file.json["accessors"][0]["count"] = json!(100_000);
    let zeros = vec![0; 1_200_000];
    let view = file.view(&zeros);
    file.json["accessors"][0]["bufferView"] = json!(view);
    let primitive = file.primitive(0).clone();
    file.json["meshes"][0]["primitives"] = json!(vec![primitive; 1000]);
    assert!(file.refusal().contains("found a claim of "));
}

#[test]
fn sparse_indices_must_ascend_within_the_accessor() {
    for (indices, found) in [([1u8, 1], 1), ([2, 1], 1), ([3, 4], 4)] {
        let mut file = square();
        let (indices, values) = (file.view(&indices), file.view(&[0; 24]));
        let indices = json!({ "bufferView": indices, "componentType": 5121 });
        let sparse = json!({ "count": 2, "indices": indices, "values": { "bufferView": values } });
        file.json["accessors"][0]["sparse"] = sparse;
        let expected = format!("accessors[0].sparse: found index {found}, expected indices that ascend, below 4");
        assert_eq!(file.refusal(), expected);
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for value in [f32::NAN, f32::INFINITY] {
        let mut file = File::new();
        file.mesh(&[[0.0; 3], [1.0, value, 0.0], [0.0, 1.0, 0.0]], &[0, 1, 2]);
        file.root(json!({ "mesh": 0 }));
        assert_eq!(file.refusal(), format!("accessors[0]: element 1: found {value}, expected a finite number"));
    }
    assert_refused(
        "/nodes/0/matrix",
        json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]),
        "nodes[0].matrix: found the last row [0.0, 0.0, 0.0, 2.0], expected 0 0 0 1",
    );
}

#[test]
fn vertices_of_triangles_must_be_there() {
    let mut file = square();
    let indices = file.indices(&[0, 1, 4]);
    file.primitive(0)["indices"] = json!(indices);
    let place = "meshes[0].primitives[0].indices";
    assert_eq!(
        file.refusal(),
        format!("{place}: found index 4 as element 2, expected less than 4, the number of vertices")
    );
    let indices = file.indices(&[0, 1, 2, 3]);
    file.primitive(0)["indices"] = json!(indices);
    assert_eq!(file.refusal(), "meshes[0].primitives[0]: found 4 indices, expected three a triangle");
    file.primitive(0)["indices"] = json!(0);
    assert!(file.refusal().starts_with("accessors[0]: found Vec3, expected elements of 1 components"));
}

#[test]
fn attributes_must_be_parallel() {
    let mut file = square();
    let uv = file.floats(&[[0.0, 0.0]]);
    file.primitive(0)["attributes"]["TEXCOORD_0"] = json!(uv);
    let place = "meshes[0].primitives[0]";
    assert_eq!(file.refusal(), format!("{place}.attributes.TEXCOORD_0: found 1 elements, expected 4, as POSITION"));
    let mut file = square();
    let offsets = file.floats(&[[0.0; 3]]);
    file.primitive(0)["targets"] = json!([{ "POSITION": offsets }]);
    assert_eq!(file.refusal(), format!("{place}.targets[0].POSITION: found 1 elements, expected 4, as POSITION"));
}

#[test]
fn a_scene_without_a_mesh_is_refused() {
    let mut file = File::new();
    file.root(json!({}));
    assert_eq!(file.refusal(), "scene: found no mesh of triangles, expected one or more");
}

#[test]
fn files_that_are_no_gltf_are_refused() {
    let refusal = |bytes: &[u8]| read_gltf("a.gltf", bytes, &LoadOptions::default()).unwrap_err().to_string();
    assert_eq!(refusal(b""), "a.gltf: line 1, column 0: found EOF while parsing a value, expected glTF 2.0");
    assert_eq!(refusal(b"v 0 0 0"), "a.gltf: line 1, column 1: found expected value, expected glTF 2.0");
    assert_eq!(refusal(b"{}"), "a.gltf: line 1, column 2: found missing field `asset`, expected glTF 2.0");
    let no_index = br#"{"asset":{"version":"2.0"},"scene":-1}"#;
    assert_eq!(refusal(no_index), "a.gltf: line 1, column 37: found integer `-1`, expected index into child of root");
}

#[test]
fn paths_that_leave_the_folder_are_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scene")).unwrap();
    let file = square();
    std::fs::write(folder.path().join("a.bin"), &file.bytes).unwrap();
    let scene = folder.path().join("scene/a.gltf");
    let absolute = folder.path().join("a.bin").display().to_string();
    for uri in ["../a.bin", "%2e%2e/a.bin", "x/../../a.bin", &absolute, &format!("file://{absolute}")] {
        let error = read_gltf(&scene, &file.to_gltf_beside(uri), &LoadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("buffers[0]: found `"), "{error}");
        assert!(
            error.ends_with("expected a path within the scene's folder")
                || error.ends_with("expected data: or the path of a file")
        );
        let mut with_image = square();
        with_image.add("images", json!({ "uri": uri }));
        assert!(with_image.refusal().starts_with("images[0]: found `"));
    }
}
