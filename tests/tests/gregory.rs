//! Method gregory end to end: dumps of all scenes are closed and cover every face, corners are on OpenSubdiv's limit surface, and
//! regular faces are those of method fas.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use planish_tests::folder::temporary;
use planish_tests::judge::{check, check_approximation};
use planish_tests::oracle::Report;
use planish_tests::parallel::check_all;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::{is_about_rules, is_edited, models, root, scene, scenes, stem};

/// Hierarchical edits are refused.
fn meshes() -> Vec<PathBuf> {
    let mut meshes = [scenes(), models()].concat();
    meshes.retain(|mesh| !is_edited(mesh));
    meshes
}

#[test]
fn dumps_are_closed_and_cover_every_face() {
    // All spacings, in turn: how edges are divided does not depend on what the patch is.
    let flags = ["--tess 5.3", "--tess 4.6 --spacing fractional-even", "--tess 3 --spacing equal"];
    // Of the scenes about rules every other one: each process takes a second.
    let mut meshes = meshes();
    let mut rules = 0;
    meshes.retain(|mesh| {
        rules += usize::from(is_about_rules(mesh));
        !is_about_rules(mesh) || rules % 2 == 0
    });
    let cases: Vec<_> = meshes.into_iter().zip(flags.into_iter().cycle()).collect();
    check_all(&cases, |(mesh, flags)| check_approximation(mesh, &format!("--method gregory {flags}")).map(|_| ()));
}

#[test]
fn corners_of_quads_are_on_the_limit_surface_with_its_normals() {
    // At factor 1 all points are corners, or ends of refinement, which method fas has as limit points too.
    let is_of_quads = |mesh: &PathBuf| {
        let text = std::fs::read_to_string(mesh).expect("a mesh");
        text.lines().filter(|line| line.starts_with("f ")).all(|face| face.split_whitespace().count() == 5)
    };
    let mut meshes = meshes();
    meshes.retain(is_of_quads);
    // Of those about rules a part: the limit points are those of the other methods, which are judged in all.
    let mut rules = 0;
    meshes.retain(|mesh| {
        rules += usize::from(is_about_rules(mesh));
        !is_about_rules(mesh) || rules % 8 == 0
    });
    assert!(meshes.len() > 25, "{} meshes of quads", meshes.len());
    check_all(&meshes, |mesh| check(mesh, "--method gregory --tess 1 --spacing equal"));
}

fn dump(mesh: &Path, flags: &str) -> Vec<Vertex> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    Planish::dump(mesh, &path).flags(flags).run().silent_success().unwrap();
    Dump::read(&path).unwrap().vertices().collect()
}

fn bits<const N: usize>(values: [f32; N]) -> [u32; N] {
    values.map(f32::to_bits)
}

#[test]
fn regular_faces_are_those_of_method_fas_to_the_bit() {
    for name in ["adjacent_extraordinary", "boundary_valences", "crease_infinite_extraordinary", "ngon_5", "torus_32"] {
        let flags = "--tess 8 --spacing equal";
        let place = |vertex: &Vertex| (vertex.face, bits(vertex.uv));
        let value = |vertex: &Vertex| (bits(vertex.position), bits(vertex.normal));
        let fas: HashMap<_, _> = dump(&scene(name), &format!("--method fas {flags}"))
            .iter()
            .map(|vertex| (place(vertex), value(vertex)))
            .collect();
        let mut compared = 0;
        for vertex in dump(&scene(name), &format!("--method gregory {flags}")).iter().filter(|v| v.kind == 0) {
            let expected = fas.get(&place(vertex)).unwrap_or_else(|| panic!("{name}: {vertex:?} is not in fas"));
            assert_eq!(&value(vertex), expected, "{name}: {vertex:?}");
            compared += 1;
        }
        assert!(compared > 500, "{name}: {compared} vertices of regular faces");
    }
}

#[test]
fn end_caps_are_closed_and_cover_every_face() {
    let flags = [
        "--method fas --max-level 1 --tess 9.4",
        "--method dfas --max-level 2 --edge-pixels 2 --size 160x90 --spacing equal",
        "--method dfas --max-level 0 --tess 5 --spacing fractional-even",
    ];
    let mut meshes = meshes();
    meshes.retain(|mesh| !stem(mesh).starts_with("uv_") && !stem(mesh).starts_with("color_"));
    let cases: Vec<_> = meshes.into_iter().zip(flags.into_iter().cycle()).step_by(4).collect();
    check_all(&cases, |(mesh, flags)| check_approximation(mesh, &format!("--end-cap gregory {flags}")).map(|_| ()));
}

#[test]
fn end_caps_come_nearer_to_the_limit_surface_with_every_level() {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    for name in ["adjacent_extraordinary", "genus_2", "ngon_5"] {
        let mesh = scene(name);
        let error = |level: u32| {
            let flags = format!("--method fas --end-cap gregory --max-level {level} --tess 16 --spacing equal");
            Planish::dump(&mesh, &path).flags(&flags).run().silent_success().unwrap();
            Report::of(&mesh, &path).unwrap().number("rms_pos_err")
        };
        let errors = [1, 2, 3].map(error);
        assert!(errors[0] < 1e-3 && errors[2] > 0.0, "{name}: {errors:?}");
        assert!(errors[1] < 0.45 * errors[0] && errors[2] < 0.45 * errors[1], "{name}: {errors:?}");
    }
}

#[test]
fn instances_are_drawn_and_faces_of_any_sides_counted() {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let several = root().join("scenes/several.json");
    let outcome = Planish::dump(&several, &path).flags("--method gregory --tess 3 --stats -").run();
    let stats = outcome.silent_success().unwrap().json().unwrap();
    let patches = &stats["frames"][0]["patches"];
    assert!(patches["gregory_quad"].as_u64() > Some(0), "{patches}");
    assert_eq!((patches["quad"].as_u64(), patches["truncated"].as_u64()), (Some(0), Some(0)), "{patches}");

    // Four triangles, whose twelve Ptex faces are all drawn.
    let vertices = check_approximation(&scene("tetrahedron"), "--method gregory --tess 2 --spacing equal").unwrap();
    assert!(vertices.iter().all(|vertex| (vertex.kind, vertex.level) == (4, 0)));
    let mesh = scene("tetrahedron");
    let outcome = Planish::dump(&mesh, &path).flags("--method gregory --tess 2 --stats -").run();
    let stats = outcome.silent_success().unwrap().json().unwrap();
    assert_eq!(stats["frames"][0]["patches"]["gregory_triangle"].as_u64(), Some(4));
}

#[test]
fn what_gregory_patches_do_not_have_is_refused() {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let refused = |mesh: &str, flags: &str, expected: &str| {
        let outcome = Planish::dump(&scene(mesh), &path).flags("--method gregory").flags(flags).run();
        let told = outcome.one_error(1).unwrap();
        assert!(told.contains(expected), "{told}");
        assert!(!path.exists());
    };
    refused("edit_vertex_add_1", "--tess 2", "expected no hierarchical edits");
    refused("crease_2_3", "--tess 2 --crease-patches single", "expected --crease-patches infinite or none");
    let outcome = Planish::dump(&scene("edit_vertex_add_1"), &path).flags("--end-cap gregory --tess 2").run();
    assert!(outcome.one_error(1).unwrap().contains("expected no hierarchical edits"));
}
