//! What regular patches share with neighbours of other kinds, so that both have the same bits there (FAS section 5).
//!
//! Regular patches of one level evaluate a shared edge from the same control points in an order that no turn of the
//! patch changes: they agree by themselves. Two things do not:
//! - a corner where irregular faces, or vertices of coarser faces, lie around: all take its limit point. So they do where an
//!   irregular face of the level before does, on the other side of an edge: it may be drawn as it is while this side is refined;
//! - an edge that is half of an edge of a coarser patch: the finer patch evaluates the coarser one there.
//!
//! Where the surface is displaced, positions depend on normals and texture coordinates too, and those differ on both sides of
//! creases and of seams of the channel. There one of the patches decides, the first one, and the others evaluate it; and
//! corners are limit points, each of which has one direction and one pair of coordinates ([`LimitSeat`]).

use crate::face_varying::ChannelLevel;
use crate::refine::Refinement;
use crate::topology::{Level, NONE};

/// The patch that decides along an edge of another: a coarser one, half of whose edge it is, or one of the same level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Border {
    /// That patch, among the patches.
    pub patch: u32,
    /// Its edge.
    pub edge: u8,
    /// Which part of that edge: 0 is the half with the lower u or v, 1 the other, 2 all of it.
    pub part: u8,
    /// Whether u or v grows along the edge in one of the patches and falls in the other.
    pub is_reversed: bool,
}

impl Border {
    /// Patches that a packed border can name.
    pub const MAX_PATCHES: u64 = 1 << 27;
    /// [`Self::part`] of an edge of the same level.
    pub const WHOLE: u8 = 2;

    /// In one word: reversed in bit 0, the part in bits 1-2, the edge in bits 3-4, the patch in bits 5-31.
    pub fn pack(self) -> u32 {
        u32::from(self.is_reversed) | u32::from(self.part) << 1 | u32::from(self.edge) << 3 | self.patch << 5
    }

    /// The inverse of [`Self::pack`].
    pub fn unpack(word: u32) -> Self {
        Self { patch: word >> 5, edge: (word >> 3 & 3) as u8, part: (word >> 1 & 3) as u8, is_reversed: word & 1 != 0 }
    }
}

/// What a regular patch takes from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchSeams {
    /// Limit point that each corner is, or [`NONE`] if the patch evaluates it.
    pub limits: [u32; 4],
    /// What decides along each edge, if not the patch itself.
    pub borders: [Option<Border>; 4],
}

impl PatchSeams {
    pub(super) const NOTHING: Self = Self { limits: [NONE; 4], borders: [None; 4] };
}

/// The level before.
#[derive(Clone, Copy)]
pub(super) struct FacesAbove<'a> {
    pub level: &'a Level,
    /// Which of its faces are patches.
    pub is_patch: &'a [bool],
    /// Which of them are irregular and drawn between limit points in some frames.
    pub may_be_leaf: &'a [bool],
}

/// Which vertices of a level are limit points for all patches around them: memory, filled as they are asked for.
pub(super) struct SharedCorners<'a> {
    level: &'a Level,
    is_irregular: &'a [bool],
    above: Option<FacesAbove<'a>>,
    /// Parent corner of each face.
    child_corners: &'a [u32],
    /// Vertices below this are those of the level before.
    vertex_count: u32,
    /// Where the surface is displaced: its channel of texture coordinates, if there is one.
    displaced: Option<Option<&'a ChannelLevel>>,
    known: Vec<Option<bool>>,
}

impl<'a> SharedCorners<'a> {
    /// Of level `k`; `is_irregular` for its faces.
    pub fn new(refinement: &'a Refinement, k: u32, is_irregular: &'a [bool], above: Option<FacesAbove<'a>>) -> Self {
        let level = &refinement.levels[k as usize];
        let split = k.checked_sub(1).map(|above| &refinement.splits[above as usize]);
        Self {
            level,
            is_irregular,
            above,
            child_corners: split.map_or(&[], |split| &split.child_corners),
            vertex_count: split.map_or(0, |split| split.vertices.len() as u32),
            displaced: refinement.options.displaced.then(|| displacing_channel(refinement, k)),
            known: vec![None; level.tags.len()],
        }
    }

    /// Whether the vertex at the start of a half-edge of a patch is a limit point for all patches around it.
    pub fn is_limit(&mut self, half_edge: u32) -> bool {
        let vertex = self.level.origin(half_edge);
        if let Some(known) = self.known[vertex as usize] {
            return known;
        }
        let mut faces = self.level.all_spokes(vertex).map(|spoke| self.level.face(spoke));
        let is_limit =
            faces.any(|face| self.asks_for_limit(vertex, face)) || self.is_on_leaf(vertex) || self.is_cut(vertex);
        self.known[vertex as usize] = Some(is_limit);
        is_limit
    }

    /// Whether a crease or a seam of a displaced surface ends at a vertex, that is not in the middle of the edge of a patch of the
    /// level before.
    fn is_cut(&self, vertex: u32) -> bool {
        let Some(channel) = self.displaced else { return false };
        let mut edges = self.level.all_spokes(vertex).flat_map(|spoke| [spoke, self.level.previous(spoke)]);
        edges.any(|edge| is_cut(self.level, channel, edge)) && !self.is_middle_of_patch(vertex)
    }

    /// Whether a vertex is a corner of a face of the level before, or in the middle of its edge, which may be drawn between
    /// limit points while the faces on the other side of the edge are refined.
    fn is_on_leaf(&self, vertex: u32) -> bool {
        let Some(above) = self.above else { return false };
        let faces = self.level.all_spokes(vertex).map(|spoke| self.level.face(spoke));
        let mut parents = faces.map(|face| above.level.face(self.child_corners[face as usize]));
        let Some(first) = parents.next() else { return false };
        let (mut is_shared, mut may_be_leaf) = (false, above.may_be_leaf[first as usize]);
        for parent in parents {
            is_shared |= parent != first;
            may_be_leaf |= above.may_be_leaf[parent as usize];
        }
        is_shared && may_be_leaf && !self.is_middle_of_patch(vertex)
    }

    fn is_middle_of_patch(&self, vertex: u32) -> bool {
        let Some(above) = self.above else { return false };
        let mut faces = self.level.all_spokes(vertex).map(|spoke| self.level.face(spoke));
        vertex >= self.vertex_count
            && faces.any(|face| {
                let parent = above.level.face(self.child_corners[face as usize]);
                face >= self.level.drawn_count && above.is_patch[parent as usize]
            })
    }

    /// Whether a face at a vertex is drawn otherwise than as a patch of this level, or of the level before with the vertex in
    /// the middle of its edge: then the vertex is where its edge is cut in halves.
    fn asks_for_limit(&self, vertex: u32, face: u32) -> bool {
        if face < self.level.drawn_count {
            return self.level.is_drawn(face) && self.is_irregular[face as usize];
        }
        let Some(above) = self.above else { return true };
        let parent = above.level.face(self.child_corners[face as usize]);
        above.level.is_drawn(parent) && (vertex < self.vertex_count || !above.is_patch[parent as usize])
    }
}

/// The coarser patch along the edges of the child at a corner of the level above; `places` are those of that level's patches,
/// [`NONE`] for other faces. `edges` are the numbers of the child's two edges on its parent's boundary: of the one
/// that begins at the corner, and of the one that ends there.
pub(super) fn borders(above: &Level, places: &[u32], corner: u32, edges: [u32; 2]) -> [Option<Border>; 4] {
    let mut borders = [None; 4];
    for (half_along, parent_edge, edge) in [(0, corner, edges[0]), (1, above.previous(corner), edges[1])] {
        let Some(across) = first_patch_across(above, places, parent_edge) else { continue };
        let face = above.face(across);
        let coarse_edge = across - above.half_edges(face).start;
        // Edges 2 and 3 of a face run against its u and v.
        let (is_against, is_coarse_against) = (edge >= 2, coarse_edge >= 2);
        let is_opposite = above.origin(across) != above.origin(parent_edge);
        borders[edge as usize] = Some(Border {
            patch: places[face as usize],
            edge: coarse_edge as u8,
            part: half_along ^ u8::from(is_opposite) ^ u8::from(is_coarse_against),
            is_reversed: is_against ^ is_opposite ^ is_coarse_against,
        });
    }
    borders
}

/// The half-edge across an edge whose patch comes first; `places` as of [`borders`].
fn first_patch_across(level: &Level, places: &[u32], edge: u32) -> Option<u32> {
    let twin = level.twin(edge);
    let across = if twin == edge { level.sharing(&edge) } else { std::slice::from_ref(&twin) };
    let place = |&other: &u32| if other == NONE || other == edge { NONE } else { places[level.face(other) as usize] };
    across.iter().copied().filter(|other| place(other) != NONE).min_by_key(|other| place(other))
}

/// The patch of the same level that decides along an edge of a patch of a displaced surface, if it is another one: the first
/// of those at a crease or a seam.
pub(super) fn border_of_cut(
    level: &Level,
    channel: Option<&ChannelLevel>,
    places: &[u32],
    edge: u32,
) -> Option<Border> {
    if !is_cut(level, channel, edge) {
        return None;
    }
    let border = border_along(level, places, edge)?;
    (border.patch < places[level.face(edge) as usize]).then_some(border)
}

/// The first patch of the same level along an edge, on the other side.
pub(super) fn border_along(level: &Level, places: &[u32], edge: u32) -> Option<Border> {
    let across = first_patch_across(level, places, edge)?;
    let (own_face, face) = (level.face(edge), level.face(across));
    let own_edge = edge - level.half_edges(own_face).start;
    let other_edge = across - level.half_edges(face).start;
    let is_opposite = level.origin(across) != level.origin(edge);
    Some(Border {
        patch: places[face as usize],
        edge: other_edge as u8,
        part: Border::WHOLE,
        is_reversed: (own_edge >= 2) ^ is_opposite ^ (other_edge >= 2),
    })
}

/// Whether normals or texture coordinates differ on both sides of an edge.
fn is_cut(level: &Level, channel: Option<&ChannelLevel>, edge: u32) -> bool {
    level.is_infinite(edge) || channel.is_some_and(|channel| channel.is_seam(edge))
}

/// The channel whose coordinates displacement maps are looked up by: the first.
pub(super) fn displacing_channel(refinement: &Refinement, k: u32) -> Option<&ChannelLevel> {
    refinement.face_varying.first().map(|channel| &channel.levels[k as usize])
}

/// What the displacement at a limit point is found by, whichever patch or face draws it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitSeat {
    /// The limit point whose normal is the direction: one for all sectors of a vertex.
    pub canonical: u32,
    /// Texture coordinates: one pair for all sectors.
    pub uv: [f32; 2],
    /// The change of the texture coordinates of the point's own sector along the two tangents of its limit row.
    pub tangents: [[f32; 2]; 2],
}

/// The seats of limit points, whose canonical points, levels and corners there are given.
pub(super) fn limit_seats(refinement: &Refinement, places: &[(u32, u32, u32)]) -> Vec<LimitSeat> {
    let limit = |(_, k, corner): (u32, u32, u32)| {
        displacing_channel(refinement, k).map(|channel| channel.limit(&refinement.levels[k as usize], corner))
    };
    let rounded = |value: [f64; 2]| value.map(|c| c as f32);
    let seat = |&place: &(u32, u32, u32)| LimitSeat {
        canonical: place.0,
        uv: limit(places[place.0 as usize]).map_or([0.0; 2], |limit| rounded(limit.value)),
        tangents: limit(place).map_or([[0.0; 2]; 2], |limit| limit.tangents.map(rounded)),
    };
    places.iter().map(seat).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_survive_packing() {
        for (part, is_reversed) in [(0, false), (0, true), (1, false), (2, true)] {
            let border = Border { patch: (1 << 27) - 1, edge: 2, part, is_reversed };
            assert_eq!(Border::unpack(border.pack()), border);
        }
    }
}
