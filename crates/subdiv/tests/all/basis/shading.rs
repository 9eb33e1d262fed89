//! Normals by Subdivision Shading beside those of tangents, around extraordinary vertices.

use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisOptions, Tables};

use super::{bipyramid, cross, grid_point, unit};
use crate::surface::{distance, points};

/// Level of the tables: four halvings of the step are looked at.
const LEVEL: u32 = 5;

/// Geometric normals of the vertices that have rings; others are not asked for.
fn ring_normals(tables: &Tables, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let first = tables.levels[tables.basis.ring_level as usize].points.start as usize;
    let mut normals = vec![[0.0; 3]; points.len()];
    for (i, (ring, is_closed)) in tables.basis.rings.iter().enumerate() {
        let own = points[first + i];
        let offset = |k: usize| -> [f64; 3] {
            let point = points[ring[k % ring.len()] as usize];
            std::array::from_fn(|c| point[c] - own[c])
        };
        let count = if *is_closed { ring.len() } else { ring.len() - 1 };
        let normal = (0..count)
            .map(|k| cross(offset(k), offset(k + 1)))
            .fold([0.0; 3], |sum: [f64; 3], n| std::array::from_fn(|c| sum[c] + n[c]));
        normals[first + i] = unit(normal);
    }
    normals
}

/// Angles between the normals at the pole of a fan and one step away along an edge, the step being halved from one to the next: by
/// Subdivision Shading, and of tangents.
fn angles(valence: u32) -> [Vec<f64>; 2] {
    let mesh = bipyramid(valence);
    let options = BasisOptions { scheme: Scheme::Loop, steps: 1, level: LEVEL, ring_level: Some(1), has_weights: true };
    let tables = Tables::of_basis(&mesh, &options).expect("tables");
    let points = points(&mesh.positions, &tables);
    let normals = ring_normals(&tables, &points);
    // The first face's first corner is the pole.
    let at = |u: f64| {
        let segments = 1 << LEVEL;
        let patches = tables.basis.patches.iter().filter(|patch| patch.ptex_face == 0);
        let places = patches
            .flat_map(|patch| (0..=segments).flat_map(move |j| (0..=segments - j).map(move |i| (patch, [i, j]))));
        let mut found = places.filter_map(|(patch, place)| {
            let point = grid_point(&tables, &points, patch, place);
            let shaded = unit(grid_point(&tables, &normals, patch, place).position);
            (point.uv == [u, 0.0]).then_some([shaded, point.normal])
        });
        found.next().expect("a point of the grid")
    };
    let pole = at(0.0);
    let steps = (1..=LEVEL).map(|k| at(0.5 * 0.5_f64.powi(k as i32)));
    let mut angles = [Vec::new(), Vec::new()];
    for step in steps {
        for (kind, angles) in angles.iter_mut().enumerate() {
            angles.push(2.0 * (0.5 * distance(step[kind], pole[kind])).asin());
        }
    }
    angles
}

#[test]
fn subdivision_shading_is_as_smooth_as_the_surface_and_tangent_normals_are_not() {
    for valence in 3..=18 {
        let [shaded, tangent] = angles(valence);
        let ratio = |angles: &[f64]| angles[LEVEL as usize - 1] / angles[LEVEL as usize - 2];
        // Points around a vertex come nearer by this eigenvalue from one halving to the next: a half where the surface is regular.
        let eigenvalue = 0.375 + 0.25 * (std::f64::consts::TAU / f64::from(valence)).cos();
        let bent = ratio(&shaded) / eigenvalue;
        assert!((bent - 1.0).abs() < 0.02, "valence {valence}: shading turns {bent} as much a length as a step before");
        if valence < 5 {
            // The surface's curvature grows without bound.
            let bent = ratio(&tangent) / eigenvalue;
            assert!(bent > 1.1, "valence {valence}: the surface turns {bent} as much a length as a step before");
        }
    }
}
