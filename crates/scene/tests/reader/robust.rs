//! Nothing that a file holds makes the reader panic, and what it returns can be subdivided.
use crate::common::{CUBE, read};
use planish_scene::{LoadOptions, read_obj};
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
        t faceedit 4/0/1 3 4 1 1 hole\n"
    )
}

/// Reads bytes; whatever is accepted must be fit to be subdivided, and errors must be one line.
fn read_and_check(bytes: &[u8]) {
    for repair in [false, true] {
        match read_obj("a.obj", bytes, &LoadOptions { repair }) {
            Ok(scene) => scene.meshes.iter().for_each(|mesh| {
                mesh.control_mesh.validate().unwrap();
                if let Some(uv) = &mesh.uv {
                    assert_eq!(uv.indices.len(), mesh.control_mesh.face_vertices.len());
                    assert!(uv.indices.iter().all(|&index| (index as usize) < uv.values.len()));
                }
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
    assert!(mesh.uv.is_some());
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

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        read_and_check(&bytes);
    }

    #[test]
    fn random_statements_are_read_or_refused(
        lines in proptest::collection::vec(
            (prop::sample::select(vec!["v", "vt", "f", "t crease 2/1/0", "t hole 1/0/0", "t corner 1/1/0",
                "t vertexedit 3/1/3", "t faceedit 3/0/1", "t edgeedit 4/1/3", "o", ""]),
             proptest::collection::vec(prop::sample::select(vec!["0", "1", "2", "3", "4", "-1", "1/1", "2/1", "1e39",
                "0.5", "nan", "set", "P", "sharpness", "hole", "\\"]), 0..6)),
            0..40)
    ) {
        let lines: Vec<String> = lines.iter().map(|(keyword, values)| format!("{keyword} {}", values.join(" "))).collect();
        read_and_check(format!("{CUBE}vt 0 0\n{}", lines.join("\n")).as_bytes());
    }
}
