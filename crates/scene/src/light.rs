//! What lights a scene.
use glam::DAffine3;

use crate::curve::Curve;

/// A light. It shines from a node's origin along its -z, and moves with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The name in the file.
    pub name: String,
    /// Into [`crate::Scene::nodes`].
    pub node: usize,
    /// What it is.
    pub kind: LightKind,
    /// Linear colour.
    pub color: [f32; 3],
    /// Point and spot: radiant intensity, so a surface that faces it from distance d receives intensity / d^2. Distant: what a
    /// surface that faces it receives. A white Lambert surface that receives 1 has the radiance 1 / pi.
    pub intensity: Curve<f64>,
    /// Whether it casts shadows.
    pub casts_shadows: bool,
}

/// Kinds of lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light along -z; `angle` is the diameter that it has in the sky, in degrees.
    Distant {
        /// Degrees; 0: hard shadows.
        angle: f32,
    },
    /// In all directions; a sphere of this radius, in the world's unit, that shadows are as soft as.
    Point {
        /// World units; 0: hard shadows.
        radius: f32,
        /// It fades to nothing at this distance (KHR_lights_punctual); infinite for none.
        range: f32,
    },
    /// In a cone around -z.
    Spot {
        /// World units; 0: hard shadows.
        radius: f32,
        /// As of [`Self::Point`].
        range: f32,
        /// Half angle, radians, within which it is full.
        inner: f32,
        /// Half angle, radians, beyond which there is nothing.
        outer: f32,
    },
}

/// Light from all around: an image in latitude and longitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Into [`crate::Scene::images`]; none: the same from everywhere. Its middle row is the horizon; its middle column lies along
    /// -z of the environment's own space, its left quarter along -x, its upper edge along +y.
    pub image: Option<usize>,
    /// Multiplies the image: radiance.
    pub color: [f32; 3],
    /// The environment's own space to the world: a rotation.
    pub to_world: DAffine3,
    /// Whether the camera sees it behind the scene.
    pub is_visible: bool,
}

/// A light at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightPose {
    /// Light to world.
    pub to_world: DAffine3,
    /// Intensity times colour; 0 where its node is hidden.
    pub radiance: [f32; 3],
}
