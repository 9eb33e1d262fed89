//! The rules of the values at one vertex where a seam ends, and how they change from level to level.
//!
//! A value's faces are its *span*. The value stays where it is (a corner), or follows the curve of the values along the
//! two ends of its span (a crease). Semi-sharp edges inside a span, or a semi-sharp vertex, make it a corner until they
//! have decayed; in the step in which they do, the two rules are blended.

use crate::mesh::Creasing;
use crate::rules::{fractional_weight, is_semi_sharp, less_sharp};
use crate::sharpness::{SharpnessAtVertex, children_at_vertex};
use crate::topology::Level;

/// What becomes of a value from level to level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// It stays.
    Corner,
    /// It follows the values at both ends of its span.
    Crease,
    /// It stays until what is semi-sharp has decayed, then it is a crease.
    SemiSharp {
        /// What decays lies in the span of the other one of two values.
        is_dependent: bool,
    },
}

/// A value's rule, and its span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ValueRule {
    pub rule: Rule,
    /// Corner at the vertex of the span's first face. Of a corner by rule any of its faces.
    pub start: u32,
    pub face_count: u32,
}

impl ValueRule {
    /// The corners at the vertex of the span's faces, counter-clockwise.
    pub fn faces<'a>(&self, level: &'a Level) -> impl Iterator<Item = u32> + use<'a> {
        let turn = |&spoke: &u32| Some(level.twin(level.previous(spoke)));
        std::iter::successors(Some(self.start), turn).take(self.face_count as usize)
    }
}

/// The sharpness that rules at a vertex depend on.
#[derive(Clone, Debug)]
pub(super) struct VertexRules {
    creasing: Creasing,
    /// Of the vertex.
    own: f32,
    /// Of all edges there.
    edges: Vec<f32>,
    /// Of each value the rule, and among `edges` those inside its span.
    values: Vec<(Rule, Vec<usize>)>,
}

impl VertexRules {
    /// Of the values at a manifold vertex.
    pub fn of(level: &Level, vertex: u32, values: &[ValueRule]) -> Self {
        let sharpness = SharpnessAtVertex::of(level, vertex);
        let spokes: Vec<u32> = level.spokes(vertex).collect();
        let inside = |value: &ValueRule| {
            let is_semi_sharp = matches!(value.rule, Rule::SemiSharp { .. });
            let faces = if is_semi_sharp { value.faces(level).skip(1).collect() } else { Vec::new() };
            faces.iter().filter_map(|face| spokes.iter().position(|spoke| spoke == face)).collect()
        };
        Self {
            creasing: level.options.creasing,
            own: sharpness.vertex,
            edges: sharpness.edges,
            values: values.iter().map(|value| (value.rule, inside(value))).collect(),
        }
    }

    pub fn rule(&self, value: usize) -> Rule {
        self.values[value].0
    }

    /// Whether rules may still change.
    pub fn is_changing(&self) -> bool {
        self.values.iter().any(|(rule, _)| matches!(rule, Rule::SemiSharp { .. }))
    }

    /// The rules one level down.
    pub fn child(&self) -> Self {
        let mut child = self.clone();
        child.edges = children_at_vertex(&self.edges, self.creasing);
        child.own = less_sharp(self.own);
        if child.own > 0.0 {
            return child;
        }
        let is_any_semi_sharp = child.edges.iter().any(|&s| is_semi_sharp(s));
        for (rule, inside) in &mut child.values {
            let decays = match rule {
                Rule::SemiSharp { is_dependent: false } => !inside.iter().any(|&i| is_semi_sharp(child.edges[i])),
                Rule::SemiSharp { is_dependent: true } => false,
                Rule::Corner | Rule::Crease => continue,
            };
            if decays || !is_any_semi_sharp {
                *rule = Rule::Crease;
            }
        }
        // One that depends on a value that has decayed is on its own from now on.
        if let [a, b] = child.values.as_mut_slice() {
            let is_over = [b.0, a.0].map(|other| !matches!(other, Rule::SemiSharp { .. }));
            for (value, is_over) in [&mut a.0, &mut b.0].into_iter().zip(is_over) {
                if *value == (Rule::SemiSharp { is_dependent: true }) && is_over {
                    *value = Rule::SemiSharp { is_dependent: false };
                }
            }
        }
        child
    }

    /// Weight of the corner rule for a value on the way to these rules one level down; the rest is the crease rule's.
    pub fn corner_weight(&self, child: &Self, value: usize) -> f64 {
        if child.rule(value) != Rule::Crease {
            return 1.0;
        }
        let decaying = match self.rule(value) {
            Rule::Crease | Rule::Corner => return 0.0,
            Rule::SemiSharp { is_dependent: false } => value,
            Rule::SemiSharp { is_dependent: true } => 1 - value,
        };
        let inside = &self.values[decaying].1;
        let of = |edges: &[f32]| -> Vec<f32> { inside.iter().map(|&i| edges[i]).collect() };
        fractional_weight([self.own, child.own], [&of(&self.edges), &of(&child.edges)])
    }
}
