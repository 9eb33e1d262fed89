//! What moves a cage's vertices: morph targets and skins (glTF 2.0, section 3.7).
use ::gltf::json::{mesh, scene};

use super::animation::Channels;
use super::cage::Cage;
use super::data::Data;
use super::fault::{Fault, at};
use super::hierarchy::Hierarchy;
use super::nodes::affine;
use super::{tags, weld};
use crate::curve::Curve;
use crate::deformation::{Influence, Joint, MorphTarget, Skin};
use glam::DAffine3;

/// The morph targets of a cage: the offsets that are not zero.
pub fn morphs(cage: &Cage, mesh: &mesh::Mesh) -> Vec<MorphTarget> {
    let names = tags::target_names(&mesh.extras);
    let count = cage.primitives.first().map_or(0, |primitive| primitive.targets.len());
    let morph = |target: usize| {
        let name = names.get(target).filter(|name| !name.is_empty()).cloned();
        let mut morph =
            MorphTarget { name: name.unwrap_or_else(|| format!("target {target}")), ..MorphTarget::default() };
        for (vertex, primitive, own_vertex) in file_vertices(cage) {
            let offset = cage.primitives[primitive].targets[target].get(own_vertex).copied().unwrap_or_default();
            if offset != [0.0; 3] {
                morph.vertices.push(vertex);
                morph.offsets.push(offset);
            }
        }
        morph
    };
    (0..count).map(morph).collect()
}

/// The weights of morph targets over time: those of the animation, else of the node, else of the mesh, else none.
pub fn weights(
    mesh: &mesh::Mesh,
    node: &scene::Node,
    channels: Option<&Channels>,
    target_count: usize,
    place: &str,
) -> Result<Option<Curve<Vec<f64>>>, Fault> {
    if let Some(keys) = channels.and_then(|channels| channels.weights.as_ref()) {
        return keys.curve(target_count).map(Some);
    }
    let Some(weights) = node.weights.as_ref().or(mesh.weights.as_ref()) else { return Ok(None) };
    if weights.len() != target_count {
        let found = format!("{} weights", weights.len());
        return Err(Fault::new(
            format!("{place}.weights"),
            found,
            format!("one for each of {target_count} morph targets"),
        ));
    }
    Ok(Some(Curve::constant(weights.iter().copied().map(f64::from).collect())))
}

/// A cage's skin. `place` names the skin.
pub fn skin(
    data: &Data,
    cage: &Cage,
    skin: &::gltf::json::Skin,
    hierarchy: &Hierarchy,
    place: &str,
) -> Result<Skin, Fault> {
    let joints = joints(data, skin, hierarchy, place)?;
    let mut first = Vec::with_capacity(cage.welded.first_of.len() + 1);
    let mut influences = Vec::new();
    first.push(0);
    for (vertex, primitive, own_vertex) in file_vertices(cage) {
        let given = weld::influences(&cage.primitives[primitive], own_vertex);
        let sum: f64 = given.iter().map(|&(_, weight)| f64::from(weight)).sum();
        if sum <= 0.0 {
            let found = format!("vertex {vertex} of the cage without a weight");
            return Err(Fault::new(place, found, "weights with a sum above 0"));
        }
        for (joint, weight) in given {
            if joint as usize >= joints.len() {
                return Err(Fault::index(place, "joints", joint as usize, joints.len()));
            }
            influences.push(Influence { joint, weight: (f64::from(weight) / sum) as f32 });
        }
        first.push(influences.len() as u32);
    }
    Ok(Skin { joints, first, influences })
}

fn joints(data: &Data, skin: &::gltf::json::Skin, hierarchy: &Hierarchy, place: &str) -> Result<Vec<Joint>, Fault> {
    let inverse_binds = match skin.inverse_bind_matrices {
        None => vec![DAffine3::IDENTITY; skin.joints.len()],
        Some(accessor) => {
            let matrices = data.floats::<16>(accessor, place)?;
            matrices
                .iter()
                .map(|matrix| affine(matrix, &format!("{place}.inverseBindMatrices")))
                .collect::<Result<_, _>>()?
        }
    };
    if inverse_binds.len() < skin.joints.len() {
        let found = format!("{} inverse bind matrices", inverse_binds.len());
        return Err(Fault::new(place, found, format!("one for each of {} joints", skin.joints.len())));
    }
    let joint = |(node, inverse_bind): (&::gltf::json::Index<scene::Node>, DAffine3)| {
        let node = *at(&hierarchy.place_of, node.value(), "nodes", || place.to_owned())?;
        Ok(Joint { node, inverse_bind })
    };
    skin.joints.iter().zip(inverse_binds).map(joint).collect()
}

/// Every vertex of the cage, with the primitive that it is from and its number there.
fn file_vertices(cage: &Cage) -> impl Iterator<Item = (u32, usize, usize)> {
    let (mut primitive, mut start) = (0, 0);
    cage.welded.first_of.iter().zip(0..).map(move |(&file_vertex, vertex)| {
        // They ascend.
        while file_vertex as usize - start >= cage.primitives[primitive].positions.len() {
            start += cage.primitives[primitive].positions.len();
            primitive += 1;
        }
        (vertex, primitive, file_vertex as usize - start)
    })
}
