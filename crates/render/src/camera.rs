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

    /// The same camera from another point of its lens: its eye moves to the right and up by `offset`, and what lies at `focus_distance`
    /// stays where it is in the image. Both in world units.
    pub fn through_lens(&self, offset: Vec2, focus_distance: f32) -> Self {
        let mut projection = self.projection;
        // x' = x - offset + offset * depth / focus, with depth -z, and y alike.
        for (column, shift) in [(projection.x_axis, offset.x), (projection.y_axis, offset.y)] {
            projection.z_axis -= column * (shift / focus_distance);
        }
        let moved = Mat4::from_translation(-offset.extend(0.0)) * self.world_to_camera;
        Self { world_to_camera: moved, projection, ..*self }
    }

    /// The camera whose whole image is a part of this one's, in pixels: left, top, width and height.
    pub fn cropped(&self, [left, top, width, height]: [u32; 4]) -> Self {
        let [left, top, width, height] = [left, top, width, height].map(|pixels| pixels as f32);
        let [full_width, full_height] = self.size.map(|pixels| pixels as f32);
        // x in clip space is 2 * pixel / size - 1, and y the other way round.
        let scale = Vec3::new(full_width / width, full_height / height, 1.0);
        let shift =
            Vec3::new((full_width - 2.0 * left - width) / width, (2.0 * top + height - full_height) / height, 0.0);
        let crop = Mat4::from_translation(shift) * Mat4::from_scale(scale);
        Self { projection: crop * self.projection, size: [width as u32, height as u32], ..*self }
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

    fn pixel(camera: &FrameCamera, p: Vec3) -> Vec2 {
        let clip = camera.view_projection() * p.extend(1.0);
        let size = Vec2::new(camera.size[0] as f32, camera.size[1] as f32);
        ((clip.truncate() / clip.w).truncate() * Vec2::new(0.5, -0.5) + 0.5) * size
    }

    #[test]
    fn what_is_in_focus_stays_where_it_is_from_all_points_of_the_lens() {
        let camera = camera();
        let moved = camera.through_lens(Vec2::new(0.1, -0.05), 4.0);
        let to_world = camera.world_to_camera.inverse();
        let at = |depth: f32| to_world.transform_point3(Vec3::new(0.3, 0.2, -depth));
        assert!((pixel(&camera, at(4.0)) - pixel(&moved, at(4.0))).length() < 1e-3);
        // Twice as far, the eye's move to the right takes the point to the right by half of what it takes infinity.
        let shift = pixel(&moved, at(8.0)) - pixel(&camera, at(8.0));
        let focal = 150.0 * camera.projection.x_axis.x;
        assert!((shift.x - focal * 0.1 * (1.0 / 4.0 - 1.0 / 8.0)).abs() < 1e-3, "{shift}");
        assert!((moved.eye() - to_world.transform_point3(Vec3::new(0.1, -0.05, 0.0))).length() < 1e-5);
    }

    #[test]
    fn a_crop_shows_the_same_pixels_from_its_own_corner() {
        let camera = camera();
        let cropped = camera.cropped([40, 30, 100, 50]);
        let p = Vec3::new(0.2, 0.1, 0.3);
        assert!((pixel(&cropped, p) + Vec2::new(40.0, 30.0) - pixel(&camera, p)).length() < 1e-3);
        assert_eq!(cropped.size, [100, 50]);
    }
}
