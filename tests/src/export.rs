//! Cages to files of other formats, as exporters write them.

use std::fs;
use std::path::Path;

use planish_subdiv::ControlMesh;
use serde_json::{Value, json};

/// A cage as glTF with the extension `FB_ngon_encoding` and a buffer beside it: faces become fans of triangles that share their first
/// vertex, and vertices are split, one for each corner of a triangle, as exporters do where normals or texture coordinates differ.
/// So no two fans in a row begin at the same index, which is how the extension tells them apart. Creases, corners and holes are extras.
pub fn write_gltf(mesh: &ControlMesh, path: &Path) {
    // Corners in the order of their vertices: the reader numbers vertices as it first meets them.
    let mut split: Vec<u32> = mesh.face_vertices.clone();
    let mut order: Vec<usize> = (0..split.len()).collect();
    order.sort_by_key(|&corner| split[corner]);
    let mut place = vec![0_u32; split.len()];
    order.iter().zip(0..).for_each(|(&corner, at)| place[corner] = at);
    split.sort_unstable();
    let (mut positions, mut indices) = (Vec::<u8>::new(), Vec::<u8>::new());
    let mut first = 0;
    for face in faces(mesh) {
        let corners = &place[first..first + face.len()];
        first += face.len();
        for pair in corners[1..].windows(2) {
            [corners[0], pair[0], pair[1]].iter().for_each(|index| indices.extend(index.to_le_bytes()));
        }
    }
    for &vertex in &split {
        mesh.positions[vertex as usize].iter().for_each(|c| positions.extend(c.to_le_bytes()));
    }
    // Extras count vertices as they are written: any of a vertex' copies stands for it.
    let copy = |vertex: u32| split.iter().position(|&of| of == vertex).expect("a vertex of a face");
    let creases: Vec<Value> =
        mesh.creases.iter().map(|c| json!([copy(c.vertices[0]), copy(c.vertices[1]), c.sharpness])).collect();
    let corners: Vec<Value> = mesh.corners.iter().map(|c| json!([copy(c.vertex), c.sharpness])).collect();
    let (position_bytes, index_bytes) = (positions.len(), indices.len());
    let buffer = path.with_extension("bin");
    fs::write(&buffer, [positions, indices].concat()).unwrap();
    let file = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["FB_ngon_encoding"],
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{
            "primitives": [{
                "attributes": { "POSITION": 0 }, "indices": 1, "extensions": { "FB_ngon_encoding": {} }
            }],
            "extras": { "planish": { "creases": creases, "corners": corners, "holes": mesh.holes } },
        }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": split.len(), "type": "VEC3" },
            { "bufferView": 1, "componentType": 5125, "count": index_bytes / 4, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": position_bytes },
            { "buffer": 0, "byteOffset": position_bytes, "byteLength": index_bytes },
        ],
        "buffers": [{ "uri": buffer.file_name().unwrap().to_str().unwrap(), "byteLength": position_bytes + index_bytes }],
    });
    fs::write(path, file.to_string()).unwrap();
}

/// A cage as a text file of USD.
pub fn write_usda(mesh: &ControlMesh, path: &Path) {
    let list = |items: Vec<String>| items.join(", ");
    let numbers = |values: &[u32]| list(values.iter().map(u32::to_string).collect());
    let points = mesh.positions.iter().map(|[x, y, z]| format!("({x}, {y}, {z})")).collect();
    let crease_vertices: Vec<u32> = mesh.creases.iter().flat_map(|crease| crease.vertices).collect();
    let crease_lengths = vec![2; mesh.creases.len()];
    let corners: Vec<u32> = mesh.corners.iter().map(|corner| corner.vertex).collect();
    let text = format!(
        "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    upAxis = \"Y\"\n)\n\ndef Mesh \"mesh\"\n{{\n    \
         point3f[] points = [{}]\n    int[] faceVertexCounts = [{}]\n    int[] faceVertexIndices = [{}]\n    \
         int[] creaseIndices = [{}]\n    int[] creaseLengths = [{}]\n    float[] creaseSharpnesses = [{}]\n    \
         int[] cornerIndices = [{}]\n    float[] cornerSharpnesses = [{}]\n    int[] holeIndices = [{}]\n}}\n",
        list(points),
        numbers(&mesh.face_sizes),
        numbers(&mesh.face_vertices),
        numbers(&crease_vertices),
        numbers(&crease_lengths),
        list(mesh.creases.iter().map(|crease| crease.sharpness.to_string()).collect()),
        numbers(&corners),
        list(mesh.corners.iter().map(|corner| corner.sharpness.to_string()).collect()),
        numbers(&mesh.holes),
    );
    fs::write(path, text).unwrap();
}

/// The faces of a cage.
fn faces(mesh: &ControlMesh) -> impl Iterator<Item = &[u32]> {
    let mut first = 0;
    mesh.face_sizes.iter().map(move |&sides| {
        first += sides as usize;
        &mesh.face_vertices[first - sides as usize..first]
    })
}
