//! One channel on one level: which value each corner has, where the seams are, and the rules at level 0.

use std::collections::{HashMap, HashSet};

use super::rule::{Rule, ValueRule};
use crate::mesh::{BoundaryInterpolation, FaceVaryingChannel, FaceVaryingInterpolation};
use crate::rules::is_semi_sharp;
use crate::topology::Level;

/// One channel on one level. A value belongs to one vertex; a vertex has several where seams end.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChannelLevel {
    /// Value of each half-edge's origin in its face.
    pub corners: Vec<u32>,
    /// The values.
    pub values: Vec<[f64; 2]>,
    /// Half-edges of seams; empty if there are none.
    pub(super) seams: Vec<bool>,
    /// The rule of each value at a vertex where a seam ends, or whose boundary has rules of the channel's own. Those of
    /// all other values are their vertices'.
    pub(super) rules: HashMap<u32, ValueRule>,
    /// Bilinear in faces: values stay, and edges and faces have the averages of their corners.
    pub is_linear: bool,
}

/// What lies between the two ends of a value's faces at a vertex.
#[derive(Clone, Debug, Default)]
struct Span {
    start: u32,
    face_count: u32,
    /// Its faces hang together in no or in several ways: other values lie between them, or a seam.
    is_disjoint: bool,
    has_infinite_edge: bool,
    has_semi_sharp_edge: bool,
}

impl ChannelLevel {
    /// A mesh's channel on level 0.
    pub fn of_mesh(level: &Level, channel: &FaceVaryingChannel) -> Self {
        let mode = level.options.face_varying;
        let is_linear = mode == FaceVaryingInterpolation::All;
        let mut of_level = Self { corners: vec![0; level.origins.len()], is_linear, ..Self::default() };
        let mut numbers = Numbers::default();
        for vertex in used_vertices(level) {
            numbers.begin(level.tag(vertex).is_non_manifold());
            for spoke in level.all_spokes(vertex) {
                let index = channel.indices[spoke as usize];
                let next = of_level.values.len() as u32;
                let number = numbers.number(index, next);
                if number == next {
                    of_level.values.push(channel.values[index as usize].map(f64::from));
                }
                of_level.corners[spoke as usize] = number;
            }
        }
        of_level.find_seams(level);
        if !is_linear {
            for vertex in used_vertices(level) {
                if of_level.has_own_rules(level, vertex) {
                    of_level.add_rules(level, vertex);
                }
            }
        }
        of_level
    }

    /// Whether values at a half-edge's edge differ on its two sides, or did so where it is a part of.
    pub fn is_seam(&self, half_edge: u32) -> bool {
        self.seams.get(half_edge as usize).copied().unwrap_or(false)
    }

    /// The distinct values at a vertex, counter-clockwise.
    pub(super) fn values_at(&self, level: &Level, vertex: u32) -> Vec<u32> {
        let mut values: Vec<u32> = level.all_spokes(vertex).map(|spoke| self.corners[spoke as usize]).collect();
        values.dedup();
        if values.len() > 2 || values.first() == values.last() {
            let mut met = HashSet::new();
            values.retain(|&value| met.insert(value));
        }
        values
    }

    /// Whether the values at all corners of a face follow their vertices' rules.
    pub fn follows_vertices(&self, level: &Level, face: u32) -> bool {
        level.half_edges(face).all(|corner| !self.rules.contains_key(&self.corners[corner as usize]))
    }

    /// The vertices around which the channel is not cut as a regular boundary or corner has it.
    pub fn irregular_vertices<'a>(&'a self, level: &'a Level) -> impl Iterator<Item = u32> + 'a {
        let is_concerned = !self.rules.is_empty();
        used_vertices(level).filter(move |&vertex| is_concerned && !self.is_regular_at(level, vertex))
    }

    fn find_seams(&mut self, level: &Level) {
        let mut seams = vec![false; level.origins.len()];
        for half_edge in 0..level.origins.len() as u32 {
            let twin = level.twin(half_edge);
            if twin != half_edge {
                seams[half_edge as usize] = self.end_values(level, half_edge) != self.end_values(level, twin);
                continue;
            }
            let shared = level.sharing(&half_edge);
            let own = self.end_values(level, half_edge);
            seams[half_edge as usize] = shared.iter().any(|&other| self.end_values(level, other) != own);
        }
        if seams.contains(&true) {
            self.seams = seams;
        }
    }

    /// The values at both ends of a half-edge in its face, that of the lower vertex first.
    fn end_values(&self, level: &Level, half_edge: u32) -> [u32; 2] {
        let next = level.next(half_edge);
        let [a, b] = [half_edge, next].map(|corner| self.corners[corner as usize]);
        if level.origin(half_edge) < level.origin(next) { [a, b] } else { [b, a] }
    }

    /// Whether the values at a vertex do not follow the vertex' rules.
    fn has_own_rules(&self, level: &Level, vertex: u32) -> bool {
        let mode = level.options.face_varying;
        let edges = level.incident_edges(vertex);
        if edges.iter().any(|&edge| self.is_seam(edge)) {
            return true;
        }
        if edges.iter().any(|&edge| level.is_boundary(edge)) {
            let is_topological_corner = level.all_spokes(vertex).nth(1).is_none();
            let is_smooth_corner = level.options.boundary != BoundaryInterpolation::EdgeAndCorner;
            if mode == FaceVaryingInterpolation::Boundaries
                || (is_topological_corner && is_smooth_corner && mode != FaceVaryingInterpolation::None)
            {
                return true;
            }
        }
        level.tag(vertex).is_non_manifold() && self.values_at(level, vertex).len() > 1
    }

    /// Adds the rules of all values at a vertex that has its own (OpenSubdiv's `completeTopologyFromFaceValues`).
    fn add_rules(&mut self, level: &Level, vertex: u32) {
        use FaceVaryingInterpolation::{Boundaries, CornersPlus1, CornersPlus2};
        let mode = level.options.face_varying;
        let (tag, values) = (level.tag(vertex), self.values_at(level, vertex));
        if tag.is_non_manifold() {
            for spoke in level.all_spokes(vertex) {
                let rule = ValueRule { rule: Rule::Corner, start: spoke, face_count: 1 };
                self.rules.insert(self.corners[spoke as usize], rule);
            }
            return;
        }
        let spans = self.spans(level, vertex, &values);
        let is_dependent = matches!(mode, CornersPlus1 | CornersPlus2);
        let sharpens_darts = matches!(mode, CornersPlus2 | Boundaries);
        let mut all_corners = mode == Boundaries
            || tag.is_corner()
            || (is_dependent && values.len() > 2)
            || (sharpens_darts && values.len() == 1 && !tag.is_boundary());
        let mut one_decays = false;
        if let (true, [a, b]) = (is_dependent, spans.as_slice()) {
            let is_sharp = |span: &Span| span.has_infinite_edge || span.is_disjoint;
            all_corners |= is_sharp(a) || is_sharp(b);
            all_corners |= mode == CornersPlus2 && (a.face_count == 1 || b.face_count == 1);
            one_decays = a.has_semi_sharp_edge != b.has_semi_sharp_edge;
        }
        for (value, span) in values.into_iter().zip(spans) {
            let is_corner = all_corners
                || span.is_disjoint
                || span.has_infinite_edge
                || (span.face_count == 1 && mode != FaceVaryingInterpolation::None);
            let rule = if is_corner {
                Rule::Corner
            } else if span.has_semi_sharp_edge || is_semi_sharp(level.vertex_sharpness(vertex)) {
                Rule::SemiSharp { is_dependent: false }
            } else if one_decays {
                Rule::SemiSharp { is_dependent: true }
            } else {
                Rule::Crease
            };
            self.rules.insert(value, ValueRule { rule, start: span.start, face_count: span.face_count });
        }
    }

    /// The spans of the values at a manifold vertex.
    fn spans(&self, level: &Level, vertex: u32, values: &[u32]) -> Vec<Span> {
        let spokes: Vec<u32> = level.spokes(vertex).collect();
        let is_open = level.is_unpaired(spokes[0]);
        let place_of: HashMap<u32, usize> = values.iter().enumerate().map(|(place, &value)| (value, place)).collect();
        let place = |i: usize| place_of[&self.corners[spokes[i] as usize]];
        let mut spans = vec![Span::default(); values.len()];
        let mut begin_counts = vec![0; values.len()];
        for i in 0..spokes.len() {
            let previous = (i + spokes.len() - 1) % spokes.len();
            let span = &mut spans[place(i)];
            span.face_count += 1;
            let sharpness = level.sharpness(spokes[i]);
            // A single value all around begins at its seam.
            let is_seam = self.is_seam(spokes[i]);
            let begins =
                (is_open && i == 0) || place(previous) != place(i) || (is_seam && values.len() == 1 && !is_open);
            if begins {
                span.start = spokes[i];
                begin_counts[place(i)] += 1;
            } else if is_seam {
                span.is_disjoint = true;
            } else {
                span.has_infinite_edge |= level.is_infinite(spokes[i]);
                span.has_semi_sharp_edge |= is_semi_sharp(sharpness);
            }
        }
        for (span, begin_count) in spans.iter_mut().zip(begin_counts) {
            span.is_disjoint |= begin_count != 1;
        }
        spans
    }

    /// Whether the values at a vertex are those of regular boundaries and corners, or follow the vertex.
    fn is_regular_at(&self, level: &Level, vertex: u32) -> bool {
        let rule_of = |spoke: u32| self.rules.get(&self.corners[spoke as usize]);
        level.all_spokes(vertex).all(|spoke| match rule_of(spoke) {
            None => true,
            Some(ValueRule { rule: Rule::Corner, .. }) => {
                let incoming = level.previous(spoke);
                self.is_cut(level, spoke) && self.is_cut(level, incoming)
            }
            Some(value) => value.face_count == 2,
        })
    }

    /// Whether the channel's surface has a boundary along a half-edge.
    pub(super) fn is_cut(&self, level: &Level, half_edge: u32) -> bool {
        self.is_seam(half_edge) || level.is_infinite(half_edge)
    }
}

fn used_vertices(level: &Level) -> impl Iterator<Item = u32> + '_ {
    (0..level.starts.len() as u32).filter(|&vertex| level.starts[vertex as usize] != crate::topology::NONE)
}

/// Numbers the values that the faces around a vertex name in turn, each as often as it begins anew in OpenSubdiv's eyes:
/// of faces that name a, b, a and b the last one has a value of its own.
#[derive(Default)]
struct Numbers {
    known: HashMap<u32, u32>,
    first: Option<u32>,
    previous: Option<(u32, u32)>,
    /// Values so far.
    count: usize,
    has_order: bool,
}

impl Numbers {
    /// Begins with another vertex. Where it is not manifold the faces have no order, and all values are corners.
    fn begin(&mut self, is_non_manifold: bool) {
        self.known.clear();
        (self.first, self.previous, self.count) = (None, None, 0);
        self.has_order = !is_non_manifold;
    }

    /// The number of the value that the next face names: `next` if it is a new one.
    fn number(&mut self, index: u32, next: u32) -> u32 {
        let number = match self.previous {
            Some((previous, number)) if previous == index => number,
            _ => {
                let first = *self.first.get_or_insert(index);
                let is_taken_for_new = self.has_order && self.count == 2 && first != index;
                let known = self.known.get(&index).copied().filter(|_| !is_taken_for_new);
                known.unwrap_or_else(|| {
                    self.known.entry(index).or_insert(next);
                    self.count += 1;
                    next
                })
            }
        };
        self.previous = Some((index, number));
        number
    }
}
