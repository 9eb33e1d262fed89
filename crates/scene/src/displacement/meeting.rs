//! Where the tiles of Ptex faces meet: points, and edges with a list of texels each.
//!
//! A side of a tile lies on an edge of the cage (of an n-gon's part: on half of one), or on a spoke: the line from the
//! middle of an n-gon's edge to its centre, on which two parts meet. Edges are told apart by their two vertices, so that any
//! number of faces may meet on one, whichever way round; points by the vertex, so that all faces around one meet there even
//! if it is not manifold. Holes have tiles, too, which take part in nothing.
use std::collections::HashMap;

use planish_subdiv::ControlMesh;

/// How the texels of a tile's side, counted along growing u or v, lie on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// All along, forwards.
    Whole,
    /// All along, backwards.
    Reversed,
    /// From the first end to the middle.
    FirstHalf,
    /// From the last end back to the middle.
    LastHalf,
}

/// The side of a tile: an edge, and the part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// In [`Meetings::edges`].
    pub edge: u32,
    /// Part and direction.
    pub span: Span,
}

/// What an edge leads from and to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// An edge of the cage, from its lower to its higher vertex: points both.
    Base([u32; 2]),
    /// From the middle of a base edge to the centre of an n-gon, a point.
    Spoke {
        /// Among the edges, before this one.
        base_edge: u32,
        /// The centre.
        center: u32,
    },
}

/// The tile of a Ptex face.
#[derive(Clone, Copy, Debug)]
pub struct TileSides {
    /// Sides v = 0, u = 1, v = 1 and u = 0.
    pub sides: [Side; 4],
    /// Points at (0, 0), (1, 0), (1, 1), (0, 1); none where the corner is the middle of an edge.
    pub corners: [Option<u32>; 4],
    /// Whether it is a part of an n-gon.
    pub is_part: bool,
    /// Whether it belongs to a hole.
    pub is_hole: bool,
}

/// How the Ptex faces of a cage meet.
#[derive(Debug, Default)]
pub struct Meetings {
    /// One a Ptex face.
    pub tiles: Vec<TileSides>,
    /// Edges of the cage and spokes.
    pub edges: Vec<Edge>,
    /// Vertices of the cage, then centres of n-gons.
    pub point_count: u32,
}

impl Meetings {
    /// The Ptex faces of a cage that [`ControlMesh::validate`] has found good.
    pub fn of(mesh: &ControlMesh) -> Self {
        let mut meetings = Self { point_count: mesh.positions.len() as u32, ..Self::default() };
        let mut edge_of = HashMap::new();
        let mut is_hole = vec![false; mesh.face_sizes.len()];
        mesh.holes.iter().for_each(|&hole| is_hole[hole as usize] = true);
        let mut first = 0;
        for (&size, &is_hole) in mesh.face_sizes.iter().zip(&is_hole) {
            let vertices = &mesh.face_vertices[first..first + size as usize];
            first += size as usize;
            if let &[a, b, c, d] = vertices {
                let sides = [(a, b), (b, c), (d, c), (a, d)].map(|(from, to)| meetings.base(&mut edge_of, from, to));
                let corners = [a, b, c, d].map(Some);
                meetings.tiles.push(TileSides { sides, corners, is_part: false, is_hole });
            } else {
                meetings.add_parts(&mut edge_of, vertices, is_hole);
            }
        }
        meetings
    }

    /// Adds the parts of an n-gon.
    fn add_parts(&mut self, edge_of: &mut HashMap<[u32; 2], u32>, vertices: &[u32], is_hole: bool) {
        let center = self.point_count;
        self.point_count += 1;
        let n = vertices.len();
        let edges: Vec<Side> = (0..n).map(|i| self.base(edge_of, vertices[i], vertices[(i + 1) % n])).collect();
        let first_spoke = self.edges.len() as u32;
        self.edges.extend(edges.iter().map(|side| Edge::Spoke { base_edge: side.edge, center }));
        for (i, &vertex) in vertices.iter().enumerate() {
            let previous = (i + n - 1) % n;
            // The part is the half at its vertex: of the edge that leaves it, and of the one that arrives.
            let half = |at_start: bool| if at_start { Span::FirstHalf } else { Span::LastHalf };
            let (leaving, arriving) = (edges[i], edges[previous]);
            let spoke = |i: usize| Side { edge: first_spoke + i as u32, span: Span::Whole };
            let sides = [
                Side { edge: leaving.edge, span: half(leaving.span == Span::Whole) },
                spoke(i),
                spoke(previous),
                Side { edge: arriving.edge, span: half(arriving.span == Span::Reversed) },
            ];
            let corners = [Some(vertex), None, Some(center), None];
            self.tiles.push(TileSides { sides, corners, is_part: true, is_hole });
        }
    }

    /// The edge of the cage between two vertices, seen from the first.
    fn base(&mut self, edge_of: &mut HashMap<[u32; 2], u32>, from: u32, to: u32) -> Side {
        let ends = [from.min(to), from.max(to)];
        let edge = *edge_of.entry(ends).or_insert_with(|| {
            self.edges.push(Edge::Base(ends));
            self.edges.len() as u32 - 1
        });
        Side { edge, span: if from < to { Span::Whole } else { Span::Reversed } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_and_parts_of_n_gons_share_edges_and_spokes() {
        let mesh = ControlMesh {
            positions: vec![[0.0; 3]; 5],
            face_sizes: vec![4, 3],
            face_vertices: vec![0, 1, 2, 3, 2, 1, 4],
            ..ControlMesh::default()
        };
        let meetings = Meetings::of(&mesh);
        assert_eq!((meetings.tiles.len(), meetings.point_count, meetings.edges.len()), (4, 6, 6 + 3));
        let shared = meetings.tiles[0].sides[1];
        assert_eq!((meetings.edges[shared.edge as usize], shared.span), (Edge::Base([1, 2]), Span::Whole));
        // The triangle's first part is at vertex 2, the last end of that edge; its second part at vertex 1.
        assert_eq!(meetings.tiles[1].sides[0], Side { edge: shared.edge, span: Span::LastHalf });
        assert_eq!(meetings.tiles[2].sides[3], Side { edge: shared.edge, span: Span::FirstHalf });
        // Parts 0 and 1 meet on the spoke from the middle of that edge.
        assert_eq!(meetings.tiles[1].sides[1], meetings.tiles[2].sides[2]);
        assert_eq!(
            meetings.edges[meetings.tiles[1].sides[1].edge as usize],
            Edge::Spoke { base_edge: shared.edge, center: 5 }
        );
    }
}
