//! An EXR file's channels.

use std::collections::BTreeMap;
use std::path::Path;

use exr::prelude::{FlatSamples, SampleType, read_first_flat_layer_from_file};

/// A 4x4 matrix for row vectors, as EXR stores it.
pub type Matrix = [f32; 16];

/// An EXR file of one part.
pub struct Layers {
    /// Width and height.
    pub size: [usize; 2],
    /// Where its data window begins in the whole image.
    pub position: [i32; 2],
    /// To the camera's space: x right, y up, z forwards.
    pub world_to_camera: Matrix,
    /// To the image: (0, 0) upper left, (1, 1) lower right.
    pub world_to_ndc: Matrix,
    /// What wrote it.
    pub software: String,
    channels: BTreeMap<String, FlatSamples>,
}

impl Layers {
    /// Reads a file that planish wrote.
    pub fn read(path: &Path) -> Self {
        let image = read_first_flat_layer_from_file(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let layer = image.layer_data;
        let attributes = layer.attributes;
        let channels = layer.channel_data.list.into_iter();
        Self {
            size: [layer.size.x(), layer.size.y()],
            position: [attributes.layer_position.x(), attributes.layer_position.y()],
            world_to_camera: attributes.world_to_camera.expect("the header has worldToCamera"),
            world_to_ndc: attributes.world_to_normalized_device.expect("the header has worldToNDC"),
            software: attributes.software_name.expect("the header has software").to_string(),
            channels: channels.map(|channel| (channel.name.to_string(), channel.sample_data)).collect(),
        }
    }

    /// Every channel's name and type, sorted by name.
    pub fn types(&self) -> Vec<(&str, SampleType)> {
        let kind = |samples: &FlatSamples| match samples {
            FlatSamples::F16(_) => SampleType::F16,
            FlatSamples::F32(_) => SampleType::F32,
            FlatSamples::U32(_) => SampleType::U32,
        };
        self.channels.iter().map(|(name, samples)| (name.as_str(), kind(samples))).collect()
    }

    /// The samples of a channel of floats, half or whole.
    pub fn floats(&self, name: &str) -> Vec<f32> {
        match &self.channels[name] {
            FlatSamples::F16(samples) => samples.iter().map(|sample| sample.to_f32()).collect(),
            FlatSamples::F32(samples) => samples.clone(),
            FlatSamples::U32(_) => panic!("{name} holds integers"),
        }
    }

    /// The samples of a channel of integers.
    pub fn integers(&self, name: &str) -> &[u32] {
        match &self.channels[name] {
            FlatSamples::U32(samples) => samples,
            _ => panic!("{name} holds floats"),
        }
    }

    /// The samples of a layer of several channels, named `NAME.COMPONENT`.
    pub fn vectors<const N: usize>(&self, name: &str, components: [&str; N]) -> Vec<[f32; N]> {
        let channels = components.map(|component| self.floats(&format!("{name}.{component}")));
        (0..channels[0].len()).map(|pixel| std::array::from_fn(|component| channels[component][pixel])).collect()
    }
}

/// A point through a matrix, after division by w.
pub fn transform(point: [f32; 3], matrix: &Matrix) -> [f64; 3] {
    let entry = |row: usize, column: usize| f64::from(matrix[4 * row + column]);
    let image: [f64; 4] = std::array::from_fn(|column| {
        (0..3).map(|row| f64::from(point[row]) * entry(row, column)).sum::<f64>() + entry(3, column)
    });
    [0, 1, 2].map(|axis| image[axis] / image[3])
}
