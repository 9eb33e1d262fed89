//! One channel, one level down (OpenSubdiv's `vtr/fvarRefinement` and `PrimvarRefiner::InterpolateFaceVarying`).

use super::ChannelLevel;
use super::rule::{Rule, ValueRule, VertexRules};
use crate::refine::{Split, child_half_edge};
use crate::rules::{self, VertexRule};
use crate::sharpness::{SharpnessAtVertex, child_sharpness};
use crate::topology::{Level, NONE};

/// The child values of a level's values, half-edges and faces.
struct Children {
    of_value: Vec<u32>,
    /// In the middle of the half-edge's edge, on its side.
    of_half_edge: Vec<u32>,
    of_face: Vec<u32>,
    /// Half-edge to the child face at its origin.
    faces: Vec<u32>,
}

impl ChannelLevel {
    /// The channel on the level that a split makes.
    pub fn split(&self, parent: &Level, split: &Split) -> Self {
        let half_edge_count = parent.origins.len();
        let mut children = Children {
            of_value: vec![NONE; self.values.len()],
            of_half_edge: vec![NONE; half_edge_count],
            of_face: vec![NONE; parent.face_count() as usize],
            faces: vec![NONE; half_edge_count],
        };
        let mut child = Self { is_linear: self.is_linear, ..Self::default() };
        for (face, &corner) in (0..).zip(&split.child_corners) {
            children.faces[corner as usize] = face;
        }
        for &face in &split.faces {
            children.of_face[face as usize] = child.push(self.centre(parent, face));
        }
        for &edge in &split.edges {
            self.split_edge(parent, edge, &mut children, &mut child);
        }
        for &vertex in &split.vertices {
            self.split_vertex(parent, vertex, &mut children, &mut child);
        }
        self.hand_down(parent, split, &children, &mut child);
        child
    }

    fn push(&mut self, value: [f64; 2]) -> u32 {
        self.values.push(value);
        self.values.len() as u32 - 1
    }

    /// The value of a corner.
    pub(super) fn value(&self, corner: u32) -> [f64; 2] {
        self.values[self.corners[corner as usize] as usize]
    }

    fn centre(&self, level: &Level, face: u32) -> [f64; 2] {
        let corners = level.half_edges(face);
        let weight = 1.0 / f64::from(corners.end - corners.start);
        corners.fold([0.0; 2], |sum, corner| add(sum, self.value(corner), weight))
    }

    fn middle(&self, level: &Level, half_edge: u32) -> [f64; 2] {
        add(add([0.0; 2], self.value(half_edge), 0.5), self.value(level.next(half_edge)), 0.5)
    }

    fn split_edge(&self, parent: &Level, edge: u32, children: &mut Children, child: &mut Self) {
        let twin = parent.twin(edge);
        let both = [edge, twin];
        let sides = if twin == edge { parent.sharing(&edge) } else { both.as_slice() };
        if !self.is_seam(edge) {
            let value = child.push(self.edge_value(parent, edge, children, &child.values));
            sides.iter().for_each(|&side| children.of_half_edge[side as usize] = value);
            return;
        }
        for &side in sides {
            let value = child.push(self.middle(parent, side));
            children.of_half_edge[side as usize] = value;
            // Towards the head first: counter-clockwise around the middle.
            let faces = [parent.next(side), side].map(|corner| children.faces[corner as usize]);
            if !self.is_linear && !faces.contains(&NONE) {
                let start = child_half_edge(faces[0], parent, parent.next(side), 3);
                child.rules.insert(value, ValueRule { rule: Rule::Crease, start, face_count: 2 });
            }
        }
    }

    /// The value in the middle of an edge that is no seam.
    fn edge_value(&self, parent: &Level, edge: u32, children: &Children, child_values: &[[f64; 2]]) -> [f64; 2] {
        let middle = self.middle(parent, edge);
        if self.is_linear || parent.is_unpaired(edge) {
            return middle;
        }
        let faces = [edge, parent.twin(edge)].map(|h| parent.face(h));
        let weight = rules::edge_face_weight(parent.options.triangles, faces.map(|face| parent.sides(face)));
        let centre = |face: u32| child_values[children.of_face[face as usize] as usize];
        let ends = middle.map(|c| c * (1.0 - 2.0 * weight));
        let smooth = faces.iter().fold(ends, |sum, &face| add(sum, centre(face), weight));
        let crease = rules::edge_crease_weight(parent.sharpness(edge), child_sharpness(parent, edge));
        add(smooth.map(|c| c * (1.0 - crease)), middle, crease)
    }

    fn split_vertex(&self, parent: &Level, vertex: u32, children: &mut Children, child: &mut Self) {
        let values = self.values_at(parent, vertex);
        let rules: Vec<ValueRule> = values.iter().filter_map(|value| self.rules.get(value).copied()).collect();
        if self.is_linear || rules.len() < values.len() {
            for value in values {
                let of_child = if self.is_linear {
                    self.values[value as usize]
                } else {
                    self.vertex_value(parent, vertex, children, &child.values)
                };
                children.of_value[value as usize] = child.push(of_child);
            }
            return;
        }
        let before = VertexRules::of(parent, vertex, &rules);
        let after = before.child();
        for (place, (value, rule)) in values.into_iter().zip(rules).enumerate() {
            let own = self.values[value as usize];
            let corner = before.corner_weight(&after, place);
            let of_child = if corner == 1.0 {
                own
            } else {
                let end_weight = (1.0 - corner) * rules::CREASE_END;
                let ends = self.crease_ends(parent, &rule);
                let kept = own.map(|c| c * (1.0 - 2.0 * end_weight));
                ends.into_iter().fold(kept, |sum, end| add(sum, end, end_weight))
            };
            let of_child = child.push(of_child);
            children.of_value[value as usize] = of_child;
            let start = child_half_edge(children.faces[rule.start as usize], parent, rule.start, 0);
            child.rules.insert(of_child, ValueRule { rule: after.rule(place), start, ..rule });
        }
    }

    /// The values at both ends of a span.
    pub(super) fn crease_ends(&self, level: &Level, rule: &ValueRule) -> [[f64; 2]; 2] {
        let last = rule.faces(level).last().unwrap_or(rule.start);
        [self.value(level.next(rule.start)), self.value(level.previous(last))]
    }

    /// The value of a vertex that the channel follows.
    fn vertex_value(&self, parent: &Level, vertex: u32, children: &Children, child_values: &[[f64; 2]]) -> [f64; 2] {
        let spokes: Vec<u32> = parent.spokes(vertex).collect();
        let own = self.value(spokes[0]);
        let smooth = || {
            let n = spokes.len() as f64;
            spokes.iter().fold(own.map(|c| c * (n - 2.0) / n), |sum, &spoke| {
                let sum = add(sum, self.value(parent.next(spoke)), 1.0 / (n * n));
                let centre = children.of_face[parent.face(spoke) as usize];
                add(sum, child_values[centre as usize], 1.0 / (n * n))
            })
        };
        let tag = parent.tag(vertex);
        if tag.is_plain() && !tag.is_boundary() && !tag.is_corner() {
            return smooth();
        }
        let edges = parent.incident_edges(vertex);
        let end = |edge: usize| self.value(corner_at_end(parent, edges[edge], vertex));
        let by_rule = |(rule, ends): (VertexRule, [usize; 2])| match rule {
            VertexRule::Corner => own,
            VertexRule::Crease => {
                let kept = own.map(|c| c * (1.0 - 2.0 * rules::CREASE_END));
                ends.into_iter().fold(kept, |sum, edge| add(sum, end(edge), rules::CREASE_END))
            }
            VertexRule::Smooth | VertexRule::Dart => smooth(),
        };
        let blend = SharpnessAtVertex::of(parent, vertex).blend(parent.options.creasing);
        add(by_rule(blend.before).map(|c| c * blend.weight), by_rule(blend.after), 1.0 - blend.weight)
    }

    /// Gives the child level's corners their values, and marks its seams.
    fn hand_down(&self, parent: &Level, split: &Split, children: &Children, child: &mut Self) {
        let half_edge_count = 4 * split.child_corners.len();
        child.corners = vec![NONE; half_edge_count];
        if !self.seams.is_empty() {
            child.seams = vec![false; half_edge_count];
        }
        for (face, &corner) in (0..).zip(&split.child_corners) {
            let previous = parent.previous(corner);
            let values = [
                children.of_value[self.corners[corner as usize] as usize],
                children.of_half_edge[corner as usize],
                children.of_face[parent.face(corner) as usize],
                children.of_half_edge[previous as usize],
            ];
            for (j, value) in (0..).zip(values) {
                child.corners[child_half_edge(face, parent, corner, j) as usize] = value;
            }
            for (j, along) in [(0, corner), (3, previous)] {
                if self.is_seam(along) {
                    child.seams[child_half_edge(face, parent, corner, j) as usize] = true;
                }
            }
        }
        if !child.seams.contains(&true) {
            child.seams = Vec::new();
        }
    }
}

/// The corner at the other end of an edge that starts or ends at a vertex, in the face that the half-edge runs around.
fn corner_at_end(level: &Level, half_edge: u32, vertex: u32) -> u32 {
    if level.origin(half_edge) == vertex { level.next(half_edge) } else { half_edge }
}

pub(super) fn add(a: [f64; 2], b: [f64; 2], weight: f64) -> [f64; 2] {
    [a[0] + weight * b[0], a[1] + weight * b[1]]
}
