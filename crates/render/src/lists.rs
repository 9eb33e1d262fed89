//! Lists that the kernels append to, and how much fits.
//!
//! Lists have room for the worst case where that is small; else for a part of it. What does not fit is counted and not
//! written, and [`Capacities::grown`] makes room for it before the next frame.

use planish_gpu::DrawArguments;
use planish_shaders::{DrawHead, FrameCounts, ListHead};
use planish_subdiv::selection::PatchCounts;
use planish_subdiv::tables::{MeshRanges, Tables};

use crate::objects::ObjectDesc;
use crate::options::{EndCap, SurfaceMethod};

/// The kinds of patches, in the order of their lists and draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatchKind {
    /// Regular patches.
    Regular,
    /// Regular patches beside a refined face.
    Transition,
    /// Patch-filling quads.
    Filling,
    /// Pieces of regular and transition patches that need more segments than the tessellator makes.
    Cut,
    /// Gregory patches of 20 points; or ACC or Pm-patches.
    Gregory,
    /// Pieces of them.
    GregoryCut,
    /// Thirds of Gregory triangles of 15 points.
    Triangle,
    /// Pieces of those.
    TriangleCut,
    /// Faces whose points are rows of a table.
    Table,
}

/// Number of kinds: `DRAW_COUNT` of the shaders.
pub const KIND_COUNT: usize = 9;

impl PatchKind {
    /// All kinds.
    pub const ALL: [Self; KIND_COUNT] = [
        Self::Regular,
        Self::Transition,
        Self::Filling,
        Self::Cut,
        Self::Gregory,
        Self::GregoryCut,
        Self::Triangle,
        Self::TriangleCut,
        Self::Table,
    ];

    /// Whether it is a piece of a patch.
    pub fn is_cut(self) -> bool {
        matches!(self, Self::Cut | Self::GregoryCut | Self::TriangleCut)
    }

    /// The kinds that a method draws, with these end caps.
    pub fn of_method(method: SurfaceMethod, end_cap: EndCap) -> &'static [Self] {
        match method {
            SurfaceMethod::Dfas | SurfaceMethod::Fas if end_cap == EndCap::Gregory => {
                &Self::ALL[..=Self::TriangleCut as usize]
            }
            SurfaceMethod::Dfas | SurfaceMethod::Fas => &Self::ALL[..=Self::Cut as usize],
            SurfaceMethod::Gregory => {
                &[Self::Regular, Self::Cut, Self::Gregory, Self::GregoryCut, Self::Triangle, Self::TriangleCut]
            }
            SurfaceMethod::Acc | SurfaceMethod::Pm => &[Self::Regular, Self::Cut, Self::Gregory, Self::GregoryCut],
            SurfaceMethod::Uniform => &[Self::Filling],
            SurfaceMethod::Table | SurfaceMethod::Flat | SurfaceMethod::Phong | SurfaceMethod::Pn => &[Self::Table],
        }
    }
}

/// Levels that a patch can have; `LEVEL_COUNT` of the shaders.
pub const LEVEL_COUNT: usize = 16;
/// Numbers of lists: `LIST_..` of `glsl/shared/scene.glsl`.
pub const LIST_VERTICES: usize = 0;
/// Chunks of slots that are faces of other than four sides.
pub const LIST_MIDDLES: usize = 1;
/// Chunks of irregular faces of level 0.
pub const LIST_ROOTS: usize = 2;
/// Chunks of regular patches of level 0.
pub const LIST_BASE: usize = 3;
/// Regular patches of finer levels.
pub const LIST_PATCHES: usize = 4;
/// Irregular leaves.
pub const LIST_LEAVES: usize = 5;
/// Patches that are cut.
pub const LIST_CUT: usize = 6;
/// Gregory patches that are cut.
pub const LIST_CUT_GREGORY: usize = 7;
/// Irregular faces of a level to select from; + level.
pub const LIST_ACTIVE: usize = 8;
/// Rows in use; + phase. The last phase is that of limit points.
pub const LIST_PHASES: usize = LIST_ACTIVE + LEVEL_COUNT;
const MAX_PHASES: usize = 2 * LEVEL_COUNT + 1;
/// Number of lists.
pub const LIST_COUNT: usize = LIST_PHASES + MAX_PHASES;
/// Entries of a chunk, and threads of a group.
pub const CHUNK: u32 = 64;

/// Entries that a list has room for at first, if it may have more.
const FIRST_CAPACITY: u32 = 1 << 16;

/// How much fits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Capacities {
    /// Chunks of each kind: the worst case.
    pub chunks: [u32; 4],
    /// Active faces of each level.
    pub active: [u32; LEVEL_COUNT],
    /// Patches of finer levels, leaves, patches that are cut, and Gregory patches that are.
    pub items: [u32; 4],
    /// Patches to draw of each kind.
    pub entries: [u32; KIND_COUNT],
    /// Draws of each kind: on a software driver there may be one an entry.
    pub draws: [u32; KIND_COUNT],
    /// What they can hold at most; none if this is it. Pieces of cut patches have no bound.
    worst: Option<Box<Capacities>>,
}

impl Capacities {
    /// For these objects; `largest` is the most entries that a list begins with.
    pub fn new(objects: &[ObjectDesc], meshes: &[MeshRanges], is_software: bool, largest: Option<u32>) -> Self {
        let largest = largest.unwrap_or(FIRST_CAPACITY);
        let has_gregory = objects.iter().any(|object| !meshes[object.mesh].spokes.is_empty());
        let mut worst = Self::bounded(objects, meshes, is_software, u32::MAX / 4);
        let mut capacities = Self::bounded(objects, meshes, is_software, largest);
        for lists in [&mut worst, &mut capacities] {
            for kind in PatchKind::ALL.into_iter().filter(|kind| kind.is_cut()) {
                let first = if kind == PatchKind::Cut || has_gregory { largest } else { 0 };
                lists.entries[kind as usize] = first;
                lists.draws[kind as usize] = if is_software { first } else { 0 };
            }
        }
        capacities.worst = Some(Box::new(worst));
        capacities
    }

    fn bounded(objects: &[ObjectDesc], meshes: &[MeshRanges], is_software: bool, largest: u32) -> Self {
        let sum = |of: &dyn Fn(&MeshRanges) -> u64| objects.iter().map(|object| of(&meshes[object.mesh])).sum::<u64>();
        let worst = |of: &dyn Fn(&MeshRanges) -> u64| sum(of).min(u64::from(largest)) as u32;
        let chunks = |count: usize| count.div_ceil(CHUNK as usize) as u64;
        let all = |ranges: &[std::ops::Range<u32>]| ranges.iter().map(|range| range.len() as u64).sum::<u64>();
        let chunk_counts: [&dyn Fn(&MeshRanges) -> u64; 4] = [
            &|mesh| chunks(mesh.cage_points.len()),
            &|mesh| chunks(mesh.slots.len() - mesh.cage_points.len()),
            &|mesh| chunks(mesh.irregular[0].len()),
            &|mesh| chunks(mesh.patches[0].len()),
        ];
        let patches = worst(&|mesh| all(&mesh.patches));
        let leaves = worst(&|mesh| all(&mesh.irregular));
        let gregory = worst(&|mesh| if mesh.spokes.is_empty() { 0 } else { all(&mesh.irregular) });
        let entries = [patches, patches, leaves, 0, gregory, 0, gregory, 0, patches];
        Self {
            chunks: chunk_counts.map(|of| u32::try_from(sum(of)).unwrap_or(u32::MAX)),
            active: std::array::from_fn(|level| {
                worst(&|mesh| mesh.irregular.get(level).map_or(0, |range| range.len() as u64))
            }),
            items: [
                worst(&|mesh| all(&mesh.patches[1..])),
                leaves,
                patches.min(1 << 12).min(largest),
                gregory.min(1 << 12).min(largest),
            ],
            entries,
            draws: entries.map(|count| if is_software { count } else { 0 }),
            worst: None,
        }
    }

    /// With room for all that a frame asked for; none if all fitted.
    ///
    /// What faces that did not fit would have become is not known, so then all lists get room for the worst case. Cut patches that
    /// did not fit have pieces that the next frame counts.
    pub fn grown(&self, status: &Status) -> Option<Self> {
        let has_lost_faces = (1..LEVEL_COUNT).any(|level| status.heads[LIST_ACTIVE + level].count > self.active[level])
            || status.heads[LIST_PATCHES].count > self.items[0]
            || status.heads[LIST_LEAVES].count > self.items[1];
        let mut grown = self.clone();
        if let Some(worst) = self.worst.as_ref().filter(|_| has_lost_faces) {
            grown = Self { worst: self.worst.clone(), ..(**worst).clone() };
            for kind in PatchKind::ALL.into_iter().filter(|kind| kind.is_cut()) {
                grown.entries[kind as usize] = self.entries[kind as usize];
                grown.draws[kind as usize] = self.draws[kind as usize];
            }
        }
        let grow = |capacity: &mut u32, needed: u32| {
            if needed > *capacity {
                // Half as much again: the next frame may ask for a little more.
                *capacity = needed.saturating_add(needed / 2);
            }
        };
        for (level, capacity) in grown.active.iter_mut().enumerate().skip(1) {
            grow(capacity, status.heads[LIST_ACTIVE + level].count);
        }
        for (capacity, list) in grown.items.iter_mut().zip([LIST_PATCHES, LIST_LEAVES, LIST_CUT, LIST_CUT_GREGORY]) {
            grow(capacity, status.heads[list].count);
        }
        for (kind, head) in status.draw_heads.iter().enumerate() {
            grow(&mut grown.entries[kind], head.count);
            grow(&mut grown.draws[kind], head.draw_count);
        }
        (grown != *self).then_some(grown)
    }

    /// Where each kind's chunks begin.
    pub(crate) fn first_chunks(&self) -> [u32; 4] {
        first_of(&self.chunks)
    }

    /// Where each level's active faces begin.
    pub(crate) fn first_active(&self) -> [u32; LEVEL_COUNT] {
        first_of(&self.active)
    }

    /// The heads of empty lists; `phase_capacities` are rows of each phase.
    pub(crate) fn heads(&self, phase_capacities: &[u32]) -> Vec<ListHead> {
        let head = |capacity| ListHead { groups_x: 0, groups_y: 1, groups_z: 1, count: 0, capacity };
        let mut heads = vec![head(0); LIST_COUNT];
        heads[..4].iter_mut().zip(self.chunks).for_each(|(to, capacity)| *to = head(capacity));
        heads[LIST_PATCHES..].iter_mut().zip(self.items).for_each(|(to, capacity)| *to = head(capacity));
        heads[LIST_ACTIVE..].iter_mut().zip(self.active).for_each(|(to, capacity)| *to = head(capacity));
        heads[LIST_PHASES..].iter_mut().zip(phase_capacities).for_each(|(to, &capacity)| *to = head(capacity));
        heads
    }

    /// The heads of empty draw lists.
    pub(crate) fn draw_heads(&self) -> [DrawHead; KIND_COUNT] {
        let (first, first_draw) = (first_of(&self.entries), first_of(&self.draws));
        std::array::from_fn(|kind| DrawHead {
            capacity: self.entries[kind],
            first: first[kind],
            draw_capacity: self.draws[kind],
            first_draw: first_draw[kind],
            ..DrawHead::default()
        })
    }
}

/// Where lists begin that lie one after the other.
fn first_of<const N: usize>(counts: &[u32; N]) -> [u32; N] {
    std::array::from_fn(|i| sum_of(&counts[..i]))
}

/// Room of several lists together. What is beyond all numbers is beyond the memory of all devices too: the buffer will be refused.
pub(crate) fn sum_of(counts: &[u32]) -> u32 {
    counts.iter().fold(0, |sum, &count| sum.saturating_add(count))
}

/// What a frame left in its heads and counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Heads of all lists.
    pub heads: Vec<ListHead>,
    /// Heads of the draw lists.
    pub draw_heads: [DrawHead; KIND_COUNT],
    /// Patches drawn, and the largest density.
    pub counts: FrameCounts,
}

impl Status {
    /// Patches drawn, by level.
    pub fn patch_counts(&self, level_count: usize) -> Vec<PatchCounts> {
        let of_level = |level: usize| PatchCounts {
            regular: self.counts.regular[level],
            transition: self.counts.transition[level],
            filling: self.counts.filling[level],
            gregory: self.counts.gregory[level],
            triangle: self.counts.triangle[level],
            table: self.counts.table[level],
        };
        (0..level_count).map(of_level).collect()
    }

    /// The largest density of a vertex.
    pub fn density(&self) -> f32 {
        f32::from_bits(self.counts.density_bits)
    }

    /// Points and limit points that were computed.
    pub fn computed_points(&self, phase_count: usize) -> u64 {
        self.heads[LIST_PHASES..][..phase_count].iter().map(|head| u64::from(head.count)).sum()
    }
}

/// Which rows are made at once, in the order in which they must be: the last phase is that of the limit points.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Phases {
    /// First row and number of rows of each.
    pub rows: Vec<[u32; 2]>,
    /// Of each level, its phases.
    pub of_level: Vec<std::ops::Range<usize>>,
}

impl Phases {
    /// Of tables.
    pub fn new(tables: &Tables) -> Self {
        let mut phases = Self::default();
        for level in &tables.levels {
            let first = phases.rows.len();
            phases.rows.extend(level.dispatches.iter().map(|rows| [rows.start, rows.len() as u32]));
            phases.of_level.push(first..phases.rows.len());
        }
        phases.rows.push([0, tables.limit_point_count()]);
        phases
    }

    /// The phase of limit points.
    pub fn limits(&self) -> usize {
        self.rows.len() - 1
    }

    /// Where each phase's part of the lists of rows begins.
    pub fn first_items(&self) -> Vec<u32> {
        let mut next = 0;
        let first = |&[_, count]: &[u32; 2]| {
            let first = next;
            next += count;
            first
        };
        self.rows.iter().map(first).collect()
    }
}

/// The shape of a draw of `count` list entries from `first` on that has to be exact for any of them: on a software driver, where the
/// cost of an instance is quadratic, each is its own instance.
pub fn draw_arguments(first: u32, count: u32, method: SurfaceMethod, is_software: bool) -> DrawArguments {
    let (vertex_count, instance_count) = match (method, is_software) {
        (SurfaceMethod::Uniform, _) => (6 * count, 1),
        (_, true) => (1, count),
        (_, false) => (count, 1),
    };
    let first_vertex = if method == SurfaceMethod::Uniform { 6 * first } else { first };
    DrawArguments { vertex_count, instance_count, first_vertex, first_instance: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_that_are_too_long_together_ask_for_more_than_there_is_and_never_for_less() {
        let mesh = MeshRanges {
            patches: vec![0..u32::MAX, 0..u32::MAX],
            irregular: vec![0..u32::MAX, 0..1],
            spokes: 0..1,
            slots: 0..u32::MAX,
            ..MeshRanges::default()
        };
        let objects = vec![ObjectDesc::identity(0); 200];
        let capacities = Capacities::bounded(&objects, &[mesh], true, u32::MAX / 4);
        assert_eq!(capacities.chunks, [0, u32::MAX, u32::MAX, u32::MAX]);
        assert_eq!(capacities.draw_heads()[PatchKind::Triangle as usize].first, u32::MAX / 4 * 4);
        assert_eq!(sum_of(&capacities.entries), u32::MAX);
        assert_eq!(capacities.first_chunks()[3], u32::MAX);
    }
}
