//! TIFF to texels: grey, RGB or RGBA of 8 to 64 bits, integers or floats; uncompressed, LZW, Deflate or PackBits.
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{PlanarConfiguration, Tag};
use tiff::{ColorType, TiffError};

use super::limits::{MAX_DECODED_BYTES, check_claim};
use super::raster::{Raster, Source, from_samples, undecodable, without_vectors};
use super::texel::TexelFold;
use crate::error::Fault;

/// Most bytes of a list in a directory: two offsets of 8 bytes for every row, and room.
const MAX_LIST_BYTES: usize = 1 << 20;

pub fn decode(source: Source, fold: &mut TexelFold) -> Result<Raster, Fault> {
    let undecodable = |error: TiffError| undecodable("TIFF", error);
    let mut decoder = Decoder::new(source.reader).map_err(undecodable)?;
    let (width, height) = decoder.dimensions().map_err(undecodable)?;
    let (channel_count, bits) = match decoder.colortype().map_err(undecodable)? {
        ColorType::Gray(bits) => (1, bits),
        ColorType::GrayA(bits) => (2, bits),
        ColorType::RGB(bits) => (3, bits),
        ColorType::RGBA(bits) => (4, bits),
        other => return Err(Fault::whole(format!("a TIFF image of {other:?}"), "grey, RGB or RGBA")),
    };
    let texel_bytes = channel_count * u64::from(bits.div_ceil(8));
    check_claim(width.into(), height.into(), texel_bytes, source.bytes)?;
    if fold.kind.channel_count() == 3 && channel_count < 3 {
        return Err(without_vectors("a grey image"));
    }
    if ![8, 16, 32, 64].contains(&bits) {
        return Err(Fault::whole(format!("a TIFF image of {bits} bits a sample"), "8, 16, 32 or 64"));
    }
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(undecodable)?;
    if channel_count > 1 && planes.is_some_and(|planes| planes != PlanarConfiguration::Chunky.to_u16()) {
        return Err(Fault::whole("a TIFF image of one plane a channel", "interleaved channels"));
    }
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_DECODED_BYTES as usize;
    // A strip may be the whole image.
    limits.intermediate_buffer_size = MAX_DECODED_BYTES.min(source.bytes.saturating_mul(2).max(1 << 20)) as usize;
    limits.ifd_value_size = MAX_LIST_BYTES;
    let samples = decoder.with_limits(limits).read_image().map_err(undecodable)?;
    let size = [width, height];
    let channels = channel_count as usize;
    match samples {
        DecodingResult::U8(samples) => from_samples(size, &samples, channels, |s| f64::from(s) / 255.0, fold),
        DecodingResult::U16(samples) => from_samples(size, &samples, channels, |s| f64::from(s) / 65535.0, fold),
        DecodingResult::U32(samples) => {
            from_samples(size, &samples, channels, |s| f64::from(s) / f64::from(u32::MAX), fold)
        }
        DecodingResult::U64(samples) => from_samples(size, &samples, channels, |s| s as f64 / u64::MAX as f64, fold),
        DecodingResult::I8(samples) => from_samples(size, &samples, channels, |s| f64::from(s) / 127.0, fold),
        DecodingResult::I16(samples) => from_samples(size, &samples, channels, |s| f64::from(s) / 32767.0, fold),
        DecodingResult::I32(samples) => {
            from_samples(size, &samples, channels, |s| f64::from(s) / f64::from(i32::MAX), fold)
        }
        DecodingResult::I64(samples) => from_samples(size, &samples, channels, |s| s as f64 / i64::MAX as f64, fold),
        DecodingResult::F16(samples) => from_samples(size, &samples, channels, f64::from, fold),
        DecodingResult::F32(samples) => from_samples(size, &samples, channels, f64::from, fold),
        DecodingResult::F64(samples) => from_samples(size, &samples, channels, |s| s, fold),
    }
}
