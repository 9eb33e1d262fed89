//! Limit rows: position and two tangents on the limit surface at a vertex, from the points of its level.

use crate::rules::{self, BoundaryTangent};
use crate::stencil::{StencilRow, boundary_neighbours, ring_pair, shared};
use crate::topology::Level;

/// Rows that make limit points. As in a stencil row the first index is the origin p0: the position is
/// p0 + sum w (p - p0), the tangents are sum w (p - p0), and their cross product points outward.
#[derive(Clone, Debug, Default)]
pub struct LimitTable {
    /// One row a limit point.
    pub rows: Vec<StencilRow>,
    /// Indices into the points of all levels.
    pub indices: Vec<u32>,
    /// Weights of the position, the first and the second tangent.
    pub weights: Vec<[f32; 3]>,
}

/// Limit weights that rows of the same rule share, by number of faces.
#[derive(Debug, Default)]
pub(crate) struct SharedLimitWeights {
    smooth: Vec<Option<u32>>,
    boundary: Vec<Option<u32>>,
    corner: Vec<Option<u32>>,
}

/// The limit mask at a vertex whose faces are all quads: its points, as vertices of the level, and in f64 the weights
/// of position and tangents.
pub fn limit_mask(level: &Level, vertex: u32) -> (Vec<u32>, Vec<[f64; 3]>) {
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let rule = mask_points(level, vertex, |point| points.push(point));
    mask_weights(rule, |weight| weights.push(weight));
    (points, weights)
}

/// A limit rule, with the number of faces at the vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LimitRule {
    Smooth(u32),
    Boundary(u32),
    Corner(u32),
}

fn mask_points(level: &Level, vertex: u32, mut push: impl FnMut(u32)) -> LimitRule {
    let tag = level.tag(vertex);
    debug_assert!(tag.touches_only_quads(), "limit masks are for quads");
    push(vertex);
    let mut face_count = 0;
    if tag.is_corner() {
        boundary_neighbours(level, vertex).into_iter().for_each(&mut push);
        return LimitRule::Corner(level.spokes(vertex).count() as u32);
    }
    for spoke in level.spokes(vertex) {
        face_count += 1;
        ring_pair(level, spoke).into_iter().for_each(&mut push);
    }
    if tag.is_boundary() {
        push(boundary_neighbours(level, vertex)[1]);
        return LimitRule::Boundary(face_count);
    }
    LimitRule::Smooth(face_count)
}

fn mask_weights(rule: LimitRule, mut push: impl FnMut([f64; 3])) {
    match rule {
        LimitRule::Smooth(valence) => {
            let mask = rules::smooth_limit(valence);
            push([mask.vertex, 0.0, 0.0]);
            for i in 0..valence {
                let (edge, face) = rules::smooth_tangents(valence, i);
                push([mask.edge, edge[0], edge[1]]);
                push([mask.face, face[0], face[1]]);
            }
        }
        LimitRule::Boundary(face_count) => {
            let across = BoundaryTangent::new(face_count);
            let end = rules::CREASE_LIMIT_END;
            push([1.0 - 2.0 * end, 0.0, across.vertex()]);
            for i in 0..face_count {
                let first = if i == 0 { 1.0 } else { 0.0 };
                push([first * end, first, across.edge(i)]);
                push([0.0, 0.0, across.face(i)]);
            }
            push([end, -1.0, across.edge(face_count)]);
        }
        LimitRule::Corner(_) => {
            push([1.0, 0.0, 0.0]);
            push([0.0, 1.0, 0.0]);
            push([0.0, 0.0, 1.0]);
        }
    }
}

impl LimitTable {
    /// Appends the row of a vertex; `first_point` is the place of the level's points among those of all levels.
    pub(crate) fn push_vertex(&mut self, level: &Level, vertex: u32, first_point: u32, cache: &mut SharedLimitWeights) {
        let first_index = self.indices.len();
        let indices = &mut self.indices;
        let rule = mask_points(level, vertex, |point| indices.push(first_point + point));
        let (slots, n) = match rule {
            LimitRule::Smooth(n) => (&mut cache.smooth, n),
            LimitRule::Boundary(n) => (&mut cache.boundary, n),
            LimitRule::Corner(n) => (&mut cache.corner, n),
        };
        let first_weight = shared(slots, n, &mut self.weights, |weights| {
            mask_weights(rule, |weight| weights.push(weight.map(|w| w as f32)));
        });
        let count = (self.indices.len() - first_index) as u32;
        self.rows.push(StencilRow { first_index: first_index as u32, first_weight, count });
    }
}
