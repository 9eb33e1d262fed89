//! PNG to texels: 8 and 16 bits; palettes and fewer bits are expanded. Values are taken as they are, without a transfer
//! function.
use image::codecs::png::PngDecoder;
use image::{ColorType, ImageDecoder, ImageError};

use super::limits::check_claim;
use super::raster::{Raster, Source, from_samples, undecodable};
use super::texel::TexelFold;
use crate::error::Fault;

pub fn decode(source: Source, fold: &mut TexelFold) -> Result<Raster, Fault> {
    let undecodable = |error: ImageError| undecodable("PNG", error);
    let decoder = PngDecoder::new(source.reader).map_err(undecodable)?;
    let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
    check_claim(width.into(), height.into(), color.bytes_per_pixel().into(), source.bytes)?;
    let mut bytes = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut bytes).map_err(undecodable)?;
    // Alpha comes after the colour, so that a texel's first samples are what is wanted; but grey with alpha has no colour.
    let channel_count = usize::from(color.channel_count());
    let colors = if color == ColorType::La8 || color == ColorType::La16 { 1 } else { channel_count };
    if colors < fold.kind.channel_count() {
        return Err(super::raster::without_vectors("a grey image"));
    }
    if usize::from(color.bytes_per_pixel()) == channel_count {
        return from_samples([width, height], &bytes, channel_count, |byte| f64::from(byte) / 255.0, fold);
    }
    let words: Vec<u16> = bytes.chunks_exact(2).map(|pair| u16::from_ne_bytes([pair[0], pair[1]])).collect();
    from_samples([width, height], &words, channel_count, |word| f64::from(word) / 65535.0, fold)
}
