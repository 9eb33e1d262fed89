//! What can go wrong, in one line each: which file, which line, what was found, what was expected.
use std::io;
use std::path::PathBuf;

/// Why a scene could not be loaded or a camera not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is missing or cannot be read.
    #[error("{}: cannot be read: {source}; expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The path names a directory.
    #[error("{}: found a directory, expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file", .path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
    },
    /// No reader for the file's extension.
    #[error("{}: found a file of unknown format, expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file", .path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// A USD file for a program without the reader of them.
    #[error("{}: found a USD file, expected another: this program was built without USD (cargo feature usd)", .path.display())]
    WithoutUsd {
        /// The file.
        path: PathBuf,
    },
    /// The file's content is wrong.
    #[error("{}: {}found {found}, expected {expected}", .path.display(), line_prefix(.line))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Line counted from 1; none when the whole file is meant.
        line: Option<u32>,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// A scene file of JSON is wrong in one place.
    #[error("{}: {place}: found {found}, expected {expected}", .path.display())]
    Misplaced {
        /// The file.
        path: PathBuf,
        /// Line and column, counted from 1, or the element: `instances[3].mesh`.
        place: String,
        /// What stands there.
        found: String,
        /// What should stand there.
        expected: String,
    },
    /// A mesh of a scene file cannot be read.
    #[error("{}: {place}: {source}", .path.display())]
    Mesh {
        /// The scene file.
        path: PathBuf,
        /// The element that names the mesh' file.
        place: String,
        /// What is wrong with the mesh' file.
        source: Box<Error>,
    },
    /// A displacement map that cannot be read, or does not fit its mesh.
    #[error("{}: found {found}, expected {expected}", .path.display())]
    Displacement {
        /// The map's file.
        path: PathBuf,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
    /// An image of a texture or an environment that cannot be read.
    #[error("image {image}: found {found}, expected {expected}")]
    Image {
        /// What the scene calls it.
        image: String,
        /// What is there.
        found: String,
        /// What should be there.
        expected: String,
    },
    /// A camera that sees nothing.
    #[error("camera: found {found}, expected {expected}")]
    Camera {
        /// The offending values.
        found: String,
        /// What a camera needs.
        expected: &'static str,
    },
    /// No camera of that name.
    #[error("camera: found the name {found:?}, expected {expected}")]
    UnknownCamera {
        /// The name asked for.
        found: String,
        /// The names there are.
        expected: String,
    },
    /// No camera path of that name.
    #[error("camera path: found the name {found:?}, expected {expected}")]
    UnknownPath {
        /// The name asked for.
        found: String,
        /// The names there are.
        expected: String,
    },
}

/// Longest part of a message that comes from a file, in characters.
const MESSAGE_LIMIT: usize = 200;

/// Most names that a message lists.
const NAMES_SHOWN: usize = 10;

/// What was expected of a name: one of those that there are.
pub(crate) fn name_list<'a>(names: impl Iterator<Item = &'a str>, kind: &str) -> String {
    let mut names = names.map(|name| format!("{name:?}"));
    let shown: Vec<String> = names.by_ref().take(NAMES_SHOWN).collect();
    match (shown.as_slice(), names.count()) {
        ([], _) => format!("no name: the scene has no {kind}"),
        (names, 0) => format!("one of {}", names.join(", ")),
        (names, others) => format!("one of {} and {others} others", names.join(", ")),
    }
}

/// A message on one line and of bounded length, whatever names and strings of the file it quotes.
pub(crate) fn shown(message: &str) -> String {
    let mut escaped = String::new();
    for character in message.chars().take(MESSAGE_LIMIT) {
        if character.is_control() {
            escaped.extend(character.escape_default());
        } else {
            escaped.push(character);
        }
    }
    let cut = if message.chars().nth(MESSAGE_LIMIT).is_some() { ".." } else { "" };
    format!("{escaped}{cut}")
}

fn line_prefix(line: &Option<u32>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

/// An error in a file's content before the file's name is known.
#[derive(Debug, PartialEq)]
pub(crate) struct Fault {
    pub line: Option<u32>,
    pub found: String,
    pub expected: String,
}

impl Fault {
    /// A fault in one line, counted from 1.
    pub fn at(line: u32, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { line: Some(line), found: found.into(), expected: expected.into() }
    }

    /// A fault of the file as a whole.
    pub fn whole(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { line: None, found: found.into(), expected: expected.into() }
    }
}
