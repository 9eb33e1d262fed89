//! The attributes of a part.

use std::io::{self, Seek, SeekFrom, Write};

use exr::error::Result as ExrResult;
use exr::math::Vec2;
use exr::meta::attribute::{self, AttributeValue, Chromaticities, IntegerBounds, LineOrder, Text};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, Headers, MetaData, compute_chunk_count, magic_number, sequence_end};

use crate::{Film, Metadata, metadata::Matrix};

use super::part::Part;

/// Primaries and white point of ITU-R BT.709, as x and y.
const REC_709: Chromaticities =
    Chromaticities { red: Vec2(0.64, 0.33), green: Vec2(0.3, 0.6), blue: Vec2(0.15, 0.06), white: Vec2(0.3127, 0.329) };

/// The string as UTF-8 bytes, which EXR stores without asking for an encoding.
pub(super) fn text(string: &str) -> Text {
    Text::from_slice_unchecked(string.as_bytes())
}

/// The header of a part. Every part has the frame's metadata, so that it tells as much when it is taken out.
pub(super) fn header(film: &Film, part: &Part<'_>) -> Header {
    let window = film.window();
    let layer_size = Vec2(film.width as usize, film.height as usize);
    let compression = part.compression.to_exr();
    let mut own_attributes = attributes(&film.metadata);
    own_attributes.layer_name = part.name.as_deref().map(text);
    own_attributes.layer_position = Vec2(window.x, window.y);
    let mattes = part.cryptomattes.iter().flat_map(|matte| matte.attributes());
    own_attributes.other.extend(mattes.map(|(name, value)| (text(&name), AttributeValue::Text(text(&value)))));
    Header {
        channels: part.channels.list(),
        compression,
        blocks: BlockDescription::ScanLines,
        line_order: LineOrder::Increasing,
        layer_size,
        deep: false,
        deep_data_version: None,
        chunk_count: compute_chunk_count(compression, layer_size, BlockDescription::ScanLines),
        max_samples_per_pixel: None,
        shared_attributes: ImageAttributes {
            chromaticities: Some(REC_709),
            ..ImageAttributes::new(IntegerBounds::from_dimensions((
                window.full_width as usize,
                window.full_height as usize,
            )))
        },
        own_attributes,
    }
}

fn attributes(metadata: &Metadata) -> LayerAttributes {
    let flat = |matrix: Option<Matrix>| matrix.map(|m| std::array::from_fn(|i| m[i / 4][i % 4]));
    let extra = metadata.extra.iter();
    let extra = extra.map(|(name, value)| (text(&format!("planish/{name}")), AttributeValue::Text(text(value))));
    let frame = (text("frame"), AttributeValue::I32(metadata.frame));
    let time = (text("time"), AttributeValue::F32(metadata.time));
    let mut attributes = LayerAttributes {
        world_to_camera: flat(metadata.world_to_camera),
        world_to_normalized_device: flat(metadata.world_to_ndc),
        software_name: Some(text(&metadata.software)).filter(|_| !metadata.software.is_empty()),
        frames_per_second: metadata.frames_per_second,
        exposure: metadata.shutter_seconds,
        aperture: metadata.aperture,
        focus: metadata.focus,
        other: [frame, time].into_iter().chain(extra).collect(),
        ..LayerAttributes::default()
    };
    if let Some(width) = metadata.screen_window_width {
        attributes.screen_window_width = width;
    }
    attributes
}

/// What a file begins with, up to its tables of offsets; attributes are sorted by name.
pub(super) fn sorted_bytes(headers: &Headers) -> ExrResult<Vec<u8>> {
    let requirements = MetaData::validate(headers, true)?;
    let mut bytes = Vec::new();
    magic_number::write(&mut bytes)?;
    requirements.write(&mut bytes)?;
    for header in headers {
        let mut sorted: Vec<_> = header.all_named_attributes().collect();
        sorted.sort_by_key(|&(name, _)| name);
        for (name, value) in sorted {
            attribute::write(name, &value, &mut bytes)?;
        }
        sequence_end::write(&mut bytes)?;
    }
    if requirements.has_multiple_layers {
        sequence_end::write(&mut bytes)?;
    }
    Ok(bytes)
}

/// Puts those bytes in the place of those that the crate wrote.
pub(super) fn overwrite(writer: &mut (impl Write + Seek), bytes: &[u8]) -> io::Result<()> {
    writer.seek(SeekFrom::Start(0))?;
    writer.write_all(bytes)
}
