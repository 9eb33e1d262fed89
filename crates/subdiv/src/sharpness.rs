//! Sharpness at the vertices and edges of a level, gathered for the rules.

use crate::mesh::Creasing;
use crate::rules::{SemiSharpEdges, VertexBlend, child_edge_sharpness, less_sharp};
use crate::topology::Level;

/// Sharpness of a vertex and of all edges at it.
#[derive(Clone, Debug)]
pub(crate) struct SharpnessAtVertex {
    /// Of the vertex.
    pub vertex: f32,
    /// Of each edge.
    pub edges: Vec<f32>,
    /// The vertex at the other end of each edge.
    pub ends: Vec<u32>,
}

impl SharpnessAtVertex {
    pub fn of(level: &Level, vertex: u32) -> Self {
        let edges = level.incident_edges(vertex);
        Self {
            vertex: level.vertex_sharpness(vertex),
            ends: edges.iter().map(|&edge| level.other_end(edge, vertex)).collect(),
            edges: edges.into_iter().map(|edge| level.sharpness(edge)).collect(),
        }
    }

    /// Sharpness of the edges' children at the vertex.
    pub fn children(&self, creasing: Creasing) -> Vec<f32> {
        children_at_vertex(&self.edges, creasing)
    }

    /// How the vertex is refined.
    pub fn blend(&self, creasing: Creasing) -> VertexBlend {
        VertexBlend::new([self.vertex, less_sharp(self.vertex)], [&self.edges, &self.children(creasing)])
    }
}

/// Sharpness of the children of all edges at a vertex.
pub(crate) fn children_at_vertex(edges: &[f32], creasing: Creasing) -> Vec<f32> {
    let all = SemiSharpEdges::of(edges);
    edges.iter().map(|&sharpness| child_edge_sharpness(creasing, sharpness, all.without(sharpness))).collect()
}

/// Sharpness of the two children of a half-edge's edge, at its origin and at its head. Those of an unpaired one are
/// infinitely sharp whatever is said; it has 0.
pub(crate) fn child_sharpness(level: &Level, half_edge: u32) -> [f32; 2] {
    if level.is_unpaired(half_edge) {
        return [0.0; 2];
    }
    let sharpness = level.sharpness(half_edge);
    [level.origin(half_edge), level.head(half_edge)]
        .map(|end| child_edge_sharpness(level.options.creasing, sharpness, others_at(level, sharpness, end)))
}

/// The other semi-sharp edges at an end of an edge of this sharpness; only Chaikin's rule looks at them.
pub(crate) fn others_at(level: &Level, sharpness: f32, end: u32) -> SemiSharpEdges {
    level.semi_sharp_edges.get(end as usize).copied().unwrap_or_default().without(sharpness)
}
