//! A mesh of polygons as half-edges, whole or a piece of one: what schemes split, and what their rules look at.

use crate::mesh::{Creasing, INFINITE_SHARPNESS};
use crate::rules::{SemiSharpEdges, child_edge_sharpness, is_semi_sharp, less_sharp};
use crate::scheme::Rules;
use crate::topology::Level;

/// Nothing lies across an edge.
pub(crate) const BORDER: u32 = u32::MAX;
/// What lies across an edge is not part of the piece.
pub(crate) const CUT: u32 = u32::MAX - 1;

/// Half-edge h runs from `origin[h]` to the origin of the next one around its face, counter-clockwise.
#[derive(Clone, Debug, Default)]
pub(crate) struct Poly {
    /// First half-edge of each face, and of none after the last.
    pub first: Vec<u32>,
    /// Face of each half-edge.
    pub face: Vec<u32>,
    /// Vertex where it starts.
    pub origin: Vec<u32>,
    /// Half-edge across, [`BORDER`] or [`CUT`].
    pub twin: Vec<u32>,
    /// Edge of each half-edge.
    pub edge: Vec<u32>,
    /// A half-edge of each edge.
    pub half_of_edge: Vec<u32>,
    /// Of edges; those of one face are infinitely sharp.
    pub edge_sharpness: Vec<f32>,
    /// Of vertices.
    pub vertex_sharpness: Vec<f32>,
    /// A half-edge from each vertex: of open fans the first counter-clockwise. [`BORDER`] for a vertex without faces.
    pub start: Vec<u32>,
    /// Whether all faces at a vertex are there.
    pub is_whole: Vec<bool>,
    /// Rule of creases.
    pub creasing: Creasing,
}

/// What lies around a vertex, counter-clockwise.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fan {
    /// Half-edges from it, one a face.
    pub spokes: Vec<u32>,
    /// Edges: one a spoke, and of an open fan the last one.
    pub edges: Vec<u32>,
    /// Vertices at their other ends.
    pub ends: Vec<u32>,
    /// Whether the last face borders the first.
    pub is_closed: bool,
}

impl Poly {
    /// Completes what `first`, `origin`, `twin` and sharpness of half-edges and vertices say.
    pub fn new(
        first: Vec<u32>,
        origin: Vec<u32>,
        twin: Vec<u32>,
        sharpness: &[f32],
        vertex_sharpness: Vec<f32>,
        creasing: Creasing,
    ) -> Self {
        let mut face = Vec::with_capacity(origin.len());
        for (index, ends) in first.windows(2).enumerate() {
            face.resize(ends[1] as usize, index as u32);
        }
        let vertex_count = vertex_sharpness.len();
        let mut poly = Self {
            first,
            face,
            twin,
            edge: vec![0; origin.len()],
            origin,
            vertex_sharpness,
            start: vec![BORDER; vertex_count],
            is_whole: vec![true; vertex_count],
            creasing,
            ..Self::default()
        };
        for h in 0..poly.origin.len() as u32 {
            let (from, twin) = (poly.origin[h as usize] as usize, poly.twin[h as usize]);
            if poly.start[from] == BORDER || twin >= CUT {
                poly.start[from] = h;
            }
            if twin == CUT {
                poly.is_whole[from] = false;
                let to = poly.head(h) as usize;
                poly.is_whole[to] = false;
            }
            if twin >= CUT || h < twin {
                poly.edge[h as usize] = poly.half_of_edge.len() as u32;
                poly.half_of_edge.push(h);
                poly.edge_sharpness.push(if twin == BORDER { INFINITE_SHARPNESS } else { sharpness[h as usize] });
            } else {
                poly.edge[h as usize] = poly.edge[twin as usize];
            }
        }
        poly
    }

    /// A cage, which must be manifold.
    pub fn of_level(level: &Level, creasing: Creasing) -> Self {
        let half_edges = 0..level.origins.len() as u32;
        let first = (0..level.face_count()).map(|face| level.half_edges(face).start).chain([half_edges.end]).collect();
        let twin = half_edges.clone().map(|h| if level.is_boundary(h) { BORDER } else { level.twin(h) }).collect();
        let sharpness: Vec<f32> = half_edges.map(|h| level.sharpness(h)).collect();
        let vertices = (0..level.tags.len() as u32).map(|vertex| {
            if level.tag(vertex).is_corner() { INFINITE_SHARPNESS } else { level.vertex_sharpness(vertex) }
        });
        let mut poly = Self::new(first, level.origins.clone(), twin, &sharpness, vertices.collect(), creasing);
        // Where more than two infinitely sharp edges meet there is a corner at every level.
        for vertex in 0..poly.vertex_sharpness.len() as u32 {
            let edges = poly.fan(vertex, None).edges;
            let is_infinite = |edge: &&u32| poly.edge_sharpness[**edge as usize] >= INFINITE_SHARPNESS;
            if edges.iter().filter(is_infinite).count() > 2 {
                poly.vertex_sharpness[vertex as usize] = INFINITE_SHARPNESS;
            }
        }
        poly
    }

    pub fn face_count(&self) -> u32 {
        self.first.len() as u32 - 1
    }

    pub fn half_edges(&self, face: u32) -> std::ops::Range<u32> {
        self.first[face as usize]..self.first[face as usize + 1]
    }

    pub fn sides(&self, face: u32) -> u32 {
        self.first[face as usize + 1] - self.first[face as usize]
    }

    pub fn vertices(&self, face: u32) -> &[u32] {
        let range = self.half_edges(face);
        &self.origin[range.start as usize..range.end as usize]
    }

    pub fn next(&self, h: u32) -> u32 {
        let range = self.half_edges(self.face[h as usize]);
        if h + 1 == range.end { range.start } else { h + 1 }
    }

    pub fn previous(&self, h: u32) -> u32 {
        let range = self.half_edges(self.face[h as usize]);
        if h == range.start { range.end - 1 } else { h - 1 }
    }

    pub fn origin(&self, h: u32) -> u32 {
        self.origin[h as usize]
    }

    pub fn head(&self, h: u32) -> u32 {
        self.origin[self.next(h) as usize]
    }

    pub fn twin(&self, h: u32) -> u32 {
        self.twin[h as usize]
    }

    pub fn sharpness(&self, h: u32) -> f32 {
        self.edge_sharpness[self.edge[h as usize] as usize]
    }

    /// The fan of a vertex, from `start` on if that is given; of a whole vertex, or from a half-edge that begins an open fan.
    pub fn fan(&self, vertex: u32, start: Option<u32>) -> Fan {
        let start = start.unwrap_or(self.start[vertex as usize]);
        let mut fan = Fan::default();
        if start == BORDER {
            return fan;
        }
        let mut spoke = start;
        loop {
            fan.spokes.push(spoke);
            fan.edges.push(self.edge[spoke as usize]);
            fan.ends.push(self.head(spoke));
            let back = self.previous(spoke);
            spoke = self.twin(back);
            if spoke == start {
                fan.is_closed = true;
                return fan;
            }
            if spoke >= CUT {
                fan.edges.push(self.edge[back as usize]);
                fan.ends.push(self.origin(back));
                return fan;
            }
        }
    }

    /// Sharpness of the child of half-edge `h`'s edge that lies at its origin.
    fn child_sharpness(&self, h: u32) -> f32 {
        let vertex = self.origin(h);
        let sharpness = self.sharpness(h);
        // Chaikin's rule is about semi-sharp edges alone: most need not look around.
        if self.creasing == Creasing::Uniform || !is_semi_sharp(sharpness) || !self.is_whole[vertex as usize] {
            return less_sharp(sharpness);
        }
        let edges: Vec<f32> = self.fan(vertex, None).edges.iter().map(|&e| self.edge_sharpness[e as usize]).collect();
        child_edge_sharpness(self.creasing, sharpness, SemiSharpEdges::of(&edges).without(sharpness))
    }

    /// Sharpness of the two children of an edge: at the origin of its half-edge, and at the head.
    pub fn children_sharpness(&self, edge: u32) -> [f32; 2] {
        let h = self.half_of_edge[edge as usize];
        // From the other end the edge is the twin, or else the one before the next.
        let at_head = if self.creasing == Creasing::Uniform {
            less_sharp(self.sharpness(h))
        } else if self.twin(h) < CUT {
            self.child_sharpness(self.twin(h))
        } else {
            less_sharp(self.sharpness(h))
        };
        [self.child_sharpness(h), at_head]
    }

    /// The mesh of all children: vertex v stays v, edge e's point is V + e, and face f's, if it has one, follows in their order. Of a
    /// face in corners child i is the one at vertex i; the middle triangle of four is the last.
    pub fn split(&self, is_split_in_triangles: impl Fn(u32) -> bool) -> Self {
        let vertex_count = self.vertex_sharpness.len() as u32;
        let edge_count = self.half_of_edge.len() as u32;
        let mut face_point = vertex_count + edge_count;
        let mut child = ChildFaces::default();
        // First half-edge of the child at each corner.
        let mut corner = Vec::with_capacity(self.origin.len());
        let edge_point = |h: u32| vertex_count + self.edge[h as usize];
        for face in 0..self.face_count() {
            let range = self.half_edges(face);
            let in_triangles = is_split_in_triangles(self.sides(face));
            for h in range.clone() {
                let (own, before) = (edge_point(h), edge_point(self.previous(h)));
                corner.push(child.origin.len() as u32);
                if in_triangles {
                    child.push(&[self.origin(h), own, before]);
                } else {
                    child.push(&[self.origin(h), own, face_point, before]);
                }
            }
            if in_triangles {
                let middles: Vec<u32> = range.map(edge_point).collect();
                child.push(&middles);
            } else {
                face_point += 1;
            }
        }
        let (twin, sharpness) = self.child_edges(&child, &corner, &is_split_in_triangles);
        let mut vertex_sharpness: Vec<f32> = self.vertex_sharpness.iter().map(|&s| less_sharp(s)).collect();
        vertex_sharpness.resize(face_point as usize, 0.0);
        child.first.push(child.origin.len() as u32);
        Self::new(child.first, child.origin, twin, &sharpness, vertex_sharpness, self.creasing)
    }

    /// Twins and sharpness of the children's half-edges; `corner` is the first half-edge of the child at each corner.
    fn child_edges(
        &self,
        child: &ChildFaces,
        corner: &[u32],
        is_split_in_triangles: &impl Fn(u32) -> bool,
    ) -> (Vec<u32>, Vec<f32>) {
        let mut twin = vec![BORDER; child.origin.len()];
        let mut sharpness = vec![0.0; child.origin.len()];
        let sides = |h: u32| if is_split_in_triangles(self.sides(self.face[h as usize])) { 3 } else { 4 };
        let last = |h: u32| corner[h as usize] + sides(h) - 1;
        for h in 0..self.origin.len() as u32 {
            let (across, own) = (self.twin(h), corner[h as usize]);
            let [at_origin, at_head] = self.halves_sharpness(h);
            // The half of the edge from its origin to its middle, and that from its middle on.
            let onward = last(self.next(h));
            twin[own as usize] = if across >= CUT { across } else { last(self.next(across)) };
            twin[onward as usize] = if across >= CUT { across } else { corner[across as usize] };
            sharpness[own as usize] = at_origin;
            sharpness[onward as usize] = at_head;
            let face = self.face[h as usize];
            if sides(h) == 4 {
                // From the edge's point to the face's, and back in the child at the next corner.
                let back = corner[self.next(h) as usize] + 2;
                twin[own as usize + 1] = back;
                twin[back as usize] = own + 1;
            } else {
                let range = self.half_edges(face);
                let middle = corner[range.end as usize - 1] + 3;
                let before = middle + (self.previous(h) - range.start);
                twin[own as usize + 1] = before;
                twin[before as usize] = own + 1;
            }
        }
        (twin, sharpness)
    }

    /// Sharpness of the halves of a half-edge's edge: at its origin and at its head.
    fn halves_sharpness(&self, h: u32) -> [f32; 2] {
        let edge = self.edge[h as usize];
        let [a, b] = self.children_sharpness(edge);
        if self.half_of_edge[edge as usize] == h { [a, b] } else { [b, a] }
    }

    /// Some of the faces as a mesh of their own, and its vertices.
    pub fn piece(&self, faces: &[u32]) -> (Self, Vec<u32>) {
        let mut number = vec![BORDER; self.vertex_sharpness.len()];
        let mut place = vec![CUT; self.origin.len()];
        let (mut first, mut vertices, mut halves) = (Vec::new(), Vec::new(), Vec::new());
        for &face in faces {
            first.push(halves.len() as u32);
            for h in self.half_edges(face) {
                place[h as usize] = halves.len() as u32;
                halves.push(h);
                let vertex = self.origin(h);
                if number[vertex as usize] == BORDER {
                    number[vertex as usize] = vertices.len() as u32;
                    vertices.push(vertex);
                }
            }
        }
        first.push(halves.len() as u32);
        let twin = |&h: &u32| if self.twin(h) >= CUT { self.twin(h) } else { place[self.twin(h) as usize] };
        let sharpness: Vec<f32> = halves.iter().map(|&h| self.sharpness(h)).collect();
        let vertex_sharpness = vertices.iter().map(|&vertex| self.vertex_sharpness[vertex as usize]).collect();
        let origin = halves.iter().map(|&h| number[self.origin(h) as usize]).collect();
        let twins = halves.iter().map(twin).collect();
        (Self::new(first, origin, twins, &sharpness, vertex_sharpness, self.creasing), vertices)
    }

    /// The faces of some vertices, in ascending order.
    pub fn faces_at(&self, vertices: impl IntoIterator<Item = u32>) -> Vec<u32> {
        let mut faces = Vec::new();
        for vertex in vertices {
            if self.is_whole[vertex as usize] {
                // As a fan has them; this is asked for so often that making one would count.
                let start = self.start[vertex as usize];
                let next = |&spoke: &u32| Some(self.twin(self.previous(spoke))).filter(|&h| h < CUT && h != start);
                let spokes = std::iter::successors(Some(start).filter(|&h| h != BORDER), next);
                faces.extend(spokes.map(|spoke| self.face[spoke as usize]));
            } else {
                // Several fans: all that is there.
                let at = (0..self.origin.len()).filter(|&h| self.origin[h] == vertex);
                faces.extend(at.map(|h| self.face[h]));
            }
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Rings of faces that the limit surface of a face depends on. By Chaikin's rule sharpness does so too, of edges one ring further.
    pub fn width(&self, rules: &dyn Rules) -> u32 {
        rules.width() + u32::from(self.creasing == Creasing::Chaikin)
    }

    /// Some faces and those around them, `width` times.
    pub fn ring(&self, faces: &[u32], width: u32) -> Vec<u32> {
        let mut all = faces.to_vec();
        for _ in 0..width {
            let mut vertices: Vec<u32> = all.iter().flat_map(|&face| self.vertices(face).iter().copied()).collect();
            vertices.sort_unstable();
            vertices.dedup();
            all = self.faces_at(vertices);
        }
        all
    }
}

/// Faces as they are made.
#[derive(Default)]
struct ChildFaces {
    first: Vec<u32>,
    origin: Vec<u32>,
}

impl ChildFaces {
    fn push(&mut self, vertices: &[u32]) {
        self.first.push(self.origin.len() as u32);
        self.origin.extend(vertices);
    }
}
