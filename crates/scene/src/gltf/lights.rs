//! Lights of KHR_lights_punctual, and cameras.
use ::gltf::json::camera;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light as FileLight, Type};
use ::gltf::json::validation::Checked;
use std::f32::consts::FRAC_PI_2;

use super::data::Data;
use super::fault::{Fault, at};
use super::hierarchy::Hierarchy;
use super::nodes::own_name;
use crate::curve::Curve;
use crate::node::Placed;
use crate::obj::Warnings;
use crate::{Camera, CameraRig, Light, LightKind};

/// The lights that the scene shows, in the order of nodes. One lux and one candela are the unit of [`Light::intensity`].
pub fn lights(data: &Data, hierarchy: &Hierarchy) -> Result<Vec<Light>, Fault> {
    let extension = data.root.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    let file_lights = extension.map_or(&[][..], |extension| &extension.lights);
    let mut lights = Vec::new();
    for (place, &file_node) in hierarchy.file_nodes[..hierarchy.shown_count].iter().enumerate() {
        let node = &data.root.nodes[file_node];
        let used = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        let Some(index) = used.map(|used| used.light.value()) else { continue };
        let light = at(file_lights, index, "lights", || format!("nodes[{file_node}]"))?;
        let name = own_name(node).or_else(|| light.name.clone()).unwrap_or_else(|| format!("light {index}"));
        let kind = kind(light, &format!("lights[{index}]"))?;
        let intensity = Curve::constant(f64::from(light.intensity));
        lights.push(Light { name, node: place, kind, color: light.color, intensity, casts_shadows: true });
    }
    Ok(lights)
}

fn kind(light: &FileLight, place: &str) -> Result<LightKind, Fault> {
    let mut amounts = light.color.into_iter().chain([light.intensity]);
    if let Some(value) = amounts.find(|value| !(value.is_finite() && *value >= 0.0)) {
        return Err(Fault::new(place, format!("{value} as colour or intensity"), "0 or more"));
    }
    let range = light.range.unwrap_or(f32::INFINITY);
    if range.is_nan() || range <= 0.0 {
        return Err(Fault::new(place, format!("a range of {range}"), "more than 0"));
    }
    match light.type_ {
        Checked::Valid(Type::Directional) => Ok(LightKind::Distant { angle: 0.0 }),
        Checked::Valid(Type::Point) => Ok(LightKind::Point { radius: 0.0, range }),
        Checked::Valid(Type::Spot) => {
            let spot = light.spot.as_ref().ok_or_else(|| Fault::new(place, "no spot", "the angles of its cone"))?;
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2 + f32::EPSILON) {
                let found = format!("a cone of {inner} to {outer} radians");
                return Err(Fault::new(place, found, "0 <= inner < outer <= pi / 2"));
            }
            Ok(LightKind::Spot { radius: 0.0, range, inner, outer })
        }
        Checked::Invalid => Err(Fault::new(place, "an unknown type", "directional, point or spot")),
    }
}

/// The cameras that the scene shows, in the order of nodes. `placed`: all nodes at the scene's first moment, `time`. `diagonal`: of
/// the scene's box then.
pub fn cameras(
    data: &Data,
    hierarchy: &Hierarchy,
    placed: &[Placed],
    (time, diagonal): (f64, f64),
    warnings: &mut Warnings,
) -> Result<Vec<Camera>, Fault> {
    let mut cameras = Vec::new();
    for (place, &file_node) in hierarchy.file_nodes[..hierarchy.shown_count].iter().enumerate() {
        let node = &data.root.nodes[file_node];
        let Some(index) = node.camera.map(|camera| camera.value()) else { continue };
        let camera = at(&data.root.cameras, index, "cameras", || format!("nodes[{file_node}].camera"))?;
        let element = format!("cameras[{index}]");
        let perspective = match (camera.type_, &camera.perspective) {
            (Checked::Valid(camera::Type::Perspective), Some(perspective)) => perspective,
            (Checked::Valid(camera::Type::Orthographic), _) => {
                warnings.push(None, format!("{element}: orthographic: left out"));
                continue;
            }
            _ => return Err(Fault::new(element, "no perspective", "type perspective or orthographic, and its values")),
        };
        let name = own_name(node).or_else(|| camera.name.clone()).unwrap_or_else(|| format!("camera {index}"));
        let rig = CameraRig::pinhole(place, f64::from(perspective.yfov).to_degrees());
        let made = Camera::rigged(&name, rig, &placed[place].to_world, time, diagonal);
        cameras.push(made.map_err(|error| Fault::new(element, error.to_string(), "a camera that sees something"))?);
    }
    Ok(cameras)
}
