//! Marks of points and limit points in use: a bit each, phase by phase, every phase from a group of words of its own on.

use planish_shaders::MarkGroup;
use planish_subdiv::tables::Tables;

use crate::lists::{CHUNK, Phases};

/// Bits that a group of the compact stage goes over.
const GROUP_BITS: u32 = 32 * CHUNK;

/// Where the marks of rows and limit points lie.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Marks {
    /// What each group of the compact stage goes over.
    pub groups: Vec<MarkGroup>,
    /// The mark of limit point 0.
    pub first_limit: u32,
    /// Number of words.
    pub word_count: u32,
    /// First row, end of rows and first mark of each phase of rows, by first row.
    spans: Vec<[u32; 3]>,
}

impl Marks {
    pub fn new(phases: &Phases) -> Self {
        let mut marks = Self::default();
        for (phase, (&[first, count], first_item)) in (0..).zip(phases.rows.iter().zip(phases.first_items())) {
            let first_mark = marks.groups.len() as u32 * GROUP_BITS;
            if phase as usize == phases.limits() {
                marks.first_limit = first_mark;
            } else {
                marks.spans.push([first, first + count, first_mark]);
            }
            for group in 0..count.div_ceil(GROUP_BITS) {
                marks.groups.push(MarkGroup {
                    phase,
                    first: first + group * GROUP_BITS,
                    end: first + count,
                    first_item,
                });
            }
        }
        marks.spans.sort_unstable();
        marks.word_count = marks.groups.len() as u32 * CHUNK;
        marks
    }

    /// The mark of a row.
    pub fn of_row(&self, row: u32) -> u32 {
        let place = self.spans.partition_point(|span| span[0] <= row);
        // Empty phases begin where others do; of those that begin before the row, one holds it.
        let span = self.spans[..place].iter().rev().find(|span| row < span[1]);
        let [first, _, first_mark] = span.copied().unwrap_or_default();
        first_mark + (row - first)
    }

    /// The marks of the points of all stars.
    pub fn of_stars(&self, tables: &Tables) -> Vec<u32> {
        tables.stars.indices.iter().map(|&point| self.of_row(point - tables.cage_point_count)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_and_limit_point_has_a_mark_of_its_own() {
        // A level whose faces' points, the last rows, are made first; an empty one; and limit points.
        let phases =
            Phases { rows: vec![[3000, 10], [0, 3000], [3010, 0], [3010, 5], [0, 2500]], of_level: Vec::new() };
        let marks = Marks::new(&phases);
        let mut all: Vec<u32> = (0..3015).map(|row| marks.of_row(row)).collect();
        all.extend((0..2500).map(|limit| marks.first_limit + limit));
        for &mark in &all {
            let group = &marks.groups[(mark / GROUP_BITS) as usize];
            assert!(group.first + mark % GROUP_BITS < group.end);
        }
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 3015 + 2500);
        assert!(all.iter().all(|&mark| mark < 32 * marks.word_count));
    }
}
