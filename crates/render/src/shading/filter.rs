//! The twin of `glsl/shared/textures.glsl` for images in latitude and longitude: bilinear, repeated along s, clamped along t.

use super::texture::LinearImage;

/// The value at (s, t) of a level.
pub(crate) fn bilinear(image: &LinearImage, [s, t]: [f32; 2]) -> [f32; 3] {
    let [width, height] = image.size.map(|size| size as i32);
    let (x, y) = (s * width as f32 - 0.5, t * height as f32 - 0.5);
    let (column, row) = (x.floor(), y.floor());
    let (along, down) = (x - column, y - row);
    let mut sum = [0.0; 3];
    for (i, weight) in
        [(1.0 - along) * (1.0 - down), along * (1.0 - down), (1.0 - along) * down, along * down].into_iter().enumerate()
    {
        let column = (column as i32 + (i & 1) as i32).rem_euclid(width);
        let row = (row as i32 + (i >> 1) as i32).clamp(0, height - 1);
        let texel = image.texels[(row * width + column) as usize];
        sum = std::array::from_fn(|c| sum[c] + weight * texel[c]);
    }
    sum
}

/// Between two levels; `lod` 0 is the first.
pub(crate) fn trilinear(levels: &[LinearImage], st: [f32; 2], lod: f32) -> [f32; 3] {
    let lod = lod.clamp(0.0, (levels.len() - 1) as f32);
    let (level, share) = (lod as usize, lod.fract());
    let finer = bilinear(&levels[level], st);
    if share == 0.0 {
        return finer;
    }
    let coarser = bilinear(&levels[level + 1], st);
    std::array::from_fn(|c| finer[c] + share * (coarser[c] - finer[c]))
}
