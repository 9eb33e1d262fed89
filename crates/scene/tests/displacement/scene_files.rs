//! Displacement maps in scene files of JSON.
use planish_scene::displacement::{DisplacementKind, DisplacementLayout, DisplacementRequest};
use planish_scene::{Error, LoadOptions, Scene, read_json};

use crate::common::{QUAD, TempDir, tempdir};

/// Reads a scene file with these elements of `meshes`, of which instances use `a`.
fn scene(folder: &TempDir, meshes: &str) -> Result<Scene, Error> {
    std::fs::write(folder.path().join("quad.obj"), QUAD).unwrap();
    let text = format!(r#"{{ "meshes": [{meshes}], "instances": [{{ "mesh": "a" }}] }}"#);
    read_json(folder.path().join("scene.json"), text.as_bytes(), &LoadOptions::default())
}

fn with(displacement: &str) -> String {
    format!(r#"{{ "name": "a", "file": "quad.obj", "displacement": {displacement} }}"#)
}

#[test]
fn a_mesh_asks_for_a_map_that_lies_beside_the_scene_file() {
    let folder = tempdir().unwrap();
    let whole = r#"{ "file": "maps/a.exr", "scale": -2, "midpoint": 0.5, "kind": "vector", "layout": "faces" }"#;
    let found = scene(&folder, &with(whole)).unwrap();
    let expected = DisplacementRequest {
        path: folder.path().join("maps/a.exr"),
        kind: DisplacementKind::Vector,
        layout: DisplacementLayout::Faces,
        scale: -2.0,
        midpoint: 0.5,
    };
    assert_eq!(found.meshes[0].displacement, Some(expected));
    let found = scene(&folder, &with(r#"{ "file": "a.<UDIM>.exr" }"#)).unwrap();
    assert_eq!(found.meshes[0].displacement, Some(DisplacementRequest::new(folder.path().join("a.<UDIM>.exr"))));
}

#[test]
fn one_file_displaced_in_two_ways_is_two_meshes() {
    let folder = tempdir().unwrap();
    let mesh = |name: &str, file: &str| {
        format!(r#"{{ "name": "{name}", "file": "quad.obj", "displacement": {{ "file": "{file}" }} }}"#)
    };
    let plain = r#"{ "name": "d", "file": "./quad.obj" }"#.to_owned();
    let meshes = [mesh("a", "x.exr"), mesh("b", "y.exr"), mesh("c", "x.exr"), plain].join(", ");
    let found = scene(&folder, &meshes).unwrap();
    let names: Vec<_> = found.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "d"]);
    assert_eq!(found.meshes[2].displacement, None);
    assert_eq!(found.meshes[1].control_mesh, found.meshes[0].control_mesh);
}

#[test]
fn what_is_wrong_with_a_map_is_said_with_its_place() {
    let folder = tempdir().unwrap();
    for (text, told) in [
        (r#"{ "file": "a.exr", "scal": 1 }"#, "found unknown field `scal`, expected one of `file`, `scale`, "),
        (r#"{ "scale": 1 }"#, "found no field `file`, expected one"),
        (r#"{ "file": "a.exr", "kind": "normal" }"#, "found unknown variant `normal`, expected `scalar` or `vector`"),
        (r#"{ "file": "a.exr", "layout": "ptex" }"#, "found unknown variant `ptex`, expected `uv` or `faces`"),
        (r#"{ "file": "a.exr", "scale": "big" }"#, "found string \"big\", expected f64"),
        (r#"{ "file": "a.exr", "midpoint": 1e999 }"#, "found number out of range, expected a scene file of JSON"),
        (r#"{ "file": "" }"#, "meshes[0].displacement.file: found ``, expected the path of an image"),
        (r#"{ "file": "a\n.exr" }"#, "meshes[0].displacement.file: found `a"),
    ] {
        let message = scene(&folder, &with(text)).unwrap_err().to_string();
        assert!(message.contains(told) && !message.contains(char::is_control), "{message}");
    }
}
