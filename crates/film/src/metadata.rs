//! What an EXR header tells about a frame besides its pixels.

use std::collections::BTreeMap;

/// A 4x4 matrix in the convention of OpenEXR (Imath): points are row vectors, `p' = [x y z 1] * M`, and
/// `m[row][column]` holds the translation in `m[3]`.
///
/// It is the transpose of the matrix that column-vector math writes for the same map, and therefore, entry by entry,
/// what a column-major library keeps in memory: `glam::Mat4::to_cols_array_2d()` is a `Matrix` already.
pub type Matrix = [[f32; 4]; 4];

/// The header of a frame.
///
/// | field | EXR attribute | type |
/// |---|---|---|
/// | `world_to_camera` | `worldToCamera` | `m44f` |
/// | `world_to_ndc` | `worldToNDC` | `m44f` |
/// | `software` | `software` | `string` |
/// | `frame` | `frame` | `int` |
/// | `time` | `time` | `float` |
/// | `frames_per_second` | `framesPerSecond` | `rational` |
/// | `shutter_seconds` | `expTime` | `float` |
/// | `aperture` | `aperture` | `float` |
/// | `focus` | `focus` | `float` |
/// | `screen_window_width` | `screenWindowWidth` | `float` |
/// | `extra` | `planish/NAME` | `string` |
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// World to camera, left-handed as OpenEXR wants it: x to the right, y up, z positive in front of the camera.
    pub world_to_camera: Option<Matrix>,
    /// World to the image plane: after division by w, (0, 0) is the upper left corner of the image and (1, 1) the lower
    /// right.
    pub world_to_ndc: Option<Matrix>,
    /// What made the image, with its version. Empty: left out.
    pub software: String,
    /// The frame's number in its sequence.
    pub frame: i32,
    /// The frame's time on the scene's clock, in seconds.
    pub time: f32,
    /// Nominal playback rate, as numerator and denominator: (24, 1), (30000, 1001).
    pub frames_per_second: Option<(i32, u32)>,
    /// How long the shutter is open, in seconds.
    pub shutter_seconds: Option<f32>,
    /// The lens's aperture in f-stops: focal length over diameter.
    pub aperture: Option<f32>,
    /// The camera's focus distance, in meters.
    pub focus: Option<f32>,
    /// Width of what the frame shows, a unit away from the camera; absent: 1.
    pub screen_window_width: Option<f32>,
    /// What else is to be told: values by names, which are printable ASCII.
    pub extra: BTreeMap<String, String>,
}

impl Metadata {
    /// Derives both camera matrices, and the width of the screen window, from the matrices of a Vulkan renderer.
    ///
    /// `world_to_view`: right-handed, x to the right, y up, looking down -z. `view_to_clip`: to Vulkan's clip space, y
    /// down, -w to w in x and y. Both as [`Matrix`], so glam's column-vector matrices pass as `to_cols_array_2d()`.
    pub fn set_camera(&mut self, world_to_view: &Matrix, view_to_clip: &Matrix) {
        /// OpenEXR's camera looks along +z.
        const VIEW_TO_CAMERA: Matrix =
            [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        /// x and y from -w .. w to 0 .. w.
        const CLIP_TO_NDC: Matrix =
            [[0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.5, 0.5, 0.0, 1.0]];
        self.world_to_camera = Some(product(world_to_view, &VIEW_TO_CAMERA));
        self.world_to_ndc = Some(product(&product(world_to_view, view_to_clip), &CLIP_TO_NDC));
        // x runs from -1 to 1 over the frame, a unit away in perspective and anywhere without.
        self.screen_window_width = Some(2.0 / view_to_clip[0][0].abs()).filter(|width| width.is_normal());
    }
}

/// `a * b`: with row vectors, first `a`, then `b`.
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|k| a[row][k] * b[k][column]).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transform(p: [f32; 3], m: &Matrix) -> [f32; 3] {
        let image: [f32; 4] = std::array::from_fn(|column| {
            p[0] * m[0][column] + p[1] * m[1][column] + p[2] * m[2][column] + m[3][column]
        });
        [0, 1, 2].map(|i| image[i] / image[3])
    }

    /// A camera at (0, 0, 5) looking down -z that sees 90 degrees from left to right, twice as wide as high, near plane 1,
    /// depth reversed or not: z is free here.
    fn metadata() -> Metadata {
        let view = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, -5.0, 1.0]];
        let clip = [[1.0, 0.0, 0.0, 0.0], [0.0, -2.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0]];
        let mut metadata = Metadata::default();
        metadata.set_camera(&view, &clip);
        metadata
    }

    #[test]
    fn camera_space_is_left_handed_with_positive_depth() {
        let to_camera = metadata().world_to_camera.unwrap();
        assert_eq!(transform([1.0, 2.0, 3.0], &to_camera), [1.0, 2.0, 2.0]);
    }

    #[test]
    fn the_screen_window_of_a_right_angle_is_two_wide_a_unit_away() {
        assert_eq!(metadata().screen_window_width, Some(2.0));
    }

    #[test]
    fn ndc_runs_from_the_upper_left_corner_to_the_lower_right() {
        let to_ndc = metadata().world_to_ndc.unwrap();
        let image = |p| {
            let [x, y, _] = transform(p, &to_ndc);
            [x, y]
        };
        assert_eq!(image([0.0, 0.0, 0.0]), [0.5, 0.5]);
        assert_eq!(image([-5.0, 2.5, 0.0]), [0.0, 0.0]);
        assert_eq!(image([5.0, -2.5, 0.0]), [1.0, 1.0]);
    }
}
