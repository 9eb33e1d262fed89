//! One level of a mesh as half-edges: who borders whom, and where each face lies on the base mesh.
//!
//! A half-edge `h` runs from `origins[h]` to the origin of the next one around its face, counter-clockwise.
//! `twins[h]` is the half-edge of the neighbouring face, `h` itself on the boundary, and [`NONE`] where a level does
//! not hold the neighbour: a refined level holds the faces that are drawn or refined further and, around them, the
//! faces that support them.

use std::collections::HashMap;

use crate::error::Error;
use crate::mesh::{BoundaryInterpolation, ControlMesh, Creasing, INFINITE_SHARPNESS, MeshOptions};
use crate::rules::is_semi_sharp;

/// "There is none", for any index.
pub const NONE: u32 = u32::MAX;

/// What decides the rules at a vertex.
///
/// | bit | meaning |
/// |---|---|
/// | 0 | boundary: the faces form one fan between two boundary edges |
/// | 1 | corner: infinitely sharp, interpolated |
/// | 2 | not a regular arrangement of faces |
/// | 3 | touches a face that is no quad (level 0 only) |
/// | 4 | semi-sharp itself, or an end of a semi-sharp edge: its rule still changes from level to level |
/// | 5 | an end of an infinitely sharp edge between two faces |
/// | 6 | not manifold: more than one fan of faces, or an edge of more than two faces |
/// | 7 | infinitely sharp edges do not cut the faces as a regular boundary or corner has them |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexTag(u8);

impl VertexTag {
    const BOUNDARY: u8 = 1;
    const CORNER: u8 = 2;
    const EXTRAORDINARY: u8 = 4;
    const BESIDE_NON_QUAD: u8 = 8;
    const SEMI_SHARP: u8 = 16;
    const INFINITE_CREASE: u8 = 32;
    const NON_MANIFOLD: u8 = 64;
    const IRREGULAR_SECTORS: u8 = 128;

    /// The tag of a manifold vertex with this many faces.
    pub fn new(face_count: u32, boundary: bool, corner: bool, beside_non_quad: bool) -> Self {
        let regular = match (boundary, corner) {
            (false, false) => face_count == 4,
            (false, true) => false,
            (true, false) => face_count == 2,
            (true, true) => face_count == 1,
        };
        Self(
            (u8::from(boundary) * Self::BOUNDARY)
                | (u8::from(corner) * Self::CORNER)
                | (u8::from(!regular) * Self::EXTRAORDINARY)
                | (u8::from(beside_non_quad) * Self::BESIDE_NON_QUAD),
        )
    }

    /// The tag of a vertex that is not manifold.
    fn non_manifold(corner: bool, beside_non_quad: bool) -> Self {
        let plain = Self::new(0, false, corner, beside_non_quad);
        Self(plain.0 | Self::NON_MANIFOLD)
    }

    /// The tag of the middle of an edge that is not manifold: a crease with two faces on every side of it.
    pub(crate) fn middle_of_non_manifold() -> Self {
        Self::non_manifold(false, false)
    }

    /// The tag with what its edges' and its own sharpness adds.
    pub(crate) fn with_sharpness(self, semi_sharp: bool, infinite_crease: bool) -> Self {
        let kept = self.0 & !(Self::SEMI_SHARP | Self::INFINITE_CREASE);
        Self(kept | (u8::from(semi_sharp) * Self::SEMI_SHARP) | (u8::from(infinite_crease) * Self::INFINITE_CREASE))
    }

    fn with_irregular_sectors(self) -> Self {
        Self(self.0 | Self::IRREGULAR_SECTORS)
    }

    /// On the boundary of a manifold part: the crease rule, unless it is a corner.
    pub fn is_boundary(self) -> bool {
        self.0 & Self::BOUNDARY != 0
    }

    /// Interpolated at every level.
    pub fn is_corner(self) -> bool {
        self.0 & Self::CORNER != 0
    }

    /// Other than four faces inside, two on the boundary, one at a corner.
    pub fn is_extraordinary(self) -> bool {
        self.0 & Self::EXTRAORDINARY != 0
    }

    /// Semi-sharp, or an end of a semi-sharp edge.
    pub fn is_semi_sharp(self) -> bool {
        self.0 & Self::SEMI_SHARP != 0
    }

    /// An end of an infinitely sharp edge between two faces.
    pub fn has_infinite_crease(self) -> bool {
        self.0 & Self::INFINITE_CREASE != 0
    }

    /// More than one fan of faces, or an edge of more than two faces.
    pub fn is_non_manifold(self) -> bool {
        self.0 & Self::NON_MANIFOLD != 0
    }

    /// Smooth, a boundary without creases, or a sharpened boundary vertex: the rule follows from the tag alone.
    pub fn is_plain(self) -> bool {
        self.0 & (Self::SEMI_SHARP | Self::INFINITE_CREASE | Self::NON_MANIFOLD) == 0
    }

    /// Quads all of whose vertices are so have a bicubic limit patch.
    pub fn is_regular(self) -> bool {
        let is_cut = self.0 & (Self::INFINITE_CREASE | Self::NON_MANIFOLD) != 0;
        let irregular = if is_cut { Self::IRREGULAR_SECTORS } else { Self::EXTRAORDINARY };
        self.0 & (irregular | Self::BESIDE_NON_QUAD | Self::SEMI_SHARP) == 0
    }

    /// All faces at the vertex are quads.
    pub fn touches_only_quads(self) -> bool {
        self.0 & Self::BESIDE_NON_QUAD == 0
    }

    /// The tag of the vertex that it becomes one level down, where all faces are quads; sharpness apart.
    pub(crate) fn child(self) -> Self {
        Self(self.0 & !Self::BESIDE_NON_QUAD)
    }
}

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
enum Faces {
    /// Face f has the half-edges 4 f to 4 f + 3.
    Quads,
    /// Face f has the half-edges `first[f]` to `first[f + 1] - 1`; `of[h]` is h's face.
    Mixed { first: Vec<u32>, of: Vec<u32> },
}

/// The half-edges of one level.
#[derive(Clone, Debug)]
pub struct Level {
    faces: Faces,
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
            options: MeshOptions::default(),
            drawn_count: 0,
            hidden: Vec::new(),
            locations: Vec::new(),
        }
    }

    /// Level 0.
    pub fn from_mesh(mesh: &ControlMesh) -> Result<Self, Error> {
        mesh.validate()?;
        let mut level = Self::of_quads(mesh.face_vertices.clone(), Vec::new());
        if mesh.face_sizes.iter().any(|&n| n != 4) {
            level.faces = mixed_faces(&mesh.face_sizes);
        }
        level.options = mesh.options;
        let vertex_count = mesh.positions.len();
        let shared_edges = pair_half_edges(&mut level, vertex_count);
        level.find_fans(vertex_count, shared_edges);
        level.set_sharpness(mesh);
        level.tag_vertices(mesh);
        level.drawn_count = mesh.face_count();
        level.hide_faces(mesh);
        let mut ptex_face = 0;
        for &sides in &mesh.face_sizes {
            level.locations.push(Location { ptex_face, ..Location::default() });
            ptex_face += if sides == 4 { 1 } else { sides };
        }
        Ok(level)
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
    fn has_regular_sectors(&self, vertex: u32, is_corner: bool) -> bool {
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

    fn spokes_from(&self, start: u32) -> Spokes<'_> {
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
            let mut seen = Vec::new();
            edges.retain(|edge| {
                let shared = self.sharing(edge);
                let is_new = !seen.contains(&shared[0]);
                if is_new && shared.len() > 1 {
                    seen.push(shared[0]);
                }
                is_new
            });
        }
        edges
    }

    /// The vertex at the other end of a half-edge that starts or ends at this one.
    pub(crate) fn other_end(&self, half_edge: u32, vertex: u32) -> u32 {
        let origin = self.origin(half_edge);
        if origin == vertex { self.head(half_edge) } else { origin }
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

    /// Finds where the fans of each vertex start.
    fn find_fans(&mut self, vertex_count: usize, shared_edges: Vec<Vec<u32>>) {
        let mut face_counts = vec![0_u32; vertex_count];
        let mut suspects = Vec::new();
        self.starts = vec![NONE; vertex_count];
        for half_edge in 0..self.origins.len() as u32 {
            let vertex = self.origin(half_edge);
            face_counts[vertex as usize] += 1;
            let start = self.starts[vertex as usize];
            if start == NONE || self.is_unpaired(half_edge) {
                if start != NONE && self.is_unpaired(start) {
                    suspects.push(vertex);
                } else {
                    self.starts[vertex as usize] = half_edge;
                }
            }
        }
        for (vertex, &count) in (0..).zip(&face_counts) {
            if count > 0 && self.spokes(vertex).count() as u32 != count {
                suspects.push(vertex);
            }
        }
        suspects.extend(shared_edges.iter().flatten().flat_map(|&h| [self.origin(h), self.head(h)]));
        if suspects.is_empty() {
            return;
        }
        let mut fans: HashMap<u32, Vec<u32>> = suspects.into_iter().map(|vertex| (vertex, Vec::new())).collect();
        let mut spokes_of: HashMap<u32, Vec<u32>> = HashMap::new();
        for half_edge in 0..self.origins.len() as u32 {
            let vertex = self.origin(half_edge);
            if fans.contains_key(&vertex) {
                spokes_of.entry(vertex).or_default().push(half_edge);
            }
        }
        for (vertex, starts) in &mut fans {
            let mut left = spokes_of.remove(vertex).unwrap_or_default();
            // Open fans start at their unpaired spoke; what is left then are closed ones.
            left.sort_by_key(|&spoke| (!self.is_unpaired(spoke), spoke));
            while let Some(&start) = left.first() {
                starts.push(start);
                let met: Vec<u32> = self.spokes_from(start).collect();
                left.retain(|spoke| !met.contains(spoke));
            }
            self.starts[*vertex as usize] = starts.first().copied().unwrap_or(NONE);
        }
        self.non_manifold = Some(Box::new(NonManifold::new(shared_edges, fans)));
    }

    /// Takes over the cage's creases and sharp vertices; corners come with the tags.
    fn set_sharpness(&mut self, mesh: &ControlMesh) {
        let sorted = |a: u32, b: u32| (a.min(b), a.max(b));
        // A later tag overrides an earlier one.
        let creases: HashMap<(u32, u32), f32> = mesh
            .creases
            .iter()
            .map(|crease| (sorted(crease.vertices[0], crease.vertices[1]), crease.sharpness))
            .collect();
        if creases.values().any(|&sharpness| sharpness > 0.0) {
            let mut is_end = vec![false; mesh.positions.len()];
            creases.keys().for_each(|&(a, b)| {
                is_end[a as usize] = true;
                is_end[b as usize] = true;
            });
            self.edge_sharpness = vec![0.0; self.origins.len()];
            for half_edge in 0..self.origins.len() as u32 {
                let (a, b) = (self.origin(half_edge), self.head(half_edge));
                if is_end[a as usize] && is_end[b as usize] {
                    let sharpness = creases.get(&sorted(a, b)).copied().unwrap_or(0.0);
                    self.edge_sharpness[half_edge as usize] = sharpness.clamp(0.0, INFINITE_SHARPNESS);
                }
            }
        }
        if mesh.corners.iter().any(|corner| corner.sharpness > 0.0) {
            self.vertex_sharpness = vec![0.0; mesh.positions.len()];
            for corner in &mesh.corners {
                self.vertex_sharpness[corner.vertex as usize] = corner.sharpness.clamp(0.0, INFINITE_SHARPNESS);
            }
        }
    }

    fn tag_vertices(&mut self, mesh: &ControlMesh) {
        self.tags = vec![VertexTag::default(); mesh.positions.len()];
        for vertex in 0..mesh.positions.len() as u32 {
            if self.starts[vertex as usize] != NONE {
                self.tags[vertex as usize] = self.vertex_tag(vertex);
            }
        }
    }

    /// The tag of a vertex all of whose faces are in this level.
    pub(crate) fn vertex_tag(&self, vertex: u32) -> VertexTag {
        let (mut face_count, mut beside_non_quad) = (0, false);
        for spoke in self.all_spokes(vertex) {
            face_count += 1;
            beside_non_quad |= self.sides(self.face(spoke)) != 4;
        }
        let given = self.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0);
        let topological_corner = face_count == 1 && self.options.boundary == BoundaryInterpolation::EdgeAndCorner;
        let corner = given >= INFINITE_SHARPNESS || topological_corner;
        let is_manifold = self.non_manifold.as_ref().is_none_or(|parts| !parts.fans.contains_key(&vertex));
        let tag = if is_manifold {
            let boundary = self.is_unpaired(self.starts[vertex as usize]);
            VertexTag::new(face_count, boundary, corner, beside_non_quad)
        } else {
            VertexTag::non_manifold(corner || !self.is_non_manifold_crease(vertex, face_count), beside_non_quad)
        };
        let has_sharpness = !self.edge_sharpness.is_empty() || given > 0.0;
        let tag = if has_sharpness { self.tag_with_sharpness(vertex, tag) } else { tag };
        let is_cut = tag.is_non_manifold() || tag.has_infinite_crease();
        if is_cut && !self.has_regular_sectors(vertex, tag.is_corner()) { tag.with_irregular_sectors() } else { tag }
    }

    /// The tag of a vertex with what the sharpness at it adds.
    fn tag_with_sharpness(&self, vertex: u32, tag: VertexTag) -> VertexTag {
        let own = self.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0);
        let (mut semi_sharp, mut infinite) = (is_semi_sharp(own) && !tag.is_corner(), false);
        for spoke in self.all_spokes(vertex).filter(|&spoke| !self.is_unpaired(spoke)) {
            let sharpness = self.sharpness(spoke);
            semi_sharp |= is_semi_sharp(sharpness);
            infinite |= sharpness >= INFINITE_SHARPNESS;
        }
        tag.with_sharpness(semi_sharp, infinite)
    }

    /// Whether a vertex lies inside a crease of edges of more than two faces: two such edges, no boundary and more faces
    /// than edges. All other vertices that are not manifold are corners (OpenSubdiv's rule).
    fn is_non_manifold_crease(&self, vertex: u32, face_count: u32) -> bool {
        let edges = self.incident_edges(vertex);
        let shared_count = edges.iter().filter(|edge| self.sharing(edge).len() > 1).count();
        let has_boundary = edges.iter().any(|&edge| self.is_boundary(edge));
        shared_count == 2 && !has_boundary && face_count as usize > edges.len()
    }

    fn hide_faces(&mut self, mesh: &ControlMesh) {
        let no_boundary = mesh.options.boundary == BoundaryInterpolation::None;
        if mesh.holes.is_empty() && !no_boundary {
            return;
        }
        self.hidden = vec![false; self.face_count() as usize];
        if no_boundary {
            // A vertex on the boundary has a limit only if all its boundary edges were made infinitely sharp.
            for vertex in (0..mesh.positions.len() as u32).filter(|&v| self.starts[v as usize] != NONE) {
                let is_open = self.incident_edges(vertex).iter().any(|&edge| {
                    let given = self.edge_sharpness.get(edge as usize).copied().unwrap_or(0.0);
                    self.is_boundary(edge) && given < INFINITE_SHARPNESS
                });
                if is_open {
                    let faces: Vec<u32> = self.all_spokes(vertex).map(|spoke| self.face(spoke)).collect();
                    faces.into_iter().for_each(|face| self.hidden[face as usize] = true);
                }
            }
        }
        for &hole in &mesh.holes {
            self.hidden[hole as usize] = true;
        }
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
}

impl NonManifold {
    pub fn new(shared_edges: Vec<Vec<u32>>, fans: HashMap<u32, Vec<u32>>) -> Self {
        let places = (0..).zip(&shared_edges).flat_map(|(place, edge)| edge.iter().map(move |&h| (h, place))).collect();
        Self { shared_edges, places, fans }
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

fn mixed_faces(sizes: &[u32]) -> Faces {
    let mut first = Vec::with_capacity(sizes.len() + 1);
    let mut of = Vec::new();
    let mut end = 0;
    for (face, &sides) in sizes.iter().enumerate() {
        first.push(end);
        end += sides;
        of.resize(end as usize, face as u32);
    }
    first.push(end);
    Faces::Mixed { first, of }
}

/// Finds the twin of every half-edge: half-edges are bucketed by their lower vertex, and paired within the bucket.
/// Returns the half-edges of each edge that is not manifold (more than two faces, or two that run the same way along it);
/// those stay unpaired.
fn pair_half_edges(level: &mut Level, vertex_count: usize) -> Vec<Vec<u32>> {
    let count = level.origins.len() as u32;
    let ends = |h: u32| {
        let (a, b) = (level.origin(h), level.head(h));
        (a.min(b), a.max(b))
    };
    let mut bucket_ends = vec![0_u32; vertex_count + 1];
    for h in 0..count {
        bucket_ends[ends(h).0 as usize + 1] += 1;
    }
    for i in 0..vertex_count {
        bucket_ends[i + 1] += bucket_ends[i];
    }
    let mut cursor = bucket_ends.clone();
    let mut sorted = vec![(0_u32, 0_u32); count as usize];
    for h in 0..count {
        let (low, high) = ends(h);
        sorted[cursor[low as usize] as usize] = (high, h);
        cursor[low as usize] += 1;
    }
    let mut twins: Vec<u32> = (0..count).collect();
    let mut shared_edges = Vec::new();
    for low in 0..vertex_count {
        let bucket = &mut sorted[bucket_ends[low] as usize..bucket_ends[low + 1] as usize];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|a, b| a.0 == b.0) {
            match *edge {
                [_] => {}
                [(_, a), (_, b)] if level.origin(a) != level.origin(b) => {
                    twins[a as usize] = b;
                    twins[b as usize] = a;
                }
                _ => shared_edges.push(edge.iter().map(|&(_, h)| h).collect()),
            }
        }
    }
    level.twins = twins;
    shared_edges
}
