//! Frames in which densities vary, with the view or by tags: exact, covered once and closed, wherever the camera stands.

use std::fs;
use std::path::{Path, PathBuf};

use planish_tests::cage::Cage;
use planish_tests::folder::temporary;
use planish_tests::judge;
use planish_tests::parallel::check_all;
use planish_tests::repository::{is_about_rules, models, scenes};
use planish_tests::view::Place;

/// Pixels an edge, with an image in which densities stay moderate; beside it a spacing.
const WAYS: [&str; 3] = [
    "--edge-pixels 16 --size 160x90",
    "--edge-pixels 4 --size 96x54 --spacing equal",
    "--edge-pixels 1.5 --size 48x27 --spacing fractional-even",
];

/// Every pair of a place and a way, or with `PLANISH_ALL_VIEWS` unset one or two of them by turns.
fn cases() -> Vec<(PathBuf, Place, &'static str)> {
    let every = std::env::var_os("PLANISH_ALL_VIEWS").is_some();
    let meshes = [scenes(), models()].concat();
    let mut cases = Vec::new();
    for (index, mesh) in meshes.into_iter().enumerate() {
        for (p, place) in Place::ALL.into_iter().enumerate() {
            for (w, way) in WAYS.into_iter().enumerate() {
                // Places by threes, and then one half of the meshes after the other.
                let turn = (index + p + w) % 3;
                let is_in_turn = turn == 0 && (index / 3 + p) % 2 == 0;
                if every || is_in_turn && (!is_about_rules(&mesh) || p == index / 3 % 3) {
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
        judge::check(mesh, &flags)
    });
}

/// Factors on the density of one vertex after the other, in no order.
const DENSITIES: [&str; 7] = ["1", "0.3", "8", "0", "2.7", "0.9", "5"];
const SPACINGS: [&str; 3] = ["equal", "fractional-odd", "fractional-even"];

/// Writes a mesh with a density for each vertex.
fn write_dense(mesh: &Path, folder: &Path) -> PathBuf {
    let vertex_count = Cage::read(mesh).positions.len();
    let vertices: String = (0..vertex_count).map(|vertex| format!(" {vertex}")).collect();
    // Squares modulo a prime: neighbours differ, whatever the mesh's order is.
    let density = |vertex: usize| DENSITIES[(vertex * vertex % 101 + vertex / 3) % DENSITIES.len()];
    let densities: String = (0..vertex_count).map(|vertex| format!(" {}", density(vertex))).collect();
    let text = fs::read_to_string(mesh).expect("scenes can be read");
    let path = folder.join(mesh.file_name().expect("a scene has a name"));
    let tag = format!("t density {vertex_count}/{vertex_count}/0{vertices}{densities}");
    fs::write(&path, format!("{text}\n{tag}\n")).expect("a temporary file can be written");
    path
}

#[test]
fn dumps_of_meshes_with_densities_are_the_limit_surface_and_closed() {
    let mut cases: Vec<_> = [scenes(), models()].concat().into_iter().zip(SPACINGS.into_iter().cycle()).collect();
    // Of scenes that differ in rules alone every second.
    let mut rules = 0;
    cases.retain(|(mesh, _)| {
        rules += usize::from(is_about_rules(mesh));
        !is_about_rules(mesh) || rules.is_multiple_of(2)
    });
    check_all(&cases, |(mesh, spacing)| {
        let folder = temporary();
        let flags = format!("--tess 3 --spacing {spacing}");
        let mesh = write_dense(mesh, folder.path());
        judge::check(&mesh, &flags)
    });
}
