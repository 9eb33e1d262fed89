//! The forest of irregular faces that frames select a cut of, and the patches between them.

use crate::gregory::Composer;
use crate::patch::{PatchInfo, RegularPatch, control_points};
use crate::refine::{CreasePatches, Refinement, child_half_edge};
use crate::tables::Tables;
use crate::tables::gregory::GregoryBuilder;
use crate::tables::limits::{LimitPoints, children};
use crate::tables::seams::{
    FacesAbove, PatchSeams, SharedCorners, border_of_cut, borders, displacing_channel, limit_seats,
};
use crate::tables::stars::StarPoints;
use crate::topology::{Level, Location, NONE};

/// An irregular face of any level: refined in some frames, drawn between limit points in others (FAS section 4.1).
///
/// An n-gon of level 0 is n of these, one a corner: entry 0 of each array is about that corner (the quad there, the edge
/// that begins there, its star), the others are [`NONE`]. Corner i is followed by edge i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IrregularFace {
    /// Location and level; of a part of an n-gon the Ptex face of its corner.
    pub info: PatchInfo,
    /// Child at each corner: a place among the irregular faces, marked with [`Self::IRREGULAR`], or among the patches.
    /// [`NONE`] if it is a hole, or if the face is never refined.
    pub children: [u32; 4],
    /// Number of each edge that this face or the one across may split, or [`NONE`].
    pub edges: [u32; 4],
    /// Star of each corner; [`NONE`] where the next level has none, and for holes: nothing drawn is made of theirs alone.
    pub stars: [u32; 4],
    /// Limit point at each corner; [`NONE`] if the face is never drawn.
    pub limits: [u32; 4],
    /// Limit point at the middle of each edge that the face across may split while this one is drawn, or [`NONE`].
    pub midpoints: [u32; 4],
    /// Corners whose limit point is made of their star's points: of the next level, because the vertex touches a face that
    /// is no quad. One bit each.
    pub star_limits: u8,
    /// Refined at any density: an n-gon, or a face that an edit of a finer level reaches.
    pub is_forced: bool,
    /// A hole, refined for what is around it.
    pub is_hidden: bool,
}

impl IrregularFace {
    /// Marks a child that is an irregular face. [`NONE`] has this bit too.
    pub const IRREGULAR: u32 = 1 << 31;

    fn at(location: Location, level: u32) -> Self {
        Self {
            info: PatchInfo { location, level: level as u8, ..PatchInfo::default() },
            children: [NONE; 4],
            edges: [NONE; 4],
            stars: [NONE; 4],
            limits: [NONE; 4],
            midpoints: [NONE; 4],
            star_limits: 0,
            is_forced: false,
            is_hidden: false,
        }
    }
}

/// Adds the patches and the irregular faces of all levels, and the edges, stars and limit points that they name.
pub(super) fn add_faces(tables: &mut Tables, refinement: &Refinement) {
    let levels: Vec<LevelFaces> = (0..=refinement.last_level).map(|k| LevelFaces::new(tables, refinement, k)).collect();
    let first_points: Vec<u32> = tables.levels.iter().map(|level| level.points.start).collect();
    let mut table = std::mem::take(&mut tables.limits);
    let mut limits = LimitPoints::new(refinement, &first_points, &mut table);
    for (k, faces) in levels.iter().enumerate() {
        let edges = faces.number_edges(&mut tables.edge_count);
        let above = k.checked_sub(1).map(|above| (&levels[above], refinement.splits[above].child_corners.as_slice()));
        faces.add_patches(tables, refinement, &edges, above, &mut limits);
        faces.add_irregular(tables, refinement, &edges, levels.get(k + 1), &mut limits);
    }
    if refinement.options.gregory {
        let has_stencils = refinement.options.gregory_stencils;
        let composer = has_stencils.then(|| Composer::new(&tables.stencils, tables.cage_point_count));
        let mut gregory = GregoryBuilder::new(refinement, &first_points, composer);
        levels.iter().for_each(|faces| faces.add_gregory(&mut gregory, &mut limits));
        tables.gregory = gregory.finish(limits.count());
    }
    tables.limit_seats = limit_seats(refinement, &limits.places);
    tables.limits = table;
}

/// The faces of one level.
struct LevelFaces<'a> {
    k: u32,
    level: &'a Level,
    irregular: &'a [u32],
    split: &'a [u32],
    is_irregular: Vec<bool>,
    is_split: Vec<bool>,
    is_forced: Vec<bool>,
    /// Irregular faces that are leaves whatever the density, because refinement ends here.
    is_end: Vec<bool>,
    /// What a child entry says of each face.
    places: Vec<u32>,
}

impl<'a> LevelFaces<'a> {
    /// Gives the faces of a level their places among those of the tables.
    fn new(tables: &mut Tables, refinement: &'a Refinement, k: u32) -> Self {
        let level = &refinement.levels[k as usize];
        let irregular = &refinement.irregular_faces[k as usize];
        let is_irregular = refinement.flags(k, irregular);
        let is_forced = refinement.flags(k, &refinement.forced_faces[k as usize]);
        let ends_here = k >= refinement.options.max_level;
        let is_end = is_irregular.iter().zip(&is_forced).map(|(&irregular, &forced)| ends_here && irregular && !forced);
        let first_patch = tables.patch_ranges.last().map_or(0, |range| range.end);
        let first_irregular = tables.irregular_ranges.last().map_or(0, |range| range.end);
        let (mut patch, mut next) = (first_patch, first_irregular);
        let mut places = vec![NONE; level.face_count() as usize];
        for face in 0..level.drawn_count {
            if is_irregular[face as usize] {
                places[face as usize] = IrregularFace::IRREGULAR | next;
                next += if level.sides(face) == 4 { 1 } else { level.sides(face) };
            } else if level.is_drawn(face) {
                places[face as usize] = patch;
                patch += 1;
            }
        }
        tables.patch_ranges.push(first_patch..patch);
        tables.irregular_ranges.push(first_irregular..next);
        Self {
            k,
            level,
            irregular,
            split: &refinement.split_faces[k as usize],
            is_end: is_end.collect(),
            is_split: refinement.flags(k, &refinement.split_faces[k as usize]),
            is_irregular,
            is_forced,
            places,
        }
    }

    /// Numbers the edges of the faces that may be refined, by half-edge.
    fn number_edges(&self, edge_count: &mut u32) -> Vec<u32> {
        let level = self.level;
        let mut edges = vec![NONE; level.origins.len()];
        for half_edge in self.split.iter().flat_map(|&face| level.half_edges(face)) {
            if edges[half_edge as usize] == NONE {
                edges[level.twin(half_edge) as usize] = *edge_count;
                level.sharing(&half_edge).iter().for_each(|&same| edges[same as usize] = *edge_count);
                *edge_count += 1;
            }
        }
        edges
    }

    /// Whether one of these faces lies on the other side of a half-edge.
    fn is_across(&self, half_edge: u32, is_one: &[bool]) -> bool {
        let level = self.level;
        let twin = level.twin(half_edge);
        if twin != half_edge {
            return is_one[level.face(twin) as usize];
        }
        level.sharing(&half_edge).iter().any(|&other| other != half_edge && is_one[level.face(other) as usize])
    }

    fn add_patches(
        &self,
        tables: &mut Tables,
        refinement: &Refinement,
        edges: &[u32],
        above: Option<(&LevelFaces, &[u32])>,
        limits: &mut LimitPoints,
    ) {
        let level = self.level;
        let (patches_above, places_above) = above.map(|(above, _)| above.patch_places()).unwrap_or_default();
        let (_, places) = self.patch_places();
        let channel = displacing_channel(refinement, self.k);
        let leaves_above = above.map(|(above, _)| above.possible_leaves()).unwrap_or_default();
        let faces_above = above.map(|(above, _)| FacesAbove {
            level: above.level,
            is_patch: &patches_above,
            may_be_leaf: &leaves_above,
        });
        let mut shared = SharedCorners::new(refinement, self.k, &self.is_irregular, faces_above);
        let first_point = tables.levels[self.k as usize].points.start;
        for face in (0..level.drawn_count).filter(|&face| level.is_drawn(face) && !self.is_irregular[face as usize]) {
            let (points, boundary) = control_points(level, face);
            let has_single = refinement.options.crease_patches == CreasePatches::Single && boundary == 0;
            let single = if has_single { level.single_crease(face) } else { None };
            let (crease, sharpness) = single.map_or((0, 0.0), |(edge, sharpness)| (1 << edge, sharpness));
            let own = level.half_edges(face).zip(0..);
            let leaf = own.fold(0, |mask, (edge, i)| mask | u8::from(self.is_across(edge, &self.is_end)) << i);
            let leaf = leaf | above.map_or(0, |(above, corners)| above.ends_beside_child(corners[face as usize]));
            // Gregory patches have tess factors of their own: no edge is left with one segment.
            let leaf = if refinement.options.gregory { 0 } else { leaf };
            let info = PatchInfo {
                location: level.locations[face as usize],
                level: self.k as u8,
                boundary,
                transition: 0,
                leaf,
                crease,
            };
            let edges = four(|i| edges[(level.half_edges(face).start + i) as usize]);
            let first = level.half_edges(face).start;
            let mut seams = PatchSeams::NOTHING;
            if let Some((above, corners)) = above {
                let corner = corners[face as usize];
                let own = [0, 3].map(|j| child_half_edge(0, above.level, corner, j));
                seams.borders = borders(above.level, &places_above, corner, own);
            }
            if refinement.options.displaced {
                for (i, border) in (0..).zip(&mut seams.borders) {
                    let of_cut = || border_of_cut(level, channel, &places, first + i);
                    *border = border.or_else(of_cut);
                }
            }
            seams.limits = four(|i| if shared.is_limit(first + i) { limits.point(self.k, first + i) } else { NONE });
            let place = if seams == PatchSeams::NOTHING { NONE } else { tables.seams.len() as u32 };
            tables.seams.extend((place != NONE).then_some(seams));
            let points = points.map(|v| first_point + v);
            tables.patches.push(RegularPatch { points, info, sharpness, edges, seams: place });
        }
    }

    /// Which faces are patches, and their places; [`NONE`] for the others.
    fn patch_places(&self) -> (Vec<bool>, Vec<u32>) {
        let place = |&place: &u32| if place & IrregularFace::IRREGULAR == 0 { place } else { NONE };
        let places: Vec<u32> = self.places.iter().map(place).collect();
        (places.iter().map(|&place| place != NONE).collect(), places)
    }

    /// Which faces are irregular and drawn in some frames.
    fn possible_leaves(&self) -> Vec<bool> {
        let faces = (0..).zip(self.is_irregular.iter().zip(&self.is_forced));
        faces
            .map(|(face, (&is_irregular, &is_forced))| is_irregular && !is_forced && self.level.is_drawn(face))
            .collect()
    }

    /// The edges of the child at a corner that are halves of edges of this level's ends of refinement, one bit each.
    fn ends_beside_child(&self, corner: u32) -> u8 {
        let level = self.level;
        [(0, corner), (3, level.previous(corner))].into_iter().fold(0, |mask, (j, half_edge)| {
            let edge = child_half_edge(0, level, corner, j);
            mask | u8::from(self.is_across(half_edge, &self.is_end)) << edge
        })
    }

    /// Adds the Gregory patch of every irregular face, in their order.
    fn add_gregory(&self, gregory: &mut GregoryBuilder, limits: &mut LimitPoints) {
        let (_, places) = self.patch_places();
        for &face in self.irregular {
            let sides = self.level.sides(face);
            if sides != 4 {
                gregory.push_nothing(sides);
            } else if !self.is_end[face as usize] || !self.level.is_drawn(face) {
                gregory.push_nothing(1);
            } else {
                gregory.push_quad(self.k, face, &places, limits);
            }
        }
    }

    fn add_irregular(
        &self,
        tables: &mut Tables,
        refinement: &Refinement,
        edges: &[u32],
        next: Option<&LevelFaces>,
        limits: &mut LimitPoints,
    ) {
        let level = self.level;
        let split = refinement.splits.get(self.k as usize);
        let children = split.map_or_else(Vec::new, |split| children(level.origins.len(), &split.child_corners));
        let mut stars =
            split.map(|split| StarPoints::new(level, split, tables.levels[self.k as usize + 1].points.start));
        let mut star = |half_edge: u32, table: &mut _| match &mut stars {
            Some(stars) => stars.star(level.origin(half_edge), table),
            None => NONE,
        };
        let child = |half_edge: u32| next.map_or(NONE, |next| next.places[children[half_edge as usize] as usize]);
        for &face in self.irregular {
            let location = level.locations[face as usize];
            let mut entry = IrregularFace::at(location, self.k);
            entry.is_forced = self.is_forced[face as usize];
            entry.is_hidden = !level.is_drawn(face);
            let half_edges = level.half_edges(face);
            if level.sides(face) != 4 {
                for (i, half_edge) in (0..).zip(half_edges) {
                    entry.info.location.ptex_face = location.ptex_face + i;
                    entry.children[0] = child(half_edge);
                    entry.edges[0] = edges[half_edge as usize];
                    entry.stars[0] = if entry.is_hidden { NONE } else { star(half_edge, &mut tables.stars) };
                    tables.irregular.push(entry);
                }
                continue;
            }
            let at = |i: u32| half_edges.start + i;
            let is_split = self.is_split[face as usize];
            entry.edges = four(|i| edges[at(i) as usize]);
            if is_split {
                entry.children = four(|i| child(at(i)));
            }
            if !entry.is_forced && !entry.is_hidden {
                entry.limits = four(|i| limits.point(self.k, at(i)));
                entry.star_limits =
                    (0..4).fold(0, |mask, i| mask | u8::from(limits.is_on_next_level(self.k, at(i))) << i);
                let is_beside_split = |i: &u32| self.is_across(at(*i), &self.is_split);
                for i in (0..4).filter(is_beside_split) {
                    let middle = child_half_edge(children[at(i) as usize], level, at(i), 1);
                    entry.midpoints[i as usize] = limits.point(self.k + 1, middle);
                }
            }
            entry.stars = four(|i| {
                let has_star_limit = entry.star_limits >> i & 1 != 0;
                let is_end = [i, (i + 3) % 4].into_iter().any(|edge| entry.edges[edge as usize] != NONE);
                let is_asked_for = !entry.is_hidden && (is_split || has_star_limit || is_end);
                if is_asked_for { star(at(i), &mut tables.stars) } else { NONE }
            });
            tables.irregular.push(entry);
        }
    }
}

/// The four values of a function.
fn four(value: impl FnMut(u32) -> u32) -> [u32; 4] {
    [0, 1, 2, 3].map(value)
}
