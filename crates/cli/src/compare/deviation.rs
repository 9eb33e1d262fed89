//! How far one point lies from another, and what becomes of many such.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::soup::SurfacePoint;

/// Squared length of an interpolated normal below which it has no direction.
const MIN_NORMAL_SQUARED: f64 = 1e-12;

/// How far a point lies from the one that it is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    pub distance: f64,
    /// Between the normals, in radians; none where one of them is 0.
    pub angle: Option<f64>,
}

impl Deviation {
    pub fn between(a: &SurfacePoint, b: &SurfacePoint) -> Self {
        Self { distance: a.position.distance(b.position), angle: angle(a.normal, b.normal) }
    }
}

/// The arc tangent keeps its digits for small angles, which the arc cosine does not.
fn angle(a: DVec3, b: DVec3) -> Option<f64> {
    let is_direction = |normal: DVec3| normal.length_squared() > MIN_NORMAL_SQUARED;
    (is_direction(a) && is_direction(b)).then(|| a.cross(b).length().atan2(a.dot(b)))
}

/// Where on the base mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Place {
    pub face: i32,
    pub u: f64,
    pub v: f64,
}

impl Place {
    pub fn new(face: i32, uv: DVec2) -> Self {
        Self { face, u: uv.x, v: uv.y }
    }
}

/// What many values of one kind come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Moments {
    pub rms: f64,
    pub mean: f64,
    pub max: f64,
    /// Where the greatest is.
    pub at: Place,
}

impl Moments {
    /// The greater of each; as Metro makes one figure of two directions.
    fn greater(self, other: Self) -> Self {
        let at = if other.max > self.max { other.at } else { self.at };
        let (rms, mean, max) = (self.rms.max(other.rms), self.mean.max(other.mean), self.max.max(other.max));
        Self { rms, mean, max, at }
    }
}

/// What the deviations of a surface come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Distances, in the units of the dump.
    pub distance: Moments,
    /// Angles between normals, in radians.
    pub normal: Moments,
}

impl Summary {
    pub fn greater(self, other: Self) -> Self {
        Self { distance: self.distance.greater(other.distance), normal: self.normal.greater(other.normal) }
    }
}

/// Adds up deviations by weight.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    distance: Sums,
    normal: Sums,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    weight: f64,
    value: f64,
    square: f64,
    max: f64,
    at: Option<Place>,
}

impl Tally {
    pub fn add(&mut self, weight: f64, deviation: Deviation, place: Place) {
        self.distance.add(weight, deviation.distance, place);
        if let Some(angle) = deviation.angle {
            self.normal.add(weight, angle, place);
        }
    }

    pub fn summary(&self) -> Summary {
        Summary { distance: self.distance.moments(), normal: self.normal.moments() }
    }
}

impl Sums {
    fn add(&mut self, weight: f64, value: f64, place: Place) {
        self.weight += weight;
        self.value += weight * value;
        self.square += weight * value * value;
        if self.at.is_none() || value > self.max {
            (self.max, self.at) = (value, Some(place));
        }
    }

    fn moments(&self) -> Moments {
        let mean_of = |sum: f64| if self.weight > 0.0 { sum / self.weight } else { 0.0 };
        Moments {
            rms: mean_of(self.square).sqrt(),
            mean: mean_of(self.value),
            max: self.max,
            at: self.at.unwrap_or_default(),
        }
    }
}
