//! Random cages: what the kernels' CPU twins make of them is the surface of the f64 evaluator.
//!
//! A cage that fails is written by `planish-generate random --seed SEED --features BITS --operations COUNT -o FILE`.
//! `PROPTEST_CASES` asks for more cages, `PROPTEST_RNG_SEED` for others.

mod judge;
mod vector;

use planish_generate::random_cage::{Features, Recipe};
use planish_render::{Spacing, SurfaceDesc, SurfaceMethod, limit, preprocess, subdivide};
use planish_scene::{LoadOptions, read_obj};
use planish_subdiv::ControlMesh;
use planish_subdiv::patch::{RegularPatch, SurfacePoint, evaluate_crease, reflect};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::tables::Tables;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::judge::{CORNERS, Judge};

/// What the cages may have.
const FEATURES: Features = Features::ALL;
/// Cages of a test, unless more are asked for.
const CASES: u32 = 1000;
/// Where regular patches are evaluated, in their own domain.
const SAMPLES: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.5], [0.3, 0.7], [0.0, 1.0], [0.85, 0.1]];
/// Where filling quads have limit points besides: in the middles of edges and in the centre.
const MIDDLES: [[f64; 2]; 5] = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5], [0.5, 0.5]];

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
    for (quad_index, quad) in tables.filling.iter().enumerate() {
        let middles = tables.filling_midpoints.get(quad_index).into_iter().flatten();
        for (&point, sample) in quad.corners.iter().chain(middles).zip(CORNERS.into_iter().chain(MIDDLES)) {
            let limit = &limits[point as usize];
            judge.check(&quad.info, sample, limit.position.map(f64::from), Some(limit.normal.map(f64::from)))?;
        }
    }
    let infos = tables.patches.iter().map(|patch| patch.info).chain(tables.filling.iter().map(|quad| quad.info));
    judge.check_coverage(&infos.collect::<Vec<_>>())
}

fn check(recipe: Recipe, desc: &SurfaceDesc) -> Result<(), String> {
    let text = recipe.cage().to_obj("A random cage.");
    let mut scene =
        read_obj("random.obj", text.as_bytes(), &LoadOptions::default()).map_err(|error| error.to_string())?;
    let mesh = scene.meshes.remove(0).control_mesh;
    let made = preprocess(&mesh, desc).map_err(|error| error.to_string())?;
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
        spacing in prop::sample::select(vec![Spacing::Equal, Spacing::FractionalEven]),
        crease_patches in crease_patches(),
    ) {
        let desc = SurfaceDesc { method: SurfaceMethod::Fas, spacing, level, crease_patches };
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
