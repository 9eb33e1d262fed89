//! The quartic Gregory triangle of 15 points, with cubic boundary curves (section 3.1).

use super::{Corner, Normals, Vec3, blend, face_points, sum};
use crate::patch::SurfacePoint;

/// The control points of a triangle.
pub fn triangle_points(corners: &[Corner; 3]) -> Vec<Vec3> {
    face_points(4.0, corners)
}

/// Barycentric coordinates of a point of part `part` of a triangle, whose parameters (u, v) are those of the Ptex face that begins at
/// corner `part`: bilinear between the corner, the middle of its edge, the centre and the middle of the edge before.
pub fn part_barycentric(part: usize, u: f64, v: f64) -> [f64; 3] {
    let (s, t) = (1.0 - u, 1.0 - v);
    let (next, previous, centre) = (u * t, s * v, u * v);
    let mut b = [0.0; 3];
    b[part] = s * t + 0.5 * (next + previous) + centre / 3.0;
    b[(part + 1) % 3] = 0.5 * next + centre / 3.0;
    b[(part + 2) % 3] = 0.5 * previous + centre / 3.0;
    b
}

/// The patch at barycentric coordinates of sum 1; the derivatives are those towards corner 0 and corner 1, away from corner 2.
///
/// # Panics
/// If there are not 15 points.
pub fn evaluate_triangle(points: &[Vec3], at: [f64; 3], normals: Normals) -> SurfacePoint {
    assert_eq!(points.len(), 15);
    let mut position = [0.0; 3];
    let mut by = [[0.0; 3]; 3];
    let mut add = |weight: f64, slopes: [f64; 3], point: Vec3| {
        position = sum([(1.0, position), (weight, point)]);
        by = [0, 1, 2].map(|k| sum([(1.0, by[k]), (slopes[k], point)]));
    };
    let product = 12.0 * at[0] * at[1] * at[2];
    let mut of_blends = [[0.0; 3]; 3];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (a, b) = (at[i], at[j]);
        let slopes = |of_i: f64, of_j: f64, of_k: f64| {
            let mut slopes = [0.0; 3];
            (slopes[i], slopes[j], slopes[k]) = (of_i, of_j, of_k);
            slopes
        };
        let [p, out] = [points[5 * i], points[5 * i + 1]];
        let into = points[5 * j + 2];
        add(a * a * a, slopes(3.0 * a * a, 0.0, 0.0), p);
        // 3 a b (a + b) (a e+ + b e-)
        let (aab, abb) = (3.0 * a * a * b * (a + b), 3.0 * a * b * b * (a + b));
        add(aab, slopes(9.0 * a * a * b + 6.0 * a * b * b, 3.0 * a * a * a + 6.0 * a * a * b, 0.0), out);
        add(abb, slopes(3.0 * b * b * b + 6.0 * a * b * b, 9.0 * a * b * b + 6.0 * a * a * b, 0.0), into);
        // Towards the edge that ends at the corner f- wins, towards the one that begins there f+.
        let (plus, minus) = (at[j], at[k]);
        let (inner, by_plus) = blend(plus, points[5 * i + 3], minus, points[5 * i + 4]);
        let c = at[k];
        add(product * a, slopes(24.0 * a * b * c, 12.0 * a * a * c, 12.0 * a * a * b), inner);
        if normals == Normals::Exact {
            let (_, by_minus) = blend(minus, points[5 * i + 4], plus, points[5 * i + 3]);
            of_blends[j] = sum([(1.0, of_blends[j]), (product * a, by_plus)]);
            of_blends[k] = sum([(1.0, of_blends[k]), (product * a, by_minus)]);
        }
    }
    let from_last = |i: usize| sum([(1.0, by[i]), (1.0, of_blends[i]), (-1.0, by[2]), (-1.0, of_blends[2])]);
    SurfacePoint { position, du: from_last(0), dv: from_last(1) }
}
