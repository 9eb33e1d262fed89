//! What `planish dump` writes is OpenSubdiv's limit surface, covers every face once and meets edge to edge: at one factor for
//! all edges.

use std::path::{Path, PathBuf};

use planish_tests::folder::temporary;
use planish_tests::judge;
use planish_tests::oracle::Report;
use planish_tests::parallel::check_all;
use planish_tests::program::Planish;
use planish_tests::repository::{is_about_rules, models, scene, scenes, stem};

/// Judges the dumps of meshes with each of these flags.
fn check_meshes(flags: &[&str], is_wanted: impl Fn(&Path) -> bool) {
    let mut meshes = [scenes(), models()].concat();
    meshes.retain(|mesh| is_wanted(mesh));
    check_cases(&meshes, flags);
}

fn check_cases(meshes: &[PathBuf], flags: &[&str]) {
    let cases: Vec<_> = meshes.iter().flat_map(|mesh| flags.iter().map(move |flags| (mesh, *flags))).collect();
    check_all(&cases, |(mesh, flags)| judge::check(mesh, flags));
}

fn is_shape(mesh: &Path) -> bool {
    !is_about_rules(mesh)
}

#[test]
fn fractional_odd_dumps_of_every_mesh_are_the_closed_limit_surface() {
    check_meshes(&["--tess 13.7"], is_shape);
    check_meshes(&["--tess 7.3"], is_about_rules);
}

#[test]
fn dumps_of_every_mesh_at_factor_1_are_the_closed_limit_surface() {
    // Rules do not change what a patch of one segment is, and are judged at another factor: half of those scenes.
    let mut rules = 0;
    let mut meshes = [scenes(), models()].concat();
    meshes.retain(|mesh| {
        rules += usize::from(is_about_rules(mesh));
        is_shape(mesh) || rules.is_multiple_of(2)
    });
    check_cases(&meshes, &["--tess 1"]);
}

#[test]
fn equal_dumps_of_every_shape_are_the_closed_limit_surface() {
    check_meshes(&["--tess 8 --spacing equal"], is_shape);
}

#[test]
fn fractional_even_dumps_of_every_shape_are_the_closed_limit_surface() {
    check_meshes(&["--tess 5.3 --spacing fractional-even"], is_shape);
}

#[test]
fn static_dumps_of_every_shape_are_the_closed_limit_surface() {
    check_meshes(&["--method fas --edge-pixels 4 --size 160x90 --max-level 4"], is_shape);
}

#[test]
fn dumps_cut_short_by_the_largest_level_are_the_closed_limit_surface() {
    check_meshes(&["--tess 9.4 --max-level 1 --spacing fractional-even"], is_shape);
}

#[test]
fn dumps_with_other_crease_patches_are_the_closed_limit_surface() {
    let flags = ["--tess 5.3 --crease-patches single", "--tess 5.3 --crease-patches none"];
    check_meshes(&flags, |mesh| stem(mesh).starts_with("crease_") || stem(mesh).starts_with("cube_all"));
}

#[test]
fn whole_odd_and_largest_factors_beside_transitions_are_the_closed_limit_surface() {
    let mesh = [scene("adjacent_extraordinary")];
    check_cases(
        &mesh,
        &["--tess 1.5", "--tess 2", "--tess 1.5 --spacing fractional-even", "--tess 2.5 --spacing equal"],
    );
    check_cases(&[scene("valence_5")], &["--tess 64 --spacing fractional-even", "--tess 62", "--tess 63"]);
}

#[test]
fn patches_cut_into_pieces_are_the_closed_limit_surface() {
    for spacing in ["equal", "fractional-odd", "fractional-even"] {
        // All of the cube's patches of level 1 are cut, and of the other's those that are not beside the vertex.
        check_cases(&[scene("cube")], &[&format!("--tess 200 --spacing {spacing}")]);
        check_cases(&[scene("valence_5")], &[&format!("--tess 100.3 --spacing {spacing}")]);
    }
    check_cases(&[scene("single_quad")], &["--tess 300.7"]);
}

#[test]
fn another_surface_is_not_taken_for_the_limit_surface() {
    let folder = temporary();
    let dump = folder.path().join("dump.ply");
    Planish::dump(&scene("boundary_edge_only"), &dump).flags("--tess 3").run().silent_success().unwrap();
    let same = Report::of(&scene("boundary_edge_only"), &dump).unwrap();
    assert_eq!(same.faults(0), Vec::<String>::new());
    let other = Report::of(&scene("boundary_edge_and_corner"), &dump).unwrap();
    let faults = other.faults(0);
    assert!(faults.iter().any(|fault| fault.starts_with("max_pos_err_rel")), "{faults:?}");
}
