//! Frame ranges, and the names of their files.

use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Frames `first`, `first + step` .. up to `last`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    first: i32,
    last: i32,
    step: u32,
}

impl FrameRange {
    /// A single frame.
    pub fn single(frame: i32) -> Self {
        Self { first: frame, last: frame, step: 1 }
    }

    /// Number of frames, at least 1.
    pub fn count(self) -> u64 {
        (i64::from(self.last) - i64::from(self.first)) as u64 / u64::from(self.step) + 1
    }

    /// The frames, in ascending order.
    pub fn frames(self) -> impl Iterator<Item = i32> {
        (i64::from(self.first)..=i64::from(self.last)).step_by(self.step as usize).map(|frame| frame as i32)
    }
}

impl FromStr for FrameRange {
    type Err = String;

    /// `A`, `A-B`, `A-BxS`, `A:B` or `A:BxS`; negative frames read best with a colon.
    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected a frame A, or a range A-B, A-BxS, A:B or A:BxS with A <= B and S >= 1".to_owned();
        let frame = |text: &str| text.parse::<i32>().map_err(|_| expected());
        if let Ok(only) = text.parse() {
            return Ok(Self::single(only));
        }
        let (range, step) = match text.split_once('x') {
            Some((range, step)) => (range, step.parse().map_err(|_| expected())?),
            None => (text, 1),
        };
        let colon = range.find(':');
        // A sign is no separator: the first byte is skipped.
        let dash = range.bytes().skip(1).position(|byte| byte == b'-').map(|at| at + 1);
        let at = colon.or(dash).ok_or_else(expected)?;
        let (first, last) = (frame(&range[..at])?, frame(&range[at + 1..])?);
        if first > last || step == 0 {
            return Err(expected());
        }
        Ok(Self { first, last, step })
    }
}

/// The shortest run of `#` that stands for the frame's number.
const LEAST_PLACEHOLDER: usize = 2;

/// Where in a file's name the frame's number goes: the last run of `#`.
fn placeholder(path: &Path) -> Option<(&str, usize, &str)> {
    let name = path.file_name()?.to_str()?;
    let end = name.rfind('#')? + 1;
    let before = name[..end].trim_end_matches('#');
    let width = end - before.len();
    (width >= LEAST_PLACEHOLDER).then_some((before, width, &name[end..]))
}

/// Whether the file's name has a place for the frame's number.
pub fn has_placeholder(path: &Path) -> bool {
    placeholder(path).is_some()
}

/// The path with the last run of `#` in its file name replaced by the frame's number, padded with zeros to the run's
/// length; as it is without such a run.
pub fn frame_path(path: &Path, frame: i32) -> PathBuf {
    match placeholder(path) {
        Some((before, width, after)) => path.with_file_name(format!("{before}{frame:0width$}{after}")),
        None => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<i32> {
        text.parse::<FrameRange>().unwrap().frames().collect()
    }

    #[test]
    fn ranges_are_inclusive_and_may_step() {
        assert_eq!(frames("7"), [7]);
        assert_eq!(frames("-7"), [-7]);
        assert_eq!(frames("1-4"), [1, 2, 3, 4]);
        assert_eq!(frames("1-6x2"), [1, 3, 5]);
        assert_eq!(frames("-2:1"), [-2, -1, 0, 1]);
        assert_eq!(frames("-2-1"), [-2, -1, 0, 1]);
        assert_eq!(frames("-4:-1x3"), [-4, -1]);
        assert_eq!(frames("5-5"), [5]);
    }

    #[test]
    fn the_count_is_that_of_the_frames() {
        for text in ["7", "1-4", "1-6x2", "-4:-1x3", "0:9x10"] {
            assert_eq!(text.parse::<FrameRange>().unwrap().count(), frames(text).len() as u64);
        }
        assert_eq!("-2147483648:2147483647".parse::<FrameRange>().unwrap().count(), 1 << 32);
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for text in ["", "a", "1-", "-", ":", "4-1", "1-4x0", "1-4x", "1-4x-1", "1.5", "1:2:3", "99999999999"] {
            assert!(text.parse::<FrameRange>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_run_of_hashes_becomes_the_padded_number() {
        let named = |path: &str, frame| frame_path(Path::new(path), frame).to_str().unwrap().to_owned();
        assert_eq!(named("out/a.####.exr", 7), "out/a.0007.exr");
        assert_eq!(named("a##.png", 123), "a123.png");
        assert_eq!(named("####.exr", -7), "-007.exr");
        assert_eq!(named("####/a##b##.exr", 1), "####/a##b01.exr");
        assert_eq!(named("take#2.exr", 1), "take#2.exr");
    }

    #[test]
    fn only_the_file_name_has_a_placeholder() {
        assert!(has_placeholder(Path::new("a/b.####.exr")));
        assert!(!has_placeholder(Path::new("####/b.exr")));
        assert!(!has_placeholder(Path::new("b#.exr")));
    }
}
