//! Random tags.
use super::{Features, Purpose, Recipe};
use crate::cage::Cage;
use crate::random::Random;
use crate::tags::{BoundaryRule, INFINITE};

const WHOLE: [f64; 4] = [1.0, 2.0, 3.0, 5.0];
const FRACTIONAL: [f64; 6] = [0.3, 1.5, 2.3, 3.7, 7.8, 9.9];
/// From 10 on sharpness is infinite, whatever it is.
const INFINITE_VALUES: [f64; 2] = [INFINITE, 12.0];

/// How likely an allowed rule is used, in percent.
const OPTION: usize = 40;

/// The cage with tags.
pub fn tag(mut cage: Cage, recipe: &Recipe) -> Cage {
    let features = recipe.features;
    let sharpness = sharpness_values(features);
    if features.has(Features::CREASES) && !sharpness.is_empty() {
        cage = creases(cage, &sharpness, &mut recipe.random(Purpose::Creases));
    }
    if features.has(Features::CORNERS) && !sharpness.is_empty() {
        cage = corners(cage, &sharpness, &mut recipe.random(Purpose::Corners));
    }
    if features.has(Features::HOLES) {
        cage = holes(cage, &mut recipe.random(Purpose::Holes));
    }
    options(cage, features, &mut recipe.random(Purpose::Options))
}

fn sharpness_values(features: Features) -> Vec<f64> {
    let mut values = Vec::new();
    if features.has(Features::SEMI_SHARP) {
        values.extend(WHOLE);
    }
    if features.has(Features::FRACTIONAL) {
        values.extend(FRACTIONAL);
    }
    if features.has(Features::INFINITE) {
        // As often as the others together, of which they are a part.
        (0..=values.len() / 4).for_each(|_| values.extend(INFINITE_VALUES));
    }
    values
}

/// Single edges, and walks along edges of one sharpness or of another on every edge.
fn creases(mut cage: Cage, sharpness: &[f64], random: &mut Random) -> Cage {
    const MOST: usize = 4;
    const LONGEST: usize = 8;
    let edges = cage.edges();
    for _ in 0..random.below(MOST + 1) {
        let edge = random.pick(&edges);
        cage = cage.creased(&edge, random.pick(sharpness));
    }
    for _ in 0..random.below(MOST) {
        let walk = walk(&edges, 1 + random.below(LONGEST), random);
        if random.percent(50) {
            cage = cage.creased(&walk, random.pick(sharpness));
        } else {
            for edge in walk.windows(2) {
                cage = cage.creased(edge, random.pick(sharpness));
            }
        }
    }
    cage
}

/// A walk of at most so many edges that does not turn back at once.
fn walk(edges: &[[u32; 2]], length: usize, random: &mut Random) -> Vec<u32> {
    let mut walk = random.pick(edges).to_vec();
    while walk.len() <= length {
        let &[.., before, last] = walk.as_slice() else { unreachable!("a walk begins with an edge") };
        let other_end = |&[a, b]: &[u32; 2]| match (a == last, b == last) {
            (true, _) => Some(b),
            (_, true) => Some(a),
            _ => None,
        };
        let next: Vec<u32> = edges.iter().filter_map(other_end).filter(|&vertex| vertex != before).collect();
        if next.is_empty() {
            break;
        }
        walk.push(random.pick(&next));
    }
    walk
}

fn corners(mut cage: Cage, sharpness: &[f64], random: &mut Random) -> Cage {
    const MOST: usize = 4;
    for _ in 0..random.below(MOST + 1) {
        let face = random.below(cage.faces.len());
        let vertex = random.pick(&cage.faces[face]);
        cage = cage.cornered(vertex, random.pick(sharpness));
    }
    cage
}

/// Fewer faces than there are.
fn holes(cage: Cage, random: &mut Random) -> Cage {
    const MOST: usize = 3;
    let count = random.below(MOST + 1).min(cage.faces.len() - 1);
    if count == 0 {
        return cage;
    }
    let faces: Vec<u32> = (0..count).map(|_| random.below(cage.faces.len()) as u32).collect();
    cage.with_holes(&faces)
}

fn options(mut cage: Cage, features: Features, random: &mut Random) -> Cage {
    let [rule, chaikin, smooth] = [(); 3].map(|()| random.percent(OPTION));
    let boundary = random.pick(&[BoundaryRule::None, BoundaryRule::EdgeOnly]);
    if features.has(Features::BOUNDARY_RULES) && rule {
        cage = cage.with_boundary(boundary);
    }
    if features.has(Features::CHAIKIN) && chaikin {
        cage = cage.with_chaikin();
    }
    if features.has(Features::SMOOTH_TRIANGLES) && smooth {
        cage = cage.with_smooth_triangles();
    }
    cage
}
