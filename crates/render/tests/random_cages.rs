//! Random cages: what the kernels' CPU twins make of them is the surface of the f64 evaluator.
//!
//! A cage that fails is written by `planish-generate random --seed SEED --features BITS --operations COUNT -o FILE`.
//! `PROPTEST_CASES` asks for more cages, `PROPTEST_RNG_SEED` for others.

use std::collections::BTreeMap;

use planish_generate::random_cage::{Features, Recipe};
use planish_render::{Spacing, SurfaceDesc, SurfaceMethod, limit, preprocess, subdivide};
use planish_scene::{LoadOptions, read_obj};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::patch::{PatchInfo, RegularPatch, SurfacePoint, evaluate_crease, reflect};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::Location;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// What the cages may have.
const FEATURES: Features = Features::ALL;
/// Cages of a test, unless more are asked for.
const CASES: u32 = 1500;
/// Largest distance from the evaluator's point, over the largest coordinate magnitude of the cage.
const POSITION_TOLERANCE: f64 = 2e-6;
/// Least tolerance of a normal, in degrees.
const NORMAL_TOLERANCE: f64 = 0.01;
/// Where regular patches are evaluated, in their own domain.
const SAMPLES: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.5], [0.3, 0.7], [0.0, 1.0], [0.85, 0.1]];
/// Where filling quads have limit points: corners, then middles of edges and the centre.
const QUAD_POINTS: [[f64; 2]; 9] =
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5], [0.5, 0.5]];

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn subtract(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|c| a[c] - b[c])
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// A cage with its evaluator, and what tolerances depend on.
struct Judge {
    evaluator: Evaluator,
    largest_coordinate: f64,
    /// Of each Ptex face, the shortest edge of its base face.
    shortest_edges: Vec<f64>,
}

impl Judge {
    fn new(mesh: &ControlMesh) -> Result<Self, String> {
        let evaluator = Evaluator::new(mesh).map_err(|error| error.to_string())?;
        let point = |vertex: u32| mesh.positions[vertex as usize].map(f64::from);
        let mut shortest_edges = Vec::new();
        let mut rest = mesh.face_vertices.as_slice();
        for &size in &mesh.face_sizes {
            let (face, after) = rest.split_at(size as usize);
            rest = after;
            let edges = face.iter().zip(face.iter().cycle().skip(1));
            let shortest = edges.map(|(&a, &b)| length(subtract(point(a), point(b)))).fold(f64::MAX, f64::min);
            shortest_edges.extend(vec![shortest; if size == 4 { 1 } else { size as usize }]);
        }
        let largest_coordinate =
            mesh.face_vertices.iter().flat_map(|&vertex| point(vertex)).fold(0.0, |m, c| c.abs().max(m));
        Ok(Self { evaluator, largest_coordinate, shortest_edges })
    }

    /// Compares a point at (u, v) of a patch with the evaluator's. `has_plane` says whether the derivatives are those
    /// of a patch, and not two vectors of any length.
    fn check(
        &mut self,
        info: &PatchInfo,
        [u, v]: [f64; 2],
        position: Vector,
        normal: Option<Vector>,
    ) -> Result<(), String> {
        let Location { ptex_face, u: low_u, v: low_v, depth } = info.location;
        let scale = f64::from(depth).exp2();
        let (u, v) = ((f64::from(low_u) + u) / scale, (f64::from(low_v) + v) / scale);
        let wrong = |what: String| Err(format!("{what} at Ptex face {ptex_face} ({u}, {v}), {info:?}"));
        let Some(expected) = self.evaluator.evaluate(ptex_face, u, v) else {
            return wrong("a patch where there is no surface".to_owned());
        };
        let distance = length(subtract(position, expected.position)) / self.largest_coordinate;
        // Also where it is NaN.
        if !(distance <= POSITION_TOLERANCE) {
            return wrong(format!("position {position:?} is off {:?} by {distance:e}", expected.position));
        }
        let Some(expected_normal) = expected.normal() else { return Ok(()) };
        let edge = self.shortest_edges[ptex_face as usize] / f64::from(info.level).exp2();
        let tolerance = normal_tolerance(self.largest_coordinate / edge, &expected);
        let Some(normal) = normal else { return wrong(format!("no normal, expected {expected_normal:?}")) };
        let angle = length(cross(normal, expected_normal)).atan2(dot(normal, expected_normal)).to_degrees();
        if angle <= tolerance {
            return Ok(());
        }
        wrong(format!("normal {normal:?} is off {expected_normal:?} by {angle} degrees, at most {tolerance} expected"))
    }

    /// Checks that the patches cover what has a surface, and that once.
    fn check_coverage(&mut self, patches: &[PatchInfo]) -> Result<(), String> {
        let mut by_face: BTreeMap<u32, Vec<Location>> = BTreeMap::new();
        for info in patches {
            by_face.entry(info.location.ptex_face).or_default().push(info.location);
        }
        for face in 0..self.evaluator.ptex_face_count() {
            let locations = by_face.remove(&face).unwrap_or_default();
            let depth = locations.iter().map(|location| location.depth).max().unwrap_or(2);
            let mut covered = vec![0; 1 << (2 * depth)];
            for location in &locations {
                let shift = depth - location.depth;
                let [low_u, low_v] = [location.u, location.v].map(|low| usize::from(low) << shift);
                for v in low_v..low_v + (1 << shift) {
                    (low_u..low_u + (1 << shift)).for_each(|u| covered[(v << depth) + u] += 1);
                }
            }
            for (cell, &count) in covered.iter().enumerate() {
                let [u, v] =
                    [cell & ((1 << depth) - 1), cell >> depth].map(|low| (low as f64 + 0.5) / f64::from(depth).exp2());
                // What is covered once has been compared with the surface.
                if count > 1 || count == 0 && self.evaluator.evaluate(face, u, v).is_some() {
                    return Err(format!("Ptex face {face} is covered {count} times at ({u}, {v})"));
                }
            }
        }
        if by_face.is_empty() { Ok(()) } else { Err(format!("patches on Ptex faces {:?}", by_face.keys())) }
    }
}

/// How far a normal may be off, in degrees: points of one level have lost so many bits in their differences, and the
/// more the flatter the angle between the tangents.
fn normal_tolerance(coordinate_by_edge: f64, expected: &SurfacePoint) -> f64 {
    let rounding = 4.0 * (-24_f64).exp2() * coordinate_by_edge;
    let sine = length(cross(expected.du, expected.dv)) / (length(expected.du) * length(expected.dv));
    NORMAL_TOLERANCE.max(rounding.to_degrees()) / sine
}

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
        for (&point, sample) in quad.corners.iter().chain(middles).zip(QUAD_POINTS) {
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
