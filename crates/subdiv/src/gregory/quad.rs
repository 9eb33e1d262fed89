//! The bicubic Gregory patch of 20 points (section 3.1).

use super::{Corner, Normals, Vec3, bernstein, blend, face_points, sum};
use crate::patch::SurfacePoint;

/// The control points of a quad.
pub fn quad_points(corners: &[Corner; 4]) -> Vec<Vec3> {
    face_points(3.0, corners)
}

/// The patch at (u, v): its corners are at (0,0), (1,0), (1,1), (0,1).
///
/// # Panics
/// If there are not 20 points.
pub fn evaluate_quad(points: &[Vec3], u: f64, v: f64, normals: Normals) -> SurfacePoint {
    assert_eq!(points.len(), 20);
    let (s, t) = (1.0 - u, 1.0 - v);
    let f = |corner: usize, plus: f64, minus: f64| blend(plus, points[5 * corner + 3], minus, points[5 * corner + 4]);
    // f+ of corners 0 and 2 lies along u from it, that of 1 and 3 along v.
    let blends = [f(0, u, v), f(1, v, s), f(2, s, t), f(3, t, u)];
    let [p, out, into] = [0, 1, 2].map(|j| [0, 1, 2, 3].map(|i| points[5 * i + j]));
    let inner = blends.map(|(point, _)| point);
    // Row by row of v.
    let rows = [
        [p[0], out[0], into[1], p[1]],
        [into[0], inner[0], inner[1], out[1]],
        [out[3], inner[3], inner[2], into[2]],
        [p[3], into[3], out[2], p[2]],
    ];
    let ((nu, du), (nv, dv)) = (bernstein(u), bernstein(v));
    let weigh = |a: [f64; 4], b: [f64; 4]| {
        let row = |j: usize| sum([0, 1, 2, 3].map(|i| (a[i], rows[j][i])));
        sum([0, 1, 2, 3].map(|j| (b[j], row(j))))
    };
    let mut point = SurfacePoint { position: weigh(nu, nv), du: weigh(du, nv), dv: weigh(nu, dv) };
    if normals == Normals::Exact {
        // Of corner i the blend's weights are `plus` and `minus`; how they change with u and v.
        let weights = [(u, v), (v, s), (s, t), (t, u)];
        let slopes = [
            ([1.0, 0.0], [0.0, 1.0]),
            ([0.0, 1.0], [-1.0, 0.0]),
            ([-1.0, 0.0], [0.0, -1.0]),
            ([0.0, -1.0], [1.0, 0.0]),
        ];
        let places = [(1, 1), (2, 1), (2, 2), (1, 2)];
        for i in 0..4 {
            let ((plus, minus), (by_plus, by_minus)) = (weights[i], slopes[i]);
            let (_, by_first) = blends[i];
            let (_, by_second) = blend(minus, points[5 * i + 4], plus, points[5 * i + 3]);
            let weight = nu[places[i].0] * nv[places[i].1];
            let slope = |axis: usize| sum([(weight * by_plus[axis], by_first), (weight * by_minus[axis], by_second)]);
            point.du = sum([(1.0, point.du), (1.0, slope(0))]);
            point.dv = sum([(1.0, point.dv), (1.0, slope(1))]);
        }
    }
    point
}
