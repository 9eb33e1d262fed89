//! What is uploaded: texels, and where those of a tile and a level begin.
use super::{DisplacementKind, limits};
use crate::error::Fault;

/// Entry of [`DisplacementMap::tile_of`] where there is no tile: the surface is not displaced there.
pub const NO_TILE: u32 = u32::MAX;

/// How a bound on texels is enlarged to be one on what is filtered from them: three interpolations, each a sum of two
/// products, round 9 times by 2^-24 at most, and weights add up to more than 1 by as much.
const FILTER_SLACK: f64 = 1.0 + 1e-5;

/// How tiles lie, and how the texels at their borders are continued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileLayout {
    /// One tile over texture coordinates that repeats. Texel (i, j), counted from the upper left, is at
    /// u = (i + 1/2) / width, v = 1 - (j + 1/2) / height.
    Repeat,
    /// A tile for each unit square of texture coordinates; the same within it, and its border texels go on outward.
    Udim,
    /// A tile for each Ptex face. Texel (i, j) is at u = i / (width - 1), v = j / (height - 1): those at a border lie on the
    /// edge of the face.
    Faces,
}

/// One resolution of a tile, or of all tiles of Ptex faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisplacementLevel {
    /// In [`DisplacementMap::texels`], counted in texels: its first number is `first_texel * channels`.
    pub first_texel: u32,
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A tile over texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisplacementTile {
    /// In [`DisplacementMap::levels`]: the finest level. Coarser ones follow, down to 1 x 1.
    pub first_level: u32,
    /// Number of levels.
    pub level_count: u32,
}

/// A displacement map, ready for upload. All texels are finite displacements, scale and midpoint included; none is -0.
///
/// | layout | levels | texels of a level |
/// |---|---|---|
/// | [`TileLayout::Repeat`], [`TileLayout::Udim`] | those of tile 0, then those of tile 1, .. | rows from the top |
/// | [`TileLayout::Faces`] | shared by all tiles; a level has half as many segments as the one before | those of Ptex face 0, then those of face 1, ..: `width * height` each, rows from v = 0 |
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementMap {
    /// What a texel says.
    pub kind: DisplacementKind,
    /// Numbers in a texel: 1 or 3.
    pub channels: u32,
    /// How tiles lie.
    pub layout: TileLayout,
    /// Interleaved channels, texel by texel, level by level.
    pub texels: Vec<f32>,
    /// Resolutions, see the table.
    pub levels: Vec<DisplacementLevel>,
    /// Tiles over texture coordinates; none for Ptex faces.
    pub tiles: Vec<DisplacementTile>,
    /// Unit squares in a row of `tile_of`: 10 for UDIM, 1 otherwise.
    pub tile_columns: u32,
    /// In `tiles`, or [`NO_TILE`], for each unit square of texture coordinates, rows from v = 0; none for Ptex faces.
    pub tile_of: Vec<u32>,
    /// For Ptex faces: bit `f % 32` of entry `f / 32` is set if Ptex face f is a part of an n-gon. Its sides u = 0 and v = 0
    /// are halves of edges, and sampled at every second texel, as the whole edge is from a quad beside it.
    pub parts: Vec<u32>,
    /// No displacement is longer, filtered or not.
    pub bound: f32,
}

impl DisplacementMap {
    /// A map without texels.
    pub(super) fn empty(kind: DisplacementKind, layout: TileLayout) -> Self {
        Self {
            kind,
            channels: kind.channel_count() as u32,
            layout,
            texels: Vec::new(),
            levels: Vec::new(),
            tiles: Vec::new(),
            tile_columns: 1,
            tile_of: Vec::new(),
            parts: Vec::new(),
            bound: 0.0,
        }
    }

    /// Number of levels of the finest tile; 0 without tiles.
    pub fn level_count(&self) -> u32 {
        match self.layout {
            TileLayout::Faces => self.levels.len() as u32,
            _ => self.tiles.iter().map(|tile| tile.level_count).max().unwrap_or(0),
        }
    }

    /// Number of Ptex faces that have a tile; 0 over texture coordinates.
    pub fn ptex_face_count(&self) -> u32 {
        match (self.layout, self.levels.first()) {
            (TileLayout::Faces, Some(level)) => {
                let next = self.levels.get(1).map_or(self.texel_count(), |level| level.first_texel);
                next / (level.width * level.height)
            }
            _ => 0,
        }
    }

    /// Whether a Ptex face is a part of an n-gon.
    pub fn is_part(&self, ptex_face: u32) -> bool {
        self.parts.get(ptex_face as usize / 32).is_some_and(|bits| bits >> (ptex_face % 32) & 1 == 1)
    }

    /// Number of texels of all levels.
    pub fn texel_count(&self) -> u32 {
        (self.texels.len() / self.channels as usize) as u32
    }

    /// Appends a level, and its texels of a tile or of all Ptex faces.
    pub(super) fn push_level(&mut self, width: u32, height: u32, values: &[f32]) -> Result<(), Fault> {
        limits::check_values(self.texels.len() as u64 + values.len() as u64)?;
        self.levels.push(DisplacementLevel { first_texel: self.texel_count(), width, height });
        self.texels.extend_from_slice(values);
        Ok(())
    }

    /// Finds the bound, once all texels are there.
    pub(super) fn set_bound(&mut self) {
        let square = |texel: &[f32]| texel.iter().map(|&value| f64::from(value) * f64::from(value)).sum::<f64>();
        let longest = self.texels.chunks_exact(self.channels as usize).map(square).fold(0.0, f64::max).sqrt();
        self.bound = if longest > 0.0 { ((longest * FILTER_SLACK) as f32).next_up() } else { 0.0 };
    }
}
