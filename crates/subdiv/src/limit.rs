//! Limit rows: position and two tangents on the limit surface at a corner of a face, from the points of its level.
//!
//! A vertex has one position, but a normal for each sector that infinitely sharp edges cut out around it. Where rules
//! still change from level to level (semi-sharp edges and vertices) the mask is that of the vertex after its sharpness
//! has decayed, carried back through the steps in between: exact at any level.

use std::collections::HashMap;

use crate::ring::{Decay, Ring, Step};
use crate::rules::{self, BoundaryTangent, VertexRule};
use crate::sharpness::SharpnessAtVertex;
use crate::stencil::{StencilRow, boundary_neighbours, ring_pair, shared};
use crate::topology::{Level, Sector};

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

/// Limit weights that rows of the same rule share.
#[derive(Debug, Default)]
pub(crate) struct SharedLimitWeights {
    smooth: Vec<Option<u32>>,
    boundary: Vec<Option<u32>>,
    corner: Vec<Option<u32>>,
    cone: Vec<Option<u32>>,
    /// Of creased vertices, by their bits.
    interned: HashMap<Vec<[u32; 3]>, u32>,
}

/// The limit mask at a corner (an outgoing half-edge) of a vertex whose faces are all quads: its points, as vertices of
/// the level, and in f64 the weights of position and tangents.
pub fn limit_mask(level: &Level, corner: u32) -> (Vec<u32>, Vec<[f64; 3]>) {
    let vertex = level.origin(corner);
    if !level.tag(vertex).is_plain() {
        return creased_mask(level, corner);
    }
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let rule = mask_points(level, vertex, |point| points.push(point));
    mask_weights(rule, |weight| weights.push(weight));
    (points, weights)
}

/// The same with the points as corners: each names its vertex in a face of the sector, so that face-varying values can be
/// told apart. Ends of creases beyond the sector are named in a face beside the crease.
pub(crate) fn limit_mask_at_corners(level: &Level, corner: u32) -> (Vec<u32>, Vec<[f64; 3]>) {
    let (points, weights) = limit_mask(level, corner);
    let vertex = level.origin(corner);
    let sector = if level.tag(vertex).is_plain() {
        let is_closed = !level.tag(vertex).is_boundary();
        Sector { spokes: level.spokes(vertex).collect(), is_closed }
    } else {
        level.sector(corner)
    };
    let mut corners = vec![sector.spokes[0]];
    corners.extend(sector.spokes.iter().flat_map(|&spoke| {
        let next = level.next(spoke);
        [next, level.next(next)]
    }));
    if !sector.is_closed {
        corners.push(level.previous(sector.spokes[sector.spokes.len() - 1]));
    }
    let edges = level.incident_edges(vertex);
    for &point in &points[corners.len()..] {
        let edge = edges.iter().find(|&&edge| level.other_end(edge, vertex) == point);
        corners.extend(edge.map(|&edge| if level.origin(edge) == vertex { level.next(edge) } else { edge }));
    }
    (corners, weights)
}

/// The limit rule of a sector with so many faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LimitRule {
    Smooth(u32),
    /// Between the two edges of a crease, or of the boundary.
    Boundary(u32),
    /// Between two infinitely sharp edges of an interpolated vertex.
    Corner(u32),
    /// All around an interpolated vertex: the tip of a cone.
    Cone(u32),
}

/// The limit rule at a corner, once nothing is semi-sharp any more, and whether that takes levels.
pub(crate) fn limit_rule(level: &Level, corner: u32) -> (LimitRule, bool) {
    let vertex = level.origin(corner);
    if level.tag(vertex).is_plain() {
        return (mask_points(level, vertex, |_| {}), false);
    }
    let sharpness = SharpnessAtVertex::of(level, vertex);
    let sector = level.sector(corner);
    let decay = Decay::new(level, &sharpness);
    (creased_rule(decay.last.before.0, sector.is_closed, sector.spokes.len() as u32), !decay.steps.is_empty())
}

/// The limit rule of a sector of a vertex of this rule. That of a dart is smooth.
fn creased_rule(rule: VertexRule, is_closed: bool, face_count: u32) -> LimitRule {
    match rule {
        VertexRule::Smooth | VertexRule::Dart => LimitRule::Smooth(face_count),
        VertexRule::Crease | VertexRule::Corner if is_closed => LimitRule::Cone(face_count),
        VertexRule::Crease => LimitRule::Boundary(face_count),
        VertexRule::Corner => LimitRule::Corner(face_count),
    }
}

/// Points of the mask of a plain vertex: itself, then the edge's end and the opposite corner of each face in turn, and
/// on the boundary the end of the last edge.
fn mask_points(level: &Level, vertex: u32, mut push: impl FnMut(u32)) -> LimitRule {
    let tag = level.tag(vertex);
    debug_assert!(tag.touches_only_quads(), "limit masks are for quads");
    push(vertex);
    let mut face_count = 0;
    for spoke in level.spokes(vertex) {
        face_count += 1;
        ring_pair(level, spoke).into_iter().for_each(&mut push);
    }
    if tag.is_boundary() {
        push(boundary_neighbours(level, vertex)[1]);
    }
    match (tag.is_boundary(), tag.is_corner()) {
        (false, false) => LimitRule::Smooth(face_count),
        (false, true) => LimitRule::Cone(face_count),
        (true, false) => LimitRule::Boundary(face_count),
        (true, true) => LimitRule::Corner(face_count),
    }
}

fn mask_weights(rule: LimitRule, mut push: impl FnMut([f64; 3])) {
    match rule {
        LimitRule::Smooth(valence) | LimitRule::Cone(valence) => {
            let mask = match rule {
                LimitRule::Cone(_) => rules::VertexMask { vertex: 1.0, edge: 0.0, face: 0.0 },
                _ => rules::smooth_limit(valence),
            };
            push([mask.vertex, 0.0, 0.0]);
            for i in 0..valence {
                let (edge, face) = rules::smooth_tangents(valence, i);
                push([mask.edge, edge[0], edge[1]]);
                push([mask.face, face[0], face[1]]);
            }
        }
        LimitRule::Boundary(face_count) | LimitRule::Corner(face_count) => {
            let (across, end) = match rule {
                LimitRule::Corner(_) => (BoundaryTangent::at_corner(face_count), 0.0),
                _ => (BoundaryTangent::new(face_count), rules::CREASE_LIMIT_END),
            };
            push([1.0 - 2.0 * end, 0.0, across.vertex()]);
            for i in 0..face_count {
                let first = if i == 0 { 1.0 } else { 0.0 };
                push([first * end, first, across.edge(i)]);
                push([0.0, 0.0, across.face(i)]);
            }
            push([end, -1.0, across.edge(face_count)]);
        }
    }
}

/// The mask in a sector of a vertex with creases: the ring is followed until nothing is semi-sharp any more, and the
/// mask of the rule that is left is carried back step by step.
fn creased_mask(level: &Level, corner: u32) -> (Vec<u32>, Vec<[f64; 3]>) {
    let sharpness = SharpnessAtVertex::of(level, level.origin(corner));
    let sector = level.sector(corner);
    let decay = Decay::new(level, &sharpness);
    let ring = Ring::new(level, &sector, &sharpness, &decay);
    let face_count = ring.face_count as u32;
    let mut weights = Vec::with_capacity(ring.points.len());
    let (rule, ends) = decay.last.before;
    let limit_rule = creased_rule(rule, ring.is_closed, face_count);
    if rule == VertexRule::Dart {
        weights = dart_mask(&ring);
    } else {
        mask_weights(limit_rule, |weight| weights.push(weight));
    }
    weights.resize(ring.points.len(), [0.0; 3]);
    if rule == VertexRule::Crease {
        // The crease need not run along the sector: a whole fan, or one that begins and ends at the same edge.
        weights.iter_mut().for_each(|weight| weight[0] = 0.0);
        weights[0][0] = 1.0 - 2.0 * rules::CREASE_LIMIT_END;
        ends.into_iter().for_each(|edge| weights[ring.edge_places[edge]][0] += rules::CREASE_LIMIT_END);
    }
    for step in decay.steps.iter().rev() {
        weights = ring.carry_back(step, &weights);
    }
    (ring.points, weights)
}

/// The mask at the end of an infinitely sharp crease inside a smooth surface, where no closed form is known: the left
/// eigenvectors of the refinement step, found by iterating it. The position's belongs to the eigenvalue 1; the tangents
/// are the leading ones among those that are symmetric about the crease and those that are not.
fn dart_mask(ring: &Ring) -> Vec<[f64; 3]> {
    /// The position converges in less than 200 steps; the next eigenvalues of a high valence lie close together.
    const MOST_STEPS: usize = 20_000;
    /// Of weights of about 1, from one step to the next.
    const LEAST_CHANGE: f64 = 1e-15;
    let step = Step::dart(ring);
    let count = ring.points.len();
    let valence = ring.face_count as u32;
    let mut weights = vec![[0.0; 3]; count];
    weights[0] = [1.0, 0.0, 0.0];
    for i in 0..valence {
        let (edge, face) = rules::smooth_tangents(valence, i);
        weights[1 + 2 * i as usize] = [0.0, edge[0], edge[1]];
        weights[2 + 2 * i as usize] = [0.0, face[0], face[1]];
    }
    for _ in 0..MOST_STEPS {
        let before = weights;
        weights = ring.carry_back(&step, &before);
        let sum: f64 = weights.iter().map(|w| w[0]).sum();
        weights.iter_mut().for_each(|w| w[0] /= sum);
        for tangent in [1, 2] {
            // What the position's eigenvector has in it would win in the end.
            let sum: f64 = weights.iter().map(|w| w[tangent]).sum();
            let position: Vec<f64> = weights.iter().map(|w| w[0]).collect();
            weights.iter_mut().zip(position).for_each(|(w, p)| w[tangent] -= sum * p);
            let largest = weights.iter().fold(f64::MIN_POSITIVE, |m, w| m.max(w[tangent].abs()));
            weights.iter_mut().for_each(|w| w[tangent] /= largest);
        }
        let changes = weights.iter().zip(&before).flat_map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
        if changes.fold(0.0, |m: f64, change| m.max(change.abs())) < LEAST_CHANGE {
            break;
        }
    }
    weights
}

impl LimitTable {
    /// Appends the row of a corner; `first_point` is the place of the level's points among those of all levels.
    pub(crate) fn push_corner(&mut self, level: &Level, corner: u32, first_point: u32, cache: &mut SharedLimitWeights) {
        let first_index = self.indices.len();
        let vertex = level.origin(corner);
        let first_weight = if level.tag(vertex).is_plain() {
            let indices = &mut self.indices;
            let rule = mask_points(level, vertex, |point| indices.push(first_point + point));
            let (slots, n) = match rule {
                LimitRule::Smooth(n) => (&mut cache.smooth, n),
                LimitRule::Boundary(n) => (&mut cache.boundary, n),
                LimitRule::Corner(n) => (&mut cache.corner, n),
                LimitRule::Cone(n) => (&mut cache.cone, n),
            };
            shared(slots, n, &mut self.weights, |weights| {
                mask_weights(rule, |weight| weights.push(weight.map(|w| w as f32)));
            })
        } else {
            let (points, weights) = creased_mask(level, corner);
            self.indices.extend(points.into_iter().map(|point| first_point + point));
            let weights: Vec<[f32; 3]> = weights.into_iter().map(|weight| weight.map(|w| w as f32)).collect();
            let bits = weights.iter().map(|weight| weight.map(f32::to_bits)).collect();
            let table = &mut self.weights;
            *cache.interned.entry(bits).or_insert_with(|| {
                let first = table.len() as u32;
                table.extend(weights);
                first
            })
        };
        let count = (self.indices.len() - first_index) as u32;
        self.rows.push(StencilRow { first_index: first_index as u32, first_weight, count });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far each column of the mask of a dart of this valence is from an eigenvector of the step.
    fn dart_residuals(valence: usize) -> [f64; 3] {
        let ring = Ring {
            points: (0..=2 * valence as u32).collect(),
            face_count: valence,
            is_closed: true,
            edge_places: (0..valence).map(|i| 1 + 2 * i).collect(),
        };
        let weights = dart_mask(&ring);
        let carried = ring.carry_back(&Step::dart(&ring), &weights);
        std::array::from_fn(|c| {
            let dot = |a: &[[f64; 3]], b: &[[f64; 3]]| a.iter().zip(b).map(|(a, b)| a[c] * b[c]).sum::<f64>();
            let eigenvalue = dot(&weights, &carried) / dot(&weights, &weights);
            weights.iter().zip(&carried).map(|(a, b)| (eigenvalue * a[c] - b[c]).abs()).fold(0.0, f64::max)
        })
    }

    #[test]
    fn the_mask_of_a_dart_is_made_of_eigenvectors_of_its_step() {
        for valence in [3, 4, 5, 6, 7, 8, 12, 40, 100] {
            let residuals = dart_residuals(valence);
            // Rows hold the weights as 32-bit floats.
            let is_exact = residuals.iter().all(|&residual| residual < f64::from(f32::EPSILON) / 100.0);
            assert!(is_exact, "valence {valence}: {residuals:?}");
        }
    }
}
