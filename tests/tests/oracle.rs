//! What `planish dump` writes is OpenSubdiv's limit surface.

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

/// The oracle follows the rings of very high valences point by point: of such meshes it judges every so many faces.
/// The stride is prime to the number of faces a sector, so that each place in a sector is judged somewhere.
fn judged_stride(mesh: &Path) -> usize {
    if stem(mesh) == "valence_360" { 29 } else { 1 }
}

fn check(case: &Case) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let dump = folder.path().join("dump.ply");
    let flags = format!("--tess {} --spacing {}", case.tess, case.spacing);
    let outcome = Planish::dump(&case.mesh, &dump).flags(&flags).run().silent_success()?;
    let cage = Cage::read(&case.mesh);
    let stride = judged_stride(&case.mesh);
    let (mut judged, mut absent_faces) = (dump.clone(), 0);
    if stride > 1 {
        let all = Dump::read(&dump)?;
        let areas = all.covered_areas(cage.ptex_face_count())?;
        if let Some(face) = areas.iter().position(|area| (area - 1.0).abs() > AREA_TOLERANCE) {
            return Err(outcome.told(&format!("expected face {face} to be covered once, not {}", areas[face])));
        }
        judged = folder.path().join("judged.ply");
        all.write_faces(&judged, |face| (face as usize).is_multiple_of(stride))?;
        absent_faces = cage.ptex_face_count() - cage.ptex_face_count().div_ceil(stride);
    }
    let faults = Report::of(&case.mesh, &judged)?.faults(absent_faces);
    if faults.is_empty() { Ok(()) } else { Err(outcome.told(&faults.join("\n  "))) }
}

#[test]
fn fractional_odd_dumps_of_every_scene_are_the_limit_surface() {
    check_all(&cases(&scenes(), &["13.7", "8", "3", "1"], "fractional-odd"), check);
}

#[test]
fn equal_dumps_of_every_scene_are_the_limit_surface() {
    check_all(&cases(&scenes(), &["8", "3"], "equal"), check);
}

#[test]
fn fractional_even_dumps_of_every_scene_are_the_limit_surface() {
    check_all(&cases(&scenes(), &["8", "3"], "fractional-even"), check);
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
