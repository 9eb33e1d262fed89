//! The refinement of the ring around one vertex, over and over: what the limit at a semi-sharp vertex depends on.

use std::collections::HashMap;

use crate::rules::{
    self, SemiSharpEdges, VertexBlend, VertexRule, child_edge_sharpness, edge_crease_weight, is_semi_sharp, less_sharp,
};
use crate::sharpness::{SharpnessAtVertex, children_at_vertex, others_at};
use crate::stencil::ring_pair;
use crate::topology::{Level, Sector};

/// The points of a sector of quads around a vertex, and the ends of creases beyond it that the vertex depends on.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    /// The vertex; of each face its first edge's end and its opposite corner; in an open sector the end of the last
    /// edge; then ends of infinitely sharp edges that are not in the sector.
    pub points: Vec<u32>,
    pub face_count: usize,
    pub is_closed: bool,
    /// For each edge at the vertex (in the order of its [`SharpnessAtVertex`]) its end's place among the points, or the
    /// number of points for one that nothing here depends on.
    pub edge_places: Vec<usize>,
}

/// One refinement of a ring: the rules of the vertex and of its edges.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    vertex: VertexBlend,
    /// Weight of the crease rule, for each edge at the vertex.
    creases: Vec<f64>,
}

impl Step {
    /// The step at a vertex with one infinitely sharp edge, the ring's first.
    pub fn dart(ring: &Ring) -> Self {
        let smooth = (VertexRule::Dart, [0; 2]);
        let creases = ring.edge_places.iter().map(|&place| if place == 1 { 1.0 } else { 0.0 }).collect();
        Self { vertex: VertexBlend { before: smooth, after: smooth, weight: 1.0 }, creases }
    }
}

/// How the rules at a vertex change until nothing there is semi-sharp any more.
#[derive(Clone, Debug)]
pub(crate) struct Decay {
    pub steps: Vec<Step>,
    /// The rule from then on.
    pub last: VertexBlend,
}

impl Decay {
    /// Of a vertex with this sharpness.
    pub fn new(level: &Level, sharpness: &SharpnessAtVertex) -> Self {
        let creasing = level.options.creasing;
        // The other semi-sharp edges at the far end of each edge.
        let ends = sharpness.edges.iter().zip(&sharpness.ends);
        let mut beyond: Vec<SemiSharpEdges> = ends.map(|(&s, &end)| others_at(level, s, end)).collect();
        let (mut own, mut edges) = (sharpness.vertex, sharpness.edges.clone());
        let mut steps = Vec::new();
        loop {
            let children = children_at_vertex(&edges, creasing);
            let blend = VertexBlend::new([own, less_sharp(own)], [&edges, &children]);
            if !is_semi_sharp(own) && !edges.iter().any(|&s| is_semi_sharp(s)) {
                return Self { steps, last: blend };
            }
            let far: Vec<f32> =
                edges.iter().zip(&beyond).map(|(&s, &others)| child_edge_sharpness(creasing, s, others)).collect();
            let ends = children.iter().zip(&far);
            let creases =
                edges.iter().zip(ends).map(|(&s, (&near, &far))| edge_crease_weight(s, [near, far])).collect();
            steps.push(Step { vertex: blend, creases });
            // From now on the far end is the middle of an edge: its other half is all else that is sharp there.
            beyond = far.iter().map(|&sharpness| SemiSharpEdges::of(&[sharpness])).collect();
            (own, edges) = (less_sharp(own), children);
        }
    }

    /// The edges that the vertex depends on as the ends of a crease, at some step.
    fn crease_ends(&self) -> impl Iterator<Item = usize> {
        let blends = self.steps.iter().map(|step| step.vertex).chain([self.last]);
        blends
            .flat_map(|blend| [blend.before, blend.after])
            .filter(|(rule, _)| *rule == VertexRule::Crease)
            .flat_map(|(_, ends)| ends)
    }
}

impl Ring {
    pub fn new(level: &Level, sector: &Sector, sharpness: &SharpnessAtVertex, decay: &Decay) -> Self {
        let vertex = level.origin(sector.spokes[0]);
        let mut points = vec![vertex];
        points.extend(sector.spokes.iter().flat_map(|&spoke| ring_pair(level, spoke)));
        if !sector.is_closed {
            points.push(level.origin(level.previous(sector.spokes[sector.spokes.len() - 1])));
        }
        // Backwards, so that of two places of one end the first stays.
        let in_ring: HashMap<u32, usize> =
            (1..points.len()).step_by(2).rev().map(|place| (points[place], place)).collect();
        let place = |end: &u32| in_ring.get(end).copied().unwrap_or(usize::MAX);
        let mut edge_places: Vec<usize> = sharpness.ends.iter().map(place).collect();
        for edge in decay.crease_ends() {
            if edge_places[edge] == usize::MAX {
                edge_places[edge] = points.len();
                points.push(sharpness.ends[edge]);
            }
        }
        Self { points, face_count: sector.spokes.len(), is_closed: sector.is_closed, edge_places }
    }

    /// Weights of the points before a step that come to the same as these of the points after it.
    pub fn carry_back(&self, step: &Step, after: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut before = vec![[0.0; 3]; after.len()];
        let mut add = |place: usize, weight: f64, of: [f64; 3]| {
            before[place] = std::array::from_fn(|c| before[place][c] + weight * of[c]);
        };
        let edge_count = self.face_count + usize::from(!self.is_closed);
        let edge = |i: usize| 1 + 2 * (i % edge_count);
        let face = |i: usize| 2 + 2 * (i % self.face_count);
        for ((rule, ends), weight) in
            [(step.vertex.before, step.vertex.weight), (step.vertex.after, 1.0 - step.vertex.weight)]
        {
            match rule {
                VertexRule::Corner => add(0, weight, after[0]),
                VertexRule::Crease => {
                    add(0, (1.0 - 2.0 * rules::CREASE_END) * weight, after[0]);
                    ends.into_iter().for_each(|end| add(self.edge_places[end], rules::CREASE_END * weight, after[0]));
                }
                VertexRule::Smooth | VertexRule::Dart => {
                    let mask = rules::smooth_vertex(self.face_count as u32);
                    add(0, mask.vertex * weight, after[0]);
                    for i in 0..self.face_count {
                        add(edge(i), mask.edge * weight, after[0]);
                        add(face(i), mask.face * weight, after[0]);
                    }
                }
            }
        }
        let ring_end = 1 + self.face_count + edge_count;
        let mut crease_of = vec![0.0; after.len()];
        for (&place, &crease) in self.edge_places.iter().zip(&step.creases).filter(|(place, _)| **place < after.len()) {
            crease_of[place] = crease;
        }
        if !self.is_closed {
            // Infinitely sharp; both may be the same edge, of which only one has a place.
            (crease_of[edge(0)], crease_of[edge(self.face_count)]) = (1.0, 1.0);
        }
        for i in 0..edge_count {
            let (of, crease) = (after[edge(i)], crease_of[edge(i)]);
            let ends = 0.5 * crease + rules::EDGE_END * (1.0 - crease);
            add(0, ends, of);
            add(edge(i), ends, of);
            if crease != 1.0 {
                let far = rules::EDGE_FAR * (1.0 - crease);
                let previous = i + edge_count - 1;
                [edge(i + 1), edge(previous), face(i), face(i + self.face_count - 1)]
                    .into_iter()
                    .for_each(|place| add(place, far, of));
            }
        }
        for i in 0..self.face_count {
            [0, edge(i), edge(i + 1), face(i)].into_iter().for_each(|place| add(place, 0.25, after[face(i)]));
        }
        // Beyond the sector only ends of creases matter.
        for (place, &of) in after.iter().enumerate().skip(ring_end) {
            add(0, 0.5, of);
            add(place, 0.5, of);
        }
        before
    }
}
