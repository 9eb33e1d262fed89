//! Lights (UsdLux). A light has the radiance L = intensity * 2^exposure, the same in all directions; ours have what far-away
//! surfaces receive of it: a sphere of radius r has the radiant intensity L pi r^2, a disc in the sky of the angle a gives
//! L pi sin^2(a / 2), a flat light of the area A has L A along its axis. `normalize` divides L by the surface (a sphere's is
//! 4 pi r^2), or by pi sin^2(a / 2).
use std::f64::consts::PI;

use glam::{DAffine3, DQuat};
use openusd::sdf::Value;

use super::attributes::Attributes;
use super::meshes::Context;
use super::textures::Textures;
use super::walk::Item;
use super::{blackbody, convert};
use crate::curve::{Curve, Interpolation};
use crate::gltf::fault::Fault;
use crate::obj::Warnings;
use crate::{Environment, Light, LightKind};

/// The schema's fallbacks.
const DISTANT_INTENSITY: f64 = 50_000.0;
const DISTANT_ANGLE: f64 = 0.53;
const TEMPERATURE: f64 = 6500.0;

/// Lights of a stage.
#[derive(Default)]
pub struct Lights {
    pub lights: Vec<Light>,
    pub environment: Option<Environment>,
}

/// Reads all lights that renders show.
pub fn read(context: &Context, textures: &mut Textures, warnings: &mut Warnings) -> Result<Lights, Fault> {
    let mut lights = Lights::default();
    for item in context.tree.items.iter().filter(|item| item.is_rendered && item.kind.contains("Light")) {
        let attributes = Attributes::new(&item.prim, context.rate);
        if item.kind.starts_with("DomeLight") {
            if lights.environment.is_some() {
                warnings.push(None, format!("{}: a second dome light: left out", attributes.path()));
                continue;
            }
            lights.environment = Some(dome(context, item, &attributes, textures)?);
        } else if let Some(light) = light(context, item, &attributes, warnings)? {
            lights.lights.push(light);
        }
    }
    Ok(lights)
}

/// An input; files of before 2021 name it without its namespace.
fn input<T>(
    attributes: &Attributes,
    name: &str,
    expected: &str,
    convert: fn(Value) -> Option<T>,
) -> Result<Option<T>, Fault> {
    match attributes.get(&format!("inputs:{name}"), expected, convert)? {
        Some(value) => Ok(Some(value)),
        None => attributes.get(name, expected, convert),
    }
}

fn number(attributes: &Attributes, name: &str, fallback: f64) -> Result<f64, Fault> {
    Ok(input(attributes, name, "0 or more", |value| convert::number(value).filter(|v| v.is_finite() && *v >= 0.0))?
        .unwrap_or(fallback))
}

fn flag(attributes: &Attributes, name: &str, fallback: bool) -> Result<bool, Fault> {
    Ok(input(attributes, name, "a bool", convert::boolean)?.unwrap_or(fallback))
}

/// Radiance over time, white.
fn radiance(attributes: &Attributes, fallback: f64) -> Result<Curve<f64>, Fault> {
    let curve = |name: &str, fallback: f64| -> Result<Curve<f64>, Fault> {
        let read = |name: &str| attributes.curve(name, ("a finite number", Interpolation::Linear), finite);
        let curve = match read(&format!("inputs:{name}"))? {
            Some(curve) => Some(curve),
            None => read(name)?,
        };
        Ok(curve.unwrap_or_else(|| Curve::constant(fallback)))
    };
    let (intensity, exposure) = (curve("intensity", fallback)?, curve("exposure", 0.0)?);
    Ok(super::cameras::both(&intensity, &exposure, |intensity, exposure| intensity.max(0.0) * exposure.exp2()))
}

fn finite(value: Value) -> Option<f64> {
    convert::number(value).filter(|v| v.is_finite())
}

fn color(attributes: &Attributes) -> Result<[f32; 3], Fault> {
    let color = |value| convert::vec3(value).filter(|v| v.is_finite() && v.min_element() >= 0.0);
    let color = input(attributes, "color", "a colour of 0 or more", color)?.unwrap_or(glam::DVec3::ONE);
    let is_warm = flag(attributes, "enableColorTemperature", false)?;
    let tint = match is_warm {
        true => blackbody::color(number(attributes, "colorTemperature", TEMPERATURE)?),
        false => glam::DVec3::ONE,
    };
    Ok((color * tint).as_vec3().to_array())
}

fn light(
    context: &Context,
    item: &Item,
    attributes: &Attributes,
    warnings: &mut Warnings,
) -> Result<Option<Light>, Fault> {
    let to_world = context.placed[item.node].to_world;
    // Lights grow with what they stand on.
    let scale = to_world.matrix3.determinant().abs().cbrt();
    let radius = scale * number(attributes, "radius", 0.5)?;
    let is_normalized = flag(attributes, "normalize", false)?;
    let is_point = flag(attributes, "treatAsPoint", false)?;
    let mut fallback = 1.0;
    // What of the radiance is received, and by what normalised lights divide it.
    let (factor, size, radius) = match item.kind.as_str() {
        "SphereLight" => (PI * radius * radius, 4.0 * PI * radius * radius, if is_point { 0.0 } else { radius }),
        "DiskLight" => (PI * radius * radius, PI * radius * radius, radius),
        "RectLight" => {
            let area = scale * scale * number(attributes, "width", 1.0)? * number(attributes, "height", 1.0)?;
            (area, area, (area / PI).sqrt())
        }
        "CylinderLight" => {
            let length = scale * number(attributes, "length", 1.0)?;
            (2.0 * radius * length, 2.0 * PI * radius * length, radius)
        }
        "DistantLight" => {
            fallback = DISTANT_INTENSITY;
            let angle = number(attributes, "angle", DISTANT_ANGLE)?.min(180.0);
            let disc = PI * (angle.to_radians() / 2.0).sin().powi(2);
            // A point in the sky gives what is left when the disc shrinks: the intensity itself.
            if disc > 0.0 { (disc, disc, angle) } else { (1.0, 1.0, 0.0) }
        }
        kind => {
            warnings.push(None, format!("{}: a {kind}: left out", attributes.path()));
            return Ok(None);
        }
    };
    if ["DiskLight", "RectLight", "CylinderLight"].contains(&item.kind.as_str()) {
        let text = format!("{}: a {} shines from its middle", attributes.path(), item.kind);
        warnings.push(None, text);
    }
    let share = match is_normalized {
        true if size > 0.0 => factor / size,
        true => 0.25,
        false => factor,
    };
    Ok(Some(Light {
        name: attributes.path(),
        node: item.node,
        kind: kind(item, attributes, radius as f32)?,
        color: color(attributes)?,
        intensity: radiance(attributes, fallback)?.map(|radiance| radiance * share),
        casts_shadows: flag(attributes, "shadow:enable", true)?,
    }))
}

fn kind(item: &Item, attributes: &Attributes, radius: f32) -> Result<LightKind, Fault> {
    if item.kind == "DistantLight" {
        return Ok(LightKind::Distant { angle: radius });
    }
    let range = f32::INFINITY;
    let is_flat = ["DiskLight", "RectLight"].contains(&item.kind.as_str());
    let angle = input(attributes, "shaping:cone:angle", "a finite number", finite)?;
    let softness = number(attributes, "shaping:cone:softness", 0.0)?.min(1.0);
    match angle {
        Some(angle) if (0.0..90.0).contains(&angle) => {
            let outer = angle.to_radians();
            // A sharp edge needs some width still.
            let inner = (outer * (1.0 - softness)).min(outer * (1.0 - 1e-3));
            Ok(LightKind::Spot { radius, range, inner: inner as f32, outer: outer as f32 })
        }
        // They shine to one side, less and less towards their edges.
        _ if is_flat => Ok(LightKind::Spot { radius, range, inner: 0.0, outer: std::f32::consts::FRAC_PI_2 }),
        _ => Ok(LightKind::Point { radius, range }),
    }
}

fn dome(
    context: &Context,
    item: &Item,
    attributes: &Attributes,
    textures: &mut Textures,
) -> Result<Environment, Fault> {
    let asset = match attributes.asset("inputs:texture:file")? {
        None => attributes.asset("texture:file")?,
        asset => asset,
    };
    let image = asset.map(|asset| textures.image(&asset));
    let time = context.time;
    let radiance = radiance(attributes, 1.0)?.at(time) as f32;
    let is_visible = context.placed[item.node].is_visible;
    let color = color(attributes)?.map(|c| if is_visible { c * radiance } else { 0.0 });
    let (_, rotation, _) = context.placed[item.node].to_world.to_scale_rotation_translation();
    let rotation = if rotation.is_finite() { rotation.normalize() } else { DQuat::IDENTITY };
    let axis = attributes.get("poleAxis", "a token", convert::token)?;
    let is_z_pole = item.kind == "DomeLight_1"
        && match axis.as_deref() {
            None | Some("scene") => context.is_z_up,
            Some(axis) => axis == "Z",
        };
    let pole = if is_z_pole { super::xform::z_up().inverse() } else { DAffine3::IDENTITY };
    // The middle of USD's images lies along +z, ours along -z.
    let turn = DAffine3::from_quat(rotation) * pole * DAffine3::from_rotation_y(PI);
    Ok(Environment { image, color, to_world: turn, is_visible: true })
}
