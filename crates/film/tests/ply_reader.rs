//! Dumps that are read are those that were written, or refused with one line.

use std::fs;
use std::path::{Path, PathBuf};

use planish_film::{DumpProperties, DumpVertex, read_ply_stream, write_ply_stream};
use tempfile::TempDir;

fn vertex(i: u8) -> DumpVertex {
    let f = f32::from(i);
    DumpVertex {
        position: [f, -f, 0.1],
        normal: [0.0, -0.0, f32::INFINITY],
        uv: [0.25, f / 8.0],
        face: i32::from(i) - 2,
        level: i,
        kind: 5,
        tex_coord: [f, 0.5],
        shading_normal: [0.0, f, -1.0],
        color: [2.0, f, -0.5],
    }
}

fn read(path: &Path) -> Result<Vec<DumpVertex>, String> {
    let mut vertices = Vec::new();
    read_ply_stream(path, |vertex| vertices.push(vertex)).map_err(|error| error.to_string())?;
    Ok(vertices)
}

/// A dump of two triangles, as bytes; and the file that variants of it are written to.
fn dump(properties: DumpProperties) -> (TempDir, PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dump.ply");
    write_ply_stream(&path, 6, properties, (0..6).map(vertex)).unwrap();
    let bytes = fs::read(&path).unwrap();
    (folder, path, bytes)
}

#[test]
fn what_was_written_is_read() {
    for bits in 0..8 {
        let [tex_coords, shading_normals, colors] = [1, 2, 4].map(|bit| bits & bit != 0);
        let (_folder, path, _) = dump(DumpProperties { tex_coords, shading_normals, colors });
        let expected = (0..6).map(vertex).map(|vertex| DumpVertex {
            tex_coord: if tex_coords { vertex.tex_coord } else { [0.0; 2] },
            shading_normal: if shading_normals { vertex.shading_normal } else { [0.0; 3] },
            color: if colors { vertex.color } else { [0.0; 3] },
            ..vertex
        });
        assert_eq!(read(&path).unwrap(), expected.collect::<Vec<_>>());
    }
}

#[test]
fn every_truncation_is_refused_and_so_is_more() {
    let (_folder, path, bytes) = dump(DumpProperties::default());
    for length in 0..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let message = read(&path).expect_err("it is cut");
        assert!(message.contains("dump.ply: found") && !message.contains('\n'), "{message}");
    }
    fs::write(&path, [&bytes[..], b"\n"].concat()).unwrap();
    assert!(read(&path).unwrap_err().ends_with("found bytes after the last triangle, expected none"));
}

#[test]
fn headers_of_other_files_are_refused_with_what_is_missing() {
    let (_folder, path, bytes) = dump(DumpProperties::default());
    let text = String::from_utf8_lossy(&bytes[..bytes.len() - 6 * 38 - 2 * 13]).into_owned();
    let cases = [
        ("ply\n", "obj\n", "found a file that is no PLY, expected a dump"),
        ("ply\n", "plywood\n", "found a file that is no PLY, expected a dump"),
        ("binary_little_endian", "ascii", "expected format binary_little_endian 1.0"),
        ("property float u\n", "", "found vertices without u, expected x y z nx ny nz u v face level kind"),
        ("property int face\n", "", "found vertices without face"),
        ("float x\n", "double x\n", "found property double x, expected property float x"),
        ("float y\n", "float x\n", "found property x twice, expected it once"),
        ("float y\n", "list uchar int y\n", "expected a scalar property"),
        ("element face 2", "element face 3", "found 6 vertices and 3 triangles, expected three vertices a triangle"),
        ("element vertex 6", "element vertex -6", "found \"element vertex -6\", expected element vertex and a count"),
        ("uchar int vertex", "uchar short vertex", "expected property list uchar int vertex_indices"),
        ("end_header", "element edge 1\nend_header", "found \"element edge 1\", expected end_header"),
    ];
    for (old, new, words) in cases {
        let header = text.replace(old, new);
        assert_ne!(header, text);
        fs::write(&path, [header.as_bytes(), &bytes[text.len()..]].concat()).unwrap();
        let message = read(&path).expect_err(new);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn nothing_is_allocated_for_what_a_header_claims() {
    let (_folder, path, bytes) = dump(DumpProperties::default());
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let end = text.find("end_header\n").unwrap() + "end_header\n".len();
    let claims = text[..end].replace("vertex 6", "vertex 18446744073709551615");
    let claims = claims.replace("face 2", "face 6148914691236517205");
    fs::write(&path, [claims.as_bytes(), &bytes[end..]].concat()).unwrap();
    let message = read(&path).unwrap_err();
    assert!(message.contains("found the end of the file in vertex"), "{message}");
}

#[test]
fn properties_may_come_in_another_order_among_others() {
    let (_folder, path, bytes) = dump(DumpProperties::default());
    let header_end = bytes.len() - 6 * 38 - 2 * 13;
    let text = String::from_utf8_lossy(&bytes[..header_end]).into_owned();
    let text = text.replace("property uchar level\nproperty uchar kind\n", "");
    let text = text.replace(
        "property float x\n",
        "comment moved\nproperty uint8 level\nproperty uint8 kind\nproperty double w\nproperty float x\n",
    );
    let rows = bytes[header_end..header_end + 6 * 38].chunks_exact(38);
    let rows: Vec<u8> = rows.flat_map(|row| [&row[36..], &[7; 8], &row[..36]].concat()).collect();
    fs::write(&path, [text.as_bytes(), &rows, &bytes[header_end + 6 * 38..]].concat()).unwrap();
    let mut expected: Vec<_> = (0..6).map(vertex).collect();
    for vertex in &mut expected {
        (vertex.tex_coord, vertex.shading_normal, vertex.color) = ([0.0; 2], [0.0; 3], [0.0; 3]);
    }
    assert_eq!(read(&path).unwrap(), expected);
}

#[test]
fn a_file_that_is_not_there_is_told() {
    let folder = tempfile::tempdir().unwrap();
    assert!(read(&folder.path().join("none.ply")).unwrap_err().starts_with("cannot read "));
    assert!(read(folder.path()).unwrap_err().starts_with("cannot read "));
}
