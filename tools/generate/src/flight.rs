//! A flight low through the valleys of a terrain.
use glam::DVec3;

use crate::scene_text::{Instance, Key, Path, SceneText};
use crate::terrain::{height, sides};

/// Vertical field of view, degrees.
const FOV: f64 = 60.0;
/// Frames of the flight.
const FRAME_COUNT: u32 = 120;
/// Places along the terrain's x, and across it, among which the way is chosen.
const COLUMNS: usize = 80;
const ROWS: usize = 80;
/// Cost of a row's step to the side over that of a unit of height: how much rather the way goes over a saddle than around.
const SIDESTEP_COST: f64 = 0.3;
/// Width of the mean that smooths the way, in columns to either side.
const SMOOTHING: usize = 3;
/// Columns from key to key.
const KEY_SPACING: usize = 2;
/// Columns from the eye's place to that of the target.
const LOOK_AHEAD: usize = 10;
/// Height of the eye over the highest ground around it, and of the target over the ground.
const EYE_CLEARANCE: f64 = 0.06;
const TARGET_CLEARANCE: f64 = 0.05;
/// How far around the way ground counts, in units of the terrain.
const GROUND_RADIUS: f64 = 0.2;

/// A scene of a terrain of about so many faces, in `file`, and the camera path `flight`.
pub fn scene(face_count: u32, file: &str) -> SceneText {
    let mut text =
        SceneText { comment: "Hills, and a flight through their valleys.".to_owned(), ..SceneText::default() };
    text.mesh("terrain", file);
    text.instances.push(Instance { mesh: "terrain".to_owned(), ..Instance::default() });
    text.paths.push(Path {
        name: "flight".to_owned(),
        fov: FOV,
        frames: FRAME_COUNT,
        keys: keys(&smoothed(&valley(sides(face_count)))),
    });
    text
}

/// The lowest way along x over the terrain, one point on the ground a column: dynamic programming over the rows.
fn valley([width, depth]: [f64; 2]) -> Vec<DVec3> {
    let point = |column: usize, row: usize| {
        // The outermost rows and columns are left out: over the border there is nothing to see.
        let share = |index: usize, count: usize| (index as f64 + 0.5) / count as f64 - 0.5;
        let (x, z) = (width * share(column, COLUMNS), 0.9 * depth * share(row, ROWS));
        DVec3::new(x, height(x, z), z)
    };
    let mut cost: Vec<f64> = (0..ROWS).map(|row| point(0, row).y).collect();
    let mut came_from = Vec::new();
    for column in 1..COLUMNS {
        let best = (0..ROWS).map(|row| {
            let neighbors = row.saturating_sub(1)..=(row + 1).min(ROWS - 1);
            let through =
                |from: usize| cost[from] + if from == row { 0.0 } else { SIDESTEP_COST * depth / ROWS as f64 };
            let from = neighbors.min_by(|&a, &b| through(a).total_cmp(&through(b))).unwrap_or(row);
            (from, through(from) + point(column, row).y)
        });
        let (from, next): (Vec<usize>, Vec<f64>) = best.unzip();
        came_from.push(from);
        cost = next;
    }
    let mut row = (0..ROWS).min_by(|&a, &b| cost[a].total_cmp(&cost[b])).unwrap_or(0);
    let mut way = vec![point(COLUMNS - 1, row)];
    for column in (1..COLUMNS).rev() {
        row = came_from[column - 1][row];
        way.push(point(column - 1, row));
    }
    way.reverse();
    way
}

/// The way without its corners, on the ground.
fn smoothed(way: &[DVec3]) -> Vec<DVec3> {
    (0..way.len())
        .map(|index| {
            let around = &way[index.saturating_sub(SMOOTHING)..(index + SMOOTHING + 1).min(way.len())];
            let mean = around.iter().sum::<DVec3>() / around.len() as f64;
            DVec3::new(mean.x, height(mean.x, mean.z), mean.z)
        })
        .collect()
}

/// The flight's keys along a way on the ground, as far as there is some to look ahead to.
fn keys(way: &[DVec3]) -> Vec<Key> {
    let key = |index: usize| {
        // As high as all that the camera passes until the neighbouring keys calls for.
        let passed = &way[index.saturating_sub(KEY_SPACING)..(index + KEY_SPACING + 1).min(way.len())];
        let ground = passed.iter().map(|&place| highest_around(place)).fold(f64::MIN, f64::max);
        let eye = DVec3::new(way[index].x, ground + EYE_CLEARANCE, way[index].z);
        let ahead = way[index + LOOK_AHEAD];
        Key::new(eye, ahead + DVec3::Y * TARGET_CLEARANCE)
    };
    (0..way.len() - LOOK_AHEAD).step_by(KEY_SPACING).map(key).collect()
}

/// The highest ground within [`GROUND_RADIUS`] of a place.
fn highest_around(place: DVec3) -> f64 {
    const STEPS: i32 = 6;
    let steps = || (-STEPS..=STEPS).map(|i| f64::from(i) * GROUND_RADIUS / f64::from(STEPS));
    let offsets = steps().flat_map(|x| steps().map(move |z| (x, z)));
    let within = offsets.filter(|(x, z)| x.hypot(*z) <= GROUND_RADIUS);
    within.map(|(x, z)| height(place.x + x, place.z + z)).fold(f64::MIN, f64::max)
}
