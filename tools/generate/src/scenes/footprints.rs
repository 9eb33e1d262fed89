//! A trail of footprints in sand (FAS section 6.3): few faces, and edits where something has stepped.
use glam::{DVec2, DVec3};

use crate::cage::Cage;
use crate::edits::{Path, path_to_vertex};
use crate::random::noise;
use crate::sheets::grid;

/// Quads along the trail (x) and across it (z).
const QUADS: [u32; 2] = [18, 8];
/// Side of a quad.
const SIDE: f64 = 0.25;
const STEP_COUNT: u32 = 8;
/// From one footprint to the next along the trail, and from the trail's middle to either foot.
const STRIDE: f64 = 0.5;
const HALF_GAIT: f64 = 0.16;
/// The level whose vertices are pressed in, and the one whose vertices are pushed up beside.
const SOLE_LEVEL: u32 = 3;
const RIM_LEVEL: u32 = 4;
const SOLE_DEPTH: f64 = 0.05;
const RIM_HEIGHT: f64 = 0.014;
/// Width of the rim around a footprint, and how far outside of the sole it begins.
const RIM_WIDTH: f64 = 0.022;
const RIM_DISTANCE: f64 = 0.03;

/// The sheet with its footprints.
pub fn sand() -> Cage {
    let mut cage = grid(QUADS[0], QUADS[1], |i, j| {
        let point = lattice_point(0, i, j);
        let (x, z) = (point.x, point.y);
        DVec3::new(x, 0.12 * (0.9 * x + 0.4).sin() + 0.05 * noise(DVec3::new(2.0 * x, 0.3, 2.0 * z), 3), z)
    });
    for step in 0..STEP_COUNT {
        let foot = Foot::of(step);
        for (level, height) in [(SOLE_LEVEL, Foot::sole as fn(&Foot, DVec2) -> f64), (RIM_LEVEL, Foot::rim)] {
            let edits = edits(&foot, level, height);
            cage = cage.with_vertices_moved(&edits);
        }
    }
    cage
}

/// (x, z) of a vertex of a level, counted from the sheet's corner.
fn lattice_point(level: u32, i: u32, j: u32) -> DVec2 {
    let step = SIDE / f64::from(1 << level);
    DVec2::new(step * f64::from(i), step * f64::from(j)) - 0.5 * SIDE * DVec2::from(QUADS.map(f64::from))
}

/// The vertices of a level that a footprint moves, up or down.
fn edits(foot: &Foot, level: u32, height: impl Fn(&Foot, DVec2) -> f64) -> Vec<(Path, DVec3)> {
    /// Anything below is nothing to see.
    const LEAST: f64 = 0.001;
    let size = 1 << level;
    let mut edits = Vec::new();
    for i in 0..QUADS[0] * size {
        for j in 0..QUADS[1] * size {
            let moved = height(foot, lattice_point(level, i, j));
            if moved.abs() < LEAST {
                continue;
            }
            // A grid numbers its faces along x first, and a face has u along z.
            let face = j / size * QUADS[0] + i / size;
            edits.push((path_to_vertex(face, level, j % size, i % size), DVec3::new(0.0, moved, 0.0)));
        }
    }
    edits
}

/// One footprint.
struct Foot {
    center: DVec2,
    /// Along the foot.
    direction: DVec2,
    /// 1 for the left foot, -1 for the right.
    side: f64,
}

impl Foot {
    fn of(step: u32) -> Self {
        let along = (f64::from(step) - f64::from(STEP_COUNT - 1) / 2.0) * STRIDE;
        let side = if step.is_multiple_of(2) { 1.0 } else { -1.0 };
        let bend = 0.12 * (1.4 * along).sin();
        // Feet point a little outwards.
        let angle = 0.17 * (1.4 * along).cos() - 0.15 * side;
        Self { center: DVec2::new(along, bend - HALF_GAIT * side), direction: DVec2::from_angle(angle), side }
    }

    /// How far a point is outside of the sole's outline; negative inside.
    fn distance(&self, point: DVec2) -> f64 {
        let offset = point - self.center;
        let local = DVec2::new(offset.dot(self.direction), self.side * self.direction.perp_dot(offset));
        // The ball of the foot, the heel, and the waist between them.
        let circles = [(0.085, 0.008, 0.055), (0.03, 0.004, 0.048), (-0.095, -0.004, 0.042)];
        let circle = |&(along, across, radius): &(f64, f64, f64)| local.distance(DVec2::new(along, across)) - radius;
        circles.iter().map(circle).fold(f64::INFINITY, f64::min)
    }

    /// The sole pressed in, deeper towards its middle.
    fn sole(&self, point: DVec2) -> f64 {
        const SLOPE: f64 = 0.03;
        -SOLE_DEPTH * (0.5 - self.distance(point) / SLOPE).clamp(0.0, 1.0)
    }

    /// The sand that was pushed aside.
    fn rim(&self, point: DVec2) -> f64 {
        let across = (self.distance(point) - RIM_DISTANCE) / RIM_WIDTH;
        RIM_HEIGHT * (1.0 - across * across).max(0.0)
    }
}
