//! What holds of the tables of every scheme: edges and corners are what the faces beside them say, weights are affine, builds are the
//! same again, and what has no tables is refused.

use planish_subdiv::mesh::{ControlMesh, Creasing, EditOperation, HierarchicalEdit};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisPatch, Tables};

use super::{
    bipyramid, corner_uv, is_triangle, lattice, mixed, options, patch_row, row, size, tables, triangle_meshes,
};
use crate::cages::{bow_tie, cube, mesh, pole, prism, random, sharpened, sheet};
use crate::surface::{distance, limit};

/// Rows have 32-bit weights.
const TOLERANCE: f64 = 2e-6;
/// Most that unit normals of rows may differ by.
const NORMALS: f64 = 2e-4;
/// The same at corners: a mask that sees sharpness fade over several levels is of differences of points that are near by then.
const CORNER_NORMALS: f64 = 1e-3;

/// Cages of each scheme, smooth and not.
fn all() -> Vec<(Scheme, ControlMesh)> {
    let triangles = || triangle_meshes().into_iter().chain([sharpened(bipyramid(7), Creasing::Uniform)]);
    let chaikin = sharpened(lattice(4, |x, y| 0.1 * x * y), Creasing::Chaikin);
    let mut quads = vec![cube(), sheet(3, 2), pole(5, 2), prism(6), sharpened(cube(), Creasing::Chaikin)];
    quads.extend((0..6).map(random).filter(|mesh| mesh.edits.is_empty()));
    let quads = quads.into_iter().filter(|mesh| Tables::of_basis(mesh, &options(Scheme::CatmullClark, 0)).is_ok());
    let with = |scheme: Scheme| move |mesh: ControlMesh| (scheme, mesh);
    let of_catmull_clark = quads.map(with(Scheme::CatmullClark));
    let of_loop = triangles().chain([chaikin.clone()]).map(with(Scheme::Loop));
    let of_butterfly = triangles().chain([chaikin]).map(with(Scheme::Butterfly));
    let of_loop_stam = mixed::meshes().into_iter().map(with(Scheme::LoopStam));
    of_catmull_clark.chain(of_loop).chain(of_butterfly).chain(of_loop_stam).collect()
}

/// The grid point at a place along an edge, from corner `edge` on.
fn on_edge(patch: &BasisPatch, segments: u32, edge: usize, along: u32) -> [u32; 2] {
    let rest = segments - along;
    match (edge, is_triangle(patch)) {
        (0, _) => [along, 0],
        (1, true) => [rest, along],
        (1, false) => [segments, along],
        (2, false) => [rest, segments],
        _ => [0, rest],
    }
}

#[test]
fn edge_rows_are_those_of_the_faces_on_both_sides() {
    for (number, (scheme, mesh)) in all().iter().enumerate() {
        let (tables, points) = tables(mesh, *scheme);
        let segments = 1 << tables.basis.level;
        let (mut ways, mut normals) = ([0; 2], 0);
        for (patch_number, patch) in tables.basis.patches.iter().enumerate() {
            for edge in 0..if is_triangle(patch) { 3 } else { 4 } {
                let number_of_edge = patch.edges[edge];
                let table = tables.basis.edges[number_of_edge as usize / 2];
                ways[number_of_edge as usize % 2] += 1;
                for along in 1..segments {
                    let from_first = if number_of_edge % 2 == 1 { segments - along } else { along };
                    let controls = (table.first_control, table.control_count);
                    let [position, normal] = row(&tables, &points, controls, table.first_weight, from_first);
                    let at = patch_row(patch, segments, on_edge(patch, segments, edge, along));
                    let controls = (patch.first_control, patch.control_count);
                    let own = row(&tables, &points, controls, patch.first_weight, at);
                    let place = format!("{} cage {number}, patch {patch_number}, edge {edge}, {along}", scheme.name());
                    let error = distance(position, own[0]) / size(mesh);
                    assert!(error < TOLERANCE, "{place}: {error:e}");
                    if patch.flags >> edge & 1 == 0 && normal.iter().chain(&own[1]).all(|c| c.is_finite()) {
                        let apart = distance(normal, own[1]);
                        assert!(apart < NORMALS, "{place}: normals {apart:e} apart");
                        normals += 1;
                    }
                }
            }
        }
        assert!(ways.iter().all(|&count| count > 0) && normals > 0, "cage {number}: {ways:?}, {normals} normals");
    }
}

#[test]
fn corners_are_limit_points() {
    for (number, (scheme, mesh)) in all().iter().enumerate() {
        let (tables, points) = tables(mesh, *scheme);
        let segments = 1 << tables.basis.level;
        let mut normals = 0;
        for (patch_number, patch) in tables.basis.patches.iter().enumerate() {
            for corner in 0..if is_triangle(patch) { 3 } else { 4 } {
                let at = patch_row(patch, segments, on_edge(patch, segments, corner, 0));
                let own = row(&tables, &points, (patch.first_control, patch.control_count), patch.first_weight, at);
                let limit = limit(&tables, &points, patch.corners[corner]);
                let place = format!("{} cage {number}, patch {patch_number}, corner {corner}", scheme.name());
                let error = distance(limit.position, own[0]) / size(mesh);
                assert!(error < TOLERANCE, "{place}: {error:e}");
                // At the tip of a cone there is none: one is made up for all faces.
                let is_tip = mesh.corners.iter().any(|corner| {
                    let position = mesh.positions[corner.vertex as usize].map(f64::from);
                    corner.sharpness >= 10.0 && distance(position, limit.position) < TOLERANCE
                });
                let normal = limit.normal().filter(|_| !is_tip && patch.flags >> (4 + corner) & 1 == 0);
                if let Some(normal) = normal.filter(|_| own[1].iter().all(|c| c.is_finite())) {
                    let apart = distance(normal, own[1]);
                    assert!(apart < CORNER_NORMALS, "{place}: normals {apart:e} apart");
                    normals += 1;
                }
            }
        }
        assert!(normals > 0, "cage {number}");
    }
}

#[test]
fn weights_of_a_row_sum_to_1_and_those_of_tangents_to_0() {
    for (number, (scheme, mesh)) in all().iter().enumerate() {
        let (tables, _) = tables(mesh, *scheme);
        let basis = &tables.basis;
        let segments: u32 = 1 << basis.level;
        let of_patch = |patch: &BasisPatch| {
            let rows = if is_triangle(patch) { (segments + 1) * (segments + 2) / 2 } else { (segments + 1).pow(2) };
            (patch.first_weight, patch.control_count, rows)
        };
        let of_edges = basis.edges.iter().map(|edge| (edge.first_weight, edge.control_count, segments + 1));
        for (first, count, rows) in basis.patches.iter().map(of_patch).chain(of_edges) {
            for row in 0..rows {
                let range = (first + row * count) as usize..(first + (row + 1) * count) as usize;
                let sum: f64 = basis.weights[range.clone()].iter().map(|&weight| f64::from(weight)).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{} cage {number}: {sum}", scheme.name());
                // By Chaikin's rule an edge sharper than 1 may become smooth at once, which is told by more than the whole crease rule.
                if scheme.is_within_hull() && mesh.options.creasing == Creasing::Uniform {
                    assert!(basis.weights[range.clone()].iter().all(|&weight| weight > -1e-7), "cage {number}");
                }
                for axis in 0..2 {
                    let sum: f64 = basis.tangents[range.clone()].iter().map(|weights| f64::from(weights[axis])).sum();
                    assert!(sum.abs() < 1e-5, "{} cage {number}: tangent {sum}", scheme.name());
                }
            }
        }
    }
}

#[test]
fn flat_cages_have_one_normal() {
    let flat = |mut mesh: ControlMesh| {
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.5 * p[0] - 0.25 * p[1]);
        mesh
    };
    let normal = super::unit([-0.5, 0.25, 1.0]);
    let cages = [
        (Scheme::CatmullClark, flat(sheet(3, 3))),
        (Scheme::CatmullClark, flat(pole(7, 2))),
        (Scheme::Loop, flat(lattice(3, |_, _| 0.0))),
        (Scheme::Butterfly, flat(lattice(3, |_, _| 0.0))),
        (Scheme::LoopStam, flat(mixed::plane(2, 3))),
    ];
    for (scheme, mesh) in cages {
        let (tables, points) = tables(&mesh, scheme);
        for point in super::grid(&tables, &points).into_iter().flatten() {
            let apart = distance(point.normal, normal);
            assert!(apart < NORMALS, "{}, face {} at {:?}: {apart:e}", scheme.name(), point.ptex_face, point.uv);
        }
    }
}

#[test]
fn parameters_of_patches_cover_each_ptex_face_once() {
    for (number, (scheme, mesh)) in all().iter().enumerate() {
        let (tables, _) = tables(mesh, *scheme);
        let mut areas = std::collections::BTreeMap::<u32, [f64; 2]>::new();
        for patch in &tables.basis.patches {
            let [origin, u, v] = [0, 1, if is_triangle(patch) { 2 } else { 3 }].map(|i| corner_uv(patch, i));
            let area = (u[0] - origin[0]) * (v[1] - origin[1]) - (u[1] - origin[1]) * (v[0] - origin[0]);
            let whole = if scheme.is_triangle(if is_triangle(patch) { 3 } else { 4 }) { 0.5 } else { 1.0 };
            let share = if is_triangle(patch) { 0.5 } else { 1.0 };
            let sum = areas.entry(patch.ptex_face).or_insert([0.0, whole]);
            sum[0] += share * area;
        }
        for (face, [area, expected]) in areas {
            assert!((area - expected).abs() < 1e-12, "{} cage {number}, face {face}: {area}", scheme.name());
        }
    }
}

#[test]
fn two_builds_are_the_same() {
    for (scheme, mesh) in all() {
        let [a, b] = [0, 1].map(|_| tables(&mesh, scheme).0);
        let words = |tables: &Tables| {
            let limits = tables.limits.weights.iter().flatten().map(|weight| weight.to_bits()).collect::<Vec<_>>();
            let weights = tables.stencils.weights.iter().map(|weight| weight.to_bits()).collect::<Vec<_>>();
            (limits, tables.limits.indices.clone(), weights, tables.stencils.indices.clone())
        };
        assert!(a.basis == b.basis && words(&a) == words(&b), "{}", scheme.name());
    }
}

#[test]
fn patches_of_one_configuration_have_one_table() {
    // Far from the rim all faces of a lattice are alike, and all turned as they like.
    let (tables, _) = tables(&lattice(12, |x, y| x * y), Scheme::Loop);
    let distinct: std::collections::BTreeSet<u32> =
        tables.basis.patches.iter().map(|patch| patch.first_weight).collect();
    assert!(distinct.len() < 40 && tables.basis.patches.len() == 4 * 288, "{}", distinct.len());
}

#[test]
fn cages_without_tables_are_refused() {
    let told = |mesh: &ControlMesh, scheme: Scheme| {
        Tables::of_basis(mesh, &options(scheme, 0)).expect_err("no tables").to_string()
    };
    let face = |face: u32, sides: u32, scheme: &str, accepted: &str| {
        format!("face {face} (from 0) has {sides} sides: scheme {scheme} expects {accepted}")
    };
    assert_eq!(told(&cube(), Scheme::Loop), face(0, 4, "loop", "triangles"));
    assert_eq!(told(&cube(), Scheme::Butterfly), face(0, 4, "butterfly", "triangles"));
    assert_eq!(told(&prism(5), Scheme::LoopStam), face(0, 5, "loop-stam", "triangles and quads"));
    let mut late = bipyramid(4);
    late.face_sizes.splice(2..4, [4]);
    late.face_vertices.splice(6..12, [0, 3, 1, 2]);
    assert_eq!(told(&late, Scheme::Loop), face(2, 4, "loop", "triangles"));
    let manifold = "method table expects edges of one or two faces and one fan a vertex";
    assert_eq!(told(&bow_tie(), Scheme::CatmullClark), format!("vertex 7 (from 0) is not manifold: {manifold}"));
    let flap = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
    let book = mesh(flap.to_vec(), &[vec![2, 0, 1], vec![3, 0, 1], vec![4, 0, 1]]);
    for scheme in [Scheme::Loop, Scheme::Butterfly, Scheme::LoopStam] {
        assert_eq!(told(&book, scheme), format!("vertex 0 (from 0) is not manifold: {manifold}"));
    }
    let mut edited = cube();
    edited.edits = vec![HierarchicalEdit { path: vec![0, 0], operation: EditOperation::Hole }];
    let expected = "tables are over the cage itself: expected no hierarchical edits";
    assert_eq!(told(&edited, Scheme::CatmullClark), expected);
}
