//! Odd cameras and densities: every frame ends, without a word of the validation layer and without a hole.

use std::collections::{HashMap, HashSet};

use glam::{Mat4, Vec3};
use planish_render::emit::Emitted;
use planish_render::{Culling, Density, Error, FrameCamera, FrameOptions, PatchKind, Selection, Spacing};
use planish_subdiv::eval::Evaluator;
use planish_subdiv::patch::PatchInfo;
use planish_subdiv::topology::Location;

use crate::lab::{Easel, Lab, SPACINGS};
use crate::random::Random;
use crate::world::{World, scene};

const SIZE: [u32; 2] = [64, 48];
/// Few patches, that a density of thousands may cut.
const SCENES: [(&str, u32); 7] = [
    ("single_quad", 0),
    ("tetrahedron", 4),
    ("ngon_5", 3),
    ("hole_ngon", 4),
    ("nonmanifold_edge_3", 3),
    ("edit_hole_ngon", 3),
    ("crease_mixed_3", 4),
];

fn is_small(name: &str) -> bool {
    SCENES[..2].iter().any(|(small, _)| name.starts_with(small))
}

/// Cameras that see well, and such that see nothing or are none.
fn cameras(world: &World, random: &mut Random) -> Vec<FrameCamera> {
    let mut cameras = world.cameras(SIZE).to_vec();
    let sane = cameras[0];
    let [low, high] = world.bounds();
    let object = &world.objects[0];
    let vertex = object.to_world.transform_point3(Vec3::from(world.meshes[object.mesh].positions[0]));
    // On a vertex, looking at the middle and away; from far behind; from beyond what numbers tell apart.
    cameras.push(world.camera(vertex, 0.5 * (low + high) + 0.01, SIZE));
    cameras.push(world.camera(vertex, 2.0 * vertex - 0.5 * (low + high) + 0.01, SIZE));
    cameras.push(world.camera(high + 9.0 * (high - low), high + 20.0 * (high - low), SIZE));
    cameras.push(world.camera_from(([1.0, 0.6, 1.2], 1e6), SIZE));
    let of = |world_to_camera: Mat4, projection: Mat4| FrameCamera { world_to_camera, projection, size: SIZE };
    for matrix in [Mat4::ZERO, Mat4::NAN, Mat4::from_scale(Vec3::splat(1e30)), Mat4::from_scale(Vec3::splat(1e-30))] {
        cameras.push(of(matrix, sane.projection));
        cameras.push(of(sane.world_to_camera, matrix * sane.projection));
        cameras.push(of(matrix * sane.world_to_camera, sane.projection));
    }
    cameras.push(of(sane.world_to_camera, Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0)) * sane.projection));
    for _ in 0..6 {
        let mut matrices = [sane.world_to_camera, sane.projection].map(|matrix| matrix.to_cols_array());
        for _ in 0..1 + random.bits() % 4 {
            matrices[random.bits() as usize % 2][random.bits() as usize % 16] = random.odd();
        }
        let [world_to_camera, projection] = matrices.map(|matrix| Mat4::from_cols_array(&matrix));
        cameras.push(of(world_to_camera, projection));
    }
    cameras
}

/// Densities from none to the largest, of which only the first scenes' few patches make not too many pieces.
const DENSITIES: [Density; 8] = [
    Density::EdgePixels(f32::MAX),
    Density::EdgePixels(4.0),
    Density::Tess(1.0),
    Density::EdgePixels(0.8),
    Density::Tess(80.0),
    Density::EdgePixels(1e-3),
    Density::EdgePixels(f32::MIN_POSITIVE),
    Density::Tess(16_000.0),
];
const MODERATE: usize = 5;

/// Scales of the densities of a mesh's vertices; what is multiplied with infinity may be no number.
fn scales(kind: u32, count: usize, largest: f32, random: &mut Random) -> Vec<f32> {
    match kind {
        0 => Vec::new(),
        1 => vec![0.0; count],
        2 => vec![largest; count],
        3 => (0..count).map(|_| [0.0, 1.0, 8.0][random.bits() as usize % 3]).collect(),
        _ => (0..count).map(|_| 3.0 * random.part()).collect(),
    }
}

/// The patches that lists draw of an object's Ptex face: those that are cut once, all of their pieces being there.
fn drawn_patches(world: &World, entries: &Emitted) -> HashMap<(u32, u32), Vec<Location>> {
    let tables = world.surface.tables();
    let mut drawn: HashMap<(u32, u32), Vec<Location>> = HashMap::new();
    let mut add = |object: u32, info: &PatchInfo| {
        drawn.entry((object, info.location.ptex_face)).or_default().push(info.location);
    };
    for kind in [PatchKind::Regular, PatchKind::Transition] {
        entries[kind as usize].iter().for_each(|entry| add(entry.object, &tables.patches[entry.place as usize].info));
    }
    for entry in &entries[PatchKind::Filling as usize] {
        add(entry.object, &tables.irregular[entry.place as usize].info);
    }
    let mut pieces: HashMap<(u32, u32), HashSet<u32>> = HashMap::new();
    for entry in &entries[PatchKind::Cut as usize] {
        let is_new = pieces.entry((entry.object, entry.place)).or_default().insert(entry.flags >> 4 & 0xffff);
        assert!(is_new, "{}: {entry:?} is listed twice", world.name);
        let side = entry.flags >> 20;
        assert!((entry.flags >> 4 & 255) < side && (entry.flags >> 12 & 255) < side, "{entry:?}");
    }
    for entry in &entries[PatchKind::Cut as usize] {
        let side = (entry.flags >> 20) as usize;
        if let Some(own) = pieces.remove(&(entry.object, entry.place)) {
            assert_eq!(own.len(), side * side, "{}: pieces of patch {}", world.name, entry.place);
            add(entry.object, &tables.patches[entry.place as usize].info);
        }
    }
    drawn
}

/// The part of a Ptex face that patches cover, none of which lies in another.
fn area(locations: &[Location]) -> f64 {
    let all: HashSet<(u8, u16, u16)> = locations.iter().map(|l| (l.depth, l.u, l.v)).collect();
    assert_eq!(all.len(), locations.len(), "a patch is drawn twice");
    for location in locations {
        let mut outer = (1..=location.depth).map(|k| (location.depth - k, location.u >> k, location.v >> k));
        assert!(!outer.any(|outer| all.contains(&outer)), "{location:?} lies in another patch");
    }
    locations.iter().map(|location| (-2.0 * f64::from(location.depth)).exp2()).sum()
}

/// For each Ptex face of each mesh, the part of it that has a surface: all, none, or by what is there of it at a depth
/// that holes have at most.
fn surface_areas(world: &World) -> Vec<Vec<f64>> {
    const SIDE: u32 = 8;
    let area = |mesh| {
        let mut evaluator = Evaluator::new(mesh).expect("a legal cage");
        let mut area = |face: u32| {
            let cells =
                (0..SIDE * SIDE).map(|cell| [cell % SIDE, cell / SIDE].map(|c| (f64::from(c) + 0.5) / f64::from(SIDE)));
            cells.filter(|&[u, v]| evaluator.evaluate(face, u, v).is_some()).count() as f64 / f64::from(SIDE * SIDE)
        };
        (0..Evaluator::new(mesh).expect("a legal cage").ptex_face_count()).map(&mut area).collect()
    };
    world.meshes.iter().map(area).collect()
}

fn check_coverage(world: &World, entries: &Emitted, expected: &[Vec<f64>], named: &str) {
    let mut drawn = drawn_patches(world, entries);
    for (index, object) in world.objects.iter().enumerate() {
        for (face, &expected) in expected[object.mesh].iter().enumerate() {
            let locations = drawn.remove(&(index as u32, face as u32)).unwrap_or_default();
            assert_eq!(area(&locations), expected, "object {index}, Ptex face {face}: {named}");
        }
    }
    assert!(drawn.is_empty(), "{named}");
}

/// Triangles that are not too many to draw.
fn triangle_count(entries: &Emitted) -> u64 {
    entries.iter().flatten().map(|entry| u64::from(entry.triangles)).sum()
}

fn check_world(lab: &Lab, easels: &[Easel; 3], world: &mut World, random: &mut Random, frames: &mut [u32; 2]) {
    const MOST_TRIANGLES: u64 = 20_000;
    let expected = surface_areas(world);
    let densities = if is_small(&world.name) { &DENSITIES[..] } else { &DENSITIES[..MODERATE] };
    for camera in cameras(world, random) {
        let density = densities[random.bits() as usize % densities.len()];
        let easel = &easels[random.bits() as usize % 3];
        let spacing: Spacing = easel.spacing;
        let selection = if random.bits().is_multiple_of(3) { Selection::Static } else { Selection::Dynamic };
        let options =
            FrameOptions { density, selection, culling: Culling::Off, object_lod: random.bits().is_multiple_of(5) };
        let named = format!("{} {spacing:?} {options:?} {camera:?}", world.name);
        lab.run(&mut world.surface, spacing, &camera, &options);
        let entries = lab.entries(&world.surface);
        check_coverage(world, &entries, &expected, &named);
        frames[0] += 1;
        if triangle_count(&entries) < MOST_TRIANGLES {
            lab.draw(&mut world.surface, easel, &camera, &options);
            frames[1] += 1;
        }
        let culling = [Culling::Unseen, Culling::UnseenAndBacks][frames[0] as usize % 2];
        lab.run(&mut world.surface, spacing, &camera, &FrameOptions { culling, ..options });
        let culled = lab.entries(&world.surface);
        assert!(culled.iter().flatten().count() <= entries.iter().flatten().count(), "{named}");
    }
}

#[test]
fn odd_cameras_and_densities_cover_every_face_once_in_silence() {
    let lab = Lab::new();
    let easels = SPACINGS.map(|spacing| Easel::new(&lab, spacing, false, SIZE));
    let mut random = Random(5);
    let mut frames = [0; 2];
    for (turn, (name, level)) in SCENES.into_iter().enumerate() {
        // Each as it is or with scales, the first of all in both ways.
        for kind in if turn < 2 { 0..2 } else { turn % 2..turn % 2 + 1 } {
            let (mut meshes, objects) = scene(name, turn % 2 == 0);
            let kind = if kind == 0 { 0 } else { 1 + turn as u32 % 4 };
            let largest = if is_small(name) { f32::MAX } else { 6.0 };
            for mesh in &mut meshes {
                mesh.density = scales(kind, mesh.positions.len(), largest, &mut random);
            }
            let mut world = World::new(&lab.device, &format!("{name}, scales {kind}"), meshes, objects, level);
            check_world(&lab, &easels, &mut world, &mut random, &mut frames);
        }
    }
    println!("{frames:?} frames, and drawn");
    assert!(frames[0] > 200 && frames[1] > 80, "{frames:?}");
    lab.assert_silent();
}

#[test]
fn densities_that_are_no_lengths_and_factors_below_one_are_refused() {
    let lab = Lab::new();
    let world = World::of_scene(&lab.device, "ngon_5", 2, false);
    let camera = world.cameras(SIZE)[0];
    for bad in [f32::NAN, 0.0, -1.0, f32::INFINITY, f32::NEG_INFINITY] {
        let set = |density| world.surface.set_frame(&camera, &FrameOptions { density, ..FrameOptions::default() });
        assert!(matches!(set(Density::EdgePixels(bad)), Err(Error::EdgePixels { .. })), "{bad}");
        assert!(matches!(set(Density::Tess(bad)), Err(Error::TessFactor { .. })), "{bad}");
    }
}
