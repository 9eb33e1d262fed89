//! Why a file could not be written or read.

use std::{io, path::PathBuf};

use thiserror::Error;

/// The result of everything here that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file could not be written or read: one line each, naming the file or the layer, and what was expected.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The system refused, or an encoder did.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file asked for, not the temporary one.
        path: PathBuf,
        /// What was answered.
        source: io::Error,
    },
    /// The path's extension names no format that can hold this.
    #[error("cannot write {}: its extension must be {accepted}", path.display())]
    Extension {
        /// The file asked for.
        path: PathBuf,
        /// The extensions that would do.
        accepted: &'static str,
    },
    /// The folder that the file is to lie in does not exist.
    #[error("cannot write {}: there is no folder {}", path.display(), folder.display())]
    NoFolder {
        /// The file asked for.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// What the file is to lie in is no folder.
    #[error("cannot write {}: {} is not a folder", path.display(), folder.display())]
    NotAFolder {
        /// The file asked for.
        path: PathBuf,
        /// What is there instead of a folder.
        folder: PathBuf,
    },
    /// The path names a folder, a device or the like, which renaming would replace.
    #[error("cannot write {}: it exists and is not a regular file", path.display())]
    NotAFile {
        /// The path asked for.
        path: PathBuf,
    },
    /// A film without pixels.
    #[error("a film of {width}x{height} pixels cannot be written; expected at least 1x1")]
    EmptyFilm {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The colour has not one entry a pixel.
    #[error("the film's colour has {found} pixels; expected {expected}")]
    ColorLength {
        /// Width times height.
        expected: u64,
        /// Entries found.
        found: usize,
    },
    /// A layer has not one sample a pixel and channel.
    #[error("layer {layer} has {found} samples; expected {expected}, {channel_count} a pixel")]
    LayerLength {
        /// The layer's name.
        layer: String,
        /// Width times height times channels.
        expected: u64,
        /// Samples found.
        found: usize,
        /// Samples a pixel.
        channel_count: usize,
    },
    /// EXR cannot store a channel under this name.
    #[error("layer {layer:?} gives a channel the name {channel:?}; expected 1 to 255 printable ASCII characters")]
    ChannelName {
        /// The layer's name.
        layer: String,
        /// The channel's.
        channel: String,
    },
    /// Two layers, or a layer and the colour, have a channel of the same name.
    #[error("two channels of the film are named {channel:?}")]
    DuplicateChannel {
        /// The name.
        channel: String,
    },
    /// The vertices of a dump do not make whole triangles.
    #[error("cannot write {}: {vertex_count} vertices are not whole triangles", path.display())]
    PartialTriangle {
        /// The file asked for.
        path: PathBuf,
        /// Vertices announced.
        vertex_count: u64,
    },
    /// A dump has more vertices than PLY's `int` can count.
    #[error("cannot write {}: {vertex_count} vertices are more than the {} that PLY indices reach", path.display(), i32::MAX)]
    TooManyVertices {
        /// The file asked for.
        path: PathBuf,
        /// Vertices announced.
        vertex_count: u64,
    },
    /// A stream of vertices ended early or went on.
    #[error("cannot write {}: {expected} vertices were announced, but the stream has {}", path.display(), stream_length(*found, *expected))]
    StreamLength {
        /// The file asked for.
        path: PathBuf,
        /// Vertices announced.
        expected: u64,
        /// Vertices taken; reading stops at the first one too many.
        found: u64,
    },
    /// The system refused to read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What was answered.
        source: io::Error,
    },
    /// A file is not a dump, or not all of one.
    #[error("cannot read {}: found {found}, expected {expected}", path.display())]
    NotADump {
        /// The file asked for.
        path: PathBuf,
        /// What is there.
        found: String,
        /// What a dump has there.
        expected: String,
    },
}

/// "12", or "more" where the stream was not read to its end.
fn stream_length(found: u64, expected: u64) -> String {
    if found > expected { "more".to_owned() } else { found.to_string() }
}
