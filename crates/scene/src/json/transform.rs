//! The ways to write a transform, and which are refused.
use std::ops::RangeInclusive;

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3};

use super::Fault;
use super::text::{InstanceText, RotationText, ScaleText};

/// Lengths that the unit vectors may get. With [`MIN_RELATIVE_VOLUME`] the determinant is at least 1e-9 cubed times 1e-6, which
/// is 1e-33, and the least normal 32-bit float 1.2e-38.
const LENGTHS: RangeInclusive<f64> = 1e-9..=1e9;
/// The volume of the unit cube's image over that of a box of the same edges, below which it counts as flat: some roundings of
/// 32-bit floats.
const MIN_RELATIVE_VOLUME: f64 = 1e-6;

/// The transform that an instance writes, without its array.
pub fn transform(text: &InstanceText) -> Result<DAffine3, Fault> {
    let fields =
        [("translate", text.translate.is_some()), ("rotate", text.rotate.is_some()), ("scale", text.scale.is_some())];
    let Some(matrix) = text.matrix else {
        return parts(text);
    };
    if let Some((field, _)) = fields.iter().find(|(_, present)| *present) {
        return Err(Fault::new(*field, format!("a {field} beside a matrix"), "one or the other"));
    }
    let row = |row: usize| DVec3::new(matrix[4 * row], matrix[4 * row + 1], matrix[4 * row + 2]);
    let matrix3 = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    let transform = DAffine3 { matrix3, translation: DVec3::new(matrix[3], matrix[7], matrix[11]) };
    refuse_flat(&transform.matrix3)?;
    Ok(transform)
}

fn parts(text: &InstanceText) -> Result<DAffine3, Fault> {
    let scale = match text.scale {
        None => DVec3::ONE,
        Some(ScaleText::Same(scale)) => DVec3::splat(scale),
        Some(ScaleText::Each(scale)) => scale.into(),
    };
    if !scale.to_array().iter().all(|scale| LENGTHS.contains(&scale.abs())) {
        return Err(Fault::new(
            "scale",
            format!("{:?}", scale.to_array()),
            "magnitudes from 1e-9 to 1e9; negative ones mirror",
        ));
    }
    let rotation = text.rotate.as_ref().map_or(Ok(DQuat::IDENTITY), rotation)?;
    let translation = text.translate.unwrap_or_default().into();
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}

fn rotation(text: &RotationText) -> Result<DQuat, Fault> {
    let axis = DVec3::from(text.axis);
    // Its greatest coordinate first: squares may leave the range even of doubles.
    match (axis / axis.abs().max_element()).try_normalize() {
        Some(axis) => Ok(DQuat::from_axis_angle(axis, text.degrees.to_radians())),
        None => Err(Fault::new("rotate.axis", format!("{:?}", axis.to_array()), "a direction")),
    }
}

fn refuse_flat(matrix: &DMat3) -> Result<(), Fault> {
    let lengths = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length);
    if !lengths.iter().all(|length| LENGTHS.contains(length)) {
        let found = format!("columns of lengths {lengths:?}");
        return Err(Fault::new("matrix", found, "lengths from 1e-9 to 1e9"));
    }
    let volume: f64 = lengths.iter().product();
    if matrix.determinant().abs() < MIN_RELATIVE_VOLUME * volume {
        return Err(Fault::new("matrix", "columns in one plane", "columns that span space"));
    }
    Ok(())
}

/// The transform as it is kept: none where the translation leaves the range of 32-bit floats.
pub fn rounded(transform: &DAffine3) -> Option<Affine3A> {
    Some(transform.as_affine3a()).filter(|rounded| rounded.is_finite())
}
