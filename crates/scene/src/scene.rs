//! What a file holds once read.
use std::fmt;

use planish_subdiv::mesh::ControlMesh;

use crate::displacement::DisplacementRequest;
use crate::error::name_list;
use crate::light::{Environment, Light};
use crate::material::{ImageSource, Material, Texture};
use crate::node::Node;
use crate::{Bounds, Camera, CameraPath, Deformation, Error, Instance};

/// A scene: meshes, where they stand, and the cameras to see them with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The file's stem.
    pub name: String,
    /// The meshes, in file order. One OBJ file is one mesh, whatever its groups, objects and materials.
    pub meshes: Vec<Mesh>,
    /// Where the meshes stand, in file order: a mesh may stand in many places, or in none. An OBJ file's stands in one, as
    /// it is.
    pub instances: Vec<Instance>,
    /// The file's own cameras; an OBJ file has none.
    pub cameras: Vec<Camera>,
    /// The file's own camera paths; an OBJ file has none.
    pub paths: Vec<CameraPath>,
    /// Frames of reference, each after its parent.
    pub nodes: Vec<Node>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Textures of the materials.
    pub textures: Vec<Texture>,
    /// Images of the textures and of the environment.
    pub images: Vec<ImageSource>,
    /// Lights.
    pub lights: Vec<Light>,
    /// Light from all around.
    pub environment: Option<Environment>,
    /// Names of the animations that the file holds; which one is read is [`crate::LoadOptions::clip`].
    pub clips: Vec<String>,
    /// First and last moment of what moves, in seconds; none where nothing does.
    pub time_range: Option<[f64; 2]>,
    /// Frames a second, where the file says.
    pub frames_per_second: Option<f64>,
    /// What is odd in the file but does not keep it from being read, in the order in which it was noticed.
    pub warnings: Vec<Warning>,
}

/// A mesh of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The object's name in the file (OBJ: the first `o`), else the file's stem.
    pub name: String,
    /// The cage. Texture coordinates, when every corner of every face has one, are its face-varying channel `st`.
    pub control_mesh: ControlMesh,
    /// The displacement map that a scene file asks for; [`crate::displacement::load_displacement`] reads it.
    pub displacement: Option<DisplacementRequest>,
    /// Names of the slots that an instance has a material in each of; none: one without a name.
    pub slots: Vec<String>,
    /// The slot of each face, into `slots`; empty: all are of the first.
    pub face_slots: Vec<u32>,
    /// How the vertices move; none: they stay. A mesh with a skin has one instance.
    pub deformation: Option<Deformation>,
}

/// Something odd in a file that did not keep it from being read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Line counted from 1; none when the whole file is meant.
    pub line: Option<u32>,
    /// What was found, and what was done about it.
    pub text: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(formatter, "line {line}: {}", self.text),
            None => formatter.write_str(&self.text),
        }
    }
}

impl Scene {
    /// The box in world space around the boxes of all instances; none when there are none.
    ///
    /// An instance's box is that of its mesh, all control points included, with its corners transformed: exact where the
    /// transform only moves, scales and mirrors along the axes, and else somewhat larger than need be, at the cost of eight
    /// points an instance.
    pub fn bounds(&self) -> Option<Bounds> {
        let meshes: Vec<Option<Bounds>> = self.meshes.iter().map(Mesh::bounds).collect();
        let boxes = self.instances.iter().filter_map(|instance| {
            let mesh = meshes.get(instance.mesh).copied().flatten()?;
            Some(instance.bounds(&mesh))
        });
        boxes.reduce(Bounds::union)
    }

    /// The camera called `name`; without a name the scene's first camera, else the default view.
    ///
    /// # Errors
    /// When the scene has no camera of that name, or the default view does not exist ([`Camera::default_view`]).
    pub fn camera(&self, name: Option<&str>) -> Result<Camera, Error> {
        match name {
            Some(name) => {
                self.cameras.iter().find(|camera| camera.name == name).cloned().ok_or_else(|| Error::UnknownCamera {
                    found: name.to_owned(),
                    expected: name_list(self.cameras.iter().map(|camera| camera.name.as_str()), "cameras"),
                })
            }
            None => match self.cameras.first() {
                Some(camera) => Ok(camera.clone()),
                None => self.default_view(),
            },
        }
    }

    /// The default view of the whole scene.
    ///
    /// # Errors
    /// When there are no points, or all are one point.
    pub fn default_view(&self) -> Result<Camera, Error> {
        match self.bounds() {
            Some(bounds) => Camera::default_view(&bounds),
            None => Err(Error::Camera { found: "a scene without points".to_owned(), expected: "something to look at" }),
        }
    }

    /// The camera path called `name`.
    ///
    /// # Errors
    /// When the scene has no path of that name.
    pub fn path(&self, name: &str) -> Result<&CameraPath, Error> {
        self.paths.iter().find(|path| path.name() == name).ok_or_else(|| Error::UnknownPath {
            found: name.to_owned(),
            expected: name_list(self.paths.iter().map(CameraPath::name), "camera paths"),
        })
    }
}

impl Mesh {
    /// The box around all control points, those that no face uses included; none when there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(self.control_mesh.positions.iter().copied())
    }
}
