//! Files to scenes: meshes, where they stand, and cameras.
//!
//! [`load`] picks the reader by the file's extension and returns a [`Scene`]; [`read_obj`], [`read_json`] and [`read_gltf`] do the same
//! from memory.
//! Everything that is read is checked here: a scene that comes back names no vertex or face that it lacks, and has
//! only finite coordinates. What is odd but harmless is a [`Warning`] in the scene; what is wrong is an [`Error`] that
//! says in one line which file, which line, what was found and what was expected.
//!
//! | module | idea |
//! |---|---|
//! | `scene` | what a file holds once read |
//! | `instance` | where a mesh stands |
//! | `camera` | a pinhole camera, its matrices and the default view |
//! | `path` | a camera that moves from frame to frame |
//! | `curve` | a value that changes over time |
//! | `node` | frames of reference that move |
//! | `deformation` | vertices that move: points over time, morph targets, skins |
//! | `pose` | a scene at one time |
//! | `material` | what surfaces are made of |
//! | `texture` | image files to texels |
//! | `light` | what lights them |
//! | `bounds` | a bounding box |
//! | `obj` | the OBJ reader, with OpenSubdiv's subdivision tags |
//! | `gltf` | the glTF 2.0 reader |
//! | `usd` | the USD reader, behind the cargo feature `usd` |
//! | `displacement` | displacement maps, ready for upload |
//! | `json` | the reader of our own scene files, which place meshes of OBJ files |
//! | `error` | what can go wrong |
mod bounds;
mod camera;
pub mod curve;
pub mod deformation;
pub mod displacement;
mod error;
mod gltf;
mod instance;
mod json;
pub mod light;
pub mod material;
pub mod node;
mod obj;
mod path;
mod pose;
mod scene;
pub mod texture;
#[cfg(feature = "usd")]
mod usd;

pub use self::gltf::read_gltf;
#[cfg(feature = "usd")]
pub use self::usd::read_usd;
pub use bounds::Bounds;
pub use camera::{Camera, CameraRig, Lens};
pub use curve::{Curve, Interpolation};
pub use deformation::{Deformation, MeshPose};
pub use error::Error;
pub use instance::Instance;
pub use json::{MAX_INSTANCES, read_json};
pub use light::{Environment, Light, LightKind, LightPose};
pub use material::{AlphaMode, ImageContent, ImageSource, Material, Texture, TextureRef, Wrap};
pub use node::Node;
pub use path::{CameraPath, Key, MAX_FRAMES};
pub use pose::{InstancePose, Pose};
pub use scene::{Mesh, Scene, Warning};
pub use texture::{DecodedImage, Pixels, decode_image};

use std::path::Path;

use glam::Affine3A;

/// How files are read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Drop degenerate faces (a vertex twice, fewer than three vertices) with a warning instead of refusing the file.
    pub repair: bool,
    /// The name of the animation to read of a file that has several (glTF); none: its first.
    pub clip: Option<String>,
    /// Pairs of triangles of files that have nothing else (glTF) become quads where they make good ones.
    pub quads: bool,
}

/// Extensions of USD files.
const USD_EXTENSIONS: [&str; 4] = ["usd", "usda", "usdc", "usdz"];

/// Reads a scene file: an `.obj`, a `.json` and the OBJ files that it names, a `.gltf` or `.glb` and the files that it names, or a
/// USD file (`.usd`, `.usda`, `.usdc`, `.usdz`) and the layers that it names.
///
/// # Errors
/// When a file cannot be read, is of no known format, or its content is wrong (see [`Error`]).
pub fn load(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    if has_extension(path, "json") {
        return read_json(path, &file_bytes(path)?, options);
    }
    if has_extension(path, "gltf") || has_extension(path, "glb") {
        return read_gltf(path, &file_bytes(path)?, options);
    }
    if USD_EXTENSIONS.iter().any(|extension| has_extension(path, extension)) {
        refuse_directory(path)?;
        #[cfg(feature = "usd")]
        return read_usd(path, options);
        #[cfg(not(feature = "usd"))]
        return Err(Error::WithoutUsd { path: path.to_owned() });
    }
    read_obj(path, &obj_bytes(path)?, options)
}

/// Reads a scene from the bytes of an OBJ file. `path` names the scene (its file stem) and stands in error messages.
///
/// # Errors
/// When the content is wrong (see [`Error`]).
pub fn read_obj(path: impl AsRef<Path>, bytes: &[u8], options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    let (mesh, warnings) = read_mesh(path, bytes, options)?;
    let instance = Instance::placed(mesh.name.clone(), 0, Affine3A::IDENTITY);
    Ok(Scene { name: stem(path), meshes: vec![mesh], instances: vec![instance], warnings, ..Scene::default() })
}

/// The mesh of an OBJ file's bytes.
fn read_mesh(path: &Path, bytes: &[u8], options: &LoadOptions) -> Result<(Mesh, Vec<Warning>), Error> {
    obj::read(&stem(path), bytes, options).map_err(|fault| Error::Malformed {
        path: path.to_owned(),
        line: fault.line,
        found: fault.found,
        expected: fault.expected,
    })
}

/// What an OBJ file holds; none but those are opened.
fn obj_bytes(path: &Path) -> Result<Vec<u8>, Error> {
    refuse_directory(path)?;
    if !has_extension(path, "obj") {
        return Err(Error::UnknownFormat { path: path.to_owned() });
    }
    file_bytes(path)
}

fn file_bytes(path: &Path) -> Result<Vec<u8>, Error> {
    refuse_directory(path)?;
    std::fs::read(path).map_err(|source| Error::Unreadable { path: path.to_owned(), source })
}

fn refuse_directory(path: &Path) -> Result<(), Error> {
    match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => Err(Error::Directory { path: path.to_owned() }),
        Ok(_) => Ok(()),
        Err(source) => Err(Error::Unreadable { path: path.to_owned(), source }),
    }
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
