//! Maps over texture coordinates: one image, or UDIM tiles, with mips by boxes.
use super::map::{DisplacementMap, DisplacementTile, NO_TILE, TileLayout};
use super::raster::{self, Raster};
use super::texel::TexelFold;
use super::udim::{COLUMNS, Pattern, used_tiles};
use super::{DisplacementRequest, error_at};
use crate::error::Fault;
use crate::obj::quoted;
use crate::{Error, Mesh};

/// Reads a map over a mesh' texture coordinates.
pub fn load(request: &DisplacementRequest, mesh: &Mesh, fold: &mut TexelFold) -> Result<DisplacementMap, Error> {
    let at = error_at(&request.path);
    let uv = mesh.control_mesh.face_varying.first().ok_or_else(|| {
        let found = format!("mesh {} without texture coordinates", quoted(mesh.name.as_bytes()));
        at(Fault::whole(found, "a `vt` at every corner of its faces, or a map of layout faces"))
    })?;
    let Some(pattern) = Pattern::of(&request.path) else {
        let mut map = DisplacementMap::empty(request.kind, TileLayout::Repeat);
        push_tile(&mut map, raster::read(&request.path, fold)?).map_err(&at)?;
        map.tile_of = vec![0];
        map.set_bound();
        return Ok(map);
    };
    let tiles = pattern.existing().map_err(&at)?;
    let used = used_tiles(uv.indices.iter().filter_map(|&index| uv.values.get(index as usize).copied()));
    pattern.check_used(&used, &tiles).map_err(&at)?;
    let mut map = DisplacementMap::empty(request.kind, TileLayout::Udim);
    let row_count = tiles.last().map_or(0, |&[_, row]| row + 1);
    map.tile_columns = COLUMNS;
    map.tile_of = vec![NO_TILE; (COLUMNS * row_count) as usize];
    for (index, &[column, row]) in (0..).zip(&tiles) {
        let file = pattern.file(column, row);
        push_tile(&mut map, raster::read(&file, fold)?).map_err(error_at(&file))?;
        map.tile_of[(COLUMNS * row + column) as usize] = index;
    }
    map.set_bound();
    Ok(map)
}

/// Appends a tile with its levels, the last of one texel.
pub fn push_tile(map: &mut DisplacementMap, finest: Raster) -> Result<(), Fault> {
    let first_level = map.levels.len() as u32;
    let mut level = finest;
    map.push_level(level.width, level.height, &level.values)?;
    while level.width > 1 || level.height > 1 {
        level = halved(&level, map.channels as usize);
        map.push_level(level.width, level.height, &level.values)?;
    }
    map.tiles.push(DisplacementTile { first_level, level_count: map.levels.len() as u32 - first_level });
    Ok(())
}

/// The image at half its size, rounded down: every texel is the mean over the rectangle that it covers.
fn halved(image: &Raster, channels: usize) -> Raster {
    let (width, height) = (image.width as usize, image.height as usize);
    let (columns, rows) = ((width / 2).max(1), (height / 2).max(1));
    let mut values = Vec::with_capacity(columns * rows * channels);
    for row in 0..rows {
        let row_taps = taps(row, height);
        for column in 0..columns {
            let column_taps = taps(column, width);
            for channel in 0..channels {
                let mut sum = 0.0;
                for &(y, row_weight) in row_taps.iter().filter(|tap| tap.1 > 0.0) {
                    for &(x, weight) in column_taps.iter().filter(|tap| tap.1 > 0.0) {
                        sum += row_weight * weight * f64::from(image.values[(y * width + x) * channels + channel]);
                    }
                }
                values.push(sum as f32 + 0.0);
            }
        }
    }
    Raster { width: columns as u32, height: rows as u32, values }
}

/// The texels that texel `index` of half as many covers, and their weights: two, or of an odd number three (Guthe and
/// Heckbert, Non-Power-of-Two Mipmap Creation, 2005); of one, itself.
fn taps(index: usize, count: usize) -> [(usize, f64); 3] {
    let first = 2 * index;
    if count == 1 {
        return [(0, 1.0), (0, 0.0), (0, 0.0)];
    }
    if count.is_multiple_of(2) {
        return [(first, 0.5), (first + 1, 0.5), (first, 0.0)];
    }
    let (half, count) = ((count / 2) as f64, count as f64);
    let index = index as f64;
    [(first, (half - index) / count), (first + 1, half / count), (first + 2, (index + 1.0) / count)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::displacement::DisplacementKind;

    fn map_of(width: u32, height: u32, values: Vec<f32>) -> DisplacementMap {
        let mut map = DisplacementMap::empty(DisplacementKind::Scalar, TileLayout::Repeat);
        push_tile(&mut map, Raster { width, height, values }).unwrap();
        map.set_bound();
        map
    }

    #[test]
    fn mips_go_down_to_one_texel_whatever_the_size() {
        let map = map_of(5, 3, vec![1.0; 15]);
        let sizes: Vec<_> = map.levels.iter().map(|level| (level.width, level.height, level.first_texel)).collect();
        assert_eq!(sizes, [(5, 3, 0), (2, 1, 15), (1, 1, 17)]);
        assert_eq!(map.tiles, [DisplacementTile { first_level: 0, level_count: 3 }]);
        assert!(map.texels.iter().all(|value| (value - 1.0).abs() < 1e-6));
    }

    #[test]
    fn mips_keep_the_mean() {
        for (width, height) in [(4, 4), (7, 5), (1, 9), (6, 1), (3, 2)] {
            let values: Vec<f32> = (0..width * height).map(|i| ((i * 37) % 11) as f32 - 4.0).collect();
            let mean = values.iter().sum::<f32>() / values.len() as f32;
            let map = map_of(width, height, values);
            // Sizes are halved with rounding: the mean stays only because every level is weighted by covered area.
            assert!((map.texels.last().unwrap() - mean).abs() < 1e-5, "{width} x {height}");
        }
    }

    #[test]
    fn an_odd_row_s_middle_texel_belongs_to_both_halves() {
        assert_eq!(taps(0, 3), [(0, 1.0 / 3.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0)]);
        assert_eq!(taps(1, 5), [(2, 1.0 / 5.0), (3, 2.0 / 5.0), (4, 2.0 / 5.0)]);
    }

    #[test]
    fn bound_is_above_every_texel() {
        let map = map_of(2, 1, vec![-3.0, 2.0]);
        assert!(map.bound > 3.0 && map.bound < 3.001);
        assert_eq!(map_of(1, 1, vec![0.0]).bound, 0.0);
    }
}
