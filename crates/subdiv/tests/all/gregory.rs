//! Gregory patches in f64 from the tables, against the limit surface and their own theory (Loop et al. 2009).

use planish_generate::random::Random;
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::gregory::{GregoryPatch, GregorySurface, Normals, Vec3};
use planish_subdiv::mesh::Crease;
use planish_subdiv::patch::{SurfacePoint, evaluate, reflect};
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::tables::Tables;

use crate::cages::{cube, mesh, pole, prism, random, sheet};

fn tables(mesh: &ControlMesh) -> Tables {
    let options = RefineOptions { max_level: 0, gregory: true, ignores_channels: true, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a cage"))
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|c| a[c] * b[c]).sum()
}

fn minus(a: Vec3, b: Vec3) -> Vec3 {
    [0, 1, 2].map(|c| a[c] - b[c])
}

fn length(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

fn angle(a: Vec3, b: Vec3) -> f64 {
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    length(cross).atan2(dot(a, b))
}

/// A drawn piece of a mesh by its Ptex face: what it is, and its value anywhere.
struct Piece<'a> {
    ptex_face: u32,
    at: Box<dyn Fn(f64, f64) -> SurfacePoint + 'a>,
}

fn pieces<'a>(tables: &'a Tables, surface: &GregorySurface, cage: &'a [[f32; 3]]) -> Vec<Piece<'a>> {
    let mut pieces = Vec::new();
    for patch in &tables.patches {
        let mut points = patch.points.map(|i| cage[i as usize].map(f64::from));
        reflect(&mut points, patch.info.boundary);
        let at = Box::new(move |u, v| evaluate(&points, u, v));
        pieces.push(Piece { ptex_face: patch.info.location.ptex_face, at });
    }
    for (i, face) in (0..).zip(&tables.irregular) {
        if let Some(patch) = surface.patch(i) {
            let at = Box::new(move |u, v| patch.evaluate(u, v, Normals::Approximate));
            pieces.push(Piece { ptex_face: face.info.location.ptex_face, at });
        }
    }
    pieces
}

/// Cages of all kinds: extraordinary vertices of both ends of edges, triangles, n-gons and boundaries.
fn cages() -> Vec<(String, ControlMesh)> {
    let mut cages = vec![("cube".to_owned(), cube()), ("sheet".to_owned(), sheet(3, 4))];
    cages.extend([3, 5, 6, 7, 8, 12, 20, 40].map(|n| (format!("pole {n}"), pole(n, 2))));
    cages.extend([3, 5, 6, 7].map(|n| (format!("prism {n}"), prism(n))));
    let corners = vec![[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let faces = [vec![0, 1, 3], vec![0, 2, 1], vec![0, 3, 2], vec![1, 2, 3]];
    cages.push(("tetrahedron".to_owned(), mesh(corners, &faces)));
    cages
}

#[test]
fn the_tangent_plane_is_continuous_across_every_smooth_edge() {
    for (name, mesh) in cages() {
        let tables = tables(&mesh);
        let surface = GregorySurface::new(&tables, &mesh.positions);
        let pieces = pieces(&tables, &surface, &mesh.positions);
        // Points of all pieces' edges, found again by their place in space.
        let mut normals: std::collections::HashMap<[i64; 3], Vec<(u32, Vec3)>> = std::collections::HashMap::new();
        for piece in &pieces {
            for i in 1..8 {
                let t = f64::from(i) / 8.0;
                for (u, v) in [(t, 0.0), (1.0, t), (t, 1.0), (0.0, t)] {
                    let point = (piece.at)(u, v);
                    let key = point.position.map(|c| (c * 2e4).round() as i64);
                    let normal = point.normal().unwrap_or_else(|| panic!("{name}: no normal at {u}, {v}"));
                    normals.entry(key).or_default().push((piece.ptex_face, normal));
                }
            }
        }
        let mut shared = 0;
        for (_, found) in normals.iter().filter(|(_, found)| found.len() > 1) {
            shared += 1;
            for (face, normal) in &found[1..] {
                let off = angle(found[0].1, *normal);
                assert!(off < 1e-5, "{name}: faces {} and {face} meet at an angle of {off}", found[0].0);
            }
        }
        assert!(shared > 7, "{name}: {shared} shared points");
    }
}

#[test]
fn corners_are_on_the_limit_surface_with_its_normal() {
    for (name, mesh) in cages() {
        let tables = tables(&mesh);
        let surface = GregorySurface::new(&tables, &mesh.positions);
        let mut limit = Evaluator::new(&mesh).expect("a cage");
        for piece in pieces(&tables, &surface, &mesh.positions) {
            // The first corner of every Ptex face is a vertex of the cage.
            let point = (piece.at)(0.0, 0.0);
            let expected = limit.evaluate(piece.ptex_face, 0.0, 0.0).expect("a drawn face");
            let off = length(minus(point.position, expected.position));
            assert!(off < 2e-6, "{name}, face {}: off by {off}", piece.ptex_face);
            let (Some(normal), Some(expected)) = (point.normal(), expected.normal()) else { continue };
            let off = angle(normal, expected).to_degrees();
            assert!(off < 0.01, "{name}, face {}: normal off by {off} degrees", piece.ptex_face);
        }
    }
}

#[test]
fn a_regular_face_drawn_as_a_gregory_patch_is_its_bicubic_patch() {
    // The faces along a crease are not regular where creases are no patches of their own.
    let mut mesh = sheet(4, 4);
    let line = (0..4).map(|j| Crease { vertices: [5 * j + 2, 5 * j + 7], sharpness: 10.0 });
    mesh.creases.extend(line);
    let mut random = Random::new(5);
    mesh.positions.iter_mut().flatten().for_each(|c| *c += 0.2 * (random.unit() as f32 - 0.5));
    let mut limit = Evaluator::new(&mesh).expect("a cage");
    let options =
        RefineOptions { max_level: 0, gregory: true, crease_patches: CreasePatches::None, ..RefineOptions::default() };
    let refinement = Refinement::new(&mesh, options).expect("a cage");
    let tables = Tables::new(&refinement);
    let surface = GregorySurface::new(&tables, &mesh.positions);
    let mut compared = 0;
    for (i, face) in (0..).zip(&tables.irregular) {
        let Some(patch) = surface.patch(i) else { continue };
        for (u, v) in [(0.0, 0.0), (0.3, 0.7), (1.0, 0.2), (0.5, 0.5), (0.9, 1.0)] {
            let point = patch.evaluate(u, v, Normals::Exact);
            let expected = limit.evaluate(face.info.location.ptex_face, u, v).expect("a drawn face");
            for (a, b) in [(point.position, expected.position), (point.du, expected.du), (point.dv, expected.dv)] {
                assert!(length(minus(a, b)) < 1e-5, "face {i} at {u}, {v}: {a:?}, expected {b:?}");
            }
            compared += 1;
        }
    }
    assert!(compared > 0, "the sheet has no irregular face");
}

#[test]
fn exact_derivatives_are_those_of_the_patch() {
    for (name, mesh) in cages() {
        let tables = tables(&mesh);
        let surface = GregorySurface::new(&tables, &mesh.positions);
        let patches: Vec<GregoryPatch> = (0..tables.irregular.len() as u32).filter_map(|i| surface.patch(i)).collect();
        for patch in &patches {
            let (u, v, h) = (0.31, 0.57, 1e-6);
            let at = |u: f64, v: f64| patch.evaluate(u, v, Normals::Exact);
            let slope = |a: SurfacePoint, b: SurfacePoint| minus(b.position, a.position).map(|c| c / (2.0 * h));
            let point = at(u, v);
            let (du, dv) = (slope(at(u - h, v), at(u + h, v)), slope(at(u, v - h), at(u, v + h)));
            assert!(length(minus(du, point.du)) < 1e-7 && length(minus(dv, point.dv)) < 1e-7, "{name}");
        }
    }
}

#[test]
fn random_cages_have_patches_near_their_limit_surface() {
    let mut compared = 0;
    for seed in 0..200 {
        let mesh = random(seed);
        if !mesh.edits.is_empty() {
            continue;
        }
        let tables = tables(&mesh);
        let surface = GregorySurface::new(&tables, &mesh.positions);
        let mut limit = Evaluator::new(&mesh).expect("a cage");
        let size = mesh.positions.iter().flatten().fold(0.0_f64, |m, c| m.max(f64::from(c.abs())));
        for (i, face) in (0..).zip(&tables.irregular) {
            let Some(patch) = surface.patch(i) else { continue };
            let ptex_face = face.info.location.ptex_face;
            // At vertices of valence 2 the tangents of both edges are one: such patches may overshoot.
            let has_valence_2 = tables.gregory.faces[i as usize].cosines.iter().any(|&c| c <= -0.99);
            for (u, v) in [(0.0, 0.0), (0.5, 0.5), (0.25, 0.75), (1.0, 0.5), (1.0, 1.0)] {
                let point = patch.evaluate(u, v, Normals::Approximate);
                let expected = limit.evaluate(ptex_face, u, v).expect("a drawn face");
                let off = length(minus(point.position, expected.position)) / size;
                // These cages have few and large faces.
                let most = if u + v == 0.0 { 2e-6 } else { 0.5 };
                if !(has_valence_2 && u + v > 0.0) {
                    assert!(off < most, "seed {seed}, face {ptex_face}, at {u}, {v}: off by {off}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 1000);
}

fn stencil_tables(mesh: &ControlMesh) -> Tables {
    let options = RefineOptions { gregory: true, gregory_stencils: true, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a cage"))
}

/// Largest difference of stencils from the points that spokes make, over the largest coordinate; and how many faces have stencils.
fn stencil_error(tables: &Tables, cage: &[[f32; 3]]) -> (f64, usize) {
    let surface = GregorySurface::new(tables, cage);
    let size = cage.iter().flatten().fold(0.0_f64, |m, c| m.max(f64::from(c.abs())));
    let (mut largest, mut compared) = (0.0_f64, 0);
    for face in 0..tables.irregular.len() as u32 {
        let (Some(patch), Some((points, across))) = (surface.patch(face), surface.stencil_points(face, cage)) else {
            continue;
        };
        let expected = patch.points.iter().chain(patch.edges.iter().flat_map(|edge| &edge.across));
        let made = points.iter().chain(&across);
        assert_eq!(made.clone().count(), expected.clone().count());
        largest = made.zip(expected).fold(largest, |m, (a, b)| m.max(length(minus(*a, *b)) / size));
        compared += 1;
    }
    (largest, compared)
}

#[test]
fn stencils_make_the_points_that_spokes_make() {
    let mut all = cages();
    all.extend((0..200).map(|seed| (format!("seed {seed}"), random(seed))));
    let mut compared = 0;
    for (name, mesh) in all.iter().filter(|(_, mesh)| mesh.edits.is_empty()) {
        let (off, faces) = stencil_error(&stencil_tables(mesh), &mesh.positions);
        assert!(off < 1e-6, "{name}: off by {off}");
        compared += faces;
    }
    assert!(compared > 1000, "{compared} faces");
}

#[test]
fn faces_of_one_connectivity_share_a_table() {
    for n in [3, 5, 6, 7, 12, 40] {
        let tables = stencil_tables(&pole(n, 3));
        let stencils = &tables.gregory.stencils;
        let at_pole = stencils.faces.iter().filter(|face| !face.is_of_spokes()).count();
        assert!(at_pole >= n as usize);
        // All faces at the pole are alike.
        assert_eq!(stencils.connectivities.len(), 1, "valence {n}");
        assert_eq!(stencils.connectivities[0].point_count, 2 * n + 8, "valence {n}");
    }
}

#[test]
fn meshes_of_one_connectivity_share_a_table_when_merged() {
    let (a, b) = (stencil_tables(&pole(5, 3)), stencil_tables(&pole(7, 3)));
    let cages = [pole(5, 3), pole(7, 3), pole(5, 3)].map(|mesh| mesh.positions).concat();
    let (merged, _) = Tables::merge(vec![a.clone(), b, a]).expect("small tables");
    assert_eq!(merged.gregory.stencils.connectivities.len(), 2);
    let (off, faces) = stencil_error(&merged, &cages);
    assert!(off < 1e-6 && faces == 5 + 7 + 5, "off by {off} in {faces} faces");
}

#[test]
fn both_faces_at_an_edge_sum_the_same_weights_in_the_same_order() {
    for (name, mesh) in cages() {
        let tables = stencil_tables(&mesh);
        let stencils = &tables.gregory.stencils;
        let mut rows: std::collections::HashMap<(u32, bool), Vec<(u32, u32)>> = std::collections::HashMap::new();
        let mut shared = 0;
        for (face, stencil) in tables.gregory.faces.iter().zip(&stencils.faces).filter(|(_, s)| !s.is_of_spokes()) {
            let table = stencils.connectivities[stencil.connectivity as usize];
            let n = table.corner_count as usize;
            let ring = &stencils.rings[stencil.first_point as usize..][..table.point_count as usize];
            let row = |row: usize, sign: f32| -> Vec<(u32, u32)> {
                let weight =
                    |column: u32| stencils.weights[table.first_weight as usize + column as usize * 8 * n + row];
                let (used, skipped): (Vec<_>, Vec<_>) = ring.iter().partition(|[.., mask]| mask >> row & 1 != 0);
                // The masks skip what has no weight, and that alone.
                assert!(skipped.iter().all(|&&[_, column, _]| weight(column) == 0.0), "{name}: row {row}");
                assert!(used.iter().all(|&&[_, column, _]| weight(column) != 0.0), "{name}: row {row}");
                used.iter().map(|&&[point, column, _]| (point, (sign * weight(column)).to_bits())).collect()
            };
            for edge in 0..n {
                // By the spoke: its edge point and its vector across, to the left of it.
                let next = (edge + 1) % n;
                let found = [
                    ((face.first[edge], false), row(4 * edge, 1.0)),
                    ((face.last[edge], false), row(4 * next + 1, 1.0)),
                    ((face.first[edge], true), row(4 * n + 4 * edge, 1.0)),
                    ((face.last[edge], true), row(4 * n + 4 * edge + 3, -1.0)),
                ];
                for (key, row) in found {
                    if let Some(known) = rows.get(&key) {
                        assert_eq!(known, &row, "{name}: spoke {key:?}");
                        shared += 1;
                    }
                    rows.insert(key, row);
                }
            }
        }
        assert!(shared > 0 || name == "sheet" || name.starts_with("prism"), "{name} shares nothing");
    }
}
