//! The transform of a prim (UsdGeomXformable): its ops become the steps of a node, in the order in which they are written.
use glam::{DAffine3, DQuat, DVec3};
use openusd::sdf::Value;

use super::attributes::Attributes;
use super::convert;
use crate::curve::Interpolation;
use crate::gltf::fault::Fault;
use crate::node::{TransformStep, euler_order};

const ORDER: &str = "xformOpOrder";
const INVERT: &str = "!invert!";
const RESET: &str = "!resetXformStack!";
/// How the axes of a scene with z upwards lie in one with y upwards: +z becomes +y, +y becomes -z.
const Z_UP: [DVec3; 3] = [DVec3::X, DVec3::NEG_Z, DVec3::Y];

/// What a prim's ops say.
#[derive(Debug, Default)]
pub struct Transform {
    pub steps: Vec<TransformStep>,
    /// The prim stands in the world, whatever its parents do.
    pub is_reset: bool,
}

/// Turns a scene with z upwards to +y upwards.
pub fn z_up() -> DAffine3 {
    DAffine3 { matrix3: glam::DMat3::from_cols(Z_UP[0], Z_UP[1], Z_UP[2]), translation: DVec3::ZERO }
}

/// Reads a prim's ops.
pub fn read(attributes: &Attributes) -> Result<Transform, Fault> {
    let mut transform = Transform::default();
    for op in attributes.get(ORDER, "token[]", convert::tokens)?.unwrap_or_default() {
        if op == RESET {
            transform = Transform { steps: Vec::new(), is_reset: true };
            continue;
        }
        let (name, is_inverse) = match op.strip_prefix(INVERT) {
            Some(name) => (name, true),
            None => (op.as_str(), false),
        };
        let Some(step) = step(attributes, name)? else {
            return Err(attributes.fault(ORDER, format!("the op {op:?} without a value"), "an op that has one"));
        };
        transform.steps.push(if is_inverse { TransformStep::Inverse(Box::new(step)) } else { step });
    }
    Ok(transform)
}

/// One op; none if it has no value.
fn step(attributes: &Attributes, name: &str) -> Result<Option<TransformStep>, Fault> {
    let kind = name.strip_prefix("xformOp:").map(|rest| rest.split(':').next().unwrap_or_default());
    let linear = |expected| (expected, Interpolation::Linear);
    let vector = || attributes.curve::<DVec3>(name, linear("three finite numbers"), vector);
    let along = |axis: usize, rest: f64| {
        let curve = attributes.curve::<f64>(name, linear("a finite number"), number)?;
        Ok(curve.map(|curve| {
            curve.map(|&value| {
                let mut vector = DVec3::splat(rest);
                vector[axis] = value;
                vector
            })
        }))
    };
    let axis = |letter: &str| "XYZ".find(letter).filter(|_| letter.len() == 1);
    Ok(match kind {
        Some("translate") => vector()?.map(TransformStep::Translate),
        Some("scale") => vector()?.map(TransformStep::Scale),
        Some("orient") => {
            attributes.curve::<DQuat>(name, linear("a finite quaternion"), rotation)?.map(TransformStep::Rotate)
        }
        Some("transform") => attributes
            .curve::<DAffine3>(name, linear("an affine matrix4d"), convert::affine)?
            .map(TransformStep::Matrix),
        Some(kind) => {
            let single = |prefix: &str| kind.strip_prefix(prefix).and_then(axis);
            if let Some(order) = kind.strip_prefix("rotate").and_then(euler_order) {
                vector()?.map(|curve| TransformStep::RotateEuler(order, curve))
            } else if let Some(axis) = single("rotate") {
                along(axis, 0.0)?.map(|curve| TransformStep::RotateEuler([0, 1, 2], curve))
            } else if let Some(axis) = single("translate") {
                along(axis, 0.0)?.map(TransformStep::Translate)
            } else if let Some(axis) = single("scale") {
                along(axis, 1.0)?.map(TransformStep::Scale)
            } else {
                return Err(attributes.fault(ORDER, format!("the op {name:?}"), "an op of UsdGeomXformOp"));
            }
        }
        None => return Err(attributes.fault(ORDER, format!("the op {name:?}"), "a name that begins with xformOp:")),
    })
}

fn vector(value: Value) -> Option<DVec3> {
    convert::vec3(value).filter(|v| v.is_finite())
}

fn rotation(value: Value) -> Option<DQuat> {
    convert::quat(value).filter(|q| q.is_finite())
}

fn number(value: Value) -> Option<f64> {
    convert::number(value).filter(|v| v.is_finite())
}
