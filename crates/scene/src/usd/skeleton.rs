//! Skeletons (UsdSkel): every joint becomes a node below its skeleton's.
use std::collections::HashMap;

use glam::{DAffine3, DQuat, DVec3};
use openusd::sdf::Value;
use openusd::usd;

use super::attributes::Attributes;
use super::convert;
use super::guard::Stage;
use super::walk::Tree;
use crate::curve::{Curve, Interpolation};
use crate::gltf::fault::Fault;
use crate::node::{Node, TransformStep};

/// A skeleton whose joints are nodes.
pub struct Skeleton {
    /// The skeleton's own node.
    pub node: usize,
    /// Names of the joints, in the order of influences.
    pub joints: Vec<String>,
    /// The node of each.
    pub nodes: Vec<usize>,
    /// Where each was when the skin was bound, to the skeleton.
    pub binds: Vec<DAffine3>,
    /// Weights of blend shapes over time, by their names.
    pub shapes: Vec<String>,
    pub weights: Option<Curve<Vec<f64>>>,
}

/// Adds the joints of all skeletons; returns skeletons by their paths.
pub fn expand(stage: &Stage, tree: &mut Tree, rate: f64) -> Result<HashMap<String, Skeleton>, Fault> {
    let places: Vec<usize> = (0..tree.items.len()).filter(|&item| tree.items[item].kind == "Skeleton").collect();
    let mut skeletons = HashMap::new();
    for place in places {
        let prim = tree.items[place].prim.clone();
        let path = prim.path().as_str().to_owned();
        let animation = animation(stage, tree, place)?;
        skeletons.insert(path, read(tree, place, &Attributes::new(&prim, rate), animation.as_ref(), rate)?);
    }
    Ok(skeletons)
}

/// What animates a skeleton: the source that it names, or its nearest parent.
fn animation(stage: &Stage, tree: &Tree, place: usize) -> Result<Option<usd::Prim>, Fault> {
    for item in std::iter::successors(Some(place), |&item| tree.items[item].parent) {
        let targets = Attributes::new(&tree.items[item].prim, 1.0).targets("skel:animationSource")?;
        if let Some(target) = targets.first() {
            return stage.prim(target.as_str()).map(Some);
        }
    }
    Ok(None)
}

fn read(
    tree: &mut Tree,
    place: usize,
    attributes: &Attributes,
    animation: Option<&usd::Prim>,
    rate: f64,
) -> Result<Skeleton, Fault> {
    let joints = attributes.get("joints", "token[]", convert::tokens)?.unwrap_or_default();
    let matrices = |name: &str| -> Result<Vec<DAffine3>, Fault> {
        let list = attributes.get(name, "affine matrix4d[]", convert::affines)?.unwrap_or_default();
        if list.len() == joints.len() {
            return Ok(list);
        }
        Err(attributes.fault(
            name,
            format!("{} matrices", list.len()),
            format!("one for each of {} joints", joints.len()),
        ))
    };
    let binds = matrices("bindTransforms")?;
    let rests = if attributes.get("restTransforms", "matrix4d[]", convert::affines)?.is_some() {
        matrices("restTransforms")?
    } else {
        vec![DAffine3::IDENTITY; joints.len()]
    };
    let moves = animation.map(|prim| Animation::read(&Attributes::new(prim, rate))).transpose()?;
    let skeleton_node = tree.items[place].node;
    let mut node_of: HashMap<&str, usize> = HashMap::new();
    let mut nodes = Vec::new();
    for (joint, name) in joints.iter().enumerate() {
        let above = name.rsplit_once('/').map(|(above, _)| above);
        let parent = above.and_then(|above| node_of.get(above).copied()).unwrap_or(skeleton_node);
        let moved = moves.as_ref().and_then(|moves| moves.steps(name));
        let steps = moved.unwrap_or_else(|| vec![TransformStep::Matrix(Curve::constant(rests[joint]))]);
        let node = Node { steps, ..Node::still(&format!("{}/{name}", attributes.path()), Some(parent)) };
        node_of.insert(name, tree.nodes.len());
        nodes.push(tree.nodes.len());
        tree.nodes.push(node);
    }
    let (shapes, weights) = moves.map_or((Vec::new(), None), |moves| (moves.shapes, moves.weights));
    Ok(Skeleton { node: skeleton_node, joints: joints.clone(), nodes, binds, shapes, weights })
}

/// What a UsdSkelAnimation says of joints and shapes.
struct Animation {
    joints: Vec<String>,
    translations: Keys<DVec3>,
    rotations: Keys<DQuat>,
    scales: Keys<DVec3>,
    shapes: Vec<String>,
    weights: Option<Curve<Vec<f64>>>,
}

/// One value a joint at every time in seconds.
type Keys<T> = Vec<(f64, Vec<T>)>;

impl Animation {
    fn read(attributes: &Attributes) -> Result<Self, Fault> {
        let tokens = |name| attributes.get(name, "token[]", convert::tokens).map(Option::unwrap_or_default);
        let joints = tokens("joints")?;
        let weights = ("finite numbers", Interpolation::Linear);
        let read = Self {
            translations: keys(attributes, "translations", joints.len(), vectors)?,
            rotations: keys(attributes, "rotations", joints.len(), rotations)?,
            scales: keys(attributes, "scales", joints.len(), vectors)?,
            shapes: tokens("blendShapes")?,
            weights: attributes.curve("blendShapeWeights", weights, finite)?,
            joints,
        };
        Ok(read)
    }

    /// The steps of a joint; none of one that is not animated.
    fn steps(&self, joint: &str) -> Option<Vec<TransformStep>> {
        let place = self.joints.iter().position(|name| name == joint)?;
        if self.translations.is_empty() || self.rotations.is_empty() || self.scales.is_empty() {
            return None;
        }
        Some(vec![
            TransformStep::Translate(curve(&self.translations, place)?),
            TransformStep::Rotate(curve(&self.rotations, place)?),
            TransformStep::Scale(curve(&self.scales, place)?),
        ])
    }
}

fn keys<T>(
    attributes: &Attributes,
    name: &str,
    count: usize,
    convert: fn(Value) -> Option<Vec<T>>,
) -> Result<Keys<T>, Fault> {
    let keys = attributes.keys(name, "finite numbers", convert)?;
    match keys.iter().find(|(_, values)| values.len() != count) {
        None => Ok(keys),
        Some((_, values)) => {
            Err(attributes.fault(name, format!("{} values", values.len()), format!("one for each of {count} joints")))
        }
    }
}

fn curve<T: crate::curve::Animated>(keys: &Keys<T>, joint: usize) -> Option<Curve<T>> {
    if let [(_, only)] = keys.as_slice() {
        return Some(Curve::constant(only[joint].clone()));
    }
    let (times, values) = keys.iter().map(|(time, values)| (*time, values[joint].clone())).unzip();
    Curve::keyed(times, values, Interpolation::Linear).ok()
}

fn vectors(value: Value) -> Option<Vec<DVec3>> {
    let list: Vec<DVec3> = convert::vec3s(value)?.into_iter().map(|v| DVec3::from(v.map(f64::from))).collect();
    list.iter().all(|v| v.is_finite()).then_some(list)
}

fn rotations(value: Value) -> Option<Vec<DQuat>> {
    convert::quats(value).filter(|list| list.iter().all(|q| q.is_finite()))
}

fn finite(value: Value) -> Option<Vec<f64>> {
    convert::numbers(value).filter(|list| list.iter().all(|v| v.is_finite()))
}
