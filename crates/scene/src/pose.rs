//! A scene at one time.
use glam::{Affine3A, DAffine3};

use crate::light::LightPose;
use crate::node::{Placed, place_nodes};
use crate::{Bounds, Camera, Error, MeshPose, Scene};

/// A scene at one time: all that changes from frame to frame, but for the camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// One an instance.
    pub instances: Vec<InstancePose>,
    /// One a mesh; none for those that keep their shape.
    pub meshes: Vec<Option<MeshPose>>,
    /// One a light.
    pub lights: Vec<LightPose>,
}

/// An instance at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstancePose {
    /// Object to world.
    pub transform: Affine3A,
    /// Whether it is seen.
    pub is_visible: bool,
}

impl Scene {
    /// The scene at a time in seconds.
    pub fn pose(&self, time: f64) -> Pose {
        let nodes = place_nodes(&self.nodes, time);
        let instance = |instance: &crate::Instance| match instance.node {
            None => InstancePose { transform: instance.transform, is_visible: true },
            Some(node) => InstancePose {
                transform: in_single(&nodes[node].to_world),
                // A transform without an inverse leaves nothing to see.
                is_visible: nodes[node].is_visible && in_single(&nodes[node].to_world).matrix3.determinant() != 0.0,
            },
        };
        let light = |light: &crate::Light| {
            let placed = &nodes[light.node];
            let intensity = if placed.is_visible { light.intensity.at(time) as f32 } else { 0.0 };
            LightPose { to_world: placed.to_world, radiance: light.color.map(|color| color * intensity) }
        };
        Pose {
            instances: self.instances.iter().map(instance).collect(),
            meshes: (0..self.meshes.len()).map(|mesh| self.mesh_pose(mesh, time, &nodes)).collect(),
            lights: self.lights.iter().map(light).collect(),
        }
    }

    fn mesh_pose(&self, mesh: usize, time: f64, nodes: &[Placed]) -> Option<MeshPose> {
        let deformation = self.meshes[mesh].deformation.as_ref()?;
        // A mesh with a skin has one instance: the skin says where it is.
        let node = self.instances.iter().find(|instance| instance.mesh == mesh).and_then(|instance| instance.node);
        let from_world = node.map_or(DAffine3::IDENTITY, |node| nodes[node].to_world.inverse());
        let from_world = if from_world.is_finite() { from_world } else { DAffine3::IDENTITY };
        Some(deformation.pose(time, nodes, &from_world))
    }

    /// The positions of a mesh's vertices in a pose of the scene.
    pub fn posed_positions(&self, mesh: usize, pose: &Pose) -> Vec<[f32; 3]> {
        let Some(mesh_pose) = pose.meshes.get(mesh).and_then(Option::as_ref) else {
            return self.meshes[mesh].control_mesh.positions.clone();
        };
        let deformation = self.meshes[mesh].deformation.as_ref().expect("a pose of a mesh that deforms");
        deformation.deform(&self.meshes[mesh].control_mesh.positions, mesh_pose)
    }

    /// The box in world space around all visible instances of a pose; none when there are none. See [`Scene::bounds`].
    pub fn posed_bounds(&self, pose: &Pose) -> Option<Bounds> {
        let meshes: Vec<Option<Bounds>> = (0..self.meshes.len())
            .map(|mesh| match pose.meshes.get(mesh) {
                Some(Some(_)) => Bounds::of(self.posed_positions(mesh, pose)),
                _ => self.meshes[mesh].bounds(),
            })
            .collect();
        let placed = self.instances.iter().zip(&pose.instances).filter(|(_, placed)| placed.is_visible);
        let boxes = placed.filter_map(|(instance, placed)| {
            let mesh = meshes.get(instance.mesh).copied().flatten()?;
            Some(crate::Instance { transform: placed.transform, ..instance.clone() }.bounds(&mesh))
        });
        boxes.reduce(Bounds::union)
    }

    /// A camera of the scene at a time in seconds: where its node is then. A camera without a node stays.
    ///
    /// # Errors
    /// When it would see nothing ([`Camera::new`]).
    pub fn camera_at(&self, camera: &Camera, time: f64) -> Result<Camera, Error> {
        let Some(rig) = &camera.rig else { return Ok(camera.clone()) };
        let nodes = place_nodes(&self.nodes, time);
        camera.placed(rig, &nodes[rig.node].to_world, time)
    }

    /// Whether anything moves: a node, a vertex, a light.
    pub fn is_animated(&self) -> bool {
        let moves =
            |mesh: &crate::Mesh| mesh.deformation.as_ref().is_some_and(|deformation| !deformation.is_constant());
        self.nodes.iter().any(|node| !node.is_constant())
            || self.meshes.iter().any(moves)
            || self.lights.iter().any(|light| !light.intensity.is_constant())
            || self.cameras.iter().filter_map(|camera| camera.rig.as_ref()).any(|rig| !rig.is_constant())
    }
}

/// The transform in single precision.
pub(crate) fn in_single(transform: &DAffine3) -> Affine3A {
    Affine3A { matrix3: transform.matrix3.as_mat3().into(), translation: transform.translation.as_vec3().into() }
}
