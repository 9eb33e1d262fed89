//! Frames of reference that move: what instances, cameras, lights and joints hang on.
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use crate::curve::Curve;

/// One step of a node's transform.
#[derive(Clone, Debug, PartialEq)]
pub enum TransformStep {
    /// Any affine map.
    Matrix(Curve<DAffine3>),
    /// A translation.
    Translate(Curve<DVec3>),
    /// A rotation; quaternions need not be of unit length.
    Rotate(Curve<DQuat>),
    /// Rotations about the axes x, y and z by degrees, in this order of application: `[0, 1, 2]` turns about x first.
    RotateEuler([usize; 3], Curve<DVec3>),
    /// A scale along each axis.
    Scale(Curve<DVec3>),
    /// The inverse of another step.
    Inverse(Box<TransformStep>),
}

impl TransformStep {
    /// The map at a time in seconds.
    pub fn at(&self, time: f64) -> DAffine3 {
        match self {
            Self::Matrix(curve) => curve.at(time),
            Self::Translate(curve) => DAffine3::from_translation(curve.at(time)),
            Self::Rotate(curve) => {
                let rotation = curve.at(time);
                let is_turn = rotation.length_squared() > 0.0 && rotation.is_finite();
                DAffine3::from_quat(if is_turn { rotation.normalize() } else { DQuat::IDENTITY })
            }
            Self::RotateEuler(order, curve) => {
                let degrees = curve.at(time);
                order.iter().fold(DAffine3::IDENTITY, |before, &axis| {
                    let turn = DQuat::from_axis_angle(DVec3::AXES[axis], degrees[axis].to_radians());
                    DAffine3::from_quat(turn) * before
                })
            }
            Self::Scale(curve) => DAffine3::from_scale(curve.at(time)),
            Self::Inverse(step) => {
                let inverse = step.at(time).inverse();
                // Without an inverse the node would be nowhere: it collapses to a point instead.
                if inverse.is_finite() { inverse } else { DAffine3::from_mat3(DMat3::ZERO) }
            }
        }
    }

    fn key_times(&self) -> &[f64] {
        match self {
            Self::Matrix(curve) => curve.times(),
            Self::Rotate(curve) => curve.times(),
            Self::Translate(curve) | Self::RotateEuler(_, curve) | Self::Scale(curve) => curve.times(),
            Self::Inverse(step) => step.key_times(),
        }
    }

    /// Whether it is the same at all times.
    pub fn is_constant(&self) -> bool {
        match self {
            Self::Matrix(curve) => curve.is_constant(),
            Self::Rotate(curve) => curve.is_constant(),
            Self::Translate(curve) | Self::RotateEuler(_, curve) | Self::Scale(curve) => curve.is_constant(),
            Self::Inverse(step) => step.is_constant(),
        }
    }
}

/// A frame of reference. A node comes after its parent, so there are no cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The name in the file; a USD prim's path.
    pub name: String,
    /// Its parent, of a smaller index; none: the world.
    pub parent: Option<usize>,
    /// Node to parent: the product of the steps in this order, so the last is applied to points first. None: as the parent.
    pub steps: Vec<TransformStep>,
    /// Whether what hangs on it, and on its children, is seen.
    pub visible: Curve<bool>,
}

impl Node {
    /// A node that stays where its parent is.
    pub fn still(name: &str, parent: Option<usize>) -> Self {
        Self { name: name.to_owned(), parent, steps: Vec::new(), visible: Curve::constant(true) }
    }

    /// Node to parent at a time in seconds.
    pub fn local(&self, time: f64) -> DAffine3 {
        self.steps.iter().map(|step| step.at(time)).reduce(|a, b| a * b).unwrap_or(DAffine3::IDENTITY)
    }

    /// Times of all its keys, in seconds and in no order.
    #[cfg_attr(not(feature = "usd"), expect(dead_code, reason = "the USD reader's alone"))]
    pub(crate) fn key_times(&self) -> impl Iterator<Item = f64> {
        self.visible.times().iter().chain(self.steps.iter().flat_map(TransformStep::key_times)).copied()
    }

    /// Whether it is the same at all times, its parents apart.
    pub fn is_constant(&self) -> bool {
        self.visible.is_constant() && self.steps.iter().all(TransformStep::is_constant)
    }
}

/// Where a node is, and whether it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Node to world.
    pub to_world: DAffine3,
    /// Whether it and all its parents are visible.
    pub is_visible: bool,
}

/// All nodes at a time in seconds.
///
/// # Panics
/// If a node does not come after its parent.
pub fn place_nodes(nodes: &[Node], time: f64) -> Vec<Placed> {
    let mut placed: Vec<Placed> = Vec::with_capacity(nodes.len());
    for (index, node) in nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index), "node {index} before its parent");
        let parent = node.parent.map(|parent| placed[parent]);
        let parent = parent.unwrap_or(Placed { to_world: DAffine3::IDENTITY, is_visible: true });
        let to_world = if node.steps.is_empty() { parent.to_world } else { parent.to_world * node.local(time) };
        placed.push(Placed { to_world, is_visible: parent.is_visible && node.visible.at(time) });
    }
    placed
}

/// The order that rotates about `x`, then `y`, then `z`, and its kin, by the letters of USD's ops: `rotateXYZ` turns about x
/// first.
pub fn euler_order(letters: &str) -> Option<[usize; 3]> {
    match letters {
        "XYZ" => Some([0, 1, 2]),
        "XZY" => Some([0, 2, 1]),
        "YXZ" => Some([1, 0, 2]),
        "YZX" => Some([1, 2, 0]),
        "ZXY" => Some([2, 0, 1]),
        "ZYX" => Some([2, 1, 0]),
        _ => None,
    }
}

/// A rotation by Euler angles in degrees about x, then y, then z, as a quaternion.
pub fn euler_xyz(degrees: DVec3) -> DQuat {
    let [x, y, z] = degrees.to_array().map(f64::to_radians);
    DQuat::from_euler(EulerRot::ZYX, z, y, x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Interpolation;

    fn close(a: DVec3, b: [f64; 3]) {
        assert!((a - DVec3::from(b)).length() < 1e-12, "{a} {b:?}");
    }

    #[test]
    fn children_move_with_their_parents() {
        let times = vec![0.0, 2.0];
        let path = Curve::keyed(times, vec![DVec3::ZERO, DVec3::X * 4.0], Interpolation::Linear).unwrap();
        let parent = Node { steps: vec![TransformStep::Translate(path)], ..Node::still("parent", None) };
        let turn = Curve::constant(DVec3::new(0.0, 0.0, 90.0));
        let child = Node { steps: vec![TransformStep::RotateEuler([0, 1, 2], turn)], ..Node::still("child", Some(0)) };
        let placed = place_nodes(&[parent, child], 1.0);
        close(placed[1].to_world.transform_point3(DVec3::X), [2.0, 1.0, 0.0]);
    }

    #[test]
    fn the_last_step_is_applied_first_and_inverses_undo() {
        let scale = TransformStep::Scale(Curve::constant(DVec3::splat(2.0)));
        let translate = TransformStep::Translate(Curve::constant(DVec3::X));
        let node = Node { steps: vec![translate.clone(), scale], ..Node::still("n", None) };
        close(node.local(0.0).transform_point3(DVec3::ONE), [3.0, 2.0, 2.0]);
        let undone = Node {
            steps: vec![translate.clone(), TransformStep::Inverse(Box::new(translate))],
            ..Node::still("n", None)
        };
        assert_eq!(undone.local(0.0), DAffine3::IDENTITY);
    }

    #[test]
    fn euler_angles_turn_in_the_order_of_their_letters() {
        // x by 90 degrees takes y to z, then z by 90 degrees leaves it.
        let step = |letters| {
            let order = euler_order(letters).unwrap();
            TransformStep::RotateEuler(order, Curve::constant(DVec3::new(90.0, 0.0, 90.0)))
        };
        close(step("XYZ").at(0.0).transform_point3(DVec3::Y), [0.0, 0.0, 1.0]);
        // The other way round: z takes y to -x, which x leaves.
        close(step("ZYX").at(0.0).transform_point3(DVec3::Y), [-1.0, 0.0, 0.0]);
        close(euler_xyz(DVec3::new(90.0, 0.0, 90.0)).mul_vec3(DVec3::Y), [0.0, 0.0, 1.0]);
        assert_eq!(euler_order("XXY"), None);
    }

    #[test]
    fn what_hangs_on_a_hidden_node_is_hidden() {
        let hidden = Node { visible: Curve::constant(false), ..Node::still("a", None) };
        let placed = place_nodes(&[hidden, Node::still("b", Some(0)), Node::still("c", None)], 0.0);
        assert_eq!(placed.iter().map(|node| node.is_visible).collect::<Vec<_>>(), [false, false, true]);
    }
}
