//! Approximate Catmull-Clark patches (Loop and Schaefer 2008).

use super::rivals_surface::RivalCorner;
use super::{Vec3, bernstein, sum};
use crate::patch::SurfacePoint;

/// A bicubic patch and the tangents that its normals are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct AccPatch {
    /// Row by row of v.
    points: [[Vec3; 4]; 4],
    /// The tangent along u: three columns of four.
    along_u: [[Vec3; 3]; 4],
    /// Along v: four columns of three.
    along_v: [[Vec3; 4]; 3],
}

impl AccPatch {
    /// From the corners of a quad.
    pub(super) fn new(corners: &[RivalCorner; 4]) -> Self {
        let [p, out, into, inner] = [
            corners.map(|corner| corner.position),
            corners.map(|corner| corner.out_middle),
            corners.map(|corner| corner.into_middle),
            corners.map(|corner| corner.inner()),
        ];
        let points = [
            [p[0], out[0], into[1], p[1]],
            [into[0], inner[0], inner[1], out[1]],
            [out[3], inner[3], inner[2], into[2]],
            [p[3], into[3], out[2], p[2]],
        ];
        let difference = |a: Vec3, b: Vec3| sum([(3.0, a), (-3.0, b)]);
        // Of each edge its tangents at both ends, and the derivatives into the face.
        let edges = [0, 1, 2, 3].map(|i| {
            let (from, to) = (&corners[i], &corners[(i + 1) % 4]);
            let (first, last) = (difference(from.out.edge, p[i]), difference(p[(i + 1) % 4], to.into.edge));
            let middle = difference(to.into_middle, from.out_middle);
            let (c0, c1) = (from.cosine, to.cosine);
            let near = sum([(1.0, from.out.beside), (2.0 * c0 / 3.0, middle), (-c1 / 3.0, first)]);
            let far = sum([(-1.0, to.into.beside), (c0 / 3.0, last), (-2.0 * c1 / 3.0, middle)]);
            [first, last, near, far]
        });
        let turned = |a: Vec3| a.map(|c| -c);
        let inside = |a: usize, b: usize, c: usize, d: usize| difference(points[c][d], points[a][b]);
        let along_u = [
            [edges[0][0], inside(0, 1, 0, 2), edges[0][1]],
            [edges[3][3], inside(1, 1, 1, 2), turned(edges[1][2])],
            [edges[3][2], inside(2, 1, 2, 2), turned(edges[1][3])],
            [turned(edges[2][1]), inside(3, 1, 3, 2), turned(edges[2][0])],
        ];
        let along_v = [
            [turned(edges[3][1]), edges[0][2], edges[0][3], edges[1][0]],
            [inside(1, 0, 2, 0), inside(1, 1, 2, 1), inside(1, 2, 2, 2), inside(1, 3, 2, 3)],
            [turned(edges[3][0]), turned(edges[2][3]), turned(edges[2][2]), edges[1][1]],
        ];
        Self { points, along_u, along_v }
    }

    /// Position and the two tangents that the normal is made of, at (u, v).
    pub fn evaluate(&self, u: f64, v: f64) -> SurfacePoint {
        let ((nu, _), (nv, _)) = (bernstein(u), bernstein(v));
        let quadratic = |t: f64| [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
        let (qu, qv) = (quadratic(u), quadratic(v));
        let cubic_row = |row: &[Vec3; 4]| sum([0, 1, 2, 3].map(|i| (nu[i], row[i])));
        let quadratic_row = |row: &[Vec3; 3]| sum([0, 1, 2].map(|i| (qu[i], row[i])));
        SurfacePoint {
            position: sum([0, 1, 2, 3].map(|j| (nv[j], cubic_row(&self.points[j])))),
            du: sum([0, 1, 2, 3].map(|j| (nv[j], quadratic_row(&self.along_u[j])))),
            dv: sum([0, 1, 2].map(|j| (qv[j], cubic_row(&self.along_v[j])))),
        }
    }
}
