//! Maps of one tile a Ptex face, cut out of an atlas.
//!
//! Tiles lie in the atlas by rows from the upper left, in the order of Ptex faces; the last row may have spare ones. A tile
//! of R + 1 texels a side, R a power of two, has the values at u = i / R, v = j / R; its upper row is v = 0.
use planish_subdiv::ControlMesh;

use super::map::{DisplacementMap, TileLayout};
use super::meeting::Meetings;
use super::raster::{self, Raster};
use super::stitch::{EdgeTexels, FaceTexels, halved_inside};
use super::texel::TexelFold;
use super::{DisplacementRequest, error_at};
use crate::error::Fault;
use crate::{Error, Mesh};

/// Segments of the tiles that a message gives as an example.
const EXAMPLE_SEGMENTS: u64 = 8;

/// Reads an atlas for a mesh.
pub fn load(request: &DisplacementRequest, mesh: &Mesh, fold: &mut TexelFold) -> Result<DisplacementMap, Error> {
    let atlas = raster::read(&request.path, fold)?;
    from_atlas(&atlas, request, &mesh.control_mesh).map_err(error_at(&request.path))
}

fn from_atlas(atlas: &Raster, request: &DisplacementRequest, mesh: &ControlMesh) -> Result<DisplacementMap, Fault> {
    let has_n_gons = mesh.face_sizes.iter().any(|&size| size != 4);
    let segments = segments_of(atlas, mesh.ptex_face_count(), has_n_gons)?;
    let meetings = Meetings::of(mesh);
    let channels = request.kind.channel_count();
    let mut map = DisplacementMap::empty(request.kind, TileLayout::Faces);
    map.parts = vec![0; meetings.tiles.len().div_ceil(32)];
    for (ptex_face, _) in meetings.tiles.iter().enumerate().filter(|(_, tile)| tile.is_part) {
        map.parts[ptex_face / 32] |= 1 << (ptex_face % 32);
    }
    let mut texels = cut(atlas, segments, meetings.tiles.len(), channels);
    let mut edges = EdgeTexels::averaged(&meetings, &texels);
    edges.write_to(&meetings, &mut texels);
    // A part of an n-gon has half of a quad's edge on a side: of one segment there is no half.
    let last = if has_n_gons { 2 } else { 1 };
    loop {
        let side = texels.segments as u32 + 1;
        map.push_level(side, side, &texels.values)?;
        if texels.segments == last {
            break;
        }
        edges = edges.halved(&meetings);
        texels = halved_inside(&texels, meetings.tiles.len());
        edges.write_to(&meetings, &mut texels);
    }
    map.set_bound();
    Ok(map)
}

/// Segments of a tile's side: the largest power of two with which the atlas has the tiles that it should.
fn segments_of(atlas: &Raster, tile_count: u64, has_n_gons: bool) -> Result<usize, Fault> {
    let (width, height) = (u64::from(atlas.width), u64::from(atlas.height));
    let fits = |&segments: &u64| {
        let side = segments + 1;
        let (columns, rows) = (width / side, height / side);
        let is_whole = columns * side == width && rows * side == height;
        is_whole && columns * rows >= tile_count && (columns * rows).saturating_sub(tile_count) < columns
    };
    let least = u64::from(has_n_gons);
    let sizes = (least..14).rev().map(|power| 1 << power);
    if let Some(segments) = sizes.into_iter().find(|segments| fits(segments)) {
        return Ok(segments as usize);
    }
    let columns = (tile_count as f64).sqrt().ceil() as u64;
    let side = EXAMPLE_SEGMENTS + 1;
    let (least_side, example) = ((1_u64 << least) + 1, (columns * side, tile_count.div_ceil(columns) * side));
    Err(Fault::whole(
        format!("an atlas of {width} x {height} texels"),
        format!(
            "rows of {tile_count} tiles, one a Ptex face, of 2^k + 1 texels a side ({least_side} or more), such as {} x {}",
            example.0, example.1
        ),
    ))
}

/// The tiles of an atlas, one after another.
fn cut(atlas: &Raster, segments: usize, tile_count: usize, channels: usize) -> FaceTexels {
    let (side, width) = (segments + 1, atlas.width as usize);
    let columns = width / side;
    let mut values = Vec::with_capacity(tile_count * side * side * channels);
    for tile in 0..tile_count {
        let (left, top) = (tile % columns * side, tile / columns * side);
        for row in top..top + side {
            values.extend_from_slice(&atlas.values[(row * width + left) * channels..][..side * channels]);
        }
    }
    FaceTexels { segments, channels, values }
}
