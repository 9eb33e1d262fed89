//! The USD reader: `.usda`, `.usdc`, `.usd` and `.usdz` (docs: formats).
//!
//! The `openusd` crate composes a stage (layers, references, payloads, variants); what prims mean is read here, and all
//! indices and numbers are checked where they are used.
//!
//! | module | idea |
//! |---|---|
//! | `walk` | prims, and the nodes that they stand on |
//! | `xform` | ops of a prim's transform |
//! | `attributes` | what a prim says of itself, over time |
//! | `convert` | values to numbers |
//! | `guard` | what is checked before the crate reads a layer, and its panics |
//! | `layers` | layers that are missing |
//! | `faces` | faces, checked |
//! | `tags` | creases, corners, holes and options |
//! | `primvar` | values of vertices, faces and corners |
//! | `cage` | all of this makes one cage of a mesh |
//! | `meshes` | cages, and where they stand |
//! | `shared` | meshes that say the same |
//! | `instancer` | meshes on points |
//! | `skeleton`, `skin` | UsdSkel |
//! | `materials` | UsdPreviewSurface, and what is bound to it |
//! | `network`, `textures` | what shaders are connected to |
//! | `lights`, `blackbody` | UsdLux |
//! | `cameras` | UsdGeomCamera |
mod attributes;
mod blackbody;
mod cage;
mod cameras;
mod convert;
mod faces;
mod guard;
mod instancer;
mod layers;
mod lights;
mod materials;
mod meshes;
mod network;
mod primvar;
mod shared;
mod skeleton;
mod skin;
mod tags;
mod textures;
mod walk;
mod xform;

use std::path::Path;

use crate::gltf::fault::Fault;
use crate::node::{Node, place_nodes};
use crate::obj::Warnings;
use crate::{Error, LoadOptions, Mesh, Scene};
use guard::Stage;
use materials::Materials;
use walk::Tree;

/// Reads a scene from a USD file and the layers that it names. Images are not opened.
///
/// # Errors
/// When a layer cannot be read, or the content is wrong (see [`Error`]).
pub fn read_usd(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Scene, Error> {
    let path = path.as_ref();
    crate::refuse_directory(path)?;
    // The crate that reads layers panics on some malformed ones.
    guard::apart(|| read_checked(path, options))
        .unwrap_or_else(|| Err(misplaced(path, Fault::new("layers", "a malformed file", "a USD file"))))
}

/// What is wrong with a layer is told before what follows from it.
fn read_checked(path: &Path, options: &LoadOptions) -> Result<Scene, Error> {
    let findings = guard::Findings::of(path);
    let read = guard::silent(|| read(path, options, &findings));
    if let Some(error) = findings.take_error() {
        return Err(error);
    }
    let read = read.unwrap_or_else(|| Err(Fault::new("layers", "a malformed file", "a USD file")));
    read.map_err(|fault| misplaced(path, fault))
}

fn misplaced(path: &Path, fault: Fault) -> Error {
    let (path, found, expected) = (path.to_owned(), fault.found, fault.expected);
    match fault.place {
        place if place.is_empty() => Error::Malformed { path, line: None, found, expected },
        place => Error::Misplaced { path, place, found, expected },
    }
}

fn read(path: &Path, options: &LoadOptions, findings: &guard::Findings) -> Result<Scene, Fault> {
    let stage = open(path, findings)?;
    let scene = scene(path, &stage, options);
    // What is missing is told before what follows from it.
    stage.composition_errors().iter().try_for_each(layers::check)?;
    scene
}

fn scene(path: &Path, stage: &Stage, options: &LoadOptions) -> Result<Scene, Fault> {
    let mut warnings = Warnings::default();
    let rate = rate(stage)?;
    let is_z_up = is_z_up(stage)?;
    let mut tree = Tree::read(stage, rate, is_z_up)?;
    instancer::expand(&mut tree, rate)?;
    let skeletons = skeleton::expand(stage, &mut tree, rate)?;
    let skins = skin::Skins { stage, skeletons: &skeletons };
    let first = authored_range(stage, rate).or_else(|| moving_range(&tree.nodes, &[]));
    let time = first.map_or(0.0, |[first, _]| first);
    let placed = place_nodes(&tree.nodes, time);
    let context = meshes::Context { tree: &tree, placed: &placed, skins: &skins, rate, time, is_z_up, options };
    let mut materials = Materials::new(stage);
    let read = meshes::read(&context, &mut materials, &mut warnings)?;
    if read.instances.is_empty() {
        return Err(Fault::new("/", "no mesh of faces", "one or more"));
    }
    let lights = lights::read(&context, &mut materials.textures, &mut warnings)?;
    let mut scene =
        Scene { name: crate::stem(path), meshes: read.meshes, instances: read.instances, ..Scene::default() };
    scene.nodes = tree.nodes.clone();
    let bounds = scene.posed_bounds(&scene.pose(time));
    let diagonal = bounds.map(|bounds| bounds.diagonal()).filter(|&diagonal| diagonal > 0.0).unwrap_or(1.0);
    scene.cameras = cameras::cameras(&context, (time, diagonal), &mut warnings)?;
    (scene.lights, scene.environment) = (lights.lights, lights.environment);
    scene.materials = materials.materials;
    (scene.textures, scene.images) = (materials.textures.textures, materials.textures.images);
    scene.time_range = authored_range(stage, rate).or_else(|| moving_range(&scene.nodes, &scene.meshes));
    let rate = stage.frames_per_second();
    scene.frames_per_second = scene.time_range.and((rate.is_finite() && rate > 0.0).then_some(rate));
    for error in stage.composition_errors() {
        warnings.push(None, crate::error::shown(&format!("{error}: ignored")));
    }
    scene.warnings = warnings.into_vec();
    Ok(scene)
}

/// First and last moment in seconds, as the stage says.
fn authored_range(stage: &Stage, rate: f64) -> Option<[f64; 2]> {
    let authored = stage.has_authored_time_code_range();
    let authored = authored.then(|| [stage.start_time_code() / rate, stage.end_time_code() / rate]);
    authored.filter(|[first, last]| first.is_finite() && last.is_finite() && first <= last)
}

fn open(path: &Path, findings: &guard::Findings) -> Result<Stage, Fault> {
    let Some(name) = path.to_str() else {
        return Err(Fault::new("layers", "a path that is not UTF-8", "one that is"));
    };
    Stage::open(name, findings)
}

/// Time codes a second.
fn rate(stage: &Stage) -> Result<f64, Fault> {
    let rate = stage.time_codes_per_second();
    if rate.is_finite() && rate > 0.0 {
        return Ok(rate);
    }
    Err(Fault::new("timeCodesPerSecond", format!("{rate}"), "a finite number above 0"))
}

fn is_z_up(stage: &Stage) -> Result<bool, Fault> {
    let axis = stage.stage_metadata("upAxis");
    let axis = axis.map_err(|error| Fault::new("upAxis", error.to_string(), "Y or Z"))?.and_then(convert::token);
    match axis.as_deref() {
        None | Some("Y") => Ok(false),
        Some("Z") => Ok(true),
        Some(other) => Err(Fault::new("upAxis", format!("{other:?}"), "Y or Z")),
    }
}

/// First and last key of what moves nodes and vertices; none where nothing does.
fn moving_range(nodes: &[Node], meshes: &[Mesh]) -> Option<[f64; 2]> {
    let points = meshes.iter().filter_map(|mesh| mesh.deformation.as_ref()).flat_map(|deformation| {
        let points = deformation.points.iter().flat_map(|curve| curve.times());
        points.chain(deformation.weights.iter().flat_map(|curve| curve.times())).copied()
    });
    let mut range: Option<[f64; 2]> = None;
    for time in nodes.iter().flat_map(Node::key_times).chain(points) {
        let [first, last] = range.unwrap_or([time, time]);
        range = Some([first.min(time), last.max(time)]);
    }
    range
}
