//! Whether nothing can be seen of a patch. CPU twin of `glsl/shared/visibility.glsl`, operation by operation.
//!
//! **Outside of the view**: all points of the patch's convex hull lie beyond one plane of the frustum.
//!
//! **Turned away**: all triangles that the patch can be tessellated into show their back. A triangle at d from the eye with
//! sides e and f shows it when `d . (e x f) > 0`. Let e be the change of the surface over a step r along u, and f that over
//! a step t along v. Then e is r times a mean of the derivatives S_u, f is t times one of S_v, and means of derivatives are
//! weighted means of the 12 vectors between neighbouring Bezier points, times 3. The product is linear in each: with
//! unit vectors u_i and v_j along those,
//!
//! > d . (e x f) >= r U t V min d . (u_i x v_j), where |e| <= r U, |f| <= t V
//!
//! and U and V are the same weighted means of the vectors' lengths. For d within a radius R of a vector m at the patch,
//! `d . (u_i x v_j) >= m . (u_i x v_j) - R`. This does not depend on how finely the patch is tessellated, and 144 products
//! are hardly coarser than the patch itself; a bounding cone of normals (Sederberg and Meyers 1988) is.
//!
//! So a patch is turned away if `min m . (u_i x v_j) > R + x (|m| + R)`, with slack x for
//!
//! - **rounding**, and the rasterizer's grid: a corner moves by `error` at most, a side by twice that, and the product
//!   changes by `2 error (|e| + |f|) + 4 error^2` times |d|: it needs `x > n + n^2`, n = 2 error (1 / (r U) + 1 / (t V)).
//! - **uneven rings.** Where an edge has other points than the row of points beside it, triangles between the two have a side
//!   f = s S_u + t S_v that runs along neither. Beside e = r S'_u of the row, `d . (e x f)` has the further term `r s d .
//!   (S'_u x S_u)`, in which S'_u and S_u, means over steps r and s from one point, differ by |r - s| / 2 times the second
//!   derivative at most: it needs `x > s |r - s| / (2 t) |S_uu| / |S_v|` besides, and in n there is s / (r t) U / (U V).
//!
//! [`crate::factors::PatchFactors::grain`] knows the shortest r and t and the longest s. What is no Bezier patch is off one
//! ([`crate::gregory_visibility`]).

use std::array::from_fn;

use planish_shaders::EmitView;

use crate::factors::Grain;

pub(crate) type Vec3 = [f32; 3];

// The constants of the shader, by the same names.
const ROUNDING: f32 = 1.907_348_6e-6;
const TURN_MARGIN: f32 = 1e-4;
const CUBE_DIAGONAL: f32 = 1.732_050_9;

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|c| a[c] + b[c])
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|c| a[c] - b[c])
}

pub(crate) fn times(a: Vec3, factor: f32) -> Vec3 {
    a.map(|c| c * factor)
}

pub(crate) fn over(a: Vec3, divisor: f32) -> Vec3 {
    a.map(|c| c / divisor)
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn largest_component(a: Vec3) -> f32 {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

fn sum_of_components(a: Vec3) -> f32 {
    (a[0].abs() + a[1].abs()) + a[2].abs()
}

pub(crate) struct Scale {
    pub factor: f32,
    pub eye: Vec3,
    near: f32,
    rounding: f32,
    pub eye_rounding: f32,
}

impl Scale {
    pub fn new(view: &EmitView, unit: f32, points: &[Vec3]) -> Self {
        let (mut largest_offset, mut largest) = (0.0_f32, 0.0_f32);
        for &point in points {
            largest_offset = largest_offset.max(largest_component(sub(point, times(view.eye, unit))));
            largest = largest.max(largest_component(point));
        }
        let factor = 1.0 / largest_offset.max(f32::MIN_POSITIVE);
        let eye = times(times(view.eye, unit), factor);
        Self {
            factor,
            eye,
            near: (view.near * unit) * factor,
            rounding: ROUNDING * (largest * factor),
            eye_rounding: ROUNDING * largest_component(eye),
        }
    }

    fn error(&self, view: &EmitView) -> f32 {
        self.rounding + CUBE_DIAGONAL * view.snap
    }
}

pub(crate) fn outside_planes(d: Vec3, view: &EmitView, scale: &Scale, margin: f32) -> u32 {
    let (x, y, w) = (dot(view.clip_x, d), dot(view.clip_y, d), dot(view.clip_w, d));
    let noise = ((scale.rounding + scale.eye_rounding) + ROUNDING) + margin;
    let depth_noise = sum_of_components(view.clip_w) * noise;
    let x_noise = -(sum_of_components(view.clip_x) * noise + depth_noise);
    let y_noise = -(sum_of_components(view.clip_y) * noise + depth_noise);
    u32::from(w + x < x_noise)
        | u32::from(w - x < x_noise) << 1
        | u32::from(w + y < y_noise) << 2
        | u32::from(w - y < y_noise) << 3
        | u32::from(w - scale.near < -depth_noise) << 4
}

/// The planes that a point and all within `margin` of it lie outside of.
pub fn point_outside_planes(p: Vec3, view: &EmitView, margin: f32) -> u32 {
    let scale = Scale::new(view, 1.0, &[p]);
    let d = sub(times(p, scale.factor), scale.eye);
    outside_planes(d, view, &scale, margin * scale.factor)
}

/// Points of a cubic Bezier curve, times 6, from those of a B-spline.
fn bezier_points([p0, p1, p2, p3]: [Vec3; 4]) -> [Vec3; 4] {
    [
        add(add(p0, times(p1, 4.0)), p2),
        add(times(p1, 4.0), times(p2, 2.0)),
        add(times(p1, 2.0), times(p2, 4.0)),
        add(add(p1, times(p2, 4.0)), p3),
    ]
}

/// Points of a bicubic Bezier patch, times 36, from those of a B-spline.
pub fn bezier_patch(p: &[Vec3; 16]) -> [Vec3; 16] {
    let mut row = *p;
    for i in [0, 4, 8, 12] {
        row[i..i + 4].copy_from_slice(&bezier_points(from_fn(|j| p[i + j])));
    }
    let mut b = row;
    for i in 0..4 {
        for (j, point) in bezier_points(from_fn(|j| row[4 * j + i])).into_iter().enumerate() {
            b[4 * j + i] = point;
        }
    }
    b
}

fn between(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    let s = 1.0 - t;
    from_fn(|c| a[c] * s + b[c] * t)
}

/// Value of the polar form of a cubic Bezier curve.
fn blossom(b: [Vec3; 4], [r, s, t]: [f32; 3]) -> Vec3 {
    let c = [between(b[0], b[1], r), between(b[1], b[2], r), between(b[2], b[3], r)];
    between(between(c[0], c[1], s), between(c[1], c[2], s), t)
}

/// The Bezier points of the part between `low` and `high` of the parameters.
pub fn bezier_part(b: &mut [Vec3; 16], low: [f32; 2], high: [f32; 2]) {
    for (axis, (step, row)) in [(1, 4), (4, 1)].into_iter().enumerate() {
        let (l, h) = (low[axis], high[axis]);
        for i in 0..4 {
            let curve = from_fn(|j| b[i * row + j * step]);
            for (j, at) in [[l, l, l], [l, l, h], [l, h, h], [h, h, h]].into_iter().enumerate() {
                b[i * row + j * step] = blossom(curve, at);
            }
        }
    }
}

/// Bounds on the lengths of the tangents along one direction, and on the change of them.
pub(crate) struct TangentBounds {
    pub least: f32,
    pub most: f32,
    pub change: f32,
}

/// What is not the Bezier patch that stands for it: how far points may be off, how far tangents over the shortest of them, and what the
/// products lose by it.
#[derive(Clone, Copy, Default)]
pub(crate) struct Deviation {
    pub position: f32,
    pub tangent: f32,
    pub product: f32,
}

/// Unit vectors along the 12 tangents at the Bezier points, and their bounds.
pub(crate) fn tangents_of(b: &[Vec3; 16], step: usize, row: usize) -> ([Vec3; 12], TangentBounds) {
    let (mut least, mut most) = (f32::MAX, 0.0_f32);
    let tangents = from_fn(|i| {
        let at = i / 3 * row + i % 3 * step;
        let tangent = sub(b[at + step], b[at]);
        let square = dot(tangent, tangent);
        least = least.min(square);
        most = most.max(square);
        over(tangent, square.max(f32::MIN_POSITIVE).sqrt())
    });
    let change = (0..8).fold(0.0_f32, |change, i| {
        let at = i / 2 * row + i % 2 * step;
        let bend = sub(sub(b[at + 2 * step], b[at + step]), sub(b[at + step], b[at]));
        change.max(dot(bend, bend))
    });
    (tangents, TangentBounds { least: 3.0 * least.sqrt(), most: 3.0 * most.sqrt(), change: 6.0 * change.sqrt() })
}

/// The x of the module's text.
fn slack_of(u: &TangentBounds, v: &TangentBounds, grain: &Grain, error: f32) -> f32 {
    let most = if grain.is_uneven { u.most.max(v.most) } else { 0.0 };
    let noise = (((2.0 * error) * grain.grain) * ((u.least + v.least) + most)) / (u.least * v.least);
    let turn = grain.skew * (u.change / v.least).max(v.change / u.least);
    (noise + noise * noise) + (turn + TURN_MARGIN)
}

/// What all points of a patch lie in: its middle, from the eye, and the square of its radius.
pub(crate) struct Ball {
    pub middle: Vec3,
    pub square_radius: f32,
}

impl Ball {
    /// Around points.
    pub fn new(middle: Vec3, points: &[Vec3], scale: &Scale) -> Self {
        let square = |&point: &Vec3| {
            let around = sub(sub(point, scale.eye), middle);
            dot(around, around)
        };
        Self { middle, square_radius: points.iter().map(square).fold(0.0, f32::max) }
    }
}

/// Whether triangles whose corners have at least this product of their place and unit tangents show their back.
pub(crate) fn exceeds_slack(
    product: f32,
    [u, v]: [&TangentBounds; 2],
    view: &EmitView,
    grain: &Grain,
    scale: &Scale,
    ball: &Ball,
    deviation: Deviation,
) -> bool {
    let radius = ball.square_radius.sqrt() + deviation.position;
    let farthest = dot(ball.middle, ball.middle).sqrt() + radius;
    let error = scale.rounding + farthest * view.snap;
    let slack = slack_of(u, v, grain, error) * (1.0 + deviation.tangent);
    product > ((radius + farthest * slack) + 2.0 * scale.eye_rounding) + deviation.product
}

/// The least product of a place and two unit tangents.
pub(crate) fn least_product(along_u: &[Vec3], along_v: &[Vec3], middle: Vec3) -> f32 {
    let across_v: Vec<Vec3> = along_v.iter().map(|&v| cross(v, middle)).collect();
    let products = along_u.iter().flat_map(|&u| across_v.iter().map(move |&v| dot(u, v)));
    products.fold(f32::MAX, f32::min)
}

/// Whether all triangles of a patch show their back, by its Bezier points, scaled.
fn is_patch_turned(b: &[Vec3; 16], view: &EmitView, grain: &Grain, scale: &Scale, ball: &Ball) -> bool {
    let (along_u, u) = tangents_of(b, 1, 4);
    let (along_v, v) = tangents_of(b, 4, 1);
    let product = least_product(&along_u, &along_v, ball.middle);
    exceeds_slack(product, [&u, &v], view, grain, scale, ball, Deviation::default())
}

/// Whether nothing of a bicubic patch can be seen, by its Bezier points times 36. `displacement` is how far its points may be
/// moved; such patches are seen from behind.
pub fn is_patch_unseen(b: &[Vec3; 16], view: &EmitView, grain: &Grain, cull_back: bool, displacement: f32) -> bool {
    let scale = Scale::new(view, 36.0, b);
    let margin = (36.0 * displacement) * scale.factor;
    let b = b.map(|point| times(point, scale.factor));
    let middle = sub(times(add(add(b[0], b[3]), add(b[12], b[15])), 0.25), scale.eye);
    let planes = b.iter().fold(31, |planes, &p| planes & outside_planes(sub(p, scale.eye), view, &scale, margin));
    let ball = Ball::new(middle, &b, &scale);
    let is_turned = || is_patch_turned(&b, view, grain, &scale, &ball);
    planes != 0 || (cull_back && displacement == 0.0 && is_turned())
}

fn is_triangle_turned([d0, d1, d2]: [Vec3; 3], error: f32, eye_rounding: f32) -> bool {
    let (a, b) = (sub(d1, d0), sub(d2, d0));
    let (a_length, b_length) = (dot(a, a).sqrt(), dot(b, b).sqrt());
    let area = a_length * b_length;
    let noise = TURN_MARGIN * area + (2.0 * error) * ((a_length + b_length) + 2.0 * error);
    let least = dot(d0, d0).sqrt() * noise + (2.0 * eye_rounding) * area;
    dot(d0, cross(a, b)) > least
}

/// Whether nothing can be seen of the triangles of a quad: 8 points, corners and the middles of split edges; where an edge is
/// not split the middle is a corner.
pub fn is_quad_unseen(
    points: &[Vec3; 8],
    split_edges: u32,
    view: &EmitView,
    cull_back: bool,
    displacement: f32,
) -> bool {
    let scale = Scale::new(view, 1.0, points);
    let margin = displacement * scale.factor;
    let p = points.map(|p| sub(times(p, scale.factor), scale.eye));
    let planes = p.iter().fold(31, |planes, &d| planes & outside_planes(d, view, &scale, margin));
    if !cull_back || displacement != 0.0 {
        return planes != 0;
    }
    let error = scale.error(view);
    let is_turned = |corners: [usize; 3]| is_triangle_turned(corners.map(|i| p[i]), error, scale.eye_rounding);
    if split_edges == 0 {
        return planes != 0 || [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]].into_iter().all(is_turned);
    }
    let fan = split_edges.trailing_zeros() as usize;
    let all_turned = (0..4).filter(|&i| i != fan).all(|i| {
        let next = (i + 1) % 4;
        if split_edges >> i & 1 != 0 {
            is_turned([4 + fan, i, 4 + i]) && is_turned([4 + fan, 4 + i, next])
        } else {
            is_turned([4 + fan, i, next])
        }
    });
    planes != 0 || all_turned
}

#[cfg(test)]
pub(crate) mod tests {
    use planish_subdiv::patch::evaluate;

    use super::*;

    /// A linear congruential generator's numbers between -1 and 1.
    pub(crate) struct Random(pub u64);

    impl Random {
        pub fn number(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        }

        pub fn part(&mut self) -> f64 {
            0.5 * self.number() + 0.5
        }

        /// Control points of a bent, sheared, uneven patch.
        fn patch(&mut self) -> [Vec3; 16] {
            let (bend, noise, shear) = (0.3 * self.number(), 0.15 * self.part(), 0.7 * self.number());
            from_fn(|i| {
                let (u, v) = ((i % 4) as f64 - 1.5, (i / 4) as f64 - 1.5);
                let height = bend * (u * u + shear * v * v);
                [u + shear * v, v, height].map(|c| (c + noise * self.number()) as f32)
            })
        }
    }

    /// A view of everything from `eye`, without a grid.
    pub(crate) fn view_from(eye: Vec3) -> EmitView {
        EmitView { eye, cull: 2, ..EmitView::default() }
    }

    fn is_unseen(points: &[Vec3; 16], eye: Vec3, grain: &Grain) -> bool {
        is_patch_unseen(&bezier_patch(points), &view_from(eye), grain, true, 0.0)
    }

    /// Patches that are turned away from an eye, and it.
    fn turned_away(grain: &Grain) -> Vec<([[f64; 3]; 16], [f64; 3])> {
        let mut random = Random(7);
        let mut found = Vec::new();
        for _ in 0..4000 {
            let points = random.patch();
            let eye = [6.0 * random.number(), 6.0 * random.number(), -4.0 * random.part()].map(|c| c as f32);
            if is_unseen(&points, eye, grain) {
                found.push((points.map(|p| p.map(f64::from)), eye.map(f64::from)));
            }
        }
        found
    }

    /// Whether a triangle shows its back, by parameters of its corners in counter-clockwise order; by how much.
    fn turn(patch: &[[f64; 3]; 16], eye: [f64; 3], corners: [[f64; 2]; 3]) -> f64 {
        turn_of(corners.map(|[u, v]| evaluate(patch, u, v).position), eye)
    }

    /// The same by its corners.
    pub(crate) fn turn_of([p, q, r]: [[f64; 3]; 3], eye: [f64; 3]) -> f64 {
        let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { from_fn(|c| a[c] - b[c]) };
        let (a, b, d) = (minus(q, p), minus(r, p), minus(p, eye));
        d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) + d[2] * (a[0] * b[1] - a[1] * b[0])
    }

    #[test]
    fn every_triangle_along_u_and_v_of_a_patch_that_is_turned_away_shows_its_back() {
        let found = turned_away(&Grain { grain: 1.0, reach: 0.0, skew: 0.0, is_uneven: false });
        assert!(found.len() > 400, "only {} patches are turned away", found.len());
        let mut random = Random(11);
        for (patch, eye) in &found {
            for _ in 0..200 {
                let [[u0, u1], [v0, v1]] = from_fn(|_| [random.part(), random.part()]);
                let corners = if (u1 - u0) * (v1 - v0) > 0.0 {
                    [[u0, v0], [u1, v0], [u0, v1]]
                } else {
                    [[u0, v0], [u0, v1], [u1, v0]]
                };
                assert!(turn(patch, *eye, corners) > 0.0, "{patch:?} from {eye:?}: {corners:?}");
            }
        }
    }

    #[test]
    fn every_triangle_of_an_uneven_ring_of_a_patch_that_is_turned_away_shows_its_back() {
        const SKEW: f64 = 1.5;
        let found = turned_away(&Grain { grain: 1.0, reach: 1.0, skew: SKEW as f32, is_uneven: true });
        assert!(found.len() > 100, "only {} patches are turned away", found.len());
        let mut random = Random(13);
        let mut tried = 0;
        for (patch, eye) in &found {
            for _ in 0..500 {
                // A base along one row, the tip on another that is near, as in the module's text.
                let (row, depth) = (0.1 + 0.8 * random.part(), 0.1 * random.part());
                let tip_row = row + if random.number() > 0.0 { depth } else { -depth };
                let [from, to, tip]: [f64; 3] = from_fn(|_| random.part());
                if from >= to || (tip - from).abs() * (tip - to).abs() / (2.0 * depth) > SKEW {
                    continue;
                }
                tried += 1;
                let is_above = tip_row > row;
                let ends = if is_above { [from, to] } else { [to, from] };
                let along_u = [[ends[0], row], [ends[1], row], [tip, tip_row]];
                assert!(turn(patch, *eye, along_u) > 0.0, "{patch:?} from {eye:?}: {along_u:?}");
                // Exchanging u and v turns the triangle over.
                let along_v = [[row, ends[1]], [row, ends[0]], [tip_row, tip]];
                assert!(turn(patch, *eye, along_v) > 0.0, "{patch:?} from {eye:?}: {along_v:?}");
            }
        }
        assert!(tried > 10_000, "only {tried} triangles");
    }

    #[test]
    fn what_cannot_be_computed_is_kept() {
        let grain = Grain { grain: 1.0, reach: 0.0, skew: 0.0, is_uneven: false };
        let flat: [Vec3; 16] = from_fn(|i| [(i % 4) as f32, (i / 4) as f32, 0.0]);
        assert!(is_unseen(&flat, [1.5, 1.5, -9.0], &grain));
        assert!(!is_unseen(&flat, [1.5, 1.5, 9.0], &grain));
        for scale in [1e-37, 1e-30, 1e30, 1e37] {
            let [eye] = [[1.5, 1.5, 9.0]].map(|eye| times(eye, scale));
            assert!(!is_unseen(&flat.map(|p| times(p, scale)), eye, &grain));
        }
        for bad in [f32::NAN, f32::INFINITY] {
            let mut points = flat;
            points[5][0] = bad;
            assert!(!is_unseen(&points, [1.5, 1.5, -9.0], &grain));
        }
        assert!(!is_unseen(&[[1.0; 3]; 16], [1.5, 1.5, -9.0], &grain));
        assert!(!is_quad_unseen(&[[1.0; 3]; 8], 0, &view_from([1.5, 1.5, -9.0]), true, 0.0));
    }
}
