//! The images that a frame is drawn into.
//!
//! Four colour targets, which every device has, hold all layers: colour; normal and depth; position and tess factor;
//! Ptex face, patch with the level in its upper four bits, and u and v as the bits of floats.

use planish_gpu::{Clear, ColorTarget, DepthTarget, Device, Format, Image, ImageDesc, RenderTargets};

use crate::error::Error;

/// Format of the depth target.
pub(crate) const DEPTH_FORMAT: Format = Format::Depth32Float;
/// A pixel without a surface, in the layer of ids.
pub const NO_SURFACE: u32 = u32::MAX;

/// Formats of the colour targets.
pub(crate) fn color_formats(layers: bool) -> Vec<Format> {
    let all = [Format::Rgba16Float, Format::Rgba32Float, Format::Rgba32Float, Format::Rgba32Uint];
    all[..if layers { 4 } else { 1 }].to_vec()
}

/// Images of one size.
pub struct Targets {
    colors: Vec<Image>,
    depth: Image,
    size: [u32; 2],
}

impl Targets {
    /// Makes them; `layers` adds normal, depth, position, tess factor and ids to the colour.
    pub fn new(device: &Device, size: [u32; 2], layers: bool) -> Result<Self, Error> {
        let image = |name: &str, format| Image::new(device, &ImageDesc { name, format, extent: size });
        let names = ["colour", "normal and depth", "position and factor", "ids"];
        let colors = names
            .iter()
            .zip(color_formats(layers))
            .map(|(name, format)| image(name, format))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self { colors, depth: image("depth", DEPTH_FORMAT)?, size })
    }

    /// Whether there is more than colour.
    pub fn has_layers(&self) -> bool {
        self.colors.len() > 1
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The colour image: four halves a pixel.
    pub fn color(&self) -> &Image {
        &self.colors[0]
    }

    /// The images of the layers: normal and depth, position and tess factor (four floats each), ids (four words).
    pub fn layers(&self) -> &[Image] {
        &self.colors[1..]
    }

    /// Bytes of all images.
    pub fn bytes(&self) -> u64 {
        self.colors.iter().chain([&self.depth]).map(Image::copy_size).sum()
    }

    pub(crate) fn render<R>(&self, f: impl FnOnce(&RenderTargets<'_>) -> R) -> R {
        let clears =
            [Clear::Float([0.0; 4]), Clear::Float([0.0; 4]), Clear::Float([0.0; 4]), Clear::Uint([NO_SURFACE; 4])];
        let colors: Vec<_> =
            self.colors.iter().zip(clears).map(|(image, clear)| ColorTarget { image, clear }).collect();
        let depth = Some(DepthTarget { image: &self.depth, clear: Some(0.0) });
        f(&RenderTargets { colors: &colors, depth, extent: self.size })
    }
}
