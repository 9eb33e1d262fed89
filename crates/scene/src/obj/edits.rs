//! Hierarchical edits: `vertexedit`, `edgeedit` and `faceedit` tags (FAS section 6.3).
//!
//! The ints are, for each edit, a path length p and p ints: a face, then children, then a vertex or an edge (a face edit
//! ends with a child). An operation is three strings, and each edit has the floats of all operations in turn.
use planish_subdiv::mesh::{ControlMesh, EditOperation, HierarchicalEdit};

use super::apply::{finite_sharpness, index, sharpness};
use super::faces::FaceMap;
use super::tags::{Tag, TagKind};
use super::warnings::Warnings;
use crate::error::Fault;

/// Children, corners and edges of a face of any level but the first.
const QUAD_SIDES: usize = 4;

/// Adds the edits of a `vertexedit` or `edgeedit` tag to the mesh.
pub fn component_edits(
    tag: &Tag,
    faces: &FaceMap,
    mesh: &mut ControlMesh,
    warnings: &mut Warnings,
) -> Result<(), Fault> {
    let what = if tag.kind == TagKind::VertexEdit { "vertex" } else { "edge" };
    let paths = paths(tag, faces, 2, what)?;
    let operations = operations(tag)?;
    let stride: usize = operations.iter().map(Operation::float_count).sum();
    if tag.floats.len() < paths.len() * stride {
        let expected = format!("{stride} for each of {} edits", paths.len());
        return Err(Fault::at(tag.line, format!("{} floats", tag.floats.len()), expected));
    }
    let mut offset = 0;
    for operation in &operations {
        for (edit, path) in paths.iter().enumerate() {
            let operation = operation.with_floats(tag, &tag.floats[edit * stride + offset..])?;
            if let Some(path) = current_path(tag, path, faces, warnings) {
                mesh.edits.push(HierarchicalEdit { path, operation });
            }
        }
        offset += operation.float_count();
    }
    Ok(())
}

/// Adds the holes of a `faceedit` tag to the mesh.
pub fn face_edits(tag: &Tag, faces: &FaceMap, mesh: &mut ControlMesh, warnings: &mut Warnings) -> Result<(), Fault> {
    if tag.strings != ["hole"] {
        return Err(Fault::at(tag.line, format!("{:?} in a faceedit", tag.strings), "`hole` alone"));
    }
    for path in paths(tag, faces, 1, "child")? {
        match current_path(tag, &path, faces, warnings) {
            None => {}
            Some(path) if path.len() == 1 => mesh.holes.push(path[0]),
            Some(path) => mesh.edits.push(HierarchicalEdit { path, operation: EditOperation::Hole }),
        }
    }
    Ok(())
}

/// The tag's paths, every entry checked against the face that it is an entry of.
fn paths(tag: &Tag, faces: &FaceMap, least_length: usize, last: &str) -> Result<Vec<Vec<u32>>, Fault> {
    let mut paths = Vec::new();
    let mut rest = tag.ints.as_slice();
    while let Some((&length, after)) = rest.split_first() {
        let entries = usize::try_from(length).ok().filter(|&n| n >= least_length).and_then(|n| after.get(..n));
        let entries = entries.ok_or_else(|| {
            let expected = format!("at least {least_length} and no more than the {} ints that follow", after.len());
            Fault::at(tag.line, format!("a path of length {length}"), expected)
        })?;
        let mut sides = 0;
        let mut path = Vec::with_capacity(entries.len());
        for (depth, &entry) in entries.iter().enumerate() {
            let (limit, what) = match depth {
                0 => (faces.original_sizes.len(), "face"),
                _ if depth + 1 == entries.len() => (sides, last),
                _ => (sides, "child"),
            };
            let entry = index(tag.line, entry, limit, what)?;
            sides = if depth == 0 { faces.original_sizes[entry as usize] as usize } else { QUAD_SIDES };
            path.push(entry);
        }
        paths.push(path);
        rest = &after[entries.len()..];
    }
    if paths.is_empty() {
        return Err(Fault::at(tag.line, "an edit without a path", "a path length and that many ints"));
    }
    Ok(paths)
}

/// The path with the face as it is counted now; none, with a warning, when `repair` dropped it.
fn current_path(tag: &Tag, path: &[u32], faces: &FaceMap, warnings: &mut Warnings) -> Option<Vec<u32>> {
    let Some(face) = faces.get(path[0]) else {
        warnings.push(Some(tag.line), format!("an edit of face {}, which was dropped: ignored", path[0]));
        return None;
    };
    let mut path = path.to_vec();
    path[0] = face;
    Some(path)
}

/// What an edit does, before its floats are known.
struct Operation {
    kind: TagKind,
    modifier: Modifier,
    is_sharpness: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Modifier {
    Set,
    Add,
    Subtract,
}

/// The tag's strings, three an operation.
fn operations(tag: &Tag) -> Result<Vec<Operation>, Fault> {
    let expected = match tag.kind {
        TagKind::VertexEdit => "set, add or subtract, then P, then value or sharpness",
        _ => "set, add or subtract, then P, then sharpness",
    };
    let refused = || Fault::at(tag.line, format!("{:?} in an edit", tag.strings), expected);
    let (operations, []) = tag.strings.as_chunks::<3>() else {
        return Err(refused());
    };
    let parse = |[modifier, variable, target]: &[String; 3]| {
        let modifier = match modifier.as_str() {
            "set" => Modifier::Set,
            "add" => Modifier::Add,
            "subtract" => Modifier::Subtract,
            _ => return Err(refused()),
        };
        let is_sharpness = match target.as_str() {
            "sharpness" => true,
            "value" if tag.kind == TagKind::VertexEdit => false,
            _ => return Err(refused()),
        };
        if variable != "P" {
            return Err(refused());
        }
        Ok(Operation { kind: tag.kind, modifier, is_sharpness })
    };
    if operations.is_empty() {
        return Err(refused());
    }
    operations.iter().map(parse).collect()
}

impl Operation {
    /// Floats of one edit.
    fn float_count(&self) -> usize {
        if self.is_sharpness { 1 } else { 3 }
    }

    /// The operation with its floats, the first ones of `floats`.
    fn with_floats(&self, tag: &Tag, floats: &[f64]) -> Result<EditOperation, Fault> {
        let sign = if self.modifier == Modifier::Subtract { -1.0 } else { 1.0 };
        if !self.is_sharpness {
            let vector = [floats[0], floats[1], floats[2]].map(|float| (sign * float) as f32);
            if !vector.iter().all(|float| float.is_finite()) {
                return Err(Fault::at(tag.line, format!("{:?} in an edit", &floats[..3]), "finite coordinates"));
            }
            return Ok(match self.modifier {
                Modifier::Set => EditOperation::SetPosition(vector),
                Modifier::Add | Modifier::Subtract => EditOperation::AddPosition(vector),
            });
        }
        let is_vertex = self.kind == TagKind::VertexEdit;
        Ok(match (self.modifier, is_vertex) {
            (Modifier::Set, true) => EditOperation::SetVertexSharpness(sharpness(tag.line, floats[0])?),
            (Modifier::Set, false) => EditOperation::SetEdgeSharpness(sharpness(tag.line, floats[0])?),
            (_, true) => EditOperation::AddVertexSharpness(finite_sharpness(sign * floats[0])),
            (_, false) => EditOperation::AddEdgeSharpness(finite_sharpness(sign * floats[0])),
        })
    }
}
