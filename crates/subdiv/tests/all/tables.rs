//! Tables against the f64 evaluator and against the theory's counts, on cages made here.

use planish_subdiv::Error;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{BoundaryInterpolation, ControlMesh, Crease, Creasing, TriangleSubdivision, VertexColors};
use planish_subdiv::patch::cubic_basis;
use planish_subdiv::refine::{RefineOptions, Refinement};
use planish_subdiv::selection::{PatchCounts, deepest_cut};
use planish_subdiv::tables::Tables;

use crate::cages::{book, bow_tie, cube, pole, prism, random, seamed, sharpened, sheet};
use crate::surface::{check, distance};

fn refine(mesh: &ControlMesh, max_level: u32, uniform: bool) -> Tables {
    let options = RefineOptions { max_level, uniform, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a legal cage"))
}

fn deepest_counts(tables: &Tables) -> Vec<PatchCounts> {
    deepest_cut(tables, &tables.ranges()).counts
}

fn total(counts: &[PatchCounts]) -> PatchCounts {
    counts.iter().fold(PatchCounts::default(), |sum, c| PatchCounts {
        regular: sum.regular + c.regular,
        transition: sum.transition + c.transition,
        filling: sum.filling + c.filling,
        ..PatchCounts::default()
    })
}

#[test]
fn sharp_and_non_manifold_cages_give_the_limit_surface_and_cover_it_once() {
    let mut smooth_prism = prism(3);
    smooth_prism.options.triangles = TriangleSubdivision::Smooth;
    let mut one_sided = cube();
    one_sided.face_vertices[..4].reverse();
    for cage in [cube(), prism(5), sheet(4, 3), pole(6, 2), book(3), book(5), bow_tie(), smooth_prism, one_sided] {
        for creasing in [Creasing::Uniform, Creasing::Chaikin] {
            let mut semi_sharp = sharpened(cage.clone(), creasing);
            semi_sharp.creases.iter_mut().for_each(|crease| crease.sharpness = crease.sharpness.min(5.3));
            semi_sharp.corners.truncate(1);
            for mesh in [cage.clone(), sharpened(cage.clone(), creasing), semi_sharp] {
                let area: f64 = mesh.ptex_face_count() as f64;
                for level in [0, 1, 2, 4] {
                    assert!((check(&mesh, &refine(&mesh, level, false)) - area).abs() < 1e-9);
                }
                assert!((check(&mesh, &refine(&mesh, 2, true)) - area).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn random_cages_give_the_limit_surface_at_every_level() {
    for seed in 0..300 {
        // Seams are isolated too, which the surface must not feel.
        let mesh = if seed % 3 == 1 { seamed(random(seed), seed) } else { random(seed) };
        check(&mesh, &refine(&mesh, [0, 1, 3, 5][seed as usize % 4], false));
        check(&mesh, &refine(&mesh, 2, true));
    }
}

#[test]
fn infinite_creases_cost_nothing_along_their_length() {
    let mut mesh = sheet(8, 8);
    mesh.creases = (0..8).map(|i| Crease { vertices: [36 + i, 37 + i], sharpness: 10.0 }).collect();
    let tables = refine(&mesh, 6, false);
    assert_eq!(
        total(&deepest_counts(&tables)),
        PatchCounts { regular: 64, transition: 0, filling: 0, ..PatchCounts::default() }
    );
    // One edge less, and only the dart at its end is isolated.
    mesh.creases.pop();
    let counts = |level: u32| {
        let counts = total(&deepest_counts(&refine(&mesh, level, false)));
        counts.regular + counts.transition + counts.filling
    };
    assert_eq!(counts(6) - counts(5), counts(5) - counts(4));
    assert!(counts(6) < 64 + 6 * 40);
}

#[test]
fn tables_give_the_limit_surface_and_cover_it_once() {
    let mut edge_only = sheet(3, 2);
    edge_only.options.boundary = BoundaryInterpolation::EdgeOnly;
    let meshes = [
        cube(),
        prism(3),
        prism(5),
        prism(6),
        prism(40),
        pole(3, 1),
        pole(5, 3),
        pole(7, 2),
        pole(40, 2),
        sheet(1, 1),
        sheet(1, 5),
        sheet(4, 4),
        edge_only,
    ];
    for mesh in &meshes {
        for level in [0, 1, 4] {
            assert_eq!(check(mesh, &refine(mesh, level, false)), mesh.ptex_face_count() as f64);
        }
        assert_eq!(check(mesh, &refine(mesh, 2, true)), mesh.ptex_face_count() as f64);
    }
}

#[test]
fn boundary_faces_have_no_limit_without_boundary_interpolation() {
    let mut mesh = sheet(5, 4);
    mesh.options.boundary = BoundaryInterpolation::None;
    let tables = refine(&mesh, 2, false);
    assert_eq!(check(&mesh, &tables), 6.0);
    assert_eq!(Evaluator::new(&mesh).unwrap().evaluate(0, 0.5, 0.5), None);
}

#[test]
fn an_isolated_vertex_of_valence_n_adds_3n_regular_patches_a_level() {
    for n in [3, 5, 6, 7, 40] {
        let depth = 6;
        let tables = refine(&pole(n, 3), depth, false);
        let rings = PatchCounts { regular: 0, transition: 2 * n, filling: 0, ..PatchCounts::default() };
        // Level 0: nine faces a sector, less the irregular one; two of them border it. The rim is regular too.
        let counts = deepest_counts(&tables);
        assert_eq!(counts[0], PatchCounts { regular: 6 * n, ..rings });
        for level in &counts[1..depth as usize] {
            assert_eq!(*level, PatchCounts { regular: n, ..rings }, "valence {n}");
        }
        assert_eq!(
            counts[depth as usize],
            PatchCounts { regular: 3 * n, transition: 0, filling: n, ..PatchCounts::default() }
        );
        for k in 2..=depth as usize {
            assert_eq!(tables.levels[k].points.len() as u32, 12 * n + 1, "points of level {k}");
        }
    }
}

#[test]
fn a_cube_has_no_regular_patch_before_level_2() {
    let counts = deepest_counts(&refine(&cube(), 3, false));
    assert_eq!(counts[0], PatchCounts::default());
    assert_eq!(counts[1], PatchCounts::default());
    assert_eq!(counts[2], PatchCounts { regular: 24, transition: 48, filling: 0, ..PatchCounts::default() });
    assert_eq!(counts[3], PatchCounts { regular: 72, transition: 0, filling: 24, ..PatchCounts::default() });
}

#[test]
fn a_regular_sheet_is_never_split() {
    let tables = refine(&sheet(4, 4), 6, false);
    assert_eq!(
        total(&deepest_counts(&tables)),
        PatchCounts { regular: 16, transition: 0, filling: 0, ..PatchCounts::default() }
    );
    assert_eq!(tables.point_count(), 25);
}

#[test]
fn stencil_rows_read_only_points_that_are_made_before_them() {
    for mesh in [prism(40), pole(7, 2)] {
        let tables = refine(&mesh, 3, false);
        let mut made = vec![false; tables.point_count() as usize];
        made[..tables.cage_point_count as usize].fill(true);
        for range in tables.levels.iter().flat_map(|level| &level.dispatches) {
            for row_index in range.clone() {
                let row = tables.stencils.rows[row_index as usize];
                let weights = &tables.stencils.weights[row.first_weight as usize..][..row.count as usize];
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-4);
                for &index in &tables.stencils.indices[row.first_index as usize..][..row.count as usize] {
                    assert!(made[index as usize]);
                }
            }
            range.clone().for_each(|row| made[(row + tables.cage_point_count) as usize] = true);
        }
        assert!(made.iter().all(|&m| m));
    }
}

#[test]
fn evaluator_reproduces_a_bicubic_sheet() {
    let mesh = sheet(5, 5);
    let mut evaluator = Evaluator::new(&mesh).unwrap();
    // Face 12 is the middle one, its control points the sheet's inner 4 x 4.
    let (nu, nv) = (cubic_basis(0.3).0, cubic_basis(0.8).0);
    let mut want = [0.0; 3];
    for (j, wv) in nv.into_iter().enumerate() {
        for (i, wu) in nu.into_iter().enumerate() {
            let p = mesh.positions[(j + 1) * 6 + i + 1];
            (0..3).for_each(|c| want[c] += wu * wv * f64::from(p[c]));
        }
    }
    assert!(distance(evaluator.evaluate(12, 0.3, 0.8).unwrap().position, want) < 1e-14);
}

#[test]
fn colours_are_none_or_one_a_vertex_and_finite() {
    let with = |values: Vec<[f32; 3]>| {
        ControlMesh { colors: Some(VertexColors { values, ..VertexColors::default() }), ..cube() }.validate()
    };
    assert_eq!(with(vec![[-2.0, 0.0, 1e30]; 8]), Ok(()));
    assert_eq!(with(vec![[0.0; 3]; 9]), Err(Error::ColorCount { expected: 8, found: 9 }));
    assert_eq!(with(Vec::new()), Err(Error::ColorCount { expected: 8, found: 0 }));
    for bad in [f32::NAN, f32::INFINITY, -1e37] {
        let mut values = vec![[1.0; 3]; 8];
        values[5][2] = bad;
        assert_eq!(with(values), Err(Error::Color { vertex: 5 }));
    }
}

#[test]
fn densities_are_none_or_one_a_vertex_finite_and_not_negative() {
    let with = |density: Vec<f32>| ControlMesh { density, ..cube() }.validate();
    assert_eq!(with(Vec::new()), Ok(()));
    assert_eq!(with(vec![0.0; 8]), Ok(()));
    assert_eq!(with(vec![1.0; 7]), Err(Error::DensityCount { expected: 8, found: 7 }));
    for bad in [f32::NAN, f32::INFINITY, -0.5] {
        let mut density = vec![2.0; 8];
        density[3] = bad;
        assert_eq!(with(density), Err(Error::Density { vertex: 3 }));
    }
}
