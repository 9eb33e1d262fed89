//! What the bodies of the scene share: curves through points, and squares made round.
use glam::DVec2;

/// The value at `t` of the polyline through (t, value) points in ascending order of t; its ends go on for ever.
pub fn profile(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.iter().position(|&(at, _)| at >= t).unwrap_or(points.len());
    match (after.checked_sub(1).map(|before| points[before]), points.get(after)) {
        (Some((t0, value0)), Some(&(t1, value1))) => value0 + (value1 - value0) * (t - t0) / (t1 - t0),
        (Some((_, value)), None) | (None, Some(&(_, value))) => value,
        (None, None) => 0.0,
    }
}

/// Maps the square -1..1 to the disc of radius 1 (elliptical grid mapping); with `roundness` 0 it stays a square.
pub fn rounded(point: DVec2, roundness: f64) -> DVec2 {
    let narrowed = |along: f64, across: f64| along * (1.0 - across * across / 2.0).sqrt();
    let disc = DVec2::new(narrowed(point.x, point.y), narrowed(point.y, point.x));
    point.lerp(disc, roundness)
}

/// Goes smoothly from 0 to 1 while t goes from `start` to `end`.
pub fn smooth_step(start: f64, end: f64, t: f64) -> f64 {
    let s = ((t - start) / (end - start)).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}
