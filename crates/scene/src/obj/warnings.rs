//! A bounded list of warnings: a file of a million oddities is worth a hundred lines.
use crate::Warning;

/// Warnings that are kept; the rest is counted.
const KEPT: usize = 100;

#[derive(Default)]
pub struct Warnings {
    kept: Vec<Warning>,
    dropped_count: usize,
}

impl Warnings {
    pub fn push(&mut self, line: Option<u32>, text: impl Into<String>) {
        if self.kept.len() < KEPT {
            self.kept.push(Warning { line, text: text.into() });
        } else {
            self.dropped_count += 1;
        }
    }

    /// The kept warnings, and one that counts the others.
    pub fn into_vec(mut self) -> Vec<Warning> {
        if self.dropped_count > 0 {
            let text = format!("{} further warnings are not shown", self.dropped_count);
            self.kept.push(Warning { line: None, text });
        }
        self.kept
    }
}
