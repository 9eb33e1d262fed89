//! Images to textures on the GPU: packed, with all their mipmaps. `glsl/shared/textures.glsl` filters them.

use half::f16;
use planish_gpu::{Buffer, Device};
use planish_shaders::Texture;

use super::desc::{Texels, TextureDesc};
use crate::error::Error;
use crate::upload::{address, table};

/// [`Texture::flags`], as `glsl/shared/materials.glsl` has them.
const HALF: u32 = 1;
const SRGB: u32 = 2;
const NEAREST: u32 = 4;
/// Levels of an image of 32768 texels a side.
const MAX_LEVELS: usize = 16;

/// A linear image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LinearImage {
    pub size: [u32; 2],
    /// Rows from the top.
    pub texels: Vec<[f32; 4]>,
}

/// The 256 values of an sRGB byte, decoded (IEC 61966-2-1).
pub(crate) fn srgb_table() -> Vec<f32> {
    (0..=255_u32).map(|byte| srgb_to_linear(f64::from(byte) / 255.0) as f32).collect()
}

/// Decodes a value.
pub fn srgb_to_linear(value: f64) -> f64 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn linear_to_srgb(value: f32) -> f32 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

/// The two or three texels that texel `at` of a side half as long is the mean of, with their weights: exact shares also of odd sides.
fn shares(at: u32, from: u32, to: u32) -> [(u32, f32); 3] {
    if from == 1 {
        return [(0, 1.0), (0, 0.0), (0, 0.0)];
    }
    let first = 2 * at;
    if from == 2 * to {
        return [(first, 0.5), (first + 1, 0.5), (first, 0.0)];
    }
    let (position, to, from) = (at as f32, to as f32, from as f32);
    [(first, (to - position) / from), (first + 1, to / from), (first + 2, (position + 1.0) / from)]
}

/// The next coarser level.
fn halved([width, height]: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 4]) -> LinearImage {
    let size = [(width / 2).max(1), (height / 2).max(1)];
    let mut texels = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let mut sum = [0.0; 4];
            for (row, share) in shares(y, height, size[1]) {
                for (column, part) in shares(x, width, size[0]) {
                    let weight = share * part;
                    if weight > 0.0 {
                        let texel = texel(column, row);
                        sum = std::array::from_fn(|c| sum[c] + weight * texel[c]);
                    }
                }
            }
            texels.push(sum);
        }
    }
    LinearImage { size, texels }
}

impl LinearImage {
    /// The next coarser level.
    pub fn halved(&self) -> Self {
        let width = self.size[0] as usize;
        halved(self.size, |x, y| self.texels[y as usize * width + x as usize])
    }

    pub fn halves(&self) -> Vec<[f16; 4]> {
        // Halves end at 65504.
        self.texels.iter().map(|texel| texel.map(|value| f16::from_f32(value.clamp(-65504.0, 65504.0)))).collect()
    }
}

/// The levels of an image, packed into words.
struct Packed {
    words: Vec<u32>,
    first_word: [u32; MAX_LEVELS],
    level_count: u32,
}

fn byte_words(texels: &[[u8; 4]]) -> impl Iterator<Item = u32> {
    texels.iter().map(|&texel| u32::from_le_bytes(texel))
}

fn half_words(texels: &[[f16; 4]]) -> impl Iterator<Item = u32> {
    let pair = |a: f16, b: f16| u32::from(a.to_bits()) | u32::from(b.to_bits()) << 16;
    texels.iter().flat_map(move |&[r, g, b, a]| [pair(r, g), pair(b, a)])
}

fn to_byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Packs an image and its mipmaps, which are made of linear values.
fn pack(desc: &TextureDesc<'_>) -> Packed {
    let [width, height] = desc.size;
    let count = width as usize * height as usize;
    let decoded = srgb_table();
    let at = |x: u32, y: u32| y as usize * width as usize + x as usize;
    let (words, mut coarser): (Vec<u32>, LinearImage) = match desc.texels {
        Texels::Bytes { texels, is_srgb } => {
            assert_eq!(texels.len(), count, "texels of an image");
            let linear = |x, y| {
                let texel = texels[at(x, y)];
                let color = |byte: u8| if is_srgb { decoded[usize::from(byte)] } else { f32::from(byte) / 255.0 };
                [color(texel[0]), color(texel[1]), color(texel[2]), f32::from(texel[3]) / 255.0]
            };
            (byte_words(texels).collect(), halved(desc.size, linear))
        }
        Texels::Halves(texels) => {
            assert_eq!(texels.len(), count, "texels of an image");
            (half_words(texels).collect(), halved(desc.size, |x, y| texels[at(x, y)].map(f16::to_f32)))
        }
    };
    let mut packed = Packed { words, first_word: [0; MAX_LEVELS], level_count: 1 };
    let mut size = desc.size;
    while size != [1, 1] && (packed.level_count as usize) < MAX_LEVELS {
        packed.first_word[packed.level_count as usize] = packed.words.len() as u32;
        packed.level_count += 1;
        match desc.texels {
            Texels::Halves(_) => packed.words.extend(half_words(&coarser.halves())),
            Texels::Bytes { is_srgb, .. } => {
                let encoded = |value: f32| to_byte(if is_srgb { linear_to_srgb(value) } else { value });
                let bytes = coarser.texels.iter().map(|&[r, g, b, a]| [encoded(r), encoded(g), encoded(b), to_byte(a)]);
                packed.words.extend(bytes.map(u32::from_le_bytes));
            }
        }
        size = coarser.size;
        coarser = coarser.halved();
    }
    packed
}

/// Uploads an image with its mipmaps.
pub(crate) fn upload(device: &Device, desc: &TextureDesc<'_>) -> Result<(Texture, Buffer), Error> {
    let packed = pack(desc);
    let buffer = table(device, "texels", &packed.words)?;
    let flags = match desc.texels {
        Texels::Halves(_) => HALF,
        Texels::Bytes { is_srgb: true, .. } => SRGB,
        Texels::Bytes { is_srgb: false, .. } => 0,
    };
    let texture = Texture {
        texels: address(&buffer),
        width: desc.size[0],
        height: desc.size[1],
        level_count: packed.level_count,
        flags: flags | if desc.is_nearest { NEAREST } else { 0 },
        wrap_s: desc.wrap[0] as u32,
        wrap_t: desc.wrap[1] as u32,
        first_word: packed.first_word,
    };
    Ok((texture, buffer))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::desc::TextureWrap;

    #[test]
    fn a_level_of_odd_sides_has_the_mean_of_the_one_before() {
        for size in [[7, 5], [8, 3], [1, 9], [2, 2], [13, 1]] {
            let texels = (0..size[0] * size[1]).map(|i| [(i * i % 17) as f32, 1.0, 0.0, i as f32]).collect();
            let image = LinearImage { size, texels };
            let mean = |image: &LinearImage, c: usize| {
                image.texels.iter().map(|texel| texel[c]).sum::<f32>() / image.texels.len() as f32
            };
            let coarser = image.halved();
            for channel in 0..4 {
                assert!((mean(&image, channel) - mean(&coarser, channel)).abs() < 1e-4, "{size:?}");
            }
        }
    }

    #[test]
    fn mipmaps_of_srgb_images_are_means_of_light() {
        let texels = [[0, 0, 0, 0], [255, 255, 255, 255]];
        let desc = TextureDesc {
            size: [2, 1],
            texels: Texels::Bytes { texels: &texels, is_srgb: true },
            wrap: [TextureWrap::Repeat; 2],
            is_nearest: false,
        };
        let packed = pack(&desc);
        // Half of the light is 188 of 255 in sRGB; alpha is linear.
        assert_eq!(packed.words[2].to_le_bytes(), [188, 188, 188, 128]);
        assert_eq!((packed.level_count, packed.first_word[1]), (2, 2));
    }

    #[test]
    fn srgb_decodes_what_it_encodes() {
        for byte in 0..=255_u8 {
            assert_eq!(to_byte(linear_to_srgb(srgb_table()[usize::from(byte)])), byte);
        }
    }
}
