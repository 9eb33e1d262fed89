//! Textures of the scene: small PNGs in the file.
use std::io::Cursor;

use glam::DVec3;
use image::{ImageFormat, RgbImage};
use serde_json::json;

use crate::gltf_text::GltfText;
use crate::hero::smooth_step;

/// Adds the textures of the ground, the pot and the leaves; returns their indices.
pub fn add(text: &mut GltfText) -> [usize; 3] {
    let sampler = text.add("samplers", json!({ "wrapS": 10497, "wrapT": 33071, "magFilter": 9729, "minFilter": 9987 }));
    let repeated =
        text.add("samplers", json!({ "wrapS": 10497, "wrapT": 10497, "magFilter": 9729, "minFilter": 9987 }));
    [
        texture(text, "tiles", repeated, [32, 32], tiles),
        texture(text, "glaze", sampler, [64, 64], glaze),
        texture(text, "veins", sampler, [32, 64], veins),
    ]
}

/// Adds a texture of so many texels; `color`: sRGB from 0 to 1 at (s, t).
fn texture(
    text: &mut GltfText,
    name: &str,
    sampler: usize,
    [width, height]: [u32; 2],
    color: fn(f64, f64) -> DVec3,
) -> usize {
    let texel = |x: u32, y: u32| {
        let color = color((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
        image::Rgb(color.to_array().map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8))
    };
    let mut png = Cursor::new(Vec::new());
    RgbImage::from_fn(width, height, texel)
        .write_to(&mut png, ImageFormat::Png)
        .expect("an image can be written to memory");
    let view = text.view(png.get_ref());
    let image = text.add("images", json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
    text.add("textures", json!({ "name": name, "source": image, "sampler": sampler }))
}

/// Two by two tiles, joints between them.
fn tiles(s: f64, t: f64) -> DVec3 {
    let near_joint = |x: f64| ((x * 2.0).fract() - 0.5).abs() > 0.46;
    if near_joint(s) || near_joint(t) {
        return DVec3::new(0.45, 0.42, 0.38);
    }
    let is_dark = ((s * 2.0) as u32 + (t * 2.0) as u32).is_multiple_of(2);
    if is_dark { DVec3::new(0.66, 0.62, 0.55) } else { DVec3::new(0.76, 0.72, 0.65) }
}

/// Terracotta with a zigzag and two bands; t runs down from the rim.
fn glaze(s: f64, t: f64) -> DVec3 {
    let zigzag = 0.5 + 0.09 * (4.0 * ((s * 8.0).fract() - 0.5).abs() - 1.0);
    let [cream, blue] = [DVec3::new(0.95, 0.88, 0.74), DVec3::new(0.18, 0.35, 0.5)];
    let base = DVec3::new(0.72, 0.38, 0.24);
    if (t - zigzag).abs() < 0.05 {
        cream
    } else if (0.27..0.31).contains(&t) || (0.69..0.73).contains(&t) {
        blue
    } else {
        base
    }
}

/// A leaf: lighter along its middle and veins; t runs from its tip to its stem.
fn veins(s: f64, t: f64) -> DVec3 {
    let across = (s - 0.5).abs();
    let middle = 1.0 - smooth_step(0.02, 0.06, across);
    let vein = ((t + 0.7 * across) * 7.0).fract();
    let side = 0.6 * (1.0 - smooth_step(0.06, 0.16, (vein - 0.5).abs()));
    DVec3::new(0.22, 0.5, 0.13).lerp(DVec3::new(0.6, 0.8, 0.35), middle.max(side))
}
