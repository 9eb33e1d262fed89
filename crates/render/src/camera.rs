//! The camera of a frame, as matrices.

use glam::{Mat3, Mat4, Vec2, Vec3};

/// A perspective camera and the image it makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameCamera {
    /// World to camera space: right-handed, looking down -z, +y up.
    pub world_to_camera: Mat4,
    /// Camera space to clip space: y up (the backend's viewport flips it), depth 1 at the near plane and 0 at infinity.
    pub projection: Mat4,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
}

impl FrameCamera {
    /// World to clip space.
    pub fn view_projection(&self) -> Mat4 {
        self.projection * self.world_to_camera
    }

    /// Where the camera is, in world space.
    pub fn eye(&self) -> Vec3 {
        self.world_to_camera.as_dmat4().inverse().w_axis.truncate().as_vec3()
    }

    /// Depth of the near plane: all depths are seen as this over themselves.
    pub fn near(&self) -> f32 {
        self.projection.w_axis.z
    }

    /// The same camera with the image moved right and down by a fraction of a pixel, for one sample of several.
    pub fn jittered(&self, pixels: Vec2) -> Self {
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        let shift = Vec2::new(2.0, -2.0) * pixels / size;
        Self { projection: Mat4::from_translation(shift.extend(0.0)) * self.projection, ..*self }
    }

    /// How the view ray at depth 1 changes from one pixel to the next to the right and down, in world space. Their cross
    /// product points along the view.
    pub fn pixel_steps(&self) -> [Vec3; 2] {
        let [width, height] = self.size.map(|s| s as f32);
        let to_world = Mat3::from_mat4(self.world_to_camera).transpose();
        let dx = Vec3::new(2.0 / (width * self.projection.x_axis.x), 0.0, 0.0);
        let dy = Vec3::new(0.0, -2.0 / (height * self.projection.y_axis.y), 0.0);
        [dx, dy].map(|v| to_world * v)
    }
}

#[cfg(test)]
mod tests {
    use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};

    use super::*;

    fn camera() -> FrameCamera {
        let world_to_camera = look_at_mat4(Vec3::new(3.0, 2.0, 5.0), Vec3::new(0.5, 0.0, 0.0), Vec3::Y);
        let projection = perspective_infinite_reverse(0.8, 1.5, 0.1);
        FrameCamera { world_to_camera, projection, size: [300, 200] }
    }

    #[test]
    fn a_ray_meets_the_pixel_that_its_points_project_to() {
        let camera = camera();
        let [dx, dy] = camera.pixel_steps();
        let eye = camera.world_to_camera.inverse().w_axis.truncate();
        let point = eye + 7.0 * (dx.cross(dy).normalize() + (120.5 - 150.0) * dx + (33.25 - 100.0) * dy);
        let clip = camera.view_projection() * point.extend(1.0);
        let pixel = (clip.truncate() / clip.w).truncate() * Vec2::new(0.5, -0.5) + 0.5;
        assert!((pixel * Vec2::new(300.0, 200.0) - Vec2::new(120.5, 33.25)).length() < 1e-3);
    }

    #[test]
    fn jitter_moves_the_image_right_and_down() {
        let project = |camera: FrameCamera| {
            let clip = camera.view_projection() * Vec3::new(0.2, 0.1, 0.3).extend(1.0);
            ((clip.truncate() / clip.w).truncate() * Vec2::new(0.5, -0.5) + 0.5) * Vec2::new(300.0, 200.0)
        };
        let moved = project(camera().jittered(Vec2::new(0.3, -0.2))) - project(camera());
        assert!((moved - Vec2::new(0.3, -0.2)).length() < 1e-3);
    }
}
