//! Why a file could not be written or read.

use std::{io, path::PathBuf};

use thiserror::Error;

use crate::Window;

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
    /// A film's window has no pixels, or lies beyond what EXR can say.
    #[error(
        "a film of {width}x{height} pixels at {},{} in a frame of {}x{} cannot be written; expected a frame of at least \
         1x1 and coordinates within {}",
        window.x, window.y, window.full_width, window.full_height, i32::MAX / 2
    )]
    Window {
        /// The window.
        window: Window,
        /// Pixels in a row of the film.
        width: u32,
        /// Rows of the film.
        height: u32,
    },
    /// EXR cannot store an attribute under this name.
    #[error("the attribute {:?} has an unfit name; expected at most 255 printable ASCII characters", format!("planish/{name}"))]
    AttributeName {
        /// The name without `planish/`.
        name: String,
    },
    /// A single part that is compressed by DWAA would lose bits of data.
    #[error("DWAA would lose bits of channel {channel}: layers that are no light need parts of their own (multipart)")]
    LossyLayer {
        /// The channel's name.
        channel: String,
    },
    /// DWAA's level is no level.
    #[error("DWAA's level is {level}; expected a number of at least 0")]
    DwaLevel {
        /// What was asked for.
        level: f32,
    },
    /// An exposure that light cannot be multiplied by.
    #[error("the exposure is {stops} stops; expected -126 to 127")]
    Exposure {
        /// What was asked for.
        stops: f32,
    },
    /// A Cryptomatte's pixels have no ranks, or more than can be numbered.
    #[error("Cryptomatte {name} has {found} ranks a pixel; expected 1 to {most}")]
    RankCount {
        /// The Cryptomatte's name.
        name: String,
        /// Ranks a pixel.
        found: usize,
        /// The most that are possible.
        most: usize,
    },
    /// A Cryptomatte has not the same number of ranks in each pixel.
    #[error("Cryptomatte {name} has {found} ranks; expected {expected}, {rank_count} a pixel")]
    RankLength {
        /// The Cryptomatte's name.
        name: String,
        /// Width times height times ranks.
        expected: u64,
        /// Ranks found.
        found: usize,
        /// Ranks a pixel.
        rank_count: usize,
    },
    /// A Cryptomatte has a rank of a name that it has not.
    #[error("Cryptomatte {name} has a rank of name {index}, but only {name_count} names")]
    RankIndex {
        /// The Cryptomatte's name.
        name: String,
        /// The index found.
        index: u32,
        /// Names there are.
        name_count: usize,
    },
    /// A Cryptomatte has a coverage that is none.
    #[error("Cryptomatte {name} has a coverage of {coverage}; expected a number of at least 0")]
    RankCoverage {
        /// The Cryptomatte's name.
        name: String,
        /// The coverage found.
        coverage: f32,
    },
    /// Two Cryptomattes have the same name.
    #[error("two Cryptomattes of the film are named {name:?}")]
    DuplicateCryptomatte {
        /// The name.
        name: String,
    },
    /// The thread that writes films is gone.
    #[error("the thread that writes images has stopped")]
    WriterStopped,
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
