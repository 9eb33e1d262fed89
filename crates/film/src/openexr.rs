//! Films to OpenEXR.

use std::{io, path::Path};

use exr::{
    block::{BlockIndex, UncompressedBlock, lines::LineRefMut},
    image::write::channels::{ChannelsWriter, WritableChannels},
    math::RoundingMode,
    meta::{
        attribute::{ChannelList, LevelMode},
        header::Header,
    },
    prelude::{
        AttributeValue, Blocks, ChannelDescription, Compression, Encoding, Image, Layer as ExrLayer, LayerAttributes,
        LineOrder, SampleType, Text, WritableImage, f16,
    },
};

use crate::{Error, Film, Metadata, Result, Samples, atomic, film::COLOR_CHANNELS, metadata::Matrix};

/// Writes the film as a single-part scan-line EXR file with ZIP compression (16 rows a block).
///
/// The colour becomes `R G B A` in half precision, rounded to nearest even: beyond 65504 plus half a step it is
/// infinite, and infinities and not-a-numbers pass. Layers keep their 32 bits. Channels are sorted by name as the
/// format demands. [`Metadata`] lists the attributes.
///
/// # Errors
/// Those of [`Film::check`]; [`Error::Write`], [`Error::NoFolder`], [`Error::NotAFolder`], [`Error::NotAFile`].
pub fn write_exr(film: &Film, path: &Path) -> Result<()> {
    film.check()?;
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let size = (film.width as usize, film.height as usize);
    let layer = ExrLayer::new(size, attributes(&film.metadata), encoding, Channels::of(film));
    let mut image = Image::from_layer(layer);
    // Custom attributes lie in hash maps, whose order is random: of the two, one goes here and one into the layer's
    // map.
    image.attributes.other.insert(text("time"), AttributeValue::F32(film.metadata.time));
    atomic::write(path, |writer| {
        image.write().to_buffered(writer).map_err(|error| {
            Error::write(
                path,
                match error {
                    exr::error::Error::Io(error) => error,
                    other => io::Error::other(other),
                },
            )
        })
    })
}

/// The header's attributes, all but the time.
fn attributes(metadata: &Metadata) -> LayerAttributes {
    let flat = |matrix: Option<Matrix>| matrix.map(|m| std::array::from_fn(|i| m[i / 4][i % 4]));
    LayerAttributes {
        world_to_camera: flat(metadata.world_to_camera),
        world_to_normalized_device: flat(metadata.world_to_ndc),
        software_name: Some(text(&metadata.software)).filter(|_| !metadata.software.is_empty()),
        frames_per_second: metadata.frames_per_second,
        other: [(text("frame"), AttributeValue::I32(metadata.frame))].into(),
        ..LayerAttributes::default()
    }
}

/// The string as UTF-8 bytes, which EXR stores without asking for an encoding.
fn text(string: &str) -> Text {
    Text::from_slice_unchecked(string.as_bytes())
}

/// The channels of a film, sorted by name. They refer to the film: no pixel is copied before its block is compressed.
struct Channels<'film> {
    width: usize,
    sorted: Vec<Channel<'film>>,
}

struct Channel<'film> {
    name: String,
    source: Source<'film>,
}

/// Where a channel's samples lie. Sample i of the image is entry `i * stride + offset`.
enum Source<'film> {
    Color { pixels: &'film [[f32; 4]], component: usize },
    Float { samples: &'film [f32], stride: usize, offset: usize },
    Uint { samples: &'film [u32], stride: usize, offset: usize },
}

impl<'film> Channels<'film> {
    fn of(film: &'film Film) -> Self {
        let color = COLOR_CHANNELS.iter().enumerate().map(|(component, &name)| Channel {
            name: name.to_owned(),
            source: Source::Color { pixels: &film.color, component },
        });
        let layers = film.layers.iter().flat_map(|layer| {
            let stride = layer.channel_count();
            layer.channel_names().into_iter().enumerate().map(move |(offset, name)| Channel {
                name,
                source: match &layer.samples {
                    Samples::Float(samples) => Source::Float { samples, stride, offset },
                    Samples::Uint(samples) => Source::Uint { samples, stride, offset },
                },
            })
        });
        let mut sorted: Vec<_> = color.chain(layers).collect();
        sorted.sort_by(|a, b| a.name.cmp(&b.name));
        Self { width: film.width as usize, sorted }
    }

    fn write_line(&self, line: LineRefMut<'_>) {
        let first = line.location.position.y() * self.width + line.location.position.x();
        let written = match self.sorted[line.location.channel].source {
            Source::Color { pixels, component } => line.write_samples(|i| f16::from_f32(pixels[first + i][component])),
            Source::Float { samples, stride, offset } => line.write_samples(|i| samples[(first + i) * stride + offset]),
            Source::Uint { samples, stride, offset } => line.write_samples(|i| samples[(first + i) * stride + offset]),
        };
        written.expect("a line has room for its samples");
    }
}

impl Source<'_> {
    fn sample_type(&self) -> SampleType {
        match self {
            Source::Color { .. } => SampleType::F16,
            Source::Float { .. } => SampleType::F32,
            Source::Uint { .. } => SampleType::U32,
        }
    }
}

impl<'a, 'film: 'a> WritableChannels<'a> for Channels<'film> {
    type Writer = &'a Self;

    fn infer_channel_list(&self) -> ChannelList {
        let describe = |channel: &Channel| ChannelDescription::named(text(&channel.name), channel.source.sample_type());
        ChannelList::new(self.sorted.iter().map(describe).collect())
    }

    fn infer_level_modes(&self) -> (LevelMode, RoundingMode) {
        (LevelMode::Singular, RoundingMode::Down)
    }

    fn create_writer(&'a self, _: &Header) -> Self::Writer {
        self
    }
}

impl ChannelsWriter for &Channels<'_> {
    fn extract_uncompressed_block(&self, header: &Header, block: BlockIndex) -> Vec<u8> {
        UncompressedBlock::collect_block_data_from_lines(&header.channels, block, |line| self.write_line(line))
    }
}
