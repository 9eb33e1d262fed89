//! Displacement maps: files to plain arrays that a shader filters by hand.
//!
//! Hardware filters an image with an accuracy of its own; here both sides of a seam must get the same bits. So a map is
//! arrays of texels and levels, and [`DisplacementMap::sample`] and [`DisplacementMap::sample_face`] are the arithmetic,
//! in an order that a shader can repeat.
//!
//! | module | idea |
//! |---|---|
//! | `request` | what is asked for: a file, and what its values mean |
//! | `map` | what is uploaded |
//! | `sample` | how it is filtered |
//! | `raster` | an image file to texels; `exr_file`, `png_file`, `tiff_file` by format, `limits` what a header may claim |
//! | `texel` | raw values to displacements |
//! | `udim` | names of tiles, and which of them UVs use |
//! | `uv` | maps over texture coordinates, with mips by boxes |
//! | `faces` | maps of one tile a Ptex face, cut out of an atlas |
//! | `meeting`, `stitch` | where the tiles of Ptex faces meet, and one value for all that meet there, level by level |
mod exr_file;
mod faces;
pub(crate) mod limits;
mod map;
mod meeting;
mod png_file;
mod raster;
mod request;
mod sample;
mod stitch;
mod texel;
mod tiff_file;
mod udim;
mod uv;

pub use map::{DisplacementLevel, DisplacementMap, DisplacementTile, NO_TILE, TileLayout};
pub use request::{DisplacementKind, DisplacementLayout, DisplacementRequest};
pub use udim::{UsedTiles, used_tiles};

use std::path::Path;

use crate::error::Fault;
use crate::{Error, Mesh, Warning};
use texel::TexelFold;

/// Reads the map that is asked for, for a mesh: a warning comes with it if texels had to be replaced.
///
/// # Errors
/// [`Error::Displacement`]: a file cannot be read or is no image of a kind that is read, is larger than what is supported
/// (16384 texels a side, 2³⁰ values in all), lacks a channel, or does not fit the mesh (no texture coordinates, a tile
/// missing, an atlas of another number of faces).
pub fn load_displacement(
    request: &DisplacementRequest,
    mesh: &Mesh,
) -> Result<(DisplacementMap, Option<Warning>), Error> {
    let mut fold = TexelFold::new(request);
    let map = match request.layout {
        DisplacementLayout::Uv => uv::load(request, mesh, &mut fold)?,
        DisplacementLayout::Faces => faces::load(request, mesh, &mut fold)?,
    };
    let warning = (fold.replaced > 0).then(|| Warning {
        line: None,
        text: format!(
            "{}: {} texels are not finite, or displace by more than 1e36: not displaced there",
            request.path.display(),
            fold.replaced
        ),
    });
    Ok((map, warning))
}

/// The error of a fault in a map's file.
fn error_at(path: &Path) -> impl Fn(Fault) -> Error {
    |fault| Error::Displacement { path: path.to_owned(), found: fault.found, expected: fault.expected }
}
