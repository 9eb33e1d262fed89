//! Lights of a sample: where in their extent they are, and the cameras that their shadow maps are seen by.
//!
//! A light with an extent is a sphere, or a disk of the sky, that shines evenly; each sample of a frame has it at another point of
//! that, which both its light and its shadow come from. Over all samples shadows are as soft as they should be.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Mat4, Vec3, Vec4};
use planish_shaders::{Light, ShadowView};

use super::desc::{LightDesc, LightKind};
use crate::camera::FrameCamera;

/// `NO_SHADOW` of `glsl/shared/shade_frame.glsl`.
const NO_SHADOW: u32 = u32::MAX;
/// Distance of a distant light's camera in radii of the scene: its rays are parallel to 1/1000.
const DISTANT_RADII: f64 = 1000.0;
/// Texels that a map holds beyond what is seen, on each side: as far as its filter looks.
const BORDER: f64 = 4.0;
/// Half angles of cones up to this have one map; wider ones six.
const WIDEST_CONE: f64 = 60.0 * PI / 180.0;
/// Nearest that a shadow may be cast from, in radii of the scene, or of the light.
const NEAREST: f64 = 1e-3;

/// A sphere around all that casts and receives shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSphere {
    /// Its middle, in world space.
    pub center: Vec3,
    /// Its radius, above 0.
    pub radius: f32,
}

/// Lights of a sample as the kernel reads them, and the cameras of their shadow maps.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlacedLights {
    pub lights: Vec<Light>,
    pub views: Vec<FrameCamera>,
}

/// Three numbers of [0, 1) for a light and a sample that fill the cube evenly over all samples (Roberts 2018, the R sequence).
fn sequence(light: usize, sample: u32) -> [f64; 3] {
    // Powers of the inverse of the root of x^4 = x + 1.
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    let start = 0.5 + 0.618_033_988_749_894_9 * light as f64;
    STEPS.map(|step| (start + step * f64::from(sample)).fract())
}

/// Radius within which a share of a sphere's points lies, when they are spread so that the sphere looks like an even disk from
/// everywhere: with a density that grows as 1 / sqrt(1 - r^2), whose projection is constant.
fn even_radius(share: f64) -> f64 {
    let within = |r: f64| 2.0 / PI * (r.asin() - r * (1.0 - r * r).max(0.0).sqrt());
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if within(middle) < share { low = middle } else { high = middle }
    }
    low
}

/// A point of a unit sphere that looks like an even disk.
fn in_sphere([a, b, c]: [f64; 3]) -> DVec3 {
    let height = 2.0 * a - 1.0;
    let ring = (1.0 - height * height).max(0.0).sqrt();
    even_radius(c) * DVec3::new(ring * (TAU * b).cos(), ring * (TAU * b).sin(), height)
}

/// A point of the unit disk.
fn in_disk([a, b, _]: [f64; 3]) -> [f64; 2] {
    let r = a.sqrt();
    [r * (TAU * b).cos(), r * (TAU * b).sin()]
}

/// A camera without distortion that sees `tangent` to each side of its direction.
fn camera(eye: DVec3, toward: DVec3, up: DVec3, tangent: f64, near: f64, size: u32) -> FrameCamera {
    let world_to_camera = glam::dcamera::rh::view::look_to_mat4(eye, toward, up);
    let projection = Mat4::from_cols(
        Vec4::X / tangent as f32,
        Vec4::Y / tangent as f32,
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, 0.0, near as f32, 0.0),
    );
    FrameCamera { world_to_camera: world_to_camera.as_mat4(), projection, size: [size; 2] }
}

/// A direction that is not along the given one.
fn any_up(toward: DVec3) -> DVec3 {
    if toward.y.abs() < 0.9 { DVec3::Y } else { DVec3::X }
}

/// The tangent of a half angle of view with the border of a map.
fn with_border(tangent: f64, size: u32) -> f64 {
    tangent * f64::from(size) / (f64::from(size) - 2.0 * BORDER)
}

fn distant(light: &LightDesc, angle: f32, numbers: [f64; 3], scene: &SceneSphere, size: u32) -> (Light, FrameCamera) {
    let back = -light.axis().as_dvec3();
    let x = back.any_orthonormal_vector();
    let [a, b] = in_disk(numbers).map(|at| at * (0.5 * f64::from(angle).to_radians()).tan());
    let toward_light = (back + a * x + b * back.cross(x)).normalize();
    let radius = f64::from(scene.radius);
    let eye = scene.center.as_dvec3() + DISTANT_RADII * radius * toward_light;
    let tangent = with_border(1.002 / DISTANT_RADII, size);
    let near = (DISTANT_RADII - 2.0) * radius;
    let camera = camera(eye, -toward_light, any_up(toward_light), tangent, near, size);
    (Light { position: toward_light.as_vec3().to_array(), kind: 0, ..Light::default() }, camera)
}

/// The six cameras around a point, in the order of `glsl/shared/lights.glsl`.
fn around(eye: DVec3, near: f64, size: u32) -> impl Iterator<Item = FrameCamera> {
    [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z]
        .into_iter()
        .map(move |toward| camera(eye, toward, any_up(toward), with_border(1.0, size), near, size))
}

/// Lights at a sample, in the middle of their extent without one; maps have `size` texels a side.
pub(crate) fn place(descs: &[LightDesc], scene: &SceneSphere, sample: Option<u32>, size: u32) -> PlacedLights {
    let mut placed = PlacedLights::default();
    for (index, desc) in descs.iter().enumerate().filter(|(_, desc)| desc.intensity != [0.0; 3]) {
        let numbers = sample.map_or([0.0, 0.0, 0.0], |sample| sequence(index, sample));
        let first_view = placed.views.len() as u32;
        let axis = desc.axis();
        let position = |radius: f32| desc.to_world.translation.as_dvec3() + f64::from(radius) * in_sphere(numbers);
        let near = |radius: f32| (NEAREST * f64::from(scene.radius)).max(f64::from(radius));
        let inverse = |range: f32| if range.is_finite() { 1.0 / range.max(1e-20) } else { 0.0 };
        let mut views = Vec::new();
        let light = match desc.kind {
            LightKind::Distant { angle } => {
                let (light, camera) = distant(desc, angle, numbers, scene, size);
                views.push(camera);
                light
            }
            LightKind::Point { radius, range } => {
                let eye = position(radius);
                views.extend(around(eye, near(radius), size));
                Light { position: eye.as_vec3().to_array(), kind: 1, inverse_range: inverse(range), ..Light::default() }
            }
            LightKind::Spot { radius, range, inner, outer } => {
                let eye = position(radius);
                // Of a light with extent points off its middle see the scene in other directions: all around.
                if f64::from(outer) <= WIDEST_CONE {
                    let (toward, tangent) = (axis.as_dvec3(), f64::from(outer).tan().max(1e-3));
                    views.push(camera(eye, toward, any_up(toward), with_border(tangent, size), near(radius), size));
                } else {
                    views.extend(around(eye, near(radius), size));
                }
                let cone_scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
                Light {
                    position: eye.as_vec3().to_array(),
                    kind: 2,
                    inverse_range: inverse(range),
                    cone_scale,
                    cone_offset: -outer.cos() * cone_scale,
                    ..Light::default()
                }
            }
        };
        let view_count = views.len() as u32;
        placed.views.extend(if desc.casts_shadows { views } else { Vec::new() });
        placed.lights.push(Light {
            intensity: desc.intensity,
            axis: axis.to_array(),
            first_view: if desc.casts_shadows { first_view } else { NO_SHADOW },
            view_count,
            ..light
        });
    }
    placed
}

/// What the kernel needs of a map's camera. `first_depth`: where its depths begin.
pub(crate) fn shadow_view(camera: &FrameCamera, first_depth: u32) -> ShadowView {
    ShadowView {
        world_to_clip: camera.view_projection().to_cols_array_2d(),
        near: camera.near(),
        texel: 2.0 / (camera.size[0] as f32 * camera.projection.x_axis.x),
        first_depth,
        size: camera.size[0],
    }
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;

    use super::*;

    const SCENE: SceneSphere = SceneSphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 5.0 };

    fn light(kind: LightKind) -> LightDesc {
        LightDesc { kind, to_world: Affine3A::IDENTITY, intensity: [1.0; 3], casts_shadows: true }
    }

    #[test]
    fn a_sphere_light_looks_like_an_even_disk() {
        let count = 20_000;
        let mut rings = [0; 4];
        for sample in 0..count {
            let p = in_sphere(sequence(3, sample));
            let square = p.x * p.x + p.y * p.y;
            rings[((4.0 * square) as usize).min(3)] += 1;
        }
        // Rings of equal area.
        for found in rings {
            assert!((f64::from(found) / f64::from(count) - 0.25).abs() < 0.01, "{rings:?}");
        }
    }

    #[test]
    fn a_distant_light_sees_all_of_the_scene_and_nothing_is_nearer_than_its_near_plane() {
        let placed = place(&[light(LightKind::Distant { angle: 0.0 })], &SCENE, None, 1024);
        let camera = &placed.views[0];
        for i in 0..64_u32 {
            let p = in_sphere([0.1 + 0.01 * f64::from(i), 0.37 * f64::from(i), 1.0]).normalize().as_vec3();
            let clip = camera.view_projection() * (SCENE.center + SCENE.radius * p).extend(1.0);
            assert!(clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z <= clip.w && clip.w > 0.0);
        }
        assert_eq!(placed.lights[0].position, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn the_six_maps_of_a_point_light_see_every_direction_where_the_kernel_looks_it_up() {
        let placed = place(&[light(LightKind::Point { radius: 0.0, range: f32::INFINITY })], &SCENE, None, 256);
        for sample in 0..500 {
            let d = in_sphere(sequence(1, sample)).normalize().as_vec3();
            let size = d.abs();
            let axis = if size.x >= size.y.max(size.z) { 0 } else { if size.y >= size.z { 1 } else { 2 } };
            let camera = &placed.views[2 * axis + usize::from(d[axis] < 0.0)];
            let clip = camera.view_projection() * (7.0 * d).extend(1.0);
            assert!(clip.x.abs() < clip.w && clip.y.abs() < clip.w, "{d}");
        }
    }

    #[test]
    fn a_light_that_is_off_is_left_out_and_one_without_shadows_has_no_map() {
        let point = light(LightKind::Point { radius: 0.0, range: 1.0 });
        let off = LightDesc { intensity: [0.0; 3], ..point };
        let bare = LightDesc { casts_shadows: false, ..point };
        let placed = place(&[off, bare, point], &SCENE, None, 64);
        assert_eq!((placed.lights.len(), placed.views.len()), (2, 6));
        assert_eq!((placed.lights[0].first_view, placed.lights[1].first_view), (NO_SHADOW, 0));
    }
}
