//! Hierarchical edits (FAS section 6.3): where they reach, and what they change.
//!
//! An edit names a component by a path: a base face, then a child at each level. On the way down the faces on the path
//! and all around them are split whether or not they are irregular, so that at the edit's level every patch that sees
//! the component is one of that level.

use crate::error::Error;
use crate::mesh::{ControlMesh, EditOperation, HierarchicalEdit, INFINITE_SHARPNESS};
use crate::refine::MAX_LEVEL;
use crate::topology::Level;

/// A change of one point of a level: p becomes `keep` p + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointEdit {
    /// The point: of a level, or (in tables) of all levels.
    pub point: u32,
    /// 0 where the position was set, else 1.
    pub keep: f32,
    /// What is added.
    pub offset: [f32; 3],
}

/// The place of an edit: the level whose components it names.
pub fn edit_level(edit: &HierarchicalEdit) -> u32 {
    let below = if edit.operation == EditOperation::Hole { 1 } else { 2 };
    (edit.path.len() as u32).saturating_sub(below)
}

/// The deepest level that a mesh has edits at, or 0.
pub fn deepest_level(mesh: &ControlMesh) -> u32 {
    mesh.edits.iter().map(edit_level).max().unwrap_or(0)
}

/// Checks that every path has the right length and that its entries exist.
pub(crate) fn validate(mesh: &ControlMesh) -> Result<(), Error> {
    // Several may add to one point: together they are held to the bound of a coordinate.
    let mut total = 0.0_f32;
    for (index, edit) in (0..).zip(&mesh.edits) {
        let is_hole = edit.operation == EditOperation::Hole;
        if edit.path.len() < 2 {
            return Err(Error::EditPath { edit: index });
        }
        if edit_level(edit) > MAX_LEVEL {
            return Err(Error::MaxLevel { asked: edit_level(edit), max: MAX_LEVEL });
        }
        let face = edit.path[0];
        let sides = mesh.face_sizes.get(face as usize).copied();
        let mut sides =
            sides.ok_or(Error::OutOfRange { what: "face of an edit", index: face, count: mesh.face_count() })?;
        for (depth, &entry) in edit.path.iter().enumerate().skip(1) {
            if entry >= sides {
                let is_last = depth + 1 == edit.path.len() && !is_hole;
                let what = if is_last { "vertex or edge of an edit" } else { "child of an edit" };
                return Err(Error::OutOfRange { what, index: entry, count: sides });
            }
            sides = 4;
        }
        let (value, sharpness) = match edit.operation {
            EditOperation::SetPosition(p) | EditOperation::AddPosition(p) => (p, 0.0),
            EditOperation::SetVertexSharpness(s)
            | EditOperation::AddVertexSharpness(s)
            | EditOperation::SetEdgeSharpness(s)
            | EditOperation::AddEdgeSharpness(s) => ([0.0; 3], s),
            EditOperation::Hole => ([0.0; 3], 0.0),
        };
        total += value.iter().fold(0.0, |m: f32, c| m.max(c.abs()));
        let is_bounded = value.iter().all(|c| c.is_finite()) && total <= crate::mesh::MAX_COORDINATE;
        if !is_bounded || sharpness.is_nan() {
            return Err(Error::EditValue { edit: index });
        }
    }
    Ok(())
}

/// A mesh's edits on their way down the levels.
#[derive(Clone, Debug)]
pub(crate) struct PathEdits<'a> {
    edits: &'a [HierarchicalEdit],
    /// Of each edit, the face of the current level on its path, until its own level is reached.
    faces: Vec<u32>,
    level: u32,
}

impl<'a> PathEdits<'a> {
    /// At level 0.
    pub fn new(mesh: &'a ControlMesh) -> Self {
        Self { edits: &mesh.edits, faces: mesh.edits.iter().map(|edit| edit.path[0]).collect(), level: 0 }
    }

    /// Applies what the current level's edits say of sharpness and holes; returns its points' edits, by its vertices,
    /// with the number of the edit.
    pub fn apply(&self, level: &mut Level) -> Vec<(u32, u32)> {
        let mut moved = Vec::new();
        for (index, (edit, &face)) in (0..).zip(self.edits.iter().zip(&self.faces)) {
            if edit_level(edit) != self.level {
                continue;
            }
            let last = edit.path.last().copied().unwrap_or(0);
            let half_edge = level.half_edges(face).start + last;
            match edit.operation {
                EditOperation::SetPosition(_) | EditOperation::AddPosition(_) => {
                    moved.push((level.origin(half_edge), index));
                }
                EditOperation::SetVertexSharpness(s) => set_vertex_sharpness(level, half_edge, |_| s),
                EditOperation::AddVertexSharpness(s) => set_vertex_sharpness(level, half_edge, |old| old + s),
                EditOperation::SetEdgeSharpness(s) => set_edge_sharpness(level, half_edge, |_| s),
                EditOperation::AddEdgeSharpness(s) => set_edge_sharpness(level, half_edge, |old| old + s),
                EditOperation::Hole => {
                    level.hidden.resize(level.face_count() as usize, false);
                    level.hidden[face as usize] = true;
                }
            }
        }
        level.sum_semi_sharp_edges();
        moved
    }

    /// The faces of the current level that must be split because an edit of a finer level reaches them, ascending: those
    /// on its path and all that touch them, so that neighbours differ by one level; but the parent of a hole alone.
    pub fn forced_faces(&self, level: &Level) -> Vec<u32> {
        let (mut forced, mut vertices) = (Vec::new(), Vec::new());
        for (edit, &face) in self.edits.iter().zip(&self.faces).filter(|(edit, _)| edit_level(edit) > self.level) {
            forced.push(face);
            if edit.operation != EditOperation::Hole || edit_level(edit) > self.level + 1 {
                vertices.extend(level.vertices(face));
            }
        }
        vertices.sort_unstable();
        vertices.dedup();
        let around = vertices.into_iter().flat_map(|vertex| level.all_spokes(vertex));
        forced.extend(around.map(|spoke| level.face(spoke)));
        forced.sort_unstable();
        forced.dedup();
        forced
    }

    /// Goes down one level, whose faces are the children of these (ascending) in their order.
    pub fn descend(&mut self, parent: &Level, split_faces: &[u32]) {
        let mut first_child = Vec::with_capacity(split_faces.len());
        let mut next = 0;
        for &face in split_faces {
            first_child.push(next);
            next += parent.sides(face);
        }
        for (edit, face) in self.edits.iter().zip(&mut self.faces).filter(|(edit, _)| edit_level(edit) > self.level) {
            // Faces on paths are forced, so they are among those split.
            if let Ok(place) = split_faces.binary_search(face) {
                *face = first_child[place] + edit.path[self.level as usize + 1];
            }
        }
        self.level += 1;
    }
}

/// Combines the edits of one point, in their order.
pub(crate) fn combine(point: u32, operations: impl Iterator<Item = EditOperation>) -> PointEdit {
    let mut result = PointEdit { point, keep: 1.0, offset: [0.0; 3] };
    for operation in operations {
        match operation {
            EditOperation::SetPosition(p) => (result.keep, result.offset) = (0.0, p),
            EditOperation::AddPosition(p) => result.offset = std::array::from_fn(|c| result.offset[c] + p[c]),
            _ => {}
        }
    }
    result
}

fn set_vertex_sharpness(level: &mut Level, half_edge: u32, change: impl Fn(f32) -> f32) {
    let vertex = level.origin(half_edge);
    let sharpness = change(level.vertex_sharpness(vertex)).clamp(0.0, INFINITE_SHARPNESS);
    level.vertex_sharpness.resize(level.tags.len(), 0.0);
    level.vertex_sharpness[vertex as usize] = sharpness;
    level.tags[vertex as usize] = level.vertex_tag(vertex).with_values_of(level.tag(vertex));
}

fn set_edge_sharpness(level: &mut Level, half_edge: u32, change: impl Fn(f32) -> f32) {
    // What is infinitely sharp by its topology stays so.
    if level.is_unpaired(half_edge) {
        return;
    }
    let sharpness = change(level.sharpness(half_edge)).clamp(0.0, INFINITE_SHARPNESS);
    level.edge_sharpness.resize(level.origins.len(), 0.0);
    for side in [half_edge, level.twin(half_edge)] {
        level.edge_sharpness[side as usize] = sharpness;
    }
    for vertex in [level.origin(half_edge), level.head(half_edge)] {
        level.tags[vertex as usize] = level.vertex_tag(vertex).with_values_of(level.tag(vertex));
    }
}
