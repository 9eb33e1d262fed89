//! Files to scenes: meshes and cameras.
//!
//! [`load`] picks the reader by the file's extension and returns a [`Scene`]; [`read_obj`] does the same from memory.
//! Everything that is read is checked here: a scene that comes back names no vertex or face that it lacks, and has
//! only finite coordinates. What is odd but harmless is a [`Warning`] in the scene; what is wrong is an [`Error`] that
//! says in one line which file, which line, what was found and what was expected.
//!
//! | module | idea |
//! |---|---|
//! | `scene` | what a file holds once read |
//! | `camera` | a pinhole camera, its matrices and the default view |
//! | `bounds` | a bounding box |
//! | `obj` | the OBJ reader, with OpenSubdiv's subdivision tags |
//! | `error` | what can go wrong |
mod bounds;
mod camera;
mod error;
mod obj;
mod scene;

pub use bounds::Bounds;
pub use camera::Camera;
pub use error::Error;
pub use scene::{FaceVaryingChannel, Mesh, Scene, Warning};

use std::path::Path;

/// How files are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Drop degenerate faces (a vertex twice, fewer than three vertices) with a warning instead of refusing the file.
    pub repair: bool,
}

/// Reads a scene file.
///
/// # Errors
/// When the file cannot be read, is of no known format, or its content is wrong (see [`Error`]).
pub fn load(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    let unreadable = |source| Error::Unreadable { path: path.to_owned(), source };
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Err(Error::Directory { path: path.to_owned() });
    }
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
        return Err(Error::UnknownFormat { path: path.to_owned() });
    }
    read_obj(path, &std::fs::read(path).map_err(unreadable)?, options)
}

/// Reads a scene from the bytes of an OBJ file. `path` names the scene (its file stem) and stands in error messages.
///
/// # Errors
/// When the content is wrong (see [`Error`]).
pub fn read_obj(path: impl AsRef<Path>, bytes: &[u8], options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    obj::read(&name, bytes, options).map_err(|fault| Error::Malformed {
        path: path.to_owned(),
        line: fault.line,
        found: fault.found,
        expected: fault.expected,
    })
}
