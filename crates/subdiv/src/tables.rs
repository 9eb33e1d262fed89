//! What the GPU reads: stencils by level, limit rows, and the patches of all levels.
//!
//! Points of all levels live in one array, the cage's first. Everything here depends on connectivity alone and costs
//! O(irregular faces x depth); nothing is composed down to the cage.

use std::collections::HashMap;
use std::ops::Range;

use crate::edits::{PointEdit, combine};
use crate::limit::{LimitTable, SharedLimitWeights};
use crate::mesh::HierarchicalEdit;
use crate::patch::{FillingQuad, PatchInfo, RegularPatch, control_points};
use crate::refine::{CreasePatches, Refinement};
use crate::stencil::{SharedWeights, StencilTable, has_large_faces};
use crate::topology::{Level, NONE};

/// The points of one level.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LevelPoints {
    /// Places among the points of all levels.
    pub points: Range<u32>,
    /// Edits of them, applied before the next level is made: a part of [`Tables::edits`].
    pub edits: Range<u32>,
    /// The rows that make them, in dispatches that depend on each other: one, or two where n-gons of many sides have
    /// their face points made first. Row r makes point r + (number of cage points). Empty for the cage.
    pub dispatches: Vec<Range<u32>>,
}

/// How many patches of each kind a level has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchCounts {
    /// Regular patches without a split neighbour.
    pub regular: u32,
    /// Regular patches beside a split face.
    pub transition: u32,
    /// Patch-filling quads.
    pub filling: u32,
}

/// Tables of one mesh.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    /// Number of cage points.
    pub cage_point_count: u32,
    /// By level.
    pub levels: Vec<LevelPoints>,
    /// Rows of all levels from the first on.
    pub stencils: StencilTable,
    /// Limit points.
    pub limits: LimitTable,
    /// Bicubic patches, level by level.
    pub patches: Vec<RegularPatch>,
    /// Irregular leaves.
    pub filling: Vec<FillingQuad>,
    /// For each irregular leaf the limit points at the middles of its edges 0 to 3 and at its centre; empty unless the
    /// refinement kept midpoints.
    pub filling_midpoints: Vec<[u32; 5]>,
    /// By level.
    pub counts: Vec<PatchCounts>,
    /// Level of the irregular leaves.
    pub last_level: u32,
    /// Edits of points of all levels, level by level.
    pub edits: Vec<PointEdit>,
    /// For each of them the hierarchical edits that it combines: numbers of the mesh's edits, in their order.
    edit_sources: Vec<Vec<u32>>,
}

impl Tables {
    /// Builds the tables of a refinement.
    pub fn new(refinement: &Refinement) -> Self {
        let cage_point_count = refinement.levels[0].tags.len() as u32;
        let mut tables = Self {
            cage_point_count,
            levels: vec![LevelPoints { points: 0..cage_point_count, ..LevelPoints::default() }],
            last_level: refinement.last_level,
            ..Self::default()
        };
        tables.add_stencils(refinement);
        tables.add_edits(refinement);
        for k in 0..=refinement.last_level {
            tables.add_patches(refinement, k);
        }
        tables.add_filling(refinement);
        tables
    }

    /// Number of points of all levels.
    pub fn point_count(&self) -> u32 {
        self.levels.last().map_or(0, |level| level.points.end)
    }

    /// Number of limit points.
    pub fn limit_point_count(&self) -> u32 {
        self.limits.rows.len() as u32
    }

    /// Number of patches of all kinds and levels.
    pub fn total_counts(&self) -> PatchCounts {
        self.counts.iter().fold(PatchCounts::default(), |sum, c| PatchCounts {
            regular: sum.regular + c.regular,
            transition: sum.transition + c.transition,
            filling: sum.filling + c.filling,
        })
    }

    fn add_stencils(&mut self, refinement: &Refinement) {
        let mut cache = SharedWeights::default();
        let rows: usize = refinement.splits.iter().map(|split| split.point_count()).sum();
        self.stencils.rows.reserve_exact(rows);
        self.stencils.indices.reserve(7 * rows);
        for (parent, split) in refinement.levels.iter().zip(&refinement.splits) {
            let (first_point, first_child) = (self.levels.last().map_or(0, |l| l.points.start), self.point_count());
            let end = first_child + split.point_count() as u32;
            self.stencils.append_split(parent, split, first_point, first_child, &mut cache);
            let rows = first_child - self.cage_point_count..end - self.cage_point_count;
            let first_face_row = rows.end - split.faces.len() as u32;
            let dispatches = if has_large_faces(parent, split) {
                vec![first_face_row..rows.end, rows.start..first_face_row]
            } else {
                vec![rows]
            };
            self.levels.push(LevelPoints { points: first_child..end, dispatches, edits: 0..0 });
        }
    }

    fn add_edits(&mut self, refinement: &Refinement) {
        for (level, moved) in self.levels.iter_mut().zip(&refinement.moved_points) {
            let first = self.edit_sources.len();
            let mut moved = moved.clone();
            // By point, and for each point in the edits' order.
            moved.sort_by_key(|&(vertex, _)| vertex);
            for same in moved.chunk_by(|a, b| a.0 == b.0) {
                self.edits.push(PointEdit { point: level.points.start + same[0].0, keep: 1.0, offset: [0.0; 3] });
                self.edit_sources.push(same.iter().map(|&(_, edit)| edit).collect());
            }
            level.edits = first as u32..self.edit_sources.len() as u32;
        }
        self.edits = self.point_edits(&refinement.edits);
    }

    /// The edits of points for the mesh's edits with other values: same paths, in the same order.
    pub fn point_edits(&self, edits: &[HierarchicalEdit]) -> Vec<PointEdit> {
        let combined = |(row, sources): (&PointEdit, &Vec<u32>)| {
            combine(row.point, sources.iter().map(|&source| edits[source as usize].operation))
        };
        self.edits.iter().zip(&self.edit_sources).map(combined).collect()
    }

    fn add_patches(&mut self, refinement: &Refinement, k: u32) {
        let level = &refinement.levels[k as usize];
        let irregular = refinement.irregular_flags(k);
        let is_last = k == refinement.last_level;
        let first_point = self.levels[k as usize].points.start;
        let mut counts = PatchCounts::default();
        for face in (0..level.drawn_count).filter(|&face| level.is_drawn(face) && !irregular[face as usize]) {
            let (points, boundary) = control_points(level, face);
            let beside = irregular_neighbours(level, face, &irregular);
            let (transition, leaf) = if is_last { (0, beside) } else { (beside, 0) };
            let location = level.locations[face as usize];
            let has_single = refinement.options.crease_patches == CreasePatches::Single && boundary == 0;
            let single = if has_single { level.single_crease(face) } else { None };
            let (edge, sharpness) = single.map_or((0, 0.0), |(edge, sharpness)| (1 << edge, sharpness));
            let info = PatchInfo { location, level: k as u8, boundary, transition, leaf, crease: edge };
            counts.regular += u32::from(transition == 0);
            counts.transition += u32::from(transition != 0);
            self.patches.push(RegularPatch { points: points.map(|v| first_point + v), info, sharpness });
        }
        if is_last {
            counts.filling = refinement.irregular_faces[k as usize].len() as u32;
        }
        self.counts.push(counts);
    }

    fn add_filling(&mut self, refinement: &Refinement) {
        let last = refinement.last_level as usize;
        let leaves = &refinement.irregular_faces[last];
        let level = &refinement.levels[last];
        // With midpoints the limits are those of the leaves' children: their corners are the leaves' corners,
        // the middles of their edges and their centres.
        let limit_level = refinement.levels.len() - 1;
        let mut limits = LimitPoints {
            level: &refinement.levels[limit_level],
            first_point: self.levels[limit_level].points.start,
            table: &mut self.limits,
            of_vertex: vec![NONE; refinement.levels[limit_level].tags.len()],
            of_corner: HashMap::new(),
            cache: SharedLimitWeights::default(),
        };
        for (i, &face) in (0..).zip(leaves) {
            let info =
                PatchInfo { location: level.locations[face as usize], level: last as u8, ..PatchInfo::default() };
            let corners = if refinement.options.midpoints {
                let child = |j: u32, corner: u32| limits.level.half_edges(4 * i + j).start + corner;
                let middle = [child(0, 1), child(1, 2), child(2, 3), child(3, 0), child(0, 2)];
                let corners = [child(0, 0), child(1, 1), child(2, 2), child(3, 3)];
                self.filling_midpoints.push(middle.map(|v| limits.point(v)));
                corners
            } else {
                std::array::from_fn(|corner| level.half_edges(face).start + corner as u32)
            };
            self.filling.push(FillingQuad { corners: corners.map(|v| limits.point(v)), info });
        }
    }
}

/// Which of a face's edges have an irregular face on the other side, one bit each.
fn irregular_neighbours(level: &Level, face: u32, irregular: &[bool]) -> u8 {
    level.half_edges(face).zip(0..).fold(0, |mask, (half_edge, i)| {
        let twin = level.twin(half_edge);
        let beside = |h: u32| irregular[level.face(h) as usize];
        let is_beside =
            if twin == half_edge { level.sharing(&half_edge).iter().any(|&h| beside(h)) } else { beside(twin) };
        mask | u8::from(is_beside) << i
    })
}

/// Numbers limit points as they are asked for.
struct LimitPoints<'a> {
    level: &'a Level,
    first_point: u32,
    table: &'a mut LimitTable,
    /// Of vertices with one normal.
    of_vertex: Vec<u32>,
    /// Of the others, by corner.
    of_corner: HashMap<u32, u32>,
    cache: SharedLimitWeights,
}

impl LimitPoints<'_> {
    /// The limit point at a corner: an outgoing half-edge of a vertex.
    fn point(&mut self, corner: u32) -> u32 {
        let vertex = self.level.origin(corner);
        let is_plain = self.level.tag(vertex).is_plain();
        let known = if is_plain {
            self.of_vertex[vertex as usize]
        } else {
            self.of_corner.get(&corner).copied().unwrap_or(NONE)
        };
        if known != NONE {
            return known;
        }
        let point = self.table.rows.len() as u32;
        if is_plain {
            self.of_vertex[vertex as usize] = point;
        } else {
            self.of_corner.extend(self.level.sector(corner).spokes.into_iter().map(|spoke| (spoke, point)));
        }
        self.table.push_corner(self.level, corner, self.first_point, &mut self.cache);
        point
    }
}
