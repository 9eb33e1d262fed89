//! Where the surface is at the next moment: the same tables, applied to the cages of the next pose, in points of their own. What is
//! selected now is evaluated then, so a point of the surface and its successor have the same parameters.

use glam::{Affine3A, DAffine3, DMat3};
use planish_gpu::{Buffer, Device};
use planish_shaders as shaders;
use planish_shaders::Object;
use planish_subdiv::tables::Tables;

use crate::deform::{DeformBuffers, PoseBuffers};
use crate::error::Error;
use crate::objects::columns;
use crate::upload::{array, mapped};

/// What the next moment has of its own.
pub(crate) struct MotionBuffers {
    pub cage: Buffer,
    pub points: Buffer,
    pub limits: Buffer,
    pub pose: PoseBuffers,
}

impl MotionBuffers {
    pub fn new(device: &Device, tables: &Tables, deform: &DeformBuffers) -> Result<Self, Error> {
        Ok(Self {
            cage: mapped::<shaders::Points>(device, "next cage", tables.cage_point_count)?,
            points: array::<shaders::Points>(device, "next points", tables.point_count())?,
            limits: array::<shaders::LimitPoint>(device, "next limit points", tables.limit_point_count())?,
            pose: deform.another_pose(device)?,
        })
    }

    pub fn all(&self) -> [&Buffer; 5] {
        [&self.cage, &self.points, &self.limits, &self.pose.weights, &self.pose.joints]
    }
}

/// Says where an object goes: its transform at the next moment.
pub(crate) fn move_object(object: &mut Object, to_world: &Affine3A, next: &Affine3A, deforms: bool) {
    object.motion = if deforms {
        columns(next)
    } else if to_world == next {
        columns(&Affine3A::IDENTITY)
    } else {
        columns(&in_single(&(in_double(next) * in_double(to_world).inverse())))
    };
}

fn in_double(transform: &Affine3A) -> DAffine3 {
    let m = &transform.matrix3;
    let matrix3 = DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3());
    DAffine3 { matrix3, translation: transform.translation.as_dvec3() }
}

fn in_single(transform: &DAffine3) -> Affine3A {
    Affine3A { matrix3: transform.matrix3.as_mat3().into(), translation: transform.translation.as_vec3().into() }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn an_object_that_does_not_deform_moves_from_world_to_world() {
        let now = Affine3A::from_rotation_y(0.3) * Affine3A::from_scale(Vec3::new(-2.0, 1.0, 0.5));
        let next = Affine3A::from_translation(Vec3::new(1.0, 2.0, 3.0)) * now;
        let mut object = Object::default();
        move_object(&mut object, &now, &next, false);
        let motion = Affine3A::from_cols_array_2d(&object.motion);
        assert!((motion.transform_point3(Vec3::ONE) - Vec3::new(2.0, 3.0, 4.0)).length() < 1e-6);
        move_object(&mut object, &now, &now, false);
        assert_eq!(object.motion, columns(&Affine3A::IDENTITY));
        move_object(&mut object, &now, &next, true);
        assert_eq!(object.motion, columns(&next));
    }
}
