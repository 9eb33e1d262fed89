//! A scene at one moment, on its way to the device.

use std::borrow::Cow;
use std::time::Instant;

use anyhow::{Context, Result};
use glam::Affine3A;
use planish_gpu::Device;
use planish_render::{DeformationDesc, FrameCamera, ObjectDesc, PoseDesc, Surface};
use planish_scene::{Camera, Deformation, MeshPose, Pose};
use planish_subdiv::ControlMesh;

use crate::args::ViewArguments;
use crate::cage::{Cage, milliseconds};
use crate::offline::frame_camera;
use crate::values::FrameRate;

/// A scene and its camera at one moment.
pub struct Moment {
    /// The camera.
    pub camera: Camera,
    /// What else changes.
    pub pose: Pose,
    /// The instances.
    pub objects: Vec<ObjectDesc>,
    /// How long the CPU took to find out, in milliseconds.
    pub milliseconds: f64,
}

impl Moment {
    /// The scene so many frames after frame 0; they need not be whole.
    pub fn new(cage: &Cage, view: &ViewArguments, rate: FrameRate, frames: f64) -> Result<Self> {
        let start = Instant::now();
        let named = || format!("{}: frame {frames}", cage.path().display());
        let pose = cage.scene().pose(rate.seconds(frames));
        let camera = cage.camera(view, rate, frames).with_context(named)?;
        let objects = cage.objects(&camera, &pose);
        Ok(Self { camera, pose, objects, milliseconds: milliseconds(start) })
    }

    /// The scene at a time in seconds, seen by this camera.
    pub fn seen_by(cage: &Cage, camera: &Camera, time: f64) -> Self {
        let pose = cage.scene().pose(time);
        let objects = cage.objects(camera, &pose);
        Self { camera: camera.clone(), pose, objects, milliseconds: 0.0 }
    }

    /// The control meshes, those that deform as they are now.
    pub fn meshes<'a>(&self, cage: &'a Cage) -> Vec<Cow<'a, ControlMesh>> {
        let posed = |(mesh, rest): (usize, &'a planish_scene::Mesh)| match self.pose.meshes[mesh] {
            None => Cow::Borrowed(&rest.control_mesh),
            Some(_) => {
                let positions = cage.scene().posed_positions(mesh, &self.pose);
                Cow::Owned(ControlMesh { positions, ..rest.control_mesh.clone() })
            }
        };
        cage.scene().meshes.iter().enumerate().map(posed).collect()
    }

    /// Makes it what frames from now on show; `next`, where its motion leads to.
    pub fn apply(&self, surface: &mut Surface, next: Option<(&Self, &FrameCamera)>) -> Result<()> {
        surface.set_objects(&self.objects)?;
        for (mesh, pose) in self.pose.meshes.iter().enumerate() {
            if let Some(pose) = pose {
                with_desc(pose, |pose| surface.set_pose(mesh, pose))?;
            }
        }
        let Some((next, camera)) = next else { return Ok(()) };
        for (mesh, pose) in next.pose.meshes.iter().enumerate() {
            if let Some(pose) = pose {
                with_desc(pose, |pose| surface.set_next_pose(mesh, pose))?;
            }
        }
        Ok(surface.set_motion(&self.objects, &next.objects, camera)?)
    }

    /// The camera, for an image of this size.
    pub fn frame_camera(&self, size: [u32; 2]) -> FrameCamera {
        frame_camera(&self.camera, size)
    }
}

fn with_desc<R>(pose: &MeshPose, f: impl FnOnce(&PoseDesc<'_>) -> R) -> R {
    let columns = |map: &Affine3A| {
        [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis, map.translation].map(|axis| axis.to_array())
    };
    let joints: Vec<[[f32; 3]; 4]> = pose.joints.iter().map(columns).collect();
    f(&PoseDesc { points: pose.points.as_deref(), weights: &pose.weights, joints: &joints })
}

/// Gives a surface the tables of the cages that deform; `moves`: it is asked where their points go.
pub fn deform_surface(device: &Device, surface: &mut Surface, cage: &Cage, moves: bool) -> Result<()> {
    if !cage.deforms() {
        return Ok(());
    }
    let descs: Vec<_> = cage.scene().meshes.iter().map(|mesh| mesh.deformation.as_ref().map(desc)).collect();
    surface.set_deformations(device, &descs)?;
    if moves {
        surface.prepare_motion(device, &cage.meshes())?;
    }
    Ok(())
}

fn desc(deformation: &Deformation) -> DeformationDesc<'_> {
    let morphs = deformation.morphs.iter().map(|morph| (morph.vertices.as_slice(), morph.offsets.as_slice())).collect();
    match &deformation.skin {
        None => DeformationDesc { morphs, ..DeformationDesc::default() },
        Some(skin) => DeformationDesc {
            morphs,
            first_influence: &skin.first,
            influences: skin.influences.iter().map(|influence| (influence.joint, influence.weight)).collect(),
            joint_count: skin.joints.len() as u32,
        },
    }
}
