//! Triangle soups to PLY, byte by byte.

use std::fs;

use planish_film::{DumpProperties, DumpVertex, write_ply, write_ply_stream};

fn vertex(i: u32) -> DumpVertex {
    let f = i as f32;
    DumpVertex {
        position: [f, -f, 0.1],
        normal: [f32::NAN, -0.0, f32::INFINITY],
        uv: [0.25, f / 8.0],
        face: -7 + i as i32,
        level: i as u8,
        kind: 5,
        tex_coord: [f, 0.5],
        shading_normal: [0.0, f, -1.0],
        color: [2.0, f, -0.5],
    }
}

const HEADER_OF_TWO_TRIANGLES: &str = "ply
format binary_little_endian 1.0
element vertex 6
property float x
property float y
property float z
property float nx
property float ny
property float nz
property float u
property float v
property int face
property uchar level
property uchar kind
element face 2
property list uchar int vertex_indices
end_header
";

/// The body as the format's words put it, one field after the other.
fn body(vertices: &[DumpVertex]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for vertex in vertices {
        for value in vertex.position.iter().chain(&vertex.normal).chain(&vertex.uv) {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend(vertex.face.to_le_bytes());
        bytes.extend([vertex.level, vertex.kind]);
    }
    for triangle in 0..vertices.len() as i32 / 3 {
        bytes.push(3);
        for corner in 0..3 {
            bytes.extend((3 * triangle + corner).to_le_bytes());
        }
    }
    bytes
}

#[test]
fn two_triangles_are_these_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dump.ply");
    let vertices: Vec<_> = (0..6).map(vertex).collect();
    write_ply(&path, &vertices).unwrap();
    let expected = [HEADER_OF_TWO_TRIANGLES.as_bytes(), &body(&vertices)].concat();
    assert_eq!(fs::read(&path).unwrap(), expected);
    assert_eq!(expected.len(), HEADER_OF_TWO_TRIANGLES.len() + 6 * 38 + 2 * 13);
}

#[test]
fn a_stream_gives_the_bytes_of_the_slice() {
    let folder = tempfile::tempdir().unwrap();
    let (slice, stream) = (folder.path().join("slice.ply"), folder.path().join("stream.ply"));
    // More than one buffer of the writer.
    let vertex_count = 90_000;
    write_ply(&slice, &(0..vertex_count).map(vertex).collect::<Vec<_>>()).unwrap();
    write_ply_stream(&stream, u64::from(vertex_count), DumpProperties::default(), (0..vertex_count).map(vertex))
        .unwrap();
    assert!(fs::read(slice).unwrap() == fs::read(stream).unwrap());
}

#[test]
fn no_triangles_are_a_valid_dump() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("empty.ply");
    write_ply(&path, &[]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("element vertex 0\n") && text.contains("element face 0\n") && text.ends_with("end_header\n"));
}

#[test]
fn wrong_counts_are_refused_and_leave_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dump.ply");
    let message = |announced: u64, found: u32| {
        let error = write_ply_stream(&path, announced, DumpProperties::default(), (0..found).map(vertex))
            .unwrap_err()
            .to_string();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{error}");
        error.replace(&path.display().to_string(), "dump.ply")
    };
    assert_eq!(message(4, 4), "cannot write dump.ply: 4 vertices are not whole triangles");
    assert_eq!(message(6, 5), "cannot write dump.ply: 6 vertices were announced, but the stream has 5");
    assert_eq!(message(3, 9), "cannot write dump.ply: 3 vertices were announced, but the stream has more");
    assert_eq!(
        message(2_147_483_649, 0),
        "cannot write dump.ply: 2147483649 vertices are more than the 2147483647 that PLY indices reach"
    );
}

#[test]
fn texture_coordinates_shading_normals_and_colours_follow_where_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for bits in 0..8 {
        let [tex_coords, shading_normals, colors] = [1, 2, 4].map(|bit| bits & bit != 0);
        let properties = DumpProperties { tex_coords, shading_normals, colors };
        let path = folder.path().join("dump.ply");
        write_ply_stream(&path, 3, properties, (0..3).map(vertex)).unwrap();
        let bytes = fs::read(&path).unwrap();
        let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
        let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let names: Vec<&str> = header.lines().filter_map(|line| line.strip_prefix("property float ")).skip(8).collect();
        let mut expected: Vec<f32> = Vec::new();
        let mut expected_names = Vec::new();
        if properties.tex_coords {
            expected.extend(vertex(2).tex_coord);
            expected_names.extend(["s", "t"]);
        }
        if properties.shading_normals {
            expected.extend(vertex(2).shading_normal);
            expected_names.extend(["sx", "sy", "sz"]);
        }
        if properties.colors {
            expected.extend(vertex(2).color);
            expected_names.extend(["r", "g", "b"]);
        }
        assert_eq!(names, expected_names);
        // What is last of the third vertex lies before the one triangle.
        let last = bytes.len() - 13;
        let expected: Vec<u8> = expected.into_iter().flat_map(f32::to_le_bytes).collect();
        assert_eq!(&bytes[last - expected.len()..last], expected);
    }
}
