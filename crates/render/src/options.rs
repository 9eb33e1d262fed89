//! What a frame is asked to be.

use planish_subdiv::gregory::Rival;

use crate::targets::Layers;

/// How the irregular parts of a surface are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceMethod {
    /// Dynamic feature-adaptive subdivision: a depth of its own for every irregularity (DFAS).
    #[default]
    Dfas,
    /// Static feature-adaptive subdivision: every irregularity to one depth (FAS). The same kernels with a constant selection.
    Fas,
    /// One Gregory patch for each irregular face of the cage (Loop et al. 2009): an approximation.
    Gregory,
    /// Approximate Catmull-Clark patches of them (Loop and Schaefer 2008), to compare with: closed meshes of quads.
    Acc,
    /// Pm-patches of them (Myles, Ni and Peters 2008), to compare with: closed meshes of quads.
    Pm,
    /// Global table-driven refinement drawn as triangles: the baseline of FAS section 8.1.
    Uniform,
    /// Basis function tables over the cage subdivided once (Hollaender and Boubekeur 2010): any scheme.
    Table,
    /// Faces of the cage as they are, shaded smoothly: what substitutes are measured by.
    Flat,
    /// Phong tessellation (Boubekeur and Alexa 2008): a substitute to compare with.
    Phong,
    /// Curved PN triangles (Vlachos et al. 2001): a substitute to compare with.
    Pn,
}

impl SurfaceMethod {
    /// Whether every irregular face of the cage is one patch, and nothing is refined.
    pub fn is_one_patch_a_face(self) -> bool {
        matches!(self, Self::Gregory | Self::Acc | Self::Pm)
    }

    /// Whether faces are grids of points that the tessellator makes one vertex of each: by table, or by a substitute.
    pub fn is_grid(self) -> bool {
        matches!(self, Self::Table | Self::Flat | Self::Phong | Self::Pn)
    }

    /// Whether it is over the faces of the cage itself, by their corners alone.
    pub fn is_substitute(self) -> bool {
        self.is_grid() && self != Self::Table
    }

    /// The scheme of these patches, if they are no Gregory patches.
    pub fn rival(self) -> Option<Rival> {
        match self {
            Self::Acc => Some(Rival::Acc),
            Self::Pm => Some(Rival::Pm),
            _ => None,
        }
    }
}

/// Where normals of surfaces by table come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableNormals {
    /// Tables of tangents: the limit surface's own.
    #[default]
    Tangents,
    /// Subdivision Shading (Alexa and Boubekeur 2008): geometric normals of the mesh after so many steps, 2 at most, are subdivided as
    /// positions are.
    Subdivision(u32),
    /// Geometric normals of the mesh after one step, interpolated.
    Geometric,
}

/// How weights of tables are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableWeights {
    /// 32-bit floats.
    #[default]
    Float,
    /// 16 bits, in steps of 1/32767 of the largest: half the bytes. Sums of weights are 1 as before, as points are weighed relative to one of
    /// them, and both sides of an edge have the same weights.
    Short,
}

/// How the control points of Gregory patches are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GregoryPoints {
    /// In two stages: of what limit points hand on (Loop et al. 2009, sections 4.1 and 4.2).
    #[default]
    TwoStage,
    /// Straight from the cage's points, by a table of weights for each connectivity (section 4.3).
    Stencil,
}

/// What irregular faces are drawn as where the largest level ends refinement (FAS section 7).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EndCap {
    /// Patch-filling quads: flat, and their edges have one segment.
    #[default]
    Quad,
    /// Gregory patches: approximations, as fine as other patches.
    Gregory,
}

/// Where tessellated points lie between whole factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Factors are rounded up to whole numbers.
    Equal,
    /// The next odd number of segments, two of them shorter.
    #[default]
    FractionalOdd,
    /// The next even number of segments, two of them shorter; one at factor 1.
    FractionalEven,
}

impl Spacing {
    /// Value of the shaders' specialization constant `SPACING`.
    pub fn constant(self) -> u32 {
        match self {
            Self::Equal => 0,
            Self::FractionalOdd => 1,
            Self::FractionalEven => 2,
        }
    }
}

/// How finely the surface is tessellated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// The same tess factor, at least 1, on every base edge.
    Tess(f32),
    /// Triangle edges of about this many pixels.
    EdgePixels(f32),
}

impl Default for Density {
    fn default() -> Self {
        Self::EdgePixels(4.0)
    }
}

/// Which irregular faces are refined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// Those whose density asks for it.
    #[default]
    Dynamic,
    /// All, to the level that the largest density of the frame asks for.
    Static,
}

/// What is left out of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Culling {
    /// Nothing.
    #[default]
    Off,
    /// What lies outside of the view.
    Unseen,
    /// That, and what shows its back, of objects that hide their backs.
    UnseenAndBacks,
}

/// What frames may need: pipelines for nothing else are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameNeeds {
    /// Spacing.
    pub spacing: Spacing,
    /// Some are culled.
    pub culls: bool,
    /// Some objects stand elsewhere than their mesh.
    pub placed: bool,
    /// Some have densities above [`crate::density::MAX_UNCUT_DENSITY`].
    pub cuts: bool,
    /// Along every seam positions have the same bits on both sides, and normals where the surface is smooth; else each patch is
    /// evaluated by itself, in fewer operations.
    pub watertight: bool,
    /// Some objects are displaced.
    pub displaced: bool,
    /// Dumps, and what is shaded later, have texture coordinates.
    pub tex_coords: bool,
    /// Irregular faces, where refinement ends, are Gregory patches ([`SurfaceMethod::Gregory`], [`EndCap::Gregory`]).
    pub gregory: bool,
    /// Or rather patches of this scheme.
    pub rival: Option<Rival>,
    /// Other leaves are patch-filling quads all the same.
    pub filling: bool,
    /// How their control points are made: as the surface's are ([`crate::SurfaceDesc::gregory_points`]).
    pub gregory_points: GregoryPoints,
    /// Their normals are those of the rational patches, not of their Bezier form.
    pub exact_normals: bool,
    /// Dumps, and what is shaded later, have colours.
    pub colors: bool,
    /// Some cages deform.
    pub deforms: bool,
    /// It is asked where points are at the next moment.
    pub moves: bool,
    /// Some materials have holes: what is shaded later, and shadows.
    pub cutouts: bool,
    /// Faces are grids ([`SurfaceMethod::is_grid`]).
    pub grids: bool,
    /// Normals are made of those of vertices.
    pub vertex_normals: bool,
}

impl FrameNeeds {
    /// All that limit surfaces may need.
    pub fn all(spacing: Spacing) -> Self {
        Self {
            spacing,
            culls: true,
            placed: true,
            cuts: true,
            watertight: true,
            displaced: false,
            tex_coords: false,
            gregory: false,
            rival: None,
            filling: true,
            gregory_points: GregoryPoints::TwoStage,
            exact_normals: false,
            colors: false,
            deforms: false,
            moves: false,
            cutouts: false,
            grids: false,
            vertex_normals: false,
        }
    }
}

/// How a frame selects and culls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameOptions {
    /// How finely the surface is tessellated.
    pub density: Density,
    /// Which irregular faces are refined.
    pub selection: Selection,
    /// What is left out.
    pub culling: Culling,
    /// One density for each object, from the distance of its centre (FAS section 7), instead of one a vertex.
    pub object_lod: bool,
}

/// What the beauty image shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// Lit by a key, a fill, a rim and a small sky.
    #[default]
    Shaded,
    /// Normals as colours.
    Normal,
    /// Kind of patch by hue, the patch by brightness.
    Patch,
    /// Level of subdivision.
    Level,
    /// Tess factor.
    Tess,
    /// Parameters of the Ptex face.
    Uv,
    /// Colours of vertices, as they are.
    Color,
    /// Shaded, with the edges of all triangles.
    Wire,
}

impl View {
    /// Value of the fragment shader's specialization constant `VIEW`.
    pub fn constant(self, method: SurfaceMethod) -> u32 {
        match self {
            Self::Shaded | Self::Wire => 0,
            Self::Normal => 1,
            // In the colours of the Gregory paper.
            Self::Patch if method.is_one_patch_a_face() => 7,
            Self::Patch => 2,
            Self::Level => 3,
            Self::Tess => 4,
            Self::Uv => 5,
            Self::Color => 6,
        }
    }

    /// What the view needs besides the normal.
    pub fn layers(self) -> Layers {
        match self {
            Self::Shaded | Self::Wire => Layers::None,
            Self::Color => Layers::GeometryAndColors,
            _ => Layers::Geometry,
        }
    }
}
