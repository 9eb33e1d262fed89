//! Hierarchical edits of a mesh under construction (FAS section 6.3).
use glam::DVec3;

use crate::cage::Cage;

/// Where an edit is: a base face, a child from level to level, and at last a vertex or an edge of that face, or the
/// child that is edited itself. A child is the one at its parent's corner of that number, and a child of a quad has its
/// corners where its parent has them.
pub type Path = Vec<u32>;

impl Cage {
    /// The mesh with vertices put elsewhere.
    pub fn with_vertices_set(self, edits: &[(Path, DVec3)]) -> Self {
        self.with_positions("set", edits)
    }

    /// The mesh with vertices moved.
    pub fn with_vertices_moved(self, edits: &[(Path, DVec3)]) -> Self {
        self.with_positions("add", edits)
    }

    fn with_positions(mut self, operation: &str, edits: &[(Path, DVec3)]) -> Self {
        let floats: Vec<f64> = edits.iter().flat_map(|(_, vector)| vector.to_array().map(rounded)).collect();
        let paths = edits.iter().map(|(path, _)| path);
        self.tag("vertexedit", &ints(paths), &floats, &[operation, "P", "value"]);
        self
    }

    /// The mesh with `set`, `add` or `subtract` done to the sharpness of vertices.
    pub fn with_vertex_sharpness(self, operation: &str, edits: &[(Path, f64)]) -> Self {
        self.with_sharpness("vertexedit", operation, edits)
    }

    /// The mesh with `set`, `add` or `subtract` done to the sharpness of edges.
    pub fn with_edge_sharpness(self, operation: &str, edits: &[(Path, f64)]) -> Self {
        self.with_sharpness("edgeedit", operation, edits)
    }

    fn with_sharpness(mut self, tag: &str, operation: &str, edits: &[(Path, f64)]) -> Self {
        let floats: Vec<f64> = edits.iter().map(|&(_, sharpness)| sharpness).collect();
        self.tag(tag, &ints(edits.iter().map(|(path, _)| path)), &floats, &[operation, "P", "sharpness"]);
        self
    }

    /// The mesh with faces of finer levels that are not drawn.
    pub fn with_fine_holes(mut self, paths: &[Path]) -> Self {
        self.tag("faceedit", &ints(paths.iter()), &[], &["hole"]);
        self
    }
}

/// The path to the vertex of a level that lies at (u, v) of a base face that is a quad, both in units of 2^-level.
///
/// # Panics
/// If the point is outside.
pub fn path_to_vertex(face: u32, level: u32, u: u32, v: u32) -> Path {
    let size = 1 << level;
    assert!(u <= size && v <= size, "({u}, {v}) is outside of a face of {size} x {size} children");
    // The face of the level whose corner the vertex is: the one that begins there, or the last of its row or column.
    let (column, row) = (u.min(size - 1), v.min(size - 1));
    let mut path = path_to_face(face, level, column, row);
    path.push(corner(u - column, v - row));
    path
}

/// The path to the face of a level that begins at (u, v) of a base face that is a quad, both in units of 2^-level.
pub fn path_to_face(face: u32, level: u32, u: u32, v: u32) -> Path {
    let child = |bit: u32| corner(u >> bit & 1, v >> bit & 1);
    [face].into_iter().chain((0..level).rev().map(child)).collect()
}

/// The corner of a quad at (u, v).
fn corner(u: u32, v: u32) -> u32 {
    match (u, v) {
        (0, 0) => 0,
        (1, 0) => 1,
        (1, 1) => 2,
        _ => 3,
    }
}

/// Every path after its length.
fn ints<'a>(paths: impl Iterator<Item = &'a Path>) -> Vec<u32> {
    paths.flat_map(|path| [path.len() as u32].into_iter().chain(path.iter().copied())).collect()
}

/// A coordinate with as many decimals as those of vertices.
fn rounded(value: f64) -> f64 {
    let scale = 1e5;
    // Adding 0 makes 0 of -0.
    (value * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_follow_the_quarters() {
        assert_eq!(path_to_vertex(7, 0, 1, 1), [7, 2]);
        assert_eq!(path_to_vertex(7, 1, 1, 1), [7, 2, 0]);
        assert_eq!(path_to_vertex(7, 1, 2, 0), [7, 1, 1]);
        assert_eq!(path_to_vertex(7, 2, 1, 2), [7, 3, 1, 0]);
        assert_eq!(path_to_face(7, 2, 3, 2), [7, 2, 1]);
    }
}
