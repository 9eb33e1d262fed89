//! Names on the command line for what the renderer offers.

use clap::ValueEnum;
use planish_render::{Spacing, View};
use planish_scene::displacement::{DisplacementKind, DisplacementLayout};
use planish_subdiv::refine::CreasePatches;

/// Surface methods by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MethodName {
    Fas,
    Dfas,
    Gregory,
    Table,
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

/// Normals of Gregory patches by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GregoryNormalsName {
    /// Of the Bezier form (Loop et al. 2009, section 4.4)
    Approximate,
    /// Of the rational patch
    Exact,
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
    CatmullClark,
    Loop,
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
