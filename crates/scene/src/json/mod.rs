//! The reader of our own scene files: JSON that places meshes of OBJ files and cameras (docs: formats).
//!
//! | module | idea |
//! |---|---|
//! | `text` | the file as it is written, and what is wrong with its form |
//! | `meshes` | names to meshes, each OBJ file read once |
//! | `displacement` | the displacement map that a mesh asks for |
//! | `instances` | where meshes stand, arrays included |
//! | `transform` | the ways to write a transform, and which are refused |
//! | `cameras` | cameras and camera paths |
mod cameras;
mod displacement;
mod instances;
mod meshes;
mod text;
mod transform;

pub use instances::MAX_INSTANCES;

use std::path::Path;

use crate::{Error, LoadOptions, Scene};
use text::SceneText;

/// Reads a scene from the bytes of a scene file of JSON. `path` names the scene (its file stem), stands in error messages,
/// and the OBJ files that the scene names are looked for from its folder.
///
/// # Errors
/// When the content is wrong, or a mesh cannot be read (see [`Error`]).
pub fn read_json(path: impl AsRef<Path>, bytes: &[u8], options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    let misplaced = |fault: Fault| Error::Misplaced {
        path: path.to_owned(),
        place: fault.place,
        found: fault.found,
        expected: fault.expected,
    };
    let text = SceneText::parse(bytes).map_err(misplaced)?;
    let mut meshes = meshes::read(path, &text.meshes, options)?;
    let instances = instances::place(&text.instances, &meshes).map_err(misplaced)?;
    meshes.warn_of_unused(&instances);
    let (meshes, warnings) = meshes.into_parts();
    let mut scene = Scene { name: crate::stem(path), meshes, instances, warnings, ..Scene::default() };
    let diagonal = scene.bounds().map_or(0.0, |bounds| bounds.diagonal());
    scene.cameras = cameras::cameras(&text.cameras, diagonal).map_err(misplaced)?;
    scene.paths = cameras::paths(&text.paths, diagonal).map_err(misplaced)?;
    Ok(scene)
}

/// What is wrong in one place of a scene file.
#[derive(Debug, PartialEq)]
struct Fault {
    /// Line and column, or an element: `instances[3].mesh`.
    place: String,
    found: String,
    expected: String,
}

impl Fault {
    fn new(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { place: place.into(), found: found.into(), expected: expected.into() }
    }

    /// The fault's place within the element `index` of a list. Places are put together only once there is a fault.
    fn within(mut self, list: &str, index: usize) -> Self {
        let separator = if self.place.is_empty() { "" } else { "." };
        self.place = format!("{list}[{index}]{separator}{}", self.place);
        self
    }
}
