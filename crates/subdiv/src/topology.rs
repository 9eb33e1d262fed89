//! One level of a mesh as half-edges: who borders whom, and where each face lies on the base mesh.
//!
//! A half-edge `h` runs from `origins[h]` to the origin of the next one around its face, counter-clockwise.
//! `twins[h]` is the half-edge of the neighbouring face, `h` itself on the boundary, and [`NONE`] where a level does
//! not hold the neighbour: a refined level holds the faces that are drawn or refined further and, around them, the
//! faces that support them.

use crate::error::Error;
use crate::mesh::{BoundaryInterpolation, ControlMesh};

/// "There is none", for any index.
pub const NONE: u32 = u32::MAX;

/// What decides the rules at a vertex. Bits: 0 boundary, 1 corner (interpolated), 2 not a regular arrangement of faces,
/// 3 touches a face that is no quad (level 0 only).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexTag(u8);

impl VertexTag {
    const BOUNDARY: u8 = 1;
    const CORNER: u8 = 2;
    const EXTRAORDINARY: u8 = 4;
    const BESIDE_NON_QUAD: u8 = 8;

    /// The tag of a vertex with this many faces.
    pub fn new(face_count: u32, boundary: bool, corner: bool, beside_non_quad: bool) -> Self {
        let regular = match (boundary, corner) {
            (false, _) => face_count == 4,
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

    /// On the boundary: the crease rule, unless it is a corner.
    pub fn is_boundary(self) -> bool {
        self.0 & Self::BOUNDARY != 0
    }

    /// Interpolated.
    pub fn is_corner(self) -> bool {
        self.0 & Self::CORNER != 0
    }

    /// Other than four faces inside, two on the boundary, one at a corner.
    pub fn is_extraordinary(self) -> bool {
        self.0 & Self::EXTRAORDINARY != 0
    }

    /// A quad whose vertices are all so has a bicubic limit patch.
    pub fn is_regular(self) -> bool {
        self.0 & (Self::EXTRAORDINARY | Self::BESIDE_NON_QUAD) == 0
    }

    /// All faces at the vertex are quads.
    pub fn touches_only_quads(self) -> bool {
        self.0 & Self::BESIDE_NON_QUAD == 0
    }

    /// The tag of the vertex that it becomes one level down, where all faces are quads.
    pub fn child(self) -> Self {
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
    /// Half-edge on the other side, itself on the boundary, [`NONE`] where that is not part of this level.
    pub twins: Vec<u32>,
    /// A half-edge that starts at the vertex; on the boundary the one that is a boundary edge, so that turning
    /// counter-clockwise from it meets every face. [`NONE`] for a vertex that no face uses.
    pub starts: Vec<u32>,
    /// Rules at each vertex.
    pub tags: Vec<VertexTag>,
    /// Faces `0..drawn_count` belong to the surface, unless `hidden` says otherwise; the rest only support them.
    pub drawn_count: u32,
    /// Level 0 only: faces that are holes or have no limit surface; empty if there are none.
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
            drawn_count: 0,
            hidden: Vec::new(),
            locations: Vec::new(),
        }
    }

    /// Level 0. Fails where the cage is not manifold or not consistently oriented.
    pub fn from_mesh(mesh: &ControlMesh) -> Result<Self, Error> {
        mesh.validate()?;
        let mut level = Self::of_quads(mesh.face_vertices.clone(), Vec::new());
        if mesh.face_sizes.iter().any(|&n| n != 4) {
            level.faces = mixed_faces(&mesh.face_sizes);
        }
        level.twins = pair_half_edges(&level, mesh.positions.len())?;
        level.find_starts(mesh.positions.len())?;
        level.tag_vertices(mesh)?;
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

    /// Whether no face lies on the other side.
    pub fn is_boundary(&self, half_edge: u32) -> bool {
        self.twin(half_edge) == half_edge
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

    /// The outgoing half-edges of a vertex, counter-clockwise; on the boundary from the boundary edge on.
    /// The vertex must have all its faces in this level.
    pub fn spokes(&self, vertex: u32) -> Spokes<'_> {
        Spokes { level: self, start: self.starts[vertex as usize], current: self.starts[vertex as usize] }
    }

    fn find_starts(&mut self, vertex_count: usize) -> Result<(), Error> {
        self.starts = vec![NONE; vertex_count];
        for half_edge in 0..self.origins.len() as u32 {
            let vertex = self.origin(half_edge);
            let start = self.starts[vertex as usize];
            if start == NONE || self.is_boundary(half_edge) {
                if start != NONE && self.is_boundary(start) {
                    return Err(Error::NonManifoldVertex { vertex });
                }
                self.starts[vertex as usize] = half_edge;
            }
        }
        Ok(())
    }

    fn tag_vertices(&mut self, mesh: &ControlMesh) -> Result<(), Error> {
        let mut face_counts = vec![0_u32; mesh.positions.len()];
        for &vertex in &self.origins {
            face_counts[vertex as usize] += 1;
        }
        self.tags = vec![VertexTag::default(); mesh.positions.len()];
        for (vertex, &face_count) in face_counts.iter().enumerate() {
            let vertex = vertex as u32;
            if face_count == 0 {
                continue;
            }
            let (mut met, mut beside_non_quad) = (0, false);
            for spoke in self.spokes(vertex) {
                met += 1;
                beside_non_quad |= self.sides(self.face(spoke)) != 4;
            }
            if met != face_count {
                return Err(Error::NonManifoldVertex { vertex });
            }
            let boundary = self.is_boundary(self.starts[vertex as usize]);
            let corner = boundary && face_count == 1 && mesh.options.boundary == BoundaryInterpolation::EdgeAndCorner;
            self.tags[vertex as usize] = VertexTag::new(face_count, boundary, corner, beside_non_quad);
        }
        Ok(())
    }

    fn hide_faces(&mut self, mesh: &ControlMesh) {
        let no_boundary = mesh.options.boundary == BoundaryInterpolation::None;
        if mesh.holes.is_empty() && !no_boundary {
            return;
        }
        let on_boundary = |face| self.vertices(face).iter().any(|&v| self.tag(v).is_boundary());
        self.hidden = (0..self.face_count()).map(|face| no_boundary && on_boundary(face)).collect();
        for &hole in &mesh.holes {
            self.hidden[hole as usize] = true;
        }
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
fn pair_half_edges(level: &Level, vertex_count: usize) -> Result<Vec<u32>, Error> {
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
                _ => return Err(Error::NonManifoldEdge { vertices: [low as u32, edge[0].0] }),
            }
        }
    }
    Ok(twins)
}
