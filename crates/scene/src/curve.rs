//! A value that changes over time.
use std::fmt;

use glam::{DAffine3, DQuat, DVec3};

/// What lies between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the key before.
    Step,
    /// A straight line; for rotations, the shortest arc at constant speed.
    #[default]
    Linear,
    /// A cubic Hermite spline: every key has three values, the tangent that arrives, the value, and the tangent that leaves
    /// (glTF 2.0, appendix C). Tangents are per second.
    Cubic,
}

/// A value that curves can hold.
pub trait Animated: Clone {
    /// `a` at 0, `b` at 1, a straight line between.
    fn mix(a: &Self, b: &Self, t: f64) -> Self;

    /// The sum of values times weights: what a spline needs. The result may have to be made legal ([`Self::legal`]).
    fn weighted(terms: &[(f64, &Self)]) -> Self;

    /// The nearest legal value: rotations are of unit length.
    fn legal(self) -> Self {
        self
    }
}

/// A value at every time: keys, and what lies between them. Before the first key and after the last it is constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<T> {
    /// Seconds, ascending; none of a constant.
    times: Vec<f64>,
    /// One a key, or three with [`Interpolation::Cubic`]; one of a constant.
    values: Vec<T>,
    interpolation: Interpolation,
}

/// Why keys are no curve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveFault {
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: &'static str,
}

impl fmt::Display for CurveFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "found {}, expected {}", self.found, self.expected)
    }
}

impl<T: Animated> Curve<T> {
    /// The same value at all times.
    pub fn constant(value: T) -> Self {
        Self { times: Vec::new(), values: vec![value], interpolation: Interpolation::Step }
    }

    /// A curve through keys, `times` in seconds.
    ///
    /// # Errors
    /// When there are no keys, times are not finite or do not ascend, or there is not one value a key (three for
    /// [`Interpolation::Cubic`]).
    pub fn keyed(times: Vec<f64>, values: Vec<T>, interpolation: Interpolation) -> Result<Self, CurveFault> {
        let refuse = |found, expected| Err(CurveFault { found, expected });
        if times.is_empty() {
            return refuse("no keys".to_owned(), "1 or more");
        }
        if let Some(key) = times.iter().position(|time| !time.is_finite()) {
            return refuse(format!("the time {} of key {key}", times[key]), "a finite number");
        }
        if let Some(key) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            return refuse(format!("the time {} after {}", times[key + 1], times[key]), "times that ascend");
        }
        let per_key = if interpolation == Interpolation::Cubic { 3 } else { 1 };
        if Some(values.len()) != times.len().checked_mul(per_key) {
            let expected = if per_key == 3 { "three values a key" } else { "one value a key" };
            return refuse(format!("{} values for {} keys", values.len(), times.len()), expected);
        }
        Ok(Self { times, values, interpolation })
    }

    /// The value at a time in seconds.
    pub fn at(&self, time: f64) -> T {
        let after = self.times.partition_point(|&key| key <= time);
        if after == 0 || self.times.is_empty() {
            return self.value(0).clone();
        }
        if after == self.times.len() {
            return self.value(after - 1).clone();
        }
        let key = after - 1;
        let span = self.times[after] - self.times[key];
        let t = (time - self.times[key]) / span;
        if t == 0.0 {
            return self.value(key).clone();
        }
        match self.interpolation {
            Interpolation::Step => self.value(key).clone(),
            Interpolation::Linear => T::mix(self.value(key), self.value(after), t),
            Interpolation::Cubic => {
                let (squared, cubed) = (t * t, t * t * t);
                T::weighted(&[
                    (2.0 * cubed - 3.0 * squared + 1.0, &self.values[3 * key + 1]),
                    (span * (cubed - 2.0 * squared + t), &self.values[3 * key + 2]),
                    (3.0 * squared - 2.0 * cubed, &self.values[3 * after + 1]),
                    (span * (cubed - squared), &self.values[3 * after]),
                ])
                .legal()
            }
        }
    }

    /// Whether it is the same at all times, because it has one key or none.
    pub fn is_constant(&self) -> bool {
        self.times.len() < 2
    }

    /// Times of the keys in seconds, ascending; none of a constant.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The same curve of other values.
    pub fn map<U: Animated>(&self, f: impl FnMut(&T) -> U) -> Curve<U> {
        Curve {
            times: self.times.clone(),
            values: self.values.iter().map(f).collect(),
            interpolation: self.interpolation,
        }
    }

    /// The values as they are kept: one a key, or three with [`Interpolation::Cubic`].
    pub fn values(&self) -> &[T] {
        &self.values
    }

    fn value(&self, key: usize) -> &T {
        let has_tangents = self.interpolation == Interpolation::Cubic && !self.times.is_empty();
        if has_tangents { &self.values[3 * key + 1] } else { &self.values[key] }
    }
}

impl Animated for f64 {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        a + t * (b - a)
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        terms.iter().map(|&(weight, value)| weight * value).sum()
    }
}

impl Animated for DVec3 {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        *a + t * (*b - *a)
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        terms.iter().map(|&(weight, &value)| weight * value).sum()
    }
}

impl Animated for DQuat {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        // glam takes the shorter of the two arcs.
        a.slerp(*b, t)
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        terms.iter().fold(Self::from_xyzw(0.0, 0.0, 0.0, 0.0), |sum, &(weight, &value)| sum + value * weight)
    }

    fn legal(self) -> Self {
        if self.length_squared() > 0.0 { self.normalize() } else { Self::IDENTITY }
    }
}

impl Animated for DAffine3 {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        Self::weighted(&[(1.0 - t, a), (t, b)])
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        let zero = Self { matrix3: glam::DMat3::ZERO, translation: DVec3::ZERO };
        terms.iter().fold(zero, |sum, &(weight, value)| Self {
            matrix3: sum.matrix3 + value.matrix3 * weight,
            translation: sum.translation + weight * value.translation,
        })
    }
}

impl Animated for bool {
    fn mix(a: &Self, _: &Self, _: f64) -> Self {
        *a
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        terms.iter().any(|&(weight, &value)| value && weight >= 0.5)
    }
}

/// Values that are interpolated one by one. Where two keys have different numbers of them, the first key's count stays and
/// nothing is interpolated.
impl Animated for Vec<f64> {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        if a.len() != b.len() {
            return a.clone();
        }
        a.iter().zip(b).map(|(a, b)| f64::mix(a, b, t)).collect()
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        let count = terms.iter().map(|(_, values)| values.len()).min().unwrap_or_default();
        (0..count).map(|i| terms.iter().map(|(weight, values)| weight * values[i]).sum()).collect()
    }
}

/// Points that are interpolated one by one, in double; as for [`Vec<f64>`] where counts differ.
impl Animated for Vec<[f32; 3]> {
    fn mix(a: &Self, b: &Self, t: f64) -> Self {
        if a.len() != b.len() {
            return a.clone();
        }
        let mix = |(a, b): (&[f32; 3], &[f32; 3])| {
            std::array::from_fn(|c| f64::mix(&f64::from(a[c]), &f64::from(b[c]), t) as f32)
        };
        a.iter().zip(b).map(mix).collect()
    }

    fn weighted(terms: &[(f64, &Self)]) -> Self {
        let count = terms.iter().map(|(_, points)| points.len()).min().unwrap_or_default();
        let sum =
            |i: usize, c: usize| terms.iter().map(|(weight, points)| weight * f64::from(points[i][c])).sum::<f64>();
        (0..count).map(|i| std::array::from_fn(|c| sum(i, c) as f32)).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_curve_is_constant_outside_of_its_keys() {
        let curve = Curve::keyed(vec![1.0, 2.0], vec![3.0, 5.0], Interpolation::Linear).unwrap();
        assert_eq!([0.0, 1.0, 1.5, 2.0, 9.0].map(|time| curve.at(time)), [3.0, 3.0, 4.0, 5.0, 5.0]);
        assert_eq!(Curve::constant(7.0).at(1e9), 7.0);
    }

    #[test]
    fn steps_hold_until_the_next_key() {
        let curve = Curve::keyed(vec![0.0, 1.0], vec![3.0, 5.0], Interpolation::Step).unwrap();
        assert_eq!([0.0, 0.999, 1.0].map(|time| curve.at(time)), [3.0, 3.0, 5.0]);
    }

    #[test]
    fn a_cubic_curve_reproduces_a_cubic() {
        // x(t) = t^3 - 2 t^2 + 3 with its derivative 3 t^2 - 4 t at keys 0, 2 and 3.
        let x = |t: f64| t * t * t - 2.0 * t * t + 3.0;
        let slope = |t: f64| 3.0 * t * t - 4.0 * t;
        let values = [0.0, 2.0, 3.0].iter().flat_map(|&t| [slope(t), x(t), slope(t)]).collect();
        let curve = Curve::keyed(vec![0.0, 2.0, 3.0], values, Interpolation::Cubic).unwrap();
        for i in 0..=30 {
            let t = f64::from(i) * 0.1;
            assert!((curve.at(t) - x(t)).abs() < 1e-12, "{t}");
        }
        assert_eq!((curve.at(-1.0), curve.at(4.0)), (x(0.0), x(3.0)));
    }

    #[test]
    fn rotations_take_the_shorter_arc_and_stay_of_unit_length() {
        let quarter = DQuat::from_rotation_z(FRAC_PI_2);
        let curve = Curve::keyed(vec![0.0, 1.0], vec![DQuat::IDENTITY, -quarter], Interpolation::Linear).unwrap();
        let half = curve.at(0.5).mul_vec3(DVec3::X);
        assert!((half - DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0)).length() < 1e-12, "{half}");
        let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let values = vec![zero, DQuat::IDENTITY, zero, zero, quarter, zero];
        let spline = Curve::keyed(vec![0.0, 1.0], values, Interpolation::Cubic).unwrap();
        assert!((spline.at(0.3).length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn keys_that_are_no_curve_are_refused() {
        let keyed = |times: &[f64], count: usize, interpolation| {
            Curve::keyed(times.to_vec(), vec![0.0; count], interpolation).unwrap_err().to_string()
        };
        assert_eq!(keyed(&[], 0, Interpolation::Step), "found no keys, expected 1 or more");
        assert_eq!(keyed(&[0.0, 0.0], 2, Interpolation::Step), "found the time 0 after 0, expected times that ascend");
        assert_eq!(keyed(&[f64::NAN], 1, Interpolation::Step), "found the time NaN of key 0, expected a finite number");
        assert_eq!(keyed(&[0.0], 1, Interpolation::Cubic), "found 1 values for 1 keys, expected three values a key");
    }
}
