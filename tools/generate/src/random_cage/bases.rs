//! What random cages start from.
use std::f64::consts::TAU;

use glam::DVec3;

use super::Features;
use crate::cage::Cage;
use crate::random::Random;
use crate::{lattice, sectors, sheets, solids};

/// How likely there is a second component, in percent.
const SECOND_COMPONENT: usize = 20;
/// Where it lies.
const OFFSET: DVec3 = DVec3::new(3.5, 0.5, 0.3);

/// One or two shapes, of quads alone unless n-gons are allowed.
pub fn base(random: &mut Random, features: Features) -> Cage {
    let mut cage = shape(random, features);
    if random.percent(SECOND_COMPONENT) {
        let other = shape(random, features);
        if cage.faces.len() + other.faces.len() <= super::MAX_FACES {
            cage.append(&other.moved(OFFSET));
        }
    }
    cage
}

fn shape(random: &mut Random, features: Features) -> Cage {
    const QUAD_SHAPES: usize = 8;
    const ALL_SHAPES: usize = 12;
    let between = |random: &mut Random, low: u32, high: u32| low + random.below((high - low + 1) as usize) as u32;
    let count = if features.has(Features::N_GONS) { ALL_SHAPES } else { QUAD_SHAPES };
    match random.below(count) {
        0 => solids::cube(),
        1 => sheets::waved_grid(between(random, 2, 5), between(random, 2, 5)),
        2 => solids::torus(between(random, 3, 6), between(random, 3, 5)).map(|p| 2.0 * p),
        3 => sheets::strip(between(random, 2, 7)),
        4 => sectors::fan(between(random, 1, 6)),
        5 => sectors::disc(pick_valence(random, features)),
        6 => solids::open_cylinder(between(random, 3, 6), between(random, 1, 3)),
        7 => {
            let size = [(); 3].map(|()| between(random, 1, 3) as i32);
            lattice::surface(size, |_| true, |point| DVec3::from(point.map(f64::from)))
        }
        8 => solids::tetrahedron(),
        9 => prism(between(random, 3, 9)),
        10 => icosahedron(),
        _ => sectors::ngon(pick_valence(random, features).max(3)),
    }
}

fn pick_valence(random: &mut Random, features: Features) -> u32 {
    let low = if features.has(Features::VALENCE_2) { 2 } else { 3 };
    low + random.below(5) as u32
}

/// Two n-gons and n quads between them.
fn prism(sides: u32) -> Cage {
    let mut cage = Cage::default();
    for y in [-0.6, 0.6] {
        for i in 0..sides {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(sides)).sin_cos();
            cage.vertex(DVec3::new(1.2 * cos, y, -1.2 * sin));
        }
    }
    cage.faces.push((0..sides).rev().collect());
    cage.faces.push((sides..2 * sides).collect());
    for i in 0..sides {
        let next = (i + 1) % sides;
        cage.face(&[i, next, sides + next, sides + i]);
    }
    cage
}

fn icosahedron() -> Cage {
    // Two poles, and two rings of five at heights of 1 / sqrt(5).
    let height = 5_f64.sqrt().recip();
    let mut cage = Cage::default();
    let bottom = cage.vertex(DVec3::new(0.0, -1.2, 0.0));
    for (y, shift) in [(-height, 0.0), (height, 0.5)] {
        for i in 0..5 {
            let (sin, cos) = (TAU * (f64::from(i) + shift) / 5.0).sin_cos();
            cage.vertex(DVec3::new(cos, 1.2 * y, -sin));
        }
    }
    let top = cage.vertex(DVec3::new(0.0, 1.2, 0.0));
    for i in 0..5 {
        let [low, high] = [1, 6].map(|first| [first + i, first + (i + 1) % 5]);
        cage.face(&[bottom, low[1], low[0]]);
        cage.face(&[low[0], low[1], high[0]]);
        cage.face(&[low[1], high[1], high[0]]);
        cage.face(&[high[0], high[1], top]);
    }
    cage
}
