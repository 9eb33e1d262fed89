//! Frame buffers to EXR and PNG files, tessellated surfaces to PLY and back.
//!
//! | module | from | to |
//! |---|---|---|
//! | `film`, `layer` | | [`Film`]: colour, [`Layer`]s, [`Cryptomatte`]s, [`Metadata`], [`Window`] |
//! | `cryptomatte`, `murmur` | ids and coverages | layers, and the header's manifest |
//! | `openexr` | [`Film`] | EXR of one part or several: `R G B A` half, layers as they are |
//! | `png`, `tone` | [`Film`]'s colour | 8 bit sRGB |
//! | `writer` | [`Film`]s | files, on a thread of its own |
//! | `complete` | a path | whether the image there is whole |
//! | `ply` | [`DumpVertex`] stream | binary little-endian PLY, a triangle soup |
//! | `ply_reader`, `ply_header` | such a PLY | [`DumpVertex`] stream |
//! | `output` | a path | the format it asks for, or why nothing can be written there |
//! | `atomic` | bytes | a file that is complete or absent |
//!
//! Every file is written to a temporary one in the same folder, flushed to the device and renamed: a target that exists
//! is replaced whole or left as it was. Equal input gives equal bytes. [`write_scratch`] alone does not flush.

mod atomic;
mod complete;
mod cryptomatte;
mod error;
mod film;
mod layer;
mod metadata;
mod murmur;
mod openexr;
mod output;
mod ply;
mod ply_header;
mod ply_reader;
mod png;
mod srgb;
mod tone;
mod writer;

pub use atomic::{remove_stale_files, write_scratch};
pub use complete::is_complete;
pub use cryptomatte::{Cryptomatte, DEFAULT_RANK_COUNT};
pub use error::{Error, Result};
pub use film::{Film, Window};
pub use layer::{Layer, Samples};
pub use metadata::{Matrix, Metadata};
pub use openexr::{Compression, ExrOptions, write_exr, write_exr_with};
pub use output::{
    ImageFormat, WriteOptions, check_dump_output, check_image_output, check_text_output, write_image, write_image_with,
    write_text,
};
pub use ply::{DumpProperties, DumpVertex, write_ply, write_ply_stream};
pub use ply_reader::read_ply_stream;
pub use png::{PngOptions, write_png, write_png_with};
pub use tone::ToneMap;
pub use writer::{FilmWriter, QUEUE_LENGTH, Target, WriterReport};
