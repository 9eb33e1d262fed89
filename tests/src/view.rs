//! Cameras at odd places.

use crate::cage::Cage;

/// Where a camera stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the middle of the mesh.
    Inside,
    /// Outside, level with the highest vertex, so that the top is seen edge-on.
    Grazing,
    /// Close above a face, looking along it: some of its corners are behind.
    Above,
}

impl Place {
    /// All places.
    pub const ALL: [Self; 3] = [Self::Inside, Self::Grazing, Self::Above];

    /// The flags of a camera there.
    pub fn flags(self, cage: &Cage) -> String {
        let (low, high) = cage.bounding_box();
        let diagonal = cage.diagonal();
        let centre = mean(&[low, high]);
        let (eye, target) = match self {
            Self::Inside => (along(centre, [0.031, 0.017, 0.023], diagonal), along(centre, [0.2, 0.1, -0.3], diagonal)),
            Self::Grazing => {
                let eye = [low[0] - 0.3 * diagonal, high[1], centre[2] + 0.07 * diagonal];
                (eye, along(eye, [1.0, 0.0, 0.01], diagonal))
            }
            Self::Above => {
                let corners: Vec<[f64; 3]> = cage.faces[0].iter().map(|&vertex| cage.positions[vertex]).collect();
                let edge = difference(corners[1], corners[0]);
                let up = cross(edge, difference(corners[2], corners[0]));
                let length = up.iter().map(|c| c * c).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
                let eye = along(mean(&corners), up.map(|c| c / length), 0.03 * diagonal);
                let forward = if edge == [0.0; 3] { [1.0, 0.0, 0.0] } else { edge };
                (eye, along(eye, forward, 1.0))
            }
        };
        let text = |[x, y, z]: [f64; 3]| format!("{x:.6},{y:.6},{z:.6}");
        format!("--eye {} --target {} --fov 60", text(eye), text(target))
    }
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

fn along(from: [f64; 3], direction: [f64; 3], length: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| from[axis] + length * direction[axis])
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
