//! Nothing that a file holds makes the reader panic, and what it returns can be subdivided.
use std::path::Path;

use crate::common::{CUBE, read, scene_folder};
use planish_scene::{LoadOptions, MAX_INSTANCES, read_json, read_obj};
use proptest::prelude::*;

/// A mesh that has every statement and every tag.
fn everything() -> String {
    let vertices: String = CUBE.lines().take(8).map(|line| format!("{line} 1.0\r\n")).collect();
    format!(
        "\u{feff}# caf\u{e9}\nmtllib a.mtl\no cube\ng side\nusemtl red\ns 1\n{vertices}\
        vt 0 0\nvt 1.5e-1 0\nvt 1 1 0\nvn 0 0 1\n\
        f 1/1/1 2/2/1 4/3/1 3/1/1\nf 3/1 4/1 6/1 5/1\nf -4/-1 -3/-1 -1/-1 -2/-1\nf 7/1 8/1 \\\n2/1 1/1\n\
        f 2/1 8/1 6/1 4/1\nf 7/1 1/1 3/1 5/1\n\
        t interpolateboundary 1/0/0 2\nt facevaryinginterpolateboundary 1/0/0 1\nt facevaryingpropagatecorners 1/0/0 1\n\
        t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\nt unknown 1/0/0 1\n\
        t crease 3/2/0 0 1 3 2.5 1e1\nt corner 2/1/0 4 5 3\nt hole 1/0/0 2\n\
        t vertexedit 8/6/3 3 4 1 0 3 4 1 1 0 0 1 0 0 1 add P value\nt edgeedit 4/1/3 3 4 1 0 10 set P sharpness\n\
        t faceedit 4/0/1 3 4 1 1 hole\nt density 2/2/0 4 5 3 0.5\n"
    )
}

/// Reads bytes; whatever is accepted must be fit to be subdivided, and errors must be one line.
fn read_and_check(bytes: &[u8]) {
    for repair in [false, true] {
        match read_obj("a.obj", bytes, &LoadOptions { repair, ..LoadOptions::default() }) {
            Ok(scene) => scene.meshes.iter().for_each(|mesh| {
                mesh.control_mesh.validate().unwrap();
            }),
            Err(error) => assert!(!error.to_string().chars().any(char::is_control), "{error:?}"),
        }
    }
}

#[test]
fn the_mesh_with_everything_is_read() {
    let scene = read(everything()).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(scene.warnings.len(), 2);
    assert_eq!((mesh.control_mesh.creases.len(), mesh.control_mesh.edits.len()), (2, 4));
    assert_eq!(mesh.control_mesh.face_varying.len(), 1);
}

#[test]
fn files_cut_at_any_byte_are_read_or_refused() {
    let text = everything();
    for end in 0..text.len() {
        read_and_check(&text.as_bytes()[..end]);
    }
}

#[test]
fn files_with_any_byte_replaced_are_read_or_refused() {
    let text = everything();
    for at in 0..text.len() {
        for byte in [0, b' ', b'\n', b'-', b'9', b'/', b'\\', b'#', 0xff] {
            let mut bytes = text.clone().into_bytes();
            bytes[at] = byte;
            read_and_check(&bytes);
        }
    }
}

/// A scene file that has every field.
const SCENE: &str = r#"{ "comment": "é", "meshes": [{ "name": "a", "file": "cube.obj" }, { "name": "b", "file": "sub/strip.OBJ" }],
    "instances": [{ "mesh": "a", "name": "x", "translate": [1, 2, 3], "rotate": { "axis": [1, 2, 3], "degrees": 9 },
      "scale": [1, -2e1, 3], "array": { "count": [2, 1, 3], "step": [1, 0, -9] } }, { "mesh": "b", "scale": 9 },
      { "mesh": "b", "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0] }],
    "cameras": [{ "name": "c", "eye": [0, 0, 9], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 30 }],
    "paths": [{ "name": "p", "fov": 9, "frames": 9, "keys": [{ "eye": [0, 0, 4], "target": [0, 0, 0] },
      { "eye": [9, 0, 4], "target": [0, 0, 0] }] }] }"#;

/// Reads a scene file; whatever is accepted must be fit to be drawn, and errors must be one line.
fn read_scene_and_check(folder: &Path, bytes: &[u8]) {
    match read_json(folder.join("a.json"), bytes, &LoadOptions::default()) {
        Ok(scene) => {
            assert!((1..=MAX_INSTANCES as usize).contains(&scene.instances.len()));
            for instance in &scene.instances {
                assert!(instance.mesh < scene.meshes.len());
                assert!(instance.transform.is_finite() && instance.transform.matrix3.determinant().is_normal());
            }
            assert!(scene.bounds().unwrap().diagonal().is_finite());
            scene.paths.iter().for_each(|path| _ = path.camera(path.frame_count() - 1));
        }
        Err(error) => assert!(!error.to_string().chars().any(char::is_control), "{error:?}"),
    }
}

#[test]
fn scene_files_cut_at_any_byte_are_read_or_refused() {
    let folder = scene_folder();
    let scene = read_json(folder.path().join("a.json"), SCENE.as_bytes(), &LoadOptions::default()).unwrap();
    assert_eq!((scene.instances.len(), scene.cameras.len(), scene.paths.len()), (8, 1, 1));
    for end in 0..SCENE.len() {
        read_scene_and_check(folder.path(), &SCENE.as_bytes()[..end]);
    }
}

#[test]
fn scene_files_with_any_byte_replaced_are_read_or_refused() {
    let folder = scene_folder();
    for at in 0..SCENE.len() {
        for byte in [0, b' ', b'-', b'0', b'9', b'e', b'"', b'\\', b'[', b'}', b',', 0xff] {
            let mut bytes = SCENE.as_bytes().to_vec();
            bytes[at] = byte;
            read_scene_and_check(folder.path(), &bytes);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        read_and_check(&bytes);
    }

    #[test]
    fn random_statements_are_read_or_refused(
        lines in proptest::collection::vec(
            (prop::sample::select(vec!["v", "vt", "f", "t crease 2/1/0", "t hole 1/0/0", "t corner 1/1/0", "t density 1/1/0",
                "t vertexedit 3/1/3", "t faceedit 3/0/1", "t edgeedit 4/1/3", "o", ""]),
             proptest::collection::vec(prop::sample::select(vec!["0", "1", "2", "3", "4", "-1", "1/1", "2/1", "1e39",
                "0.5", "nan", "set", "P", "sharpness", "hole", "\\"]), 0..6)),
            0..40)
    ) {
        let lines: Vec<String> = lines.iter().map(|(keyword, values)| format!("{keyword} {}", values.join(" "))).collect();
        read_and_check(format!("{CUBE}vt 0 0\n{}", lines.join("\n")).as_bytes());
    }
}
