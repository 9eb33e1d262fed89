//! An image file to texels.
use std::fs::File;
use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::texel::TexelFold;
use super::{DisplacementKind, error_at, exr_file, png_file, tiff_file};
use crate::Error;
use crate::error::{Fault, shown};

/// What a path should lead to.
const EXPECTED: &str = "a displacement map: an .exr, .png, .tif or .tiff file";

/// The texels of an image or of one of its levels, rows from the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    pub width: u32,
    pub height: u32,
    /// Displacements: `width * height` times the kind's channel count.
    pub values: Vec<f32>,
}

/// A file that is being decoded.
pub struct Source {
    pub reader: BufReader<File>,
    /// Length of the file in bytes.
    pub bytes: u64,
}

type Decode = fn(Source, &mut TexelFold) -> Result<Raster, Fault>;

/// Reads an image file.
pub fn read(path: &Path, fold: &mut TexelFold) -> Result<Raster, Error> {
    open(path).and_then(|(source, decode)| decode_guarded(source, decode, fold)).map_err(error_at(path))
}

fn open(path: &Path) -> Result<(Source, Decode), Fault> {
    let unreadable = |error: std::io::Error| Fault::whole(format!("no file that can be read ({error})"), EXPECTED);
    let metadata = std::fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() { "a directory" } else { "something that is no regular file" };
        return Err(Fault::whole(found, EXPECTED));
    }
    let decoders: [(&str, Decode); 4] =
        [("exr", exr_file::decode), ("png", png_file::decode), ("tif", tiff_file::decode), ("tiff", tiff_file::decode)];
    let known = decoders.into_iter().find(|(extension, _)| crate::has_extension(path, extension));
    let (_, decode) = known.ok_or_else(|| Fault::whole("a file of unknown format", EXPECTED))?;
    let reader = BufReader::new(File::open(path).map_err(unreadable)?);
    Ok((Source { reader, bytes: metadata.len() }, decode))
}

/// Runs a decoder. Sizes are checked before anything is decoded, and no file is known that makes the decoders panic; but
/// they are others' code and index what files tell them to, so that a panic of theirs ends here as what it is: a fault of
/// the file. Nothing of theirs outlives it.
fn decode_guarded(source: Source, decode: Decode, fold: &mut TexelFold) -> Result<Raster, Fault> {
    let replaced = fold.replaced;
    catch_unwind(AssertUnwindSafe(|| decode(source, fold))).unwrap_or_else(|_| {
        fold.replaced = replaced;
        Err(Fault::whole("content that the decoder cannot cope with", "an intact image"))
    })
}

/// A decoder's refusal as a fault.
pub fn undecodable(format: &str, reason: impl std::fmt::Display) -> Fault {
    Fault::whole(
        format!("no {format} image that can be decoded ({})", shown(&reason.to_string())),
        format!("an intact {format} file"),
    )
}

/// A vector's channels are missing.
pub fn without_vectors(found: &str) -> Fault {
    Fault::whole(found, "channels R, G and B for a vector displacement")
}

/// Texels of interleaved samples: the first of each texel, or the first three.
pub fn from_samples<S: Copy>(
    [width, height]: [u32; 2],
    samples: &[S],
    channel_count: usize,
    to_raw: impl Fn(S) -> f64,
    fold: &mut TexelFold,
) -> Result<Raster, Fault> {
    let used = fold.kind.channel_count();
    if channel_count < used {
        return Err(without_vectors("an image of one colour channel"));
    }
    let mut values = Vec::with_capacity(width as usize * height as usize * used);
    for texel in samples.chunks_exact(channel_count) {
        match fold.kind {
            DisplacementKind::Scalar => fold.push(&[to_raw(texel[0])], &mut values),
            DisplacementKind::Vector => {
                fold.push(&[to_raw(texel[0]), to_raw(texel[1]), to_raw(texel[2])], &mut values);
            }
        }
    }
    debug_assert_eq!(values.len(), width as usize * height as usize * used);
    Ok(Raster { width, height, values })
}
