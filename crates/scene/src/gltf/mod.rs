//! The glTF 2.0 reader: `.gltf` and `.glb` (docs: formats).
//!
//! The `gltf` crate turns JSON into its types; all indices, ranges and numbers are checked here, where they are used.
//!
//! | module | idea |
//! |---|---|
//! | `container` | JSON alone, or in a GLB |
//! | `uri` | data URIs, and the files that a scene may name |
//! | `data` | buffers, views, and how much memory a file may claim |
//! | `accessor` | numbers from views |
//! | `extensions` | which extensions are understood |
//! | `hierarchy` | the order of nodes |
//! | `animation` | one animation's curves |
//! | `nodes` | nodes that move |
//! | `primitive` | vertices and triangles as they are written |
//! | `weld` | vertices that were split become one |
//! | `faces` | polygons that the order of triangles encodes |
//! | `quads` | quads where nothing encodes them |
//! | `tags` | creases, corners, holes and options in extras |
//! | `cage` | all of this makes one cage of a mesh |
//! | `deform` | morph targets and skins |
//! | `meshes` | cages, and where they stand |
//! | `textures`, `materials` | what surfaces are made of |
//! | `lights` | lights and cameras |
//! | `fault` | what is wrong in one place |
mod accessor;
mod animation;
mod cage;
mod container;
mod data;
mod deform;
mod extensions;
mod faces;
pub(crate) mod fault;
mod hierarchy;
mod lights;
mod materials;
mod meshes;
mod nodes;
mod primitive;
mod quads;
mod tags;
mod textures;
mod uri;
mod weld;

use std::path::Path;

use crate::node::place_nodes;
use crate::obj::Warnings;
use crate::{Error, LoadOptions, Scene};
use data::Data;
use fault::Fault;
use hierarchy::Hierarchy;
use materials::Materials;
use textures::Textures;

/// Reads a scene from the bytes of a glTF file, JSON or GLB. `path` names the scene (its file stem) and stands in error messages,
/// and buffers and images that the file names are looked for from its folder. Images are not opened.
///
/// # Errors
/// When the content is wrong, or a buffer cannot be read (see [`Error`]).
pub fn read_gltf(path: impl AsRef<Path>, bytes: &[u8], options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    read(path, bytes, options).map_err(|fault| Error::Misplaced {
        path: path.to_owned(),
        place: fault.place,
        found: fault.found,
        expected: fault.expected,
    })
}

fn read(path: &Path, bytes: &[u8], options: &LoadOptions) -> Result<Scene, Fault> {
    let mut warnings = Warnings::default();
    let (root, blob) = container::parse(bytes)?;
    extensions::check(&root, &mut warnings)?;
    let data = Data::read(path, &root, blob, bytes.len())?;
    let hierarchy = Hierarchy::read(&root)?;
    let clip = animation::read(&data, options.clip.as_deref())?;
    let nodes = nodes::nodes(&data, &hierarchy, &clip)?;
    let textures = Textures::read(&data, &mut warnings)?;
    let materials = Materials::read(&data, &textures, &mut warnings)?;
    let time = clip.time_range.map_or(0.0, |[first, _]| first);
    let placed = place_nodes(&nodes, time);
    let context = meshes::Context {
        data: &data,
        hierarchy: &hierarchy,
        clip: &clip,
        materials: &materials,
        nodes: &nodes,
        placed: &placed,
        options,
    };
    let (meshes, instances) = meshes::read(&context, &mut warnings)?;
    if instances.is_empty() {
        return Err(Fault::new("scene", "no mesh of triangles", "one or more"));
    }
    let lights = lights::lights(&data, &hierarchy)?;
    let clips = animation::names(&root.animations);
    let time_range = clip.time_range;
    let mut scene =
        Scene { name: crate::stem(path), meshes, instances, nodes, lights, clips, time_range, ..Scene::default() };
    (scene.materials, scene.textures, scene.images) = (materials.materials, textures.textures, textures.images);
    let bounds = scene.posed_bounds(&scene.pose(time));
    let diagonal = bounds.map(|bounds| bounds.diagonal()).filter(|&diagonal| diagonal > 0.0).unwrap_or(1.0);
    scene.cameras = lights::cameras(&data, &hierarchy, &placed, (time, diagonal), &mut warnings)?;
    scene.warnings = warnings.into_vec();
    Ok(scene)
}
