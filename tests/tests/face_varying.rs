//! Face-varying values are OpenSubdiv's: on the patches that the tables have, and at the exact points of irregular faces.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use planish_generate::cage::Cage;
use planish_generate::random::Random;
use planish_generate::random_cage::{Features, Recipe};
use planish_generate::seams::{corner_classes, unite};
use planish_scene::{LoadOptions, read_obj};
use planish_subdiv::ControlMesh;
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::tables::{FaceVaryingEvaluator, Tables};
use planish_subdiv::topology::{Location, NONE};
use planish_tests::oracle::Report;
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;
use planish_tests::repository::{scenes, stem};

/// Values of `facevaryinginterpolateboundary`.
const MODES: std::ops::Range<u32> = 0..6;
/// Seeds of random cages.
const SEEDS: std::ops::Range<u64> = 3000..3042;
/// Points of a patch that are looked at, along each axis: corners, edges, inside.
const PLACES: [f64; 3] = [0.0, 0.3125, 1.0];

/// Points of a dump with nothing but places and values.
#[derive(Default)]
struct Points {
    lines: String,
    count: usize,
}

impl Points {
    /// Adds a point of a square of a Ptex face.
    fn add(&mut self, evaluator: &FaceVaryingEvaluator, location: Location, u: f64, v: f64) {
        let size = f64::from(1_u32 << location.depth).recip();
        let (u, v) = ((f64::from(location.u) + u) * size, (f64::from(location.v) + v) * size);
        let [s, t] = evaluator.evaluate(location.ptex_face, u, v).expect("patches and faces lie where values are");
        writeln!(self.lines, "0 0 0 0 0 1 {u} {v} {} 0 0 {s} {t}", location.ptex_face).expect("a string takes all");
        self.count += 1;
    }

    fn write(&self, path: &Path) {
        let floats =
            |names: &str| -> String { names.split(' ').map(|name| format!("property float {name}\n")).collect() };
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n{}property int face\nproperty uchar level\nproperty uchar \
             kind\n{}element face 0\nproperty list uchar int vertex_indices\nend_header\n{}",
            self.count,
            floats("x y z nx ny nz u v"),
            floats("s t"),
            self.lines
        );
        fs::write(path, text).expect("a temporary file can be written");
    }
}

/// All patches, and what is exact of irregular faces.
fn points_of(tables: &Tables) -> Points {
    let evaluator = FaceVaryingEvaluator::new(tables, 0).expect("the mesh has a channel");
    let mut points = Points::default();
    for patch in &tables.patches {
        for (u, v) in PLACES.into_iter().flat_map(|u| PLACES.map(|v| (u, v))) {
            points.add(&evaluator, patch.info.location, u, v);
        }
    }
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let middles = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)];
    let is_leaf = |level: u8| u32::from(level) == tables.max_level;
    for (face, values) in tables.irregular.iter().zip(&tables.face_varying[0].faces) {
        for (place, (u, v)) in corners.into_iter().chain(middles).enumerate() {
            // Only what is not covered by finer squares is looked up as these values.
            if values[place] != NONE && is_leaf(face.info.level) {
                points.add(&evaluator, face.info.location, u, v);
            }
        }
    }
    for quad in &tables.filling {
        corners.into_iter().for_each(|(u, v)| points.add(&evaluator, quad.info.location, u, v));
    }
    points
}

fn mesh_of(text: &str) -> ControlMesh {
    let mut scene = read_obj("mesh.obj", text.as_bytes(), &LoadOptions::default()).expect("the mesh can be read");
    scene.meshes.remove(0).control_mesh
}

/// Judges the values of a mesh of an OBJ file's text.
fn check(text: &str, options: RefineOptions) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let [mesh, dump] = ["mesh.obj", "dump.ply"].map(|name| folder.path().join(name));
    fs::write(&mesh, text).expect("a temporary file can be written");
    let refinement = Refinement::new(&mesh_of(text), options).map_err(|error| error.to_string())?;
    let tables = Tables::new(&refinement);
    let points = points_of(&tables);
    if points.count == 0 {
        return Ok(());
    }
    points.write(&dump);
    let faults = Report::of_values(&mesh, &dump)?.value_faults();
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n  ")) }
}

fn with_mode(text: &str, mode: u32) -> String {
    format!("{text}t facevaryinginterpolateboundary 1/0/0 {mode}\n")
}

#[test]
fn values_of_every_scene_in_every_mode_are_the_limit() {
    let mut cases = Vec::new();
    for mesh in scenes().into_iter().filter(|mesh| stem(mesh).starts_with("uv_")) {
        let text = fs::read_to_string(&mesh).expect("scenes can be read");
        cases.extend(MODES.map(|mode| (stem(&mesh).to_owned(), with_mode(&text, mode), mode)));
    }
    assert!(cases.len() > 6 * 20, "there are scenes with texture coordinates");
    check_all(&cases, |(name, text, mode)| {
        let crease_patches = [CreasePatches::Infinite, CreasePatches::Single, CreasePatches::None][*mode as usize % 3];
        let max_level = [2, 1, 3, 2, 1, 2][*mode as usize];
        let options = RefineOptions { max_level, crease_patches, ..RefineOptions::default() };
        check(text, options).map_err(|fault| format!("{name}, mode {mode}: {fault}"))?;
        if mode % 3 != 2 {
            return Ok(());
        }
        let uniform = RefineOptions { max_level: 2, uniform: true, ..options };
        check(text, uniform).map_err(|fault| format!("{name}, mode {mode}, uniform: {fault}"))
    });
}

/// A random cage whose edges are seams here and there, or which is cut into charts of some faces each.
fn random_cage(seed: u64) -> Cage {
    let recipe = Recipe { seed, features: Features::ALL, operation_count: (seed % 24) as u32 };
    let mut random = Random::new(seed ^ 0x5EA);
    let mut cage = recipe.cage();
    let percent = random.pick(&[3, 10, 25, 60]);
    let is_cut: std::collections::HashMap<[u32; 2], bool> =
        cage.edges().into_iter().map(|[a, b]| ([a.min(b), a.max(b)], random.percent(percent))).collect();
    let mut classes = corner_classes(&cage.faces, |[a, b]| is_cut[&[a.min(b), a.max(b)]]);
    // Now and then two parts of a vertex' faces share a value without a common edge.
    let corners: Vec<u32> = cage.faces.iter().flatten().copied().collect();
    for a in 0..corners.len() {
        if random.percent(2) {
            let same: Vec<usize> = (0..corners.len()).filter(|&b| corners[b] == corners[a]).collect();
            let b = random.pick(&same);
            unite(&mut classes, a as u32, b as u32);
        }
    }
    let classes: Vec<u32> = (0..classes.len()).map(|corner| last(&classes, corner as u32)).collect();
    cage.tags.push(format!("t facevaryinginterpolateboundary 1/0/0 {}", seed % 6));
    cage.with_corner_classes(&classes, seed, |p| glam::DVec2::new(p.x + 0.3 * p.y, p.z - 0.4 * p.y))
}

/// What a class was made a part of.
fn last(classes: &[u32], mut corner: u32) -> u32 {
    while classes[corner as usize] != corner {
        corner = classes[corner as usize];
    }
    corner
}

#[test]
fn values_of_random_cages_are_the_limit() {
    check_all(&SEEDS.collect::<Vec<_>>(), |&seed| {
        let crease_patches = [CreasePatches::Single, CreasePatches::Infinite, CreasePatches::None][seed as usize % 3];
        let (max_level, uniform) = ((seed % 5) as u32, seed % 11 == 0);
        let options = RefineOptions { max_level, crease_patches, uniform, ..RefineOptions::default() };
        let text = random_cage(seed).to_obj("A random cage.");
        check(&text, options).map_err(|fault| format!("seed {seed}: {fault}"))
    });
}

#[test]
fn other_values_are_not_taken_for_the_limit() {
    let mesh = planish_tests::repository::scene("uv_linear_boundaries");
    let text = fs::read_to_string(mesh).expect("scenes can be read");
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let [mesh, dump] = ["mesh.obj", "dump.ply"].map(|name| folder.path().join(name));
    let options = RefineOptions { max_level: 2, ..RefineOptions::default() };
    let refinement = Refinement::new(&mesh_of(&text), options).expect("the scene can be refined");
    points_of(&Tables::new(&refinement)).write(&dump);
    fs::write(&mesh, with_mode(&text, 1)).expect("a temporary file can be written");
    let faults = Report::of_values(&mesh, &dump).expect("the oracle answers").value_faults();
    assert!(faults.iter().any(|fault| fault.starts_with("max_st_err")), "{faults:?}");
}

#[test]
fn dumps_of_every_scene_have_the_values_of_the_limit() {
    const FLAGS: [&str; 3] =
        ["--tess 5.3", "--tess 7 --method fas --spacing equal", "--tess 12 --method uniform --max-level 2"];
    let mut cases = Vec::new();
    // Each in two of the modes, and so in all of them.
    for (first, mesh) in (0..).zip(scenes().into_iter().filter(|mesh| stem(mesh).starts_with("uv_"))) {
        let text = fs::read_to_string(&mesh).expect("scenes can be read");
        let modes = [first % 6, (first + 3) % 6];
        let case = |mode: u32| (stem(&mesh).to_owned(), with_mode(&text, mode), FLAGS[(mode + first) as usize % 3]);
        cases.extend(modes.map(case));
    }
    check_all(&cases, |(name, text, flags)| {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let [mesh, dump] = [format!("{name}.obj"), "dump.ply".to_owned()].map(|name| folder.path().join(name));
        fs::write(&mesh, text).expect("a temporary file can be written");
        Planish::dump(&mesh, &dump).flags(flags).run().silent_success()?;
        if !Dump::read(&dump)?.properties.tex_coords {
            return Err("the dump has no texture coordinates".to_owned());
        }
        let faults = Report::of_values(&mesh, &dump)?.value_faults();
        if faults.is_empty() { Ok(()) } else { Err(format!("{flags}: {}", faults.join("\n  "))) }
    });
}
