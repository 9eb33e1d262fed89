//! Cameras (UsdGeomCamera): apertures and the focal length are in tenths of the world's unit.
use openusd::sdf::Value;

use super::attributes::Attributes;
use super::convert;
use super::meshes::Context;
use super::walk::Item;
use crate::curve::{Curve, Interpolation};
use crate::gltf::fault::Fault;
use crate::obj::Warnings;
use crate::{Camera, CameraRig};

/// The schema's fallbacks.
const FOCAL_LENGTH: f64 = 50.0;
const HORIZONTAL_APERTURE: f64 = 20.955;
const VERTICAL_APERTURE: f64 = 15.2908;
/// Units of the lens in one of the world.
const TENTHS: f64 = 10.0;

/// The cameras of a stage, in its order. `time`: the scene's first moment; `diagonal`: of the scene's box then.
pub fn cameras(context: &Context, (time, diagonal): (f64, f64), warnings: &mut Warnings) -> Result<Vec<Camera>, Fault> {
    let mut cameras = Vec::new();
    for item in context.tree.items.iter().filter(|item| item.kind == "Camera") {
        let attributes = Attributes::new(&item.prim, context.rate);
        let projection = attributes.get("projection", "a token", convert::token)?;
        if projection.as_deref() == Some("orthographic") {
            warnings.push(None, format!("{}: orthographic: left out", attributes.path()));
            continue;
        }
        cameras.push(camera(context, item, &attributes, (time, diagonal))?);
    }
    Ok(cameras)
}

fn camera(
    context: &Context,
    item: &Item,
    attributes: &Attributes,
    (time, diagonal): (f64, f64),
) -> Result<Camera, Fault> {
    let number = |name: &str, fallback: f64| -> Result<Curve<f64>, Fault> {
        let curve = attributes.curve(name, ("a finite number", Interpolation::Linear), finite)?;
        Ok(curve.unwrap_or_else(|| Curve::constant(fallback)))
    };
    let focal = number("focalLength", FOCAL_LENGTH)?;
    let aperture = number("verticalAperture", VERTICAL_APERTURE)?;
    let horizontal = number("horizontalAperture", HORIZONTAL_APERTURE)?;
    let rig =
        CameraRig {
            node: item.node,
            fov_y_degrees: both(&aperture, &focal, |aperture, focal| {
                2.0 * (aperture / (2.0 * focal)).atan().to_degrees()
            }),
            focus_distance: number("focusDistance", 0.0)?,
            lens_radius: both(&focal, &number("fStop", 0.0)?, |focal, stop| {
                if stop > 0.0 { focal / TENTHS / (2.0 * stop) } else { 0.0 }
            }),
            shutter: shutter(attributes, context.rate)?,
        };
    let made = Camera::rigged(&attributes.path(), rig, &context.placed[item.node].to_world, time, diagonal);
    let mut camera =
        made.map_err(|error| Fault::new(attributes.path(), error.to_string(), "a camera that sees something"))?;
    // The window on the film is moved by the offset.
    let share = |offset: f64, aperture: f64| {
        let shift = offset / (aperture / 2.0);
        if shift.is_finite() { shift as f32 } else { 0.0 }
    };
    let [x, y] = ["horizontalApertureOffset", "verticalApertureOffset"].map(|name| number(name, 0.0));
    camera.shift = [share(x?.at(time), horizontal.at(time)), share(y?.at(time), aperture.at(time))];
    Ok(camera)
}

/// When the shutter opens and closes; none where the file does not say, or says that it opens for no time.
fn shutter(attributes: &Attributes, rate: f64) -> Result<Option<[f64; 2]>, Fault> {
    let [open, close] = ["shutter:open", "shutter:close"].map(|name| attributes.get(name, "a finite number", finite));
    let shutter = [open?.unwrap_or(0.0) / rate, close?.unwrap_or(0.0) / rate];
    Ok((shutter[0] < shutter[1]).then_some(shutter))
}

/// A value made of two, at the keys of both.
pub fn both(a: &Curve<f64>, b: &Curve<f64>, value: impl Fn(f64, f64) -> f64) -> Curve<f64> {
    let mut times: Vec<f64> = a.times().iter().chain(b.times()).copied().collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let at = |time: f64| value(a.at(time), b.at(time));
    let values = times.iter().map(|&time| at(time)).collect();
    Curve::keyed(times, values, Interpolation::Linear).unwrap_or_else(|_| Curve::constant(at(0.0)))
}

fn finite(value: Value) -> Option<f64> {
    convert::number(value).filter(|v| v.is_finite())
}
