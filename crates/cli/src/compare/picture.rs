//! A surface in false colours: a small rasterizer with a depth buffer.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec3, Vec4Swizzles};
use planish_film::Film;

use super::soup::Triangle;

/// Samples along a side of a pixel: 4 in each.
const SAMPLES: usize = 2;
/// From no deviation to the greatest, evenly spaced.
const RAMP: [Vec3; 5] = [
    Vec3::new(0.0, 0.0, 1.0),
    Vec3::new(0.0, 1.0, 1.0),
    Vec3::new(0.0, 1.0, 0.0),
    Vec3::new(1.0, 1.0, 0.0),
    Vec3::new(1.0, 0.0, 0.0),
];
/// What has no deviation: faces that the other dump lacks, points without a normal.
const UNKNOWN: Vec3 = Vec3::splat(0.2);
const BACKGROUND: Vec3 = Vec3::splat(0.8);
/// Light that does not depend on how a surface is turned; the rest comes from the camera.
const AMBIENT: f32 = 0.5;
/// The legend's width, and its distance from three sides, as parts of the image's height.
const LEGEND_WIDTH: f64 = 0.03;
const LEGEND_MARGIN: f64 = 0.05;

/// From where a picture is made.
pub struct View {
    /// World to clip space: y down, w the distance along the line of sight.
    pub view_projection: DMat4,
    pub eye: DVec3,
    /// Pixels in a row and rows.
    pub size: [u32; 2],
}

/// A triangle's corners on the image.
struct Projected {
    /// In samples, from the upper left.
    places: [DVec2; 3],
    /// One over the distance along the line of sight.
    inverse_depths: [f64; 3],
}

struct Canvas {
    width: usize,
    height: usize,
    /// One over the distance of what is seen; 0 where nothing is.
    depths: Vec<f64>,
    colors: Vec<Vec3>,
}

/// Draws triangles with a value at each corner, 0 blue to 1 red and more; not a number is grey.
pub fn draw<'a>(triangles: impl Iterator<Item = (&'a Triangle, [f64; 3])>, view: &View) -> Film {
    let [width, height] = view.size.map(|extent| extent as usize * SAMPLES);
    let mut canvas =
        Canvas { width, height, depths: vec![0.0; width * height], colors: vec![BACKGROUND; width * height] };
    for (triangle, values) in triangles {
        canvas.fill(triangle, values, view);
    }
    canvas.draw_legend();
    canvas.into_film(view.size)
}

fn color(value: f64) -> Vec3 {
    if value.is_nan() {
        return UNKNOWN;
    }
    let place = value.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let index = (place as usize).min(RAMP.len() - 2);
    RAMP[index].lerp(RAMP[index + 1], (place - index as f64) as f32)
}

impl Canvas {
    /// None where a corner is not in front of the camera.
    fn project(&self, positions: [DVec3; 3], view: &View) -> Option<Projected> {
        let clip: [DVec4; 3] = positions.map(|position| view.view_projection * position.extend(1.0));
        let extent = DVec2::new(self.width as f64, self.height as f64);
        clip.iter().all(|clip| clip.w > 0.0 && clip.z <= clip.w).then(|| Projected {
            places: clip.map(|clip| (0.5 * clip.xy() / clip.w + 0.5) * extent),
            inverse_depths: clip.map(|clip| clip.w.recip()),
        })
    }

    fn fill(&mut self, triangle: &Triangle, values: [f64; 3], view: &View) {
        let positions = triangle.positions();
        let Some(Projected { places: [a, b, c], inverse_depths }) = self.project(positions, view) else { return };
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return;
        }
        let normal = (positions[1] - positions[0]).cross(positions[2] - positions[0]).normalize_or_zero();
        let facing = normal.dot((view.eye - positions[0]).normalize_or_zero()).abs() as f32;
        let light = AMBIENT + (1.0 - AMBIENT) * facing;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // Samples lie in the middle of their squares.
        let range = |low: f64, high: f64, end: usize| {
            let index = |place: f64| ((place - 0.5).ceil().max(0.0) as usize).min(end);
            index(low)..index(high + 1.0)
        };
        for row in range(low.y, high.y, self.height) {
            for column in range(low.x, high.x, self.width) {
                let sample = DVec2::new(column as f64, row as f64) + 0.5;
                let [a, b, c] = [a - sample, b - sample, c - sample];
                let weights = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)].map(|part| part / area);
                if weights.iter().any(|&weight| weight < 0.0) {
                    continue;
                }
                let weights = [0, 1, 2].map(|corner| weights[corner] * inverse_depths[corner]);
                let depth: f64 = weights.iter().sum();
                let index = row * self.width + column;
                if depth > self.depths[index] {
                    let value = weights.iter().zip(values).map(|(weight, value)| weight * value).sum::<f64>() / depth;
                    self.depths[index] = depth;
                    self.colors[index] = light * color(value);
                }
            }
        }
    }

    /// A bar at the right, red above.
    fn draw_legend(&mut self) {
        let part = |of_height: f64| (of_height * self.height as f64) as usize;
        let (margin, bar_width) = (part(LEGEND_MARGIN), part(LEGEND_WIDTH));
        let right = self.width.saturating_sub(margin);
        let rows = margin..self.height - margin;
        for row in rows.clone() {
            let value = (rows.end - row) as f64 / rows.len() as f64;
            self.colors[row * self.width..][right.saturating_sub(bar_width)..right].fill(color(value));
        }
    }

    /// Pixels as averages of their samples.
    fn into_film(self, [width, height]: [u32; 2]) -> Film {
        let pixel = |row: usize, column: usize| {
            let rows = (row * SAMPLES..(row + 1) * SAMPLES).map(|row| &self.colors[row * self.width..]);
            let sum: Vec3 = rows.flat_map(|row| &row[column * SAMPLES..(column + 1) * SAMPLES]).sum();
            (sum / (SAMPLES * SAMPLES) as f32).extend(1.0).to_array()
        };
        let pixels = (0..height as usize).flat_map(|row| (0..width as usize).map(move |column| (row, column)));
        Film { width, height, color: pixels.map(|(row, column)| pixel(row, column)).collect(), ..Film::default() }
    }
}
