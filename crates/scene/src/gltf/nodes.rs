//! Nodes of the file to nodes of the scene.
use ::gltf::json::scene;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::animation::{Channels, Clip};
use super::data::Data;
use super::fault::Fault;
use super::hierarchy::Hierarchy;
use crate::Node;
use crate::curve::Curve;
use crate::node::TransformStep;

/// The scene's nodes, in the order of the hierarchy.
pub fn nodes(data: &Data, hierarchy: &Hierarchy, clip: &Clip) -> Result<Vec<Node>, Fault> {
    let still = Channels::default();
    let node = |(&file_node, &parent): (&usize, &Option<usize>)| {
        let node = &data.root.nodes[file_node];
        let channels = clip.channels.get(&file_node).unwrap_or(&still);
        let steps = steps(node, channels, &format!("nodes[{file_node}]"))?;
        Ok(Node { steps, ..Node::still(&name(data, file_node), parent) })
    };
    hierarchy.file_nodes.iter().zip(&hierarchy.parents).map(node).collect()
}

/// A node's name, or its number.
pub fn name(data: &Data, file_node: usize) -> String {
    own_name(&data.root.nodes[file_node]).unwrap_or_else(|| format!("node {file_node}"))
}

/// A node's name, if it has one.
pub fn own_name(node: &scene::Node) -> Option<String> {
    node.name.clone().filter(|name| !name.is_empty())
}

/// Translation, rotation and scale, as far as they do anything; or a matrix.
fn steps(node: &scene::Node, channels: &Channels, place: &str) -> Result<Vec<TransformStep>, Fault> {
    let is_moved = channels.translation.is_some() || channels.rotation.is_some() || channels.scale.is_some();
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(matrix) = &node.matrix {
        if is_moved || has_parts {
            return Err(Fault::new(place, "a matrix beside translation, rotation or scale", "one or the other"));
        }
        let matrix = affine(matrix, &format!("{place}.matrix"))?;
        return Ok(if matrix == DAffine3::IDENTITY {
            Vec::new()
        } else {
            vec![TransformStep::Matrix(Curve::constant(matrix))]
        });
    }
    let vector = |value: Option<[f32; 3]>, default: DVec3| value.map_or(default, |value| value.map(f64::from).into());
    let translation = vector(node.translation, DVec3::ZERO);
    let scale = vector(node.scale, DVec3::ONE);
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| DQuat::from_array(rotation.0.map(f64::from)));
    if !(translation.is_finite() && scale.is_finite() && rotation.is_finite()) {
        return Err(Fault::new(place, "a transform that is not finite", "finite numbers"));
    }
    let mut steps = Vec::new();
    match &channels.translation {
        Some(curve) => steps.push(TransformStep::Translate(curve.clone())),
        None if translation != DVec3::ZERO => steps.push(TransformStep::Translate(Curve::constant(translation))),
        None => {}
    }
    match &channels.rotation {
        Some(curve) => steps.push(TransformStep::Rotate(curve.clone())),
        None if rotation != DQuat::IDENTITY => steps.push(TransformStep::Rotate(Curve::constant(rotation))),
        None => {}
    }
    match &channels.scale {
        Some(curve) => steps.push(TransformStep::Scale(curve.clone())),
        None if scale != DVec3::ONE => steps.push(TransformStep::Scale(Curve::constant(scale))),
        None => {}
    }
    Ok(steps)
}

/// A matrix of the file: columns, the last row 0 0 0 1.
pub fn affine(columns: &[f32; 16], place: &str) -> Result<DAffine3, Fault> {
    let column = |at: usize| DVec3::new(columns[at].into(), columns[at + 1].into(), columns[at + 2].into());
    let last_row = [columns[3], columns[7], columns[11], columns[15]];
    if !columns.iter().all(|value| value.is_finite()) {
        return Err(Fault::new(place, "a matrix that is not finite", "finite numbers"));
    }
    if last_row != [0.0, 0.0, 0.0, 1.0] {
        return Err(Fault::new(place, format!("the last row {last_row:?}"), "0 0 0 1"));
    }
    Ok(DAffine3 { matrix3: DMat3::from_cols(column(0), column(4), column(8)), translation: column(12) })
}
