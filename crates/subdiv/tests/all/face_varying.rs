//! Face-varying tables: where channels follow the vertices they are the limit surface's x and y, merged ones are what
//! they are alone, and broken channels are refused.

use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{ControlMesh, FaceVaryingInterpolation};
use planish_subdiv::patch::PatchInfo;
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::tables::{FaceVaryingEvaluator, Tables};
use planish_subdiv::topology::NONE;

use crate::cages::{cube, pole, prism, random, seamed, sheet, with_continuous_values};
use crate::surface::points;

fn tables(mesh: &ControlMesh, max_level: u32) -> Tables {
    let options = RefineOptions { max_level, crease_patches: CreasePatches::Single, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a legal cage"))
}

/// The parameters of a place in a patch's square.
fn at(info: &PatchInfo, u: f64, v: f64) -> (f64, f64) {
    let size = f64::from(1_u32 << info.location.depth).recip();
    ((f64::from(info.location.u) + u) * size, (f64::from(info.location.v) + v) * size)
}

#[test]
fn channels_without_seams_follow_the_surface() {
    for seed in 0..60 {
        let mut mesh = with_continuous_values(random(seed));
        mesh.edits.clear();
        // The rule that takes no vertex for sharper than it is.
        mesh.options.face_varying = FaceVaryingInterpolation::None;
        let tables = tables(&mesh, (seed % 4) as u32);
        let values = FaceVaryingEvaluator::new(&tables, 0).expect("a channel");
        let mut surface = Evaluator::new(&mesh).expect("a legal cage");
        for info in tables.patches.iter().map(|patch| patch.info) {
            for (u, v) in [(0.0, 0.0), (0.3, 0.7), (1.0, 0.4)].map(|(u, v)| at(&info, u, v)) {
                let expected = surface.evaluate(info.location.ptex_face, u, v).expect("patches are drawn").position;
                let got = values.evaluate(info.location.ptex_face, u, v).expect("patches have values");
                assert!((0..2).all(|c| (got[c] - expected[c]).abs() < 2e-6), "seed {seed}: {got:?}, {expected:?}");
            }
        }
    }
}

#[test]
fn limit_values_and_tangents_without_seams_are_those_of_the_positions() {
    for mesh in [cube(), prism(5), sheet(3, 2), pole(7, 2)].map(with_continuous_values) {
        let tables = tables(&mesh, 2);
        let table = &tables.face_varying[0];
        let all = points(&mesh.positions, &tables);
        let mut compared = 0;
        for (face, values) in tables.irregular.iter().zip(&table.faces) {
            let limits = face.limits.iter().chain(&face.midpoints);
            for (&limit, &value) in limits.zip(values) {
                assert_eq!(limit == NONE, value == NONE);
                if limit == NONE {
                    continue;
                }
                let row = tables.limits.rows[limit as usize];
                let origin = all[tables.limits.indices[row.first_index as usize] as usize];
                let mut expected = [[origin[0], origin[1]], [0.0; 2], [0.0; 2]];
                for i in 0..row.count {
                    let point = all[tables.limits.indices[(row.first_index + i) as usize] as usize];
                    let weights = tables.limits.weights[(row.first_weight + i) as usize];
                    for (of, weight) in expected.iter_mut().zip(weights) {
                        (0..2).for_each(|c| of[c] += f64::from(weight) * (point[c] - origin[c]));
                    }
                }
                let [s, t] = table.tangents[value as usize];
                for (got, expected) in [table.values[value as usize], s, t].iter().zip(expected) {
                    assert!((0..2).all(|c| (f64::from(got[c]) - expected[c]).abs() < 1e-5), "{got:?}, {expected:?}");
                }
                compared += 1;
            }
        }
        assert!(compared > 0 || mesh.face_sizes.len() == 6);
    }
}

#[test]
fn bilinear_patches_have_their_corner_values_inside() {
    let mut mesh = seamed(sheet(4, 3), 5);
    mesh.options.face_varying = FaceVaryingInterpolation::All;
    let tables = tables(&mesh, 2);
    let (table, channel) = (&tables.face_varying[0], &mesh.face_varying[0]);
    assert!(table.is_linear);
    for (patch, info) in (0..).zip(tables.patches.iter().map(|patch| patch.info)).filter(|(_, info)| info.level == 0) {
        let corners = &channel.indices[4 * info.location.ptex_face as usize..][..4];
        let values = table.corner_values(patch).map(|value| table.values[value as usize]);
        assert_eq!(values.as_slice(), corners.iter().map(|&i| channel.values[i as usize]).collect::<Vec<_>>());
    }
}

#[test]
fn merged_channels_are_what_they_are_alone() {
    let without = prism(5);
    let meshes = [seamed(cube(), 1), without, seamed(pole(7, 2), 2), seamed(sheet(3, 3), 3)];
    let parts: Vec<Tables> = meshes.iter().map(|mesh| tables(mesh, 2)).collect();
    let (merged, ranges) = Tables::merge(parts.clone()).expect("small tables");
    let all = &merged.face_varying[0];
    assert_eq!((all.patches.len(), all.faces.len()), (merged.patches.len(), merged.irregular.len()));
    for (part, mesh) in parts.iter().zip(&ranges) {
        let alone = part.face_varying.first();
        let is_same = |own: Option<&u32>, there: u32| match own {
            None | Some(&NONE) => there == NONE,
            Some(&own) => alone.is_some_and(|alone| {
                let is_limit = (own as usize) < alone.tangents.len();
                let has_same_tangents = !is_limit || alone.tangents[own as usize] == all.tangents[there as usize];
                alone.values[own as usize] == all.values[there as usize] && has_same_tangents
            }),
        };
        for (from, to) in part.patch_ranges.iter().zip(&mesh.patches) {
            for (from, to) in from.clone().zip(to.clone()) {
                let own = alone.map(|alone| &alone.patches[from as usize]);
                let there = &all.patches[to as usize];
                assert!((0..16).all(|i| is_same(own.map(|own| &own[i]), there[i])));
            }
        }
        for (from, to) in part.irregular_ranges.iter().zip(&mesh.irregular) {
            for (from, to) in from.clone().zip(to.clone()) {
                let own = alone.map(|alone| &alone.faces[from as usize]);
                let there = &all.faces[to as usize];
                assert!((0..8).all(|i| is_same(own.map(|own| &own[i]), there[i])));
            }
        }
    }
}

#[test]
fn broken_channels_are_refused() {
    let fault = |change: &dyn Fn(&mut ControlMesh)| {
        let mut mesh = with_continuous_values(cube());
        change(&mut mesh);
        mesh.validate().unwrap_err().to_string()
    };
    let nan = fault(&|mesh| mesh.face_varying[0].values[3][1] = f32::NAN);
    assert_eq!(nan, "face-varying channel 0 (from 0): value 3 (from 0) is not finite, or beyond 1e36");
    let huge = fault(&|mesh| mesh.face_varying[0].values[0][0] = 2e36);
    assert_eq!(huge, "face-varying channel 0 (from 0): value 0 (from 0) is not finite, or beyond 1e36");
    let index = fault(&|mesh| mesh.face_varying[0].indices[5] = 8);
    let expected = "index 8 of corner 5 (both from 0) is out of range: there are 8 values";
    assert_eq!(index, format!("face-varying channel 0 (from 0): {expected}"));
    let count = fault(&|mesh| mesh.face_varying[0].indices.truncate(20));
    assert_eq!(count, "face-varying channel 0 (from 0): 20 indices for 24 face corners");
}
