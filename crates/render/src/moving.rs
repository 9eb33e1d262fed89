//! What moves between frames: objects, cages that deform, and where all of it is at the next moment.

use planish_gpu::Device;
use planish_subdiv::ControlMesh;

use crate::camera::FrameCamera;
use crate::deform::{DeformBuffers, DeformationDesc, PoseDesc};
use crate::error::Error;
use crate::motion::{MotionBuffers, move_object};
use crate::objects::ObjectDesc;
use crate::surface::{Surface, cage_offset};

impl Surface {
    /// Puts the objects in other places, for all frames submitted from now on. They are those that the surface was made with.
    ///
    /// # Panics
    /// If there are not as many, or one has another mesh.
    pub fn set_objects(&mut self, descs: &[ObjectDesc]) -> Result<(), Error> {
        assert_eq!(descs.len(), self.objects.len(), "objects of the surface");
        for ((object, &mesh), desc) in self.objects.iter_mut().zip(&self.object_meshes).zip(descs) {
            assert_eq!(desc.mesh, mesh, "the mesh of an object");
            crate::objects::place(object, desc);
            self.cage_facts[mesh].set(object);
            if object.map != planish_subdiv::topology::NONE {
                crate::objects::displace(object, object.map, self.displacement_bounds[mesh]);
            }
        }
        Ok(self.frame.objects.write(0, &self.objects)?)
    }

    /// Says how cages deform, one entry a mesh; until a pose is set all weights and joints are 0. Frames must be recorded anew then, by
    /// stages that know of it ([`crate::FrameNeeds::deforms`]).
    ///
    /// # Panics
    /// If a morph target or an influence names what is not there.
    pub fn set_deformations(&mut self, device: &Device, descs: &[Option<DeformationDesc<'_>>]) -> Result<(), Error> {
        self.deform = Some(DeformBuffers::new(device, descs, &self.meshes)?);
        for (object, &mesh) in self.objects.iter_mut().zip(&self.object_meshes) {
            crate::objects::deform(object, descs[mesh].is_some());
        }
        Ok(self.frame.objects.write(0, &self.objects)?)
    }

    /// Sets the pose of a mesh that deforms, for all frames submitted from now on.
    ///
    /// # Panics
    /// If the surface has no deformations, or the pose is not one of the mesh's.
    pub fn set_pose(&mut self, mesh: usize, pose: &PoseDesc<'_>) -> Result<(), Error> {
        if let Some(points) = pose.points {
            self.set_cage(mesh, points)?;
        }
        let deform = self.deform.as_ref().expect("a surface that deforms");
        deform.pose.write(&deform.ranges[mesh], pose)
    }

    /// Makes room for the next moment of cages that deform: frames then say where their points go
    /// ([`crate::FrameNeeds::moves`]). Frames must be recorded anew then.
    pub fn prepare_motion(&mut self, device: &Device, meshes: &[&ControlMesh]) -> Result<(), Error> {
        let Some(deform) = &self.deform else { return Ok(()) };
        let motion = MotionBuffers::new(device, &self.tables, deform)?;
        for (cage, ranges) in meshes.iter().zip(&self.meshes).filter(|(cage, _)| !cage.positions.is_empty()) {
            motion.cage.write(cage_offset(ranges), &cage.positions)?;
        }
        self.motion = Some(motion);
        self.write_scene()
    }

    /// Sets where a mesh that deforms is at the next moment.
    ///
    /// # Panics
    /// If there is no room ([`Self::prepare_motion`]), or the pose is not one of the mesh's.
    pub fn set_next_pose(&self, mesh: usize, pose: &PoseDesc<'_>) -> Result<(), Error> {
        let motion = self.motion.as_ref().expect("room for the next moment");
        if let Some(points) = pose.points {
            assert_eq!(points.len(), self.meshes[mesh].cage_points.len(), "positions of cage {mesh}");
            motion.cage.write(cage_offset(&self.meshes[mesh]), points)?;
        }
        let deform = self.deform.as_ref().expect("a surface that deforms");
        motion.pose.write(&deform.ranges[mesh], pose)
    }

    /// Sets where objects and camera are at the next moment; they stay until then, and after [`Self::set_objects`].
    pub fn set_motion(&mut self, now: &[ObjectDesc], next: &[ObjectDesc], camera: &FrameCamera) -> Result<(), Error> {
        for ((object, now), next) in self.objects.iter_mut().zip(now).zip(next) {
            let deforms = crate::objects::deforms(object) && self.motion.is_some();
            move_object(object, &now.to_world, &next.to_world, deforms);
        }
        self.next_camera = Some(*camera);
        Ok(self.frame.objects.write(0, &self.objects)?)
    }
}
