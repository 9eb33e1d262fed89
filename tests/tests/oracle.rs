//! What `planish dump` writes is OpenSubdiv's limit surface.

use std::fs;
use std::path::{Path, PathBuf};

use planish_tests::cage::Cage;
use planish_tests::oracle::{AREA_TOLERANCE, Report};
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;
use planish_tests::repository::{models, scene, scenes, stem};

/// One dump to compare.
struct Case {
    mesh: PathBuf,
    tess: &'static str,
    spacing: &'static str,
}

/// Every mesh at every tess factor, with one spacing.
fn cases(meshes: &[PathBuf], factors: &[&'static str], spacing: &'static str) -> Vec<Case> {
    let case = |mesh: &PathBuf, &tess| Case { mesh: mesh.clone(), tess, spacing };
    meshes.iter().flat_map(|mesh| factors.iter().map(move |tess| case(mesh, tess))).collect()
}

/// Meshes of `scenes/` that OpenSubdiv can subdivide: it has no hierarchical edits.
fn judged_scenes() -> Vec<PathBuf> {
    scenes().into_iter().filter(|mesh| !stem(mesh).starts_with("edit_")).collect()
}

/// Those of them that have no tags, but for the boundary's.
fn plain_scenes() -> Vec<PathBuf> {
    let is_tag = |line: &str| line.starts_with("t ") && !line.contains("interpolateboundary");
    let is_plain = |mesh: &PathBuf| !fs::read_to_string(mesh).expect("scenes can be read").lines().any(is_tag);
    judged_scenes().into_iter().filter(is_plain).collect()
}

/// The oracle takes most of the time: where there are many points it judges every so many faces. The stride is prime to
/// the number of faces in a sector and in a row, so that each place there is judged somewhere.
fn judged_stride(case: &Case) -> usize {
    match (stem(&case.mesh), case.tess) {
        ("valence_360", _) => 29,
        (_, "16") => 7,
        (_, "7.3" | "8") => 3,
        _ => 1,
    }
}

/// Surfaces that are folded flat have no normal along whole edges.
fn is_folded(mesh: &Path) -> bool {
    ["double_sided_quad", "flat_pair"].contains(&stem(mesh))
}

/// Unless each face is covered once if it is drawn, and not at all if it is not: which is not.
fn check_coverage(areas: &[f64], is_drawn: &[bool]) -> Result<(), String> {
    for (face, (area, &is_drawn)) in areas.iter().zip(is_drawn).enumerate() {
        let expected = if is_drawn { 1.0 } else { 0.0 };
        if (area - expected).abs() > AREA_TOLERANCE {
            return Err(format!("expected face {face} to be covered {expected} times, not {area}"));
        }
    }
    Ok(())
}

fn check(case: &Case) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let dump = folder.path().join("dump.ply");
    let flags = format!("--tess {} --spacing {}", case.tess, case.spacing);
    let outcome = Planish::dump(&case.mesh, &dump).flags(&flags).run().silent_success()?;
    let is_drawn = Cage::read(&case.mesh).drawn_ptex_faces();
    let all = Dump::read(&dump)?;
    check_coverage(&all.covered_areas(is_drawn.len())?, &is_drawn).map_err(|fault| outcome.told(&fault))?;
    let is_judged = |stride: usize| is_drawn.iter().step_by(stride).any(|&is_drawn| is_drawn);
    let stride = Some(judged_stride(case)).filter(|&stride| is_judged(stride)).unwrap_or(1);
    let (mut judged, mut absent_faces) = (dump, 0);
    if stride > 1 {
        judged = folder.path().join("judged.ply");
        all.write_faces(&judged, |face| (face as usize).is_multiple_of(stride))?;
        absent_faces = (0..is_drawn.len()).filter(|&face| is_drawn[face] && !face.is_multiple_of(stride)).count();
    }
    let report = Report::of(&case.mesh, &judged)?;
    let faults = if is_folded(&case.mesh) {
        report.faults_but_degenerate_normals(absent_faces)
    } else {
        report.faults(absent_faces)
    };
    if faults.is_empty() { Ok(()) } else { Err(outcome.told(&faults.join("\n  "))) }
}

#[test]
fn fractional_odd_dumps_of_every_scene_are_the_limit_surface() {
    let mut all = cases(&judged_scenes(), &["16", "7.3", "4", "1"], "fractional-odd");
    all.extend(cases(&plain_scenes(), &["13.7", "8", "3"], "fractional-odd"));
    check_all(&all, check);
}

#[test]
fn equal_dumps_of_every_scene_are_the_limit_surface() {
    let mut all = cases(&plain_scenes(), &["8"], "equal");
    all.extend(cases(&judged_scenes(), &["3"], "equal"));
    check_all(&all, check);
}

#[test]
fn fractional_even_dumps_of_every_scene_are_the_limit_surface() {
    let mut all = cases(&plain_scenes(), &["8"], "fractional-even");
    all.extend(cases(&judged_scenes(), &["3"], "fractional-even"));
    check_all(&all, check);
}

#[test]
fn dumps_of_the_models_are_the_limit_surface() {
    check_all(&cases(&models(), &["13.7", "8", "3", "1"], "fractional-odd"), check);
}

#[test]
fn patches_at_the_largest_factor_are_the_limit_surface() {
    let closed = [scene("torus_32"), scene("cube")];
    let mut all = cases(&closed, &["64"], "equal");
    all.extend(cases(&[scene("torus_32")], &["64"], "fractional-even"));
    all.extend(cases(&[scene("torus_32")], &["63"], "fractional-odd"));
    check_all(&all, check);
}

#[test]
fn unusual_factors_beside_transitions_give_the_limit_surface() {
    let mesh = [scene("adjacent_extraordinary")];
    let mut all = cases(&[scene("valence_5")], &["64"], "fractional-even");
    all.extend(cases(&[scene("valence_5")], &["63", "62"], "fractional-odd"));
    all.extend(cases(&mesh, &["1", "1.5", "2", "2.5"], "fractional-odd"));
    all.extend(cases(&mesh, &["1", "1.5", "2.5"], "fractional-even"));
    all.extend(cases(&mesh, &["1.5", "2.5", "5"], "equal"));
    check_all(&all, check);
}

#[test]
fn another_surface_is_not_taken_for_the_limit_surface() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let dump = folder.path().join("dump.ply");
    Planish::dump(&scene("boundary_edge_only"), &dump).flags("--tess 3").run().silent_success().unwrap();
    let same = Report::of(&scene("boundary_edge_only"), &dump).unwrap();
    assert_eq!(same.faults(0), Vec::<String>::new());
    let other = Report::of(&scene("boundary_edge_and_corner"), &dump).unwrap();
    let faults = other.faults(0);
    assert!(faults.iter().any(|fault| fault.starts_with("max_pos_err_rel")), "{faults:?}");
}
