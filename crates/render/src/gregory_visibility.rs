//! Whether nothing can be seen of a Gregory patch. CPU twin of `glsl/shared/gregory_visibility.glsl`, operation by operation.
//!
//! A Gregory patch is a Bezier patch whose face points move: that of a corner is `(a f+ + b f-) / (a + b)`, a and b being the
//! distances from the corner's two edges in parameters. That is the mean of f+ and f- plus w / 2 times g = f+ - f-, w = (a - b) / (a + b). So the
//! patch is the Bezier patch of the mean face points, the *mean patch*, plus
//!
//! > sum over the corners of E_k(u, v) g_k / 2, E_k = B_k w_k
//!
//! where B_k is the Bernstein polynomial of the face point, at the corner 9 a b or 12 a b. `a b (a - b) / (a + b)` has derivatives that go
//! to 0 there, and second ones that are bounded. All E_k are 0 on the patch's edges. Half the sum of their absolute values, and of those of
//! their derivatives, is bounded by (found on a grid; the test tries to exceed it)
//!
//! | | positions | along u or v | along u at v, over v (quads: over v (1 - v)) | second, along u at v >= 1/2 |
//! |---|---|---|---|---|
//! | quads | 0.0716 | 9/8, at u = 0, v = 1/2 | 9/2, at u = 0 | |
//! | thirds of triangles | 0.0707 | 0.528 | 1.4990 | 3.902 |
//!
//! Let u_i, v_j, U, V and R be the mean patch's in the text of [`crate::visibility`], G the largest |g_k|, and c the bound on
//! derivatives. Along u and v sides are e = r (S_u + a), f = t (S_v + b) where a and b are sums of g_k with weights of c together. Besides
//! the product of the mean patch there are those with a and b, which are linear in the u_i, v_j and g_k again. Those are known:
//! with Q_u the largest |m . (u_i x g_k)|, Q_v likewise, Q_g the largest |m . (g_k x g_l)|, each loses at most
//!
//! > c ((Q_u + R G) / V + (Q_v + R G) / U) + c^2 (Q_g + R G^2) / (U V)
//!
//! of the product over r t U V. It is not c G |m| (1 / U + 1 / V): seen at an angle both the product and what it loses are small. The slack x
//! grows by the factor 1 + c G (1 / U + 1 / V), as sides do.
//!
//! **Uneven rings.** A triangle between the edge v = 0, where the patch is the mean patch, and the row at t has a tip that is off by c t at
//! most, as above, and a base that is off by r 9/2 t; that times s S_u is `9/2 s (Q_u + R G) / V` more, where S_u may be as long as the
//! longest tangent and U as short as the shortest. Or else S'_u and S_u, of that row both, differ by twice 9/2 t at most: so that
//! it is twice as much if they are not known to be longer. s is the distance from the nearer end of the base, so s^2 is at most the product that
//! the skew is made of. Beside the edges of a third that lie inside of its triangle, where E_k is not 0, the second derivative bounds
//! the same as in that text: `s |r - s| / (2 t) 4 (Q_u + R G) / V` more.
//!
//! Second derivatives of quads are looked at in the same way: bends point along the normal, so that seen from right behind their products
//! with tangents are small, where |S_uu| alone would be most of the slack.
//!
//! **Thirds of triangles.** The third at corner a of a triangle a, b, c maps (u, v) bilinearly to barycentric coordinates, so that a line
//! along u is straight in the triangle: S_u at v is `(1 - v) D_b / 2 + v D_m / 6`, D_b being the derivative towards b, (-1, 1, 0), and D_m
//! that through the middle, (-1, 2, -1). Both have 10 Bezier vectors, times 4, and all S_u are means of these 20; so are all S_v of those with
//! b and c exchanged. Second derivatives along u are means of the changes of these vectors in the same two directions.
//!
//! **Edges.** Points on edges are the patch's own up to rounding: neighbours share curves, and a bicubic patch that decides there has the
//! same. Only one with a semi-sharp crease has another: the patches beside it are always drawn.

use std::array::from_fn;

use planish_shaders::EmitView;

use crate::factors::Grain;
use crate::visibility::{
    Ball, Deviation, Scale, TangentBounds, Vec3, add, cross, dot, exceeds_slack, least_product, outside_planes, over,
    sub, tangents_of, times,
};

// The constants of the shader, by the same names.
const QUAD_DEVIATION: DeviationBounds = DeviationBounds { position: 0.072, tangent: 1.125, row: 4.5, change: 0.0 };
const THIRD_DEVIATION: DeviationBounds = DeviationBounds { position: 0.071, tangent: 0.53, row: 1.5, change: 4.0 };
const MOST_SQUARE: f32 = 4.0;

fn mean(a: Vec3, b: Vec3) -> Vec3 {
    add(times(a, 0.5), times(b, 0.5))
}

fn near_corner(corner: Vec3, edge: Vec3) -> Vec3 {
    add(times(corner, 0.25), times(edge, 0.75))
}

/// The table of the module's text.
struct DeviationBounds {
    position: f32,
    tangent: f32,
    row: f32,
    change: f32,
}

/// What is known of the face points of a patch: how far those of a corner are apart, and the crosses of that with its middle.
struct Apart {
    across: [Vec3; 4],
    most: f32,
    product: f32,
}

impl Apart {
    fn new(p: &[Vec3], middle: Vec3) -> Self {
        let mut apart = [[0.0; 3]; 4];
        for (apart, corner) in apart.iter_mut().zip(p.chunks_exact(5)) {
            *apart = sub(corner[3], corner[4]);
        }
        let across = apart.map(|apart| cross(apart, middle));
        let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (j, i)));
        let product = pairs.fold(0.0_f32, |most, (j, i)| most.max(dot(apart[j], across[i]).abs()));
        let square = apart.iter().fold(0.0_f32, |most, &apart| most.max(dot(apart, apart)));
        Self { across, most: square.sqrt(), product }
    }

    fn tangent_product(&self, tangents: &[Vec3]) -> f32 {
        let products = tangents.iter().flat_map(|&tangent| self.across.map(|across| dot(tangent, across).abs()));
        products.fold(0.0, f32::max)
    }

    fn deviation(
        &self,
        bounds: &DeviationBounds,
        [u, v]: [&TangentBounds; 2],
        [along_u, along_v]: [&[Vec3]; 2],
        grain: &Grain,
        scale: &Scale,
        ball: &Ball,
    ) -> Deviation {
        let (u_product, v_product) = (self.tangent_product(along_u), self.tangent_product(along_v));
        let position = bounds.position * self.most;
        let spread = (ball.square_radius.sqrt() + position) + 2.0 * scale.eye_rounding;
        let area = u.least * v.least;
        let tangent = ((bounds.tangent * self.most) * (u.least + v.least)) / area;
        let of_u = (u_product + spread * self.most) / v.least;
        let of_v = (v_product + spread * self.most) / u.least;
        let both = (self.product + (spread * self.most) * self.most) / area;
        let (turn, slide) = (bounds.change * grain.skew, bounds.row * grain.reach);
        let u_turn = turn.max(slide * (u.most / u.least).min(2.0));
        let v_turn = turn.max(slide * (v.most / v.least).min(2.0));
        let linear = bounds.tangent * (of_u + of_v) + (u_turn * of_u).max(v_turn * of_v);
        let square = bounds.tangent * (bounds.tangent + u_turn.max(v_turn));
        Deviation { position, tangent, product: linear + square * both }
    }
}

/// The bicubic patch of a quad's mean face points.
fn mean_quad(p: &[Vec3]) -> [Vec3; 16] {
    let face = |corner: usize| mean(p[5 * corner + 3], p[5 * corner + 4]);
    [
        [p[0], p[1], p[7], p[5]],
        [p[2], face(0), face(1), p[6]],
        [p[16], face(3), face(2), p[12]],
        [p[15], p[17], p[11], p[10]],
    ]
    .concat()
    .try_into()
    .unwrap_or([[0.0; 3]; 16])
}

/// The largest product of the middle, a unit tangent and a second derivative in the same direction.
fn bend_product(b: &[Vec3; 16], [step, row]: [usize; 2], along: &[Vec3; 12], middle: Vec3) -> f32 {
    let products = (0..8).flat_map(|i| {
        let at = i / 2 * row + i % 2 * step;
        let bend = sub(sub(b[at + 2 * step], b[at + step]), sub(b[at + step], b[at]));
        let across = cross(bend, middle);
        along.iter().map(move |&tangent| dot(tangent, across).abs())
    });
    6.0 * products.fold(0.0, f32::max)
}

fn is_quad_turned(p: &[Vec3], view: &EmitView, grain: &Grain, scale: &Scale) -> bool {
    let b = mean_quad(p);
    let middle = sub(times(add(add(b[0], b[3]), add(b[12], b[15])), 0.25), scale.eye);
    let (along_u, u) = tangents_of(&b, 1, 4);
    let (along_v, v) = tangents_of(&b, 4, 1);
    let ball = Ball::new(middle, &b, scale);
    let (bounds, tangents) = ([&u, &v], [&along_u[..], &along_v[..]]);
    let mut deviation = Apart::new(p, middle).deviation(&QUAD_DEVIATION, bounds, tangents, grain, scale, &ball);
    let u_bend = bend_product(&b, [1, 4], &along_u, middle);
    let v_bend = bend_product(&b, [4, 1], &along_v, middle);
    let spread = (ball.square_radius.sqrt() + deviation.position) + 2.0 * scale.eye_rounding;
    let rest = spread + (dot(middle, middle).sqrt() + spread) * deviation.tangent;
    let bend = ((u_bend + rest * u.change) / v.least).max((v_bend + rest * v.change) / u.least);
    deviation.product += grain.skew * bend;
    let grain = Grain { skew: 0.0, ..*grain };
    exceeds_slack(least_product(&along_u, &along_v, middle), bounds, view, &grain, scale, &ball, deviation)
}

/// Place in a triangular net of Bezier points of a degree, by the exponents of the second and the third corner's coordinate.
fn net_place(degree: usize, second: usize, third: usize) -> usize {
    third * (2 * degree + 3 - third) / 2 + second
}

/// The places of a net.
fn places(degree: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..=degree).flat_map(move |third| (0..=degree - third).map(move |second| [second, third]))
}

/// At a place of a net, the points of the net of one degree more: of its first, second and third corner.
fn neighbours(net: &[Vec3], degree: usize, [second, third]: [usize; 2]) -> [Vec3; 3] {
    [[0, 0], [1, 0], [0, 1]].map(|[a, b]| net[net_place(degree + 1, second + a, third + b)])
}

/// Changes along D_b / 2 and D_m / 6 of the module's text.
fn changes([own, towards, other]: [Vec3; 3]) -> [Vec3; 2] {
    let to_own = sub(towards, own);
    [times(to_own, 0.5), over(add(to_own, sub(towards, other)), 6.0)]
}

/// The quartic triangle of mean face points.
fn mean_triangle(p: &[Vec3]) -> [Vec3; 15] {
    let face = |corner: usize| mean(p[5 * corner + 3], p[5 * corner + 4]);
    [
        p[0],
        near_corner(p[0], p[1]),
        mean(p[1], p[7]),
        near_corner(p[5], p[7]),
        p[5],
        near_corner(p[0], p[2]),
        face(0),
        face(1),
        near_corner(p[5], p[6]),
        mean(p[2], p[11]),
        face(2),
        mean(p[6], p[12]),
        near_corner(p[10], p[11]),
        near_corner(p[10], p[12]),
        p[10],
    ]
}

/// Unit vectors along the tangents of the third at the first corner, along u or v, and their bounds.
fn third_tangents(net: &[Vec3; 15], is_u: bool) -> ([Vec3; 20], TangentBounds) {
    let turned = |[own, second, third]: [Vec3; 3]| if is_u { [own, second, third] } else { [own, third, second] };
    let mut tangents = [[0.0; 3]; 20];
    for (i, place) in places(3).enumerate() {
        [tangents[i], tangents[10 + i]] = changes(turned(neighbours(net, 3, place)));
    }
    let of_half = |half: usize| {
        let half = &tangents[10 * half..][..10];
        places(2).flat_map(move |place| changes(turned(neighbours(half, 2, place))))
    };
    let change = of_half(0).chain(of_half(1)).fold(0.0_f32, |change, bend| change.max(dot(bend, bend)));
    let squares = tangents.map(|tangent| dot(tangent, tangent));
    let (least, most) = (squares.iter().copied().fold(f32::MAX, f32::min), squares.iter().copied().fold(0.0, f32::max));
    let units = from_fn(|i| over(tangents[i], squares[i].max(f32::MIN_POSITIVE).sqrt()));
    (units, TangentBounds { least: 4.0 * least.sqrt(), most: 4.0 * most.sqrt(), change: 12.0 * change.sqrt() })
}

fn is_third_turned(p: &[Vec3], view: &EmitView, grain: &Grain, scale: &Scale) -> bool {
    let net = mean_triangle(p);
    let middle = sub(over(add(add(p[0], p[5]), p[10]), 3.0), scale.eye);
    let (along_u, u) = third_tangents(&net, true);
    let (along_v, v) = third_tangents(&net, false);
    let product = least_product(&along_u, &along_v, middle);
    let ball = Ball::new(middle, &net, scale);
    let (bounds, tangents) = ([&u, &v], [&along_u[..], &along_v[..]]);
    let deviation = Apart::new(p, middle).deviation(&THIRD_DEVIATION, bounds, tangents, grain, scale, &ball);
    exceeds_slack(product, bounds, view, grain, scale, &ball, deviation)
}

/// Whether an offset from the eye is a number: components of scaled ones are at most 1.
fn is_computed(offset: Vec3) -> bool {
    dot(offset, offset) < MOST_SQUARE
}

/// Whether nothing of a Gregory patch can be seen, by the 20 control points of a quad, or the 15 of a triangle from the corner of the third
/// on. `displacement` is how far its points may be moved; such patches are seen from behind.
pub fn is_gregory_unseen(
    points: &[[f32; 3]],
    view: &EmitView,
    grain: &Grain,
    cull_back: bool,
    displacement: f32,
) -> bool {
    let scale = Scale::new(view, 1.0, points);
    let margin = displacement * scale.factor;
    let p: Vec<Vec3> = points.iter().map(|&point| times(point, scale.factor)).collect();
    let planes = p.iter().fold(31, |planes, &p| planes & outside_planes(sub(p, scale.eye), view, &scale, margin));
    let is_tested = cull_back && displacement == 0.0 && p.iter().all(|&p| is_computed(sub(p, scale.eye)));
    let is_turned = if points.len() == 20 { is_quad_turned } else { is_third_turned };
    planes != 0 || (is_tested && is_turned(&p, view, grain, &scale))
}

#[cfg(test)]
mod tests {
    use planish_subdiv::gregory::{Normals, evaluate_quad, evaluate_triangle, part_barycentric};

    use super::*;
    use crate::visibility::tests::{Random, turn_of, view_from};

    type Point = [f64; 3];

    /// A quad, or the third of a triangle at its first corner.
    fn position(points: &[Point], [u, v]: [f64; 2]) -> Point {
        if points.len() == 20 {
            return evaluate_quad(points, u, v, Normals::Exact).position;
        }
        evaluate_triangle(points, part_barycentric(0, u, v), Normals::Exact).position
    }

    fn length(a: Point) -> f64 {
        a.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    /// Control points of a sheared patch, flat or bent and uneven, whose face points are off by `apart`.
    fn patch(random: &mut Random, corners: usize, is_flat: bool, apart: f64) -> Vec<Point> {
        let (bend, noise, shear) = (0.3 * random.number(), 0.1 * random.part(), 0.5 * random.number());
        let (bend, noise) = if is_flat { (0.0, 0.0) } else { (bend, noise) };
        let seats: &[[f64; 2]] = match corners {
            4 => &[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]],
            _ => &[[0.0, 0.0], [3.0, 0.0], [1.5, 2.6]],
        };
        let mut points = Vec::new();
        for i in 0..corners {
            let [p, next, previous] = [i, (i + 1) % corners, (i + corners - 1) % corners].map(|i| seats[i]);
            let part = if corners == 4 { 3.0 } else { 4.0 };
            let step = |a: f64, b: f64, part: f64| {
                from_fn::<f64, 2, _>(|c| p[c] + (a * (next[c] - p[c]) + b * (previous[c] - p[c])) / part)
            };
            let flat = [p, step(1.0, 0.0, 3.0), step(0.0, 1.0, 3.0), step(1.0, 1.0, part), step(1.0, 1.0, part)];
            for (j, [x, y]) in flat.into_iter().enumerate() {
                let height = bend * ((x - 1.5).powi(2) + shear * (y - 1.5).powi(2));
                let noise = if j < 3 { noise } else { noise + apart };
                points.push([x + shear * y, y, height].map(|c| c + noise * random.number()));
            }
        }
        points
    }

    /// What is added to the mean patch: its face points are h and -h.
    fn deviating(random: &mut Random, corners: usize) -> Vec<Point> {
        let is_along_one = random.number() > 0.0;
        let corner = |random: &mut Random| {
            let h = if is_along_one { [random.number().signum(), 0.0, 0.0] } else { from_fn(|_| random.number()) };
            let half = 0.5 / length(h);
            [[0.0; 3], [0.0; 3], [0.0; 3], h.map(|c| c * half), h.map(|c| -c * half)]
        };
        (0..corners).flat_map(|_| corner(random)).collect()
    }

    #[test]
    fn a_gregory_patch_is_off_that_of_its_mean_face_points_by_no_more_than_its_deviation() {
        let mut random = Random(3);
        for (corners, bounds) in [(4, QUAD_DEVIATION), (3, THIRD_DEVIATION)] {
            let mut most = [0.0_f64; 4];
            for _ in 0..4000 {
                let points = deviating(&mut random, corners);
                for i in 0..60 {
                    // Many beside edges and in the middle, where the sums are largest.
                    let step = 0.02 * random.part() + 1e-4;
                    let along = if i % 3 == 0 { 0.0 } else { (1.0 - 2.0 * step) * random.part() };
                    let across = [0.02 * random.part(), 0.5 + 0.01 * random.part(), random.part()][i % 4 % 3];
                    let at = |k: f64| {
                        let place = [along + k * step, across];
                        position(&points, if i % 2 == 0 { place } else { [place[1], place[0]] })
                    };
                    let [a, b, c] = [at(0.0), at(1.0), at(2.0)];
                    let first = length(from_fn(|k| b[k] - a[k])) / step;
                    let second = length(from_fn(|k| c[k] - 2.0 * b[k] + a[k])) / (step * step);
                    let change = if corners == 3 && across >= 0.5 { second } else { 0.0 };
                    let from_edge = if corners == 4 { across * (1.0 - across) } else { across };
                    let found = [length(a), first, first / from_edge, change];
                    most = from_fn(|i| most[i].max(found[i]));
                }
            }
            let DeviationBounds { position, tangent, row, change } = bounds;
            for (found, bound) in most.into_iter().zip([position, tangent, row, change].map(f64::from)) {
                assert!((0.85 * bound..=bound).contains(&found), "{corners} corners: {most:?}, not {bound}");
            }
        }
    }

    /// Patches that are turned away from an eye, and it.
    fn turned_away(corners: usize, grain: &Grain) -> Vec<(Vec<Point>, Point)> {
        let mut random = Random(7);
        let mut found = Vec::new();
        for i in 0..4000 {
            let points = patch(&mut random, corners, i % 2 == 0, [1.5, 0.0, 0.8, 0.05, 0.4, 0.15, 0.2, 0.4][i % 8]);
            // From afar too, where the patch's size does not matter, and at all angles.
            let distance = [1.0, 20.0][i / 8 % 2];
            let eye = [9.0 * random.number(), 9.0 * random.number(), -1.0 - 8.0 * random.part()].map(|c| distance * c);
            let single: Vec<Vec3> = points.iter().map(|p| p.map(|c| c as f32)).collect();
            if is_gregory_unseen(&single, &view_from(eye.map(|c| c as f32)), grain, true, 0.0) {
                found.push((points, eye));
            }
        }
        found
    }

    #[test]
    fn every_triangle_along_u_and_v_of_a_patch_that_is_turned_away_shows_its_back() {
        for (corners, least) in [(4, 300), (3, 150)] {
            let found = turned_away(corners, &Grain { grain: 1.0, reach: 0.0, skew: 0.0, is_uneven: false });
            assert!(found.len() > least, "only {} patches of {corners} corners are turned away", found.len());
            let mut random = Random(11);
            for (patch, eye) in &found {
                for i in 0..300 {
                    // Small ones see more of what the patch is off at a place, most at the edges.
                    let mut side = || match i % 3 {
                        0 => [random.part(), random.part()],
                        _ => {
                            let from = 0.98 * random.part();
                            [from, from + 0.02]
                        }
                    };
                    let (mut u, v) = (side(), side());
                    if i % 3 == 2 {
                        u = if i % 2 == 0 { [0.0, 0.02] } else { [0.98, 1.0] };
                    }
                    let [[u0, u1], [v0, v1]] = if i % 4 < 2 { [u, v] } else { [v, u] };
                    let mut triangle = [[u0, v0], [u1, v0], [u0, v1]];
                    if (u1 - u0) * (v1 - v0) < 0.0 {
                        triangle.swap(1, 2);
                    }
                    let turn = turn_of(triangle.map(|place| position(patch, place)), *eye);
                    assert!(turn > 0.0, "{patch:?} from {eye:?}: {triangle:?}");
                }
            }
        }
    }

    #[test]
    fn every_triangle_of_an_uneven_ring_of_a_patch_that_is_turned_away_shows_its_back() {
        const SKEW: f64 = 0.3;
        for (corners, least) in [(4, 30), (3, 20)] {
            let found = turned_away(corners, &Grain { grain: 1.0, reach: 1.0, skew: SKEW as f32, is_uneven: true });
            assert!(found.len() > least, "only {} patches of {corners} corners are turned away", found.len());
            let (mut random, mut tried) = (Random(13), 0);
            for (patch, eye) in &found {
                for _ in 0..500 {
                    // Between an edge and the row beside it, the base on either.
                    let depth = 0.2 * random.part();
                    let mut rows = [0.0, depth];
                    if random.number() > 0.0 {
                        rows.reverse();
                    }
                    let [row, tip_row] = if random.number() > 0.0 { rows } else { rows.map(|row| 1.0 - row) };
                    let [from, to, tip]: [f64; 3] = from_fn(|_| random.part());
                    if from >= to || (tip - from).abs() * (tip - to).abs() / (2.0 * depth) > SKEW {
                        continue;
                    }
                    tried += 1;
                    let ends = if tip_row > row { [from, to] } else { [to, from] };
                    let along_u = [[ends[0], row], [ends[1], row], [tip, tip_row]];
                    // Exchanging u and v turns the triangle over.
                    let along_v = [[row, ends[1]], [row, ends[0]], [tip_row, tip]];
                    for triangle in [along_u, along_v] {
                        let turn = turn_of(triangle.map(|place| position(patch, place)), *eye);
                        assert!(turn > 0.0, "{patch:?} from {eye:?}: {triangle:?}");
                    }
                }
            }
            assert!(tried > 2000, "only {tried} triangles of {corners} corners");
        }
    }

    #[test]
    fn what_cannot_be_computed_is_kept() {
        let grain = Grain { grain: 1.0, reach: 0.0, skew: 0.0, is_uneven: false };
        for corners in [3, 4] {
            let flat: Vec<Vec3> = patch(&mut Random(1), corners, true, 0.0)
                .into_iter()
                .map(|[x, y, _]| [x as f32, y as f32, 0.0])
                .collect();
            let is_unseen = |points: &[Vec3], eye: Vec3| is_gregory_unseen(points, &view_from(eye), &grain, true, 0.0);
            assert!(is_unseen(&flat, [1.5, 1.5, -9.0]));
            assert!(!is_unseen(&flat, [1.5, 1.5, 9.0]));
            assert!(!is_gregory_unseen(&flat, &view_from([1.5, 1.5, -9.0]), &grain, true, 0.1));
            for bad in [f32::NAN, f32::INFINITY] {
                for place in 0..flat.len() {
                    let mut points = flat.clone();
                    points[place][0] = bad;
                    assert!(!is_unseen(&points, [1.5, 1.5, -9.0]), "{bad} at {place}");
                }
            }
            assert!(!is_unseen(&vec![[1.0; 3]; 5 * corners], [1.5, 1.5, -9.0]));
        }
    }
}
