//! From inside a closed surface every pixel shows it: a crack would let the empty background shine through.

use glam::Vec3;
use planish_render::{Culling, Density, FrameOptions, NO_SURFACE, ObjectDesc, Selection, Spacing, SurfaceDesc};
use planish_subdiv::ControlMesh;

use crate::lab::{Easel, Lab};
use crate::random::Random;
use crate::watertight::noise;
use crate::world::{World, scene};

const SIZE: [u32; 2] = [96, 64];
/// The layer of ids among the images.
const IDS: usize = 3;
/// Eyes are not farther from the middle, over the diagonal of the bounding box: inside of the surface.
const REACH: f32 = 0.08;

fn world(lab: &Lab, name: &str, displaced: bool) -> World {
    let mesh: ControlMesh = scene(name, false).0.remove(0);
    let desc = SurfaceDesc { level: 5, displaced, ..SurfaceDesc::default() };
    let mut world = World::with_desc(&lab.device, name, vec![mesh], vec![ObjectDesc::identity(0)], desc, None);
    if displaced {
        let map = noise(&world.meshes[0], &mut Random(11));
        world.displace(&lab.device, 0, &map);
    }
    world
}

/// Looks around in a world so many times a selection; returns the number of views.
fn look_around(lab: &Lab, world: &mut World, easel: &Easel, views: usize, random: &mut Random) -> usize {
    let [low, high] = world.bounds();
    let (middle, diagonal) = (0.5 * (low + high), (high - low).length());
    for selection in [Selection::Dynamic, Selection::Static] {
        for view in 0..views {
            let eye = middle + REACH * diagonal * random.part() * random.direction();
            let target: Vec3 = eye + diagonal * random.direction();
            let camera = world.camera_of_angle(eye, target, random.between(80.0, 120.0), SIZE);
            let density = Density::EdgePixels(random.between(2.0, 6.0));
            // Backs are what is seen.
            let culling = [Culling::Off, Culling::Unseen][view % 2];
            let options = FrameOptions { density, selection, culling, object_lod: false };
            let ids = lab.draw(&mut world.surface, easel, &camera, &options).swap_remove(IDS);
            let bright: Vec<[usize; 2]> = (0..ids.len() / 4)
                .filter(|pixel| ids[4 * pixel] == NO_SURFACE)
                .map(|pixel| [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize])
                .collect();
            assert!(bright.is_empty(), "{} {:?} {options:?} {camera:?}: {bright:?}", world.name, easel.spacing);
        }
    }
    2 * views
}

/// Looks around in all of these scenes; returns the number of views.
fn look_around_all(lab: &Lab, names: &[&str], views: usize) -> usize {
    let displaced = lab.needs(Spacing::Equal).displaced;
    let mut random = Random(29);
    let mut worlds: Vec<World> = names.iter().map(|name| world(lab, name, displaced)).collect();
    let mut count = 0;
    for spacing in [Spacing::FractionalOdd, Spacing::FractionalEven] {
        let easel = Easel::new(lab, spacing, false, SIZE);
        for world in &mut worlds {
            count += look_around(lab, world, &easel, views, &mut random);
        }
    }
    lab.assert_silent();
    count
}

#[test]
fn no_pixel_is_bright_inside_closed_meshes() {
    let count = look_around_all(&Lab::new(), &["adjacent_extraordinary", "mixed_triangles_quads"], 18);
    assert!(count >= 140, "{count} views");
}

#[test]
fn no_pixel_is_bright_inside_a_displaced_mesh() {
    let count = look_around_all(&Lab::displaced(), &["adjacent_extraordinary"], 18);
    assert!(count >= 70, "{count} views");
}
