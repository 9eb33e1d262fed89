//! An axis-aligned bounding box, in double so that neither its centre nor its diagonal overflows or loses digits.
use glam::{DVec3, Vec3};

/// The smallest axis-aligned box around a set of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box around `points`; none when there are none.
    pub fn of(points: impl IntoIterator<Item = [f32; 3]>) -> Option<Self> {
        points
            .into_iter()
            .map(|point| Vec3::from(point).as_dvec3())
            .map(|p| Self { min: p, max: p })
            .reduce(Self::union)
    }

    /// The box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle of the box.
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) / 2.0
    }

    /// Length of the box' diagonal.
    pub fn diagonal(&self) -> f64 {
        (self.max - self.min).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_holds_every_point_and_no_more() {
        let bounds = Bounds::of([[1.0, 5.0, -2.0], [3.0, -1.0, 0.0], [2.0, 0.0, 4.0]]).unwrap();
        assert_eq!((bounds.min, bounds.max), (DVec3::new(1.0, -1.0, -2.0), DVec3::new(3.0, 5.0, 4.0)));
        assert_eq!(bounds.center(), DVec3::new(2.0, 2.0, 1.0));
        assert_eq!(bounds.diagonal(), (4.0f64 + 36.0 + 36.0).sqrt());
    }

    #[test]
    fn no_points_have_no_box() {
        assert_eq!(Bounds::of([]), None);
    }

    #[test]
    fn diagonal_of_the_largest_floats_is_finite() {
        assert!(Bounds::of([[f32::MIN; 3], [f32::MAX; 3]]).unwrap().diagonal().is_finite());
    }
}
