//! A model from several distances: a camera path from where it fills the frame to where it is a speck.
use anyhow::{Context as _, Result};
use glam::Vec3;
use planish_scene::Scene;

use crate::framing::{DEFAULT_DIRECTION, distance};
use crate::scene_text::{Instance, Key, Path, SceneText};

/// Vertical field of view, degrees.
const FOV: f64 = 45.0;
/// Distance at the path's end, in diagonals of the model's box.
pub const FARTHEST: f64 = 20.0;
/// Places that the path passes through; the ratio of a distance to the next is always the same, so that the model shrinks
/// steadily.
const KEY_COUNT: u32 = 12;

/// A scene of one model and the path `distances` of `frame_count` frames. `file` is the model's file, as seen from the
/// scene file's folder.
///
/// # Errors
/// When all points of the model are one.
pub fn scene(model: &Scene, file: &str, frame_count: u32) -> Result<SceneText> {
    let bounds = model.bounds().filter(|bounds| bounds.diagonal() > 0.0).context("the model has no size")?;
    let points = model.meshes.iter().flat_map(|mesh| &mesh.control_mesh.positions);
    let points = points.map(|&point| Vec3::from(point).as_dvec3());
    let nearest = distance(points, bounds.center(), DEFAULT_DIRECTION, FOV);
    let farthest = FARTHEST * bounds.diagonal();
    let key = |index: u32| {
        let share = f64::from(index) / f64::from(KEY_COUNT - 1);
        let distance = nearest * (farthest / nearest).powf(share);
        Key::new(bounds.center() + distance * DEFAULT_DIRECTION.normalize(), bounds.center())
    };
    let mut text = SceneText { comment: "A model from several distances.".to_owned(), ..SceneText::default() };
    text.mesh("model", file);
    text.instances.push(Instance { mesh: "model".to_owned(), ..Instance::default() });
    text.paths.push(Path {
        name: "distances".to_owned(),
        fov: FOV,
        frames: frame_count,
        keys: (0..KEY_COUNT).map(key).collect(),
    });
    Ok(text)
}
