//! Pm-patches of quads (Myles, Ni and Peters 2008): four quartic triangles that meet in the middle.

use super::rivals_surface::RivalCorner;
use super::{Vec3, sum};
use crate::patch::SurfacePoint;

/// Coefficients of a quad: of each side p, the two inner points of its cubic, two points beside them and one towards the middle.
pub(super) const POINTS_PER_SIDE: usize = 6;

/// A patch of four quartic triangles, by the 24 coefficients that they are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct PmPatch([[Vec3; POINTS_PER_SIDE]; 4]);

fn mean(a: Vec3, b: Vec3) -> Vec3 {
    sum([(0.5, a), (0.5, b)])
}

/// A quarter of the way back from `near` to `corner`: a cubic's first inner point as a quartic's.
fn raised(corner: Vec3, near: Vec3) -> Vec3 {
    sum([(0.25, corner), (0.75, near)])
}

impl PmPatch {
    /// From the corners of a quad.
    pub(super) fn new(corners: &[RivalCorner; 4]) -> Self {
        let sides = [0, 1, 2, 3].map(|i| {
            let (from, to) = (&corners[i], &corners[(i + 1) % 4]);
            let points = [from.position, from.out.edge, to.into.edge, to.position];
            let [u0, u1, u2] = [0, 1, 2].map(|k| sum([(1.0, points[k + 1]), (-1.0, points[k])]));
            let (c0, c1) = (from.cosine, to.cosine);
            let sines = (1.0 - c0 * c0).sqrt() + (1.0 - c1 * c1).sqrt();
            // The sides' angle at the middle is a quarter turn.
            let beside = |p: Vec3, near: Vec3, own: f64, other: f64, next: Vec3, previous: Vec3, r: Vec3| {
                let weights = [(0.25 * (1.0 + own), next), ((1.0 - other) / 8.0, previous), (0.25 / sines, r)];
                sum([(1.0, raised(p, near)), (1.0, sum(weights))])
            };
            let turned = |a: Vec3| a.map(|c| -c);
            let near = beside(points[0], points[1], c0, c1, u1, u0, from.out.beside);
            let far = beside(points[3], points[2], c1, c0, turned(u1), turned(u2), turned(to.into.beside));
            [points[0], points[1], points[2], near, far]
        });
        // The bicubic patch of the inner points, there.
        let around = |i: usize| {
            let corner = &corners[i];
            sum([(1.0, corner.position), (9.0, corner.inner()), (3.0, corner.out_middle), (3.0, corner.into_middle)])
        };
        let middle = sum([0, 1, 2, 3].map(|i| (1.0 / 64.0, around(i))));
        let tilt = |i: usize| sum([(1.0, sides[i][3]), (-1.0, sides[(i + 1) % 4][4])]);
        let towards = |i: usize| {
            let [own, next, opposite, previous] = [0, 1, 2, 3].map(|k| tilt((i + k) % 4));
            sum([
                (1.0, middle),
                (3.0 / 16.0, own),
                (1.0 / 16.0, next),
                (-1.0 / 16.0, opposite),
                (-3.0 / 16.0, previous),
            ])
        };
        Self([0, 1, 2, 3].map(|i| {
            let [p, near, far, beside_near, beside_far] = sides[i];
            [p, near, far, beside_near, beside_far, towards(i)]
        }))
    }

    /// The 15 Bezier points of the triangle at a side: row by row from it to the middle.
    fn triangle(&self, side: usize) -> [Vec3; 15] {
        let at = |k: usize| &self.0[(side + k) % 4];
        let (own, next, opposite, previous) = (at(0), at(1), at(2), at(3));
        let first = raised(own[0], own[1]);
        let last = raised(next[0], own[2]);
        let both = mean(own[5], opposite[5]);
        [
            own[0],
            first,
            mean(own[1], own[2]),
            last,
            next[0],
            mean(first, raised(own[0], previous[2])),
            own[3],
            own[4],
            mean(last, raised(next[0], next[1])),
            mean(own[3], previous[4]),
            own[5],
            mean(own[4], next[3]),
            mean(own[5], previous[5]),
            mean(own[5], next[5]),
            mean(both, mean(next[5], previous[5])),
        ]
    }

    /// Position and derivatives at (u, v).
    pub fn evaluate(&self, u: f64, v: f64) -> SurfacePoint {
        // The side whose triangle the point lies in, and the point seen from there.
        let (side, a, b) = match (v <= u, u + v <= 1.0) {
            (true, true) => (0, u, v),
            (true, false) => (1, v, 1.0 - u),
            (false, false) => (2, 1.0 - u, 1.0 - v),
            (false, true) => (3, 1.0 - v, u),
        };
        let weights = [1.0 - a - b, a - b, 2.0 * b];
        let mut row = self.triangle(side).to_vec();
        // De Casteljau, down to the three points of the tangent plane.
        for size in (2..=4).rev() {
            let place = |i: usize, j: usize| j * (size + 1) - j * j.saturating_sub(1) / 2 + i;
            let mut next = Vec::new();
            for j in 0..size {
                for i in 0..size - j {
                    let corners = [row[place(i, j)], row[place(i + 1, j)], row[place(i, j + 1)]];
                    next.push(sum([0, 1, 2].map(|k| (weights[k], corners[k]))));
                }
            }
            row = next;
        }
        let [x, y, z] = [row[0], row[1], row[2]];
        let position = sum([(weights[0], x), (weights[1], y), (weights[2], z)]);
        let along = sum([(4.0, y), (-4.0, x)]);
        let inward = sum([(8.0, z), (-4.0, x), (-4.0, y)]);
        let turned = |a: Vec3| a.map(|c| -c);
        let (du, dv) = match side {
            0 => (along, inward),
            1 => (turned(inward), along),
            2 => (turned(along), turned(inward)),
            _ => (inward, turned(along)),
        };
        SurfacePoint { position, du, dv }
    }
}
