//! Creases, corners, holes and options of UsdGeomMesh. What is not authored is as the schema says.
use std::collections::HashSet;

use planish_subdiv::mesh::{
    BoundaryInterpolation, ControlMesh, Corner, Crease, FaceVaryingInterpolation, INFINITE_SHARPNESS, MeshOptions,
    TriangleSubdivision,
};

use super::attributes::Attributes;
use super::convert;
use super::faces::{Faces, below};
use crate::gltf::fault::Fault;
use crate::obj::Warnings;

/// Reads the tags of a cage whose faces are there.
pub fn apply(
    attributes: &Attributes,
    faces: &Faces,
    mesh: &mut ControlMesh,
    warnings: &mut Warnings,
) -> Result<(), Fault> {
    let scheme = attributes.get("subdivisionScheme", "a token", convert::token)?;
    mesh.options = options(attributes)?;
    match scheme.as_deref() {
        None | Some("catmullClark") => {
            creases(attributes, mesh)?;
            corners(attributes, mesh)?;
            drop_creases_without_edge(attributes, mesh, warnings);
        }
        Some(scheme @ ("none" | "bilinear")) => {
            let text = format!("subdivisionScheme {scheme}: all edges and vertices are infinitely sharp");
            warnings.push(None, format!("{}: {text}", attributes.path()));
            sharpen(mesh);
        }
        Some(scheme) => {
            let expected = "catmullClark, bilinear or none";
            return Err(attributes.fault("subdivisionScheme", format!("{scheme:?}"), expected));
        }
    }
    for face in attributes.get("holeIndices", "int[]", convert::integers)?.unwrap_or_default() {
        let kept = usize::try_from(face).ok().and_then(|face| faces.kept.get(face));
        let expected = || below(faces.kept.len(), "faces");
        let kept = kept.ok_or_else(|| attributes.fault("holeIndices", format!("face {face}"), expected()))?;
        mesh.holes.extend(kept);
    }
    Ok(())
}

fn options(attributes: &Attributes) -> Result<MeshOptions, Fault> {
    let boundaries = [
        ("edgeAndCorner", BoundaryInterpolation::EdgeAndCorner),
        ("edgeOnly", BoundaryInterpolation::EdgeOnly),
        ("none", BoundaryInterpolation::None),
    ];
    let face_varying = [
        ("cornersPlus1", FaceVaryingInterpolation::CornersPlus1),
        ("cornersPlus2", FaceVaryingInterpolation::CornersPlus2),
        ("cornersOnly", FaceVaryingInterpolation::CornersOnly),
        ("boundaries", FaceVaryingInterpolation::Boundaries),
        ("all", FaceVaryingInterpolation::All),
        ("none", FaceVaryingInterpolation::None),
    ];
    let triangles = [("catmullClark", TriangleSubdivision::CatmullClark), ("smooth", TriangleSubdivision::Smooth)];
    Ok(MeshOptions {
        boundary: keyword(attributes, "interpolateBoundary", &boundaries)?,
        face_varying: keyword(attributes, "faceVaryingLinearInterpolation", &face_varying)?,
        triangles: keyword(attributes, "triangleSubdivisionRule", &triangles)?,
        ..MeshOptions::default()
    })
}

/// The option that a token names; the first without one.
fn keyword<T: Copy>(attributes: &Attributes, name: &str, words: &[(&str, T)]) -> Result<T, Fault> {
    let token = attributes.get(name, "a token", convert::token)?;
    let token = token.as_deref().unwrap_or(words[0].0);
    let known = words.iter().find(|(word, _)| *word == token);
    known.map(|&(_, value)| value).ok_or_else(|| {
        let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        attributes.fault(name, format!("{token:?}"), format!("one of {}", words.join(", ")))
    })
}

/// Polylines of vertices, with a sharpness each, or one an edge of all.
fn creases(attributes: &Attributes, mesh: &mut ControlMesh) -> Result<(), Fault> {
    let lengths = attributes.get("creaseLengths", "int[]", convert::integers)?.unwrap_or_default();
    let vertices = vertices(attributes, "creaseIndices", mesh.positions.len())?;
    let sharpnesses = sharpnesses(attributes, "creaseSharpnesses")?;
    if let Some(length) = lengths.iter().find(|&&length| length < 2) {
        return Err(attributes.fault("creaseLengths", format!("a crease of {length} vertices"), "2 or more"));
    }
    let total = lengths.iter().try_fold(0i64, |sum, &length| sum.checked_add(length));
    if total != Some(vertices.len() as i64) {
        let expected = total.map_or_else(|| "fewer".to_owned(), |total| total.to_string());
        let found = format!("{} vertices", vertices.len());
        return Err(attributes.fault("creaseIndices", found, format!("the {expected} of creaseLengths")));
    }
    let edge_count = vertices.len() - lengths.len();
    let is_per_edge = sharpnesses.len() == edge_count;
    if !is_per_edge && sharpnesses.len() != lengths.len() {
        let found = format!("{} sharpnesses", sharpnesses.len());
        let expected = format!("one for each of {} creases or {edge_count} edges", lengths.len());
        return Err(attributes.fault("creaseSharpnesses", found, expected));
    }
    let mut rest = vertices.as_slice();
    for (crease, &length) in lengths.iter().enumerate() {
        let (line, after) = rest.split_at(length as usize);
        rest = after;
        for pair in line.windows(2) {
            let sharpness = sharpnesses[if is_per_edge { mesh.creases.len() } else { crease }];
            mesh.creases.push(Crease { vertices: [pair[0], pair[1]], sharpness });
        }
    }
    Ok(())
}

fn corners(attributes: &Attributes, mesh: &mut ControlMesh) -> Result<(), Fault> {
    let vertices = vertices(attributes, "cornerIndices", mesh.positions.len())?;
    let sharpnesses = sharpnesses(attributes, "cornerSharpnesses")?;
    if vertices.len() != sharpnesses.len() {
        let found = format!("{} sharpnesses", sharpnesses.len());
        return Err(attributes.fault(
            "cornerSharpnesses",
            found,
            format!("one for each of {} corners", vertices.len()),
        ));
    }
    let corners = vertices.into_iter().zip(sharpnesses);
    mesh.corners.extend(corners.map(|(vertex, sharpness)| Corner { vertex, sharpness }));
    Ok(())
}

fn vertices(attributes: &Attributes, name: &str, count: usize) -> Result<Vec<u32>, Fault> {
    let indices = attributes.get(name, "int[]", convert::integers)?.unwrap_or_default();
    let vertex = |index: i64| {
        let vertex = u32::try_from(index).ok().filter(|&vertex| (vertex as usize) < count);
        vertex.ok_or_else(|| attributes.fault(name, format!("vertex {index}"), below(count, "points")))
    };
    indices.into_iter().map(vertex).collect()
}

fn sharpnesses(attributes: &Attributes, name: &str) -> Result<Vec<f32>, Fault> {
    let values = attributes.get(name, "float[]", convert::numbers)?.unwrap_or_default();
    let sharpness = |value: f64| match value {
        // Beyond the floats' range it is infinite sharpness anyway, whose number is finite.
        value if value >= 0.0 => Ok(if (value as f32).is_finite() { value as f32 } else { INFINITE_SHARPNESS }),
        _ => Err(attributes.fault(name, format!("sharpness {value}"), "0 or more")),
    };
    values.into_iter().map(sharpness).collect()
}

/// Makes all edges and vertices infinitely sharp: the limit surface is bilinear.
fn sharpen(mesh: &mut ControlMesh) {
    let mut seen = HashSet::new();
    for_edges(&mesh.face_sizes, &mesh.face_vertices, |a, b| {
        if seen.insert((a.min(b), a.max(b))) {
            mesh.creases.push(Crease { vertices: [a, b], sharpness: INFINITE_SHARPNESS });
        }
    });
    let vertices = 0..mesh.positions.len() as u32;
    mesh.corners.extend(vertices.map(|vertex| Corner { vertex, sharpness: INFINITE_SHARPNESS }));
}

/// Drops the creases whose two vertices no edge joins, as OpenSubdiv does.
fn drop_creases_without_edge(attributes: &Attributes, mesh: &mut ControlMesh, warnings: &mut Warnings) {
    if mesh.creases.is_empty() {
        return;
    }
    let mut edges = HashSet::new();
    for_edges(&mesh.face_sizes, &mesh.face_vertices, |a, b| {
        edges.insert((a.min(b), a.max(b)));
    });
    mesh.creases.retain(|&Crease { vertices: [a, b], .. }| {
        let is_edge = edges.contains(&(a.min(b), a.max(b)));
        if !is_edge {
            let text = format!("a crease from vertex {a} to {b}, which no edge joins: ignored");
            warnings.push(None, format!("{}: {text}", attributes.path()));
        }
        is_edge
    });
}

fn for_edges(sizes: &[u32], vertices: &[u32], mut edge: impl FnMut(u32, u32)) {
    let mut rest = vertices;
    for &size in sizes {
        let (face, after) = rest.split_at(size as usize);
        rest = after;
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            edge(a, b);
        }
    }
}
