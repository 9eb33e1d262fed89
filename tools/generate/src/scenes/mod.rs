//! What stands in `scenes/`: small meshes that each show one feature, the hero, and scenes of several of them.
mod boundaries;
mod chaikin;
mod colors;
mod corners;
mod creases;
mod degenerate;
mod edits;
mod footprints;
mod holes;
mod mixed_creases;
mod nonmanifold;
mod parts;
mod schemes;
mod several;
mod shapes;
mod triangles;
mod uvs;

use crate::cage::Cage;
use crate::gltf_text::GltfText;
use crate::scene_text::SceneText;
use crate::sprout;

/// A mesh file of `scenes/`.
pub struct SceneFile {
    /// The file's stem, which names what it shows.
    pub name: String,
    /// What it shows, for the file's first line.
    pub comment: String,
    /// The mesh.
    pub cage: Cage,
}

impl SceneFile {
    fn new(name: impl Into<String>, comment: impl Into<String>, cage: Cage) -> Self {
        Self { name: name.into(), comment: comment.into(), cage }
    }

    /// The file's name.
    pub fn file_name(&self) -> String {
        format!("{}.obj", self.name)
    }

    /// The file's content.
    pub fn text(&self) -> String {
        self.cage.to_obj(&self.comment)
    }
}

/// All mesh files of `scenes/`.
pub fn all() -> Vec<SceneFile> {
    let features = [
        shapes::files(),
        creases::files(),
        mixed_creases::files(),
        chaikin::files(),
        corners::files(),
        boundaries::files(),
        triangles::files(),
        holes::files(),
        nonmanifold::files(),
        degenerate::files(),
        edits::files(),
        uvs::files(),
        colors::files(),
    ];
    features.into_iter().flatten().collect()
}

/// The folder in `scenes/` of [`of_schemes`].
pub const SCHEMES_FOLDER: &str = "schemes";

/// All mesh files of `scenes/schemes/`: those for schemes of triangles.
pub fn of_schemes() -> Vec<SceneFile> {
    schemes::files()
}

/// All scene files of `scenes/`: their stems and what stands in them.
pub fn placed() -> Vec<(&'static str, SceneText)> {
    vec![("several", several::scene())]
}

/// The glTF scenes of `scenes/` by name: each is written as `.gltf` and as `.glb`.
pub fn gltf() -> Vec<(&'static str, GltfText)> {
    vec![("sprout", sprout::scene())]
}
