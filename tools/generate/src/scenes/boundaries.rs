//! Boundary rules with creases.
use super::SceneFile;
use super::parts::sheet;
use crate::cage::Cage;
use crate::sheets;
use crate::tags::{BoundaryRule, INFINITE};

pub fn files() -> Vec<SceneFile> {
    let quad = || {
        let cage = sheets::waved_grid(1, 1);
        let edges = cage.edges();
        cage.creased_edges(&edges, &[INFINITE])
    };
    vec![
        SceneFile::new(
            "boundary_none_creased",
            "Boundary rule none: faces live where all boundary edges at their vertices are infinitely sharp.",
            creased().with_boundary(BoundaryRule::None),
        ),
        SceneFile::new(
            "boundary_edge_only_creased",
            "Boundary rule edge only, and creases inside and on the boundary.",
            creased().with_boundary(BoundaryRule::EdgeOnly),
        ),
        SceneFile::new(
            "boundary_edge_and_corner_creased",
            "Boundary rule edge and corner, and creases inside and on the boundary.",
            creased().with_boundary(BoundaryRule::EdgeAndCorner),
        ),
        SceneFile::new(
            "boundary_none_quad",
            "Boundary rule none, and a quad whose edges are all infinitely sharp.",
            quad().with_boundary(BoundaryRule::None),
        ),
        SceneFile::new(
            "boundary_none_corner",
            "Boundary rule none, and infinitely sharp vertices on the boundary.",
            sheets::waved_grid(4, 4)
                .cornered_above(-2.0, -2.0, INFINITE)
                .cornered_above(-1.0, -2.0, INFINITE)
                .cornered_above(2.0, 0.0, 2.3)
                .with_boundary(BoundaryRule::None),
        ),
    ]
}

/// A sheet, sharp along its far and left sides and semi-sharp on the right, with creases that reach the boundary.
fn creased() -> Cage {
    let across: [f64; 7] = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0];
    sheet()
        .creased_above(&across.map(|x| [x, -3.0]), INFINITE)
        .creased_above(&across.map(|z| [-3.0, z]), INFINITE)
        .creased_above(&across.map(|z| [3.0, z]), 2.3)
        .creased_above(&[[0.0, -3.0], [0.0, -2.0], [0.0, -1.0], [1.0, -1.0]], 1.5)
        .creased_above(&[[-3.0, 0.0], [-2.0, 0.0], [-1.0, 0.0]], INFINITE)
        .creased_above(&[[3.0, 3.0], [2.0, 3.0]], 3.7)
}
