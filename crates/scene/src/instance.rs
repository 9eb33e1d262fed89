//! Where a mesh stands.
use glam::{Affine3A, DAffine3, DMat3, DVec3};

use crate::Bounds;

/// A mesh in one place of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The name in the file, else the mesh' name; members of an array have their place in it appended, as in `tree[3,0,1]`.
    pub name: String,
    /// Into [`crate::Scene::meshes`].
    pub mesh: usize,
    /// Object to world. Its determinant is not 0, and negative where the instance is mirrored: its faces are then clockwise
    /// seen from outside.
    pub transform: Affine3A,
    /// What it hangs on, into [`crate::Scene::nodes`]; none: it stays where `transform` puts it. With a node, `transform` is where
    /// that is at the scene's first moment.
    pub node: Option<usize>,
    /// What it is made of: into [`crate::Scene::materials`], one a slot of the mesh ([`crate::Mesh::slots`]); none: the default
    /// material. Slots beyond the end have none.
    pub materials: Vec<Option<usize>>,
}

impl Instance {
    /// A mesh in a place, of the default material.
    pub fn placed(name: impl Into<String>, mesh: usize, transform: Affine3A) -> Self {
        Self { name: name.into(), mesh, transform, node: None, materials: Vec::new() }
    }

    /// The box around the corners of `mesh_bounds` in world space; `mesh_bounds` itself, to the bit, where the mesh stands
    /// as it is.
    pub fn bounds(&self, mesh_bounds: &Bounds) -> Bounds {
        if self.transform == Affine3A::IDENTITY {
            return *mesh_bounds;
        }
        transformed(mesh_bounds, &in_double(&self.transform))
    }

    /// Whether the transform turns the mesh inside out, so that the order of its faces' vertices must be reversed.
    pub fn is_mirrored(&self) -> bool {
        in_double(&self.transform).matrix3.determinant() < 0.0
    }
}

/// The transform in double, where products of its entries neither overflow nor vanish.
fn in_double(transform: &Affine3A) -> DAffine3 {
    let columns = [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis];
    let [x, y, z] = columns.map(|column| column.as_dvec3());
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: transform.translation.as_dvec3() }
}

/// The box around the transformed corners of a box.
fn transformed(bounds: &Bounds, transform: &DAffine3) -> Bounds {
    let corner = |index: u32| {
        let upper = |axis: u32| f64::from(index >> axis & 1);
        let share = DVec3::new(upper(0), upper(1), upper(2));
        // No lerp: it is exact at both ends only where the difference is.
        let corner = DVec3::select(share.cmpgt(DVec3::ZERO), bounds.max, bounds.min);
        transform.transform_point3(corner)
    };
    let first = corner(0);
    (1..8)
        .map(corner)
        .fold(Bounds { min: first, max: first }, |around, corner| around.union(Bounds { min: corner, max: corner }))
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat, Vec3};

    use super::*;

    fn instance(transform: Affine3A) -> Instance {
        Instance::placed("i", 0, transform)
    }

    fn sample() -> Bounds {
        Bounds { min: DVec3::new(-0.0, 0.1, -3.0), max: DVec3::new(2.0, 0.7, 5.0) }
    }

    #[test]
    fn box_of_an_untransformed_instance_is_its_mesh_box_to_the_bit() {
        let bits = |bounds: Bounds| [bounds.min, bounds.max].map(|corner| corner.to_array().map(f64::to_bits));
        assert_eq!(bits(instance(Affine3A::IDENTITY).bounds(&sample())), bits(sample()));
    }

    #[test]
    fn box_of_a_mirrored_and_moved_instance_is_exact() {
        let transform =
            Affine3A { matrix3: Mat3::from_diagonal(Vec3::new(-2.0, 1.0, 0.5)).into(), translation: Vec3::ONE.into() };
        let bounds = instance(transform).bounds(&Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) });
        assert_eq!((bounds.min, bounds.max), (DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 3.0, 2.5)));
    }

    #[test]
    fn box_of_a_turned_instance_holds_the_turned_corners() {
        let turned = instance(Affine3A::from_quat(Quat::from_rotation_z(std::f32::consts::FRAC_PI_4)));
        let bounds = turned.bounds(&Bounds { min: DVec3::ZERO, max: DVec3::ONE });
        let half = 0.5f64.sqrt();
        assert!((bounds.min - DVec3::new(-half, 0.0, 0.0)).length() < 1e-6, "{bounds:?}");
        assert!((bounds.max - DVec3::new(half, 2.0 * half, 1.0)).length() < 1e-6, "{bounds:?}");
    }

    #[test]
    fn an_odd_number_of_negative_scales_mirrors() {
        for (scale, mirrored) in [([1.0, 1.0, 1.0], false), ([-1.0, 2.0, 1.0], true), ([-1.0, -1e-12, 1e-12], false)] {
            assert_eq!(instance(Affine3A::from_scale(scale.into())).is_mirrored(), mirrored, "{scale:?}");
        }
        // The determinant of this one vanishes in 32 bits.
        assert!(instance(Affine3A::from_scale(Vec3::splat(-1e-16))).is_mirrored());
    }
}
