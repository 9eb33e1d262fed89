//! Sharp vertices, alone and on creases.
use super::SceneFile;
use super::parts::{disc_center, discs, sheet, stars};
use crate::cage::Cage;
use crate::sheets;
use crate::tags::{BoundaryRule, INFINITE};

/// Valences of the sharp vertices inside.
const VALENCES: [u32; 3] = [4, 3, 5];

pub fn files() -> Vec<SceneFile> {
    let inside = |name: &str, sharpness: f64| {
        let comment = format!("Vertices of valence 4, 3 and 5 with sharpness {sharpness}.");
        SceneFile::new(name, comment, with_corners(discs(&VALENCES), sharpness))
    };
    let and_crease = |name: &str, corner: f64, crease: f64| {
        let comment = format!("Vertices of sharpness {corner} on creases of sharpness {crease}.");
        SceneFile::new(name, comment, with_corners(stars(&VALENCES, &[crease; 2]), corner))
    };
    let boundary = |rule| {
        let points = [(-2.0, -1.0, 2.3), (2.0, 0.0, INFINITE), (-2.0, 2.0, INFINITE), (2.0, 2.0, 1.5), (0.0, 2.0, 0.3)];
        let sharpen = |cage: Cage, (x, z, sharpness)| cage.cornered_above(x, z, sharpness);
        points.into_iter().fold(sheets::waved_grid(4, 4), sharpen).with_boundary(rule)
    };
    vec![
        inside("corner_0_3", 0.3),
        inside("corner_2_3", 2.3),
        inside("corner_9_9", 9.9),
        inside("corner_infinite", INFINITE),
        and_crease("corner_1_5_crease_2_3", 1.5, 2.3),
        and_crease("corner_2_3_crease_1_5", 2.3, 1.5),
        and_crease("corner_2_3_crease_infinite", 2.3, INFINITE),
        and_crease("corner_infinite_crease_1_5", INFINITE, 1.5),
        SceneFile::new(
            "corner_dart",
            "A vertex of sharpness 1.5 at the end of a crease of sharpness 2.3, and the other way round.",
            sheet()
                .creased_above(&[[-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]], 2.3)
                .cornered_above(1.0, -1.0, 1.5)
                .creased_above(&[[-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]], 1.5)
                .cornered_above(1.0, 1.0, 2.3),
        ),
        SceneFile::new(
            "corner_neighbours",
            "Neighbouring vertices of sharpness 3.7, 1.5 and infinite.",
            sheet().cornered_above(-1.0, 0.0, 3.7).cornered_above(0.0, 0.0, 1.5).cornered_above(0.0, 1.0, INFINITE),
        ),
        SceneFile::new(
            "corner_boundary",
            "Sharp vertices on the boundary of a sheet.",
            boundary(BoundaryRule::EdgeAndCorner),
        ),
        SceneFile::new(
            "corner_boundary_edge_only",
            "Sharp vertices on a boundary of which only edges are sharp by themselves.",
            boundary(BoundaryRule::EdgeOnly),
        ),
    ]
}

/// Discs with sharp middles.
fn with_corners(discs: Cage, sharpness: f64) -> Cage {
    (0..VALENCES.len() as u32).fold(discs, |cage, place| cage.cornered_above(disc_center(place), 0.0, sharpness))
}
