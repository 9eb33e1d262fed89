//! Basis function tables against the evaluator, against schemes written down once more, and against what theory says of them.

mod butterfly;
mod cached;
mod every_scheme;
mod loops;
mod mixed;
mod shading;

use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::Creasing;
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisOptions, BasisPatch, TABLE_TRIANGLE, Tables};
use planish_subdiv::{ControlMesh, Error};

use crate::cages::{cube, mesh, pole, prism, random, sharpened, sheet};
use crate::surface::{distance, points};

const LEVEL: u32 = 4;

/// A point of a patch's grid.
struct GridPoint {
    /// Place in the grid.
    at: [u32; 2],
    ptex_face: u32,
    uv: [f64; 2],
    position: [f64; 3],
    normal: [f64; 3],
}

/// Tables over the cage split once.
fn options(scheme: Scheme, level: u32) -> BasisOptions {
    BasisOptions { scheme, steps: 1, level, ring_level: None, has_weights: true }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = distance(a, [0.0; 3]);
    a.map(|c| c / length)
}

/// Position and unit normal of a row.
fn row(tables: &Tables, points: &[[f64; 3]], controls: (u32, u32), first_weight: u32, row: u32) -> [[f64; 3]; 2] {
    let basis = &tables.basis;
    let point = |i: u32| points[basis.controls[(controls.0 + i) as usize] as usize];
    let origin = point(0);
    let (mut position, mut u, mut v) = (origin, [0.0; 3], [0.0; 3]);
    for i in 0..controls.1 {
        let at = (first_weight + row * controls.1 + i) as usize;
        let (weight, tangents) = (basis.weights[at], basis.tangents[at]);
        for c in 0..3 {
            let offset = point(i)[c] - origin[c];
            position[c] += f64::from(weight) * offset;
            u[c] += f64::from(tangents[0]) * offset;
            v[c] += f64::from(tangents[1]) * offset;
        }
    }
    [position, unit(cross(u, v))]
}

fn is_triangle(patch: &BasisPatch) -> bool {
    patch.flags & TABLE_TRIANGLE != 0
}

fn patch_row(patch: &BasisPatch, segments: u32, [i, j]: [u32; 2]) -> u32 {
    if is_triangle(patch) { j * (segments + 1) - j * (j.max(1) - 1) / 2 + i } else { j * (segments + 1) + i }
}

fn corner_uv(patch: &BasisPatch, corner: u32) -> [f64; 2] {
    [0, 3].map(|shift| 0.5 * f64::from(patch.corner_uvs >> (6 * corner + shift) & 7))
}

fn grid_point(tables: &Tables, points: &[[f64; 3]], patch: &BasisPatch, at: [u32; 2]) -> GridPoint {
    let segments = 1 << tables.basis.level;
    let [position, normal] = row(
        tables,
        points,
        (patch.first_control, patch.control_count),
        patch.first_weight,
        patch_row(patch, segments, at),
    );
    let [a, b] = at.map(|at| f64::from(at) / f64::from(segments));
    let (origin, u, v) =
        (corner_uv(patch, 0), corner_uv(patch, 1), corner_uv(patch, if is_triangle(patch) { 2 } else { 3 }));
    let uv = std::array::from_fn(|c| origin[c] + a * (u[c] - origin[c]) + b * (v[c] - origin[c]));
    GridPoint { at, ptex_face: patch.ptex_face, uv, position, normal }
}

fn grid(tables: &Tables, points: &[[f64; 3]]) -> Vec<Vec<GridPoint>> {
    let segments = 1 << tables.basis.level;
    let of_patch = |patch: &BasisPatch| {
        let most = |j: u32| if is_triangle(patch) { segments - j } else { segments };
        let places = (0..=segments).flat_map(|j| (0..=most(j)).map(move |i| [i, j]));
        places.map(|at| grid_point(tables, points, patch, at)).collect()
    };
    tables.basis.patches.iter().map(of_patch).collect()
}

fn tables(mesh: &ControlMesh, scheme: Scheme) -> (Tables, Vec<[f64; 3]>) {
    let tables = Tables::of_basis(mesh, &options(scheme, LEVEL)).expect("a cage of the scheme's");
    let points = points(&mesh.positions, &tables);
    (tables, points)
}

fn size(mesh: &ControlMesh) -> f64 {
    mesh.positions.iter().flatten().fold(0.0, |most, c| f64::from(c.abs()).max(most))
}

#[test]
fn catmull_clark_rows_are_the_limit_surface_at_every_point() {
    let mut cages = vec![
        cube(),
        prism(5),
        sheet(3, 2),
        sharpened(cube(), Creasing::Uniform),
        sharpened(sheet(3, 3), Creasing::Chaikin),
    ];
    cages.extend([3, 5, 7, 18].map(|n| pole(n, 2)));
    cages.extend((0..12).map(random).filter(|mesh| mesh.edits.is_empty()));
    let (mut checked, mut normals) = (0, 0);
    for (number, mesh) in cages.iter().enumerate() {
        let tables = match Tables::of_basis(mesh, &options(Scheme::CatmullClark, LEVEL)) {
            Err(Error::NonManifoldTable { .. }) => continue,
            made => made.expect("tables"),
        };
        let points = points(&mesh.positions, &tables);
        let mut evaluator = Evaluator::new(mesh).expect("a cage");
        let segments = 1 << LEVEL;
        for point in grid(&tables, &points).into_iter().flatten() {
            let expected = evaluator.evaluate(point.ptex_face, point.uv[0], point.uv[1]).expect("a limit");
            let error = distance(point.position, expected.position) / size(mesh);
            assert!(error < 2e-6, "cage {number}, face {} at {:?}: {error:e}", point.ptex_face, point.uv);
            let is_inside = point.at.iter().all(|&at| at > 0 && at < segments);
            let sine = distance(cross(unit(expected.du), unit(expected.dv)), [0.0; 3]);
            if is_inside
                && sine > 0.05
                && [expected.du, expected.dv].iter().all(|d| distance(*d, [0.0; 3]) > 1e-3 * size(mesh))
            {
                let apart = distance(point.normal, expected.normal().expect("a normal"));
                assert!(
                    apart < 1e-4,
                    "cage {number}, face {} at {:?}: normals {apart:e} apart",
                    point.ptex_face,
                    point.uv
                );
                normals += 1;
            }
            checked += 1;
        }
    }
    assert!(checked > 50_000 && normals > 30_000, "{checked} points, {normals} normals");
}

/// Two fans of n triangles each with a rim in common, not flat anywhere.
fn bipyramid(n: u32) -> ControlMesh {
    let mut positions = vec![[0.0, 1.2, 0.1], [0.1, -1.0, 0.0]];
    positions.extend((0..n).map(|i| {
        let angle = i as f32 * std::f32::consts::TAU / n as f32;
        [angle.cos(), 0.1 * (i % 3) as f32, angle.sin()]
    }));
    let rim = |i: u32| 2 + i % n;
    let faces = (0..n).flat_map(|i| [vec![0, rim(i + 1), rim(i)], vec![1, rim(i), rim(i + 1)]]);
    mesh(positions, &faces.collect::<Vec<_>>())
}

/// A lattice of n x n pairs of equilateral triangles with `f(x, y)` over it.
fn lattice(n: u32, f: impl Fn(f32, f32) -> f32) -> ControlMesh {
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| (i as f32 + 0.5 * j as f32, 0.75_f32.sqrt() * j as f32)));
    let positions = positions.map(|(x, y)| [x, y, f(x, y)]).collect();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let faces = (0..n).flat_map(|j| {
        (0..n).flat_map(move |i| {
            [vec![at(i, j), at(i + 1, j), at(i, j + 1)], vec![at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
    });
    mesh(positions, &faces.collect::<Vec<_>>())
}

/// Meshes of triangles: closed ones with vertices of valences 3 to 18, and an open one.
fn triangle_meshes() -> Vec<ControlMesh> {
    let mut all: Vec<ControlMesh> = [3, 4, 5, 6, 7, 9, 18].map(bipyramid).to_vec();
    all.push(lattice(4, |x, y| 0.3 * x * x - 0.2 * y * x));
    all
}

/// Where parameters of a triangle of the cage lie on it.
fn on_triangle(mesh: &ControlMesh, face: u32, [u, v]: [f64; 2]) -> [f64; 3] {
    let corners = &mesh.face_vertices[3 * face as usize..][..3];
    let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[corners[i] as usize].map(f64::from));
    std::array::from_fn(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
}
