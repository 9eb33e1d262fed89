//! Images against committed ones, by FLIP.

use std::fs;
use std::path::{Path, PathBuf};

use image::RgbImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool};

use crate::repository;

/// Set to 1, it replaces the committed images.
const UPDATE: &str = "PLANISH_UPDATE_GOLDEN";
/// Largest mean FLIP error, of 0 to 1, of images that count as the same.
pub const MEAN_TOLERANCE: f32 = 0.02;

/// The committed image of that name.
pub fn path(name: &str) -> PathBuf {
    repository::root().join("tests/golden").join(format!("{name}.png"))
}

/// Unless an image looks like the committed one: why not. Where an update is asked for, it becomes the committed one.
pub fn check(name: &str, image: &Path) -> Result<(), String> {
    let (found, golden) = (read(image)?, path(name));
    if std::env::var_os(UPDATE).is_some_and(|value| value == "1") {
        eprintln!("updating {}", golden.display());
        return write(&found, &golden);
    }
    let expected = read(&golden).map_err(|error| format!("{error}; {UPDATE}=1 writes it"))?;
    let error = mean_error(&expected, &found)?;
    if error <= MEAN_TOLERANCE {
        return Ok(());
    }
    // Kept, unlike the folder of the test, so that it can be looked at.
    let kept = std::env::temp_dir().join(format!("planish-{name}.png"));
    write(&found, &kept)?;
    Err(format!(
        "{} differs from {}: mean FLIP error {error}, at most {MEAN_TOLERANCE} expected; {UPDATE}=1 replaces it",
        kept.display(),
        golden.display()
    ))
}

/// The mean FLIP error between two images of the same size, 0 to 1.
pub fn mean_error(expected: &RgbImage, found: &RgbImage) -> Result<f32, String> {
    if expected.dimensions() != found.dimensions() {
        return Err(format!("sizes differ: {:?}, {:?} expected", found.dimensions(), expected.dimensions()));
    }
    let flip = |image: &RgbImage| FlipImageRgb8::with_data(image.width(), image.height(), image.as_raw());
    let errors = nv_flip::flip(flip(expected), flip(found), DEFAULT_PIXELS_PER_DEGREE);
    Ok(FlipPool::from_image(&errors).mean())
}

/// Reads an image's colours.
pub fn read(path: &Path) -> Result<RgbImage, String> {
    image::open(path).map(|image| image.into_rgb8()).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes an image in as few bytes as PNG takes.
fn write(image: &RgbImage, path: &Path) -> Result<(), String> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    image.write_with_encoder(encoder).map_err(|error| format!("{}: {error}", path.display()))?;
    fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}
