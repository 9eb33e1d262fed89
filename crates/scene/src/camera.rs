//! A pinhole camera, its matrices and the default view.
use glam::camera::rh::proj::vulkan::perspective_infinite_reverse;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DAffine3, DVec3, Mat4, Vec3};

use crate::curve::Curve;
use crate::{Bounds, Error};

/// Default view: vertical field of view, degrees.
pub(crate) const DEFAULT_FOV_Y_DEGREES: f32 = 45.0;
/// Default view: direction from the centre of the box to the eye, not normalised.
const DEFAULT_DIRECTION: DVec3 = DVec3::new(1.0, 0.6, 1.2);
/// Default view: distance from the centre of the box to the eye, in diagonals of the box.
const DEFAULT_DISTANCE: f64 = 1.1;
/// Distance of the near plane, in diagonals of the box. A reversed depth in floating point has digits to spare.
const NEAR: f64 = 1e-4;
/// Sine of the angle between up and the line of sight below which they count as parallel.
const MIN_UP_SINE: f64 = 1e-5;

/// A pinhole camera. [`Camera::new`] and its kin make only cameras whose matrices exist.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The name in the file.
    pub name: String,
    /// Where it stands.
    pub eye: Vec3,
    /// The point in the middle of the image.
    pub target: Vec3,
    /// A direction that points upwards in the image.
    pub up: Vec3,
    /// Vertical field of view, degrees.
    pub fov_y_degrees: f32,
    /// Distance of the near plane; what is nearer is not drawn.
    pub near: f32,
    /// Distance of the far plane: infinite, as nothing is too far for a reversed depth in floating point.
    pub far: f32,
    /// What is out of focus; none: nothing.
    pub lens: Option<Lens>,
    /// Where in the image the line of sight ends: the middle is moved right and up by these shares of half its width and height.
    pub shift: [f32; 2],
    /// What moves it; none: nothing.
    pub rig: Option<CameraRig>,
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture, in world units: half the focal length over the f-number.
    pub radius: f32,
    /// Distance along the line of sight of what is in focus, in world units.
    pub focus_distance: f32,
}

/// What a camera hangs on: it looks along -z of a node, +y upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraRig {
    /// Into [`crate::Scene::nodes`].
    pub node: usize,
    /// Vertical field of view, degrees.
    pub fov_y_degrees: Curve<f64>,
    /// See [`Lens::focus_distance`]; 0: nothing is out of focus.
    pub focus_distance: Curve<f64>,
    /// See [`Lens::radius`]; 0: nothing is out of focus.
    pub lens_radius: Curve<f64>,
    /// When the shutter opens and closes, in seconds from the frame's time; none: not said.
    pub shutter: Option<[f64; 2]>,
}

impl CameraRig {
    /// A pinhole camera on a node.
    pub fn pinhole(node: usize, fov_y_degrees: f64) -> Self {
        Self {
            node,
            fov_y_degrees: Curve::constant(fov_y_degrees),
            focus_distance: Curve::constant(0.0),
            lens_radius: Curve::constant(0.0),
            shutter: None,
        }
    }

    /// Whether its own values are the same at all times; its node may move.
    pub fn is_constant(&self) -> bool {
        [&self.fov_y_degrees, &self.focus_distance, &self.lens_radius].iter().all(|curve| curve.is_constant())
    }
}

impl Camera {
    /// A camera that looks at a scene whose bounding box has the given diagonal. The near plane lies at 1/10,000 of it,
    /// and nearer in proportion when the eye is nearer to its target than in the default view (1.1 diagonals).
    ///
    /// # Errors
    /// When a coordinate is not finite, eye and target are the same point, `up` is zero or along the line of sight, the
    /// field of view is not between 0 and 180 degrees (both excluded), or the diagonal is not positive.
    pub fn new(
        name: &str,
        eye: Vec3,
        target: Vec3,
        up: Vec3,
        fov_y_degrees: f32,
        diagonal: f64,
    ) -> Result<Self, Error> {
        let refuse = |found: String, expected| Err(Error::Camera { found, expected });
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return refuse(format!("eye {eye}, target {target}, up {up}"), "finite coordinates");
        }
        let sight = target.as_dvec3() - eye.as_dvec3();
        let distance = sight.length();
        if distance == 0.0 {
            return refuse(format!("eye and target both {eye}"), "two different points");
        }
        let up_length = up.as_dvec3().length();
        if up_length == 0.0 || sight.cross(up.as_dvec3()).length() < MIN_UP_SINE * distance * up_length {
            return refuse(format!("up {up} along the line of sight"), "an up direction across it");
        }
        if !(fov_y_degrees > 0.0 && fov_y_degrees < 180.0) {
            return refuse(format!("a field of view of {fov_y_degrees} degrees"), "more than 0 and less than 180");
        }
        let near = (NEAR * diagonal.min(distance / DEFAULT_DISTANCE)) as f32;
        if !(near > 0.0 && near.is_finite()) {
            return refuse(format!("a scene of size {diagonal}"), "a size above zero that a 32-bit float can hold");
        }
        Ok(Self {
            name: name.to_owned(),
            eye,
            target,
            up,
            fov_y_degrees,
            near,
            far: f32::INFINITY,
            lens: None,
            shift: [0.0; 2],
            rig: None,
        })
    }

    /// A camera on a rig, at the scene's first moment. `diagonal` as of [`Self::new`].
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn rigged(
        name: &str,
        rig: CameraRig,
        node_to_world: &DAffine3,
        time: f64,
        diagonal: f64,
    ) -> Result<Self, Error> {
        // Beyond any scene, so that the near plane follows from the diagonal.
        let mut camera = Self::new(name, Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, DEFAULT_FOV_Y_DEGREES, diagonal)?;
        camera.near = (NEAR * diagonal) as f32;
        camera.rig = Some(rig.clone());
        camera.placed(&rig, node_to_world, time)
    }

    /// The camera where its rig's node is.
    pub(crate) fn placed(&self, rig: &CameraRig, node_to_world: &DAffine3, time: f64) -> Result<Self, Error> {
        let eye = node_to_world.translation;
        let direction = |axis: DVec3| node_to_world.matrix3.mul_vec3(axis).normalize_or_zero();
        let focus = rig.focus_distance.at(time);
        let (sight, up) = (direction(DVec3::NEG_Z), direction(DVec3::Y));
        // As far away as the eye is from the origin: a nearer target would be lost in its digits.
        let distance = if focus > 0.0 && focus.is_finite() { focus } else { 1.0 + eye.length() };
        let target = eye + distance * sight;
        let fov = rig.fov_y_degrees.at(time) as f32;
        let placed = Self::new(&self.name, eye.as_vec3(), target.as_vec3(), up.as_vec3(), fov, 1.0)?;
        let radius = rig.lens_radius.at(time);
        let has_lens = radius > 0.0 && focus > 0.0 && focus.is_finite() && radius.is_finite();
        let lens = has_lens.then_some(Lens { radius: radius as f32, focus_distance: focus as f32 });
        Ok(Self { near: self.near, shift: self.shift, rig: self.rig.clone(), lens, ..placed })
    }

    /// A camera with up +Y; where it looks along Y, with up -Z when it looks down and +Z when it looks up.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn upright(name: &str, eye: Vec3, target: Vec3, fov_y_degrees: f32, diagonal: f64) -> Result<Self, Error> {
        let sight = (target.as_dvec3() - eye.as_dvec3()).normalize_or_zero();
        let vertical = sight.x.hypot(sight.z) < MIN_UP_SINE && sight.y != 0.0;
        let up = if vertical { Vec3::Z * sight.y.signum() as f32 } else { Vec3::Y };
        Self::new(name, eye, target, up, fov_y_degrees, diagonal)
    }

    /// The default view of what lies in a box: 45 degrees, up +Y, target = centre, eye = centre + 1.1 * diagonal *
    /// normalize(1, 0.6, 1.2).
    ///
    /// # Errors
    /// When the box is a single point.
    pub fn default_view(bounds: &Bounds) -> Result<Self, Error> {
        let (center, diagonal) = (bounds.center(), bounds.diagonal());
        if diagonal == 0.0 {
            return Err(Error::Camera {
                found: format!("all points at {center}"),
                expected: "points apart, for the default view",
            });
        }
        let eye = center + DEFAULT_DISTANCE * diagonal * DEFAULT_DIRECTION.normalize();
        Self::new("default", eye.as_vec3(), center.as_vec3(), Vec3::Y, DEFAULT_FOV_Y_DEGREES, diagonal)
    }

    /// World to camera: right-handed, x right, y up, the camera looks along -z.
    pub fn view_matrix(&self) -> Mat4 {
        // In double: squares of huge or tiny coordinates leave the range of floats.
        look_at_mat4(self.eye.as_dvec3(), self.target.as_dvec3(), self.up.as_dvec3()).as_mat4()
    }

    /// Camera to Vulkan's clip space: y down, depth 1 at the near plane and 0 at infinity. `aspect` is width / height.
    pub fn projection_matrix(&self, aspect: f32) -> Mat4 {
        let mut projection = perspective_infinite_reverse(self.fov_y_degrees.to_radians(), aspect, self.near);
        // Depth is -z: what is at the middle moves left and down (y is down in clip space) by the shift.
        projection.z_axis.x += self.shift[0];
        projection.z_axis.y -= self.shift[1];
        projection
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample_bounds() -> Bounds {
        Bounds::of([[-1.0, 2.0, 3.0], [3.0, 8.0, 15.0]]).unwrap()
    }

    fn sample() -> Camera {
        Camera::new("c", Vec3::new(3.0, 2.0, 5.0), Vec3::new(1.0, 0.5, -1.0), Vec3::Y, 40.0, 4.0).unwrap()
    }

    fn refusal(camera: Result<Camera, Error>) -> String {
        camera.unwrap_err().to_string()
    }

    #[test]
    fn default_view_is_the_interface_formula() {
        let camera = Camera::default_view(&sample_bounds()).unwrap();
        // The box is 4 x 6 x 12, its diagonal 14 and its centre (1, 5, 9); |(1, 0.6, 1.2)| = sqrt(2.8).
        let step = 1.1 * 14.0 / 2.8f32.sqrt();
        assert_eq!(camera.target, Vec3::new(1.0, 5.0, 9.0));
        assert!((camera.eye - Vec3::new(1.0 + step, 5.0 + 0.6 * step, 9.0 + 1.2 * step)).length() < 1e-5);
        assert_eq!((camera.up, camera.fov_y_degrees), (Vec3::Y, 45.0));
        assert!((camera.near - 1.4e-3).abs() < 1e-9);
        assert_eq!(camera.far, f32::INFINITY);
    }

    #[test]
    fn target_maps_to_the_image_centre() {
        let camera = sample();
        let clip = camera.projection_matrix(1.5) * camera.view_matrix() * camera.target.extend(1.0);
        assert!((clip.x / clip.w).abs() < 1e-6 && (clip.y / clip.w).abs() < 1e-6);
        assert!(clip.w > 0.0);
    }

    #[test]
    fn up_in_the_world_is_up_in_the_image_where_y_points_down() {
        let camera = sample();
        let clip = camera.projection_matrix(1.0) * camera.view_matrix() * (camera.target + Vec3::Y).extend(1.0);
        assert!(clip.y < 0.0);
    }

    #[test]
    fn half_the_field_of_view_maps_to_the_image_border() {
        let camera = Camera::new("c", Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 90.0, 1.0).unwrap();
        let clip = camera.projection_matrix(2.0) * camera.view_matrix() * glam::Vec4::new(2.0, -1.0, -1.0, 1.0);
        assert!((clip / clip.w - glam::Vec4::new(1.0, 1.0, clip.z / clip.w, 1.0)).length() < 1e-6);
    }

    #[test]
    fn depth_is_one_at_the_near_plane_and_zero_at_infinity() {
        let camera = Camera::new("c", Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 60.0, 1.0).unwrap();
        let depth = |distance: f32| {
            let clip = camera.projection_matrix(1.0) * glam::Vec4::new(0.0, 0.0, -distance, 1.0);
            clip.z / clip.w
        };
        assert!((depth(camera.near) - 1.0).abs() < 1e-6);
        assert!(depth(1e12) < 1e-9);
        assert!(depth(1.0) > depth(2.0));
    }

    #[test]
    fn near_plane_follows_an_eye_that_comes_close_and_stays_for_one_that_leaves() {
        let near = |distance: f32| Camera::upright("c", Vec3::X * distance, Vec3::ZERO, 45.0, 2.0).unwrap().near;
        assert!((near(2.2) - 2e-4).abs() < 1e-9);
        assert!((near(0.22) - 2e-5).abs() < 1e-9);
        assert!((near(220.0) - 2e-4).abs() < 1e-9);
    }

    #[test]
    fn eye_at_the_target_is_refused() {
        let camera = Camera::new("c", Vec3::ONE, Vec3::ONE, Vec3::Y, 45.0, 1.0);
        assert_eq!(refusal(camera), "camera: found eye and target both [1, 1, 1], expected two different points");
    }

    #[test]
    fn up_along_the_line_of_sight_is_refused() {
        let camera = Camera::new("c", Vec3::ZERO, Vec3::Y * 5.0, Vec3::Y, 45.0, 1.0);
        assert!(refusal(camera).contains("up [0, 1, 0] along the line of sight"));
        assert!(refusal(Camera::new("c", Vec3::ZERO, Vec3::X, Vec3::ZERO, 45.0, 1.0)).contains("up"));
    }

    #[test]
    fn fields_of_view_outside_0_to_180_are_refused() {
        for fov in [0.0, -10.0, 180.0, f32::NAN] {
            assert!(refusal(Camera::new("c", Vec3::ZERO, Vec3::X, Vec3::Y, fov, 1.0)).contains("field of view"));
        }
    }

    #[test]
    fn coordinates_that_are_not_finite_are_refused() {
        let camera = Camera::new("c", Vec3::new(f32::NAN, 0.0, 0.0), Vec3::X, Vec3::Y, 45.0, 1.0);
        assert!(refusal(camera).contains("finite coordinates"));
    }

    #[test]
    fn scenes_without_a_usable_size_are_refused() {
        assert!(refusal(Camera::new("c", Vec3::ZERO, Vec3::X, Vec3::Y, 45.0, 0.0)).contains("a scene of size 0"));
        let point = Bounds::of([[1.0; 3]]).unwrap();
        assert!(refusal(Camera::default_view(&point)).contains("all points at [1, 1, 1]"));
        let huge = Bounds::of([[f32::MIN; 3], [f32::MAX; 3]]).unwrap();
        assert!(refusal(Camera::default_view(&huge)).contains("finite coordinates"));
    }

    #[test]
    fn upright_cameras_may_look_straight_down_and_up() {
        let down = Camera::upright("c", Vec3::Y, Vec3::ZERO, 45.0, 1.0).unwrap();
        let up = Camera::upright("c", Vec3::NEG_Y, Vec3::ZERO, 45.0, 1.0).unwrap();
        assert_eq!((down.up, up.up), (Vec3::NEG_Z, Vec3::Z));
        assert_eq!(Camera::upright("c", Vec3::X, Vec3::ZERO, 45.0, 1.0).unwrap().up, Vec3::Y);
    }

    #[test]
    fn a_camera_on_a_node_looks_along_its_negative_z_and_moves_with_it() {
        let node = DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0))
            * DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2);
        let mut rig = CameraRig::pinhole(0, 30.0);
        (rig.focus_distance, rig.lens_radius) = (Curve::constant(4.0), Curve::constant(0.5));
        let camera = Camera::rigged("c", rig, &node, 0.0, 10.0).unwrap();
        assert_eq!((camera.eye, camera.fov_y_degrees, camera.near), (Vec3::new(1.0, 2.0, 3.0), 30.0, 1e-3));
        assert!((camera.target - Vec3::new(-3.0, 2.0, 3.0)).length() < 1e-5, "{}", camera.target);
        assert_eq!(camera.lens, Some(Lens { radius: 0.5, focus_distance: 4.0 }));
    }

    #[test]
    fn a_shift_moves_the_middle_of_the_image_right_and_up() {
        let camera = Camera { shift: [0.5, 0.25], ..sample() };
        let clip = camera.projection_matrix(1.0) * camera.view_matrix() * camera.target.extend(1.0);
        let seen = clip.truncate() / clip.w;
        assert!((seen.x + 0.5).abs() < 1e-6 && (seen.y - 0.25).abs() < 1e-6, "{seen}");
    }
}
