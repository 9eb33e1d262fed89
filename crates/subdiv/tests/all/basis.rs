//! Basis function tables against the evaluator, against schemes written down once more, and against what theory says of them.

use std::collections::HashMap;

use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{Creasing, HierarchicalEdit};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisPatch, TABLE_TRIANGLE, Tables};
use planish_subdiv::{ControlMesh, Error};

use crate::cages::{bow_tie, cube, mesh, pole, prism, random, sharpened, sheet};
use crate::surface::{distance, limit, points};

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
    [0, 2].map(|shift| 0.5 * f64::from(patch.corner_uvs >> (4 * corner + shift) & 3))
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
    let tables = Tables::of_basis(mesh, scheme, LEVEL).expect("a cage of the scheme's");
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
        let tables = match Tables::of_basis(mesh, Scheme::CatmullClark, LEVEL) {
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

/// Meshes of triangles: closed ones with vertices of many valences, and open ones.
fn triangle_meshes() -> Vec<ControlMesh> {
    let bipyramid = |n: u32| {
        let mut positions = vec![[0.0, 1.2, 0.1], [0.1, -1.0, 0.0]];
        positions.extend((0..n).map(|i| {
            let angle = i as f32 * std::f32::consts::TAU / n as f32;
            [angle.cos(), 0.1 * (i % 3) as f32, angle.sin()]
        }));
        let rim = |i: u32| 2 + i % n;
        let faces = (0..n).flat_map(|i| [vec![0, rim(i + 1), rim(i)], vec![1, rim(i), rim(i + 1)]]);
        mesh(positions, &faces.collect::<Vec<_>>())
    };
    let mut all: Vec<ControlMesh> = [3, 4, 5, 6, 7, 9, 18].map(bipyramid).to_vec();
    all.push(lattice(4, |x, y| 0.3 * x * x - 0.2 * y * x));
    all
}

/// A lattice of equilateral triangles with `f(x, y)` over it.
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

/// Loop's scheme once more, by edges in a map: a level's points and triangles.
fn loop_step(points: &[[f64; 3]], faces: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut across: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for face in faces {
        for i in 0..3 {
            let (a, b) = (face[i], face[(i + 1) % 3]);
            across.entry([a.min(b), a.max(b)]).or_default().push(face[(i + 2) % 3]);
        }
    }
    let sum = |terms: &[(f64, u32)]| -> [f64; 3] {
        std::array::from_fn(|c| terms.iter().map(|(weight, point)| weight * points[*point as usize][c]).sum())
    };
    let mut around: Vec<Vec<(u32, bool)>> = vec![Vec::new(); points.len()];
    for (&[a, b], opposite) in &across {
        around[a as usize].push((b, opposite.len() == 1));
        around[b as usize].push((a, opposite.len() == 1));
    }
    let mut child: Vec<[f64; 3]> = (0..points.len() as u32)
        .map(|vertex| {
            let ring = &around[vertex as usize];
            let rim: Vec<u32> = ring.iter().filter(|(_, is_rim)| *is_rim).map(|&(other, _)| other).collect();
            if rim.len() == 2 {
                // With one face it is a corner.
                return if ring.len() == 2 {
                    points[vertex as usize]
                } else {
                    sum(&[(0.75, vertex), (0.125, rim[0]), (0.125, rim[1])])
                };
            }
            let n = ring.len() as f64;
            let beta = (0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / n).cos()).powi(2)) / n;
            let mut terms = vec![(1.0 - n * beta, vertex)];
            terms.extend(ring.iter().map(|&(other, _)| (beta, other)));
            sum(&terms)
        })
        .collect();
    let mut middle = HashMap::new();
    for (&[a, b], opposite) in &across {
        middle.insert([a, b], child.len() as u32);
        child.push(match opposite[..] {
            [c, d] => sum(&[(0.375, a), (0.375, b), (0.125, c), (0.125, d)]),
            _ => sum(&[(0.5, a), (0.5, b)]),
        });
    }
    let of = |a: u32, b: u32| middle[&[a.min(b), a.max(b)]];
    let split = |&[a, b, c]: &[u32; 3]| {
        let (ab, bc, ca) = (of(a, b), of(b, c), of(c, a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    (child, faces.iter().flat_map(split).collect())
}

#[test]
fn loop_rows_are_where_loop_s_scheme_goes() {
    for mesh in triangle_meshes() {
        let (tables, table_points) = tables(&mesh, Scheme::Loop);
        let mut points: Vec<[f64; 3]> = mesh.positions.iter().map(|p| p.map(f64::from)).collect();
        let mut faces: Vec<[u32; 3]> = mesh.face_vertices.chunks(3).map(|f| [f[0], f[1], f[2]]).collect();
        // Level 1 has the patches; its vertices stay the first ones at every level after it.
        (points, faces) = loop_step(&points, &faces);
        let corners = faces.clone();
        for _ in 0..9 {
            (points, faces) = loop_step(&points, &faces);
        }
        // Corners of a base triangle's four, as `loop_step` and as tables have them: matched by where they lie.
        assert_eq!(tables.basis.patches.len(), corners.len());
        for patch in &tables.basis.patches {
            let corner = grid_point(&tables, &table_points, patch, [0, 0]);
            let four = &corners[4 * patch.ptex_face as usize..][..4];
            let nearest =
                four.iter().flatten().map(|&v| distance(points[v as usize], corner.position)).fold(f64::MAX, f64::min);
            // Nine levels more: what is left is about 4^-9 of the curvature.
            assert!(nearest < 1e-4, "face {}: {nearest:e}", patch.ptex_face);
        }
        // And inside: all points of the tables lie on the mesh of that level, which is as near to the limit.
        let fine: HashMap<[i64; 3], Vec<[f64; 3]>> = points.iter().fold(HashMap::new(), |mut cells, p| {
            cells.entry(p.map(|c| (c / 0.01).round() as i64)).or_insert_with(Vec::new).push(*p);
            cells
        });
        for point in grid(&tables, &table_points).into_iter().flatten() {
            let cell = point.position.map(|c| (c / 0.01).round() as i64);
            let near =
                (0..27).flat_map(|k| fine.get(&[cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1]));
            let nearest = near.flatten().map(|p| distance(*p, point.position)).fold(f64::MAX, f64::min);
            assert!(nearest < 2e-4, "face {} at {:?}: {nearest:e}", point.ptex_face, point.uv);
        }
    }
}
