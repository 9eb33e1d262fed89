//! What is refused, and in which words.
use crate::common::{CUBE, assert_refused, read, repair};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn assert_face_refused(face: &str, message: &str) {
    assert_refused(format!("{TRIANGLE}{face}\n"), &format!("line 4: {message}"));
}

#[test]
fn files_without_vertices_or_faces_are_refused() {
    let no_vertices = "found no vertices, expected lines `v x y z` and `f 1 2 3 ..`: an OBJ file";
    for text in ["", "\n\n", "# only a comment", "<!DOCTYPE html>\n<p>not found</p>\n", "f 1 2 3\n"] {
        assert_refused(text, no_vertices);
    }
    assert_refused(TRIANGLE, "found no faces, expected lines `f 1 2 3 ..`");
}

#[test]
fn binary_files_are_refused_with_their_line() {
    let message = "found a zero byte, expected text: this is not an OBJ file";
    assert_refused(b"glTF\x02\0\0\0\x10", &format!("line 1: {message}"));
    assert_refused(format!("{CUBE}v 1\0").as_bytes(), &format!("line 15: {message}"));
    assert_refused(b"\x89PNG\r\n\x1a\n", "line 2: found `\\u{1a}`, expected text: this is not an OBJ file");
}

#[test]
fn face_index_zero_is_refused() {
    assert_face_refused("f 0 1 2", "found vertex index 0, expected 1 or more, or -3 to -1");
    assert_refused("f 0 1 2", "line 1: found vertex index 0, expected 1 or more");
}

#[test]
fn face_indices_out_of_range_are_refused() {
    assert_face_refused("f 1 2 4", "found vertex index 4, expected 1 to 3");
    assert_face_refused("f 1 2 -4", "found vertex index -4, expected 1 or more, or -3 to -1");
    assert_face_refused("f 1 2 4294967296", "found vertex index 4294967296, expected 1 or more, or -3 to -1");
    assert_face_refused("f 1 2 4294967295", "found vertex index 4294967295, expected 1 to 3");
    assert_face_refused(
        "f 1 2 99999999999999999999",
        "found `99999999999999999999`, expected a corner like 1, 1/2, 1//3 or 1/2/3",
    );
}

#[test]
fn corners_that_are_no_indices_are_refused() {
    for corner in ["x", "1.5", "/1", "1/x", "1/1/x", "1/1/1/1", "1\\x"] {
        let expected = "expected a corner like 1, 1/2, 1//3 or 1/2/3";
        assert_face_refused(
            &format!("f 1 2 {corner}"),
            &format!("found `{}`, {expected}", corner.replace('\\', "\\\\")),
        );
    }
}

#[test]
fn texture_indices_out_of_range_are_refused() {
    assert_refused(
        format!("{TRIANGLE}vt 0 0\nf 1/1 2/1 3/1\nf 1/1 2/2 3/1\n"),
        "line 6: found vt index 2, expected 1 to 1",
    );
    assert_face_refused("f 1/0 2/1 3/1", "found vt index 0, expected 1 or more");
    assert_face_refused("f 1/-1 2/1 3/1", "found vt index -1, expected 1 or more");
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    for value in ["nan", "-inf", "infinity", "1e400", "4e38"] {
        let expected = "expected a finite coordinate within 32-bit floating point";
        assert_refused(format!("v 0 {value} 0\n"), &format!("line 1: found `{value}`, {expected}"));
        assert_refused(format!("vt {value}\n"), &format!("line 1: found `{value}`, {expected}"));
    }
}

#[test]
fn coordinates_that_are_no_numbers_or_missing_are_refused() {
    assert_refused("v 0 one 2\n", "line 1: found `one`, expected a number");
    assert_refused("v 0 0x1 2\n", "line 1: found `0x1`, expected a number");
    assert_refused("v 0 \u{e9} 2\n", "line 1: found `\u{e9}`, expected a number");
    assert_refused("\nv 0 1\n", "line 2: found v with 2 coordinates, expected 3 or more");
    assert_refused("vt\n", "line 1: found vt with 0 coordinates, expected 1 or more");
}

#[test]
fn faces_of_fewer_than_three_vertices_are_refused() {
    assert_face_refused("f", "found a face of 0 vertices, expected 3 or more");
    assert_face_refused("f 1 2", "found a face of 2 vertices, expected 3 or more");
}

#[test]
fn faces_that_name_a_vertex_twice_are_refused() {
    assert_face_refused("f 1 2 3 -3", "found a face with vertex 1 twice, expected different vertices");
    assert_face_refused("f 1 1", "found a face with vertex 1 twice, expected different vertices");
}

#[test]
fn repair_drops_degenerate_faces_with_a_warning_each() {
    let scene = repair(&format!("{TRIANGLE}f 1 2\nf 1 2 3\nf 1 2 2\nf 3 2 1\n"));
    assert_eq!(scene.meshes[0].control_mesh.face_vertices, [0, 1, 2, 2, 1, 0]);
    let warnings: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings, ["line 4: a face of 2 vertices: dropped", "line 6: a face with vertex 2 twice: dropped"]);
}

#[test]
fn repair_keeps_texture_coordinates_with_their_faces() {
    let scene = repair(&format!("{TRIANGLE}vt 0\nvt 1\nvt 2\nf 1/1 1/1 2/1\nf 1/1 2/2 3/3\n"));
    assert_eq!(scene.meshes[0].control_mesh.face_varying[0].indices, [0, 1, 2]);
}

#[test]
fn repair_does_not_save_a_file_of_degenerate_faces_only() {
    let options = planish_scene::LoadOptions { repair: true, ..planish_scene::LoadOptions::default() };
    let error = planish_scene::read_obj("a.obj", format!("{TRIANGLE}f 1 2\n").as_bytes(), &options).unwrap_err();
    assert_eq!(error.to_string(), "a.obj: found no faces, expected lines `f 1 2 3 ..`");
}

#[test]
fn a_face_of_ten_million_sides_is_refused() {
    let text = format!("{TRIANGLE}f{}\n", " 1".repeat(10_000_000));
    assert_refused(text, "line 4: found a face of more sides, expected at most 1048576");
}

#[test]
fn corners_without_texture_coordinates_among_others_are_refused() {
    let expected = "line 6: found a corner without vt, expected one at every corner of every face, or at none";
    assert_refused(format!("{TRIANGLE}vt 0 0\nf 1/1 2/1 3/1\nf 3/1 2 1/1\n"), expected);
    assert_refused(format!("{TRIANGLE}vt 0 0\nf 1/1 2/1 3/1\nf 3 2 1\n"), expected);
}

#[test]
fn texture_indices_without_any_texture_coordinates_are_ignored_with_a_warning() {
    let scene = read(format!("{TRIANGLE}f 1/1/1 2/2/2 3/3/3\n")).unwrap();
    assert_eq!(scene.meshes[0].control_mesh.face_varying, []);
    assert_eq!(scene.warnings[0].to_string(), "faces name vt indices but there are no vt lines: ignored");
}

#[test]
fn warnings_beyond_a_hundred_are_counted() {
    let scene = repair(&format!("{TRIANGLE}f 1 2 3\n{}", "f 1 2\n".repeat(1000)));
    assert_eq!(scene.warnings.len(), 101);
    assert_eq!(scene.warnings[100].to_string(), "900 further warnings are not shown");
}
