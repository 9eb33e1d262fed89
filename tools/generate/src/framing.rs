//! From how far a camera sees things.
use glam::DVec3;

/// Width over height of the frame that things are framed for.
pub const ASPECT: f64 = 16.0 / 9.0;
/// The direction from the middle of a scene to the eye in the default view of planish, not normalised.
pub const DEFAULT_DIRECTION: DVec3 = DVec3::new(1.0, 0.6, 1.2);

/// The least distance from `target` along `direction` from where all points are in a frame of [`ASPECT`] with a vertical
/// field of view of `fov` degrees, up being +Y. One of them at least is then at the frame's border.
pub fn distance(points: impl IntoIterator<Item = DVec3>, target: DVec3, direction: DVec3, fov: f64) -> f64 {
    let back = direction.normalize();
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let slope = (fov / 2.0).to_radians().tan();
    let least = |point: DVec3| {
        let p = point - target;
        p.dot(back) + (p.dot(up).abs() / slope).max(p.dot(right).abs() / (slope * ASPECT))
    };
    points.into_iter().map(least).fold(0.0, f64::max)
}
