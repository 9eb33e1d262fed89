//! How the vertices of a cage move: points over time, morph targets and skins. The GPU does the same
//! (`glsl/deform.comp`); [`Deformation::deform`] is its CPU twin.
use glam::{Affine3A, DAffine3, Vec3A};

use crate::curve::Curve;
use crate::node::Placed;

/// How a cage's vertices move, in this order: points, morph targets, skin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformation {
    /// Positions over time instead of the cage's own, one a vertex at every key.
    pub points: Option<Curve<Vec<[f32; 3]>>>,
    /// Offsets that are added, each times its weight.
    pub morphs: Vec<MorphTarget>,
    /// The weights of the morph targets; those without one have 0. None: all 0.
    pub weights: Option<Curve<Vec<f64>>>,
    /// What the vertices hang on.
    pub skin: Option<Skin>,
}

/// Offsets of some vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// The name in the file.
    pub name: String,
    /// The vertices, ascending, each once.
    pub vertices: Vec<u32>,
    /// By how much each is moved, parallel to `vertices`.
    pub offsets: Vec<[f32; 3]>,
}

/// Linear blend skinning: a vertex is moved by the weighted mean of its joints' maps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// The joints.
    pub joints: Vec<Joint>,
    /// Vertex v has the influences `first[v] .. first[v + 1]`; one more entry than vertices. A vertex without any stays.
    pub first: Vec<u32>,
    /// The influences, vertex by vertex; the weights of a vertex sum to 1.
    pub influences: Vec<Influence>,
}

/// A joint of a skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Into [`crate::Scene::nodes`].
    pub node: usize,
    /// Cage space to joint space when the skin was bound (glTF: inverse bind matrix; USD: inverse of the bind transform,
    /// times the geometry's bind transform).
    pub inverse_bind: DAffine3,
}

/// A joint's share in a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Influence {
    /// Into [`Skin::joints`].
    pub joint: u32,
    /// The share.
    pub weight: f32,
}

/// What moves a cage's vertices at one time: all that a frame uploads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPose {
    /// Positions instead of the cage's own.
    pub points: Option<Vec<[f32; 3]>>,
    /// One a morph target.
    pub weights: Vec<f32>,
    /// One a joint: from the cage to where the joint has moved it, in the space of the mesh's instances.
    pub joints: Vec<Affine3A>,
}

impl Deformation {
    /// What moves the vertices at a time in seconds. `nodes`: all nodes of the scene at this time; `from_world`: world to the
    /// space of the mesh's instance.
    pub fn pose(&self, time: f64, nodes: &[Placed], from_world: &DAffine3) -> MeshPose {
        let given = self.weights.as_ref().map(|weights| weights.at(time)).unwrap_or_default();
        let weights = (0..self.morphs.len()).map(|morph| given.get(morph).copied().unwrap_or_default() as f32);
        let joint = |joint: &Joint| {
            let map = *from_world * nodes[joint.node].to_world * joint.inverse_bind;
            Affine3A { matrix3: map.matrix3.as_mat3().into(), translation: map.translation.as_vec3().into() }
        };
        MeshPose {
            points: self.points.as_ref().map(|points| points.at(time)),
            weights: weights.collect(),
            joints: self.skin.iter().flat_map(|skin| &skin.joints).map(joint).collect(),
        }
    }

    /// Whether the vertices are where they are at all times; joints may move all the same.
    pub fn is_constant(&self) -> bool {
        self.points.as_ref().is_none_or(Curve::is_constant) && self.weights.as_ref().is_none_or(Curve::is_constant)
    }

    /// The positions of a cage whose own are `rest`, as `glsl/deform.comp` makes them: sums in the order of targets and
    /// influences, in 32 bits.
    pub fn deform(&self, rest: &[[f32; 3]], pose: &MeshPose) -> Vec<[f32; 3]> {
        let mut positions = pose.points.as_deref().unwrap_or(rest).to_vec();
        for (morph, &weight) in self.morphs.iter().zip(&pose.weights) {
            for (&vertex, offset) in morph.vertices.iter().zip(&morph.offsets) {
                let position = &mut positions[vertex as usize];
                *position = std::array::from_fn(|c| position[c] + weight * offset[c]);
            }
        }
        if let Some(skin) = &self.skin {
            for (vertex, position) in positions.iter_mut().enumerate() {
                *position = skin.moved(vertex, *position, &pose.joints);
            }
        }
        positions
    }
}

impl Skin {
    /// The influences on a vertex.
    pub fn influences_of(&self, vertex: usize) -> &[Influence] {
        &self.influences[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }

    fn moved(&self, vertex: usize, position: [f32; 3], joints: &[Affine3A]) -> [f32; 3] {
        let influences = self.influences_of(vertex);
        if influences.is_empty() {
            return position;
        }
        let p = Vec3A::from(position);
        let mut sum = Vec3A::ZERO;
        for influence in influences {
            let map = &joints[influence.joint as usize];
            let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
            let moved = ((x * p.x + y * p.y) + z * p.z) + map.translation;
            sum += moved * influence.weight;
        }
        sum.to_array()
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::curve::Interpolation;

    #[test]
    fn morphs_add_their_offsets_times_their_weights() {
        let morph = |vertex, offset| MorphTarget { name: String::new(), vertices: vec![vertex], offsets: vec![offset] };
        let weights = Curve::keyed(vec![0.0, 1.0], vec![vec![0.0, 0.0], vec![1.0, 4.0]], Interpolation::Linear);
        let deformation = Deformation {
            morphs: vec![morph(0, [1.0, 0.0, 0.0]), morph(1, [0.0, 2.0, 0.0])],
            weights: Some(weights.unwrap()),
            ..Deformation::default()
        };
        let pose = deformation.pose(0.5, &[], &DAffine3::IDENTITY);
        assert_eq!(pose.weights, [0.5, 2.0]);
        assert_eq!(deformation.deform(&[[0.0; 3], [1.0; 3]], &pose), [[0.5, 0.0, 0.0], [1.0, 5.0, 1.0]]);
    }

    #[test]
    fn a_vertex_between_two_joints_goes_half_way_and_one_without_stays() {
        let joints = [0, 1].map(|node| Joint { node, inverse_bind: DAffine3::IDENTITY }).to_vec();
        let influences = [0, 1].map(|joint| Influence { joint, weight: 0.5 }).to_vec();
        let skin = Skin { joints, first: vec![0, 2, 2], influences };
        let deformation = Deformation { skin: Some(skin), ..Deformation::default() };
        let placed = |to_world| Placed { to_world, is_visible: true };
        let nodes = [placed(DAffine3::IDENTITY), placed(DAffine3::from_translation(DVec3::new(0.0, 4.0, 0.0)))];
        let pose = deformation.pose(0.0, &nodes, &DAffine3::IDENTITY);
        assert_eq!(deformation.deform(&[[1.0; 3], [1.0; 3]], &pose), [[1.0, 3.0, 1.0], [1.0; 3]]);
        // Seen from an instance that is moved along, the joint does not move.
        let pose = deformation.pose(0.0, &nodes, &DAffine3::from_translation(DVec3::new(0.0, -4.0, 0.0)));
        assert_eq!(pose.joints[1].translation, Vec3::ZERO.into());
    }
}
