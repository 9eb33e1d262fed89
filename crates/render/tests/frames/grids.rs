//! Faces that are grids, by table and of substitutes: what the kernels list and the normals that they make, against their twins.

use planish_render::limit::limit;
use planish_render::table::vertex_normals;
use planish_render::{
    Culling, Density, FrameNeeds, FrameOptions, PatchKind, Spacing, SurfaceDesc, SurfaceMethod, TableNormals,
};
use planish_subdiv::scheme::Scheme;

use crate::lab::Lab;
use crate::twin::Twin;
use crate::world::World;

const SIZE: [u32; 2] = [96, 64];

/// Checks frames of the objects, or of a scene of triangles; returns how many faces were listed and how many were left out.
fn check(lab: &Lab, world: &mut World) -> [usize; 2] {
    let faces = world.surface.objects().iter().map(|object| object.patch_count as usize).sum::<usize>();
    let (mut listed, mut left_out) = (0, 0);
    for (number, camera) in world.cameras(SIZE).into_iter().enumerate() {
        for density in [Density::EdgePixels(6.0), Density::Tess(5.3), Density::Tess(100.0)] {
            let culling = if number % 2 == 0 { Culling::Unseen } else { Culling::Off };
            let options = FrameOptions { density, culling, ..FrameOptions::default() };
            world.move_cages(number);
            lab.run(&mut world.surface, Spacing::Equal, &camera, &options);
            let twin = Twin::new(lab, world, Spacing::Equal, &camera, &options);
            let (entries, expected) = (lab.entries(&world.surface), &twin.entries);
            assert_eq!(
                entries[PatchKind::Table as usize],
                expected[PatchKind::Table as usize],
                "{} {density:?}",
                world.name
            );
            listed += expected[PatchKind::Table as usize].len();
            left_out += faces - expected[PatchKind::Table as usize].len();
            check_points(lab, world, &twin);
        }
    }
    [listed, left_out]
}

fn check_points(lab: &Lab, world: &World, twin: &Twin) {
    let (surface, desc) = (&world.surface, world.surface.desc());
    assert_eq!(surface.download_points(&lab.device).expect("points"), twin.points, "{}", world.name);
    let mut limits = limit(surface.tables(), &twin.points);
    if desc.has_vertex_normals() {
        let (normals, of_limits) = vertex_normals(surface.tables(), desc.table_normals, &twin.points);
        let first = surface.tables().levels[surface.tables().basis.ring_level as usize].points.start as usize;
        let found = surface.download_vertex_normals(&lab.device).expect("normals");
        assert_eq!(found.len(), normals.len());
        let named = format!("{} {:?}", world.name, desc.table_normals);
        found[first..].iter().zip(&normals[first..]).for_each(|(made, twin)| lab.assert_normal(*made, *twin, &named));
        limits.iter_mut().zip(of_limits).for_each(|(limit, normal)| limit.normal = normal);
    }
    if !limits.is_empty() {
        let found = surface.download_limits(&lab.device).expect("limits");
        lab.assert_limits(&found, &limits, &format!("{} {:?}", world.name, desc.table_normals));
    }
}

#[test]
fn grids_and_normals_of_vertices_equal_their_twins_bit_for_bit() {
    use TableNormals::{Geometric, Subdivision, Tangents};
    let table = SurfaceDesc { method: SurfaceMethod::Table, ..SurfaceDesc::default() };
    let of_triangles = |scheme, table_normals| SurfaceDesc { scheme, table_normals, ..table };
    let mut sums = [0, 0];
    for (scene, desc) in [
        (None, table),
        (None, SurfaceDesc { table_normals: Subdivision(0), ..table }),
        (None, SurfaceDesc { table_normals: Subdivision(2), ..table }),
        (Some("loop_valences"), of_triangles(Scheme::Loop, Subdivision(1))),
        (Some("loop_sheet"), of_triangles(Scheme::Butterfly, Geometric)),
        (Some("stam_mixed"), of_triangles(Scheme::LoopStam, Tangents)),
        (Some("stam_mixed"), SurfaceDesc { method: SurfaceMethod::Phong, ..table }),
    ] {
        let vertex_normals = desc.has_vertex_normals();
        let lab = Lab::with_needs(|spacing| FrameNeeds { grids: true, vertex_normals, ..FrameNeeds::all(spacing) });
        let mut world = match scene {
            None => World::with_objects(&lab.device, desc),
            Some(name) => {
                let (meshes, objects) = crate::world::scene(&format!("schemes/{name}"), false);
                World::with_desc(&lab.device, name, meshes, objects, desc, None)
            }
        };
        let found = check(&lab, &mut world);
        sums = [sums[0] + found[0], sums[1] + found[1]];
        lab.assert_silent();
    }
    assert!(sums[0] > 10_000 && sums[1] > 1000, "{sums:?}");
}
