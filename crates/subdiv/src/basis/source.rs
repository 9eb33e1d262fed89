//! Where the tables of configurations come from: what was made before, else the rules.

use crate::basis::cache::{
    BasisCache, BasisCounts, Kind, Rulebook, grid_content, read_grid, read_vertex, vertex_content,
};
use crate::basis::grid::{Extent, GridTable, grid_table};
use crate::basis::limit::LimitMasks;
use crate::basis::walk::Walk;
use crate::scheme::Rules;

/// Tables of one scheme and level.
pub(crate) struct TableSource<'a> {
    rules: &'a dyn Rules,
    rulebook: Rulebook,
    level: u32,
    cache: &'a dyn BasisCache,
    masks: LimitMasks,
    counts: BasisCounts,
}

impl<'a> TableSource<'a> {
    /// `rules` are those that the rulebook names.
    pub fn new(rules: &'a dyn Rules, rulebook: Rulebook, level: u32, cache: &'a dyn BasisCache) -> Self {
        Self { rules, rulebook, level, cache, masks: LimitMasks::default(), counts: BasisCounts::default() }
    }

    /// How many were asked for so far.
    pub fn counts(&self) -> BasisCounts {
        self.counts
    }

    /// The table of the first face of a piece, or of its first edge.
    pub fn grid(&mut self, walk: &Walk, extent: Extent) -> GridTable {
        let kind = Kind::Grid { extent, level: self.level };
        let row_count = row_count(self.rules, walk.word[0], extent, self.level);
        let read = |content: &[u8]| read_grid(content, walk, row_count?);
        self.table(kind, walk, read, grid_content, |source| {
            grid_table(source.rules, walk, source.rulebook.creasing, extent, source.level, &mut source.masks)
        })
    }

    /// Weights of the limit of a piece's first vertex, and of two tangents there, over all points of the piece.
    pub fn limit(&mut self, walk: &Walk) -> Vec<[f32; 3]> {
        let read = |content: &[u8]| read_vertex(content, walk);
        let content = |weights: &Vec<_>| vertex_content(weights);
        self.table(Kind::Vertex, walk, read, content, |source| {
            let mask = source.masks.of(source.rules, walk, source.rulebook.creasing);
            let weights = (0..walk.vertices.len())
                .map(|i| [mask.position[i], mask.tangents[0][i], mask.tangents[1][i]].map(|weight| weight as f32));
            weights.collect()
        })
    }

    fn table<T>(
        &mut self,
        kind: Kind,
        walk: &Walk,
        read: impl FnOnce(&[u8]) -> Option<T>,
        content: impl FnOnce(&T) -> Vec<u8>,
        build: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let key = self.rulebook.key(kind, &walk.word);
        if let Some(table) = self.cache.load(&key).and_then(|content| read(&content)) {
            self.counts.read += 1;
            return table;
        }
        let table = build(self);
        self.counts.built += 1;
        self.cache.store(&key, &content(&table));
        table
    }
}

/// Rows of the grid of a face of so many sides, or of its first edge; of faces that have no grid not known.
fn row_count(rules: &dyn Rules, sides: u32, extent: Extent, level: u32) -> Option<usize> {
    let points = (1 << level) + 1;
    match (extent, sides) {
        (Extent::Edge, _) => Some(points),
        (Extent::Face, 3) if rules.splits_in_triangles(sides) => Some(points * (points + 1) / 2),
        (Extent::Face, 4) => Some(points * points),
        _ => None,
    }
}
