//! The images that a frame is drawn into.
//!
//! Four colour targets, which every device has, hold all layers but one: colour; normal and depth; position and tess factor;
//! Ptex face, patch with the level in its upper four bits, and u and v as the bits of floats. Colours of vertices have a
//! fifth; motion and texture coordinates share a sixth. What is shaded later has four targets of its own
//! (`glsl/shared/gbuffer.glsl`).

use planish_gpu::{Clear, ColorTarget, DepthTarget, Device, Format, Image, ImageDesc, RenderTargets};

use crate::error::Error;

/// Format of the depth target.
pub(crate) const DEPTH_FORMAT: Format = Format::Depth32Float;
/// A pixel without a surface, in the layer of ids.
pub const NO_SURFACE: u32 = u32::MAX;

/// What images hold besides the beauty image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layers {
    /// Nothing.
    #[default]
    None,
    /// Normal, depth, position, tess factor and ids.
    Geometry,
    /// Those, colours of vertices, motion and texture coordinates.
    GeometryAndColors,
    /// What [`crate::shading`] shades: normal, depth, tangent, object, face, texture coordinates and colours of vertices. There is no
    /// beauty image then.
    Shading,
}

impl Layers {
    /// Number of colour targets.
    pub(crate) fn target_count(self) -> usize {
        match self {
            Self::None => 1,
            Self::Geometry | Self::Shading => 4,
            Self::GeometryAndColors => 6,
        }
    }

    /// Formats of the colour targets.
    pub(crate) fn color_formats(self) -> Vec<Format> {
        let floats = Format::Rgba32Float;
        if self == Self::Shading {
            return vec![Format::Rgba16Float, floats, Format::Rgba32Uint, Format::Rgba16Float];
        }
        [Format::Rgba16Float, floats, floats, Format::Rgba32Uint, floats, floats][..self.target_count()].to_vec()
    }
}

/// Images of one size.
pub struct Targets {
    colors: Vec<Image>,
    depth: Image,
    size: [u32; 2],
    layers: Layers,
}

impl Targets {
    /// Makes them.
    pub fn new(device: &Device, size: [u32; 2], layers: Layers) -> Result<Self, Error> {
        let image = |name: &str, format| Image::new(device, &ImageDesc { name, format, extent: size });
        let names: &[&str] = match layers {
            Layers::Shading => &["colours of vertices", "normal and depth", "objects", "footprints"],
            _ => &[
                "colour",
                "normal and depth",
                "position and factor",
                "ids",
                "colours of vertices",
                "motion and texture coordinates",
            ],
        };
        let colors = names
            .iter()
            .zip(layers.color_formats())
            .map(|(name, format)| image(name, format))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { colors, depth: image("depth", DEPTH_FORMAT)?, size, layers })
    }

    /// Whether there are colours of vertices.
    pub fn has_vertex_colors(&self) -> bool {
        self.layers == Layers::GeometryAndColors
    }

    /// What they were made to hold.
    pub fn held(&self) -> Layers {
        self.layers
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The colour image: four halves a pixel.
    pub fn color(&self) -> &Image {
        &self.colors[0]
    }

    /// The images of the layers: normal and depth, position and tess factor (four floats each), ids (four words), colours of
    /// vertices (four floats, the last being 1 on a surface), motion in pixels to the right and down and texture coordinates (two floats
    /// each).
    pub fn layers(&self) -> &[Image] {
        &self.colors[1..]
    }

    /// Bytes of all images.
    pub fn bytes(&self) -> u64 {
        self.colors.iter().chain([&self.depth]).map(Image::copy_size).sum()
    }

    pub(crate) fn render<R>(&self, f: impl FnOnce(&RenderTargets<'_>) -> R) -> R {
        let black = Clear::Float([0.0; 4]);
        let nothing = Clear::Uint([NO_SURFACE; 4]);
        let clears = match self.layers {
            Layers::Shading => [black, black, nothing, black, black, black],
            _ => [black, black, black, nothing, black, black],
        };
        let colors: Vec<_> =
            self.colors.iter().zip(clears).map(|(image, clear)| ColorTarget { image, clear }).collect();
        let depth = Some(DepthTarget { image: &self.depth, clear: Some(0.0) });
        f(&RenderTargets { colors: &colors, depth, extent: self.size })
    }
}
