//! Frames that the view selects: exact, covered once and closed, wherever the camera stands.

use std::path::PathBuf;

use planish_tests::cage::Cage;
use planish_tests::judge;
use planish_tests::parallel::check_all;
use planish_tests::repository::{is_about_rules, models, scenes, stem};
use planish_tests::view::Place;

/// Pixels an edge, with an image in which densities stay moderate; beside it a spacing.
const WAYS: [&str; 3] = [
    "--edge-pixels 16 --size 160x90",
    "--edge-pixels 4 --size 96x54 --spacing equal",
    "--edge-pixels 1.5 --size 48x27 --spacing fractional-even",
];

/// Every pair of a place and a way, or with `PLANISH_ALL_VIEWS` unset three of them by turns.
fn cases() -> Vec<(PathBuf, Place, &'static str)> {
    let every = std::env::var_os("PLANISH_ALL_VIEWS").is_some();
    let meshes = [scenes(), models()].concat();
    let mut cases = Vec::new();
    for (index, mesh) in meshes.into_iter().enumerate() {
        for (p, place) in Place::ALL.into_iter().enumerate() {
            for (w, way) in WAYS.into_iter().enumerate() {
                let turn = (index + p + w) % 3;
                if every || turn == 0 && (!is_about_rules(&mesh) || p == index / 3 % 3) {
                    cases.push((mesh.clone(), place, way));
                }
            }
        }
    }
    cases
}

#[test]
fn dynamic_dumps_are_the_limit_surface_and_closed_from_odd_places() {
    check_all(&cases(), |(mesh, place, way)| {
        let flags = format!("{way} {}", place.flags(&Cage::read(mesh)));
        // So far from the origin floats are as far apart as the shortest edges are long.
        let is_coarse = stem(mesh) == "far_from_origin";
        if is_coarse { judge::check_but_edges(mesh, &flags).map(drop) } else { judge::check(mesh, &flags) }
    });
}
