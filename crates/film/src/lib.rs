//! Frame buffers to EXR and PNG files, tessellated surfaces to PLY and back.
//!
//! | module | from | to |
//! |---|---|---|
//! | `film` | | [`Film`]: colour, [`Layer`]s, [`Metadata`] |
//! | `openexr` | [`Film`] | single-part EXR: `R G B A` half, layers as float or uint, ZIP |
//! | `png` | [`Film`]'s colour | 8 bit sRGB |
//! | `ply` | [`DumpVertex`] stream | binary little-endian PLY, a triangle soup |
//! | `ply_reader`, `ply_header` | such a PLY | [`DumpVertex`] stream |
//! | `output` | a path | the format it asks for, or why nothing can be written there |
//! | `atomic` | bytes | a file that is complete or absent |
//!
//! Every file is written to a temporary one in the same folder, flushed to the device and renamed: a target that exists
//! is replaced whole or left as it was. Equal input gives equal bytes.

mod atomic;
mod error;
mod film;
mod metadata;
mod openexr;
mod output;
mod ply;
mod ply_header;
mod ply_reader;
mod png;
mod srgb;

pub use error::{Error, Result};
pub use film::{Film, Layer, Samples};
pub use metadata::{Matrix, Metadata};
pub use openexr::write_exr;
pub use output::{ImageFormat, check_dump_output, check_image_output, check_text_output, write_image, write_text};
pub use ply::{DumpProperties, DumpVertex, write_ply, write_ply_stream};
pub use ply_reader::read_ply_stream;
pub use png::write_png;
