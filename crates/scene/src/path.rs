//! A camera that moves from frame to frame: eye and target each follow a uniform Catmull-Rom spline through their keys.
//!
//! The spline passes through every key, and keys are as many frames apart as they are from each other in the list. Beyond the
//! first and the last key stands their neighbour's mirror image, so that the curve sets out and arrives straight.
use glam::{DVec3, Vec3};

use crate::{Camera, Error};

/// Most frames of a path: each is checked when the path is made.
pub const MAX_FRAMES: u32 = 1_000_000;

/// A place that a camera path passes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Where the camera stands.
    pub eye: Vec3,
    /// The point in the middle of the image.
    pub target: Vec3,
}

/// A camera's way through a scene. [`CameraPath::new`] makes only paths on which every frame has a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    name: String,
    fov_y_degrees: f32,
    frame_count: u32,
    keys: Vec<Key>,
    diagonal: f64,
}

impl CameraPath {
    /// A path of `frame_count` frames, the first at the first key and the last at the last. The cameras are
    /// [`Camera::upright`] in a scene of the given diagonal.
    ///
    /// # Errors
    /// When there are fewer than two keys, no frames or more than [`MAX_FRAMES`], or a frame's camera would see nothing
    /// ([`Camera::new`]).
    pub fn new(name: &str, fov_y_degrees: f32, frame_count: u32, keys: Vec<Key>, diagonal: f64) -> Result<Self, Error> {
        if keys.len() < 2 {
            return Err(Error::Camera { found: format!("{} keys", keys.len()), expected: "2 or more" });
        }
        if !(1..=MAX_FRAMES).contains(&frame_count) {
            return Err(Error::Camera { found: format!("{frame_count} frames"), expected: "1 to 1,000,000" });
        }
        let path = Self { name: name.to_owned(), fov_y_degrees, frame_count, keys, diagonal };
        for frame in 0..frame_count {
            path.try_camera(frame).map_err(|error| match error {
                Error::Camera { found, expected } => {
                    Error::Camera { found: format!("{found} in frame {frame}"), expected }
                }
                other => other,
            })?;
        }
        Ok(path)
    }

    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Number of frames, at least 1.
    pub fn frame_count(&self) -> u32 {
        self.frame_count
    }

    /// The places that the path passes through, at least two.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// The camera of a frame, counted from 0; frames after the last are as the last. It has the path's name.
    ///
    /// # Panics
    /// Never: a path on which a frame has no camera is not made.
    pub fn camera(&self, frame: u32) -> Camera {
        self.try_camera(frame).expect("every frame was tried when the path was made")
    }

    /// The camera between two frames: where it is after so many frames, which need not be whole.
    ///
    /// # Errors
    /// When it would see nothing there ([`Camera::new`]).
    pub fn camera_between(&self, frames: f64) -> Result<Camera, Error> {
        let [eye, target] = self.places(frames).map(|place| place.as_vec3());
        Camera::upright(&self.name, eye, target, self.fov_y_degrees, self.diagonal)
    }

    fn try_camera(&self, frame: u32) -> Result<Camera, Error> {
        self.camera_between(f64::from(frame))
    }

    /// Eye and target of a frame.
    fn places(&self, frame: f64) -> [DVec3; 2] {
        let last_frame = f64::from(self.frame_count - 1);
        // In units of keys; exact at a key whose frame is a whole number.
        let time = frame.clamp(0.0, last_frame) * (self.keys.len() - 1) as f64 / last_frame.max(1.0);
        let before = (time.floor() as usize).min(self.keys.len() - 1);
        let share = time - before as f64;
        let eye = |key: &Key| key.eye.as_dvec3();
        let target = |key: &Key| key.target.as_dvec3();
        [self.spline(before, share, eye), self.spline(before, share, target)]
    }

    /// The spline between key `before` and the next: Catmull and Rom, A Class of Local Interpolating Splines, 1974, with
    /// tangents of half the chord between a key's neighbours.
    fn spline(&self, before: usize, share: f64, place: impl Fn(&Key) -> DVec3) -> DVec3 {
        let key = |index: usize| self.keys.get(index).map(&place);
        let last = self.keys.len() - 1;
        let here = place(&self.keys[before.min(last)]);
        let after_end = 2.0 * place(&self.keys[last]) - place(&self.keys[last - 1]);
        let next = key(before + 1).unwrap_or(after_end);
        let after_next = key(before + 2).unwrap_or(after_end);
        let previous = match before.checked_sub(1) {
            Some(index) => place(&self.keys[index]),
            None => 2.0 * here - next,
        };
        let linear = next - previous;
        let square = 2.0 * previous - 5.0 * here + 4.0 * next - after_next;
        let cubic = 3.0 * (here - next) + after_next - previous;
        here + 0.5 * share * (linear + share * (square + share * cubic))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path whose eye is at these points and whose target is one below.
    fn path(frame_count: u32, eyes: &[[f32; 3]]) -> Result<CameraPath, Error> {
        let key = |&eye: &[f32; 3]| Key { eye: eye.into(), target: Vec3::from(eye) - Vec3::Z };
        CameraPath::new("p", 45.0, frame_count, eyes.iter().map(key).collect(), 10.0)
    }

    fn refusal(path: Result<CameraPath, Error>) -> String {
        path.unwrap_err().to_string()
    }

    #[test]
    fn path_passes_through_its_keys() {
        let eyes = [[0.1, 0.0, 0.0], [1.0, 3.0, -2.0], [5.0, 0.3, 0.0], [4.0, 4.0, 0.7]];
        let path = path(31, &eyes).unwrap();
        for (frame, eye) in [0, 10, 20, 30].into_iter().zip(eyes) {
            let camera = path.camera(frame);
            assert_eq!((camera.eye, camera.target), (Vec3::from(eye), Vec3::from(eye) - Vec3::Z), "{frame}");
        }
        assert_eq!((path.camera(7).name.as_str(), path.frame_count(), path.keys().len()), ("p", 31, 4));
    }

    #[test]
    fn between_four_keys_the_spline_is_catmull_and_roms() {
        let path = path(7, &[[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, 4.0, 0.0], [4.0, 0.0, 8.0]]).unwrap();
        // At the middle the weights are -1/16, 9/16, 9/16, -1/16.
        assert_eq!(path.camera(3).eye, Vec3::new(2.0, 54.0 / 16.0, -0.5));
    }

    #[test]
    fn keys_on_a_line_at_equal_distances_make_a_steady_motion() {
        for keys in [vec![[0.0; 3], [6.0, 0.0, 0.0]], vec![[0.0; 3], [3.0, 0.0, 0.0], [6.0, 0.0, 0.0]]] {
            let path = path(13, &keys).unwrap();
            for frame in 0..13 {
                assert!((path.camera(frame).eye.x - frame as f32 / 2.0).abs() < 1e-6, "{frame}");
            }
        }
    }

    #[test]
    fn the_first_and_the_last_stretch_are_those_of_a_mirrored_neighbour() {
        let bent = [[0.0; 3], [2.0, 2.0, 0.0], [4.0, 0.0, 0.0]];
        let mut longer = vec![[-2.0, -2.0, 0.0]];
        longer.extend(bent);
        longer.push([6.0, -2.0, 0.0]);
        let (path, longer) = (path(21, &bent).unwrap(), path(41, &longer).unwrap());
        for frame in 0..21 {
            assert!((path.camera(frame).eye - longer.camera(frame + 10).eye).length() < 1e-6, "{frame}");
        }
    }

    #[test]
    fn frames_after_the_last_are_as_the_last_and_one_frame_is_the_first_key() {
        let keys = [[0.0; 3], [1.0, 0.0, 0.0]];
        assert_eq!(path(5, &keys).unwrap().camera(u32::MAX).eye, Vec3::X);
        assert_eq!(path(1, &keys).unwrap().camera(3).eye, Vec3::ZERO);
    }

    #[test]
    fn paths_need_two_keys_and_a_bounded_number_of_frames() {
        assert_eq!(refusal(path(5, &[[0.0; 3]])), "camera: found 1 keys, expected 2 or more");
        for frame_count in [0, MAX_FRAMES + 1, u32::MAX] {
            let expected = format!("camera: found {frame_count} frames, expected 1 to 1,000,000");
            assert_eq!(refusal(path(frame_count, &[[0.0; 3], [1.0, 0.0, 0.0]])), expected);
        }
    }

    #[test]
    fn a_frame_without_a_camera_is_named() {
        let key = |x: f32, target: f32| Key { eye: Vec3::X * x, target: Vec3::X * target };
        let meeting = CameraPath::new("p", 45.0, 5, vec![key(0.0, 2.0), key(4.0, 2.0)], 1.0);
        let expected = "camera: found eye and target both [2, 0, 0] in frame 2, expected two different points";
        assert_eq!(refusal(meeting), expected);
    }

    #[test]
    fn coordinates_near_the_end_of_floats_do_not_panic() {
        let far = CameraPath::new(
            "p",
            45.0,
            9,
            vec![Key { eye: Vec3::MAX, target: Vec3::ZERO }, Key { eye: Vec3::MIN, target: Vec3::ONE }],
            1.0,
        );
        assert!(far.is_ok() || refusal(far).starts_with("camera: found "));
    }
}
