//! ACC and Pm-patches on the device: spokes against their CPU twin, and what is drawn against the f64 evaluator.

use std::collections::HashMap;

use planish_render::limit::limit;
use planish_render::rival_spokes::rival_spokes;
use planish_render::{Culling, Density, FrameOptions, Spacing, SurfaceDesc, SurfaceMethod};
use planish_subdiv::gregory::{Rival, RivalSurface};

use crate::lab::Lab;
use crate::world::{World, scene};

const SCENES: [&str; 4] = ["adjacent_extraordinary", "genus_2", "valence_40", "cube"];

fn lab_and_desc(rival: Rival) -> (Lab, SurfaceDesc) {
    let method = match rival {
        Rival::Acc => SurfaceMethod::Acc,
        Rival::Pm => SurfaceMethod::Pm,
    };
    (Lab::of_rival(rival), SurfaceDesc { method, ..SurfaceDesc::default() })
}

/// A scene after a frame of it.
fn drawn(lab: &Lab, desc: SurfaceDesc, name: &str) -> World {
    let (meshes, objects) = scene(name, false);
    let mut world = World::with_desc(&lab.device, name, meshes, objects, desc, None);
    let camera = world.cameras([96, 64])[0];
    let options = FrameOptions { density: Density::Tess(5.3), ..FrameOptions::default() };
    // The points that are tested are those of Gregory patches.
    let culled = FrameOptions { culling: Culling::UnseenAndBacks, ..options };
    assert_eq!(world.surface.frame_input(&camera, &culled).expect("a frame").view.cull, 0, "{name}");
    lab.run(&mut world.surface, Spacing::FractionalEven, &camera, &culled);
    world
}

#[test]
fn spokes_are_those_of_their_twin() {
    for rival in [Rival::Acc, Rival::Pm] {
        let (lab, desc) = lab_and_desc(rival);
        for name in SCENES {
            let world = drawn(&lab, desc, name);
            let tables = world.surface.tables();
            let points = world.surface.download_points(&lab.device).expect("points");
            let expected = rival_spokes(tables, &points, &limit(tables, &points));
            let made = world.surface.download_spokes(&lab.device).expect("spokes");
            let middles = world.surface.download_spoke_middles(&lab.device).expect("middles");
            assert!(made.len() > 10 && made.len() == expected.len(), "{name}: {} spokes", made.len());
            for (i, ((made, middle), (expected, expected_middle))) in made.iter().zip(middles).zip(expected).enumerate()
            {
                let words = |point: &planish_shaders::SpokePoint, middle: [f32; 3]| {
                    let vectors = [point.edge, point.across, point.beside, middle];
                    vectors.map(|v| v.map(|c| if c == 0.0 { 0 } else { c.to_bits() }))
                };
                assert_eq!(words(made, middle), words(&expected, expected_middle), "{rival:?}, {name}: spoke {i}");
            }
        }
        lab.assert_silent();
    }
}

#[test]
fn what_is_drawn_is_the_patch() {
    for rival in [Rival::Acc, Rival::Pm] {
        let (lab, desc) = lab_and_desc(rival);
        let passes = lab.dump_passes(&desc, Spacing::FractionalEven);
        for name in SCENES {
            let world = drawn(&lab, desc, name);
            let vertices = lab.dump(&world.surface, &passes);
            let tables = world.surface.tables();
            let surface = RivalSurface::new(tables, rival, &world.meshes[0].positions);
            let patches: HashMap<u32, _> = (0..)
                .zip(&tables.irregular)
                .filter_map(|(i, face)| Some((face.info.location.ptex_face, surface.patch(i)?)))
                .collect();
            let size = world.meshes[0].positions.iter().flatten().fold(0.0_f32, |m, c| m.max(c.abs()));
            let mut compared = 0;
            for vertex in vertices.iter().filter(|vertex| vertex.level_and_kind >> 8 & 255 == 3) {
                let [u, v] = vertex.uv.map(f64::from);
                let point = patches[&vertex.ptex_face].evaluate(u, v);
                let told = || format!("{rival:?}, {name}: face {} at {u}, {v}", vertex.ptex_face);
                for c in 0..3 {
                    let off = (vertex.position[c] - point.position[c] as f32).abs() / size;
                    assert!(off < 2e-6, "{}: off by {off}", told());
                }
                // Corners have the normal of the limit surface, which those of Pm-patches are not.
                let is_corner = [u, v].iter().all(|&t| t == 0.0 || t == 1.0);
                let Some(normal) = point.normal().filter(|_| !is_corner) else { continue };
                let cosine: f64 = (0..3).map(|c| normal[c] * f64::from(vertex.normal[c])).sum();
                assert!(cosine > 1.0 - 1e-6, "{}: normal {normal:?}, not {:?}", told(), vertex.normal);
                compared += 1;
            }
            assert!(compared > 100, "{name}: {compared} points");
        }
        lab.assert_silent();
    }
}
