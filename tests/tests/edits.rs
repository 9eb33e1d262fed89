//! Hierarchical edits, which OpenSubdiv does not have: dumps against the f64 evaluator, by feature-adaptive and by uniform
//! refinement.

use std::path::{Path, PathBuf};

use planish_scene::{LoadOptions, load};
use planish_subdiv::eval::Evaluator;
use planish_tests::cage::Cage;
use planish_tests::oracle::POSITION_TOLERANCE;
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;
use planish_tests::repository::{is_edited, scenes};
use planish_tests::view::Place;

/// Every vertex of a dump against the limit surface. Normals away from points without a tangent plane may be off by
/// `normal_degrees`.
fn check(mesh: &Path, flags: &str, normal_degrees: f64) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let dump = folder.path().join("dump.ply");
    let outcome = Planish::dump(mesh, &dump).flags(flags).run().silent_success()?;
    let cage = load(mesh, &LoadOptions::default()).expect("scenes can be read").meshes.remove(0).control_mesh;
    let size = cage.positions.iter().flatten().fold(0.0_f64, |size, c| size.max(f64::from(c.abs())));
    let mut evaluator = Evaluator::new(&cage).expect("scenes are legal");
    let mut vertices: Vec<_> = Dump::read(&dump)?.vertices().collect();
    let (mut worst_position, mut worst_angle) = (0.0_f64, 0.0_f64);
    // Faces one after another: the evaluator keeps what it made for the last.
    vertices.sort_by_key(|vertex| vertex.face);
    for vertex in &vertices {
        let [u, v] = vertex.uv.map(f64::from);
        let Some(expected) = evaluator.evaluate(vertex.face, u, v) else {
            // On the rim of a hole the evaluator may be asked for the hole's side.
            continue;
        };
        let squares = (0..3).map(|c| (f64::from(vertex.position[c]) - expected.position[c]).powi(2));
        worst_position = worst_position.max(squares.sum::<f64>().sqrt());
        if let Some(normal) = expected.normal() {
            let cosine: f64 = (0..3).map(|c| f64::from(vertex.normal[c]) * normal[c]).sum();
            let is_corner = [u, v].iter().all(|t| t.fract() == 0.0);
            if !is_corner {
                worst_angle = worst_angle.max(cosine.clamp(-1.0, 1.0).acos().to_degrees());
            }
        }
    }
    if vertices.is_empty() || worst_position > POSITION_TOLERANCE * size || worst_angle > normal_degrees {
        let found = format!("positions off by {}, normals by {worst_angle} degrees", worst_position / size);
        return Err(outcome.told(&found));
    }
    Ok(())
}

#[test]
fn dumps_of_edited_scenes_are_the_limit_surface() {
    let meshes: Vec<PathBuf> = scenes().into_iter().filter(|mesh| is_edited(mesh)).collect();
    assert!(!meshes.is_empty(), "there are scenes with edits");
    let cases: Vec<_> = meshes.iter().flat_map(|mesh| ["1", "13.7"].map(|tess| (mesh, tess))).collect();
    check_all(&cases, |(mesh, tess)| check(mesh, &format!("--tess {tess}"), 0.05));
}

#[test]
fn dynamic_dumps_of_edited_scenes_are_the_limit_surface_from_odd_places() {
    let meshes: Vec<PathBuf> = scenes().into_iter().filter(|mesh| is_edited(mesh)).collect();
    let cases: Vec<_> = meshes.iter().zip(Place::ALL.into_iter().cycle()).collect();
    check_all(&cases, |(mesh, place)| {
        check(mesh, &format!("--edge-pixels 4 --size 96x54 {}", place.flags(&Cage::read(mesh))), 0.05)
    });
}

#[test]
fn uniform_refinement_gives_the_same_surface() {
    let meshes: Vec<PathBuf> = scenes().into_iter().filter(|mesh| is_edited(mesh)).collect();
    check_all(&meshes, |mesh| check(mesh, "--tess 16 --method uniform --spacing equal", 0.05));
}
