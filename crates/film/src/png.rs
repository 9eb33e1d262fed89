//! Films to PNG.

use std::{
    io::{self, Write},
    path::Path,
};

use image::{
    ExtendedColorType, ImageEncoder, ImageError,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use crate::{Error, Film, Result, ToneMap, atomic, srgb};

/// Where the first chunk ends: 8 bytes of signature, then IHDR with 4 of length, 4 of type, 13 of data and 4 of
/// checksum.
const IHDR_END: usize = 8 + 4 + 4 + 13 + 4;

/// The chunk that declares sRGB with perceptual intent (0): length 1, type, intent, CRC of type and intent. The encoder
/// writes none.
const SRGB_CHUNK: [u8; 13] = [0, 0, 0, 1, b's', b'R', b'G', b'B', 0, 0xae, 0xce, 0x1c, 0xe9];

/// How a PNG file is made of a film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PngOptions {
    /// From scene to display.
    pub tone_map: ToneMap,
    /// Before that, in stops: light is multiplied by 2 to the power of this.
    pub exposure: f32,
}

/// [`write_png_with`] the default options: light is clipped to 0 .. 1.
///
/// # Errors
/// As [`write_png_with`].
pub fn write_png(film: &Film, path: &Path) -> Result<()> {
    write_png_with(film, path, &PngOptions::default())
}

/// Writes the film's colour as PNG: 8 bits, sRGB transfer function, declared by an `sRGB` chunk.
///
/// Light is exposed, tone mapped and clamped to 0 .. 1; alpha is not. An opaque film, whose alpha rounds to 255 everywhere,
/// becomes RGB; any other RGBA with the colour divided by alpha, as PNG wants it, and with black where alpha is 0:
/// light without coverage is lost. Layers and metadata are left out.
///
/// # Errors
/// Those of [`Film::check`]; [`Error::Exposure`]; [`Error::Write`], [`Error::NoFolder`], [`Error::NotAFolder`],
/// [`Error::NotAFile`].
pub fn write_png_with(film: &Film, path: &Path, options: &PngOptions) -> Result<()> {
    film.check()?;
    if !options.exposure.exp2().is_normal() {
        return Err(Error::Exposure { stops: options.exposure });
    }
    let failed = |source| Error::write(path, source);
    let encoded = encode(film, options).map_err(failed)?;
    atomic::write(path, |writer| {
        [&encoded[..IHDR_END], &SRGB_CHUNK, &encoded[IHDR_END..]]
            .iter()
            .try_for_each(|part| writer.write_all(part))
            .map_err(failed)
    })
}

/// The whole file but its `sRGB` chunk.
fn encode(film: &Film, options: &PngOptions) -> io::Result<Vec<u8>> {
    let (bytes, color_type) = quantize(&film.color, options);
    let mut encoded = Vec::new();
    PngEncoder::new_with_quality(&mut encoded, CompressionType::Default, FilterType::Adaptive)
        .write_image(&bytes, film.width, film.height, color_type)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })?;
    Ok(encoded)
}

/// Premultiplied linear pixels to bytes, three or four a pixel.
fn quantize(color: &[[f32; 4]], options: &PngOptions) -> (Vec<u8>, ExtendedColorType) {
    let encoder = srgb::Encoder::new();
    let exposure = options.exposure.exp2();
    let rgb = |&[r, g, b, alpha]: &[f32; 4]| {
        let scale = if alpha > 0.0 && alpha < 1.0 { exposure / alpha } else { exposure };
        options.tone_map.map([r, g, b].map(|value| value * scale)).map(|value| encoder.encode(value))
    };
    if color.iter().all(|pixel| quantize_alpha(pixel[3]) == u8::MAX) {
        return (color.iter().flat_map(rgb).collect(), ExtendedColorType::Rgb8);
    }
    let rgba = |pixel: &[f32; 4]| {
        let [r, g, b] = if pixel[3] > 0.0 { rgb(pixel) } else { [0; 3] };
        [r, g, b, quantize_alpha(pixel[3])]
    };
    (color.iter().flat_map(rgba).collect(), ExtendedColorType::Rgba8)
}

/// Coverage to 8 bits, linear; not a number is 0.
fn quantize_alpha(alpha: f32) -> u8 {
    (alpha.clamp(0.0, 1.0) * f32::from(u8::MAX)).round() as u8
}
