//! Which limit point belongs to a corner of a face of any level: one for each vertex and sector, however many levels the
//! vertex is carried through.
//!
//! The point that a vertex becomes one level down has the same limit. So its row stands on the points of the level at
//! which the vertex was made: those are in use whenever the vertex is a corner of a face that is drawn, whatever the
//! levels between have been refined to. Two things begin anew: no limit mask exists at a vertex of level 0 that touches
//! a face that is no quad, so its row is on level 1; and below a vertex all of whose faces are forced by edits, because
//! an edit may move what the limit is made of.

use std::collections::HashMap;

use crate::limit::{LimitTable, SharedLimitWeights};
use crate::refine::{Refinement, child_half_edge};
use crate::topology::{Level, NONE};

/// Numbers limit points as they are asked for.
pub(super) struct LimitPoints<'a> {
    refinement: &'a Refinement,
    /// Places of the levels' points among those of all levels.
    first_points: &'a [u32],
    table: &'a mut LimitTable,
    levels: Vec<LevelLimits>,
    /// Half-edge of level 0 to the child face at its origin.
    first_children: Vec<u32>,
    cache: SharedLimitWeights,
    /// Rows are on the points of the level that they are asked for.
    is_uniform: bool,
    /// Of displaced surfaces, for each point: the point of its vertex' first sector; its level and corner there.
    pub places: Vec<(u32, u32, u32)>,
    is_displaced: bool,
}

/// The limit points whose rows are on one level.
#[derive(Default)]
struct LevelLimits {
    /// Of vertices with one normal.
    of_vertex: Vec<u32>,
    /// Of the others, by corner.
    of_corner: HashMap<u32, u32>,
    /// Vertices all of whose faces are forced; empty if there are none.
    is_surrounded: Vec<bool>,
}

impl<'a> LimitPoints<'a> {
    pub fn new(refinement: &'a Refinement, first_points: &'a [u32], table: &'a mut LimitTable) -> Self {
        let levels = refinement.levels.iter().zip(&refinement.forced_faces).zip(&refinement.splits);
        let surrounded = levels.map(|((level, forced), split)| surrounded(level, forced, &split.vertices));
        let surrounded: Vec<Vec<bool>> = surrounded.chain([Vec::new()]).collect();
        let levels = refinement.levels.iter().zip(surrounded).map(|(level, is_surrounded)| LevelLimits {
            of_vertex: vec![NONE; level.tags.len()],
            is_surrounded,
            ..LevelLimits::default()
        });
        Self {
            refinement,
            first_points,
            levels: levels.collect(),
            first_children: refinement
                .splits
                .first()
                .map_or_else(Vec::new, |split| children(refinement.levels[0].origins.len(), &split.child_corners)),
            table,
            cache: SharedLimitWeights::default(),
            is_uniform: refinement.options.uniform,
            places: Vec::new(),
            is_displaced: refinement.options.displaced,
        }
    }

    /// The limit point at a corner (an outgoing half-edge) of a level.
    pub fn point(&mut self, k: u32, corner: u32) -> u32 {
        let (k, corner) = self.place(k, corner);
        self.point_at(k, corner)
    }

    /// How many there are by now.
    pub fn count(&self) -> usize {
        self.table.rows.len()
    }

    fn point_at(&mut self, k: u32, corner: u32) -> u32 {
        let level = &self.refinement.levels[k as usize];
        let vertex = level.origin(corner);
        let known = &mut self.levels[k as usize];
        let is_plain = level.tag(vertex).is_plain();
        let slot = if is_plain { known.of_vertex[vertex as usize] } else { get(&known.of_corner, corner) };
        if slot != NONE {
            return slot;
        }
        let point = self.table.rows.len() as u32;
        if is_plain {
            known.of_vertex[vertex as usize] = point;
        } else {
            known.of_corner.extend(level.sector(corner).spokes.into_iter().map(|spoke| (spoke, point)));
        }
        self.table.push_corner(level, corner, self.first_points[k as usize], &mut self.cache);
        if self.is_displaced {
            self.places.push((point, k, corner));
            if !is_plain {
                self.places[point as usize].0 = self.point_at(k, level.starts[vertex as usize]);
            }
        }
        point
    }

    /// The level on whose points the row of a corner stands, and the corner there.
    pub fn place(&self, k: u32, corner: u32) -> (u32, u32) {
        if self.is_uniform { (k, corner) } else { self.first_of_chain(k, corner) }
    }

    /// Whether the row of a corner is on the points of the next level.
    pub fn is_on_next_level(&self, k: u32, corner: u32) -> bool {
        let level = &self.refinement.levels[k as usize];
        !level.tag(level.origin(corner)).touches_only_quads()
    }

    /// The level and the corner there on whose points the row stands.
    fn first_of_chain(&self, mut k: u32, mut corner: u32) -> (u32, u32) {
        let levels = &self.refinement.levels;
        while k > 0 {
            let split = &self.refinement.splits[k as usize - 1];
            // Vertex points come first, and each is where its child faces begin.
            let vertex = levels[k as usize].origin(corner);
            let Some(&parent_vertex) = split.vertices.get(vertex as usize) else { break };
            let parent = &levels[k as usize - 1];
            let is_surrounded = &self.levels[k as usize - 1].is_surrounded;
            let begins_anew = is_surrounded.get(parent_vertex as usize).copied().unwrap_or(false);
            if begins_anew || !parent.tag(parent_vertex).touches_only_quads() {
                break;
            }
            corner = split.child_corners[levels[k as usize].face(corner) as usize];
            k -= 1;
        }
        if k == 0 && self.is_on_next_level(0, corner) {
            let child = self.first_children[corner as usize];
            return (1, child_half_edge(child, &levels[0], corner, 0));
        }
        (k, corner)
    }
}

/// Half-edge to the child face at its origin, or [`NONE`].
pub(super) fn children(half_edge_count: usize, child_corners: &[u32]) -> Vec<u32> {
    let mut children = vec![NONE; half_edge_count];
    for (face, &corner) in (0..).zip(child_corners) {
        children[corner as usize] = face;
    }
    children
}

fn get(points: &HashMap<u32, u32>, corner: u32) -> u32 {
    points.get(&corner).copied().unwrap_or(NONE)
}

/// Whether all faces of a vertex are forced, for the vertices that are split; empty if nothing is forced.
fn surrounded(level: &Level, forced: &[u32], split_vertices: &[u32]) -> Vec<bool> {
    if forced.is_empty() {
        return Vec::new();
    }
    let mut is_forced = vec![false; level.face_count() as usize];
    forced.iter().for_each(|&face| is_forced[face as usize] = true);
    let mut surrounded = vec![false; level.tags.len()];
    for &vertex in split_vertices {
        surrounded[vertex as usize] = level.all_spokes(vertex).all(|spoke| is_forced[level.face(spoke) as usize]);
    }
    surrounded
}
