//! Gregory patches on the device: spokes against their CPU twin, and what is drawn against the f64 evaluator.

use std::collections::HashMap;

use planish_render::limit::limit_with_tangents;
use planish_render::spokes::spokes;
use planish_render::{
    Culling, Density, EndCap, FrameNeeds, FrameOptions, GregoryPoints, Selection, Spacing, SurfaceDesc, SurfaceMethod,
    TableNormals, TableWeights,
};
use planish_subdiv::gregory::{GregorySurface, Normals};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::scheme::Scheme;

use crate::lab::Lab;
use crate::world::{World, scene};

const SIZE: [u32; 2] = [96, 64];
/// Extraordinary vertices, triangles and other faces, boundaries, creases and darts, semi-sharp rules, and several meshes at once.
pub const SCENES: [&str; 12] = [
    "adjacent_extraordinary",
    "mixed_triangles_quads",
    "ngon_5",
    "ngon_40",
    "boundary_valences",
    "crease_infinite_extraordinary",
    "dart_extraordinary",
    "crease_2_3",
    "corner_infinite",
    "nonmanifold_sectors",
    "smooth_triangles_ngon",
    "several.json",
];

pub const DESC: SurfaceDesc = SurfaceDesc {
    method: SurfaceMethod::Gregory,
    level: 0,
    crease_patches: CreasePatches::Infinite,
    end_cap: EndCap::Quad,
    displaced: false,
    gregory_points: GregoryPoints::TwoStage,
    scheme: Scheme::CatmullClark,
    table_normals: TableNormals::Tangents,
    table_weights: TableWeights::Float,
};

pub fn world(lab: &Lab, name: &str) -> World {
    let (meshes, objects) = scene(name, false);
    World::with_desc(&lab.device, name, meshes, objects, DESC, None)
}

fn frame(lab: &Lab, world: &mut World, spacing: Spacing) {
    let camera = world.cameras(SIZE)[0];
    let (density, selection, culling) = (Density::Tess(5.3), Selection::Dynamic, Culling::Off);
    let options = FrameOptions { density, selection, culling, object_lod: false };
    lab.run(&mut world.surface, spacing, &camera, &options);
}

#[test]
fn spokes_are_those_of_their_twin() {
    let lab = Lab::gregory();
    for name in SCENES {
        let mut world = world(&lab, name);
        frame(&lab, &mut world, Spacing::FractionalOdd);
        let tables = world.surface.tables();
        let points = world.surface.download_points(&lab.device).expect("points");
        let in_use = world.surface.download_rows_in_use(&lab.device).expect("rows");
        let (limits, tangents) = limit_with_tangents(tables, &points);
        let expected = spokes(tables, &points, &limits, &tangents);
        let made = world.surface.download_spokes(&lab.device).expect("spokes");
        let size = points.iter().flatten().fold(0.0_f32, |size, c| size.max(c.abs()));
        let mut compared = 0;
        for &limit in in_use.last().expect("limit points") {
            let [first, count] = tables.gregory.of_limit[limit as usize];
            for i in first as usize..(first + count) as usize {
                let parts = |point: &planish_shaders::SpokePoint| [point.edge, point.across, point.beside].concat();
                let parts = parts(&made[i]).into_iter().zip(parts(&expected[i]));
                // Of a point's own size, as quotients of what lies around it may cancel.
                let off = parts.map(|(made, twin)| (made - twin).abs()).fold(0.0, f32::max);
                let bound = if lab.is_exact() { 0.0 } else { 4.0 * f32::EPSILON * size };
                assert!(off <= bound, "{name}: spoke {i} of limit point {limit} is off by {off}");
                compared += 1;
            }
        }
        assert!(compared > 10, "{name}: {compared} spokes");
    }
    lab.assert_silent();
}

#[test]
fn what_is_drawn_is_the_patch() {
    for (exact_normals, normals) in [(false, Normals::Approximate), (true, Normals::Exact)] {
        let lab = Lab::with_needs(|spacing| FrameNeeds { gregory: true, exact_normals, ..FrameNeeds::all(spacing) });
        let passes = lab.dump_passes(&DESC, Spacing::FractionalEven);
        for name in SCENES.into_iter().filter(|name| !name.contains('.')) {
            let mut world = world(&lab, name);
            frame(&lab, &mut world, Spacing::FractionalEven);
            let vertices = lab.dump(&world.surface, &passes);
            let tables = world.surface.tables();
            let surface = GregorySurface::new(tables, &world.meshes[0].positions);
            let patches: HashMap<u32, _> = (0..)
                .zip(&tables.irregular)
                .filter_map(|(i, face)| Some((face.info.location.ptex_face, surface.patch(i)?)))
                .collect();
            let size = world.meshes[0].positions.iter().flatten().fold(0.0_f32, |m, c| m.max(c.abs()));
            let mut compared = 0;
            for vertex in vertices.iter().filter(|vertex| [3, 4].contains(&(vertex.level_and_kind >> 8 & 255))) {
                let [u, v] = vertex.uv.map(f64::from);
                let point = patches[&vertex.ptex_face].evaluate(u, v, normals);
                let told = || format!("{name}: face {} at {u}, {v}", vertex.ptex_face);
                for c in 0..3 {
                    let off = (vertex.position[c] - point.position[c] as f32).abs() / size;
                    assert!(off < 2e-6, "{}: off by {off}", told());
                }
                // Corners and edges have the normals that all patches around them have.
                let is_inside = [u, v].iter().all(|t| (0.01..0.99).contains(t));
                let Some(normal) = point.normal().filter(|_| is_inside) else { continue };
                let cosine: f64 = (0..3).map(|c| normal[c] * f64::from(vertex.normal[c])).sum();
                assert!(cosine > 1.0 - 1e-6, "{}: normal {normal:?}, not {:?}", told(), vertex.normal);
                compared += 1;
            }
            assert!(compared > 100, "{name}: {compared} points");
        }
        lab.assert_silent();
    }
}
