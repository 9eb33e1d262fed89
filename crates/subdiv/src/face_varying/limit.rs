//! Limits of values at corners, and the control values of regular faces.

use super::ChannelLevel;
use super::rule::{Rule, VertexRules};
use super::split::add;
use crate::limit::limit_mask_at_corners;
use crate::patch::{ACROSS, CORNERS, DIAGONAL};
use crate::rules::CREASE_LIMIT_END;
use crate::topology::Level;

/// The limit at a corner: the value, and two tangents by the masks of the position's tangents there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ValueLimit {
    pub value: [f64; 2],
    pub tangents: [[f64; 2]; 2],
}

impl ChannelLevel {
    /// The limit at a corner of a vertex all of whose faces are quads. The tangents are 0 where the channel does not
    /// follow the vertex, and in bilinear channels.
    pub fn limit(&self, level: &Level, corner: u32) -> ValueLimit {
        let own = self.value(corner);
        let without_tangents = |value| ValueLimit { value, tangents: [[0.0; 2]; 2] };
        if self.is_linear {
            return without_tangents(own);
        }
        match self.rules.get(&self.corners[corner as usize]) {
            Some(rule) if rule.rule == Rule::Corner => without_tangents(own),
            Some(_) => without_tangents(self.crease_limit(level, corner)),
            None => {
                let (corners, weights) = limit_mask_at_corners(level, corner);
                let mut limit = ValueLimit { value: own, tangents: [[0.0; 2]; 2] };
                for (corner, weights) in corners.into_iter().zip(weights) {
                    let offset = add(self.value(corner), own, -1.0);
                    limit.value = add(limit.value, offset, weights[0]);
                    limit.tangents[0] = add(limit.tangents[0], offset, weights[1]);
                    limit.tangents[1] = add(limit.tangents[1], offset, weights[2]);
                }
                limit
            }
        }
    }

    /// The limit of a crease, or of what becomes one: values along both ends of a span are halved towards the value in
    /// every step.
    fn crease_limit(&self, level: &Level, corner: u32) -> [f64; 2] {
        let vertex = level.origin(corner);
        let values = self.values_at(level, vertex);
        let place = values.iter().position(|&value| value == self.corners[corner as usize]).unwrap_or(0);
        let rules: Vec<_> = values.iter().map(|value| self.rules[value]).collect();
        let mut own = self.value(corner);
        let mut ends = self.crease_ends(level, &rules[place]);
        let mut state = VertexRules::of(level, vertex, &rules);
        while state.is_changing() {
            let child = state.child();
            let end_weight = (1.0 - state.corner_weight(&child, place)) * crate::rules::CREASE_END;
            let pull = ends.iter().fold([0.0; 2], |sum, &end| add(sum, add(end, own, -1.0), end_weight));
            ends = ends.map(|end| add(end.map(|c| 0.5 * c), own, 0.5));
            own = add(own, pull, 1.0);
            state = child;
        }
        ends.into_iter().fold(own, |sum, end| add(sum, add(end, own, -1.0), CREASE_LIMIT_END))
    }

    /// The corners whose values are the 16 control values of a regular face, row by row, and the mask of the edges along
    /// which the channel ends: the outer rows there are reflections, and their entries name corner 0.
    pub fn control_corners(&self, level: &Level, face: u32) -> ([u32; 16], u8) {
        let edges = level.half_edges(face);
        let mut corners = [edges.start; 16];
        let mut boundary = 0;
        for (i, half_edge) in edges.enumerate() {
            corners[CORNERS[i]] = half_edge;
            // A bilinear function is the spline whose outer rows all are reflections.
            if self.is_linear || self.is_cut(level, half_edge) {
                boundary |= 1 << i;
                continue;
            }
            let out = level.next(level.twin(half_edge));
            let across = level.next(out);
            corners[ACROSS[i][0]] = across;
            corners[ACROSS[i][1]] = level.next(across);
            if !self.is_cut(level, out) {
                corners[DIAGONAL[i]] = level.previous(level.twin(out));
            }
        }
        (corners, boundary)
    }
}
