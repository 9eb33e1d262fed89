//! Stars: what a refined face makes exist. The star of a vertex of level k is the points of level k + 1 at it: its vertex
//! point, the edge points of all its edges and the face points of all its faces.
//!
//! The stars of the corners of a refined face hold all points that its children's patches and limit rows read, and its
//! children's own stars read nothing else: what is in use follows level by level.

use crate::refine::Split;
use crate::tables::IndexLists;
use crate::topology::{Level, NONE};

/// Makes the stars of one level as they are asked for.
pub(super) struct StarPoints<'a> {
    level: &'a Level,
    /// The child point of each vertex, half-edge and face, among the points of all levels.
    of_vertex: Vec<u32>,
    of_half_edge: Vec<u32>,
    of_face: Vec<u32>,
    /// Star of each vertex.
    stars: Vec<u32>,
}

impl<'a> StarPoints<'a> {
    /// `first_child` is the place of the split's points among those of all levels.
    pub fn new(level: &'a Level, split: &Split, first_child: u32) -> Self {
        let mut points = Self {
            level,
            of_vertex: vec![NONE; level.tags.len()],
            of_half_edge: vec![NONE; level.origins.len()],
            of_face: vec![NONE; level.face_count() as usize],
            stars: vec![NONE; level.tags.len()],
        };
        let mut point = first_child..;
        for (&vertex, point) in split.vertices.iter().zip(&mut point) {
            points.of_vertex[vertex as usize] = point;
        }
        for (&edge, point) in split.edges.iter().zip(&mut point) {
            points.of_half_edge[level.twin(edge) as usize] = point;
            level.sharing(&edge).iter().for_each(|&same| points.of_half_edge[same as usize] = point);
        }
        for (&face, point) in split.faces.iter().zip(&mut point) {
            points.of_face[face as usize] = point;
        }
        points
    }

    /// The star of a core vertex of the split.
    pub fn star(&mut self, vertex: u32, stars: &mut IndexLists) -> u32 {
        let star = &mut self.stars[vertex as usize];
        if *star == NONE {
            let edges = self.level.incident_edges(vertex);
            let edge_points = edges.iter().map(|&edge| self.of_half_edge[edge as usize]);
            let faces = self.level.all_spokes(vertex).map(|spoke| self.of_face[self.level.face(spoke) as usize]);
            let vertex_point = self.of_vertex[vertex as usize];
            *star = stars.push([vertex_point].into_iter().chain(edge_points).chain(faces));
        }
        *star
    }
}
