//! What moves a mesh's vertices: influences of joints, and blend shapes (UsdSkelBindingAPI).
use std::collections::{BTreeMap, HashMap};

use glam::DAffine3;

use super::attributes::Attributes;
use super::convert;
use super::faces::below;
use super::guard::Stage;
use super::skeleton::Skeleton;
use super::walk::Tree;
use crate::Deformation;
use crate::curve::Curve;
use crate::deformation::{Influence, Joint, MorphTarget, Skin};
use crate::gltf::fault::Fault;
use crate::obj::Warnings;

const INDICES: &str = "primvars:skel:jointIndices";
const WEIGHTS: &str = "primvars:skel:jointWeights";

/// Skeletons, and how to find what is bound to them.
pub struct Skins<'a> {
    pub stage: &'a Stage,
    pub skeletons: &'a HashMap<String, Skeleton>,
}

impl Skins<'_> {
    /// The skeleton that an item is bound to, itself or by its parents.
    pub fn skeleton(&self, tree: &Tree, item: usize) -> Result<Option<&Skeleton>, Fault> {
        for item in std::iter::successors(Some(item), |&item| tree.items[item].parent) {
            let targets = Attributes::new(&tree.items[item].prim, 1.0).targets("skel:skeleton")?;
            if let Some(target) = targets.first() {
                return Ok(self.skeletons.get(target));
            }
        }
        Ok(None)
    }

    /// How a skeleton moves a mesh; none if it does not.
    pub fn deformation(
        &self,
        skeleton: &Skeleton,
        attributes: &Attributes,
        vertex_count: usize,
        warnings: &mut Warnings,
    ) -> Result<Deformation, Fault> {
        let skin = skin(skeleton, attributes, vertex_count)?;
        let names = attributes.get("skel:blendShapes", "token[]", convert::tokens)?.unwrap_or_default();
        let targets = attributes.targets("skel:blendShapeTargets")?;
        if names.len() != targets.len() {
            let found = format!("{} names", names.len());
            return Err(attributes.fault(
                "skel:blendShapes",
                found,
                format!("one for each of {} targets", targets.len()),
            ));
        }
        let mut morphs = Vec::new();
        for (name, target) in names.iter().zip(&targets) {
            morphs.push(self.morph(name, target, vertex_count, warnings)?);
        }
        let weights = skeleton.weights.as_ref().filter(|_| !morphs.is_empty());
        let places: Vec<Option<usize>> =
            names.iter().map(|name| skeleton.shapes.iter().position(|shape| shape == name)).collect();
        let weight = |all: &Vec<f64>| -> Vec<f64> {
            places.iter().map(|place| place.and_then(|place| all.get(place).copied()).unwrap_or(0.0)).collect()
        };
        let weights: Option<Curve<Vec<f64>>> = weights.map(|weights| weights.map(weight));
        Ok(Deformation { points: None, morphs, weights, skin })
    }

    fn morph(
        &self,
        name: &str,
        path: &str,
        vertex_count: usize,
        warnings: &mut Warnings,
    ) -> Result<MorphTarget, Fault> {
        let prim = self.stage.prim(path)?;
        let attributes = Attributes::new(&prim, 1.0);
        let properties = prim.property_names().unwrap_or_default();
        if properties.iter().any(|property| property.as_str().starts_with("inbetweens:")) {
            warnings.push(None, format!("{path}: inbetweens: ignored"));
        }
        let offsets = attributes.get("offsets", "vector3f[]", convert::vec3s)?.unwrap_or_default();
        let indices = attributes.get("pointIndices", "int[]", convert::integers)?;
        let indices = indices.filter(|indices| !indices.is_empty());
        let indices = indices.unwrap_or_else(|| (0..offsets.len() as i64).collect());
        if indices.len() != offsets.len() {
            let found = format!("{} offsets", offsets.len());
            return Err(attributes.fault("offsets", found, format!("one for each of {} points", indices.len())));
        }
        let mut of_vertex = BTreeMap::new();
        for (index, offset) in indices.into_iter().zip(offsets) {
            let vertex = u32::try_from(index).ok().filter(|&vertex| (vertex as usize) < vertex_count);
            let expected = || below(vertex_count, "points");
            let vertex =
                vertex.ok_or_else(|| attributes.fault("pointIndices", format!("point {index}"), expected()))?;
            if !offset.iter().all(|c| c.is_finite()) {
                return Err(attributes.fault("offsets", "an offset that is not finite", "finite numbers"));
            }
            of_vertex.insert(vertex, offset);
        }
        let (vertices, offsets) = of_vertex.into_iter().unzip();
        Ok(MorphTarget { name: name.to_owned(), vertices, offsets })
    }
}

/// The influences of joints; none if the mesh has none.
fn skin(skeleton: &Skeleton, attributes: &Attributes, vertex_count: usize) -> Result<Option<Skin>, Fault> {
    let Some(indices) = attributes.get(INDICES, "int[]", convert::integers)? else { return Ok(None) };
    let weights = attributes.get(WEIGHTS, "float[]", convert::numbers)?.unwrap_or_default();
    let each = attributes.metadata(INDICES, "elementSize", convert::number)?.filter(|each| *each >= 1.0);
    let interpolation = attributes.metadata(INDICES, "interpolation", convert::token)?;
    let is_rigid = interpolation.as_deref() == Some("constant");
    let element_count = if is_rigid { 1 } else { vertex_count };
    // Where the size is missing it is what there is room for.
    let each = each.map_or(indices.len() / element_count.max(1), |each| each as usize);
    let expected = each.saturating_mul(element_count);
    if indices.len() != expected || weights.len() != expected {
        let found = format!("{} indices and {} weights", indices.len(), weights.len());
        return Err(attributes.fault(INDICES, found, format!("{expected} of both")));
    }
    let joints = joints(skeleton, attributes)?;
    let mut skin = Skin { joints, first: vec![0], influences: Vec::new() };
    for vertex in 0..vertex_count {
        let start = if is_rigid { 0 } else { vertex * each };
        let given = || indices[start..start + each].iter().zip(&weights[start..start + each]);
        let sum: f64 = given().map(|(_, weight)| weight.max(0.0)).sum();
        for (&index, &weight) in given() {
            let joint = u32::try_from(index).ok().filter(|&joint| (joint as usize) < skin.joints.len());
            let expected = || below(skin.joints.len(), "joints");
            let joint = joint.ok_or_else(|| attributes.fault(INDICES, format!("joint {index}"), expected()))?;
            if weight > 0.0 && sum.is_finite() {
                skin.influences.push(Influence { joint, weight: (weight / sum) as f32 });
            }
        }
        skin.first.push(skin.influences.len() as u32);
    }
    Ok(Some(skin))
}

/// The joints in the mesh's own order, if it has one.
fn joints(skeleton: &Skeleton, attributes: &Attributes) -> Result<Vec<Joint>, Fault> {
    let geometry = attributes.get("primvars:skel:geomBindTransform", "an affine matrix4d", convert::affine)?;
    let geometry = geometry.unwrap_or(DAffine3::IDENTITY);
    let own = attributes.get("skel:joints", "token[]", convert::tokens)?;
    let joint = |name: &String| {
        let place = skeleton.joints.iter().position(|joint| joint == name);
        let place = place.ok_or_else(|| attributes.fault("skel:joints", format!("{name:?}"), "a joint's name"))?;
        let inverse_bind = skeleton.binds[place].inverse() * geometry;
        if !inverse_bind.is_finite() {
            return Err(attributes.fault("skel:joints", format!("{name:?} bound by no inverse"), "an inverse"));
        }
        Ok(Joint { node: skeleton.nodes[place], inverse_bind })
    };
    own.as_ref().unwrap_or(&skeleton.joints).iter().map(joint).collect()
}
