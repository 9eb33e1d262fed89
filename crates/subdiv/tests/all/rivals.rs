//! ACC and Pm-patches in f64 from the tables, against what their papers promise.

use planish_generate::random::Random;
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::gregory::{Rival, RivalPatch, RivalSurface, Vec3};
use planish_subdiv::patch::{SurfacePoint, evaluate, reflect};
use planish_subdiv::refine::{RefineOptions, Refinement};
use planish_subdiv::tables::Tables;

use crate::cages::{cube, pole, prism, sheet};

const RIVALS: [Rival; 2] = [Rival::Acc, Rival::Pm];

fn refined(mesh: &ControlMesh, rival: Rival) -> Result<Tables, planish_subdiv::Error> {
    let options =
        RefineOptions { gregory: true, rival: Some(rival), ignores_channels: true, ..RefineOptions::default() };
    Refinement::new(mesh, options).map(|refinement| Tables::new(&refinement))
}

/// Irregular vertices of many valences, away from boundaries, with some relief.
fn cages() -> Vec<(String, ControlMesh)> {
    let mut cages = vec![("cube".to_owned(), cube())];
    cages.extend([3, 5, 6, 7, 8, 12, 20, 40].map(|n| (format!("pole {n}"), pole(n, 3))));
    let mut random = Random::new(3);
    for (_, mesh) in &mut cages {
        mesh.positions.iter_mut().for_each(|p| p[2] += 0.3 * (random.unit() as f32 - 0.5));
    }
    cages
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|c| a[c] * b[c]).sum()
}

fn distance(a: Vec3, b: Vec3) -> f64 {
    let d = [0, 1, 2].map(|c| a[c] - b[c]);
    dot(d, d).sqrt()
}

fn angle(a: Vec3, b: Vec3) -> f64 {
    let c = cross(a, b);
    dot(c, c).sqrt().atan2(dot(a, b))
}

/// The parameters of edge i at t, and the derivative along it.
fn along(i: usize, t: f64, at: impl Fn(f64, f64) -> SurfacePoint) -> (SurfacePoint, Vec3) {
    let (u, v) = [(t, 0.0), (1.0, t), (1.0 - t, 1.0), (0.0, 1.0 - t)][i];
    let point = at(u, v);
    let along = [point.du, point.dv, point.du.map(|c| -c), point.dv.map(|c| -c)][i];
    (point, along)
}

fn patches(tables: &Tables, rival: Rival, mesh: &ControlMesh) -> Vec<(u32, RivalPatch)> {
    let surface = RivalSurface::new(tables, rival, &mesh.positions);
    (0..tables.irregular.len() as u32).filter_map(|i| Some((i, surface.patch(i)?))).collect()
}

#[test]
fn patches_meet_with_one_tangent_plane() {
    for rival in RIVALS {
        for (name, mesh) in cages() {
            let tables = refined(&mesh, rival).expect("a cage of quads");
            // Points of the edges of all patches, found again by their place in space.
            let mut normals: std::collections::HashMap<[i64; 3], Vec<Vec3>> = std::collections::HashMap::new();
            let mut add = |point: SurfacePoint| {
                let normal = point.normal().unwrap_or_else(|| panic!("{rival:?}, {name}: no normal"));
                normals.entry(point.position.map(|c| (c * 2e4).round() as i64)).or_default().push(normal);
            };
            let edge_points = (0..4).flat_map(|i| (1..8).map(move |k| (i, f64::from(k) / 8.0)));
            for patch in &tables.patches {
                let mut points = patch.points.map(|i| mesh.positions[i as usize].map(f64::from));
                reflect(&mut points, patch.info.boundary);
                edge_points.clone().for_each(|(i, t)| add(along(i, t, |u, v| evaluate(&points, u, v)).0));
            }
            for (_, patch) in patches(&tables, rival, &mesh) {
                edge_points.clone().for_each(|(i, t)| add(along(i, t, |u, v| patch.evaluate(u, v)).0));
            }
            let shared: Vec<_> = normals.values().filter(|found| found.len() > 1).collect();
            assert!(shared.len() > 20, "{rival:?}, {name}: {} shared points", shared.len());
            for found in shared {
                let off = angle(found[0], found[1]);
                assert!(off < 1e-5, "{rival:?}, {name}: faces meet at an angle of {off}");
            }
        }
    }
}

#[test]
fn edges_have_what_both_sides_agree_on() {
    for rival in RIVALS {
        for (name, mesh) in cages() {
            let tables = refined(&mesh, rival).expect("a cage of quads");
            for (face, patch) in patches(&tables, rival, &mesh) {
                for (i, t) in (0..4).flat_map(|i| [0.0, 0.2, 0.5, 0.9, 1.0].map(|t| (i, t))) {
                    let (point, slope) = along(i, t, |u, v| patch.evaluate(u, v));
                    let edge = patch.on_edge(i, t);
                    assert!(distance(point.position, edge.position) < 1e-6, "{rival:?}, {name}, face {face}, edge {i}");
                    assert!(distance(slope, edge.du) < 1e-5, "{rival:?}, {name}, face {face}, edge {i}: {slope:?}");
                    let (Some(own), Some(shared)) = (point.normal(), edge.normal()) else { panic!("no normal") };
                    assert!(angle(own, shared) < 1e-5, "{rival:?}, {name}, face {face}, edge {i} at {t}");
                }
            }
        }
    }
}

#[test]
fn corners_are_limit_points_and_those_of_acc_have_limit_normals() {
    for rival in RIVALS {
        let mut largest_angle = 0.0_f64;
        for (name, mesh) in cages() {
            let tables = refined(&mesh, rival).expect("a cage of quads");
            let mut limit = Evaluator::new(&mesh).expect("a cage");
            for (face, patch) in patches(&tables, rival, &mesh) {
                let ptex_face = tables.irregular[face as usize].info.location.ptex_face;
                for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                    let (point, expected) =
                        (patch.evaluate(u, v), limit.evaluate(ptex_face, u, v).expect("a drawn face"));
                    let off = distance(point.position, expected.position);
                    assert!(off < 2e-6, "{rival:?}, {name}, face {face}: off by {off}");
                    let (Some(normal), Some(expected)) = (point.normal(), expected.normal()) else {
                        panic!("no normal")
                    };
                    largest_angle = largest_angle.max(angle(normal, expected).to_degrees());
                }
            }
        }
        match rival {
            Rival::Acc => assert!(largest_angle < 0.01, "{largest_angle} degrees"),
            // Loop et al. 2009, section 5: Pm-patches only interpolate positions.
            Rival::Pm => assert!(largest_angle > 0.01, "{largest_angle} degrees"),
        }
    }
}

#[test]
fn derivatives_are_those_of_the_patch() {
    for (name, mesh) in cages() {
        let tables = refined(&mesh, Rival::Pm).expect("a cage of quads");
        for (_, patch) in patches(&tables, Rival::Pm, &mesh) {
            // In each of the four triangles.
            for (u, v) in [(0.5, 0.2), (0.9, 0.4), (0.6, 0.8), (0.1, 0.45)] {
                let h = 1e-6;
                let slope =
                    |a: SurfacePoint, b: SurfacePoint| [0, 1, 2].map(|c| (b.position[c] - a.position[c]) / (2.0 * h));
                let point = patch.evaluate(u, v);
                let du = slope(patch.evaluate(u - h, v), patch.evaluate(u + h, v));
                let dv = slope(patch.evaluate(u, v - h), patch.evaluate(u, v + h));
                assert!(distance(du, point.du) < 1e-7 && distance(dv, point.dv) < 1e-7, "{name} at {u}, {v}");
            }
        }
    }
}

#[test]
fn cages_without_a_patch_are_refused_by_face() {
    let mut creased = cube();
    creased.creases.push(planish_subdiv::mesh::Crease { vertices: [0, 1], sharpness: 2.0 });
    let mut sharpened = cube();
    sharpened.corners.push(planish_subdiv::mesh::Corner { vertex: 0, sharpness: 10.0 });
    let mut holed = prism(5);
    holed.holes = vec![0, 1];
    let mut cages = vec![prism(5), prism(3), creased, sharpened, holed];
    // The middle of a pole with one ring is beside the boundary.
    cages.push(pole(5, 1));
    for mesh in cages {
        for rival in RIVALS {
            let refusal = refined(&mesh, rival).expect_err("no patches").to_string();
            assert!(refusal.contains("expects quads alone") && refusal.contains(rival.name()), "{refusal}");
            assert_eq!(refusal.lines().count(), 1);
        }
    }
    // Boundaries of regular faces are no hindrance.
    assert!(refined(&sheet(3, 3), Rival::Acc).is_ok());
}
