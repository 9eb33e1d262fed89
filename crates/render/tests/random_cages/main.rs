//! Random cages: what the kernels' CPU twins make of them is the surface of the f64 evaluator.
//!
//! A cage that fails is written by `planish-generate random --seed SEED --features BITS --operations COUNT -o FILE`.
//! `PROPTEST_CASES` asks for more cages, `PROPTEST_RNG_SEED` for others.

mod judge;
mod vector;

use planish_generate::random_cage::{Features, Recipe};
use planish_render::{SurfaceDesc, SurfaceMethod, limit, preprocess, subdivide};
use planish_scene::{LoadOptions, read_obj};
use planish_subdiv::ControlMesh;
use planish_subdiv::patch::{PatchInfo, RegularPatch, SurfacePoint, evaluate_crease, reflect};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::selection::{Selection, density_rings, select};
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::NONE;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::judge::{CORNERS, Judge};

/// What the cages may have.
const FEATURES: Features = Features::ALL;
/// Cages of a test, unless more are asked for.
const CASES: u32 = 1000;
/// Where regular patches are evaluated, in their own domain.
const SAMPLES: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.5], [0.3, 0.7], [0.0, 1.0], [0.85, 0.1]];
/// The middles of edges.
const MIDDLES: [[f64; 2]; 4] = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]];
/// Densities at which faces are selected.
const DENSITIES: [f32; 5] = [0.0, 1.5, 3.0, 9.0, 40.0];

fn regular_point(patch: &RegularPatch, points: &[[f32; 3]], [u, v]: [f64; 2]) -> SurfacePoint {
    let mut controls = patch.points.map(|point| points[point as usize].map(f64::from));
    reflect(&mut controls, patch.info.boundary);
    evaluate_crease(&controls, patch.info.crease, f64::from(patch.sharpness), u, v)
}

fn check_tables(judge: &mut Judge, tables: &Tables, mesh: &ControlMesh) -> Result<(), String> {
    let points = subdivide::subdivide(tables, &mesh.positions);
    let limits = limit::limit(tables, &points);
    for patch in &tables.patches {
        for sample in SAMPLES {
            let found = regular_point(patch, &points, sample);
            judge.check(&patch.info, sample, found.position, found.normal())?;
        }
    }
    let mut check_limit = |info: &PatchInfo, limit: u32, sample| {
        let limit = &limits[limit as usize];
        judge.check(info, sample, limit.position.map(f64::from), Some(limit.normal.map(f64::from)))
    };
    for quad in &tables.filling {
        quad.corners.iter().zip(CORNERS).try_for_each(|(&limit, sample)| check_limit(&quad.info, limit, sample))?;
    }
    for face in tables.irregular.iter().filter(|face| !face.is_hidden) {
        let mut places = face.limits.iter().zip(CORNERS).chain(face.midpoints.iter().zip(MIDDLES));
        places.try_for_each(|(&limit, sample)| match limit {
            NONE => Ok(()),
            limit => check_limit(&face.info, limit, sample),
        })?;
    }
    if !tables.filling.is_empty() {
        return judge.check_coverage(&tables.filling.iter().map(|quad| quad.info).collect::<Vec<_>>());
    }
    check_cuts(judge, tables, mesh)
}

/// What is drawn covers the surface, whatever the densities: everywhere the same, and by chance at each vertex.
fn check_cuts(judge: &mut Judge, tables: &Tables, mesh: &ControlMesh) -> Result<(), String> {
    let ranges = tables.ranges();
    let mut state = mesh.positions.len() as u64;
    for turn in 0..4 {
        let densities: Vec<f32> = (0..ranges.cage_points.len())
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                DENSITIES[(state >> 33) as usize % DENSITIES.len()]
            })
            .collect();
        let slots = density_rings(tables, &ranges, &densities, &vec![0; densities.len()]);
        let cut = match turn {
            0 => select(tables, &ranges, &slots, Selection::Static { frame_density: 0.0 }),
            1 => select(tables, &ranges, &slots, Selection::Static { frame_density: f32::INFINITY }),
            _ => select(tables, &ranges, &slots, Selection::Dynamic),
        };
        let patches = ranges.patches[0].clone().chain(cut.patches.iter().copied());
        let patches = patches.map(|place| tables.patches[place as usize].info);
        let leaves = cut.leaves.iter().map(|leaf| tables.irregular[leaf.face as usize].info);
        judge.check_coverage(&patches.chain(leaves).collect::<Vec<_>>())?;
    }
    Ok(())
}

fn check(recipe: Recipe, desc: &SurfaceDesc) -> Result<(), String> {
    let text = recipe.cage().to_obj("A random cage.");
    let mut scene =
        read_obj("random.obj", text.as_bytes(), &LoadOptions::default()).map_err(|error| error.to_string())?;
    let mesh = scene.meshes.remove(0).control_mesh;
    let made = preprocess(&[&mesh], desc).map_err(|error| error.to_string())?;
    check_tables(&mut Judge::new(&mesh)?, &made.tables, &mesh)
}

fn config() -> ProptestConfig {
    let asked = ProptestConfig::default();
    let rng_seed = if asked.rng_seed == RngSeed::Random { RngSeed::Fixed(1) } else { asked.rng_seed };
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { asked.cases } else { CASES };
    ProptestConfig { failure_persistence: None, cases, rng_seed, ..asked }
}

/// Shrinks to small numbers and few features.
fn recipes() -> impl Strategy<Value = Recipe> {
    (0..1_u64 << 32, prop::bits::u32::masked(FEATURES.0), 0..30_u32).prop_map(|(seed, bits, operation_count)| Recipe {
        seed,
        features: Features(bits),
        operation_count,
    })
}

fn crease_patches() -> impl Strategy<Value = CreasePatches> {
    prop::sample::select(vec![CreasePatches::None, CreasePatches::Infinite, CreasePatches::Single])
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn adaptive_tables_of_random_cages_give_the_limit_surface(
        recipe in recipes(),
        level in 1..=5_u32,
        crease_patches in crease_patches(),
    ) {
        let desc = SurfaceDesc { method: SurfaceMethod::Dfas, level, crease_patches, ..SurfaceDesc::default() };
        if let Err(fault) = check(recipe, &desc) {
            prop_assert!(false, "{fault}");
        }
    }

    #[test]
    fn uniform_tables_of_random_cages_give_the_limit_surface(recipe in recipes(), level in 1..=2_u32) {
        let desc = SurfaceDesc { method: SurfaceMethod::Uniform, level, ..SurfaceDesc::default() };
        if let Err(fault) = check(recipe, &desc) {
            prop_assert!(false, "{fault}");
        }
    }
}
