//! What a renderer hands over: colour, layers and metadata of one frame.

use std::collections::HashSet;

use crate::{Error, Metadata, Result};

/// The colour's channels, in the order of [`Film::color`].
pub(crate) const COLOR_CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// EXR's limit on a channel's name, in bytes.
const MAX_CHANNEL_NAME: usize = 255;

/// One finished frame. All pixel arrays hold `width * height` pixels, row by row, the top row first, left to right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Scene-linear RGB with the primaries of Rec. 709, premultiplied by the coverage in the fourth component.
    pub color: Vec<[f32; 4]>,
    /// What is stored besides the colour. PNG files leave it out.
    pub layers: Vec<Layer>,
    /// What the header tells about the frame. PNG files leave it out.
    pub metadata: Metadata,
}

/// A named group of channels of one type: depth, normals, ids.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// `Z`, `N`, `uv`, `face` ..; with no components, also the name of the only channel.
    pub name: String,
    /// `X Y Z` of a layer `N` make the channels `N.X N.Y N.Z`; empty: a single channel named as the layer.
    pub components: Vec<String>,
    /// The components of the first pixel, those of the second, and so on: `width * height * channel_count` samples.
    pub samples: Samples,
}

/// The samples of a layer: 32 bits each, stored as they are.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Depths, vectors, parameters, tess factors.
    Float(Vec<f32>),
    /// Ids, levels and the like.
    Uint(Vec<u32>),
}

impl Samples {
    fn len(&self) -> usize {
        match self {
            Samples::Float(samples) => samples.len(),
            Samples::Uint(samples) => samples.len(),
        }
    }
}

impl Layer {
    /// A layer of floats: `Layer::float("N", &["X", "Y", "Z"], normals)`, or `Layer::float("Z", &[], depths)` for a
    /// single channel.
    pub fn float(name: &str, components: &[&str], samples: Vec<f32>) -> Self {
        Self::new(name, components, Samples::Float(samples))
    }

    /// A layer with one unsigned integer a pixel: `Layer::uint("face", faces)`.
    pub fn uint(name: &str, samples: Vec<u32>) -> Self {
        Self::new(name, &[], Samples::Uint(samples))
    }

    fn new(name: &str, components: &[&str], samples: Samples) -> Self {
        Self { name: name.to_owned(), components: components.iter().map(|&c| c.to_owned()).collect(), samples }
    }

    /// Samples a pixel, at least 1.
    pub fn channel_count(&self) -> usize {
        self.components.len().max(1)
    }

    /// The names that the channels have in the file, in the order of the samples.
    pub fn channel_names(&self) -> Vec<String> {
        if self.components.is_empty() {
            return vec![self.name.clone()];
        }
        self.components.iter().map(|component| format!("{}.{component}", self.name)).collect()
    }
}

impl Film {
    /// Width times height.
    pub fn pixel_count(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Whether the film can be written; every writer asks first.
    ///
    /// # Errors
    /// The film has no pixels; the colour or a layer has the wrong length; a channel's name is unfit or taken.
    pub fn check(&self) -> Result<()> {
        let (width, height) = (self.width, self.height);
        if width == 0 || height == 0 {
            return Err(Error::EmptyFilm { width, height });
        }
        let pixel_count = self.pixel_count();
        if self.color.len() as u64 != pixel_count {
            return Err(Error::ColorLength { expected: pixel_count, found: self.color.len() });
        }
        let mut taken: HashSet<String> = COLOR_CHANNELS.map(str::to_owned).into();
        for layer in &self.layers {
            let (channel_count, found) = (layer.channel_count(), layer.samples.len());
            let expected = pixel_count * channel_count as u64;
            if found as u64 != expected {
                return Err(Error::LayerLength { layer: layer.name.clone(), expected, found, channel_count });
            }
            for channel in layer.channel_names() {
                let printable = channel.bytes().all(|byte| byte.is_ascii_graphic() || byte == b' ');
                if channel.is_empty() || channel.len() > MAX_CHANNEL_NAME || !printable {
                    return Err(Error::ChannelName { layer: layer.name.clone(), channel });
                }
                if taken.contains(&channel) {
                    return Err(Error::DuplicateChannel { channel });
                }
                taken.insert(channel);
            }
        }
        Ok(())
    }
}
