//! A scene file, and what its mesh is like.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use glam::{Affine3A, DAffine3};
use planish_gpu::Device;
use planish_render::{ObjectDesc, Surface};
use planish_scene::displacement::DisplacementMap;
use planish_scene::{Camera, Environment, ImageContent, ImageSource, Pose, Scene, load};
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::Creasing;
use planish_subdiv::rules::{VertexRule, is_semi_sharp, vertex_rule};
use planish_subdiv::topology::{Level, NONE};
use serde::Serialize;

use crate::args::{DisplacementArguments, LightArguments, SceneArguments, ViewArguments};
use crate::console::Console;
use crate::culling::backs_are_hidden;
use crate::displacement::{load_maps, upload_map};
use crate::frames::FrameRange;
use crate::values::FrameRate;

/// Vertical field of view of a camera given by its eye, in degrees.
const DEFAULT_FOV: f32 = 45.0;
/// Frames a second of scenes that do not say.
const DEFAULT_FRAME_RATE: f64 = 24.0;

/// A scene: meshes and their instances.
pub struct Cage {
    path: PathBuf,
    scene: Scene,
    /// What each mesh is like.
    mesh_facts: Vec<MeshFacts>,
    /// What all of them are like together.
    pub facts: MeshFacts,
    /// How long reading the files took, in milliseconds.
    pub load_ms: f64,
    /// One a mesh that is displaced, once [`Self::displace`] has read them.
    displacements: Vec<Option<DisplacementMap>>,
}

impl Cage {
    /// Reads a scene file; tells what is odd in it.
    pub fn load(arguments: &SceneArguments, console: &Console) -> Result<Self> {
        let start = Instant::now();
        let path = arguments.path.as_path();
        let scene = load(path, &arguments.load_options())?;
        let load_ms = milliseconds(start);
        for warning in &scene.warnings {
            console.warn(format_args!("{}: {warning}", path.display()));
        }
        let named = || path.display().to_string();
        let facts = scene.meshes.iter().map(|mesh| MeshFacts::new(&mesh.control_mesh)).collect::<Result<Vec<_>>>();
        let facts = facts.with_context(named)?;
        let sum = facts.iter().fold(MeshFacts::default(), MeshFacts::with);
        Ok(Self { path: path.to_owned(), scene, mesh_facts: facts, facts: sum, load_ms, displacements: Vec::new() })
    }

    /// Reads the displacement maps that the scene or the command line asks for.
    pub fn displace(&mut self, arguments: &DisplacementArguments, console: &Console) -> Result<()> {
        let start = Instant::now();
        arguments.apply(&self.path, &mut self.scene)?;
        self.displacements = load_maps(&self.path, &self.scene, console)?;
        self.load_ms += milliseconds(start);
        Ok(())
    }

    /// Lights the scene by the environment that is asked for, or by its own, turned, brightened and shown as asked for.
    pub fn light(&mut self, arguments: &LightArguments) -> Result<()> {
        if let Some(file) = &arguments.environment {
            let image = self.scene.images.len();
            let content = ImageContent::File(file.clone());
            self.scene.images.push(ImageSource { name: file.display().to_string(), content });
            let (color, to_world) = ([1.0; 3], DAffine3::IDENTITY);
            self.scene.environment = Some(Environment { image: Some(image), color, to_world, is_visible: false });
        }
        let LightArguments { environment_rotation, environment_exposure, show_environment, .. } = *arguments;
        if let Some(environment) = &mut self.scene.environment {
            environment.color = environment.color.map(|c| c * environment_exposure.exp2());
            environment.to_world = DAffine3::from_rotation_y(environment_rotation.to_radians()) * environment.to_world;
            environment.is_visible |= show_environment;
        } else if show_environment || environment_rotation != 0.0 || environment_exposure != 0.0 {
            bail!(
                "{}: found no environment to turn, brighten or show, expected one in the scene or --environment",
                self.path.display()
            );
        }
        Ok(())
    }

    /// Whether any mesh has a displacement map.
    pub fn is_displaced(&self) -> bool {
        self.displacements.iter().any(Option::is_some)
    }

    /// Gives the maps to a surface of these meshes.
    pub fn displace_surface(&self, device: &Device, surface: &mut Surface) -> Result<()> {
        for (mesh, map) in self.displacements.iter().enumerate() {
            if let Some(map) = map {
                upload_map(device, surface, mesh, &self.scene.meshes[mesh].control_mesh, map)?;
            }
        }
        Ok(())
    }

    /// The file, as it was named.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The control meshes.
    pub fn meshes(&self) -> Vec<&ControlMesh> {
        self.scene.meshes.iter().map(|mesh| &mesh.control_mesh).collect()
    }

    /// Positions of the vertices of each.
    pub fn positions(&self) -> Vec<&[[f32; 3]]> {
        self.scene.meshes.iter().map(|mesh| mesh.control_mesh.positions.as_slice()).collect()
    }

    /// The control mesh of a scene that has one.
    pub fn mesh(&self) -> Result<&ControlMesh> {
        let [mesh] = self.scene.meshes.as_slice() else {
            bail!("{}: found {} meshes, expected one", self.path.display(), self.scene.meshes.len());
        };
        Ok(&mesh.control_mesh)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Whether a camera path is asked for.
    fn follows_path(&self, view: &ViewArguments) -> bool {
        view.eye.is_none() && view.camera.as_deref().is_some_and(|name| self.scene.path(name).is_ok())
    }

    /// Whether frames may differ.
    pub fn is_animated(&self, view: &ViewArguments) -> bool {
        self.follows_path(view) || self.scene.is_animated()
    }

    /// Whether any cage deforms.
    pub fn deforms(&self) -> bool {
        self.scene.meshes.iter().any(|mesh| mesh.deformation.is_some())
    }

    /// Whether a cage that deforms is displaced.
    pub fn displaces_what_deforms(&self) -> bool {
        let displaced = |mesh: usize| self.displacements.get(mesh).is_some_and(Option::is_some);
        self.scene.meshes.iter().enumerate().any(|(mesh, of)| of.deformation.is_some() && displaced(mesh))
    }

    /// Frames a second: those asked for, else the scene's, else 24.
    pub fn frame_rate(&self, asked: Option<FrameRate>) -> FrameRate {
        asked.unwrap_or_else(|| FrameRate::near(self.scene.frames_per_second.unwrap_or(DEFAULT_FRAME_RATE)))
    }

    /// The frames asked for, else the scene's first.
    pub fn frame_range(&self, asked: Option<FrameRange>, rate: FrameRate) -> FrameRange {
        asked.unwrap_or_else(|| FrameRange::single(self.scene.time_range.map_or(0, |[first, _]| rate.frame_at(first))))
    }

    /// The meshes' instances in a pose, as a camera sees them.
    pub fn objects(&self, camera: &Camera, pose: &Pose) -> Vec<ObjectDesc> {
        let object = |(instance, placed): (&planish_scene::Instance, &planish_scene::InstancePose)| ObjectDesc {
            mesh: instance.mesh,
            to_world: placed.transform,
            hides_backs: self.hides_backs(instance.mesh, &placed.transform, camera),
            is_hidden: !placed.is_visible,
        };
        self.scene.instances.iter().zip(&pose.instances).map(object).collect()
    }

    /// Whether a mesh has texture coordinates.
    pub fn has_uv(&self) -> bool {
        self.scene.meshes.iter().any(|mesh| !mesh.control_mesh.face_varying.is_empty())
    }

    /// Whether a mesh has colours.
    pub fn has_colors(&self) -> bool {
        self.scene.meshes.iter().any(|mesh| mesh.control_mesh.colors.is_some())
    }

    /// Length of the bounding box' diagonal.
    pub fn diagonal(&self) -> f64 {
        self.scene.bounds().map_or(0.0, |bounds| bounds.diagonal())
    }

    /// The camera asked for, so many frames after frame 0: its name may be that of a camera path.
    pub fn camera(&self, view: &ViewArguments, rate: FrameRate, frames: f64) -> Result<Camera> {
        if let (Some(eye), Some(target)) = (view.eye, view.target) {
            let fov = view.fov.unwrap_or(DEFAULT_FOV);
            return Ok(Camera::upright("command line", eye, target, fov, self.diagonal())?);
        }
        let named = || self.path.display().to_string();
        let path = view.camera.as_deref().and_then(|name| self.scene.path(name).ok());
        let mut camera = match path {
            Some(path) => path.camera_between(frames.max(0.0))?,
            None => {
                let camera = self.scene.camera(view.camera.as_deref()).with_context(named)?;
                self.scene.camera_at(&camera, rate.seconds(frames)).with_context(named)?
            }
        };
        camera.fov_y_degrees = view.fov.unwrap_or(camera.fov_y_degrees);
        Ok(camera)
    }

    /// The default view.
    pub fn default_view(&self) -> Result<Camera> {
        self.scene.default_view().with_context(|| self.path.display().to_string())
    }

    /// Whether the backs of an instance's triangles are never seen by a camera.
    fn hides_backs(&self, mesh_index: usize, to_world: &Affine3A, camera: &Camera) -> bool {
        // Edits move the surface out of the cage's bounding box, or make holes; where the mesh is not manifold its sides
        // may be turned against each other.
        let mesh = &self.scene.meshes[mesh_index].control_mesh;
        let facts = &self.mesh_facts[mesh_index];
        let is_closed = facts.boundary_edges == 0 && mesh.holes.is_empty() && mesh.edits.is_empty();
        let has = |feature: &str| facts.sharp_features.contains_key(feature);
        let is_manifold = !has("non_manifold_edges") && !has("non_manifold_vertices");
        // Chaikin's rule has weights below 0 where an edge sharper than 1 becomes smooth.
        let is_within = mesh.options.creasing == Creasing::Uniform || !has("semi_sharp_edges");
        let eye = to_world.inverse().transform_point3(camera.eye);
        // A displaced surface may fold over, and reach out to an eye outside of the cage.
        let is_displaced = self.displacements.get(mesh_index).is_some_and(Option::is_some);
        // One that deforms may turn itself inside out, and a lens sees from beside the eye.
        let deforms = self.scene.meshes[mesh_index].deformation.is_some() || camera.lens.is_some();
        !is_displaced
            && !deforms
            && is_closed
            && is_manifold
            && is_within
            && eye.is_finite()
            && backs_are_hidden(mesh, eye.to_array())
    }
}

/// Milliseconds since `start`.
pub fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Counts of a control mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct MeshFacts {
    /// Vertices, those that no face uses included.
    pub vertices: usize,
    /// Faces, holes included.
    pub faces: usize,
    /// Ptex faces: a quad is one, any other face one a side.
    pub ptex_faces: u64,
    /// Faces by number of sides.
    pub faces_by_sides: BTreeMap<u32, u64>,
    /// Edges of one face.
    pub boundary_edges: u64,
    /// Faces that belong to the surface and are no bicubic patch.
    pub irregular_faces: u64,
    /// Vertices with other than four faces inside, two on the boundary or one at a corner.
    pub extraordinary_vertices: u64,
    /// Those inside, by number of edges.
    pub extraordinary_by_valence: BTreeMap<u32, u64>,
    /// Those on the boundary, by number of edges.
    pub boundary_extraordinary_by_valence: BTreeMap<u32, u64>,
    /// Sharp features, by name; those that the mesh has.
    pub sharp_features: BTreeMap<&'static str, u64>,
}

impl MeshFacts {
    /// The sum with another mesh's.
    fn with(mut self, other: &Self) -> Self {
        fn add<K: Ord + Copy>(to: &mut BTreeMap<K, u64>, from: &BTreeMap<K, u64>) {
            from.iter().for_each(|(&key, count)| *to.entry(key).or_default() += count);
        }
        self.vertices += other.vertices;
        self.faces += other.faces;
        self.ptex_faces += other.ptex_faces;
        self.boundary_edges += other.boundary_edges;
        self.irregular_faces += other.irregular_faces;
        self.extraordinary_vertices += other.extraordinary_vertices;
        add(&mut self.faces_by_sides, &other.faces_by_sides);
        add(&mut self.extraordinary_by_valence, &other.extraordinary_by_valence);
        add(&mut self.boundary_extraordinary_by_valence, &other.boundary_extraordinary_by_valence);
        add(&mut self.sharp_features, &other.sharp_features);
        self
    }

    fn new(mesh: &ControlMesh) -> Result<Self> {
        let level = Level::from_mesh(mesh)?;
        let mut facts = Self {
            vertices: mesh.positions.len(),
            faces: mesh.face_sizes.len(),
            ptex_faces: mesh.ptex_face_count(),
            ..Self::default()
        };
        for &sides in &mesh.face_sizes {
            *facts.faces_by_sides.entry(sides).or_default() += 1;
        }
        facts.boundary_edges = (0..level.origins.len() as u32).filter(|&h| level.is_boundary(h)).count() as u64;
        let is_irregular = |&face: &u32| level.is_drawn(face) && !level.is_regular(face);
        facts.irregular_faces = (0..level.face_count()).filter(is_irregular).count() as u64;
        for (vertex, &tag) in (0..).zip(&level.tags) {
            if level.starts[vertex as usize] == NONE || tag.is_non_manifold() || !tag.is_extraordinary() {
                continue;
            }
            facts.extraordinary_vertices += 1;
            let faces = level.spokes(vertex).count() as u32;
            if tag.is_boundary() {
                *facts.boundary_extraordinary_by_valence.entry(faces + 1).or_default() += 1;
            } else {
                *facts.extraordinary_by_valence.entry(faces).or_default() += 1;
            }
        }
        facts.sharp_features = sharp_features(&level);
        Ok(facts)
    }
}

/// Counts of what is sharp or not manifold in a cage, boundaries apart.
fn sharp_features(level: &Level) -> BTreeMap<&'static str, u64> {
    let mut features = BTreeMap::new();
    let mut count = |name, number: u64| {
        if number > 0 {
            *features.entry(name).or_default() += number;
        }
    };
    count("non_manifold_edges", level.non_manifold_edge_count() as u64);
    for half_edge in 0..level.origins.len() as u32 {
        let sharpness = level.sharpness(half_edge);
        if half_edge < level.twin(half_edge) && sharpness > 0.0 {
            count(if is_semi_sharp(sharpness) { "semi_sharp_edges" } else { "infinitely_sharp_edges" }, 1);
        }
    }
    for (vertex, &tag) in (0..).zip(&level.tags) {
        if level.starts[vertex as usize] == NONE {
            continue;
        }
        let sharpness = level.vertex_sharpness(vertex);
        count("non_manifold_vertices", u64::from(tag.is_non_manifold()));
        count("semi_sharp_vertices", u64::from(is_semi_sharp(sharpness)));
        count("infinitely_sharp_vertices", u64::from(tag.is_corner() && !tag.is_boundary() && !tag.is_non_manifold()));
        if !tag.is_plain() && !tag.is_corner() {
            let edges = level.incident_edges(vertex);
            let sharp = edges.into_iter().filter(|&edge| level.sharpness(edge) > 0.0).count();
            count("darts", u64::from(vertex_rule(sharpness, sharp) == VertexRule::Dart));
        }
    }
    features
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: usize, faces: &[&[u32]]) -> ControlMesh {
        ControlMesh {
            positions: (0..positions).map(|i| [i as f32, (i * i) as f32, 0.0]).collect(),
            face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
            face_vertices: faces.concat(),
            ..ControlMesh::default()
        }
    }

    #[test]
    fn a_cube_has_eight_vertices_of_valence_three_and_no_boundary() {
        let faces: [&[u32]; 6] =
            [&[0, 1, 3, 2], &[2, 3, 5, 4], &[4, 5, 7, 6], &[6, 7, 1, 0], &[1, 7, 5, 3], &[6, 0, 2, 4]];
        let facts = MeshFacts::new(&mesh(8, &faces)).unwrap();
        assert_eq!((facts.vertices, facts.faces, facts.boundary_edges, facts.irregular_faces), (8, 6, 0, 6));
        assert_eq!(facts.extraordinary_by_valence, BTreeMap::from([(3, 8)]));
        assert_eq!(facts.faces_by_sides, BTreeMap::from([(4, 6)]));
    }

    #[test]
    fn a_vertex_that_no_face_uses_is_not_extraordinary() {
        let facts = MeshFacts::new(&mesh(5, &[&[0, 1, 2, 3]])).unwrap();
        assert_eq!((facts.vertices, facts.boundary_edges, facts.extraordinary_vertices), (5, 4, 0));
    }

    #[test]
    fn boundary_vertices_count_their_edges() {
        let facts = MeshFacts::new(&mesh(7, &[&[0, 1, 2], &[0, 2, 3, 4], &[0, 4, 5, 6]])).unwrap();
        assert_eq!(facts.boundary_extraordinary_by_valence, BTreeMap::from([(4, 1)]));
        assert_eq!((facts.ptex_faces, facts.irregular_faces), (5, 3));
    }
}
