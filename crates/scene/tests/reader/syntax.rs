//! What an OBJ file may look like.
use crate::common::{CUBE, mesh, read};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn cube_is_read_as_it_stands() {
    let mesh = mesh(CUBE);
    assert_eq!(mesh.control_mesh.positions.len(), 8);
    assert_eq!(mesh.control_mesh.positions[5], [1.0, 1.0, -1.0]);
    assert_eq!(mesh.control_mesh.face_sizes, [4; 6]);
    assert_eq!(mesh.control_mesh.face_vertices[4..8], [2, 3, 5, 4]);
    assert_eq!(mesh.control_mesh.face_varying, []);
    mesh.control_mesh.validate().unwrap();
}

#[test]
fn scene_takes_the_stem_and_the_mesh_the_first_object_name() {
    let scene = read(CUBE).unwrap();
    assert_eq!((scene.name.as_str(), scene.meshes[0].name.as_str()), ("name", "name"));
    let named = read(format!("o\no first one\no second\n{CUBE}")).unwrap();
    assert_eq!((named.name.as_str(), named.meshes[0].name.as_str()), ("name", "first one"));
}

#[test]
fn groups_objects_and_materials_do_not_split_the_mesh() {
    let text = format!("mtllib x.mtl\n{TRIANGLE}o a\ng b c\ns 1\nusemtl m\nf 1 2 3\no d\ns off\nf 3 2 1\n");
    assert_eq!(mesh(text).control_mesh.face_sizes, [3, 3]);
}

#[test]
fn unknown_keywords_are_ignored() {
    assert_eq!(mesh(format!("{TRIANGLE}vp 1\nl 1 2\ncurv2 0 1\n!x y\nvn 0 0 z\nf 1 2 3")).control_mesh.face_sizes, [3]);
}

#[test]
fn line_ends_blank_lines_comments_and_byte_order_mark_do_not_matter() {
    let plain = mesh(CUBE);
    let crlf = CUBE.replace('\n', "\r\n");
    let spaced = CUBE.replace('\n', "  \n\n \t\n").replace(' ', " \t ");
    let commented = format!("# caf\u{e9}\n{}", CUBE.replace('\n', " # 1 2 3\n#f 9 9 9\n"));
    let marked = format!("\u{feff}{CUBE}");
    let cut = CUBE.trim_end().to_owned();
    for text in [crlf, spaced, commented, marked, cut] {
        assert_eq!(mesh(&text), plain, "{text}");
    }
}

#[test]
fn bytes_that_are_not_utf8_are_tolerated_in_comments_and_names() {
    let mut text = b"# caf\xe9\no na\xefve\ng \xff\xfe\n".to_vec();
    text.extend_from_slice(CUBE.as_bytes());
    assert_eq!(mesh(&text).name, "na\u{fffd}ve");
}

#[test]
fn backslash_continues_a_line() {
    assert_eq!(mesh(format!("{TRIANGLE}f 1\\\n 2 \\\r\n3 \\\n")).control_mesh.face_vertices, [0, 1, 2]);
}

#[test]
fn faces_may_have_any_number_of_sides() {
    let vertices: String = (0..1000).map(|i| format!("v {i} {} 0\n", i * i)).collect();
    let indices: String = (1..=1000).map(|i| format!(" {i}")).collect();
    let mesh = mesh(format!("{vertices}f 1 2 3\nf 4 5 6 7 8\nf{indices}\n"));
    assert_eq!(mesh.control_mesh.face_sizes, [3, 5, 1000]);
    assert_eq!(mesh.control_mesh.face_vertices.len(), 1008);
}

#[test]
fn negative_indices_count_back_from_the_vertices_so_far() {
    let text = format!("{TRIANGLE}f -3 -2 -1\n{TRIANGLE}f -3 -2 -1\n");
    assert_eq!(mesh(text).control_mesh.face_vertices, [0, 1, 2, 3, 4, 5]);
}

#[test]
fn faces_may_come_before_their_vertices() {
    assert_eq!(mesh(format!("f 1 2 3\n{TRIANGLE}")).control_mesh.face_vertices, [0, 1, 2]);
}

#[test]
fn corners_may_have_texture_coordinates_and_normals() {
    for face in ["f 1/1 2/2 3/3", "f 1/1/1 2/2/2 3/3/9", "f 1/-3/-1 2/-2/ 3/-1"] {
        let mesh = mesh(format!("{TRIANGLE}vt 0.25\nvt 0.5 0.75\nvt 1 1 0\n{face}\n"));
        let uv = &mesh.control_mesh.face_varying[0];
        assert_eq!(uv.name, "st");
        assert_eq!(uv.values, [[0.25, 0.0], [0.5, 0.75], [1.0, 1.0]]);
        assert_eq!(uv.indices, [0, 1, 2]);
    }
    assert_eq!(mesh(format!("{TRIANGLE}vt 0 0\nf 1//1 2//1 3//1\n")).control_mesh.face_varying, []);
}

#[test]
fn texture_coordinates_are_indexed_apart_from_vertices() {
    let mesh = mesh(format!("{TRIANGLE}vt 0 0\nvt 1 0\nvt 0 1\nf 1/3 2/3 3/1\n"));
    let uv = &mesh.control_mesh.face_varying[0];
    assert_eq!((uv.values.len(), uv.indices.as_slice()), (3, [2, 2, 0].as_slice()));
}

#[test]
fn one_two_or_more_than_three_components_after_the_third_are_ignored() {
    let text = "v 0 0 0 1\nv 1 0 0 0.5 y\nv 0 1 0 x\nv 0 0 1 1 1 1 1\nf 1 2 3\n";
    let mesh = mesh(text).control_mesh;
    assert_eq!((mesh.positions[1], mesh.colors), ([1.0, 0.0, 0.0], None));
}

#[test]
fn numbers_may_have_exponents_signs_and_bare_points() {
    let text = "v 1e2 -2.5E-3 +.5\nv 1. 0 -0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(mesh(text).control_mesh.positions[0], [100.0, -0.0025, 0.5]);
}

#[test]
fn coordinates_are_rounded_to_double_first_and_to_float_then() {
    // Above the middle between 1 and the next float by less than half a double's step: rounding twice gives 1.
    let text = "v 1.000000059604644775390625000001 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(mesh(text).control_mesh.positions[0][0], 1.0);
    assert_eq!("1.000000059604644775390625000001".parse::<f32>(), Ok(1.000_000_1));
}
