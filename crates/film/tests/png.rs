//! Films to PNG, read back.

use std::{fs, path::PathBuf};

use image::{ColorType, DynamicImage, ImageReader};
use planish_film::{Film, Layer, PngOptions, ToneMap, Window, write_png, write_png_with};

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

/// The 8-bit pixels of a film of one row.
fn pixels(film: &Film, options: &PngOptions) -> Vec<[u8; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    write_png_with(film, &path, options).unwrap();
    let image = ImageReader::open(path).unwrap().decode().unwrap();
    image.into_rgba8().pixels().map(|pixel| pixel.0).collect()
}

#[test]
fn exposure_is_in_stops_and_leaves_alpha() {
    let film = film(2, 1, vec![[0.25, 0.125, 0.0, 1.0], [0.125, 0.0625, 0.0, 0.5]]);
    let options = PngOptions { exposure: 1.0, ..PngOptions::default() };
    assert_eq!(pixels(&film, &options), [[188, 137, 0, 255], [188, 137, 0, 128]]);
    let folder = tempfile::tempdir().unwrap();
    for (exposure, told) in [(f32::NAN, "NaN"), (1000.0, "1000"), (f32::NEG_INFINITY, "-inf")] {
        let options = PngOptions { exposure, ..PngOptions::default() };
        let message = write_png_with(&film, &folder.path().join("a.png"), &options).unwrap_err().to_string();
        assert_eq!(message, format!("the exposure is {told} stops; expected -126 to 127"));
    }
}

#[test]
fn tone_maps_act_on_the_colour_that_is_not_premultiplied() {
    for tone_map in [ToneMap::Neutral, ToneMap::Aces] {
        let options = PngOptions { tone_map, exposure: 0.0 };
        let opaque = [2.0, 0.5, 0.1, 1.0];
        let half = opaque.map(|value| value / 2.0);
        let [whole, covered] = pixels(&film(2, 1, vec![opaque, half]), &options)[..] else { panic!("two pixels") };
        assert_eq!(whole[..3], covered[..3]);
        assert_eq!([whole[3], covered[3]], [255, 128]);
        assert!(whole[0] < 255 && whole[0] > whole[1] && whole[1] > whole[2], "{tone_map:?}: {whole:?}");
    }
}

#[test]
fn bright_light_is_not_clipped_by_a_curve() {
    let grey = |i| 0.9 * 2.0_f32.powi(i);
    let ramp: Vec<_> = (0..5).map(|i| [grey(i), grey(i), grey(i), 1.0]).collect();
    let steps = |tone_map| {
        let mut reds: Vec<u8> = pixels(&film(5, 1, ramp.clone()), &PngOptions { tone_map, exposure: 0.0 })
            .iter()
            .map(|pixel| pixel[0])
            .collect();
        reds.dedup();
        reds.len()
    };
    assert_eq!(steps(ToneMap::Clip), 2);
    assert_eq!([ToneMap::Neutral, ToneMap::Aces].map(steps), [5, 5]);
}

#[test]
fn a_film_that_is_a_part_of_its_frame_is_all_of_its_picture() {
    let mut film = film(2, 1, vec![[1.0; 4]; 2]);
    film.window = Some(Window { x: 3, y: 4, full_width: 9, full_height: 9 });
    assert_eq!(pixels(&film, &PngOptions::default()).len(), 2);
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
