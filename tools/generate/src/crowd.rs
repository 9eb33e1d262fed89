//! A crowd of small figures: one mesh, many instances.
use std::f64::consts::FRAC_PI_4;

use glam::{DMat3, DVec3};

use crate::cage::Cage;
use crate::framing::{DEFAULT_DIRECTION, distance};
use crate::lattice;
use crate::random::Random;
use crate::scene_text::{Instance, Key, Path, Rotation, SceneText};

/// Lattice cells of a figure: columns, storeys, and one layer.
const CELLS: [i32; 3] = [5, 4, 1];
/// Places of the lattice's columns and storeys.
const COLUMNS: [f64; 6] = [-1.5, -0.8, -0.25, 0.25, 0.8, 1.5];
const STOREYS: [f64; 5] = [0.0, 1.0, 1.7, 2.4, 3.2];
/// Sharpness around the soles.
const SOLE_SHARPNESS: f64 = 2.3;
/// From figure to figure.
const SPACING: f64 = 4.0;
/// A figure's corners at its largest and however turned, from the point where it stands.
const REACH: DVec3 = DVec3::new(1.9, 4.0, 1.9);
/// Vertical field of view, degrees.
const FOV: f64 = 40.0;
/// Frames of the camera's turn towards the crowd.
const TURN_FRAMES: u32 = 60;

/// A figure of 42 quads that stands on the ground: two legs, two arms, a head, a body between them, and creased soles.
pub fn figure() -> Cage {
    let inside = |[i, j, _]: [i32; 3]| match j {
        0 => i == 1 || i == 3,
        1 => (1..=3).contains(&i),
        2 => true,
        _ => i == 2,
    };
    let figure = lattice::surface(CELLS, inside, |[i, j, k]| {
        let (x, y, z) = (COLUMNS[i as usize], STOREYS[j as usize], 0.7 * (f64::from(k) - 0.5));
        match (i, j) {
            (_, 4) => DVec3::new(2.2 * x, y, 1.3 * z),
            // The hands hang, one before the body and one behind.
            (0, _) => DVec3::new(x, y - 0.6, 0.6 * z + 0.3),
            (5, _) => DVec3::new(x, y - 0.6, 0.6 * z - 0.3),
            (_, 0) => DVec3::new(1.2 * x, y, 1.4 * z + 0.1),
            _ => DVec3::new(x, y, z),
        }
    });
    let soles = figure.edges_where(|p| p.y == 0.0);
    figure.creased_edges(&soles, &[SOLE_SHARPNESS])
}

/// A scene of `count` figures, whose mesh is `file`, with the cameras `all`, `some` and `none`, named after what they see,
/// and the path `turn`, which turns from none to all.
pub fn scene(count: u32, file: &str) -> SceneText {
    let side = (1..).find(|&side: &u32| u64::from(side).pow(2) >= u64::from(count)).unwrap_or(1);
    let mut text = SceneText { comment: format!("A crowd of {count} figures."), ..SceneText::default() };
    text.mesh("figure", file);
    let mut random = Random::new(7);
    let middle = f64::from(side - 1) / 2.0;
    let places: Vec<DVec3> = (0..count)
        .map(|index| DVec3::new(f64::from(index % side) - middle, 0.0, f64::from(index / side) - middle) * SPACING)
        .collect();
    text.instances = places.iter().map(|&place| instance(place, &mut random)).collect();
    add_cameras(&mut text, &places);
    text
}

/// A figure turned and sized at random.
fn instance(place: DVec3, random: &mut Random) -> Instance {
    let degrees = random.below(3600) as f64 / 10.0;
    let size = (80 + random.below(40)) as f64 / 100.0;
    Instance {
        mesh: "figure".to_owned(),
        translate: Some(place.to_array()),
        rotate: Some(Rotation { axis: [0.0, 1.0, 0.0], degrees }),
        scale: Some([size; 3]),
        ..Instance::default()
    }
}

fn add_cameras(text: &mut SceneText, places: &[DVec3]) {
    let corners = places.iter().flat_map(|&place| {
        (0..8).map(move |corner| {
            let side = |axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            place + REACH * DVec3::new(side(0), side(1).max(0.0), side(2))
        })
    });
    let all = DEFAULT_DIRECTION.normalize() * distance(corners, DVec3::ZERO, DEFAULT_DIRECTION, FOV);
    let eye_level = DVec3::Y * 5.0;
    // Above the middle of the crowd, and at its edge with the crowd behind.
    let outside = DVec3::X * (places.iter().fold(0.0, |reach, place| place.x.max(reach)) + 2.0 * REACH.x);
    text.camera("all", all, DVec3::ZERO, FOV);
    text.camera("some", eye_level, DVec3::new(10.0, 2.0, 0.0), FOV);
    text.camera("none", outside + eye_level, outside + eye_level + DVec3::X * 10.0, FOV);
    let key = |index: u32| {
        let turn = DMat3::from_rotation_y(f64::from(4 - index) * FRAC_PI_4);
        Key::new(all, all + turn * -all)
    };
    text.paths.push(Path { name: "turn".to_owned(), fov: FOV, frames: TURN_FRAMES, keys: (0..=4).map(key).collect() });
}
