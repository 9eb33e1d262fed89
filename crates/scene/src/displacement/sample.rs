//! How a map is filtered: in 32-bit floats, every expression in the order in which it is written, without fused products.
//!
//! A shader that repeats these lines, its results declared `precise`, gets the same bits: nothing is used but sums,
//! products, comparisons and `floor`.
use super::map::{DisplacementLevel, DisplacementMap, NO_TILE, TileLayout};

/// A texel and the one after it, or before it, and their weights.
#[derive(Clone, Copy)]
struct Pair {
    texels: [u32; 2],
    weights: [f32; 2],
}

impl DisplacementMap {
    /// The displacement at texture coordinates; (d, 0, 0) of a scalar map. Levels are counted from the finest, 0, and `lod`
    /// may lie between two. 0 where there is no tile, and in maps of Ptex faces.
    pub fn sample(&self, uv: [f32; 2], lod: f32) -> [f32; 3] {
        let Some((tile, [u, v])) = self.tile_at(uv) else { return [0.0; 3] };
        let tile = self.tiles[tile as usize];
        between_levels(lod, tile.level_count, |level| {
            let level = self.levels[(tile.first_level + level) as usize];
            let columns = self.centered(u, level.width);
            let rows = self.centered(1.0 - v, level.height);
            self.bilinear(level.first_texel, level.width, columns, rows)
        })
    }

    /// The displacement at (u, v) of a Ptex face; (d, 0, 0) of a scalar map. Both 1 - u and 1 - v are given, so that faces
    /// that count an edge's parameter in opposite directions exchange numbers instead of computing them anew: along an edge,
    /// which is where one of the four is 0, faces that meet there get the same bits. A part of an n-gon has twice the
    /// parameter of the whole edge. 0 in maps over texture coordinates.
    pub fn sample_face(&self, ptex_face: u32, [u, rest_u]: [f32; 2], [v, rest_v]: [f32; 2], lod: f32) -> [f32; 3] {
        if ptex_face >= self.ptex_face_count() {
            return [0.0; 3];
        }
        let is_part = self.is_part(ptex_face);
        between_levels(lod, self.levels.len() as u32, |level| {
            let DisplacementLevel { first_texel, width, .. } = self.levels[level as usize];
            let end = width - 1;
            let first_texel = first_texel + ptex_face * width * width;
            let texel = |i: u32, j: u32| self.texel(first_texel + j * width + i);
            let along = |parameter, rest, is_outer: bool| {
                if is_part && is_outer { half_edge(parameter, end) } else { whole_edge(parameter, rest, end) }
            };
            if v == 0.0 || rest_v == 0.0 {
                let j = if v == 0.0 { 0 } else { end };
                let Pair { texels: [a, b], weights } = along(u, rest_u, v == 0.0);
                return lerp(texel(a, j), texel(b, j), weights);
            }
            if u == 0.0 || rest_u == 0.0 {
                let i = if u == 0.0 { 0 } else { end };
                let Pair { texels: [a, b], weights } = along(v, rest_v, u == 0.0);
                return lerp(texel(i, a), texel(i, b), weights);
            }
            self.bilinear(first_texel, width, whole_edge(u, rest_u, end), whole_edge(v, rest_v, end))
        })
    }

    /// The tile that texture coordinates are in, and where in it they are. A coordinate on the border of two tiles is in the
    /// latter if that exists.
    fn tile_at(&self, uv: [f32; 2]) -> Option<(u32, [f32; 2])> {
        let [u, v] = uv;
        let (column, row) = (u.floor(), v.floor());
        match self.layout {
            TileLayout::Repeat => Some((0, [u - column, v - row])),
            TileLayout::Faces => None,
            TileLayout::Udim => {
                let candidates = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
                let exists = |&(left, down): &(f32, f32)| {
                    let is_there = (left == 0.0 || u == column) && (down == 0.0 || v == row);
                    is_there && self.tile_number(column - left, row - down) != NO_TILE
                };
                let (left, down) = candidates.into_iter().find(exists)?;
                let (column, row) = (column - left, row - down);
                Some((self.tile_number(column, row), [u - column, v - row]))
            }
        }
    }

    fn tile_number(&self, column: f32, row: f32) -> u32 {
        let (columns, rows) = (self.tile_columns, self.tile_of.len() as u32 / self.tile_columns);
        if column >= 0.0 && column < columns as f32 && row >= 0.0 && row < rows as f32 {
            self.tile_of[(row as u32 * columns + column as u32) as usize]
        } else {
            NO_TILE
        }
    }

    /// The texels whose centres are on both sides of a parameter from 0 to 1.
    fn centered(&self, parameter: f32, count: u32) -> Pair {
        let x = parameter * count as f32 - 0.5;
        let cell = x.floor();
        let t = x - cell;
        // From -1 to count - 1.
        let (before, after) = (cell as i64, cell as i64 + 1);
        let last = i64::from(count) - 1;
        let texels = if self.layout == TileLayout::Repeat {
            [if before < 0 { last } else { before.min(last) }, if after > last { 0 } else { after }]
        } else {
            [before.clamp(0, last), after.clamp(0, last)]
        };
        Pair { texels: texels.map(|texel| texel as u32), weights: [1.0 - t, t] }
    }

    /// First along the rows, then between them.
    fn bilinear(&self, first_texel: u32, width: u32, columns: Pair, rows: Pair) -> [f32; 3] {
        let row = |j: u32| {
            let [a, b] = columns.texels.map(|i| self.texel(first_texel + j * width + i));
            lerp(a, b, columns.weights)
        };
        lerp(row(rows.texels[0]), row(rows.texels[1]), rows.weights)
    }

    fn texel(&self, texel: u32) -> [f32; 3] {
        let at = (texel * self.channels) as usize;
        match self.channels {
            1 => [self.texels[at], 0.0, 0.0],
            _ => [self.texels[at], self.texels[at + 1], self.texels[at + 2]],
        }
    }
}

/// s a + t b.
fn lerp(a: [f32; 3], b: [f32; 3], [s, t]: [f32; 2]) -> [f32; 3] {
    std::array::from_fn(|channel| s * a[channel] + t * b[channel])
}

/// Between the two levels beside `lod`, which is brought into 0 .. `level_count` - 1; what is not a number is 0.
fn between_levels(lod: f32, level_count: u32, at: impl Fn(u32) -> [f32; 3]) -> [f32; 3] {
    let last = (level_count - 1) as f32;
    let lod = if lod > 0.0 { lod.min(last) } else { 0.0 };
    let finer = lod.floor();
    let t = lod - finer;
    if t == 0.0 {
        return at(finer as u32);
    }
    lerp(at(finer as u32), at(finer as u32 + 1), [1.0 - t, t])
}

/// The texels beside a parameter, counted from the end that is nearer: the same two, with the same weights, for those who
/// count from the other end.
fn whole_edge(parameter: f32, rest: f32, end: u32) -> Pair {
    if parameter <= rest {
        from_end(parameter, end)
    } else {
        let Pair { texels: [a, b], weights } = from_end(rest, end);
        Pair { texels: [end - a, end - b], weights }
    }
}

/// The same on a side that is half of an edge, at the texels of the whole one. Its parameter is twice that of the edge, and
/// its end the edge's middle, so that whole edges, too, are counted from this side's start.
fn half_edge(parameter: f32, end: u32) -> Pair {
    let Pair { texels, weights } = from_end(parameter, end / 2);
    Pair { texels: texels.map(|texel| 2 * texel), weights }
}

fn from_end(parameter: f32, segments: u32) -> Pair {
    let x = parameter * segments as f32;
    let cell = x.floor().min((segments - 1) as f32);
    let t = x - cell;
    Pair { texels: [cell as u32, cell as u32 + 1], weights: [1.0 - t, t] }
}
