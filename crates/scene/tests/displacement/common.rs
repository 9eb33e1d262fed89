//! What the tests of displacement maps share: small images and meshes.
use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage, f16};
use planish_scene::displacement::{
    DisplacementKind, DisplacementLayout, DisplacementMap, DisplacementRequest, load_displacement,
};
use planish_scene::{Error, LoadOptions, Mesh, Warning, read_obj};

pub use tempfile::{TempDir, tempdir};

/// A quad over the unit square of texture coordinates.
pub const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

pub fn mesh(obj: &str) -> Mesh {
    read_obj("mesh.obj", obj.as_bytes(), &LoadOptions::default()).unwrap().meshes.remove(0)
}

pub fn request(path: &Path, kind: DisplacementKind) -> DisplacementRequest {
    DisplacementRequest { kind, ..DisplacementRequest::new(path) }
}

pub fn faces(path: &Path) -> DisplacementRequest {
    DisplacementRequest { layout: DisplacementLayout::Faces, ..DisplacementRequest::new(path) }
}

/// A scalar or vector map over the quad's texture coordinates, which must not cause a warning.
pub fn map(path: &Path, kind: DisplacementKind) -> DisplacementMap {
    without_warning(load(&request(path, kind)).unwrap())
}

pub fn load(request: &DisplacementRequest) -> Result<(DisplacementMap, Option<Warning>), Error> {
    load_displacement(request, &mesh(QUAD))
}

pub fn without_warning((map, warning): (DisplacementMap, Option<Warning>)) -> DisplacementMap {
    assert_eq!(warning, None);
    map
}

/// The texels of the finest level of a map of one tile.
pub fn finest(map: &DisplacementMap) -> &[f32] {
    let level = map.levels[0];
    &map.texels[..(level.width * level.height * map.channels) as usize]
}

/// Why a map is refused, after the file's name; in one line.
pub fn refusal(request: &DisplacementRequest, mesh: &Mesh) -> String {
    let message = load_displacement(request, mesh).expect_err("the map should be refused").to_string();
    assert!(!message.contains(char::is_control) && message.len() < 800, "{message}");
    let prefix = format!("{}: found ", request.path.display());
    let told = message.strip_prefix(&prefix).unwrap_or_else(|| panic!("{message}"));
    assert!(told.contains(", expected "), "{told}");
    told.to_owned()
}

/// Writes an EXR file of these channels.
pub fn write_exr(path: &Path, size: (usize, usize), encoding: Encoding, channels: Vec<(&str, FlatSamples)>) {
    let channels = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let layer = Layer::new(size, LayerAttributes::named("map"), encoding, AnyChannels::sort(channels));
    Image::from_layer(layer).write().to_file(path).unwrap();
}

/// Writes an EXR file of one float channel, Y.
pub fn write_scalar(path: &Path, size: (usize, usize), values: Vec<f32>) {
    write_exr(path, size, Encoding::SMALL_LOSSLESS, vec![("Y", FlatSamples::F32(values))]);
}

pub fn halves(values: &[f32]) -> FlatSamples {
    FlatSamples::F16(values.iter().map(|&value| f16::from_f32(value)).collect())
}

/// Writes a grey or RGB PNG file.
pub fn write_png(path: &Path, size: (u32, u32), bytes: &[u8], color: image::ExtendedColorType) {
    image::save_buffer_with_format(path, bytes, size.0, size.1, color, image::ImageFormat::Png).unwrap();
}
