//! Image files to texels: PNG, JPEG, OpenEXR, Radiance and TIFF, told by their first bytes.
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use half::f16;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use crate::Error;
use crate::displacement::limits::check_claim;
use crate::error::{Fault, shown};
use crate::material::{ImageContent, ImageSource};

/// Most bytes of an image once decoded.
pub const MAX_IMAGE_BYTES: u64 = 512 << 20;
/// Formats that are read.
const FORMATS: [ImageFormat; 5] =
    [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::OpenExr, ImageFormat::Hdr, ImageFormat::Tiff];
/// What was expected of a file.
const EXPECTED: &str = "a PNG, JPEG, OpenEXR, Radiance or TIFF image";

/// A decoded image, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` texels.
    pub pixels: Pixels,
}

/// Texels of red, green, blue and alpha.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// As the file has them: of sRGB images still encoded.
    Bytes(Vec<[u8; 4]>),
    /// Linear light or plain numbers.
    Halves(Vec<[f16; 4]>),
}

impl DecodedImage {
    /// The texels as linear halves; bytes are decoded if they are sRGB.
    pub fn into_halves(self, is_srgb: bool) -> Vec<[f16; 4]> {
        match self.pixels {
            Pixels::Halves(texels) => texels,
            Pixels::Bytes(texels) => {
                let value = |byte: u8| f32::from(byte) / 255.0;
                texels.iter().map(|texel| half_texel(texel.map(value), is_srgb)).collect()
            }
        }
    }
}

/// Decodes an image of a scene. Of images with more than 8 bits a channel that hold no light, those of 16, sRGB ones are decoded, which
/// `is_srgb` says.
///
/// # Errors
/// [`Error::Image`] for a file that cannot be read, is of another format, claims more than [`MAX_IMAGE_BYTES`] or is damaged.
pub fn decode_image(source: &ImageSource, is_srgb: bool) -> Result<DecodedImage, Error> {
    let error =
        |fault: Fault| Error::Image { image: source.name.clone(), found: fault.found, expected: fault.expected };
    let read;
    let bytes = match &source.content {
        ImageContent::Bytes(bytes) => bytes,
        ImageContent::File(path) => {
            let metadata = std::fs::metadata(path).map_err(|reason| error(unreadable(path, &reason)))?;
            if !metadata.is_file() {
                let found = format!("something that is no regular file at {}", told(path));
                return Err(error(Fault::whole(found, EXPECTED)));
            }
            read = std::fs::read(path).map_err(|reason| error(unreadable(path, &reason)))?;
            &read
        }
    };
    // Decoders are others' code and index what files tell them to: a panic of theirs is a fault of the file.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(bytes, is_srgb)));
    decoded.unwrap_or_else(|_| Err(damaged("content that the decoder cannot cope with"))).map_err(error)
}

fn told(path: &Path) -> String {
    shown(&path.display().to_string())
}

fn unreadable(path: &Path, reason: &std::io::Error) -> Fault {
    Fault::whole(format!("no file that can be read at {} ({reason})", told(path)), EXPECTED)
}

fn damaged(found: impl std::fmt::Display) -> Fault {
    Fault::whole(shown(&found.to_string()).to_string(), "an intact image")
}

fn decode(bytes: &[u8], is_srgb: bool) -> Result<DecodedImage, Fault> {
    let format = image::guess_format(bytes).ok().filter(|format| FORMATS.contains(format));
    let format = format.ok_or_else(|| Fault::whole("a file of unknown format", EXPECTED))?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_IMAGE_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    let texel_bytes = u64::from(decoder.color_type().bytes_per_pixel());
    check_claim(width.into(), height.into(), texel_bytes, bytes.len() as u64)?;
    let claimed = decoder.total_bytes();
    if claimed > MAX_IMAGE_BYTES {
        let found = format!("an image of {width} x {height} texels, {claimed} bytes");
        return Err(Fault::whole(found, format!("at most {MAX_IMAGE_BYTES} bytes when decoded")));
    }
    let image = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    Ok(DecodedImage { width, height, pixels: pixels(image, is_srgb) })
}

fn pixels(image: DynamicImage, is_srgb: bool) -> Pixels {
    match image {
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => Pixels::Bytes(image.into_rgba8().pixels().map(|pixel| pixel.0).collect()),
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            Pixels::Halves(image.into_rgba32f().pixels().map(|pixel| half_texel(pixel.0, false)).collect())
        }
        _ => {
            let value = |word: u16| f32::from(word) / 65535.0;
            let texels = image.into_rgba16();
            Pixels::Halves(texels.pixels().map(|pixel| half_texel(pixel.0.map(value), is_srgb)).collect())
        }
    }
}

/// A texel in halves; what is no number is 0, what is too large as large as can be.
fn half_texel(texel: [f32; 4], is_srgb: bool) -> [f16; 4] {
    let finite = |value: f32| if value.is_nan() { 0.0 } else { value.clamp(-65504.0, 65504.0) };
    let [r, g, b, a] = texel.map(finite);
    let color = |value: f32| f16::from_f32(if is_srgb { decoded(value) } else { value });
    [color(r), color(g), color(b), f16::from_f32(a)]
}

/// An sRGB value as light (IEC 61966-2-1).
fn decoded(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use image::{ImageBuffer, Luma, Rgb, Rgba};

    use super::*;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn decode_bytes(bytes: Vec<u8>, is_srgb: bool) -> Result<DecodedImage, Error> {
        decode_image(&ImageSource { name: "i".to_owned(), content: ImageContent::Bytes(bytes) }, is_srgb)
    }

    #[test]
    fn bytes_come_back_as_they_are_from_png_and_tiff() {
        let image = DynamicImage::from(ImageBuffer::from_fn(3, 2, |x, y| Rgba([10 * x as u8, 20 * y as u8, 30, 200])));
        for format in [ImageFormat::Png, ImageFormat::Tiff] {
            let found = decode_bytes(encoded(&image, format), true).unwrap();
            assert_eq!((found.width, found.height), (3, 2));
            let Pixels::Bytes(texels) = found.pixels else { panic!("bytes") };
            assert_eq!((texels[1], texels[3]), ([10, 0, 30, 200], [0, 20, 30, 200]));
        }
    }

    #[test]
    fn a_jpeg_is_about_what_it_was() {
        let image = DynamicImage::from(ImageBuffer::from_pixel(16, 16, Rgb([200_u8, 100, 50])));
        let found = decode_bytes(encoded(&image, ImageFormat::Jpeg), true).unwrap();
        let Pixels::Bytes(texels) = found.pixels else { panic!("bytes") };
        assert!(texels[100].iter().zip([200, 100, 50, 255]).all(|(&a, b): (&u8, i32)| (i32::from(a) - b).abs() < 6));
    }

    #[test]
    fn light_of_exr_and_radiance_files_is_kept_beyond_1() {
        let image = DynamicImage::from(ImageBuffer::from_pixel(4, 2, Rgb([20.0_f32, 0.5, 0.0])));
        for format in [ImageFormat::OpenExr, ImageFormat::Hdr] {
            let found = decode_bytes(encoded(&image, format), true).unwrap();
            let Pixels::Halves(texels) = found.pixels else { panic!("halves") };
            assert_eq!(texels.len(), 8);
            assert_eq!(texels[5].map(f16::to_f32), [20.0, 0.5, 0.0, 1.0], "{format:?}");
        }
    }

    #[test]
    fn sixteen_bits_of_srgb_are_decoded() {
        let image = DynamicImage::from(ImageBuffer::from_pixel(1, 1, Luma([32768_u16])));
        let value = |is_srgb| decode_bytes(encoded(&image, ImageFormat::Png), is_srgb).unwrap().into_halves(is_srgb)[0];
        assert!((value(true)[0].to_f32() - 0.214).abs() < 1e-3);
        assert!((value(false)[0].to_f32() - 0.5).abs() < 1e-3);
    }

    #[test]
    fn what_is_no_number_is_black_and_what_is_too_large_ends() {
        let texel = half_texel([f32::NAN, f32::INFINITY, -1e30, 1.0], false).map(f16::to_f32);
        assert_eq!(texel, [0.0, 65504.0, -65504.0, 1.0]);
    }

    #[test]
    fn damaged_files_are_told_in_one_line() {
        let image = DynamicImage::from(ImageBuffer::from_fn(64, 64, |x, y| Rgba([x as u8, y as u8, 0, 255])));
        for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::OpenExr, ImageFormat::Hdr, ImageFormat::Tiff] {
            let image = match format {
                ImageFormat::OpenExr | ImageFormat::Hdr => DynamicImage::from(image.to_rgb32f()),
                ImageFormat::Jpeg => DynamicImage::from(image.to_rgb8()),
                _ => image.clone(),
            };
            let whole = encoded(&image, format);
            for length in (0..whole.len()).step_by(whole.len() / 60 + 1) {
                // Some decoders fill in what is missing; none panics or claims more than there is.
                if let Err(error) = decode_bytes(whole[..length].to_vec(), false) {
                    let message = error.to_string();
                    assert!(message.starts_with("image i: found ") && !message.contains('\n'), "{message}");
                }
            }
        }
        let message = decode_bytes(b"hello".to_vec(), false).unwrap_err().to_string();
        assert_eq!(message, format!("image i: found a file of unknown format, expected {EXPECTED}"));
    }

    #[test]
    fn a_small_file_that_claims_a_huge_image_is_refused() {
        // A PNG header of 16000 x 16000 RGBA: 1 GB.
        let image = DynamicImage::from(ImageBuffer::from_pixel(1, 1, Rgba([0_u8; 4])));
        let mut bytes = encoded(&image, ImageFormat::Png);
        for at in [16, 20] {
            bytes[at..at + 4].copy_from_slice(&16000_u32.to_be_bytes());
        }
        assert!(decode_bytes(bytes, false).is_err());
    }

    #[test]
    fn a_missing_file_is_told_by_the_name_of_its_image_and_its_path() {
        let content = ImageContent::File("/nowhere/at/all.png".into());
        let error = decode_image(&ImageSource { name: "wood".to_owned(), content }, true).unwrap_err();
        let message = error.to_string();
        assert!(
            message.starts_with("image wood: found no file that can be read at /nowhere/at/all.png ("),
            "{message}"
        );
    }
}
