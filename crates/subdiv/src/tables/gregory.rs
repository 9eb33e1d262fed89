//! What Gregory patches are made of: the spokes of limit points, and for each irregular face which of them are its own.

use std::collections::HashMap;

use crate::gregory::{
    Composer, Rival, RivalSpoke, RowPlace, SectorSpokes, Terms, rival_spokes, sector_of, sector_spokes,
};
use crate::limit::limit_mask;
use crate::refine::{Refinement, child_half_edge};
use crate::stencil::StencilRow;
use crate::tables::gregory_stencils::{GregoryStencils, StencilBuilder};
use crate::tables::limits::{LimitPoints, children};
use crate::tables::seams::{Border, border_along};
use crate::topology::{Level, NONE};

/// A spoke: what a limit point gives to the patches along an edge there ([`crate::gregory::SpokePoints`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spoke {
    /// The edge point is the limit position, plus these times its two tangents,
    pub along: [f32; 2],
    /// plus this times the vector from the limit position to the point `end`,
    pub direct: f32,
    /// or what of it lies in the tangent plane.
    pub is_projected: bool,
    /// The point at the other end of the edge.
    pub end: u32,
    /// The spokes before and after it, counter-clockwise; [`NONE`] at the ends of an open sector.
    pub neighbours: [u32; 2],
    /// The row that makes the vector r: its first index is the origin that the others are taken from.
    pub row: StencilRow,
}

/// A spoke of one of the schemes beside Gregory patches ([`crate::gregory::Rival`]): rows over the cage's points. Their first index is
/// the vertex, which the others are taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RivalSpokeRows {
    /// From the limit position to the end of a third of the tangent along the edge.
    pub edge: StencilRow,
    /// Derivative across the edge.
    pub across: StencilRow,
    /// 3/2 of what lies between the inner points of both faces.
    pub beside: StencilRow,
    /// From the vertex to the middle of these.
    pub middle: StencilRow,
}

/// What kind of patch an irregular face is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GregoryKind {
    /// None: it is always refined, or a hole.
    #[default]
    None,
    /// A quad of 20 points. Seats are its corners, edge i runs from corner i to corner i + 1.
    Quad,
    /// A third of a triangle of 15 points, the one at this corner. Seats and edges are the triangle's.
    PartOfTriangle(u8),
    /// The quad at a corner of a face of more sides. Seats: the corner before, the corner, the corner after, the centre. Edges: from
    /// the corner before, to the corner after, from the centre to the middle of the edge before and to that of the edge after.
    PartOfNgon,
}

/// The side that decides where points of an edge are displaced to, for both: by its own parameters.
///
/// | flag bits | meaning |
/// |---|---|
/// | 0-1 | its edge; of a part of a face of other than four sides the first half is edge 0 of `faces[0]`, the other edge 3 of `faces[1]` |
/// | 2 | the edges run against each other |
/// | 3 | it is such a face |
/// | 4 | nothing lies across |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeOwner {
    /// Ptex faces.
    pub faces: [u32; 2],
    /// The table above.
    pub flags: u32,
}

impl EdgeOwner {
    const REVERSED: u32 = 4;
    const PARTS: u32 = 8;
    const ALONE: u32 = 16;

    /// Of a half-edge: the first of those along its edge.
    fn of(level: &Level, half_edge: u32) -> Self {
        let twin = level.twin(half_edge);
        let sharing = if twin == half_edge { level.sharing(&half_edge) } else { std::slice::from_ref(&twin) };
        // Holes have no texture coordinates.
        let drawn = |&other: &u32| other != NONE && level.is_drawn(level.face(other));
        let first = sharing.iter().copied().filter(drawn).fold(half_edge, u32::min);
        let face = level.face(first);
        let (corner, sides) = (first - level.half_edges(face).start, level.sides(face));
        let base = level.locations[face as usize].ptex_face;
        let is_reversed = level.origin(first) != level.origin(half_edge);
        let is_alone = sharing.iter().filter(|other| drawn(other)).all(|&other| other == half_edge);
        let flags = if is_reversed { Self::REVERSED } else { 0 } | if is_alone { Self::ALONE } else { 0 };
        if sides == 4 {
            return Self { faces: [base; 2], flags: flags | corner };
        }
        Self { faces: [base + corner, base + (corner + 1) % sides], flags: flags | Self::PARTS }
    }
}

/// An irregular face as a Gregory patch; as many as [`super::IrregularFace`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GregoryFace {
    /// What is drawn.
    pub kind: GregoryKind,
    /// Limit points of the seats; unused ones are [`NONE`].
    pub limits: [u32; 4],
    /// The spoke of each edge at its first end.
    pub first: [u32; 4],
    /// And at its other end.
    pub last: [u32; 4],
    /// Cosine at each seat (c of equation (1)).
    pub cosines: [f32; 4],
    /// The bicubic patch across each edge of a quad, whose edge it is.
    pub borders: [Option<Border>; 4],
    /// Edges without a smooth surface across: boundaries and infinitely sharp creases, one bit each.
    pub sharp: u8,
    /// What decides along each edge where the surface is displaced.
    pub owners: [EdgeOwner; 4],
    /// The Ptex face of the part before, of a part of a face of other than four sides.
    pub part_before: u32,
}

impl GregoryFace {
    const NOTHING: Self = Self {
        kind: GregoryKind::None,
        limits: [NONE; 4],
        first: [NONE; 4],
        last: [NONE; 4],
        cosines: [0.0; 4],
        borders: [None; 4],
        sharp: 0,
        owners: [EdgeOwner { faces: [0; 2], flags: 0 }; 4],
        part_before: NONE,
    };

    /// The spoke at the first end of each edge between vertices of the cage.
    pub(super) fn cage_edges(&self) -> impl Iterator<Item = u32> {
        let count = match self.kind {
            GregoryKind::None => 0,
            GregoryKind::Quad => 4,
            GregoryKind::PartOfTriangle(_) => 3,
            GregoryKind::PartOfNgon => 2,
        };
        self.first.into_iter().take(count)
    }
}

/// Gregory patches of a mesh, or of several.
#[derive(Clone, Debug, Default)]
pub struct GregoryTable {
    /// As many as irregular faces; none if the surface has no Gregory patches.
    pub faces: Vec<GregoryFace>,
    /// Spokes.
    pub spokes: Vec<Spoke>,
    /// Instead of them, of another scheme,
    pub rival_spokes: Vec<RivalSpokeRows>,
    /// this one.
    pub rival: Option<Rival>,
    /// First spoke of each limit point, and how many it has.
    pub of_limit: Vec<[u32; 2]>,
    /// Of the rows of spokes: points.
    pub indices: Vec<u32>,
    /// And their weights.
    pub weights: Vec<f32>,
    /// Stencils of the control points, if they were asked for ([`crate::refine::RefineOptions::gregory_stencils`]).
    pub stencils: GregoryStencils,
}

/// Fills the table as the faces come.
pub(super) struct GregoryBuilder<'a> {
    refinement: &'a Refinement,
    first_points: &'a [u32],
    table: GregoryTable,
    /// Half-edge of level 0 to the child face at its origin.
    first_children: Vec<u32>,
    /// Level and limit point to what is known of its spokes.
    known: HashMap<(u32, u32), Known>,
    interned: HashMap<Vec<u32>, u32>,
    stencils: Option<StencilBuilder<'a>>,
}

/// The spokes of a limit point.
struct Known {
    first: u32,
    spokes: SectorSpokes,
}

impl<'a> GregoryBuilder<'a> {
    /// `composer` carries points back to the cage: where stencils are asked for.
    pub fn new(refinement: &'a Refinement, first_points: &'a [u32], composer: Option<Composer<'a>>) -> Self {
        let first_children = refinement
            .splits
            .first()
            .map_or_else(Vec::new, |split| children(refinement.levels[0].origins.len(), &split.child_corners));
        Self {
            refinement,
            first_points,
            table: GregoryTable { rival: refinement.options.rival, ..GregoryTable::default() },
            first_children,
            known: HashMap::new(),
            interned: HashMap::new(),
            stencils: composer.map(StencilBuilder::new),
        }
    }

    /// The table, for so many limit points.
    pub fn finish(mut self, limit_count: usize) -> GregoryTable {
        self.table.of_limit = vec![[0, 0]; limit_count];
        for (&(_, limit), known) in &self.known {
            debug_assert_eq!(
                self.table.of_limit[limit as usize][1], 0,
                "Gregory patches at a limit point are of one level"
            );
            self.table.of_limit[limit as usize] = [known.first, known.spokes.weights.len() as u32];
        }
        let GregoryTable { faces, spokes, indices, .. } = &self.table;
        if let Some(stencils) = self.stencils {
            let own_point = |spoke: u32| indices[spokes[spoke as usize].row.first_index as usize];
            self.table.stencils = stencils.finish(faces, spokes, own_point);
        }
        self.table
    }

    /// Irregular faces that are never drawn.
    pub fn push_nothing(&mut self, count: u32) {
        self.table.faces.extend(std::iter::repeat_n(GregoryFace::NOTHING, count as usize));
        if let Some(stencils) = &mut self.stencils {
            stencils.push_of_spokes(count);
        }
    }

    fn push(&mut self, face: GregoryFace) {
        if let Some(stencils) = &mut self.stencils {
            stencils.push_face(&face, &self.table.spokes);
        }
        self.table.faces.push(face);
    }

    /// An irregular quad of a level; `places` are those of the level's bicubic patches by face.
    pub fn push_quad(&mut self, k: u32, face: u32, places: &[u32], limits: &mut LimitPoints) {
        let level = &self.refinement.levels[k as usize];
        if let Some((parent_level, corner)) = self.parent_of_part(k, face) {
            let parent_sides = parent_level.sides(parent_level.face(corner));
            let part = if parent_sides == 3 {
                self.part_of_triangle(parent_level, corner, limits)
            } else {
                self.part_of_ngon(k, face, corner, limits)
            };
            return self.push(part);
        }
        let start = level.half_edges(face).start;
        let mut quad = GregoryFace { kind: GregoryKind::Quad, ..GregoryFace::NOTHING };
        for i in 0..4 {
            let edge = start + i;
            self.seat(&mut quad, i as usize, k, edge, limits);
            quad.first[i as usize] = self.first_spoke(k, edge, limits);
            quad.last[i as usize] = self.last_spoke(k, edge, limits);
            quad.borders[i as usize] = border_along(level, places, edge);
            quad.sharp |= u8::from(level.is_infinite(edge)) << i;
            quad.owners[i as usize] = EdgeOwner::of(level, edge);
        }
        self.push(quad);
    }

    /// The corner (half-edge) of the face of level 0, of other than four sides, that a face of level 1 is the part of.
    fn parent_of_part(&self, k: u32, face: u32) -> Option<(&'a Level, u32)> {
        // With a level of refinement or more, the neighbours are split too, and these are quads as others are.
        if self.refinement.options.max_level > 0 {
            return None;
        }
        let split = &self.refinement.splits.get(k.checked_sub(1)? as usize)?;
        let parent = &self.refinement.levels[k as usize - 1];
        let corner = split.child_corners[face as usize];
        (parent.sides(parent.face(corner)) != 4).then_some((parent, corner))
    }

    fn part_of_triangle(&mut self, level: &Level, corner: u32, limits: &mut LimitPoints) -> GregoryFace {
        let start = level.half_edges(level.face(corner)).start;
        let kind = GregoryKind::PartOfTriangle((corner - start) as u8);
        let mut part = GregoryFace { kind, ..GregoryFace::NOTHING };
        for i in 0..3 {
            let edge = start + i;
            self.seat(&mut part, i as usize, 0, edge, limits);
            part.first[i as usize] = self.first_spoke(0, edge, limits);
            part.last[i as usize] = self.last_spoke(0, edge, limits);
            part.sharp |= u8::from(level.is_infinite(edge)) << i;
            part.owners[i as usize] = EdgeOwner::of(level, edge);
        }
        part.part_before = part_before(level, corner);
        part
    }

    fn part_of_ngon(&mut self, k: u32, face: u32, corner: u32, limits: &mut LimitPoints) -> GregoryFace {
        let parent = &self.refinement.levels[k as usize - 1];
        let mut part = GregoryFace { kind: GregoryKind::PartOfNgon, ..GregoryFace::NOTHING };
        let before = parent.previous(corner);
        for (seat, edge) in [before, corner, parent.next(corner)].into_iter().enumerate() {
            self.seat(&mut part, seat, k - 1, edge, limits);
        }
        for (i, edge) in [before, corner].into_iter().enumerate() {
            part.first[i] = self.first_spoke(k - 1, edge, limits);
            part.last[i] = self.last_spoke(k - 1, edge, limits);
            part.sharp |= u8::from(parent.is_infinite(edge)) << i;
            part.owners[i] = EdgeOwner::of(parent, edge);
        }
        let centre = child_half_edge(face, parent, corner, 2);
        self.seat(&mut part, 3, k, centre, limits);
        let level = &self.refinement.levels[k as usize];
        part.first[2] = self.first_spoke(k, centre, limits);
        part.first[3] = self.last_spoke(k, level.previous(centre), limits);
        part.part_before = part_before(parent, corner);
        part
    }

    fn seat(&mut self, face: &mut GregoryFace, seat: usize, k: u32, corner: u32, limits: &mut LimitPoints) {
        let known = self.known(k, corner, limits);
        let (limit, cosine) = (known.0, known.1.spokes.cosine as f32);
        face.limits[seat] = limit;
        face.cosines[seat] = cosine;
    }

    /// The spoke of the edge of a half-edge at its origin.
    fn first_spoke(&mut self, k: u32, half_edge: u32, limits: &mut LimitPoints) -> u32 {
        let (_, known) = self.known(k, half_edge, limits);
        known.first + place_of(&known.spokes, half_edge)
    }

    /// And at its head: the one after the next half-edge's.
    fn last_spoke(&mut self, k: u32, half_edge: u32, limits: &mut LimitPoints) -> u32 {
        let next = self.refinement.levels[k as usize].next(half_edge);
        let (_, known) = self.known(k, next, limits);
        let count = known.spokes.weights.len() as u32;
        known.first + (place_of(&known.spokes, next) + 1) % count
    }

    /// The limit point at a corner of a level, and its spokes there.
    fn known(&mut self, k: u32, corner: u32, limits: &mut LimitPoints) -> (u32, &Known) {
        let limit = limits.point(k, corner);
        if !self.known.contains_key(&(k, limit)) {
            let made = self.make(k, corner, limits);
            self.known.insert((k, limit), made);
        }
        (limit, &self.known[&(k, limit)])
    }

    fn make(&mut self, k: u32, corner: u32, limits: &LimitPoints) -> Known {
        let level = &self.refinement.levels[k as usize];
        let (row_k, row_corner) = limits.place(k, corner);
        let row_level = &self.refinement.levels[row_k as usize];
        let turn = if row_k > k {
            // The child at a corner of the sector's first face, wherever the row begins.
            let first = sector_of(level, corner).spokes[0];
            let child = child_half_edge(self.first_children[first as usize], level, first, 0);
            let row_spokes = sector_of(row_level, row_corner).spokes;
            row_spokes.iter().position(|&spoke| spoke == child).unwrap_or(0)
        } else {
            0
        };
        let levels_finer = row_k as i32 - k as i32;
        let spokes =
            sector_spokes(level, corner, RowPlace { level: row_level, corner: row_corner, levels_finer, turn });
        let first = self.table.spoke_count();
        let count = spokes.weights.len() as u32;
        let (vertex, first_point) = (level.origin(corner), self.first_points[k as usize]);
        if let Some(rival) = self.table.rival {
            for spoke in rival_spokes(level, &spokes.sector, rival) {
                let rows = self.rival_rows(vertex, first_point, &spoke);
                self.table.rival_spokes.push(rows);
            }
            return Known { first, spokes };
        }
        for (j, spoke) in (0..).zip(&spokes.weights) {
            let row = self.row(vertex, first_point, &spoke.beside);
            let at = |j: u32| first + j % count;
            let is_closed = spokes.sector.is_closed;
            let before = if is_closed || j > 0 { at(j + count - 1) } else { NONE };
            let after = if is_closed || j + 1 < count { at(j + 1) } else { NONE };
            self.table.spokes.push(Spoke {
                along: spoke.along.map(|w| w as f32),
                direct: spoke.direct as f32,
                is_projected: spoke.is_projected,
                end: first_point + spoke.end,
                neighbours: [before, after],
                row,
            });
        }
        if let Some(stencils) = &mut self.stencils {
            let (points, weights) = limit_mask(row_level, row_corner);
            let points = points.into_iter().map(|point| self.first_points[row_k as usize] + point);
            stencils.push_limit(&spokes, first_point + vertex, first_point, &points.zip(weights).collect::<Vec<_>>());
        }
        Known { first, spokes }
    }

    fn rival_rows(&mut self, vertex: u32, first_point: u32, spoke: &RivalSpoke) -> RivalSpokeRows {
        let mut row = |terms: &Terms| self.row(vertex, first_point, terms);
        RivalSpokeRows {
            edge: row(&spoke.edge),
            across: row(&spoke.across),
            beside: row(&spoke.beside),
            middle: row(&spoke.middle),
        }
    }

    fn row(&mut self, vertex: u32, first_point: u32, terms: &[(u32, f64)]) -> StencilRow {
        let first_index = self.table.indices.len() as u32;
        self.table.indices.push(first_point + vertex);
        self.table.indices.extend(terms.iter().map(|&(v, _)| first_point + v));
        let weights: Vec<f32> = std::iter::once(0.0).chain(terms.iter().map(|&(_, w)| w as f32)).collect();
        let bits = weights.iter().map(|w| w.to_bits()).collect();
        let table = &mut self.table.weights;
        let first_weight = *self.interned.entry(bits).or_insert_with(|| {
            let first = table.len() as u32;
            table.extend(&weights);
            first
        });
        StencilRow { first_index, first_weight, count: weights.len() as u32 }
    }
}

/// The Ptex face at the corner before, of a face of other than four sides.
fn part_before(level: &Level, corner: u32) -> u32 {
    let face = level.face(corner);
    level.locations[face as usize].ptex_face + level.previous(corner) - level.half_edges(face).start
}

/// The place of a corner's spoke in its sector.
fn place_of(spokes: &SectorSpokes, corner: u32) -> u32 {
    spokes.sector.spokes.iter().position(|&spoke| spoke == corner).unwrap_or(0) as u32
}

impl GregoryTable {
    /// Number of spokes, of whichever scheme.
    pub fn spoke_count(&self) -> u32 {
        (self.spokes.len() + self.rival_spokes.len()) as u32
    }

    /// Whether points of some patches are made of spokes, of all where there are no stencils.
    pub fn needs_spokes(&self) -> bool {
        let mut stencils = self.faces.iter().zip(&self.stencils.faces);
        self.stencils.faces.is_empty()
            || stencils.any(|(face, stencil)| face.kind != GregoryKind::None && stencil.is_of_spokes())
    }

    /// Appends what belongs to limit points of another table, whose limit points, points and spokes follow those here.
    pub(super) fn append_spokes(&mut self, other: &Self, points: &[u32]) {
        let first_spoke = self.spoke_count();
        self.rival = self.rival.or(other.rival);
        let (first_index, first_weight) = (self.indices.len() as u32, self.weights.len() as u32);
        let moved = |spoke: u32| if spoke == NONE { NONE } else { spoke + first_spoke };
        self.spokes.extend(other.spokes.iter().map(|spoke| Spoke {
            end: points[spoke.end as usize],
            neighbours: spoke.neighbours.map(moved),
            row: spoke.row.moved(first_index, first_weight),
            ..*spoke
        }));
        self.rival_spokes.extend(other.rival_spokes.iter().map(|spoke| RivalSpokeRows {
            edge: spoke.edge.moved(first_index, first_weight),
            across: spoke.across.moved(first_index, first_weight),
            beside: spoke.beside.moved(first_index, first_weight),
            middle: spoke.middle.moved(first_index, first_weight),
        }));
        self.of_limit.extend(other.of_limit.iter().map(|&[first, count]| [first + first_spoke, count]));
        self.indices.extend(other.indices.iter().map(|&point| points[point as usize]));
        self.weights.extend(&other.weights);
    }

    /// Appends faces of another table; `first_spoke` is where its spokes begin here, `first_limit` where its limit points do.
    pub(super) fn append_faces(
        &mut self,
        faces: &[GregoryFace],
        first_spoke: u32,
        first_limit: u32,
        border: impl Fn(Border) -> Border,
    ) {
        let moved = |entry: u32, first: u32| if entry == NONE { NONE } else { entry + first };
        self.faces.extend(faces.iter().map(|face| GregoryFace {
            limits: face.limits.map(|limit| moved(limit, first_limit)),
            first: face.first.map(|spoke| moved(spoke, first_spoke)),
            last: face.last.map(|spoke| moved(spoke, first_spoke)),
            borders: face.borders.map(|of| of.map(&border)),
            ..*face
        }));
    }
}
