//! The control mesh (cage): positions, faces and the tags that OpenSubdiv's users rely on.

/// Sharpness from which an edge or a vertex counts as infinitely sharp (OpenSubdiv's `SHARPNESS_INFINITE`).
pub const INFINITE_SHARPNESS: f32 = 10.0;

/// Largest number of sides that a face may have; a bound on what a file can claim, far above any real pole.
pub const MAX_FACE_SIDES: u32 = 1 << 20;

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
    CornersPlus1,
    #[default]
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
    /// Options.
    pub options: MeshOptions,
}
