//! Cameras and camera paths.
use std::collections::HashSet;

use glam::Vec3;

use super::Fault;
use super::text::{CameraText, PathText};
use crate::camera::DEFAULT_FOV_Y_DEGREES;
use crate::obj::quoted;
use crate::{Camera, CameraPath, Error, Key};

/// The cameras that a file lists, in a scene of the given diagonal.
pub fn cameras(texts: &[CameraText], diagonal: f64) -> Result<Vec<Camera>, Fault> {
    named(
        "cameras",
        texts,
        |text| &text.name,
        |text| {
            let [eye, target] = [text.eye, text.target].map(Vec3::from);
            match text.up {
                Some(up) => Camera::new(&text.name, eye, target, up.into(), text.fov, diagonal),
                None => Camera::upright(&text.name, eye, target, text.fov, diagonal),
            }
        },
    )
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
