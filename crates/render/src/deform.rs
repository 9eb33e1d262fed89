//! Cages that deform: morph targets and linear blend skinning on the GPU. Tables are made once; a frame uploads weights, the
//! joints' maps and, where points are given over time, points. Shader: `glsl/deform.comp`; its CPU twin is
//! `planish_scene::Deformation::deform`.

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder};
use planish_shaders as shaders;
use planish_shaders::deform_comp::{PROGRAM, Push};
use planish_shaders::{DeformedVertex, JointInfluence, MorphOffset};
use planish_subdiv::tables::MeshRanges;

use crate::error::Error;
use crate::program::compute_pipeline;
use crate::upload::{address, mapped, table};

/// How the vertices of a mesh's cage deform. Without morph targets and influences points may still be given over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeformationDesc<'a> {
    /// The morph targets: vertices, each once, and the offset of each.
    pub morphs: Vec<(&'a [u32], &'a [[f32; 3]])>,
    /// Vertex v has the influences `first_influence[v] .. first_influence[v + 1]`; empty: no vertex has any.
    pub first_influence: &'a [u32],
    /// Joint and weight.
    pub influences: Vec<(u32, f32)>,
    /// Number of joints.
    pub joint_count: u32,
}

/// What deforms a cage at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseDesc<'a> {
    /// Positions instead of those that the cage has now.
    pub points: Option<&'a [[f32; 3]]>,
    /// One a morph target.
    pub weights: &'a [f32],
    /// One a joint: columns of a 3 x 4 matrix, from the cage to where the joint moves it in the mesh's own space.
    pub joints: &'a [[[f32; 3]; 4]],
}

/// What moves vertices at one moment.
pub(crate) struct PoseBuffers {
    pub weights: Buffer,
    pub joints: Buffer,
}

impl PoseBuffers {
    fn new(device: &Device, ranges: &[PoseRange]) -> Result<Self, Error> {
        let end = ranges.last().copied().unwrap_or_default();
        Ok(Self {
            weights: mapped::<f32>(device, "morph weights", end.first_weight + end.weight_count)?,
            joints: mapped::<[[f32; 3]; 4]>(device, "joints", end.first_joint + end.joint_count)?,
        })
    }

    /// Uploads a mesh's.
    ///
    /// # Panics
    /// If there is not one weight a morph target, and one map a joint.
    pub fn write(&self, range: &PoseRange, pose: &PoseDesc<'_>) -> Result<(), Error> {
        assert_eq!(pose.weights.len(), range.weight_count as usize, "weights of morph targets");
        assert_eq!(pose.joints.len(), range.joint_count as usize, "maps of joints");
        if !pose.weights.is_empty() {
            self.weights.write(u64::from(range.first_weight) * size_of::<f32>() as u64, pose.weights)?;
        }
        if !pose.joints.is_empty() {
            self.joints.write(u64::from(range.first_joint) * size_of::<[[f32; 3]; 4]>() as u64, pose.joints)?;
        }
        Ok(())
    }
}

/// Where a mesh's weights and joints lie among all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PoseRange {
    first_weight: u32,
    weight_count: u32,
    first_joint: u32,
    joint_count: u32,
}

/// The tables, as the kernel reads them.
#[derive(Debug, Default, PartialEq)]
struct DeformTables {
    vertices: Vec<DeformedVertex>,
    offsets: Vec<MorphOffset>,
    influences: Vec<JointInfluence>,
    ranges: Vec<PoseRange>,
}

impl DeformTables {
    fn new(descs: &[Option<DeformationDesc<'_>>], meshes: &[MeshRanges]) -> Self {
        let mut tables = Self::default();
        let mut range = PoseRange::default();
        for (desc, mesh) in descs.iter().zip(meshes) {
            range.first_weight += range.weight_count;
            range.first_joint += range.joint_count;
            (range.weight_count, range.joint_count) = (0, 0);
            if let Some(desc) = desc {
                (range.weight_count, range.joint_count) = (desc.morphs.len() as u32, desc.joint_count);
                tables.add(desc, mesh, &range);
            }
            tables.ranges.push(range);
        }
        tables
    }

    /// Adds the vertices of a mesh that anything but points over time moves.
    fn add(&mut self, desc: &DeformationDesc<'_>, mesh: &MeshRanges, range: &PoseRange) {
        let mut offsets: Vec<Vec<MorphOffset>> = vec![Vec::new(); mesh.cage_points.len()];
        for (weight, (vertices, moved)) in (range.first_weight..).zip(&desc.morphs) {
            for (&vertex, &offset) in vertices.iter().zip(*moved) {
                offsets[vertex as usize].push(MorphOffset { weight, offset });
            }
        }
        for (vertex, offsets) in offsets.into_iter().enumerate() {
            let of_vertex = match desc.first_influence {
                [] => &[][..],
                first => &desc.influences[first[vertex] as usize..first[vertex + 1] as usize],
            };
            if offsets.is_empty() && of_vertex.is_empty() {
                continue;
            }
            self.vertices.push(DeformedVertex {
                point: mesh.cage_points.start + vertex as u32,
                first_offset: self.offsets.len() as u32,
                offset_count: offsets.len() as u32,
                first_influence: self.influences.len() as u32,
                influence_count: of_vertex.len() as u32,
            });
            self.offsets.extend(offsets);
            let influence = |&(joint, weight)| JointInfluence { joint: range.first_joint + joint, weight };
            self.influences.extend(of_vertex.iter().map(influence));
        }
    }
}

/// How the meshes of a surface deform, and their pose.
pub(crate) struct DeformBuffers {
    vertices: Buffer,
    offsets: Buffer,
    influences: Buffer,
    pub pose: PoseBuffers,
    pub ranges: Vec<PoseRange>,
    vertex_count: u32,
}

impl DeformBuffers {
    pub fn new(device: &Device, descs: &[Option<DeformationDesc<'_>>], meshes: &[MeshRanges]) -> Result<Self, Error> {
        let tables = DeformTables::new(descs, meshes);
        Ok(Self {
            vertices: table(device, "deformed vertices", &tables.vertices)?,
            offsets: table(device, "morph offsets", &tables.offsets)?,
            influences: table(device, "joint influences", &tables.influences)?,
            pose: PoseBuffers::new(device, &tables.ranges)?,
            vertex_count: tables.vertices.len() as u32,
            ranges: tables.ranges,
        })
    }

    /// Room for another moment's pose.
    pub fn another_pose(&self, device: &Device) -> Result<PoseBuffers, Error> {
        PoseBuffers::new(device, &self.ranges)
    }

    pub fn all(&self) -> [&Buffer; 5] {
        [&self.vertices, &self.offsets, &self.influences, &self.pose.weights, &self.pose.joints]
    }
}

/// The stage's program.
pub(crate) struct Deform(ComputePipeline);

impl Deform {
    pub fn new(device: &Device) -> Result<Self, Error> {
        compute_pipeline(device, &PROGRAM).map(Self)
    }

    /// Records one dispatch over all vertices that deform, of cages that were copied to `points`.
    pub fn record(&self, encoder: &mut Encoder, buffers: &DeformBuffers, pose: &PoseBuffers, points: &Buffer) {
        if buffers.vertex_count == 0 {
            return;
        }
        let push = Push {
            points: address(points),
            vertices: address(&buffers.vertices),
            offsets: address(&buffers.offsets),
            influences: address(&buffers.influences),
            morph_weights: address::<shaders::Weights>(&pose.weights),
            joints: address(&pose.joints),
            vertex_count: buffers.vertex_count,
            ..Push::default()
        };
        encoder.compute(&self.0, &push, buffers.vertex_count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(first: u32, count: u32) -> MeshRanges {
        MeshRanges { cage_points: first..first + count, ..MeshRanges::default() }
    }

    #[test]
    fn tables_hold_the_vertices_that_move_with_numbers_through_all_meshes() {
        let morph: (&[u32], &[[f32; 3]]) = (&[2], &[[1.0, 2.0, 3.0]]);
        let first = DeformationDesc { morphs: vec![morph, (&[], &[])], ..DeformationDesc::default() };
        let second = DeformationDesc {
            morphs: vec![morph],
            first_influence: &[0, 0, 1, 2],
            influences: vec![(0, 1.0), (1, 0.5)],
            joint_count: 2,
        };
        let meshes = [mesh(0, 3), mesh(3, 8), mesh(11, 3)];
        let tables = DeformTables::new(&[Some(first), None, Some(second)], &meshes);
        let points: Vec<u32> = tables.vertices.iter().map(|vertex| vertex.point).collect();
        assert_eq!(points, [2, 12, 13]);
        assert_eq!(tables.offsets.iter().map(|offset| offset.weight).collect::<Vec<_>>(), [0, 2]);
        assert_eq!(tables.influences.iter().map(|influence| influence.joint).collect::<Vec<_>>(), [0, 1]);
        let last = tables.vertices[2];
        assert_eq!((last.first_offset, last.offset_count, last.first_influence, last.influence_count), (1, 1, 1, 1));
        assert_eq!(tables.ranges[1], PoseRange { first_weight: 2, weight_count: 0, first_joint: 0, joint_count: 0 });
    }
}
