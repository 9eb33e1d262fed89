//! Stencil rows: each new point as a weighted sum of points of the level before (FAS section 3.2, with the face points
//! substituted, so that one kernel a level does all three kinds).
//!
//! The first index of a row is its *origin*: kernels compute p0 + sum w_i (p_i - p0), which keeps the digits of nearby
//! points and makes a row exact under translation whatever the rounding of its weights.

use std::collections::HashMap;

use crate::refine::Split;
use crate::rules::{self, VertexRule};
use crate::sharpness::{SharpnessAtVertex, child_sharpness};
use crate::topology::Level;

/// Faces of more sides have their points made first, in a dispatch of their own: substituting the centre of an n-gon
/// into its n edges and n vertices costs n^2.
pub const MAX_SUBSTITUTED_SIDES: u32 = 8;

/// One row: `count` indices from `first_index` on, weighted by `count` weights from `first_weight` on.
/// Rows of the same rule share their weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StencilRow {
    /// Place in [`StencilTable::indices`].
    pub first_index: u32,
    /// Place in the weights.
    pub first_weight: u32,
    /// Number of points that are summed.
    pub count: u32,
}

/// Rows that make points, in the order of the points that they make.
#[derive(Clone, Debug, Default)]
pub struct StencilTable {
    /// One row a point.
    pub rows: Vec<StencilRow>,
    /// Indices into the points of all levels.
    pub indices: Vec<u32>,
    /// Weights; each row's sum to one.
    pub weights: Vec<f32>,
    /// Where the weights of rows that are not one of the shared rules lie, by their bits.
    interned: HashMap<Vec<u32>, u32>,
}

/// Weights that rows of the same rule share, by the rule's parameter.
#[derive(Debug, Default)]
pub(crate) struct SharedWeights {
    face: Vec<Option<u32>>,
    smooth_vertex: Vec<Option<u32>>,
    smooth_edge: Option<u32>,
    boundary_edge: Option<u32>,
    boundary_vertex: Option<u32>,
    corner: Option<u32>,
}

/// The shared weights for parameter `n`, made on first use.
pub(crate) fn shared<W>(
    cache: &mut Vec<Option<u32>>,
    n: u32,
    weights: &mut Vec<W>,
    make: impl FnOnce(&mut Vec<W>),
) -> u32 {
    let n = n as usize;
    if cache.len() <= n {
        cache.resize(n + 1, None);
    }
    shared_one(&mut cache[n], weights, make)
}

fn shared_one<W>(slot: &mut Option<u32>, weights: &mut Vec<W>, make: impl FnOnce(&mut Vec<W>)) -> u32 {
    *slot.get_or_insert_with(|| {
        let first = weights.len() as u32;
        make(weights);
        first
    })
}

impl StencilTable {
    fn push_row(&mut self, first_index: usize, first_weight: u32) {
        let count = (self.indices.len() - first_index) as u32;
        self.rows.push(StencilRow { first_index: first_index as u32, first_weight, count });
    }

    /// Appends the rows of one split: vertex points, edge points, face points. `first_point` is the place of the
    /// parent level's points among those of all levels, `first_child` that of the new ones.
    pub(crate) fn append_split(
        &mut self,
        parent: &Level,
        split: &Split,
        first_point: u32,
        first_child: u32,
        cache: &mut SharedWeights,
    ) {
        let first_face_point = first_child + (split.vertices.len() + split.edges.len()) as u32;
        let face_points = has_large_faces(parent, split).then(|| face_points(parent, split, first_face_point));
        let mut rows = SplitRows { table: self, parent, first_point, face_points, cache, terms: Vec::new() };
        split.vertices.iter().for_each(|&vertex| rows.vertex(vertex));
        split.edges.iter().for_each(|&edge| rows.edge(edge));
        split.faces.iter().for_each(|&face| rows.face(face));
    }
}

/// Whether a split has faces whose points are not substituted.
pub(crate) fn has_large_faces(parent: &Level, split: &Split) -> bool {
    split.faces.iter().any(|&face| parent.sides(face) > MAX_SUBSTITUTED_SIDES)
}

fn face_points(parent: &Level, split: &Split, first_face_point: u32) -> Vec<u32> {
    let mut points = vec![u32::MAX; parent.face_count() as usize];
    for (i, &face) in (0..).zip(&split.faces) {
        points[face as usize] = first_face_point + i;
    }
    points
}

struct SplitRows<'a> {
    table: &'a mut StencilTable,
    parent: &'a Level,
    first_point: u32,
    /// By face, where face points are made first.
    face_points: Option<Vec<u32>>,
    cache: &'a mut SharedWeights,
    terms: Vec<(u32, f64)>,
}

impl SplitRows<'_> {
    fn face(&mut self, face: u32) {
        let sides = self.parent.sides(face);
        let first = self.table.indices.len();
        self.table.indices.extend(self.parent.vertices(face).iter().map(|v| self.first_point + v));
        let weight = shared(&mut self.cache.face, sides, &mut self.table.weights, |weights| {
            weights.extend((0..sides).map(|_| (1.0 / f64::from(sides)) as f32));
        });
        self.table.push_row(first, weight);
    }

    fn edge(&mut self, half_edge: u32) {
        let (parent, twin) = (self.parent, self.parent.twin(half_edge));
        let ends = [parent.origin(half_edge), parent.head(half_edge)];
        let sharpness = parent.sharpness(half_edge);
        let crease = if twin == half_edge {
            1.0
        } else if sharpness > 0.0 {
            rules::edge_crease_weight(sharpness, child_sharpness(parent, half_edge))
        } else {
            0.0
        };
        let first = self.table.indices.len();
        if crease == 1.0 {
            self.table.indices.extend(ends.map(|v| self.first_point + v));
            let weight = shared_one(&mut self.cache.boundary_edge, &mut self.table.weights, |w| w.extend([0.5, 0.5]));
            return self.table.push_row(first, weight);
        }
        let faces = [parent.face(half_edge), parent.face(twin)];
        let sides = faces.map(|face| parent.sides(face));
        if crease != 0.0 || sides != [4, 4] {
            let face_weight = rules::edge_face_weight(parent.options.triangles, sides) * (1.0 - crease);
            ends.iter().for_each(|&v| self.terms.push((self.first_point + v, 0.5 - face_weight)));
            faces.iter().for_each(|&face| self.add_face_point(face, face_weight));
            return self.merge_terms(self.first_point + ends[0]);
        }
        let far = [half_edge, twin].map(|h| {
            let opposite = parent.next(parent.next(h));
            [parent.origin(opposite), parent.head(opposite)]
        });
        self.table.indices.extend(ends.iter().chain(far.as_flattened()).map(|v| self.first_point + v));
        let weight = shared_one(&mut self.cache.smooth_edge, &mut self.table.weights, |weights| {
            let (near, far) = (rules::EDGE_END as f32, rules::EDGE_FAR as f32);
            weights.extend([near, near, far, far, far, far]);
        });
        self.table.push_row(first, weight);
    }

    fn vertex(&mut self, vertex: u32) {
        let tag = self.parent.tag(vertex);
        if tag.is_corner() {
            return self.corner(vertex);
        }
        if !tag.is_plain() {
            return self.vertex_with_creases(vertex);
        }
        if tag.is_boundary() {
            return self.crease(vertex, boundary_neighbours(self.parent, vertex));
        }
        if !tag.touches_only_quads() {
            self.add_smooth_vertex(vertex, 1.0);
            return self.merge_terms(self.first_point + vertex);
        }
        let first = self.table.indices.len();
        self.table.indices.push(self.first_point + vertex);
        for spoke in self.parent.spokes(vertex) {
            let ring = ring_pair(self.parent, spoke);
            self.table.indices.extend(ring.map(|v| self.first_point + v));
        }
        let valence = (self.table.indices.len() - first) as u32 / 2;
        let weight = shared(&mut self.cache.smooth_vertex, valence, &mut self.table.weights, |weights| {
            let mask = rules::smooth_vertex(valence);
            weights.push(mask.vertex as f32);
            weights.extend((0..valence).flat_map(|_| [mask.edge as f32, mask.face as f32]));
        });
        self.table.push_row(first, weight);
    }

    fn corner(&mut self, vertex: u32) {
        let first = self.table.indices.len();
        self.table.indices.push(self.first_point + vertex);
        let weight = shared_one(&mut self.cache.corner, &mut self.table.weights, |w| w.push(1.0));
        self.table.push_row(first, weight);
    }

    fn crease(&mut self, vertex: u32, ends: [u32; 2]) {
        let first = self.table.indices.len();
        self.table.indices.extend([vertex, ends[0], ends[1]].map(|v| self.first_point + v));
        let weight = shared_one(&mut self.cache.boundary_vertex, &mut self.table.weights, |weights| {
            let end = rules::CREASE_END as f32;
            weights.extend([1.0 - 2.0 * end, end, end]);
        });
        self.table.push_row(first, weight);
    }

    fn vertex_with_creases(&mut self, vertex: u32) {
        let sharpness = SharpnessAtVertex::of(self.parent, vertex);
        let blend = sharpness.blend(self.parent.options.creasing);
        if blend.weight == 1.0 {
            match blend.before {
                (VertexRule::Corner, _) => return self.corner(vertex),
                (VertexRule::Crease, ends) => return self.crease(vertex, ends.map(|end| sharpness.ends[end])),
                (VertexRule::Smooth | VertexRule::Dart, _) => {}
            }
        }
        for ((rule, ends), weight) in [(blend.before, blend.weight), (blend.after, 1.0 - blend.weight)] {
            if weight == 0.0 {
                continue;
            }
            match rule {
                VertexRule::Corner => self.terms.push((self.first_point + vertex, weight)),
                VertexRule::Crease => {
                    self.terms.push((self.first_point + vertex, (1.0 - 2.0 * rules::CREASE_END) * weight));
                    let ends = ends.map(|end| (self.first_point + sharpness.ends[end], rules::CREASE_END * weight));
                    self.terms.extend(ends);
                }
                VertexRule::Smooth | VertexRule::Dart => self.add_smooth_vertex(vertex, weight),
            }
        }
        self.merge_terms(self.first_point + vertex);
    }

    /// Adds the smooth vertex rule, times a weight.
    fn add_smooth_vertex(&mut self, vertex: u32, weight: f64) {
        let valence = self.parent.spokes(vertex).count();
        let n = valence as f64;
        self.terms.push((self.first_point + vertex, weight * (n - 2.0) / n));
        for spoke in self.parent.spokes(vertex) {
            self.terms.push((self.first_point + self.parent.head(spoke), weight / (n * n)));
            self.add_face_point(self.parent.face(spoke), weight / (n * n));
        }
    }

    fn add_face_point(&mut self, face: u32, weight: f64) {
        if let Some(points) = &self.face_points {
            return self.terms.push((points[face as usize], weight));
        }
        let vertices = self.parent.vertices(face);
        let each = weight / vertices.len() as f64;
        self.terms.extend(vertices.iter().map(|v| (self.first_point + v, each)));
    }

    /// Turns the collected terms into a row; `origin` comes first, each point once.
    fn merge_terms(&mut self, origin: u32) {
        let first = self.table.indices.len();
        self.terms.sort_by_key(|&(point, _)| (point != origin, point));
        let mut weights = Vec::new();
        for same in self.terms.chunk_by(|a, b| a.0 == b.0) {
            self.table.indices.push(same[0].0);
            weights.push(same.iter().map(|term| term.1).sum::<f64>() as f32);
        }
        self.terms.clear();
        let first_weight = intern(&mut self.table.interned, &mut self.table.weights, weights);
        self.table.push_row(first, first_weight);
    }
}

/// Where these weights lie in a table: where they lie already, or at its end.
fn intern(interned: &mut HashMap<Vec<u32>, u32>, table: &mut Vec<f32>, weights: Vec<f32>) -> u32 {
    let bits = weights.iter().map(|weight| weight.to_bits()).collect();
    *interned.entry(bits).or_insert_with(|| {
        let first = table.len() as u32;
        table.extend(weights);
        first
    })
}

/// The two neighbours along the boundary: at the end of the first spoke and at the start of the last face's incoming edge.
pub(crate) fn boundary_neighbours(level: &Level, vertex: u32) -> [u32; 2] {
    let start = level.starts[vertex as usize];
    let last = level.spokes(vertex).last().unwrap_or(start);
    [level.head(start), level.origin(level.previous(last))]
}

/// Of a spoke in a quad: the vertex at its end and the one opposite in the face to its left.
pub(crate) fn ring_pair(level: &Level, spoke: u32) -> [u32; 2] {
    let next = level.next(spoke);
    [level.origin(next), level.head(next)]
}
