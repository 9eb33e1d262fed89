//! What becomes of primitives: welding, quads, slots, colours, texture coordinates and tags.
use crate::common::{File, HALVES, SQUARE, keep_ngons, square};
use planish_scene::LoadOptions;
use planish_subdiv::mesh::VertexInterpolation;
use serde_json::json;

fn quads() -> LoadOptions {
    LoadOptions { quads: true, ..LoadOptions::default() }
}

#[test]
fn triangles_stay_triangles_and_one_warning_says_so() {
    let mut file = square();
    file.mesh(&SQUARE, &HALVES);
    file.root(json!({ "mesh": 1 }));
    let scene = file.read_with(&LoadOptions::default()).unwrap();
    assert_eq!(scene.meshes[0].control_mesh.face_sizes, [3, 3]);
    let expected =
        "2 meshes have triangles of which nothing says if they were quads: they stay triangles (--quads pairs them)";
    assert_eq!(scene.warnings.iter().map(|warning| warning.text.as_str()).collect::<Vec<_>>(), [expected]);
}

#[test]
fn triangles_become_quads_when_asked_but_encoded_ones_do_not() {
    let mut file = square();
    let scene = file.read_with(&quads()).unwrap();
    assert_eq!(
        (scene.meshes[0].control_mesh.face_vertices.as_slice(), scene.warnings.len()),
        ([0, 1, 2, 3].as_slice(), 0)
    );
    keep_ngons(&mut file, 0);
    assert_eq!(file.scene().meshes[0].control_mesh.face_sizes, [4]);
    let indices = file.indices(&[0, 1, 2, 2, 3, 0]);
    file.primitive(0)["indices"] = json!(indices);
    assert_eq!(file.read_with(&quads()).unwrap().meshes[0].control_mesh.face_sizes, [3, 3]);
}

#[test]
fn seams_holes_and_creases_keep_triangles_apart() {
    let mut file = File::new();
    let split = [0, 1, 2, 0, 2, 3].map(|vertex| SQUARE[vertex]);
    file.mesh(&split, &[0, 1, 2, 3, 4, 5]);
    file.root(json!({ "mesh": 0 }));
    let size = |file: &File| file.read_with(&quads()).unwrap().meshes[0].control_mesh.face_sizes.clone();
    assert_eq!(size(&file), [4]);
    let mut creased = file.clone();
    creased.json["meshes"][0]["extras"] = json!({ "planish": { "creases": [[2, 0, 0.5]] } });
    assert_eq!(size(&creased), [3, 3]);
    let mut holed = file.clone();
    holed.json["meshes"][0]["extras"] = json!({ "planish": { "holes": [1] } });
    assert_eq!(size(&holed), [3, 3]);
    for (last, expected) in [([1.0, 1.0], vec![4]), ([1.0, 0.9], vec![3, 3])] {
        let uv = file.floats(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], last, [0.0, 1.0]]);
        file.primitive(0)["attributes"]["TEXCOORD_0"] = json!(uv);
        assert_eq!(size(&file), expected);
    }
}

#[test]
fn primitives_become_slots_of_one_cage() {
    let mut file = square();
    file.add("materials", json!({ "name": "red" }));
    file.add("materials", json!({}));
    let below = file.floats(&[[0.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, -0.0]]);
    file.primitive(0)["material"] = json!(1);
    for material in [json!(0), json!(null), json!(1)] {
        let mut primitive = json!({ "attributes": { "POSITION": below } });
        if !material.is_null() {
            primitive["material"] = material;
        }
        file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }
    let scene = file.scene();
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.slots, ["material 1", "red", ""]);
    assert_eq!(mesh.face_slots, [0, 0, 1, 2, 0]);
    assert_eq!(scene.instances[0].materials, [Some(1), Some(0), None]);
    assert_eq!(mesh.control_mesh.positions.len(), 5);
    assert_eq!(mesh.control_mesh.face_vertices[6..], [0, 4, 1, 0, 4, 1, 0, 4, 1]);
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    let mut file = square();
    let line = json!({ "attributes": { "POSITION": 0 }, "mode": 1 });
    file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(line.clone());
    file.add("meshes", json!({ "primitives": [line] }));
    file.root(json!({ "mesh": 1 }));
    let expected = [
        "meshes[0].primitives[1]: points or lines: left out",
        "meshes[1].primitives[0]: points or lines: left out",
        "meshes[1]: no triangles: left out",
    ];
    assert_eq!(file.warnings(), expected);
    assert_eq!(file.read_with(&LoadOptions::default()).unwrap().instances.len(), 1);
}

#[test]
fn colours_are_varying_and_the_mean_where_split_vertices_differ() {
    let mut file = File::new();
    file.mesh(&[0, 1, 2, 0, 2, 3].map(|vertex| SQUARE[vertex]), &[0, 1, 2, 3, 4, 5]);
    file.root(json!({ "mesh": 0 }));
    let grey = |value: f32| [value, value, value, 0.5];
    let colors = file.floats(&[grey(0.0), grey(0.25), grey(0.5), grey(0.0), grey(1.0), grey(3.0)]);
    file.primitive(0)["attributes"]["COLOR_0"] = json!(colors);
    assert_eq!(file.warnings(), ["meshes[0]: 1 vertices have several colours: their mean is taken"]);
    let colors = file.read_with(&LoadOptions::default()).unwrap().meshes.remove(0).control_mesh.colors.unwrap();
    assert_eq!(colors.interpolation, VertexInterpolation::Varying);
    assert_eq!(colors.values, [0.0, 0.25, 0.75, 3.0].map(|value| [value; 3]));
}

#[test]
fn small_integers_are_positions_and_texture_coordinates_too() {
    let mut file = square();
    let bytes: Vec<u8> = [[0, 0, 0, 0], [127, 0, 0, 0], [127, 127, 0, 0], [-128i8, 127, 0, 0]]
        .concat()
        .iter()
        .map(|&b| b as u8)
        .collect();
    let view = file.view(&bytes);
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    let positions =
        json!({ "bufferView": view, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3" });
    let positions = file.add("accessors", positions);
    file.primitive(0)["attributes"]["POSITION"] = json!(positions);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    assert_eq!(file.scene().meshes[0].control_mesh.positions, expected);
}

#[test]
fn sparse_accessors_replace_some_elements() {
    let mut file = square();
    let (indices, values) =
        (file.view(&[1, 0, 3, 0]), file.view(&[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.0].map(f32::to_le_bytes).concat()));
    let sparse = json!({ "count": 2, "indices": { "bufferView": indices, "componentType": 5123 }, "values": { "bufferView": values } });
    file.json["accessors"][0]["sparse"] = sparse;
    let positions = &file.scene().meshes[0].control_mesh.positions;
    assert_eq!(*positions, [SQUARE[0], [1.0, 2.0, 3.0], SQUARE[2], [4.0, 5.0, 6.0]]);
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    file.json["meshes"][0]["extras"] = json!({ "planish": { "weld": false } });
    let positions = &file.scene().meshes[0].control_mesh.positions;
    // Zeros where nothing is said.
    assert_eq!(*positions, [[0.0; 3], [1.0, 2.0, 3.0], [0.0; 3], [4.0, 5.0, 6.0]]);
}

#[test]
fn degenerate_faces_are_refused_or_dropped_by_repair() {
    let mut file = File::new();
    file.mesh(&[SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[1], SQUARE[3]], &[0, 1, 3, 0, 1, 2, 0, 2, 4]);
    file.json["meshes"][0]["extras"] = json!({ "planish": { "holes": [0, 2] } });
    file.root(json!({ "mesh": 0 }));
    let expected = "meshes[0]: face 0: found a face with vertex 1 of the cage twice, expected different vertices";
    assert_eq!(file.refusal(), expected);
    let scene = file.read_with(&LoadOptions { repair: true, ..LoadOptions::default() }).unwrap();
    let mesh = &scene.meshes[0].control_mesh;
    assert_eq!((mesh.face_vertices.as_slice(), mesh.holes.as_slice()), ([0, 1, 2, 0, 2, 3].as_slice(), [1].as_slice()));
    assert_eq!(scene.warnings[0].text, "meshes[0]: face 0: a face with vertex 1 of the cage twice: dropped");
}

#[test]
fn tags_count_vertices_of_all_primitives_before_they_are_welded() {
    let mut file = square();
    let positions = file.floats(&[SQUARE[2], SQUARE[1], [2.0, 0.0, 0.0]]);
    file.json["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "attributes": { "POSITION": positions } }));
    let tags = json!({ "creases": [[5, 4, 2.5], [1, 0, 1e300], [1, 3, 1]], "corners": [[6, 3]], "holes": [2] });
    file.json["meshes"][0]["extras"] = json!({ "planish": tags, "other": 1 });
    assert_eq!(file.warnings(), ["meshes[0]: a crease from vertex 1 to 3 of the cage, which no edge joins: ignored"]);
    let mesh = file.read_with(&LoadOptions::default()).unwrap().meshes.remove(0).control_mesh;
    let creases: Vec<_> = mesh.creases.iter().map(|crease| (crease.vertices, crease.sharpness)).collect();
    assert_eq!(creases, [([1, 2], 2.5), ([1, 0], 10.0)]);
    assert_eq!((mesh.corners[0].vertex, mesh.holes.as_slice()), (4, [2].as_slice()));
}

#[test]
fn wrong_tags_are_refused() {
    let refusal = |tags| {
        let mut file = square();
        file.json["meshes"][0]["extras"] = json!({ "planish": tags });
        file.refusal()
    };
    let place = "meshes[0].extras.planish";
    let expected = format!("{place}.creases[0]: found vertices index 4, expected 0 to 3");
    assert_eq!(refusal(json!({ "creases": [[0, 4, 1]] })), expected);
    assert_eq!(
        refusal(json!({ "corners": [[0, -1]] })),
        format!("{place}.corners[0]: found sharpness -1, expected 0 or more")
    );
    assert_eq!(refusal(json!({ "holes": [2] })), format!("{place}.holes[0]: found faces index 2, expected 0 to 1"));
    for tags in [json!({ "crease": [] }), json!(7), json!({ "creases": [[0, 1]] }), json!({ "faceVarying": "some" })] {
        assert!(refusal(tags).starts_with(&format!("{place}: found ")));
    }
}

#[test]
fn coincident_vertices_stay_apart_when_asked() {
    let mut file = File::new();
    file.mesh(&[0, 1, 2, 0, 2, 3].map(|vertex| SQUARE[vertex]), &[0, 1, 2, 3, 4, 5]);
    file.root(json!({ "mesh": 0 }));
    assert_eq!(file.scene().meshes[0].control_mesh.positions.len(), 4);
    file.json["meshes"][0]["extras"] = json!({ "planish": { "weld": false } });
    assert_eq!(file.scene().meshes[0].control_mesh.positions.len(), 6);
}
