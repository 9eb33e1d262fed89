//! The control mesh (cage): positions, faces and the tags that OpenSubdiv's users rely on.

use crate::error::Error;

/// Sharpness from which an edge or a vertex counts as infinitely sharp (OpenSubdiv's `SHARPNESS_INFINITE`).
pub const INFINITE_SHARPNESS: f32 = 10.0;

/// Largest number of sides that a face may have; a bound on what a file can claim, far above any real pole.
pub const MAX_FACE_SIDES: u32 = 1 << 20;

/// Largest magnitude of a coordinate: a patch sums 16 control points with weights of 36 in all, in 32-bit floats.
pub const MAX_COORDINATE: f32 = 1e36;

/// Bound on points, half-edges and faces of a level: indices are 32 bits and the last one means "none".
pub const MAX_ELEMENTS: u32 = 1 << 31;

/// How boundary edges and vertices of one face shape the limit surface (`interpolateboundary`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoundaryInterpolation {
    /// No face with a vertex on the boundary has a limit surface.
    None,
    /// Boundary edges are infinitely sharp creases.
    EdgeOnly,
    /// As [`Self::EdgeOnly`], and boundary vertices of one face are interpolated.
    #[default]
    EdgeAndCorner,
}

/// How the sharpness of an edge's children follows from its own (`creasemethod`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Creasing {
    /// Every child has its parent's sharpness less one.
    #[default]
    Uniform,
    /// Chaikin's rule along the crease.
    Chaikin,
}

/// The face and edge weights of triangles (`smoothtriangles`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleSubdivision {
    /// Catmull-Clark weights.
    #[default]
    CatmullClark,
    /// OpenSubdiv's smoother weights for triangles.
    Smooth,
}

/// How face-varying channels are interpolated (`facevaryinginterpolateboundary`), in OpenSubdiv's order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are OpenSubdiv's and USD's own")]
pub enum FaceVaryingInterpolation {
    None,
    CornersOnly,
    #[default]
    CornersPlus1,
    CornersPlus2,
    Boundaries,
    All,
}

/// An edge's sharpness tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// The edge's two vertices.
    pub vertices: [u32; 2],
    /// 0 is smooth; [`INFINITE_SHARPNESS`] and more is infinite.
    pub sharpness: f32,
}

/// A vertex' sharpness tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// The vertex.
    pub vertex: u32,
    /// 0 is smooth; [`INFINITE_SHARPNESS`] and more is infinite.
    pub sharpness: f32,
}

/// What a hierarchical edit does with what it finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EditOperation {
    /// Replaces a vertex' position.
    SetPosition([f32; 3]),
    /// Moves a vertex.
    AddPosition([f32; 3]),
    /// Replaces a vertex' sharpness.
    SetVertexSharpness(f32),
    /// Adds to a vertex' sharpness.
    AddVertexSharpness(f32),
    /// Replaces an edge's sharpness.
    SetEdgeSharpness(f32),
    /// Adds to an edge's sharpness.
    AddEdgeSharpness(f32),
    /// Makes a face a hole.
    Hole,
}

/// A hierarchical edit (FAS section 6.3): a path from a base face to a component of a finer level, and an operation.
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchicalEdit {
    /// Base face, then child indices; the last entry is the vertex or edge within that face, or the child that a face edit names.
    pub path: Vec<u32>,
    /// What happens there.
    pub operation: EditOperation,
}

/// Options of the whole mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOptions {
    /// Boundary rule.
    pub boundary: BoundaryInterpolation,
    /// Crease rule.
    pub creasing: Creasing,
    /// Triangle rule.
    pub triangles: TriangleSubdivision,
    /// Rule of face-varying channels.
    pub face_varying: FaceVaryingInterpolation,
}

/// Values that belong to the corners of faces: texture coordinates, mostly. Where two faces name different values at a
/// vertex the channel has a seam, even if the numbers are the same.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceVaryingChannel {
    /// What files and shaders call it.
    pub name: String,
    /// The distinct values.
    pub values: Vec<[f32; 2]>,
    /// Into `values`, one a face corner, parallel to [`ControlMesh::face_vertices`].
    pub indices: Vec<u32>,
}

/// How values of vertices become values of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VertexInterpolation {
    /// By the rules of positions, boundaries, creases and all: the limit surface of a cage with these positions.
    #[default]
    Vertex,
    /// Bilinear in each Ptex face. The middle of a face of other than four sides has the mean of its vertices, that of an
    /// edge the mean of its two.
    Varying,
}

/// Colours of vertices. They do not animate, and hierarchical edits of positions leave them alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexColors {
    /// Red, green and blue, scene-linear, of any size and sign; one a vertex.
    pub values: Vec<[f32; 3]>,
    /// What lies between vertices.
    pub interpolation: VertexInterpolation,
}

/// A Catmull-Clark cage. Plain data; [`ControlMesh::validate`] says whether it can be subdivided.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlMesh {
    /// One position a vertex.
    pub positions: Vec<[f32; 3]>,
    /// Number of sides of each face.
    pub face_sizes: Vec<u32>,
    /// Vertex indices of all faces, one face after another, counter-clockwise.
    pub face_vertices: Vec<u32>,
    /// Edge sharpness tags.
    pub creases: Vec<Crease>,
    /// Vertex sharpness tags.
    pub corners: Vec<Corner>,
    /// Faces that are not drawn.
    pub holes: Vec<u32>,
    /// Hierarchical edits.
    pub edits: Vec<HierarchicalEdit>,
    /// Scales the density of tessellation, one a vertex; empty: 1 everywhere.
    pub density: Vec<f32>,
    /// Channels of values at the corners of faces. They do not animate.
    pub face_varying: Vec<FaceVaryingChannel>,
    /// Colours of the vertices; without them the surface is white.
    pub colors: Option<VertexColors>,
    /// Options.
    pub options: MeshOptions,
}

impl ControlMesh {
    /// Number of faces.
    pub fn face_count(&self) -> u32 {
        self.face_sizes.len() as u32
    }

    /// The axis-aligned bounding box of all positions, or `None` without positions.
    pub fn bounding_box(&self) -> Option<[[f32; 3]; 2]> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold([first, first], |[mut low, mut high], p| {
            for axis in 0..3 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
            [low, high]
        }))
    }

    /// Whether another mesh is the same but for positions, densities and colours, on which no table depends.
    pub fn has_tables_of(&self, other: &Self) -> bool {
        // What differs most often comes first.
        self.positions.len() == other.positions.len()
            && self.face_vertices == other.face_vertices
            && self.face_sizes == other.face_sizes
            && self.creases == other.creases
            && self.corners == other.corners
            && self.holes == other.holes
            && self.edits == other.edits
            && self.options == other.options
            && self.face_varying == other.face_varying
    }

    /// Number of Ptex faces: a quad is one, any other face one a side.
    pub fn ptex_face_count(&self) -> u64 {
        self.face_sizes.iter().map(|&n| if n == 4 { 1 } else { u64::from(n) }).sum()
    }

    /// Checks what refinement relies on: indices in range, at least three different vertices a face, finite positions
    /// and densities, face-varying values and colours that are there and finite, edits of what exists.
    pub fn validate(&self) -> Result<(), Error> {
        if self.face_sizes.is_empty() {
            return Err(Error::Empty);
        }
        let expected = self.face_sizes.iter().map(|&n| u64::from(n)).sum::<u64>();
        let found = self.face_vertices.len() as u64;
        if expected != found {
            return Err(Error::FaceList { expected, found });
        }
        if found >= u64::from(MAX_ELEMENTS) || self.positions.len() as u64 >= u64::from(MAX_ELEMENTS) {
            return Err(Error::TooLarge { level: 0, count: found.max(self.positions.len() as u64) });
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.iter().all(|c| c.abs() <= MAX_COORDINATE)) {
            return Err(Error::NotFinite { vertex: vertex as u32 });
        }
        if !self.density.is_empty() && self.density.len() != self.positions.len() {
            return Err(Error::DensityCount {
                expected: self.positions.len() as u64,
                found: self.density.len() as u64,
            });
        }
        if let Some(vertex) = self.density.iter().position(|&d| !(0.0..f32::INFINITY).contains(&d)) {
            return Err(Error::Density { vertex: vertex as u32 });
        }
        let in_range = |what, index: u32, count: usize| {
            let count = count as u32;
            if index < count { Ok(()) } else { Err(Error::OutOfRange { what, index, count }) }
        };
        let (mut first, mut seen_in) = (0, vec![u32::MAX; self.positions.len()]);
        for (face, &sides) in self.face_sizes.iter().enumerate() {
            let face = face as u32;
            if !(3..=MAX_FACE_SIDES).contains(&sides) {
                return Err(Error::FaceSides { face, sides });
            }
            for &vertex in &self.face_vertices[first..first + sides as usize] {
                in_range("vertex", vertex, self.positions.len())?;
                if std::mem::replace(&mut seen_in[vertex as usize], face) == face {
                    return Err(Error::RepeatedVertex { face, vertex });
                }
            }
            first += sides as usize;
        }
        for &hole in &self.holes {
            in_range("hole", hole, self.face_sizes.len())?;
        }
        for vertex in self.creases.iter().flat_map(|c| c.vertices).chain(self.corners.iter().map(|c| c.vertex)) {
            in_range("vertex", vertex, self.positions.len())?;
        }
        for (number, channel) in (0..).zip(&self.face_varying) {
            channel.validate(found).map_err(|fault| Error::FaceVarying { channel: number, fault })?;
        }
        if let Some(colors) = &self.colors {
            colors.validate(self.positions.len())?;
        }
        crate::edits::validate(self)
    }
}

impl VertexColors {
    /// What is wrong with the colours of a mesh with so many vertices.
    fn validate(&self, vertex_count: usize) -> Result<(), Error> {
        if self.values.len() != vertex_count {
            return Err(Error::ColorCount { expected: vertex_count as u64, found: self.values.len() as u64 });
        }
        match self.values.iter().position(|color| !color.iter().all(|c| c.abs() <= MAX_COORDINATE)) {
            None => Ok(()),
            Some(vertex) => Err(Error::Color { vertex: vertex as u32 }),
        }
    }
}

impl FaceVaryingChannel {
    /// What is wrong with the channel of a mesh with so many face corners.
    fn validate(&self, corner_count: u64) -> Result<(), String> {
        let is_number = |value: &[f32; 2]| value.iter().all(|c| c.abs() <= MAX_COORDINATE);
        if let Some(value) = self.values.iter().position(|value| !is_number(value)) {
            return Err(format!("value {value} (from 0) is not finite, or beyond {MAX_COORDINATE:e}"));
        }
        if self.indices.len() as u64 != corner_count {
            return Err(format!("{} indices for {corner_count} face corners", self.indices.len()));
        }
        match self.indices.iter().position(|&index| index as usize >= self.values.len()) {
            None => Ok(()),
            Some(corner) => {
                let (index, count) = (self.indices[corner], self.values.len());
                Err(format!("index {index} of corner {corner} (both from 0) is out of range: there are {count} values"))
            }
        }
    }
}
