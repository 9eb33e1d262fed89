//! Tables against the f64 evaluator and against the theory's counts, on cages made here.

use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{BoundaryInterpolation, ControlMesh, Corner, Crease, Creasing, TriangleSubdivision};
use planish_subdiv::patch::{cubic_basis, evaluate, reflect};
use planish_subdiv::refine::{RefineOptions, Refinement};
use planish_subdiv::tables::{PatchCounts, Tables};

fn mesh(positions: Vec<[f32; 3]>, faces: &[Vec<u32>]) -> ControlMesh {
    ControlMesh {
        positions,
        face_sizes: faces.iter().map(|f| f.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..ControlMesh::default()
    }
}

/// A disc of `rings` rings of quads around a vertex of valence n; with `rings` >= 3 that vertex is isolated.
fn pole(n: u32, rings: u32) -> ControlMesh {
    // Sector s holds the grid points (i, j), 1 <= i <= rings, 0 <= j <= rings: i along its own axis, j along the next.
    let at = |s: u32, i: u32, j: u32| -> u32 {
        match (i, j) {
            (0, 0) => 0,
            (0, j) => 1 + (s + 1) % n * rings * (rings + 1) + (j - 1) * (rings + 1),
            (i, j) => 1 + s * rings * (rings + 1) + (i - 1) * (rings + 1) + j,
        }
    };
    let mut positions = vec![[0.0, 0.0, 1.0]; (1 + n * rings * (rings + 1)) as usize];
    let mut faces = Vec::new();
    for s in 0..n {
        for i in 0..=rings {
            for j in 0..=rings {
                let angle = |s: u32| (s % n) as f32 * std::f32::consts::TAU / n as f32;
                let (x0, y0) = (angle(s).cos(), angle(s).sin());
                let (x1, y1) = (angle(s + 1).cos(), angle(s + 1).sin());
                let (i, j) = (i as f32, j as f32);
                let (x, y) = (i * x0 + j * x1, i * y0 + j * y1);
                positions[at(s, i as u32, j as u32) as usize] = [x, y, (-0.3 * (x * x + y * y)).exp()];
            }
        }
        for i in 0..rings {
            for j in 0..rings {
                faces.push(vec![at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)]);
            }
        }
    }
    mesh(positions, &faces)
}

fn cube() -> ControlMesh {
    let positions = (0..8_u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh(positions, &faces.map(|f| f.to_vec()))
}

/// A prism over an n-gon: two n-gons and n quads.
fn prism(n: u32) -> ControlMesh {
    let ring = |z: f32| {
        (0..n).map(move |i| {
            let angle = i as f32 * std::f32::consts::TAU / n as f32;
            [angle.cos(), angle.sin() * 1.2, z + 0.1 * (2.0 * angle).sin()]
        })
    };
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    mesh(ring(0.0).chain(ring(1.0)).collect(), &faces)
}

/// A sheet of m x n quads.
fn sheet(m: u32, n: u32) -> ControlMesh {
    let positions = (0..=n).flat_map(|j| (0..=m).map(move |i| [i as f32, j as f32, ((i * j) as f32).sin()])).collect();
    let faces: Vec<_> = (0..n)
        .flat_map(|j| (0..m).map(move |i| j * (m + 1) + i))
        .map(|a| vec![a, a + 1, a + m + 2, a + m + 1])
        .collect();
    mesh(positions, &faces)
}

fn refine(mesh: &ControlMesh, max_level: u32, uniform: bool, midpoints: bool) -> Tables {
    let options = RefineOptions { max_level, uniform, midpoints, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a manifold cage"))
}

/// All points of all levels, by the stencil rows, in f64.
fn points(mesh: &ControlMesh, tables: &Tables) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = mesh.positions.iter().map(|p| p.map(f64::from)).collect();
    points.resize(tables.point_count() as usize, [f64::NAN; 3]);
    for range in tables.levels.iter().flat_map(|level| &level.dispatches) {
        for row_index in range.clone() {
            let row = tables.stencils.rows[row_index as usize];
            let mut sum = [0.0; 3];
            for i in 0..row.count {
                let p = points[tables.stencils.indices[(row.first_index + i) as usize] as usize];
                let w = f64::from(tables.stencils.weights[(row.first_weight + i) as usize]);
                (0..3).for_each(|c| sum[c] += w * p[c]);
            }
            points[(row_index + tables.cage_point_count) as usize] = sum;
        }
    }
    points
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
}

/// Compares every patch and every limit point of the tables with the evaluator, and returns the covered area.
fn check(mesh: &ControlMesh, tables: &Tables) -> f64 {
    let points = points(mesh, tables);
    let mut evaluator = Evaluator::new(mesh).expect("a manifold cage");
    let size = mesh.positions.iter().flatten().fold(0.0_f64, |m, &c| m.max(f64::from(c.abs())));
    let mut covered = 0.0;
    for patch in &tables.patches {
        let l = patch.info.location;
        let scale = (-f64::from(l.depth)).exp2();
        covered += scale * scale;
        let mut control = patch.points.map(|p| points[p as usize]);
        reflect(&mut control, patch.info.boundary);
        for (u, v) in [(0.0, 0.0), (1.0, 0.25), (0.3, 1.0), (0.6, 0.7)] {
            let got = evaluate(&control, u, v).position;
            let (pu, pv) = ((f64::from(l.u) + u) * scale, (f64::from(l.v) + v) * scale);
            let want = evaluator.evaluate(l.ptex_face, pu, pv).expect("a limit");
            assert!(distance(got, want.position) < 1e-6 * size, "{l:?} at {u}, {v}: {got:?}, expected {want:?}");
        }
    }
    let limit = |i: u32| {
        let row = tables.limits.rows[i as usize];
        let mut sum = [0.0; 3];
        for i in 0..row.count {
            let p = points[tables.limits.indices[(row.first_index + i) as usize] as usize];
            let w = f64::from(tables.limits.weights[(row.first_weight + i) as usize][0]);
            (0..3).for_each(|c| sum[c] += w * p[c]);
        }
        sum
    };
    for (i, quad) in tables.filling.iter().enumerate() {
        let l = quad.info.location;
        let scale = (-f64::from(l.depth)).exp2();
        covered += scale * scale;
        let mut samples: Vec<_> =
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].into_iter().zip(quad.corners).collect();
        if let Some(middle) = tables.filling_midpoints.get(i) {
            samples.extend([(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5), (0.5, 0.5)].into_iter().zip(*middle));
        }
        for ((u, v), index) in samples {
            let (pu, pv) = ((f64::from(l.u) + u) * scale, (f64::from(l.v) + v) * scale);
            let want = evaluator.evaluate(l.ptex_face, pu, pv).expect("a limit");
            assert!(distance(limit(index), want.position) < 1e-6 * size, "{l:?} at {u}, {v}");
        }
    }
    covered
}

/// The mesh with every edge of another sharpness, and some sharp vertices.
fn sharpened(mut mesh: ControlMesh, creasing: Creasing) -> ControlMesh {
    const SHARPNESS: [f32; 9] = [0.0, 2.3, 10.0, 0.3, 0.0, 1.0, 1.5, 0.0, 7.8];
    let mut first = 0;
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            let sharpness = SHARPNESS[(a * b + a + b) as usize % SHARPNESS.len()];
            mesh.creases.push(Crease { vertices: [a, b], sharpness });
        }
        first += sides as usize;
    }
    mesh.corners = vec![Corner { vertex: 1, sharpness: 2.3 }, Corner { vertex: 4, sharpness: 10.0 }];
    mesh.options.creasing = creasing;
    mesh
}

/// Quads that share an edge as the pages of a book share its spine, three quads high.
fn book(pages: u32) -> ControlMesh {
    let mut positions: Vec<[f32; 3]> = (0..4).map(|j| [0.0, j as f32, 0.1 * (j * j) as f32]).collect();
    let mut faces = Vec::new();
    for page in 0..pages {
        let angle = page as f32 * std::f32::consts::TAU / pages as f32;
        let first = positions.len() as u32;
        for i in 1..=2 {
            let x = i as f32;
            positions.extend((0..4).map(|j| [x * angle.cos(), j as f32 + 0.2 * x, x * angle.sin()]));
        }
        for j in 0..3 {
            faces.push(vec![j, first + j, first + j + 1, j + 1]);
            faces.push(vec![first + j, first + 4 + j, first + 5 + j, first + j + 1]);
        }
    }
    mesh(positions, &faces)
}

/// Two cubes that share a vertex.
fn bow_tie() -> ControlMesh {
    let one = cube();
    let other = |v: u32| if v == 0 { 7 } else { 7 + v };
    let mut positions = one.positions.clone();
    positions.extend(one.positions[1..].iter().map(|p| p.map(|c| c + 1.0)));
    let mut faces: Vec<Vec<u32>> = one.face_vertices.chunks(4).map(<[u32]>::to_vec).collect();
    faces.extend(one.face_vertices.chunks(4).map(|face| face.iter().map(|&v| other(v)).collect::<Vec<_>>()));
    mesh(positions, &faces)
}

#[test]
fn sharp_and_non_manifold_cages_give_the_limit_surface_and_cover_it_once() {
    let mut smooth_prism = prism(3);
    smooth_prism.options.triangles = TriangleSubdivision::Smooth;
    let mut one_sided = cube();
    one_sided.face_vertices[..4].reverse();
    for cage in [cube(), prism(5), sheet(4, 3), pole(6, 2), book(3), book(5), bow_tie(), smooth_prism, one_sided] {
        for creasing in [Creasing::Uniform, Creasing::Chaikin] {
            for mesh in [cage.clone(), sharpened(cage.clone(), creasing)] {
                let area: f64 = mesh.ptex_face_count() as f64;
                for (level, midpoints) in [(0, false), (1, true), (2, false), (4, false)] {
                    let tables = refine(&mesh, level, false, midpoints);
                    assert!((check(&mesh, &tables) - area).abs() < 1e-9);
                }
                assert!((check(&mesh, &refine(&mesh, 2, true, false)) - area).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn infinite_creases_cost_nothing_along_their_length() {
    let mut mesh = sheet(8, 8);
    mesh.creases = (0..8).map(|i| Crease { vertices: [36 + i, 37 + i], sharpness: 10.0 }).collect();
    let tables = refine(&mesh, 6, false, false);
    assert_eq!(tables.total_counts(), PatchCounts { regular: 64, transition: 0, filling: 0 });
    // One edge less, and only the dart at its end is isolated.
    mesh.creases.pop();
    let counts = |level: u32| {
        let counts = refine(&mesh, level, false, false).total_counts();
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
            for midpoints in [false, true] {
                let covered = check(mesh, &refine(mesh, level, false, midpoints));
                assert_eq!(covered, mesh.ptex_face_count() as f64);
            }
        }
        assert_eq!(check(mesh, &refine(mesh, 2, true, false)), mesh.ptex_face_count() as f64);
    }
}

#[test]
fn boundary_faces_have_no_limit_without_boundary_interpolation() {
    let mut mesh = sheet(5, 4);
    mesh.options.boundary = BoundaryInterpolation::None;
    let tables = refine(&mesh, 2, false, false);
    assert_eq!(check(&mesh, &tables), 6.0);
    assert_eq!(Evaluator::new(&mesh).unwrap().evaluate(0, 0.5, 0.5), None);
}

#[test]
fn an_isolated_vertex_of_valence_n_adds_3n_regular_patches_a_level() {
    for n in [3, 5, 6, 7, 40] {
        let depth = 6;
        let tables = refine(&pole(n, 3), depth, false, false);
        let rings = PatchCounts { regular: 0, transition: 2 * n, filling: 0 };
        // Level 0: nine faces a sector, less the irregular one; two of them border it. The rim is regular too.
        assert_eq!(tables.counts[0], PatchCounts { regular: 6 * n, ..rings });
        for k in 1..depth as usize {
            assert_eq!(tables.counts[k], PatchCounts { regular: n, ..rings }, "valence {n}, level {k}");
        }
        assert_eq!(tables.counts[depth as usize], PatchCounts { regular: 3 * n, transition: 0, filling: n });
        for k in 2..=depth as usize {
            assert_eq!(tables.levels[k].points.len() as u32, 12 * n + 1, "points of level {k}");
        }
    }
}

#[test]
fn a_cube_has_no_regular_patch_before_level_2() {
    let counts = refine(&cube(), 3, false, false).counts;
    assert_eq!(counts[0], PatchCounts::default());
    assert_eq!(counts[1], PatchCounts::default());
    assert_eq!(counts[2], PatchCounts { regular: 24, transition: 48, filling: 0 });
    assert_eq!(counts[3], PatchCounts { regular: 72, transition: 0, filling: 24 });
}

#[test]
fn a_regular_sheet_is_never_split() {
    let tables = refine(&sheet(4, 4), 6, false, false);
    assert_eq!(tables.total_counts(), PatchCounts { regular: 16, transition: 0, filling: 0 });
    assert_eq!(tables.point_count(), 25);
}

#[test]
fn stencil_rows_read_only_points_that_are_made_before_them() {
    for mesh in [prism(40), pole(7, 2)] {
        let tables = refine(&mesh, 3, false, true);
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
