//! Render lists: which patches are drawn, and the indirect draws that draw them.
//!
//! In static FAS they depend on the tables and the factors alone. A list is drawn in batches, of which the emit stage takes
//! out the patches that cannot be seen. They have at most [`MAX_BATCH`] patches; on a software driver, whose tessellation
//! costs the square of what one instance generates and a fixed price besides, they generate about [`BATCH_VERTICES`]
//! vertices. The shaders add the vertex and the instance index and do not know.

use std::ops::Range;

use planish_gpu::DrawArguments;
use planish_subdiv::tables::Tables;

use crate::density::FACTOR_COUNT;
use crate::options::{Spacing, SurfaceMethod};
use crate::tessellation::{filling_segment_count, segment_count};

/// The kinds of patches, in the order of their lists and draws; also the `kind` of a dump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatchKind {
    /// Regular patches.
    Regular,
    /// Regular patches beside a split face.
    Transition,
    /// Patch-filling quads.
    Filling,
}

impl PatchKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Regular, Self::Transition, Self::Filling];
}

/// The lists of all kinds, one after another: indices into the table of patches or of filling quads.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lists {
    /// All entries.
    pub entries: Vec<u32>,
    /// Each kind's part of the entries.
    pub ranges: [Range<u32>; 3],
}

impl Lists {
    /// Every patch of the tables.
    pub fn new(tables: &Tables) -> Self {
        let mut lists = Self::default();
        let bspline = |transition: bool| {
            (0..).zip(&tables.patches).filter(move |(_, p)| (p.info.transition != 0) == transition).map(|(i, _)| i)
        };
        lists.entries.extend(bspline(false));
        lists.ranges[0] = 0..lists.entries.len() as u32;
        lists.entries.extend(bspline(true));
        lists.ranges[1] = lists.ranges[0].end..lists.entries.len() as u32;
        lists.entries.extend(0..tables.filling.len() as u32);
        lists.ranges[2] = lists.ranges[1].end..lists.entries.len() as u32;
        lists
    }

    /// A kind's entries.
    pub fn of_kind(&self, kind: PatchKind) -> &[u32] {
        let range = &self.ranges[kind as usize];
        &self.entries[range.start as usize..range.end as usize]
    }

    /// The batches of all lists.
    pub fn batches(&self, tables: &Tables, shape: &DrawShape<'_>) -> Batches {
        let mut batches = Batches::default();
        for kind in PatchKind::ALL {
            let draws = &mut batches.draws;
            let first = draws.len() as u32;
            let entries = self.of_kind(kind);
            if shape.method == SurfaceMethod::Uniform {
                draws.push(draw_arguments(0, entries.len() as u32, shape.method, shape.is_software));
            } else {
                let vertex_counts = entries.iter().map(|&entry| shape.vertex_count(tables, kind, entry));
                push_batches(draws, vertex_counts, if shape.is_software { BATCH_VERTICES } else { u32::MAX });
            }
            batches.ranges[kind as usize] = first..draws.len() as u32;
        }
        batches
    }
}

/// The indirect draws of all lists, one after another. A draw's first vertex is its place in the kind's list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Batches {
    /// All draws.
    pub draws: Vec<DrawArguments>,
    /// Each kind's part of the draws.
    pub ranges: [Range<u32>; 3],
}

impl Batches {
    /// A kind's draws.
    pub fn of_kind(&self, kind: PatchKind) -> &[DrawArguments] {
        let range = &self.ranges[kind as usize];
        &self.draws[range.start as usize..range.end as usize]
    }
}

/// The most patches of a batch: a group of the emit stage remembers one bit for each.
pub const MAX_BATCH: u32 = 256;

/// Vertices that a draw should generate on a software driver: on Mesa 22.3's, larger batches cost more by their square,
/// smaller ones by their number (`planish bench --tess`).
const BATCH_VERTICES: u32 = 512;

/// What the shape of draws depends on.
#[derive(Clone, Copy, Debug)]
pub struct DrawShape<'a> {
    /// Surface method.
    pub method: SurfaceMethod,
    /// Spacing.
    pub spacing: Spacing,
    /// Tess factor of each level.
    pub factors: &'a [f32; FACTOR_COUNT],
    /// Whether the device is a software driver.
    pub is_software: bool,
}

impl DrawShape<'_> {
    /// About how many vertices a patch generates.
    fn vertex_count(&self, tables: &Tables, kind: PatchKind, entry: u32) -> u32 {
        let segments = match kind {
            PatchKind::Filling => filling_segment_count(self.method, self.spacing),
            PatchKind::Regular | PatchKind::Transition => {
                let level = usize::from(tables.patches[entry as usize].info.level);
                segment_count(self.factors[level], self.spacing)
            }
        };
        (segments + 1) * (segments + 1)
    }
}

/// One draw for each run of patches that together generate at most `max_vertices`, or of a single one that generates more.
fn push_batches(draws: &mut Vec<DrawArguments>, vertex_counts: impl Iterator<Item = u32>, max_vertices: u32) {
    let (mut vertices, mut batch) =
        (0, DrawArguments { vertex_count: 0, instance_count: 1, first_vertex: 0, first_instance: 0 });
    for count in vertex_counts {
        let is_full = vertices + count > max_vertices || batch.vertex_count == MAX_BATCH;
        if batch.vertex_count > 0 && is_full {
            draws.push(batch);
            batch = DrawArguments { vertex_count: 0, first_vertex: batch.first_vertex + batch.vertex_count, ..batch };
            vertices = 0;
        }
        batch.vertex_count += 1;
        vertices += count;
    }
    if batch.vertex_count > 0 {
        draws.push(batch);
    }
}

/// The draw of `count` entries of a list from `first` on.
pub fn draw_arguments(first: u32, count: u32, method: SurfaceMethod, is_software: bool) -> DrawArguments {
    let (scale, instances) = match method {
        SurfaceMethod::Uniform => (6, false),
        SurfaceMethod::Fas => (1, is_software),
    };
    DrawArguments {
        vertex_count: if instances { 1 } else { scale * count },
        instance_count: if instances { count } else { 1 },
        first_vertex: scale * first,
        first_instance: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_cover_every_patch_once_and_stay_small() {
        let mut draws = Vec::new();
        push_batches(&mut draws, (0..1000).map(|i| if i < 10 { 4225 } else { 25 }), BATCH_VERTICES);
        let mut next = 0;
        for draw in &draws {
            assert_eq!((draw.first_vertex, draw.instance_count), (next, 1));
            next += draw.vertex_count;
        }
        assert_eq!(next, 1000);
        assert!(draws[..10].iter().all(|draw| draw.vertex_count == 1));
        assert_eq!(draws[10].vertex_count, BATCH_VERTICES / 25);
    }

    #[test]
    fn without_a_bound_on_vertices_batches_are_as_large_as_they_may_be() {
        let mut draws = Vec::new();
        push_batches(&mut draws, (0..1000).map(|_| 4225), u32::MAX);
        assert_eq!(draws.iter().map(|draw| draw.vertex_count).collect::<Vec<_>>(), [256, 256, 256, 232]);
    }

    #[test]
    fn an_empty_list_has_no_batch() {
        let mut draws = Vec::new();
        push_batches(&mut draws, std::iter::empty(), BATCH_VERTICES);
        assert!(draws.is_empty());
    }
}
