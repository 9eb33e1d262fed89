//! What the GPU reads: stencils by level, limit rows, and the patches of all levels.
//!
//! Points of all levels live in one array, the cage's first. Everything here depends on connectivity alone and costs
//! O(irregular faces x depth); nothing is composed down to the cage.

mod basis;
mod face_varying;
mod gregory;
mod gregory_stencils;
mod irregular;
mod limits;
mod lists;
mod merge;
pub mod seams;
pub mod slots;
mod stars;

use std::ops::Range;

use crate::edits::{PointEdit, combine};
use crate::limit::LimitTable;
use crate::mesh::HierarchicalEdit;
use crate::patch::{FillingQuad, PatchInfo, RegularPatch};
use crate::refine::Refinement;
use crate::stencil::{SharedWeights, StencilTable, has_large_faces};

pub use crate::basis::{
    BasisCache, BasisCounts, BasisOptions, FIXED_VALENCES, MAX_TABLE_LEVEL, MAX_TABLE_STEPS, NoCache, TableSet,
    fixed_set,
};
pub use crate::selection::PatchCounts;
pub use basis::{BasisEdge, BasisPatch, BasisTable, TABLE_TRIANGLE};
pub use face_varying::{FaceVaryingEvaluator, FaceVaryingPatch, FaceVaryingTable, TexTree};
pub use gregory::{EdgeOwner, GregoryFace, GregoryKind, GregoryTable, RivalSpokeRows, Spoke};
pub use gregory_stencils::{Connectivity, GregoryStencils, MAX_RING_POINTS, ROWS_PER_CORNER, StencilFace};
pub use irregular::IrregularFace;
pub use lists::IndexLists;
pub use merge::MeshRanges;
pub use seams::{Border, LimitSeat, PatchSeams};
pub use slots::{DensitySlots, NGON, WIDE};

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

/// Tables of one mesh, or of several as one ([`Tables::merge`]).
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
    /// Of displaced surfaces, for each limit point what its displacement is found by; else none.
    pub limit_seats: Vec<LimitSeat>,
    /// What patches take from neighbours of other kinds, for those that do.
    pub seams: Vec<PatchSeams>,
    /// Places in `patches`, by level.
    pub patch_ranges: Vec<Range<u32>>,
    /// Irregular faces, level by level; none with uniform refinement.
    pub irregular: Vec<IrregularFace>,
    /// Places in `irregular`, by level.
    pub irregular_ranges: Vec<Range<u32>>,
    /// Their Gregory patches, if they are drawn as such ([`crate::refine::RefineOptions::gregory`]).
    pub gregory: GregoryTable,
    /// Number of edges that a face at them may split, of all levels.
    pub edge_count: u32,
    /// Stars of the corners of irregular faces: the points of the next level at each.
    pub stars: IndexLists,
    /// For each Ptex face the density slots of its corners: of a quad its four vertices; of an n-gon's part the vertex,
    /// the next one, the n-gon's slot marked with [`NGON`], and the previous vertex.
    pub ptex_faces: Vec<[u32; 4]>,
    /// Where density is known, and whose matters where.
    pub slots: DensitySlots,
    /// The faces of the last level of uniform refinement; else none.
    pub filling: Vec<FillingQuad>,
    /// The values of face-varying channels, refined to the end.
    pub face_varying: Vec<FaceVaryingTable>,
    /// Faces that are evaluated by table.
    pub basis: BasisTable,
    /// No irregular face of this level is refined, unless it is forced.
    pub max_level: u32,
    /// The deepest level.
    pub last_level: u32,
    /// Edits of points of all levels, level by level.
    pub edits: Vec<PointEdit>,
    /// For each of them the hierarchical edits that it combines: numbers of the mesh's edits, in their order.
    pub(crate) edit_sources: Vec<Vec<u32>>,
    /// How many hierarchical edits the mesh has, or the meshes have.
    pub(crate) hierarchical_edit_count: u32,
}

impl Tables {
    /// Builds the tables of a refinement.
    pub fn new(refinement: &Refinement) -> Self {
        let cage_point_count = refinement.levels[0].tags.len() as u32;
        let mut tables = Self {
            cage_point_count,
            levels: vec![LevelPoints { points: 0..cage_point_count, ..LevelPoints::default() }],
            max_level: refinement.options.max_level,
            last_level: refinement.last_level,
            ptex_faces: slots::ptex_faces(&refinement.levels[0]),
            hierarchical_edit_count: refinement.edits.len() as u32,
            ..Self::default()
        };
        tables.add_stencils(refinement);
        tables.add_edits(refinement);
        let level_count = tables.levels.len();
        if refinement.options.uniform {
            tables.slots = DensitySlots::new(&refinement.levels[0], &[]);
            (tables.patch_ranges, tables.irregular_ranges) = (vec![0..0; level_count], vec![0..0; level_count]);
            tables.add_filling(refinement);
        } else {
            tables.slots = DensitySlots::new(&refinement.levels[0], &refinement.irregular_faces[0]);
            irregular::add_faces(&mut tables, refinement);
        }
        tables.face_varying = face_varying::tables(&tables, refinement);
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

    /// The edits of points for the mesh's edits with other values: same paths, in the same order. Of merged tables: for
    /// the edits of all meshes, one mesh after another.
    pub fn point_edits(&self, edits: &[HierarchicalEdit]) -> Vec<PointEdit> {
        let combined = |(row, sources): (&PointEdit, &Vec<u32>)| {
            combine(row.point, sources.iter().map(|&source| edits[source as usize].operation))
        };
        self.edits.iter().zip(&self.edit_sources).map(combined).collect()
    }

    fn add_filling(&mut self, refinement: &Refinement) {
        let last = refinement.last_level as usize;
        let level = &refinement.levels[last];
        let first_points: Vec<u32> = self.levels.iter().map(|level| level.points.start).collect();
        let mut limits = limits::LimitPoints::new(refinement, &first_points, &mut self.limits);
        for &face in &refinement.irregular_faces[last] {
            let location = level.locations[face as usize];
            let info = PatchInfo { location, level: last as u8, ..PatchInfo::default() };
            let first = level.half_edges(face).start;
            let corners = [0, 1, 2, 3].map(|corner| limits.point(last as u32, first + corner));
            self.filling.push(FillingQuad { corners, info });
        }
    }
}
