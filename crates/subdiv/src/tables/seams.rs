//! What regular patches share with neighbours of other kinds, so that both have the same bits there (FAS section 5).
//!
//! Regular patches of one level evaluate a shared edge from the same control points in an order that no turn of the
//! patch changes: they agree by themselves. Two things do not:
//! - a corner where irregular faces, or vertices of coarser faces, lie around: all take its limit point;
//! - an edge that is half of an edge of a coarser patch: the finer patch evaluates the coarser one there.

use crate::refine::Refinement;
use crate::topology::{Level, NONE};

/// The coarser patch that an edge of a patch is half of an edge of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Border {
    /// The coarser patch, among the patches.
    pub patch: u32,
    /// Its edge.
    pub edge: u8,
    /// Which half of that edge: 0 is the one with the lower u or v.
    pub half: u8,
    /// Whether u or v grows along the edge in one of the patches and falls in the other.
    pub is_reversed: bool,
}

impl Border {
    /// Patches that a packed border can name.
    pub const MAX_PATCHES: u64 = 1 << 28;

    /// In one word: reversed in bit 0, the half in bit 1, the edge in bits 2-3, the patch in bits 4-31.
    pub fn pack(self) -> u32 {
        u32::from(self.is_reversed) | u32::from(self.half) << 1 | u32::from(self.edge) << 2 | self.patch << 4
    }

    /// The inverse of [`Self::pack`].
    pub fn unpack(word: u32) -> Self {
        Self { patch: word >> 4, edge: (word >> 2 & 3) as u8, half: (word >> 1 & 1) as u8, is_reversed: word & 1 != 0 }
    }
}

/// What a regular patch takes from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchSeams {
    /// Limit point that each corner is, or [`NONE`] if the patch evaluates it.
    pub limits: [u32; 4],
    /// The coarser patch along each edge.
    pub borders: [Option<Border>; 4],
}

impl PatchSeams {
    pub(super) const NOTHING: Self = Self { limits: [NONE; 4], borders: [None; 4] };
}

/// Which vertices of a level are limit points for all patches around them: memory, filled as they are asked for.
pub(super) struct SharedCorners<'a> {
    level: &'a Level,
    is_irregular: &'a [bool],
    /// The level before, and which of its faces are patches.
    above: Option<(&'a Level, &'a [bool])>,
    /// Parent corner of each face.
    child_corners: &'a [u32],
    /// Vertices below this are those of the level before.
    vertex_count: u32,
    known: Vec<Option<bool>>,
}

impl<'a> SharedCorners<'a> {
    /// Of level `k`; `is_irregular` for its faces, `is_patch_above` for those of the level before.
    pub fn new(refinement: &'a Refinement, k: u32, is_irregular: &'a [bool], is_patch_above: &'a [bool]) -> Self {
        let level = &refinement.levels[k as usize];
        let split = k.checked_sub(1).map(|above| &refinement.splits[above as usize]);
        Self {
            level,
            is_irregular,
            above: k.checked_sub(1).map(|above| (&refinement.levels[above as usize], is_patch_above)),
            child_corners: split.map_or(&[], |split| &split.child_corners),
            vertex_count: split.map_or(0, |split| split.vertices.len() as u32),
            known: vec![None; level.tags.len()],
        }
    }

    /// Whether the vertex at the start of a half-edge of a patch is a limit point for all patches around it.
    pub fn is_limit(&mut self, half_edge: u32) -> bool {
        let vertex = self.level.origin(half_edge);
        if let Some(known) = self.known[vertex as usize] {
            return known;
        }
        let is_limit = self.level.all_spokes(vertex).any(|spoke| self.asks_for_limit(vertex, self.level.face(spoke)));
        self.known[vertex as usize] = Some(is_limit);
        is_limit
    }

    /// Whether a face at a vertex is drawn otherwise than as a patch of this level, or of the level before with the vertex in
    /// the middle of its edge: then the vertex is where its edge is cut in halves.
    fn asks_for_limit(&self, vertex: u32, face: u32) -> bool {
        if face < self.level.drawn_count {
            return self.level.is_drawn(face) && self.is_irregular[face as usize];
        }
        let Some((above, is_patch)) = self.above else { return true };
        let parent = above.face(self.child_corners[face as usize]);
        above.is_drawn(parent) && (vertex < self.vertex_count || !is_patch[parent as usize])
    }
}

/// The coarser patch along the edges of the child at a corner of the level above; `places` are those of that level's patches,
/// [`NONE`] for other faces. `edges` are the numbers of the child's two edges on its parent's boundary: of the one
/// that begins at the corner, and of the one that ends there.
pub(super) fn borders(above: &Level, places: &[u32], corner: u32, edges: [u32; 2]) -> [Option<Border>; 4] {
    let mut borders = [None; 4];
    for (half_along, parent_edge, edge) in [(0, corner, edges[0]), (1, above.previous(corner), edges[1])] {
        let is_patch = |&other: &u32| other != NONE && places[above.face(other) as usize] != NONE;
        let twin = above.twin(parent_edge);
        let across = if twin != parent_edge {
            Some(twin).filter(is_patch)
        } else {
            above.sharing(&parent_edge).iter().copied().filter(|&other| other != parent_edge).find(is_patch)
        };
        let Some(across) = across else { continue };
        let face = above.face(across);
        let coarse_edge = across - above.half_edges(face).start;
        // Edges 2 and 3 of a face run against its u and v.
        let (is_against, is_coarse_against) = (edge >= 2, coarse_edge >= 2);
        let is_opposite = above.origin(across) != above.origin(parent_edge);
        borders[edge as usize] = Some(Border {
            patch: places[face as usize],
            edge: coarse_edge as u8,
            half: half_along ^ u8::from(is_opposite) ^ u8::from(is_coarse_against),
            is_reversed: is_against ^ is_opposite ^ is_coarse_against,
        });
    }
    borders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_survive_packing() {
        for (half, is_reversed) in [(0, false), (0, true), (1, false), (1, true)] {
            let border = Border { patch: (1 << 28) - 1, edge: 2, half, is_reversed };
            assert_eq!(Border::unpack(border.pack()), border);
        }
    }
}
