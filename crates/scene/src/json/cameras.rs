//! Cameras and camera paths.
use std::collections::HashSet;

use glam::Vec3;

use super::Fault;
use super::text::{CameraText, LensText, PathText};
use crate::camera::DEFAULT_FOV_Y_DEGREES;
use crate::obj::quoted;
use crate::{Camera, CameraPath, Error, Key, Lens};

/// The cameras that a file lists, in a scene of the given diagonal.
pub fn cameras(texts: &[CameraText], diagonal: f64) -> Result<Vec<Camera>, Fault> {
    named(
        "cameras",
        texts,
        |text| &text.name,
        |text| {
            let [eye, target] = [text.eye, text.target].map(Vec3::from);
            let camera = match text.up {
                Some(up) => Camera::new(&text.name, eye, target, up.into(), text.fov, diagonal),
                None => Camera::upright(&text.name, eye, target, text.fov, diagonal),
            };
            Ok(Camera { lens: text.lens.as_ref().map(lens).transpose()?, ..camera? })
        },
    )
}

fn lens(text: &LensText) -> Result<Lens, Error> {
    if !(text.radius >= 0.0 && text.radius.is_finite() && text.focus > 0.0 && text.focus.is_finite()) {
        let found = format!("a lens of radius {} focused at {}", text.radius, text.focus);
        return Err(Error::Camera { found, expected: "a radius of 0 or more and a distance above 0" });
    }
    Ok(Lens { radius: text.radius, focus_distance: text.focus })
}

/// The camera paths that a file lists, in a scene of the given diagonal.
pub fn paths(texts: &[PathText], diagonal: f64) -> Result<Vec<CameraPath>, Fault> {
    named(
        "paths",
        texts,
        |text| &text.name,
        |text| {
            let keys = text.keys.iter().map(|key| Key { eye: key.eye.into(), target: key.target.into() }).collect();
            CameraPath::new(&text.name, text.fov.unwrap_or(DEFAULT_FOV_Y_DEGREES), text.frames, keys, diagonal)
        },
    )
}

/// Makes each element of a list whose names must differ.
fn named<T, R>(
    list: &str,
    texts: &[T],
    name: impl Fn(&T) -> &str,
    make: impl Fn(&T) -> Result<R, Error>,
) -> Result<Vec<R>, Fault> {
    let mut names = HashSet::new();
    let made = texts.iter().enumerate().map(|(index, text)| {
        if !names.insert(name(text)) {
            let found = format!("{} again", quoted(name(text).as_bytes()));
            return Err(Fault::new("name", found, "different names").within(list, index));
        }
        make(text).map_err(|error| {
            let (found, expected) = match error {
                Error::Camera { found, expected } => (found, expected.to_owned()),
                other => (other.to_string(), "a camera".to_owned()),
            };
            Fault::new("", found, expected).within(list, index)
        })
    });
    made.collect()
}
