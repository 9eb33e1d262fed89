//! What culling leaves out: nothing that could be seen, and without a trace in any image.

use std::collections::{HashMap, HashSet};

use planish_render::density::isolation_level;
use planish_render::{
    CapturedVertex, Culling, Density, FrameCamera, FrameOptions, ObjectDesc, PatchKind, Selection, Spacing,
};

use crate::lab::{Easel, Lab, SPACINGS};
use crate::seen::Rasterizer;
use crate::world::{self, World};

/// Closed meshes that face outward.
pub const CLOSED: [&str; 6] =
    ["genus_2", "cube", "adjacent_extraordinary", "two_components", "valence_2_closed", "tetrahedron"];
/// Meshes with boundaries in all modes, holes in the surface, or far away.
pub const OPEN: [&str; 6] =
    ["boundary_valences", "boundary_none", "boundary_edge_only", "open_cylinder", "grid_8x8", "far_from_origin"];
/// Ways to tessellate: aligned rows, rings that are skewed, factors of 1.
pub const WAYS: [(Spacing, f32); 5] = [
    (Spacing::Equal, 1.0),
    (Spacing::Equal, 8.0),
    (Spacing::Equal, 4.7),
    (Spacing::FractionalOdd, 5.3),
    (Spacing::FractionalEven, 3.4),
];
/// Meshes whose patches are cut at a factor.
const CUT: [(&str, Spacing, f32); 4] = [
    ("grid_8x8", Spacing::FractionalOdd, 64.5),
    ("open_cylinder", Spacing::Equal, 70.0),
    ("tetrahedron", Spacing::FractionalEven, 270.0),
    ("cube", Spacing::FractionalOdd, 150.0),
];
/// Directions from which meshes are seen, and distances in diagonals of the bounding box: from outside, along the axes so
/// that much is seen edge on, and so near that most is outside of the view.
pub const EYES: [([f32; 3], f32); 7] = [
    ([1.0, 0.6, 1.2], 1.1),
    ([-0.4, -1.0, 0.3], 0.9),
    ([1.0, 0.0, 0.0], 0.8),
    ([0.02, 0.03, -1.0], 1.3),
    ([0.3, 0.2, 1.0], 0.6),
    ([1.0, 1.0, -0.1], 0.55),
    ([-1.0, 0.9, 0.2], 4.0),
];
const SIZE: [u32; 2] = [96, 64];

/// A patch or a piece of one: its kind, object, place and flags.
type Key = (usize, u32, u32, u32);

/// How much of what could be left out was, of whole patches and of pieces.
#[derive(Debug, Default)]
pub struct Tally {
    pub unseen: [u32; 2],
    pub found: [u32; 2],
}

pub fn options(world: &World, camera: &FrameCamera, density: Density) -> FrameOptions {
    // Backs are hidden from outside alone.
    let culling = if world.is_outside(camera.eye()) { Culling::UnseenAndBacks } else { Culling::Unseen };
    FrameOptions { density, selection: Selection::Dynamic, culling, object_lod: false }
}

/// The captured triangles of everything that is there.
pub fn triangles(
    lab: &Lab,
    world: &mut World,
    spacing: Spacing,
    camera: &FrameCamera,
    density: Density,
) -> HashMap<Key, Vec<CapturedVertex>> {
    let all = FrameOptions { culling: Culling::Off, ..options(world, camera, density) };
    lab.run(&mut world.surface, spacing, camera, &all);
    let vertices = lab.dump(&world.surface, &lab.dump_passes(world.surface.desc(), spacing));
    let mut rest = vertices.as_slice();
    let mut of_entries = HashMap::new();
    for (kind, entries) in lab.unsorted_entries(&world.surface).iter().enumerate() {
        for entry in entries {
            let (own, others) = rest.split_at(3 * entry.triangles as usize);
            let before = of_entries.insert((kind, entry.object, entry.place, entry.flags), own.to_vec());
            assert!(before.is_none(), "{}: {entry:?} is listed twice", world.name);
            rest = others;
        }
    }
    assert!(rest.is_empty());
    of_entries
}

/// Nothing that a frame leaves out could be seen; `all` are the triangles of everything.
pub fn check_left_out(
    lab: &Lab,
    world: &mut World,
    (spacing, density): (Spacing, Density),
    camera: &FrameCamera,
    all: &HashMap<Key, Vec<CapturedVertex>>,
    tally: &mut Tally,
) {
    let options = options(world, camera, density);
    lab.run(&mut world.surface, spacing, camera, &options);
    let entries = lab.unsorted_entries(&world.surface);
    let of_kind = |kind: usize| entries[kind].iter().map(move |entry| (kind, entry.object, entry.place, entry.flags));
    let kept: HashSet<Key> = (0..entries.len()).flat_map(of_kind).collect();
    let named = format!("{} {spacing:?} {density:?} from {}", world.name, camera.eye());
    assert!(kept.iter().all(|key| all.contains_key(key)), "{named}: what is kept is not what there is");
    let rasterizer = Rasterizer { camera, sub_pixel_bits: lab.device.limits().sub_pixel_bits };
    for (key, own) in all {
        let object = &world.objects[key.1 as usize];
        let hides_back = options.culling == Culling::UnseenAndBacks && object.hides_backs && !object.is_mirrored();
        let shows = |cull_back: bool| own.chunks_exact(3).any(|triangle| rasterizer.shows(triangle, cull_back));
        assert!(kept.contains(key) || !shows(hides_back), "{named}: {key:?} is left out");
        // Pieces are judged by the view alone. Small images have large grids: there more is kept.
        let is_piece = PatchKind::ALL[key.0].is_cut();
        if camera.size[0] > 100 && !shows(hides_back && !is_piece) {
            tally.unseen[usize::from(is_piece)] += 1;
            tally.found[usize::from(is_piece)] += u32::from(!kept.contains(key));
        }
    }
}

fn level(factor: f32) -> u32 {
    isolation_level(factor, 6)
}

#[test]
fn no_triangle_of_a_patch_that_is_left_out_could_be_seen() {
    /// Of the patches and pieces that could be left out, the shares that must be.
    const LEAST_SHARES: [f64; 2] = [0.82, 0.9];
    /// From where some pieces of a patch are out of view.
    const NEAR: [([f32; 3], f32); 2] = [([0.3, 0.9, 0.2], 0.2), ([-0.5, 0.7, 1.0], 0.35)];
    let lab = Lab::new();
    let mut tally = Tally::default();
    let closed = CLOSED.iter().map(|name| (name, true)).chain(OPEN.iter().map(|name| (name, false)));
    let whole = closed.flat_map(|(name, is_closed)| WAYS.map(|(spacing, factor)| (*name, is_closed, spacing, factor)));
    let cut = CUT.map(|(name, spacing, factor)| (name, CLOSED.contains(&name), spacing, factor));
    for (turn, (name, is_closed, spacing, factor)) in whole.chain(cut).enumerate() {
        let mut world = World::of_scene(&lab.device, name, level(factor), is_closed);
        let density = Density::Tess(factor);
        let any = world.camera_from(EYES[0], SIZE);
        let all = triangles(&lab, &mut world, spacing, &any, density);
        let near = if turn < 60 { &NEAR[..0] } else { &NEAR[..] };
        // Every other eye in turn.
        for (i, &eye) in EYES.iter().chain(near).enumerate().filter(|(i, _)| turn >= 60 || (i + turn) % 2 == 0) {
            // Small images have large grids.
            let size = if i < 7 && (i / 2 + turn) % 3 == 0 { [48, 32] } else { [640, 480] };
            let camera = world.camera_from(eye, size);
            check_left_out(&lab, &mut world, (spacing, density), &camera, &all, &mut tally);
        }
    }
    println!("{tally:?}");
    for ((found, unseen), least) in tally.found.into_iter().zip(tally.unseen).zip(LEAST_SHARES) {
        assert!(unseen > 500 && f64::from(found) > least * f64::from(unseen), "{tally:?}");
    }
    lab.assert_silent();
}

#[test]
fn no_triangle_of_a_patch_that_is_left_out_of_a_dynamic_cut_could_be_seen() {
    let lab = Lab::new();
    let mut tally = Tally::default();
    let scenes = ["adjacent_extraordinary", "boundary_valences", "mixed_triangles_quads", "hole_ngon"];
    let mut worlds: Vec<World> = scenes
        .into_iter()
        .map(|name| World::of_scene(&lab.device, name, 5, CLOSED.contains(&name)))
        .chain([World::of_objects(&lab.device, 5, None)])
        .collect();
    for (turn, world) in worlds.iter_mut().enumerate() {
        for (i, camera) in world.cameras([640, 480]).into_iter().enumerate() {
            let way = (SPACINGS[(turn + i) % 3], Density::EdgePixels([30.0, 100.0][i % 2]));
            let all = triangles(&lab, world, way.0, &camera, way.1);
            check_left_out(&lab, world, way, &camera, &all, &mut tally);
        }
    }
    println!("{tally:?}");
    assert!(tally.found[0] > 1000 && tally.found[0] > tally.unseen[0] / 2, "{tally:?}");
    lab.assert_silent();
}

/// Models beside the repository, where they are.
fn models(lab: &Lab) -> Vec<World> {
    let object = ObjectDesc { hides_backs: true, ..ObjectDesc::identity(0) };
    let world = |(name, mesh): (String, _)| World::new(&lab.device, &name, vec![mesh], vec![object], 3);
    world::models().into_iter().map(world).collect()
}

#[test]
fn images_are_the_same_bits_with_culling_and_without() {
    let lab = Lab::new();
    let easels = SPACINGS.map(|spacing| [false, true].map(|cull_back| Easel::new(&lab, spacing, cull_back, SIZE)));
    let (mut drawn, mut all) = (0, 0);
    let scenes = CLOSED.iter().map(|name| (name, true)).chain(OPEN.iter().map(|name| (name, false)));
    let worlds = scenes.map(|(name, is_closed)| World::of_scene(&lab.device, name, 5, is_closed));
    for (turn, mut world) in worlds.chain(models(&lab)).chain([World::of_objects(&lab.device, 4, None)]).enumerate() {
        // Large models are seen from two places alone.
        let eyes = if world.meshes[0].face_sizes.len() > 1000 { &EYES[..2] } else { &EYES[..] };
        for (i, &eye) in eyes.iter().enumerate() {
            let camera = world.camera_from(eye, SIZE);
            let is_piece = i == 2 && world.meshes[0].face_sizes.len() < 200;
            let density = if is_piece { Density::Tess(70.0) } else { Density::EdgePixels([1.5, 4.0][i % 2]) };
            let culled = options(&world, &camera, density);
            let hides = world.objects.iter().all(|object| object.hides_backs && !object.is_mirrored());
            let cull_back = hides && culled.culling == Culling::UnseenAndBacks;
            // The same rasterizer state on both sides: all that differs is which patches are drawn.
            let easel = &easels[(turn + i) % 3][usize::from(cull_back)];
            let counts = |world: &World| {
                let counts = world.surface.status().expect("status").patch_counts(16);
                counts.iter().map(|level| level.regular + level.transition + level.filling).sum::<u32>()
            };
            let unculled = FrameOptions { culling: Culling::Off, ..culled };
            let expected = lab.draw(&mut world.surface, easel, &camera, &unculled);
            all += if cull_back { counts(&world) } else { 0 };
            let images = lab.draw(&mut world.surface, easel, &camera, &culled);
            drawn += if cull_back { counts(&world) } else { 0 };
            assert!(images == expected, "{} {:?} {density:?} from {}", world.name, easel.spacing, camera.eye());
        }
    }
    assert!(drawn > 0 && drawn < all * 7 / 10, "{drawn} of {all} patches of closed meshes are drawn");
    lab.assert_silent();
}
