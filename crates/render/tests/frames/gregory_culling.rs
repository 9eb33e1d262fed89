//! What culling leaves out of Gregory patches: nothing that could be seen, and without a trace in any image.

use std::array::from_fn;

use glam::Vec3;
use planish_render::{
    Culling, Density, EndCap, FrameNeeds, FrameOptions, GregoryPoints, ObjectDesc, PatchKind, Spacing, SurfaceDesc,
};
use planish_subdiv::ControlMesh;
use planish_subdiv::refine::CreasePatches;

use crate::culling::{CLOSED, EYES, OPEN, Tally, WAYS, check_left_out, options, triangles};
use crate::gregory::DESC;
use crate::lab::{Easel, Lab, SPACINGS};
use crate::world::{World, scene};

/// Triangles, faces of more sides, creases; with whether they are closed.
const MORE: [(&str, bool); 8] = [
    ("mixed_triangles_quads", false),
    ("ngon_5", false),
    ("ngon_40", false),
    ("smooth_triangles_ngon", false),
    ("crease_2_3", false),
    ("cube_all_semisharp", true),
    ("dart_extraordinary", false),
    ("crease_infinite_extraordinary", false),
];
fn scenes() -> impl Iterator<Item = (&'static str, bool)> {
    let closed = CLOSED.into_iter().map(|name| (name, true));
    closed.chain(OPEN.into_iter().map(|name| (name, false))).chain(MORE)
}

fn lab(points: GregoryPoints) -> Lab {
    Lab::with_needs(|spacing| FrameNeeds { gregory: true, gregory_points: points, ..FrameNeeds::all(spacing) })
}

fn world(lab: &Lab, (name, is_closed): (&str, bool), desc: SurfaceDesc) -> World {
    let (meshes, objects) = scene(name, is_closed);
    World::with_desc(&lab.device, name, meshes, objects, desc, None)
}

/// A sphere of 512 triangles.
fn sphere(lab: &Lab, desc: SurfaceDesc) -> World {
    const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];
    // An octahedron's faces, split into 4 three times.
    let octant = |i: usize| {
        let [x, y, z] = from_fn(|axis| if i >> axis & 1 == 0 { AXES[axis] } else { -AXES[axis] });
        if i.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    let mut faces: Vec<[Vec3; 3]> = (0..8).map(octant).collect();
    for _ in 0..3 {
        let split = |[a, b, c]: [Vec3; 3]| {
            let [ab, bc, ca] = [a + b, b + c, c + a].map(Vec3::normalize);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(split).collect();
    }
    let mut mesh = ControlMesh { face_sizes: vec![3; faces.len()], ..ControlMesh::default() };
    for corner in faces.into_iter().flatten() {
        let found = mesh.positions.iter().position(|&p| Vec3::from(p).distance(corner) < 1e-4);
        mesh.face_vertices.push(found.unwrap_or(mesh.positions.len()) as u32);
        mesh.positions.extend(found.is_none().then_some(corner.to_array()));
    }
    let object = ObjectDesc { hides_backs: true, ..ObjectDesc::identity(0) };
    World::with_desc(&lab.device, "sphere", vec![mesh], vec![object], desc, None)
}

/// All of them; with stencils, which the lists do not depend on, every third.
fn worlds(lab: &Lab, desc: SurfaceDesc) -> impl Iterator<Item = World> + '_ {
    let step = if desc.gregory_points == GregoryPoints::Stencil { 3 } else { 1 };
    scenes().step_by(step).map(move |named| world(lab, named, desc)).chain([sphere(lab, desc)])
}

/// Surfaces that are made so, from some eyes each: nothing is left out that could be seen; returns how much of what could be was.
fn check_surfaces(desc: SurfaceDesc) -> Tally {
    let lab = lab(desc.gregory_points);
    let mut tally = Tally::default();
    for (turn, mut world) in worlds(&lab, desc).enumerate() {
        // All ways on few patches, of the others one in turn.
        let ways =
            WAYS.into_iter().enumerate().filter(|(w, _)| world.meshes[0].face_sizes.len() < 30 || w % 5 == turn % 5);
        for (w, (spacing, factor)) in ways.collect::<Vec<_>>() {
            let (density, any) = (Density::Tess(factor), world.camera_from(EYES[0], [96, 64]));
            let all = triangles(&lab, &mut world, spacing, &any, density);
            for (i, &eye) in EYES.iter().enumerate().filter(|(i, _)| (i + turn + w) % 4 == 0) {
                let size = if (i / 2 + turn) % 3 == 0 { [48, 32] } else { [640, 480] };
                let camera = world.camera_from(eye, size);
                check_left_out(&lab, &mut world, (spacing, density), &camera, &all, &mut tally);
            }
        }
    }
    println!("{tally:?}");
    lab.assert_silent();
    tally
}

#[test]
fn no_triangle_of_a_gregory_patch_that_is_left_out_could_be_seen() {
    for gregory_points in [GregoryPoints::TwoStage, GregoryPoints::Stencil] {
        let tally = check_surfaces(SurfaceDesc { gregory_points, ..DESC });
        assert!(tally.unseen[0] > 300 && tally.found[0] > tally.unseen[0] / 3, "{tally:?}");
    }
}

#[test]
fn no_triangle_of_a_gregory_end_cap_that_is_left_out_could_be_seen() {
    let capped = SurfaceDesc { level: 1, end_cap: EndCap::Gregory, ..SurfaceDesc::default() };
    let tally = check_surfaces(SurfaceDesc { crease_patches: CreasePatches::Single, ..capped });
    assert!(tally.unseen[0] > 1000 && tally.found[0] > tally.unseen[0] / 2, "{tally:?}");
}

/// Gregory quads and thirds of triangles of the last frame.
fn counts(world: &World) -> [u32; 2] {
    let heads = world.surface.status().expect("status").draw_heads;
    [PatchKind::Gregory, PatchKind::Triangle].map(|kind| heads[kind as usize].count)
}

#[test]
fn images_of_gregory_patches_are_the_same_bits_with_culling_and_without() {
    const SIZE: [u32; 2] = [96, 64];
    // Each spacing once: making the programs takes longer than the frames do.
    let [equal, odd, even] = SPACINGS;
    for (gregory_points, spacings) in
        [(GregoryPoints::TwoStage, vec![equal, odd]), (GregoryPoints::Stencil, vec![even])]
    {
        let (lab, desc) = (lab(gregory_points), SurfaceDesc { gregory_points, ..DESC });
        let easels: Vec<_> = spacings
            .into_iter()
            .map(|spacing| [false, true].map(|back| Easel::with_desc(&lab, &desc, spacing, back, SIZE)))
            .collect();
        let hero = world(&lab, ("hero", true), desc);
        for (turn, mut world) in worlds(&lab, desc).chain([hero]).enumerate() {
            for (i, &eye) in EYES.iter().enumerate().filter(|(i, _)| (i + turn) % 3 == 0) {
                let camera = world.camera_from(eye, SIZE);
                let density = if i % 3 == 0 { Density::Tess(6.0) } else { Density::EdgePixels([1.5, 4.0][i % 2]) };
                let culled = options(&world, &camera, density);
                let hides = world.objects.iter().all(|object| object.hides_backs && !object.is_mirrored());
                let cull_back = hides && culled.culling == Culling::UnseenAndBacks;
                let easel = &easels[(turn + i / 3) % easels.len()][usize::from(cull_back)];
                let unculled = FrameOptions { culling: Culling::Off, ..culled };
                let expected = lab.draw(&mut world.surface, easel, &camera, &unculled);
                let images = lab.draw(&mut world.surface, easel, &camera, &culled);
                assert!(images == expected, "{} {:?} from {}", world.name, easel.spacing, camera.eye());
            }
        }
        lab.assert_silent();
    }
}

#[test]
fn a_good_share_of_the_gregory_patches_of_closed_meshes_is_left_out() {
    /// Of what is in view the largest shares that may be drawn, of quads and of thirds of triangles: half of them show their backs.
    const MOST: [[f64; 2]; 2] = [[0.85, 0.85], [0.95, 1.0]];
    let lab = lab(GregoryPoints::TwoStage);
    let mut worlds = [world(&lab, ("hero", true), DESC), sphere(&lab, DESC)];
    let even = (Spacing::Equal, Density::Tess(8.0));
    for (way, most) in [even, (Spacing::Equal, Density::EdgePixels(2.0))].into_iter().zip(MOST) {
        let (mut drawn, mut all) = ([0; 2], [0; 2]);
        for world in &mut worlds {
            for (direction, distance) in EYES.into_iter().filter(|(_, distance)| *distance > 0.7) {
                let camera = world.camera_from((direction, distance), [1280, 960]);
                for (culling, sum) in [(Culling::Unseen, &mut all), (Culling::UnseenAndBacks, &mut drawn)] {
                    let options = FrameOptions { culling, ..options(world, &camera, way.1) };
                    lab.run(&mut world.surface, way.0, &camera, &options);
                    sum.iter_mut().zip(counts(world)).for_each(|(sum, count)| *sum += count);
                }
            }
        }
        println!("{way:?}: {drawn:?} of {all:?} quads and thirds of triangles in view are drawn");
        for (kind, most) in most.into_iter().enumerate() {
            assert!(drawn[kind] > 0 && f64::from(drawn[kind]) <= most * f64::from(all[kind]), "{drawn:?} of {all:?}");
        }
    }
    lab.assert_silent();
}
