//! Triangles and quads mixed: Loop's scheme and Catmull and Clark's where there is one kind, and a surface across the edges between.

use planish_generate::solids;
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::Creasing;
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::Tables;

use super::{GridPoint, bipyramid, grid, options, size, tables, triangle_meshes};
use crate::cages::{cube, mesh, of_cage, pole, sharpened, sheet};
use crate::surface::distance;

/// Rows have 32-bit weights.
const TOLERANCE: f64 = 2e-6;

/// A lattice of triangles above a grid of quads, n wide and `rows` high each.
pub fn plane(n: u32, rows: u32) -> ControlMesh {
    let height = |j: u32| j as f32 - rows as f32;
    let positions = (0..=2 * rows)
        .flat_map(|j| (0..=n).map(move |i| [i as f32 + 0.5 * height(j).max(0.0), height(j), 0.0]))
        .collect();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let mut faces = Vec::new();
    for j in 0..2 * rows {
        for i in 0..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if j < rows {
                faces.push(vec![a, b, c, d]);
            } else {
                faces.extend([vec![a, b, d], vec![b, c, d]]);
            }
        }
    }
    mesh(positions, &faces)
}

/// A cube of which some sides are cut along a diagonal: vertices of all mixtures from three faces to six.
fn cut_cube() -> ControlMesh {
    let cube = cube();
    let quads = cube.face_vertices.as_chunks::<4>().0;
    let cut = |(i, &[a, b, c, d]): (usize, &[u32; 4])| match i {
        0 => vec![vec![a, b, c], vec![a, c, d]],
        2 | 3 => vec![vec![b, c, d], vec![b, d, a]],
        _ => vec![vec![a, b, c, d]],
    };
    let faces: Vec<_> = quads.iter().enumerate().flat_map(cut).collect();
    mesh(cube.positions.clone(), &faces)
}

/// Meshes of triangles and quads, of which the first two are closed and smooth.
pub fn meshes() -> Vec<ControlMesh> {
    let rocket = of_cage(&solids::rocket());
    let mut bent = plane(3, 2);
    bent.positions.iter_mut().for_each(|p| p[2] = 0.2 * p[0] * p[1] - 0.1 * p[0] * p[0]);
    let creased = sharpened(rocket.clone(), Creasing::Uniform);
    vec![rocket, cut_cube(), sharpened(bent.clone(), Creasing::Chaikin), bent, creased]
}

fn points_by(scheme: Scheme, mesh: &ControlMesh) -> Vec<GridPoint> {
    let (tables, points) = tables(mesh, scheme);
    grid(&tables, &points).into_iter().flatten().collect()
}

/// Whether a scheme's surface is loop-stam's, point by point.
fn assert_same(scheme: Scheme, mesh: &ControlMesh, number: usize) {
    let (expected, found) = (points_by(scheme, mesh), points_by(Scheme::LoopStam, mesh));
    assert_eq!(expected.len(), found.len());
    for (expected, found) in expected.iter().zip(&found) {
        let place = format!("{} cage {number}, face {} at {:?}", scheme.name(), found.ptex_face, found.uv);
        assert_eq!((found.ptex_face, found.uv), (expected.ptex_face, expected.uv), "{place}");
        let error = distance(found.position, expected.position) / size(mesh);
        assert!(error < 1e-7, "{place}: {error:e}");
        if expected.normal.iter().all(|c| c.is_finite()) {
            let apart = distance(found.normal, expected.normal);
            assert!(apart < 1e-4, "{place}: normals {apart:e} apart");
        }
    }
}

#[test]
fn loop_stam_is_loop_on_triangles() {
    let mut cages = triangle_meshes();
    cages.push(sharpened(bipyramid(5), Creasing::Uniform));
    cages.push(sharpened(bipyramid(7), Creasing::Chaikin));
    (0..).zip(&cages).for_each(|(number, mesh)| assert_same(Scheme::Loop, mesh, number));
}

#[test]
fn loop_stam_is_catmull_clark_on_quads() {
    let mut cages = vec![cube(), sheet(3, 2), sharpened(cube(), Creasing::Uniform)];
    cages.push(sharpened(sheet(3, 3), Creasing::Chaikin));
    cages.extend([3, 5, 7, 18].map(|n| pole(n, 2)));
    (0..).zip(&cages).for_each(|(number, mesh)| assert_same(Scheme::CatmullClark, mesh, number));
}

#[test]
fn normals_are_finite_and_the_same_across_edges_between_triangles_and_quads() {
    for (number, mesh) in meshes()[..2].iter().enumerate() {
        let (tables, points) = tables(mesh, Scheme::LoopStam);
        let patches = grid(&tables, &points);
        let kinds: [usize; 2] = [0, 1].map(|kind| {
            tables.basis.patches.iter().filter(|patch| usize::from(super::is_triangle(patch)) == kind).count()
        });
        assert!(kinds.iter().all(|&count| count > 8), "{kinds:?}");
        // Points at one place, from whichever patch, have one normal; those of the rim of a patch are met by others.
        let mut met: Vec<(&GridPoint, bool)> = Vec::new();
        for (patch, points) in tables.basis.patches.iter().zip(&patches) {
            met.extend(points.iter().map(|point| (point, super::is_triangle(patch))));
        }
        met.sort_by(|(a, _), (b, _)| a.position[0].total_cmp(&b.position[0]));
        let mut mixed = 0;
        for (i, (a, a_kind)) in met.iter().enumerate() {
            assert!(a.position.iter().chain(&a.normal).all(|c| c.is_finite()), "cage {number}, {:?}", a.position);
            let near = met[i + 1..].iter().take_while(|(b, _)| b.position[0] - a.position[0] < TOLERANCE);
            for (b, b_kind) in near.filter(|(b, _)| distance(a.position, b.position) < TOLERANCE) {
                let apart = distance(a.normal, b.normal);
                assert!(apart < 2e-4, "cage {number}, {:?}: normals {apart:e} apart", a.position);
                mixed += usize::from(a_kind != b_kind);
            }
        }
        assert!(mixed > 100, "cage {number}: {mixed}");
    }
}

#[test]
fn points_lie_at_their_parameters_inside_a_flat_lattice_of_both() {
    let (n, rows) = (5, 3);
    let mut mesh = plane(n, rows);
    mesh.positions.iter_mut().for_each(|p| p[2] = 0.3 * p[0] - 0.4 * p[1]);
    let mut faces = Vec::new();
    let mut rest = mesh.face_vertices.as_slice();
    for &sides in &mesh.face_sizes {
        let (face, after) = rest.split_at(sides as usize);
        faces.push(face);
        rest = after;
    }
    let is_inside = |vertex: &&u32| {
        let (i, j) = (*vertex % (n + 1), *vertex / (n + 1));
        i > 0 && i < n && j > 0 && j < 2 * rows
    };
    let mut checked = [0; 2];
    for point in points_by(Scheme::LoopStam, &mesh) {
        let face = faces[point.ptex_face as usize];
        if face.iter().filter(is_inside).count() < face.len() {
            continue;
        }
        let [a, b, d] = [0, 1, face.len() - 1].map(|i| mesh.positions[face[i] as usize].map(f64::from));
        let [u, v] = point.uv;
        let expected: [f64; 3] = std::array::from_fn(|c| a[c] + u * (b[c] - a[c]) + v * (d[c] - a[c]));
        let error = distance(point.position, expected) / size(&mesh);
        assert!(error < TOLERANCE, "face {} at {:?}: {error:e}", point.ptex_face, point.uv);
        checked[face.len() - 3] += 1;
    }
    assert!(checked.iter().all(|&count| count > 500), "{checked:?}");
}

#[test]
fn a_vertex_between_two_quads_and_three_triangles_moves_three_quarters() {
    let (columns, rows) = (4, 2);
    let mut mesh = plane(columns, rows);
    mesh.positions[(rows * (columns + 1) + 2) as usize][2] = 1.0;
    let (tables, points) = tables(&mesh, Scheme::LoopStam);
    let range = &tables.levels[1].points;
    let heights = points[range.start as usize..range.end as usize].iter().map(|point| point[2]);
    // What stays, and its share of the middles of five edges (twice each) and of two quads, of 2 * 5 + 2 in all.
    let expected = 0.25 + 0.75 * (5.0 + 2.0 / 4.0) / 12.0;
    let highest = heights.fold(0.0, f64::max);
    assert!((highest - expected).abs() < 1e-7, "{highest}, expected {expected}");
}

#[test]
fn tables_of_the_schemes_are_not_the_same_where_triangles_and_quads_meet() {
    let mesh = &meshes()[0];
    let of = |scheme: Scheme| Tables::of_basis(mesh, &options(scheme, 1)).expect("tables").basis;
    assert!(of(Scheme::LoopStam) != of(Scheme::CatmullClark));
}

#[test]
fn an_irregular_mixture_has_the_mask_of_its_shares() {
    // A quad and four triangles around vertex 0, which alone is lifted: of the points of level 1 its own is the highest.
    let place = |i: u32| [(i as f32).cos(), (i as f32).sin(), 0.0];
    let positions = std::iter::once([0.0, 0.0, 1.0]).chain((0..6).map(place)).collect();
    let fan = |i: u32| vec![0, i, i % 6 + 1];
    let mesh = mesh(positions, &[vec![0, 1, 2, 3], fan(3), fan(4), fan(5), fan(6)]);
    let (tables, points) = tables(&mesh, Scheme::LoopStam);
    let level = tables.levels[1].points.clone();
    let highest = points[level.start as usize..level.end as usize].iter().fold(0.0_f64, |most, p| most.max(p[2]));
    // By hand: four fifths of Loop's 0.791396 for 4 + 3/2 triangles, a fifth of 3 / n for n = 1 + 4 / 1.5 quads, is 0.796753; middles of
    // edges lie at 1/2, the quad's centre at 1/4.
    let expected = 1.0 - 0.796_753 * (1.0 - 5.25 / 11.0);
    assert!((highest - expected).abs() < 2e-6, "{highest}, expected {expected}");
}
