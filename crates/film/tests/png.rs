//! Films to PNG, read back.

use std::{fs, path::PathBuf};

use image::{ColorType, DynamicImage, ImageReader};
use planish_film::{Film, Layer, write_png};

fn film(width: u32, height: u32, color: Vec<[f32; 4]>) -> Film {
    Film { width, height, color, ..Film::default() }
}

struct Written {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

impl Written {
    fn new(film: &Film) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.png");
        write_png(film, &path).unwrap();
        Self { _folder: folder, path }
    }

    fn image(&self) -> DynamicImage {
        ImageReader::open(&self.path).unwrap().decode().unwrap()
    }

    fn bytes(&self) -> Vec<u8> {
        fs::read(&self.path).unwrap()
    }
}

#[test]
fn an_opaque_film_becomes_srgb_without_alpha() {
    // The standard's values: the linear segment ends at 0.0031308; 18 % grey is 118, half is 188.
    let linear = [0.0, 0.001, 0.003_130_8, 0.18, 0.5, 1.0, 2.5, -1.0, f32::NAN];
    let codes = [0, 3, 10, 118, 188, 255, 255, 0, 0];
    let film = film(9, 1, linear.map(|value| [value, value, value, 1.0]).to_vec());
    let image = Written::new(&film).image();
    assert_eq!(image.color(), ColorType::Rgb8);
    assert_eq!(image.into_rgb8().pixels().map(|pixel| pixel.0).collect::<Vec<_>>(), codes.map(|code| [code; 3]));
}

#[test]
fn a_translucent_film_is_divided_by_its_alpha() {
    let film =
        film(2, 2, vec![[0.5, 0.25, 0.0, 0.5], [0.0, 0.0, 0.0, 0.0], [3.0, 3.0, 3.0, 0.0], [1.0, 0.5, 0.0, 1.0]]);
    let image = Written::new(&film).image();
    assert_eq!(image.color(), ColorType::Rgba8);
    let pixels: Vec<_> = image.into_rgba8().pixels().map(|pixel| pixel.0).collect();
    assert_eq!(pixels, [[255, 188, 0, 128], [0; 4], [0; 4], [255, 188, 0, 255]]);
}

#[test]
fn rows_run_from_the_top() {
    let film = film(1, 2, vec![[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
    let image = Written::new(&film).image().into_rgb8();
    assert_eq!(image.get_pixel(0, 0).0, [255, 0, 0]);
    assert_eq!(image.get_pixel(0, 1).0, [0, 0, 255]);
}

#[test]
fn alpha_that_rounds_to_opaque_needs_no_alpha_channel() {
    let image = Written::new(&film(2, 1, vec![[0.2, 0.2, 0.2, 0.999_999], [0.2, 0.2, 0.2, 1.5]])).image();
    assert_eq!(image.color(), ColorType::Rgb8);
}

/// The CRC of PNG (ISO 3309), bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let bit = |crc: u32, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), bit))
}

#[test]
fn chunks_are_ihdr_srgb_idat_iend_with_valid_checksums() {
    let bytes = Written::new(&film(3, 2, vec![[0.3, 0.2, 0.1, 1.0]; 6])).bytes();
    let mut rest = &bytes[8..];
    let mut names = Vec::new();
    while !rest.is_empty() {
        let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
        let (chunk, after) = rest.split_at(12 + length);
        let stored = u32::from_be_bytes(chunk[8 + length..].try_into().unwrap());
        assert_eq!(crc(&chunk[4..8 + length]), stored);
        names.push(String::from_utf8(chunk[4..8].to_vec()).unwrap());
        rest = after;
    }
    assert_eq!(names, ["IHDR", "sRGB", "IDAT", "IEND"]);
}

#[test]
fn equal_films_give_equal_bytes() {
    let color = (0..64 * 64).map(|i| [i as f32 / 4096.0, 0.5, (i % 64) as f32 / 64.0, 1.0]).collect();
    let film = film(64, 64, color);
    assert_eq!(Written::new(&film).bytes(), Written::new(&film).bytes());
}

#[test]
fn unfit_films_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let message = |film: &Film| write_png(film, &path).unwrap_err().to_string();
    assert_eq!(message(&film(0, 0, Vec::new())), "a film of 0x0 pixels cannot be written; expected at least 1x1");
    let mut odd = film(1, 1, vec![[0.0; 4]]);
    odd.layers.push(Layer::float("N", &["X", "Y", "Z"], vec![0.0]));
    assert_eq!(message(&odd), "layer N has 1 samples; expected 3, 3 a pixel");
    assert!(!path.exists());
}
