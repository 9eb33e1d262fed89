//! One level of a mesh as half-edges: who borders whom, and where each face lies on the base mesh.
//!
//! A half-edge `h` runs from `origins[h]` to the origin of the next one around its face, counter-clockwise.
//! `twins[h]` is the half-edge of the neighbouring face, `h` itself on the boundary, and [`NONE`] where a level does
//! not hold the neighbour: a refined level holds the faces that are drawn or refined further and, around them, the
//! faces that support them.

use std::collections::{HashMap, HashSet};

use crate::mesh::{Creasing, INFINITE_SHARPNESS, MeshOptions};
use crate::rules::{SemiSharpEdges, is_semi_sharp};
pub use crate::vertex_tag::VertexTag;

/// "There is none", for any index.
pub const NONE: u32 = u32::MAX;

/// Where a face lies: the square of side 2^-depth whose lower corner is (u, v) 2^-depth, in a Ptex face's domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Location {
    /// Ptex face: a quad is one, an n-gon n in a row.
    pub ptex_face: u32,
    /// Lower corner, in units of 2^-depth.
    pub u: u16,
    /// Lower corner, in units of 2^-depth.
    pub v: u16,
    /// Number of halvings of the Ptex face.
    pub depth: u8,
}

impl Location {
    /// The quarter that holds corner `i` (0 at (0,0), then counter-clockwise).
    pub fn quarter(self, i: u32) -> Self {
        Self {
            u: 2 * self.u + u16::from(i == 1 || i == 2),
            v: 2 * self.v + u16::from(i >= 2),
            depth: self.depth + 1,
            ..self
        }
    }
}

/// Which half-edges belong to which face.
#[derive(Clone, Debug)]
pub(crate) enum Faces {
    /// Face f has the half-edges 4 f to 4 f + 3.
    Quads,
    /// Face f has the half-edges `first[f]` to `first[f + 1] - 1`; `of[h]` is h's face.
    Mixed { first: Vec<u32>, of: Vec<u32> },
}

/// The half-edges of one level.
#[derive(Clone, Debug)]
pub struct Level {
    pub(crate) faces: Faces,
    /// Vertex at the start of each half-edge.
    pub origins: Vec<u32>,
    /// Half-edge on the other side, itself on the boundary and on an edge that is not manifold, [`NONE`] where that is
    /// not part of this level.
    pub twins: Vec<u32>,
    /// A half-edge that starts at the vertex; on the boundary the one that is a boundary edge, so that turning
    /// counter-clockwise from it meets every face (of the first fan, if there are several). [`NONE`] for a vertex that
    /// no face uses.
    pub starts: Vec<u32>,
    /// Rules at each vertex.
    pub tags: Vec<VertexTag>,
    /// Edges of more than two faces and vertices of several fans, where there are any.
    pub(crate) non_manifold: Option<Box<NonManifold>>,
    /// Sharpness of each half-edge's edge as it was given, without what boundaries add; empty if all are smooth.
    pub(crate) edge_sharpness: Vec<f32>,
    /// Sharpness of each vertex that is not infinitely sharp; empty if all are smooth.
    pub(crate) vertex_sharpness: Vec<f32>,
    /// The semi-sharp edges at each vertex, for Chaikin's rule; else empty.
    pub(crate) semi_sharp_edges: Vec<SemiSharpEdges>,
    /// The mesh's.
    pub(crate) options: MeshOptions,
    /// Faces `0..drawn_count` belong to the surface, unless `hidden` says otherwise; the rest only support them.
    pub drawn_count: u32,
    /// Faces that are holes or have no limit surface; empty if there are none.
    pub hidden: Vec<bool>,
    /// Where each of the `drawn_count` faces lies.
    pub locations: Vec<Location>,
}

impl Level {
    /// A level of quads.
    pub(crate) fn of_quads(origins: Vec<u32>, twins: Vec<u32>) -> Self {
        Self {
            faces: Faces::Quads,
            origins,
            twins,
            starts: Vec::new(),
            tags: Vec::new(),
            non_manifold: None,
            edge_sharpness: Vec::new(),
            vertex_sharpness: Vec::new(),
            semi_sharp_edges: Vec::new(),
            options: MeshOptions::default(),
            drawn_count: 0,
            hidden: Vec::new(),
            locations: Vec::new(),
        }
    }

    /// Number of faces.
    pub fn face_count(&self) -> u32 {
        match &self.faces {
            Faces::Quads => self.origins.len() as u32 / 4,
            Faces::Mixed { first, .. } => first.len() as u32 - 1,
        }
    }

    /// The half-edges of a face, from its first vertex on.
    pub fn half_edges(&self, face: u32) -> std::ops::Range<u32> {
        match &self.faces {
            Faces::Quads => 4 * face..4 * face + 4,
            Faces::Mixed { first, .. } => first[face as usize]..first[face as usize + 1],
        }
    }

    /// Number of sides of a face.
    pub fn sides(&self, face: u32) -> u32 {
        let edges = self.half_edges(face);
        edges.end - edges.start
    }

    /// Vertices of a face.
    pub fn vertices(&self, face: u32) -> &[u32] {
        let edges = self.half_edges(face);
        &self.origins[edges.start as usize..edges.end as usize]
    }

    /// The face that a half-edge runs around.
    pub fn face(&self, half_edge: u32) -> u32 {
        match &self.faces {
            Faces::Quads => half_edge / 4,
            Faces::Mixed { of, .. } => of[half_edge as usize],
        }
    }

    /// The next half-edge around the face.
    pub fn next(&self, half_edge: u32) -> u32 {
        match &self.faces {
            Faces::Quads => half_edge & !3 | (half_edge + 1) & 3,
            Faces::Mixed { first, of } => {
                let face = of[half_edge as usize] as usize;
                if half_edge + 1 == first[face + 1] { first[face] } else { half_edge + 1 }
            }
        }
    }

    /// The previous half-edge around the face.
    pub fn previous(&self, half_edge: u32) -> u32 {
        match &self.faces {
            Faces::Quads => half_edge & !3 | (half_edge + 3) & 3,
            Faces::Mixed { first, of } => {
                let face = of[half_edge as usize] as usize;
                if half_edge == first[face] { first[face + 1] - 1 } else { half_edge - 1 }
            }
        }
    }

    /// Vertex at the start.
    pub fn origin(&self, half_edge: u32) -> u32 {
        self.origins[half_edge as usize]
    }

    /// Vertex at the end.
    pub fn head(&self, half_edge: u32) -> u32 {
        self.origin(self.next(half_edge))
    }

    /// Half-edge on the other side; itself on the boundary.
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.twins[half_edge as usize]
    }

    /// Whether the half-edge has no twin: it is on the boundary, or its edge is not manifold.
    pub fn is_unpaired(&self, half_edge: u32) -> bool {
        self.twin(half_edge) == half_edge
    }

    /// Whether no face lies on the other side.
    pub fn is_boundary(&self, half_edge: u32) -> bool {
        self.is_unpaired(half_edge) && self.sharing(&half_edge).len() == 1
    }

    /// The half-edges that share an unpaired half-edge's edge, itself among them: more than one where the edge is not
    /// manifold.
    pub(crate) fn sharing<'a>(&'a self, half_edge: &'a u32) -> &'a [u32] {
        let shared = self.non_manifold.as_ref().and_then(|parts| parts.shared_edge(*half_edge));
        shared.unwrap_or(std::slice::from_ref(half_edge))
    }

    /// The rules at a vertex.
    pub fn tag(&self, vertex: u32) -> VertexTag {
        self.tags[vertex as usize]
    }

    /// Whether the face belongs to the surface (and is not just support, a hole, or without a limit).
    pub fn is_drawn(&self, face: u32) -> bool {
        face < self.drawn_count && !self.hidden.get(face as usize).copied().unwrap_or(false)
    }

    /// Whether the face's limit is one bicubic patch: a quad of regular vertices (algorithms: FAS section 3.3).
    pub fn is_regular(&self, face: u32) -> bool {
        self.sides(face) == 4 && self.vertices(face).iter().all(|&v| self.tag(v).is_regular())
    }

    /// Where a crease of one semi-sharp sharpness passes an otherwise regular face along one of its edges: the place of
    /// that edge in the face, and its sharpness (Niessner, Loop and Greiner 2012). With Chaikin's rule sharpness varies
    /// along the crease, so there is none.
    pub fn single_crease(&self, face: u32) -> Option<(u32, f32)> {
        if self.edge_sharpness.is_empty() || self.sides(face) != 4 || self.options.creasing != Creasing::Uniform {
            return None;
        }
        let corners = self.half_edges(face);
        let is_regular_inside = |corner: u32| {
            let tag = self.tag(self.origin(corner));
            let is_inside = !tag.is_boundary() && !tag.is_corner() && !tag.is_non_manifold();
            is_inside && !tag.is_extraordinary() && tag.touches_only_quads()
        };
        if !corners.clone().all(is_regular_inside) {
            return None;
        }
        let mut creased = corners.clone().filter(|&half_edge| self.sharpness(half_edge) > 0.0);
        let half_edge = creased.next().filter(|_| creased.next().is_none())?;
        let sharpness = self.sharpness(half_edge);
        if !is_semi_sharp(sharpness) {
            return None;
        }
        let passes = |corner: u32| {
            let vertex = self.origin(corner);
            let edges: Vec<u32> = self.spokes(vertex).collect();
            let mut sharp = edges.iter().enumerate().filter(|&(_, &edge)| self.sharpness(edge) > 0.0);
            let (first, second) = (sharp.next(), sharp.next());
            let is_straight = matches!((first, second), (Some((a, _)), Some((b, _))) if b == a + 2);
            let is_even = edges.iter().all(|&edge| [0.0, sharpness].contains(&self.sharpness(edge)));
            is_straight && is_even && sharp.next().is_none() && self.vertex_sharpness(vertex) == 0.0
        };
        let is_smooth = |corner: u32| self.tag(self.origin(corner)).is_plain();
        let next = self.next(half_edge);
        let opposite = [self.next(next), self.previous(half_edge)];
        let is_single = passes(half_edge) && passes(next) && opposite.into_iter().all(is_smooth);
        is_single.then_some((half_edge - corners.start, sharpness))
    }

    /// Whether infinitely sharp edges cut the faces around a vertex into parts like those of a regular boundary (two faces
    /// along a crease) or of a regular corner (one face).
    ///
    /// It takes all of them: a patch may not border one two levels finer across a crease either.
    pub(crate) fn has_regular_sectors(&self, vertex: u32, is_corner: bool) -> bool {
        let infinite_count = self.incident_edges(vertex).iter().filter(|&&edge| self.is_infinite(edge)).count();
        let regular_face_count = match infinite_count {
            0 | 1 => return false,
            2 if !is_corner => 2,
            _ => 1,
        };
        self.fans(vertex).iter().all(|&start| {
            let spokes: Vec<u32> = self.spokes_from(start).collect();
            let cuts: Vec<usize> = (0..spokes.len()).filter(|&i| self.is_infinite(spokes[i])).collect();
            // Around a closed fan the last part ends where the first begins.
            let wrapped = cuts.first().map(|first| first + spokes.len());
            let ends = cuts.iter().copied().skip(1).chain(wrapped);
            // A single part may lie between both sides of one edge.
            let last = spokes.last().map_or(start, |&spoke| self.previous(spoke));
            let is_slit = cuts.len() == 1 && (!self.is_unpaired(start) || self.sharing(&start).contains(&last));
            !cuts.is_empty() && !is_slit && cuts.iter().zip(ends).all(|(begin, end)| end - begin == regular_face_count)
        })
    }

    /// Number of edges of more than two faces, or of two that run the same way along it.
    pub fn non_manifold_edge_count(&self) -> usize {
        self.non_manifold.as_ref().map_or(0, |parts| parts.shared_edges.len())
    }

    /// The outgoing half-edges of a vertex, counter-clockwise; on the boundary from the boundary edge on.
    /// The vertex must have all its faces in this level. Where it is not manifold these are those of the first fan.
    pub fn spokes(&self, vertex: u32) -> Spokes<'_> {
        self.spokes_from(self.starts[vertex as usize])
    }

    pub(crate) fn spokes_from(&self, start: u32) -> Spokes<'_> {
        Spokes { level: self, start, current: start }
    }

    /// The first outgoing half-edge of each fan of a vertex.
    pub(crate) fn fans(&self, vertex: u32) -> &[u32] {
        let several = self.non_manifold.as_ref().and_then(|parts| parts.fans.get(&vertex));
        several.map_or(std::slice::from_ref(&self.starts[vertex as usize]), Vec::as_slice)
    }

    /// The outgoing half-edges of all fans of a vertex.
    pub(crate) fn all_spokes(&self, vertex: u32) -> impl Iterator<Item = u32> {
        self.fans(vertex).iter().flat_map(|&start| self.spokes_from(start))
    }

    /// One half-edge of each edge at a vertex: the outgoing one where there is one.
    pub fn incident_edges(&self, vertex: u32) -> Vec<u32> {
        let mut edges = Vec::new();
        for &start in self.fans(vertex) {
            let first = edges.len();
            edges.extend(self.spokes_from(start));
            if let Some(&last) = edges[first..].last() {
                let incoming = self.previous(last);
                if self.is_unpaired(incoming) {
                    edges.push(incoming);
                }
            }
        }
        if self.non_manifold.is_some() {
            let mut seen = HashSet::new();
            edges.retain(|edge| {
                let shared = self.sharing(edge);
                shared.len() == 1 || seen.insert(shared[0])
            });
        }
        edges
    }

    /// The vertex at the other end of a half-edge that starts or ends at this one.
    pub(crate) fn other_end(&self, half_edge: u32, vertex: u32) -> u32 {
        let origin = self.origin(half_edge);
        if origin == vertex { self.head(half_edge) } else { origin }
    }

    /// Sums up the semi-sharp edges at each vertex, after sharpness has changed.
    pub(crate) fn sum_semi_sharp_edges(&mut self) {
        self.semi_sharp_edges.clear();
        if self.options.creasing == Creasing::Uniform || self.edge_sharpness.is_empty() {
            return;
        }
        self.semi_sharp_edges.resize(self.starts.len(), SemiSharpEdges::default());
        for half_edge in 0..self.origins.len() as u32 {
            // Once an edge; NONE, where the level does not hold the other side, is the largest number.
            if half_edge < self.twin(half_edge) {
                let sharpness = self.edge_sharpness[half_edge as usize];
                for end in [self.origin(half_edge), self.head(half_edge)] {
                    self.semi_sharp_edges[end as usize].add(sharpness);
                }
            }
        }
    }

    /// Sharpness of a half-edge's edge: infinite on the boundary and where the edge is not manifold.
    pub fn sharpness(&self, half_edge: u32) -> f32 {
        if self.is_unpaired(half_edge) {
            return INFINITE_SHARPNESS;
        }
        self.edge_sharpness.get(half_edge as usize).copied().unwrap_or(0.0)
    }

    pub(crate) fn is_infinite(&self, half_edge: u32) -> bool {
        self.sharpness(half_edge) >= INFINITE_SHARPNESS
    }

    /// Sharpness of a vertex: infinite if it is a corner.
    pub fn vertex_sharpness(&self, vertex: u32) -> f32 {
        if self.tag(vertex).is_corner() {
            return INFINITE_SHARPNESS;
        }
        self.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0)
    }

    /// The part of a vertex' faces that holds this corner (its outgoing half-edge): all of its fan, or what two
    /// infinitely sharp edges cut out. A single such edge (a dart) cuts nothing.
    pub(crate) fn sector(&self, corner: u32) -> Sector {
        let vertex = self.origin(corner);
        let mut first = corner;
        let mut is_closed = false;
        while !self.is_infinite(first) {
            first = self.next(self.twin(first));
            if first == corner {
                is_closed = true;
                break;
            }
        }
        let mut spokes = vec![first];
        loop {
            let incoming = self.previous(spokes[spokes.len() - 1]);
            if self.is_infinite(incoming) {
                break;
            }
            let turned = self.twin(incoming);
            if turned == first {
                break;
            }
            spokes.push(turned);
        }
        // The same sector has the same first spoke, whichever corner it is asked for. Both sides of one edge: a dart.
        let is_dart =
            !is_closed && !self.is_unpaired(first) && self.twin(self.previous(spokes[spokes.len() - 1])) == first;
        if is_closed {
            let starts = self.fans(vertex);
            let at = spokes.iter().position(|spoke| starts.contains(spoke)).unwrap_or(0);
            spokes.rotate_left(at);
        }
        Sector { spokes, is_closed: is_closed || is_dart }
    }
}

/// Faces around a vertex that share one limit rule and normal, counter-clockwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Sector {
    /// The outgoing half-edge of each face.
    pub spokes: Vec<u32>,
    /// All around the vertex, from the sharp edge on if it is a dart; else the first spoke's edge and the last face's
    /// other edge are infinitely sharp.
    pub is_closed: bool,
}

/// Where a level is not manifold.
#[derive(Clone, Debug, Default)]
pub(crate) struct NonManifold {
    /// Half-edges of each edge that is not manifold: all that join the same two vertices.
    pub shared_edges: Vec<Vec<u32>>,
    /// Place of a half-edge among the shared edges.
    places: HashMap<u32, u32>,
    /// Vertices that are not manifold, and where each of their fans starts.
    pub fans: HashMap<u32, Vec<u32>>,
    /// Those of them that lie within a crease; the others are corners.
    pub creases: HashSet<u32>,
}

impl NonManifold {
    pub fn new(shared_edges: Vec<Vec<u32>>, fans: HashMap<u32, Vec<u32>>) -> Self {
        let places = (0..).zip(&shared_edges).flat_map(|(place, edge)| edge.iter().map(move |&h| (h, place))).collect();
        Self { shared_edges, places, fans, creases: HashSet::new() }
    }

    fn shared_edge(&self, half_edge: u32) -> Option<&[u32]> {
        self.places.get(&half_edge).map(|&place| self.shared_edges[place as usize].as_slice())
    }
}

/// Iterator over the outgoing half-edges of a vertex; see [`Level::spokes`].
#[derive(Clone, Debug)]
pub struct Spokes<'a> {
    level: &'a Level,
    start: u32,
    current: u32,
}

impl Iterator for Spokes<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        if self.current == NONE {
            return None;
        }
        let spoke = self.current;
        let incoming = self.level.previous(spoke);
        let turned = self.level.twin(incoming);
        self.current = if turned == incoming || turned == self.start { NONE } else { turned };
        Some(spoke)
    }
}
