//! What a film holds besides its colour.

use half::f16;

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

/// The samples of a layer, stored as they are.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Light and other values for which 11 bits of mantissa do.
    Half(Vec<f16>),
    /// Depths, vectors, parameters, tess factors.
    Float(Vec<f32>),
    /// Ids, levels and the like.
    Uint(Vec<u32>),
}

impl Samples {
    pub(crate) fn len(&self) -> usize {
        match self {
            Samples::Half(samples) => samples.len(),
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

    /// A layer of half floats, rounded to nearest even: `Layer::half("albedo", &["R", "G", "B"], &colors)`.
    pub fn half(name: &str, components: &[&str], samples: &[f32]) -> Self {
        Self::new(name, components, Samples::Half(samples.iter().map(|&sample| f16::from_f32(sample)).collect()))
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
