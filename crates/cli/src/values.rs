//! What the values of flags mean.

use std::ops::RangeInclusive;

use glam::Vec3;

/// Most pixels in a row or a column.
const MAX_EXTENT: u32 = 16384;
/// Deepest level that can be asked for; [`planish_subdiv::refine::MAX_LEVEL`].
pub const MAX_LEVEL: u32 = planish_subdiv::refine::MAX_LEVEL;

/// `WxH`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let extent = |text: &str| text.parse().ok().filter(|pixels| (1..=MAX_EXTENT).contains(pixels));
    text.split_once('x')
        .and_then(|(width, height)| Some([extent(width)?, extent(height)?]))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT, each 1 to {MAX_EXTENT} pixels"))
}

/// `x,y,z`.
pub fn vector(text: &str) -> Result<Vec3, String> {
    let coordinates: Option<Vec<f32>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|c: &f32| c.is_finite())).collect();
    match coordinates.as_deref() {
        Some(&[x, y, z]) => Ok(Vec3::new(x, y, z)),
        _ => Err("expected three finite numbers x,y,z".to_owned()),
    }
}

/// A tess factor.
pub fn tess_factor(text: &str) -> Result<f32, String> {
    number(text, |factor| factor >= 1.0, "a number of at least 1")
}

/// A length in pixels.
pub fn edge_pixels(text: &str) -> Result<f32, String> {
    number(text, |pixels| pixels > 0.0, "a number above 0")
}

/// A field of view.
pub fn field_of_view(text: &str) -> Result<f32, String> {
    number(text, |degrees| degrees > 0.0 && degrees < 180.0, "more than 0 and less than 180 degrees")
}

/// A number.
pub fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| "expected a finite number".to_owned())
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    finite(text).ok().filter(|number| *number > 0.0).ok_or_else(|| "expected a number above 0".to_owned())
}

fn number(text: &str, is_good: impl Fn(f32) -> bool, expected: &str) -> Result<f32, String> {
    let good = |number: &f32| number.is_finite() && is_good(*number);
    text.parse().ok().filter(good).ok_or_else(|| format!("expected {expected}"))
}

/// An exposure in stops.
pub fn stops(text: &str) -> Result<f32, String> {
    let stops = text.parse().ok().filter(|stops: &f32| stops.abs() <= 64.0);
    stops.ok_or_else(|| "expected -64 to 64 stops".to_owned())
}

/// Width of a pixel filter.
pub fn filter_width(text: &str) -> Result<f64, String> {
    let width = text.parse().ok().filter(|width| (0.01..=32.0).contains(width));
    width.ok_or_else(|| "expected 0.01 to 32 pixels".to_owned())
}

/// When a shutter opens and closes, in frames: `OPEN,CLOSE`, or `CLOSE` of one that opens at 0.
pub fn shutter(text: &str) -> Result<[f64; 2], String> {
    let (open, close) = text.split_once(',').unwrap_or(("0", text));
    let frames = |text: &str| text.trim().parse().ok().filter(|frames: &f64| frames.abs() <= 1e6);
    match (frames(open), frames(close)) {
        (Some(open), Some(close)) if open <= close => Ok([open, close]),
        _ => Err("expected OPEN,CLOSE with OPEN <= CLOSE, or CLOSE >= 0, in frames".to_owned()),
    }
}

/// A part of an image: left, top, width and height, from `X,Y,WxH`.
pub fn crop(text: &str) -> Result<[u32; 4], String> {
    let parsed = || {
        let (left, rest) = text.split_once(',')?;
        let (top, rest) = rest.split_once(',')?;
        let [width, height] = size(rest).ok()?;
        Some([left.parse().ok()?, top.parse().ok()?, width, height])
    };
    parsed().ok_or_else(|| "expected X,Y,WxH in pixels, with W and H from 1 on".to_owned())
}

/// Levels `A-B`, or one level.
pub fn levels(text: &str) -> Result<RangeInclusive<u32>, String> {
    let level = |text: &str| text.parse().ok().filter(|level| *level <= MAX_LEVEL);
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    match (level(first), level(last)) {
        (Some(first), Some(last)) if first <= last => Ok(first..=last),
        _ => Err(format!("expected a level or levels A-B, 0 to {MAX_LEVEL}")),
    }
}

/// Frames a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameRate(f64);

impl FrameRate {
    /// The nearest that the interface allows.
    pub fn near(rate: f64) -> Self {
        Self(rate.clamp(0.001, 10_000.0))
    }

    /// A frame's time in seconds.
    pub fn time(self, frame: i32) -> f32 {
        self.seconds(f64::from(frame)) as f32
    }

    /// The time after so many frames, in seconds.
    pub fn seconds(self, frames: f64) -> f64 {
        frames / self.0
    }

    /// The frame nearest to a time in seconds.
    pub fn frame_at(self, seconds: f64) -> i32 {
        (seconds * self.0).round() as i32
    }

    /// As a fraction: whole rates, those of NTSC (a whole number times 1000 / 1001), or thousandths.
    pub fn as_fraction(self) -> (i32, u32) {
        /// Rates are written with two or three decimals.
        const TOLERANCE: f64 = 0.005;
        let (whole, ntsc) = (self.0.round(), (self.0 * 1.001).round());
        if (self.0 - whole).abs() < 1e-6 {
            (whole as i32, 1)
        } else if (self.0 - ntsc / 1.001).abs() < TOLERANCE {
            ((ntsc * 1000.0) as i32, 1001)
        } else {
            ((self.0 * 1000.0).round() as i32, 1000)
        }
    }
}

/// Frames a second, at most 10,000.
pub fn frame_rate(text: &str) -> Result<FrameRate, String> {
    let rate = text.parse().ok().filter(|rate| (0.001..=10_000.0).contains(rate));
    rate.map(FrameRate).ok_or_else(|| "expected 0.001 to 10000 frames a second".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_width_times_height() {
        assert_eq!(size("1280x720"), Ok([1280, 720]));
        assert_eq!(size("1x16384"), Ok([1, 16384]));
        for bad in ["", "1280", "1280x", "0x720", "1280x0", "16385x1", "1280X720", "-1x5", "1x2x3", "1.5x2"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn vectors_are_three_finite_numbers() {
        assert_eq!(vector("1,-2.5,3e2"), Ok(Vec3::new(1.0, -2.5, 300.0)));
        assert_eq!(vector("-1, 0, 1"), Ok(Vec3::new(-1.0, 0.0, 1.0)));
        for bad in ["", "1,2", "1,2,3,4", "1,2,x", "nan,0,0", "1,inf,0", "1e99,0,0", "1 2 3"] {
            assert!(vector(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        assert_eq!(tess_factor("13.7"), Ok(13.7));
        assert_eq!(edge_pixels("0.5"), Ok(0.5));
        assert_eq!(finite("-0.25"), Ok(-0.25));
        assert!(["nan", "inf", "-inf", "1e999", "x", ""].iter().all(|bad| finite(bad).is_err()));
        assert_eq!(positive("1e-9"), Ok(1e-9));
        assert!(["0", "-1", "nan", "inf", "x"].iter().all(|bad| positive(bad).is_err()));
        assert_eq!(field_of_view("179.5"), Ok(179.5));
        assert!(["0.99", "-1", "nan", "inf", "x"].iter().all(|bad| tess_factor(bad).is_err()));
        assert!(["0", "-4", "nan", "inf"].iter().all(|bad| edge_pixels(bad).is_err()));
        assert!(["0", "180", "nan"].iter().all(|bad| field_of_view(bad).is_err()));
    }

    #[test]
    fn shutters_and_crops_are_numbers_in_order() {
        assert_eq!((shutter("0.5"), shutter("-0.25,0.25")), (Ok([0.0, 0.5]), Ok([-0.25, 0.25])));
        assert!(["", "-0.5", "1,0", "a,b", "nan", "0,inf"].iter().all(|bad| shutter(bad).is_err()));
        assert_eq!(crop("3,4,50x60"), Ok([3, 4, 50, 60]));
        assert!(["", "1,2", "1,2,0x5", "-1,2,3x4", "1,2,3,4"].iter().all(|bad| crop(bad).is_err()));
        assert!(["0", "-1", "33", "x"].iter().all(|bad| filter_width(bad).is_err()));
    }

    #[test]
    fn levels_are_a_range_or_one() {
        assert_eq!(levels("0-5"), Ok(0..=5));
        assert_eq!(levels("15"), Ok(15..=15));
        assert!(["", "5-0", "0-16", "a", "1-", "-1"].iter().all(|bad| levels(bad).is_err()));
    }

    #[test]
    fn rates_become_the_fractions_that_they_round() {
        let fraction = |text: &str| frame_rate(text).unwrap().as_fraction();
        assert_eq!(fraction("24"), (24, 1));
        assert_eq!(fraction("23.976"), (24000, 1001));
        assert_eq!(fraction("29.97"), (30000, 1001));
        assert_eq!(fraction("12.5"), (12500, 1000));
        assert!(["0", "-24", "nan", "inf", "1e9", "x"].iter().all(|bad| frame_rate(bad).is_err()));
    }

    #[test]
    fn a_frame_s_time_is_its_number_over_the_rate() {
        assert_eq!(frame_rate("24").unwrap().time(12), 0.5);
    }
}
