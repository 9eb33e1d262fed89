//! The modified butterfly scheme: it interpolates, and reproduces what theory says it does.

use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::Corner;
use planish_subdiv::scheme::Scheme;

use super::{GridPoint, bipyramid, grid, lattice, on_triangle, size, tables, triangle_meshes};
use crate::surface::distance;

/// Rows have 32-bit weights.
const TOLERANCE: f64 = 2e-6;

fn points(mesh: &ControlMesh) -> Vec<GridPoint> {
    let (tables, points) = tables(mesh, Scheme::Butterfly);
    grid(&tables, &points).into_iter().flatten().collect()
}

#[test]
fn butterfly_interpolates_the_cage_s_vertices_of_valences_3_to_18() {
    let meshes = (3..=18).map(bipyramid).chain([lattice(4, |x, y| 0.3 * x * x - 0.2 * y * x)]);
    for (number, mesh) in meshes.enumerate() {
        let mut met = 0;
        for point in points(&mesh) {
            assert!(point.position.iter().all(|c| c.is_finite()));
            let corner = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].contains(&point.uv);
            if corner {
                let error = distance(point.position, on_triangle(&mesh, point.ptex_face, point.uv)) / size(&mesh);
                assert!(error < 1e-6, "mesh {number}, face {}: {error:e}", point.ptex_face);
                met += 1;
            }
        }
        assert_eq!(met, mesh.face_vertices.len(), "mesh {number}");
    }
}

#[test]
fn butterfly_is_not_the_cage_and_not_loop_s_surface() {
    let mesh = bipyramid(7);
    let far = |a: &[GridPoint], b: &dyn Fn(usize) -> [f64; 3]| {
        (0..a.len()).map(|i| distance(a[i].position, b(i))).fold(0.0, f64::max)
    };
    let own = points(&mesh);
    let (tables, of_level_1) = tables(&mesh, Scheme::Loop);
    let of_loop: Vec<GridPoint> = grid(&tables, &of_level_1).into_iter().flatten().collect();
    assert!(far(&own, &|i| on_triangle(&mesh, own[i].ptex_face, own[i].uv)) > 0.05);
    assert!(far(&own, &|i| of_loop[i].position) > 0.05);
}

#[test]
fn butterfly_points_of_a_flat_lattice_lie_at_their_parameters_up_to_its_rim() {
    let mut mesh = lattice(4, |x, y| 0.2 * x - 0.7 * y);
    // Where the rim turns it ends: else it would be rounded.
    mesh.corners = [4, 20].map(|vertex| Corner { vertex, sharpness: 10.0 }).to_vec();
    for point in points(&mesh) {
        let error = distance(point.position, on_triangle(&mesh, point.ptex_face, point.uv)) / size(&mesh);
        assert!(error < TOLERANCE, "face {} at {:?}: {error:e}", point.ptex_face, point.uv);
    }
}

/// Largest height of the surface of a lattice above `f` that its vertices lie on, over the faces that are far from the rim.
fn height_above(f: impl Fn(f64, f64) -> f64) -> f64 {
    let n = 9;
    let mesh = lattice(n, |x, y| f(f64::from(x), f64::from(y)) as f32);
    let is_far = |vertex: &u32| [vertex % (n + 1), vertex / (n + 1)].iter().all(|&at| at >= 3 && at + 3 <= n);
    let inside = |point: &GridPoint| mesh.face_vertices[3 * point.ptex_face as usize..][..3].iter().all(is_far);
    let heights = points(&mesh).into_iter().filter(inside).map(|point| {
        let [x, y, z] = point.position;
        (z - f(x, y)).abs()
    });
    let heights: Vec<f64> = heights.collect();
    assert!(heights.len() > 1000, "{}", heights.len());
    heights.into_iter().fold(0.0, f64::max)
}

#[test]
fn butterfly_reproduces_cubics_inside_a_lattice_and_no_more() {
    let center = |x: f64, y: f64| (0.2 * (x - 6.75), 0.2 * (y - 3.9));
    let cubic = |x: f64, y: f64| {
        let (x, y) = center(x, y);
        0.7 * x * x * x - x * x * y + 0.5 * x * y * y + 0.3 * y * y * y + x * y - 0.4 * y * y
    };
    assert!(height_above(cubic) < 5e-6, "{:e}", height_above(cubic));
    let quartic = |x: f64, y: f64| center(x, y).0.powi(4);
    assert!(height_above(quartic) > 1e-4, "{:e}", height_above(quartic));
}

#[test]
fn the_rim_of_butterfly_depends_on_the_rim_alone() {
    let n = 5;
    let height = |x: f32, y: f32| 0.3 * x * x - 0.2 * y * x;
    let mesh = lattice(n, height);
    let mut moved = mesh.clone();
    for (i, position) in (0..).zip(&mut moved.positions) {
        if [i % (n + 1), i / (n + 1)].iter().all(|&at: &u32| at > 0 && at < n) {
            position[2] += 1.0 + (i as f32).sin();
        }
    }
    let (mut on_rim, mut inside) = (0, 0);
    for (a, b) in points(&mesh).iter().zip(&points(&moved)) {
        // The pair of triangles that the face is of, and whether it is the lower one.
        let (pair, is_lower) = (a.ptex_face / 2, a.ptex_face.is_multiple_of(2));
        let [u, v] = a.uv;
        let is_rim = if is_lower {
            pair / n == 0 && v == 0.0 || pair % n == 0 && u == 0.0
        } else {
            // Its corners are the lower right, the upper right and the upper left one.
            pair % n == n - 1 && v == 0.0 || pair / n == n - 1 && u + v == 1.0
        };
        let apart = distance(a.position, b.position);
        if is_rim {
            assert!(apart < 1e-6, "face {} at {:?}: {apart:e}", a.ptex_face, a.uv);
            on_rim += 1;
        } else if apart > 0.01 {
            inside += 1;
        }
    }
    assert!(on_rim > 300 && inside > 1000, "{on_rim}, {inside}");
}

#[test]
fn normals_of_butterfly_are_finite() {
    for mesh in triangle_meshes() {
        assert!(points(&mesh).iter().all(|point| point.normal.iter().all(|c| c.is_finite())));
    }
}
