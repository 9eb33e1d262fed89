//! Where the samples of a part lie.

use exr::block::{BlockIndex, UncompressedBlock, lines::LineRefMut};
use exr::meta::attribute::{ChannelDescription, ChannelList, SampleType};
use half::f16;

use crate::{Film, Layer, Samples, film::COLOR_CHANNELS};

use super::header::text;

/// The channels of a part, sorted by name. They refer to the film: no pixel is copied before its block is compressed.
pub(super) struct Channels<'film> {
    width: usize,
    sorted: Vec<Channel<'film>>,
}

struct Channel<'film> {
    name: String,
    source: Source<'film>,
}

/// Where a channel's samples lie. Sample i of the image is entry `i * stride + offset`.
pub(super) enum Source<'film> {
    Color { pixels: &'film [[f32; 4]], component: usize },
    Half { samples: &'film [f16], stride: usize, offset: usize },
    Float { samples: &'film [f32], stride: usize, offset: usize },
    Uint { samples: &'film [u32], stride: usize, offset: usize },
}

impl<'film> Channels<'film> {
    /// None yet.
    pub fn new(film: &Film) -> Self {
        Self { width: film.width as usize, sorted: Vec::new() }
    }

    pub fn of_color(film: &'film Film) -> Self {
        let mut channels = Self::new(film);
        for (component, name) in COLOR_CHANNELS.into_iter().enumerate() {
            channels.insert(name.to_owned(), Source::Color { pixels: &film.color, component });
        }
        channels
    }

    pub fn add(&mut self, layer: &'film Layer) {
        let stride = layer.channel_count();
        for (offset, name) in layer.channel_names().into_iter().enumerate() {
            let source = match &layer.samples {
                Samples::Half(samples) => Source::Half { samples, stride, offset },
                Samples::Float(samples) => Source::Float { samples, stride, offset },
                Samples::Uint(samples) => Source::Uint { samples, stride, offset },
            };
            self.insert(name, source);
        }
    }

    fn insert(&mut self, name: String, source: Source<'film>) {
        let place = self.sorted.partition_point(|channel| channel.name < name);
        self.sorted.insert(place, Channel { name, source });
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &Source<'film>)> {
        self.sorted.iter().map(|channel| (channel.name.as_str(), &channel.source))
    }

    pub fn list(&self) -> ChannelList {
        let describe =
            |(name, source): (&str, &Source<'_>)| ChannelDescription::named(text(name), source.sample_type());
        ChannelList::new(self.iter().map(describe).collect())
    }

    /// The bytes of a block, row by row, channel by channel.
    pub fn block(&self, channels: &ChannelList, block: BlockIndex) -> Vec<u8> {
        UncompressedBlock::collect_block_data_from_lines(channels, block, |line| self.write_line(line))
    }

    fn write_line(&self, line: LineRefMut<'_>) {
        let first = line.location.position.y() * self.width + line.location.position.x();
        let written = match self.sorted[line.location.channel].source {
            Source::Color { pixels, component } => line.write_samples(|i| f16::from_f32(pixels[first + i][component])),
            Source::Half { samples, stride, offset } => line.write_samples(|i| samples[(first + i) * stride + offset]),
            Source::Float { samples, stride, offset } => line.write_samples(|i| samples[(first + i) * stride + offset]),
            Source::Uint { samples, stride, offset } => line.write_samples(|i| samples[(first + i) * stride + offset]),
        };
        written.expect("a line has room for its samples");
    }
}

impl Source<'_> {
    fn sample_type(&self) -> SampleType {
        match self {
            Source::Color { .. } | Source::Half { .. } => SampleType::F16,
            Source::Float { .. } => SampleType::F32,
            Source::Uint { .. } => SampleType::U32,
        }
    }
}
