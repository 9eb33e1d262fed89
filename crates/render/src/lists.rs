//! Render lists: which patches are drawn, and the indirect draws that draw them.
//!
//! In static FAS they depend on the tables alone. A list is one indirect draw whose shape depends on the device: hardware
//! gets `{ vertices: N, instances: 1 }`; a software driver, whose tessellation costs the square of what one instance
//! generates, `{ 1, N }`. The shaders add both indices and do not know.

use std::ops::Range;

use planish_gpu::DrawArguments;
use planish_subdiv::tables::Tables;

use crate::options::SurfaceMethod;

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

    /// The indirect draw of each list.
    pub fn draws(&self, method: SurfaceMethod, is_software: bool) -> [DrawArguments; 3] {
        self.ranges.clone().map(|range| draw_arguments(0, range.len() as u32, method, is_software))
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
