//! How far a run of frames is.

use std::fmt::Write;
use std::time::{Duration, Instant};

use crate::console::Console;

/// Characters of the bar.
const BAR_WIDTH: u64 = 24;

/// Tells on a terminal how far a run is: frames, time left, patches.
pub struct Progress<'a> {
    console: &'a Console,
    start: Instant,
    frame_count: u64,
    /// Frames done, and how many of them were made and not just there.
    done: u64,
    made: u64,
    /// Patches of the last frame.
    pub patches: u64,
}

impl<'a> Progress<'a> {
    /// At the beginning of so many frames.
    pub fn new(console: &'a Console, frame_count: u64) -> Self {
        Self { console, start: Instant::now(), frame_count, done: 0, made: 0, patches: 0 }
    }

    /// Within a frame: after so many of its samples.
    pub fn show(&self, frame: i32, sample: u32, sample_count: u32) {
        let share = f64::from(sample) / f64::from(sample_count.max(1));
        let text = text(self.start.elapsed(), self.frame_count, self.done, self.made, share, self.patches);
        let samples = if sample_count > 1 { format!(", sample {sample} of {sample_count}") } else { String::new() };
        self.console.progress(format_args!("{text}, frame {frame}{samples}"));
    }

    /// After a frame.
    pub fn frame_done(&mut self, was_made: bool) {
        self.done += 1;
        self.made += u64::from(was_made);
    }
}

/// A bar, how many frames are done, and how long the others will take: as long as those that were made, which `share` of the
/// one at work is added to.
fn text(elapsed: Duration, frame_count: u64, done: u64, made: u64, share: f64, patches: u64) -> String {
    let filled = (BAR_WIDTH * done).checked_div(frame_count).unwrap_or_default() as usize;
    let mut text = format!("[{}{}] ", "#".repeat(filled), "-".repeat(BAR_WIDTH as usize - filled));
    let worked = made as f64 + share;
    let _ = write!(text, "{done} of {frame_count} frames");
    if worked > 0.0 {
        let left = elapsed.as_secs_f64() / worked * ((frame_count - done) as f64 - share);
        let seconds = left.round() as u64;
        let _ = write!(text, ", {}:{:02} left", seconds / 60, seconds % 60);
    }
    if patches > 0 {
        let _ = write!(text, ", {patches} patches");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_were_there_do_not_make_the_others_seem_fast() {
        // Four of twelve are done, two of which were made in 60 seconds: eight more take 240.
        let told = text(Duration::from_secs(60), 12, 4, 2, 0.0, 3812);
        assert_eq!(told, "[########----------------] 4 of 12 frames, 4:00 left, 3812 patches");
        assert_eq!(text(Duration::ZERO, 3, 0, 0, 0.0, 0), "[------------------------] 0 of 3 frames");
        // Half of the first of two frames after ten seconds: thirty are left.
        let told = text(Duration::from_secs(10), 2, 0, 0, 0.5, 0);
        assert_eq!(told, "[------------------------] 0 of 2 frames, 0:30 left");
    }
}
