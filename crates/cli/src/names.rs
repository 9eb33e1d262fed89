//! Names on the command line for what the renderer offers.

use clap::ValueEnum;
use planish_render::{EndCap, GregoryPoints, Spacing, TableNormals, TableWeights, View};
use planish_scene::displacement::{DisplacementKind, DisplacementLayout};
use planish_subdiv::refine::CreasePatches;

use crate::sampling::PixelFilter;

/// Surface methods by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MethodName {
    Fas,
    Dfas,
    Gregory,
    /// Approximate Catmull-Clark patches, to compare with: closed meshes of quads
    Acc,
    /// Pm-patches, to compare with: closed meshes of quads
    Pm,
    /// Basis function tables over the cage subdivided once: any scheme
    Table,
    /// Faces of the cage as they are, to compare with: triangles and quads
    Flat,
    /// Phong tessellation, to compare with: triangles and quads
    Phong,
    /// Curved PN triangles, to compare with: triangles
    Pn,
    Uniform,
}

/// What has a density of tessellation of its own, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LodName {
    /// Every vertex of a cage
    Vertex,
    /// Every object: from the distance to its centre
    Object,
}

/// Pixel filters by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FilterName {
    /// The same weight everywhere
    Box,
    /// Falls to 0 linearly
    Triangle,
    /// A bell, cut off at three standard deviations
    Gaussian,
    /// A bell without side lobes
    BlackmanHarris,
}

impl From<FilterName> for PixelFilter {
    fn from(name: FilterName) -> Self {
        match name {
            FilterName::Box => Self::Box,
            FilterName::Triangle => Self::Triangle,
            FilterName::Gaussian => Self::Gaussian,
            FilterName::BlackmanHarris => Self::BlackmanHarris,
        }
    }
}

/// End caps by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum EndCapName {
    /// Patch-filling quads between limit points, with one segment an edge
    Quad,
    /// Gregory patches, as fine as other patches
    Gregory,
}

impl From<EndCapName> for EndCap {
    fn from(name: EndCapName) -> Self {
        match name {
            EndCapName::Quad => Self::Quad,
            EndCapName::Gregory => Self::Gregory,
        }
    }
}

/// Normals of Gregory patches by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GregoryNormalsName {
    /// Of the Bezier form (Loop et al. 2009, section 4.4)
    Approximate,
    /// Of the rational patch
    Exact,
}

/// Normals of surfaces by table, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableNormalsName {
    /// Tables of tangents: the limit surface's own
    Tangent,
    /// Subdivision Shading from the cage on
    Subdivision0,
    /// Subdivision Shading from the mesh after one step on
    Subdivision1,
    /// Subdivision Shading from the mesh after two steps on
    Subdivision2,
    /// Geometric normals of the mesh after one step, interpolated
    Geometric,
}

impl From<TableNormalsName> for TableNormals {
    fn from(name: TableNormalsName) -> Self {
        match name {
            TableNormalsName::Tangent => Self::Tangents,
            TableNormalsName::Subdivision0 => Self::Subdivision(0),
            TableNormalsName::Subdivision1 => Self::Subdivision(1),
            TableNormalsName::Subdivision2 => Self::Subdivision(2),
            TableNormalsName::Geometric => Self::Geometric,
        }
    }
}

/// How weights of tables are stored, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableWeightsName {
    /// 32-bit floats
    Float,
    /// 16 bits
    Short,
}

impl From<TableWeightsName> for TableWeights {
    fn from(name: TableWeightsName) -> Self {
        match name {
            TableWeightsName::Float => Self::Float,
            TableWeightsName::Short => Self::Short,
        }
    }
}

/// How control points of Gregory patches are made, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GregoryPointsName {
    /// Of what limit points hand on to the patches around them (Loop et al. 2009, sections 4.1 and 4.2)
    TwoStage,
    /// Of the cage's points, by a table of weights for each connectivity (section 4.3)
    Stencil,
}

impl From<GregoryPointsName> for GregoryPoints {
    fn from(name: GregoryPointsName) -> Self {
        match name {
            GregoryPointsName::TwoStage => Self::TwoStage,
            GregoryPointsName::Stencil => Self::Stencil,
        }
    }
}

/// Deviations that `compare` shows in pictures, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MetricName {
    /// From the point with the same (face, u, v)
    Parametric,
    /// From the nearest point
    Nearest,
}

/// Subdivision schemes by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SchemeName {
    /// Faces of any number of sides
    CatmullClark,
    /// Triangles; by method table
    Loop,
    /// Triangles and quads (Stam and Loop 2003); by method table
    LoopStam,
    /// Triangles, interpolated (Modified Butterfly, Zorin et al. 1996); by method table
    Butterfly,
    Bilinear,
}

/// Spacings by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SpacingName {
    Equal,
    FractionalOdd,
    FractionalEven,
}

impl From<SpacingName> for Spacing {
    fn from(name: SpacingName) -> Self {
        match name {
            SpacingName::Equal => Self::Equal,
            SpacingName::FractionalOdd => Self::FractionalOdd,
            SpacingName::FractionalEven => Self::FractionalEven,
        }
    }
}

/// Kinds of crease patches by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum CreasePatchesName {
    /// All creases are refined to the last level
    None,
    /// Infinitely sharp creases bound regular patches
    Infinite,
    /// Semi-sharp creases along an edge of a regular patch, too
    Single,
}

impl From<CreasePatchesName> for CreasePatches {
    fn from(name: CreasePatchesName) -> Self {
        match name {
            CreasePatchesName::None => Self::None,
            CreasePatchesName::Infinite => Self::Infinite,
            CreasePatchesName::Single => Self::Single,
        }
    }
}

/// What a texel of a displacement map says, by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DisplacementKindName {
    /// A distance along the normal
    Scalar,
    /// An offset in the mesh's space
    Vector,
}

impl From<DisplacementKindName> for DisplacementKind {
    fn from(name: DisplacementKindName) -> Self {
        match name {
            DisplacementKindName::Scalar => Self::Scalar,
            DisplacementKindName::Vector => Self::Vector,
        }
    }
}

/// What leads to a texel of a displacement map, by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DisplacementLayoutName {
    /// Texture coordinates
    Uv,
    /// Ptex faces
    Faces,
}

impl From<DisplacementLayoutName> for DisplacementLayout {
    fn from(name: DisplacementLayoutName) -> Self {
        match name {
            DisplacementLayoutName::Uv => Self::Uv,
            DisplacementLayoutName::Faces => Self::Faces,
        }
    }
}

/// Views by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ViewName {
    Shaded,
    Normal,
    Patch,
    Level,
    Tess,
    Uv,
    Color,
    Wire,
}

impl From<ViewName> for View {
    fn from(name: ViewName) -> Self {
        match name {
            ViewName::Shaded => Self::Shaded,
            ViewName::Normal => Self::Normal,
            ViewName::Patch => Self::Patch,
            ViewName::Level => Self::Level,
            ViewName::Tess => Self::Tess,
            ViewName::Uv => Self::Uv,
            ViewName::Color => Self::Color,
            ViewName::Wire => Self::Wire,
        }
    }
}

/// A value as it is written on the command line.
pub fn name_of(value: impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}
