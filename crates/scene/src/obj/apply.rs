//! Tags to the mesh's creases, corners, holes, densities and options. A later tag overrides an earlier one.
use std::collections::HashSet;

use planish_subdiv::mesh::{
    BoundaryInterpolation, ControlMesh, Corner, Crease, Creasing, FaceVaryingInterpolation, INFINITE_SHARPNESS,
    TriangleSubdivision, VertexInterpolation,
};

use super::edits;
use super::faces::FaceMap;
use super::lines::quoted;
use super::tags::{Tag, TagKind};
use super::warnings::Warnings;
use crate::error::Fault;

/// Applies a file's tags to its mesh, in file order.
pub fn apply(tags: &[Tag], faces: &FaceMap, mesh: &mut ControlMesh, warnings: &mut Warnings) -> Result<(), Fault> {
    let mut crease_lines = Vec::new();
    for tag in tags {
        match tag.kind {
            TagKind::Crease => {
                creases(tag, mesh)?;
                crease_lines.resize(mesh.creases.len(), tag.line);
            }
            TagKind::Corner => corners(tag, mesh)?,
            TagKind::Hole => holes(tag, faces, mesh, warnings)?,
            TagKind::InterpolateBoundary => mesh.options.boundary = boundary(tag)?,
            TagKind::FaceVaryingInterpolateBoundary => mesh.options.face_varying = face_varying(tag)?,
            TagKind::CreaseMethod => {
                let methods = [("normal", Creasing::Uniform), ("chaikin", Creasing::Chaikin)];
                mesh.options.creasing = keyword(tag, methods)?;
            }
            TagKind::SmoothTriangles => {
                let rules = [("catmark", TriangleSubdivision::CatmullClark), ("smooth", TriangleSubdivision::Smooth)];
                mesh.options.triangles = keyword(tag, rules)?;
            }
            TagKind::VertexEdit | TagKind::EdgeEdit => edits::component_edits(tag, faces, mesh, warnings)?,
            TagKind::FaceEdit => edits::face_edits(tag, faces, mesh, warnings)?,
            TagKind::Density => densities(tag, mesh)?,
            TagKind::ColorInterpolation => color_interpolation(tag, mesh, warnings)?,
        }
    }
    drop_creases_without_edge(mesh, &crease_lines, warnings);
    Ok(())
}

/// `crease`: the edges of a polyline of vertices, with one sharpness or one an edge.
fn creases(tag: &Tag, mesh: &mut ControlMesh) -> Result<(), Fault> {
    if tag.ints.len() < 2 {
        return Err(Fault::at(tag.line, format!("a crease of {} vertices", tag.ints.len()), "2 or more"));
    }
    no_strings(tag)?;
    let sharpness = sharpnesses(tag, tag.ints.len() - 1, "edge")?;
    let vertices = indices(tag, mesh.positions.len(), "vertex")?;
    for (edge, pair) in vertices.windows(2).enumerate() {
        mesh.creases.push(Crease { vertices: [pair[0], pair[1]], sharpness: sharpness(edge) });
    }
    Ok(())
}

/// `corner`: vertices, with one sharpness or one a vertex.
fn corners(tag: &Tag, mesh: &mut ControlMesh) -> Result<(), Fault> {
    if tag.ints.is_empty() {
        return Err(Fault::at(tag.line, "a corner of 0 vertices", "1 or more"));
    }
    no_strings(tag)?;
    let sharpness = sharpnesses(tag, tag.ints.len(), "vertex")?;
    for (corner, vertex) in indices(tag, mesh.positions.len(), "vertex")?.into_iter().enumerate() {
        mesh.corners.push(Corner { vertex, sharpness: sharpness(corner) });
    }
    Ok(())
}

/// `hole`: faces that are not drawn.
fn holes(tag: &Tag, faces: &FaceMap, mesh: &mut ControlMesh, warnings: &mut Warnings) -> Result<(), Fault> {
    no_strings(tag)?;
    if tag.ints.is_empty() || !tag.floats.is_empty() {
        let found = format!("a hole of {} faces and {} floats", tag.ints.len(), tag.floats.len());
        return Err(Fault::at(tag.line, found, "1 or more faces and no floats"));
    }
    for face in indices(tag, faces.original_sizes.len(), "face")? {
        match faces.get(face) {
            Some(face) => mesh.holes.push(face),
            None => warnings.push(Some(tag.line), format!("a hole in face {face}, which was dropped: ignored")),
        }
    }
    Ok(())
}

/// `density`: vertices, with one factor on the tessellation density or one a vertex. Other vertices keep 1.
fn densities(tag: &Tag, mesh: &mut ControlMesh) -> Result<(), Fault> {
    if tag.ints.is_empty() {
        return Err(Fault::at(tag.line, "a density of 0 vertices", "1 or more"));
    }
    no_strings(tag)?;
    one_or_one_each(tag, tag.ints.len(), "density", "vertex")?;
    let vertices = indices(tag, mesh.positions.len(), "vertex")?;
    mesh.density.resize(mesh.positions.len(), 1.0);
    for (vertex, &value) in vertices.into_iter().zip(tag.floats.iter().cycle()) {
        let density = value as f32;
        if !(density.is_finite() && density >= 0.0) {
            return Err(Fault::at(tag.line, format!("density {value}"), "0 or more, finite in 32-bit floating point"));
        }
        mesh.density[vertex as usize] = density;
    }
    Ok(())
}

/// `colorinterpolation`: what lies between the colours of vertices.
fn color_interpolation(tag: &Tag, mesh: &mut ControlMesh, warnings: &mut Warnings) -> Result<(), Fault> {
    let interpolation = match option_value(tag)? {
        0 => VertexInterpolation::Vertex,
        1 => VertexInterpolation::Varying,
        other => return Err(Fault::at(tag.line, format!("colour interpolation {other}"), "0 or 1")),
    };
    match &mut mesh.colors {
        Some(colors) => colors.interpolation = interpolation,
        None => warnings.push(Some(tag.line), "colour interpolation, but no vertex has a colour: ignored"),
    }
    Ok(())
}

fn boundary(tag: &Tag) -> Result<BoundaryInterpolation, Fault> {
    match option_value(tag)? {
        0 => Ok(BoundaryInterpolation::None),
        1 => Ok(BoundaryInterpolation::EdgeAndCorner),
        2 => Ok(BoundaryInterpolation::EdgeOnly),
        other => Err(Fault::at(tag.line, format!("boundary interpolation {other}"), "0, 1 or 2")),
    }
}

fn face_varying(tag: &Tag) -> Result<FaceVaryingInterpolation, Fault> {
    match option_value(tag)? {
        0 => Ok(FaceVaryingInterpolation::None),
        1 => Ok(FaceVaryingInterpolation::CornersOnly),
        2 => Ok(FaceVaryingInterpolation::CornersPlus1),
        3 => Ok(FaceVaryingInterpolation::CornersPlus2),
        4 => Ok(FaceVaryingInterpolation::Boundaries),
        5 => Ok(FaceVaryingInterpolation::All),
        other => Err(Fault::at(tag.line, format!("face-varying interpolation {other}"), "0 to 5")),
    }
}

/// The one integer of an option's tag.
fn option_value(tag: &Tag) -> Result<i64, Fault> {
    match (tag.ints.as_slice(), tag.floats.len(), tag.strings.len()) {
        (&[value], 0, 0) => Ok(value),
        _ => Err(wrong_counts(tag, "1/0/0")),
    }
}

/// The one string of an option's tag, looked up.
fn keyword<T: Copy>(tag: &Tag, choices: [(&str, T); 2]) -> Result<T, Fault> {
    let (0, 0, [word]) = (tag.ints.len(), tag.floats.len(), tag.strings.as_slice()) else {
        return Err(wrong_counts(tag, "0/0/1"));
    };
    let choice = choices.iter().find(|(name, _)| name == word);
    choice.map(|&(_, value)| value).ok_or_else(|| {
        Fault::at(tag.line, quoted(word.as_bytes()), format!("`{}` or `{}`", choices[0].0, choices[1].0))
    })
}

fn no_strings(tag: &Tag) -> Result<(), Fault> {
    match tag.strings.len() {
        0 => Ok(()),
        count => Err(Fault::at(tag.line, format!("a tag with {count} strings"), "none")),
    }
}

fn wrong_counts(tag: &Tag, expected: &str) -> Fault {
    let found = format!("{}/{}/{}", tag.ints.len(), tag.floats.len(), tag.strings.len());
    Fault::at(tag.line, format!("a tag with {found} values"), expected)
}

/// The tag's ints as indices below `count`.
fn indices(tag: &Tag, count: usize, what: &str) -> Result<Vec<u32>, Fault> {
    tag.ints.iter().map(|&int| index(tag.line, int, count, what)).collect()
}

/// An index below `count`, which fits 32 bits.
pub fn index(line: u32, int: i64, count: usize, what: &str) -> Result<u32, Fault> {
    u32::try_from(int)
        .ok()
        .filter(|&index| (index as usize) < count)
        .ok_or_else(|| Fault::at(line, format!("{what} {int} in a tag"), format!("0 to {}", count.saturating_sub(1))))
}

/// The tag's floats as `count` sharpnesses: one for all, or one each.
fn sharpnesses(tag: &Tag, count: usize, what: &str) -> Result<impl Fn(usize) -> f32 + use<>, Fault> {
    one_or_one_each(tag, count, "sharpness", what)?;
    let values: Result<Vec<f32>, Fault> = tag.floats.iter().map(|&value| sharpness(tag.line, value)).collect();
    let values = values?;
    Ok(move |index: usize| values[index.min(values.len() - 1)])
}

/// Refuses a tag that has neither one float for all nor one for each of `count`.
fn one_or_one_each(tag: &Tag, count: usize, value: &str, each: &str) -> Result<(), Fault> {
    if tag.floats.len() == 1 || tag.floats.len() == count {
        return Ok(());
    }
    let found = format!("{} {value} values for {count}", tag.floats.len());
    Err(Fault::at(tag.line, found, format!("one, or one for each {each}")))
}

/// A sharpness that is not negative.
pub fn sharpness(line: u32, value: f64) -> Result<f32, Fault> {
    if value < 0.0 {
        return Err(Fault::at(line, format!("sharpness {value}"), "0 or more"));
    }
    Ok(finite_sharpness(value))
}

/// A sharpness as a float; beyond the floats' range it is infinite sharpness anyway, whose number is finite.
pub fn finite_sharpness(value: f64) -> f32 {
    let rounded = value as f32;
    if rounded.is_finite() { rounded } else { INFINITE_SHARPNESS.copysign(rounded) }
}

/// Drops the creases whose two vertices no edge joins, as OpenSubdiv does.
fn drop_creases_without_edge(mesh: &mut ControlMesh, crease_lines: &[u32], warnings: &mut Warnings) {
    if mesh.creases.is_empty() {
        return;
    }
    let sorted = |a: u32, b: u32| (a.min(b), a.max(b));
    let mut on_crease = vec![false; mesh.positions.len()];
    for crease in &mesh.creases {
        on_crease[crease.vertices[0] as usize] = true;
        on_crease[crease.vertices[1] as usize] = true;
    }
    let mut edges = HashSet::new();
    let mut rest = mesh.face_vertices.as_slice();
    for &size in &mesh.face_sizes {
        let (face, after) = rest.split_at(size as usize);
        rest = after;
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            if on_crease[a as usize] && on_crease[b as usize] {
                edges.insert(sorted(a, b));
            }
        }
    }
    let mut lines = crease_lines.iter();
    mesh.creases.retain(|&Crease { vertices: [a, b], .. }| {
        let line = lines.next().copied();
        let joined = edges.contains(&sorted(a, b));
        if !joined {
            warnings.push(line, format!("a crease from vertex {a} to {b}, which no edge joins: ignored"));
        }
        joined
    });
}
