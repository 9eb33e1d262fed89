//! What is asked for: a file, and what its values mean.
use std::path::PathBuf;

/// What a texel says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DisplacementKind {
    /// One number: how far along the limit surface's unit normal, in the mesh' own units.
    #[default]
    Scalar,
    /// Three: an offset (x, y, z) = (r, g, b) in the mesh' own space.
    Vector,
}

impl DisplacementKind {
    /// Numbers in a texel.
    pub fn channel_count(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => 3,
        }
    }
}

/// What leads from a point of the surface to a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DisplacementLayout {
    /// Texture coordinates: one image that repeats, or UDIM tiles.
    #[default]
    Uv,
    /// Ptex faces and their own (u, v): an atlas of one tile a Ptex face. It has no seams.
    Faces,
}

/// A displacement map as it is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementRequest {
    /// An .exr, .png, .tif or .tiff file; `<UDIM>` or `<UVTILE>` in its name stands for the tile.
    pub path: PathBuf,
    /// What a texel says.
    pub kind: DisplacementKind,
    /// What leads to a texel.
    pub layout: DisplacementLayout,
    /// A texel displaces by scale * (value - midpoint).
    pub scale: f64,
    /// The value that does not displace.
    pub midpoint: f64,
}

impl DisplacementRequest {
    /// Scalar, over texture coordinates, scale 1 and midpoint 0.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            kind: DisplacementKind::default(),
            layout: DisplacementLayout::default(),
            scale: 1.0,
            midpoint: 0.0,
        }
    }
}
