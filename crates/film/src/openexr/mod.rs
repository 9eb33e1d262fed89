//! Films to OpenEXR.
//!
//! | module | idea |
//! |---|---|
//! | `options` | how a file is made: compression, one part or several |
//! | `part` | which channels go into which part |
//! | `channels` | where the samples of a channel lie |
//! | `header` | the attributes of a part, in an order that does not change |

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use exr::block::UncompressedBlock;
use exr::block::writer::ChunksWriter;
use exr::error::UnitResult;
use exr::meta::Headers;

use crate::{Error, Film, Result, atomic};
use part::Part;

mod channels;
mod header;
mod options;
mod part;

pub use options::{Compression, ExrOptions};

/// [`write_exr_with`] the default options: one part, ZIP compression.
///
/// # Errors
/// As [`write_exr_with`].
pub fn write_exr(film: &Film, path: &Path) -> Result<()> {
    write_exr_with(film, path, &ExrOptions::default())
}

/// Writes the film as a scan-line EXR file.
///
/// The colour becomes `R G B A` in half precision, rounded to nearest even: beyond 65504 plus half a step it is
/// infinite, and infinities and not-a-numbers pass. Layers keep their bits. Channels are sorted by name as the format
/// demands, attributes too, so that equal films give equal bytes. [`Metadata`](crate::Metadata) lists the attributes.
///
/// # Errors
/// Those of [`Film::check`]; [`Error::LossyLayer`]; [`Error::DwaLevel`]; [`Error::Write`], [`Error::NoFolder`],
/// [`Error::NotAFolder`], [`Error::NotAFile`].
pub fn write_exr_with(film: &Film, path: &Path, options: &ExrOptions) -> Result<()> {
    film.check()?;
    options.check()?;
    let mattes: Vec<_> = film.cryptomattes.iter().map(|matte| (matte, matte.layers())).collect();
    let parts = part::parts(film, &mattes, options);
    parts.iter().try_for_each(Part::check_loss)?;
    let headers: Headers = parts.iter().map(|part| header::header(film, part)).collect();
    atomic::write(path, |writer| fill(writer, headers, &parts).map_err(|error| Error::write(path, io_error(error))))
}

/// Writes the file twice over at its start: the crate writes custom attributes in the random order of a hash map, so the
/// headers, which take as many bytes in any order, are replaced by sorted ones.
fn fill(writer: &mut BufWriter<&File>, headers: Headers, parts: &[Part<'_>]) -> UnitResult {
    let sorted = header::sorted_bytes(&headers)?;
    exr::block::write(&mut *writer, headers, true, |meta, chunks| {
        let blocks = meta.collect_ordered_blocks(|index| UncompressedBlock {
            index,
            data: parts[index.layer].channels.block(&meta.headers[index.layer].channels, index),
        });
        chunks.on_progress(|_| ()).compress_all_blocks_parallel(&meta, blocks)
    })?;
    header::overwrite(writer, &sorted)?;
    Ok(())
}

fn io_error(error: exr::error::Error) -> io::Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    }
}
