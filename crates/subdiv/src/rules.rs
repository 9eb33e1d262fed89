//! Catmull-Clark's masks: weights only, no topology.
//!
//! Refinement masks are FAS section 3.1 with the face points substituted, so that every weight is one of the level
//! before. Sharpness: DeRose, Kass and Truong 1998, in OpenSubdiv's reading: where rules change from one level to the
//! next, the old and the new one are blended by the sharpness that reached zero. Limit masks: Halstead, Kass and DeRose
//! 1993 (smooth vertices), derived here (boundary tangents), Biermann, Levin and Zorin 2000 (tangents at corners).

use std::f64::consts::PI;

use crate::mesh::{Creasing, INFINITE_SHARPNESS, TriangleSubdivision};

/// Weights of a smooth vertex of valence n whose faces are all quads, for refinement or for its limit position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexMask {
    /// Weight of the vertex itself.
    pub vertex: f64,
    /// Weight of each of the n vertices at the other end of an incident edge.
    pub edge: f64,
    /// Weight of each of the n vertices opposite in an incident face.
    pub face: f64,
}

/// Weight of each end of an interior edge between two quads: (v + e + f + f) / 4 with the face points substituted.
pub const EDGE_END: f64 = 3.0 / 8.0;
/// Weight of each of the other four vertices of the two quads at an interior edge.
pub const EDGE_FAR: f64 = 1.0 / 16.0;
/// Weight of each neighbour along a boundary or crease in the vertex rule.
pub const CREASE_END: f64 = 1.0 / 8.0;
/// Weight of each neighbour along a boundary or crease in the limit position.
pub const CREASE_LIMIT_END: f64 = 1.0 / 6.0;

/// Vertex rule of a smooth vertex: (n-2)/n v + 1/n^2 sum e + 1/n^2 sum f (FAS 3.1), face points substituted.
pub fn smooth_vertex(valence: u32) -> VertexMask {
    let n = f64::from(valence);
    VertexMask { vertex: (n - 2.0) / n + 0.25 / n, edge: 1.5 / (n * n), face: 0.25 / (n * n) }
}

/// Limit position of a smooth vertex: (n^2 v + 4 sum e + sum f) / (n (n + 5)) (Halstead et al. 1993).
pub fn smooth_limit(valence: u32) -> VertexMask {
    let n = f64::from(valence);
    let denominator = n * (n + 5.0);
    VertexMask { vertex: n / (n + 5.0), edge: 4.0 / denominator, face: 1.0 / denominator }
}

/// Tangent weights of edge i and of the face between the edges i and i + 1, counter-clockwise, at a smooth vertex.
///
/// The two tangents are the left eigenvectors of the subdominant eigenvalue; their cross product is the outward normal.
/// A valence of 2 has no subdominant pair: all three next eigenvalues are of magnitude 1/4, so the surface has no
/// tangent plane there in general; the edges' and the faces' differences are the useful answer.
/// Returns `([edge for t1, t2], [face for t1, t2])`.
pub fn smooth_tangents(valence: u32, i: u32) -> ([f64; 2], [f64; 2]) {
    if valence == 2 {
        let sign = if i == 0 { 1.0 } else { -1.0 };
        return ([sign, 0.0], [0.0, sign]);
    }
    let n = f64::from(valence);
    let angle = |k: u32| 2.0 * PI * f64::from(k % valence) / n;
    let a = 1.0 + angle(1).cos() + (PI / n).cos() * (2.0 * (9.0 + angle(1).cos())).sqrt();
    let (s0, c0) = angle(i).sin_cos();
    let (s1, c1) = angle(i + 1).sin_cos();
    ([a * c0, a * s0], [c0 + c1, s0 + s1])
}

/// Rule of a vertex (DeRose et al. 1998).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexRule {
    /// No sharp edge.
    Smooth,
    /// One sharp edge: a crease ends here. The smooth rule.
    Dart,
    /// Two sharp edges.
    Crease,
    /// Sharp itself, or more than two sharp edges.
    Corner,
}

/// The rule of a vertex of this sharpness with so many edges of sharpness above zero.
pub fn vertex_rule(sharpness: f32, sharp_edge_count: usize) -> VertexRule {
    match sharp_edge_count {
        _ if sharpness > 0.0 => VertexRule::Corner,
        0 => VertexRule::Smooth,
        1 => VertexRule::Dart,
        2 => VertexRule::Crease,
        _ => VertexRule::Corner,
    }
}

/// Whether a sharpness changes from level to level.
pub fn is_semi_sharp(sharpness: f32) -> bool {
    sharpness > 0.0 && sharpness < INFINITE_SHARPNESS
}

/// Sharpness one level down by the uniform rule: less by one, not below zero; infinite stays infinite.
pub fn less_sharp(sharpness: f32) -> f32 {
    if sharpness >= INFINITE_SHARPNESS { INFINITE_SHARPNESS } else { (sharpness - 1.0).max(0.0) }
}

/// Semi-sharp edges at a vertex, or some of them: the sum of their sharpness, and how many they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SemiSharpEdges {
    /// Sum of their sharpness.
    pub sum: f64,
    /// Their number.
    pub count: u32,
}

impl SemiSharpEdges {
    /// Adds an edge, if it is one.
    pub fn add(&mut self, sharpness: f32) {
        if is_semi_sharp(sharpness) {
            self.sum += f64::from(sharpness);
            self.count += 1;
        }
    }

    /// Those of some edges.
    pub fn of(edges: &[f32]) -> Self {
        let mut all = Self::default();
        edges.iter().for_each(|&sharpness| all.add(sharpness));
        all
    }

    /// All but an edge of this sharpness.
    #[must_use]
    pub fn without(self, sharpness: f32) -> Self {
        if !is_semi_sharp(sharpness) {
            return self;
        }
        Self { sum: self.sum - f64::from(sharpness), count: self.count.saturating_sub(1) }
    }
}

/// Sharpness of the child at one end of an edge, by that of the other edges at that end, of which Chaikin's rule averages
/// the semi-sharp ones (DeRose et al. 1998, section 5).
pub fn child_edge_sharpness(creasing: Creasing, sharpness: f32, others: SemiSharpEdges) -> f32 {
    if creasing == Creasing::Uniform || !is_semi_sharp(sharpness) || others.count == 0 {
        return less_sharp(sharpness);
    }
    let average = others.sum / f64::from(others.count);
    (0.75 * f64::from(sharpness) + 0.25 * average - 1.0).max(0.0) as f32
}

/// The rule of a vertex in one refinement step: `weight` times the rule that its sharpness asks for at the level before,
/// and the rest of the rule at the level after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexBlend {
    /// Rule by the sharpness before the step, and where it is a crease the two sharp edges.
    pub before: (VertexRule, [usize; 2]),
    /// Rule by the sharpness after the step, likewise.
    pub after: (VertexRule, [usize; 2]),
    /// Weight of the rule before.
    pub weight: f64,
}

impl VertexBlend {
    /// The blend for a vertex whose sharpness and whose edges' sharpness go from the first to the second of each pair.
    pub fn new(vertex: [f32; 2], edges: [&[f32]; 2]) -> Self {
        let rule = |step: usize| {
            let mut sharp = (0..).zip(edges[step]).filter(|&(_, &s)| s > 0.0).map(|(i, _)| i);
            let ends = [sharp.next().unwrap_or(0), sharp.next().unwrap_or(0)];
            let count = edges[step].iter().filter(|&&s| s > 0.0).count();
            (vertex_rule(vertex[step], count), ends)
        };
        let (before, after) = (rule(0), rule(1));
        if before.0 == after.0 || matches!(before.0, VertexRule::Smooth | VertexRule::Dart) {
            return Self { before, after: before, weight: 1.0 };
        }
        Self { before, after, weight: fractional_weight(vertex, edges) }
    }
}

/// Weight of the rule before a step in which sharpness goes from the first to the second of each pair: the average of
/// those that reach zero, at most 1.
pub(crate) fn fractional_weight(vertex: [f32; 2], edges: [&[f32]; 2]) -> f64 {
    let pairs = edges[0].iter().zip(edges[1]).chain(std::iter::once((&vertex[0], &vertex[1])));
    let (sum, count) = pairs
        .filter(|&(&before, &after)| before > 0.0 && after <= 0.0)
        .fold((0.0_f32, 0.0_f32), |(sum, count), (&before, _)| (sum + before, count + 1.0));
    let weight = if count == 0.0 { 0.0 } else { (sum / count).min(1.0) };
    f64::from(weight)
}

/// Weight of the crease rule (the middle of the edge) for an edge of this sharpness whose children at its two ends have
/// those; the rest is the smooth rule's. As in OpenSubdiv it is not held below 1 where Chaikin's rule lets an edge
/// sharper than 1 become smooth.
pub fn edge_crease_weight(sharpness: f32, children: [f32; 2]) -> f64 {
    if sharpness <= 0.0 {
        0.0
    } else if children.iter().all(|&child| child > 0.0) {
        1.0
    } else {
        f64::from(sharpness)
    }
}

/// OpenSubdiv's weight of the centre of a triangle in the rule of its edges, where smooth triangles are asked for
/// (Stam and Loop 2003 give the reason, OpenSubdiv the number).
pub const SMOOTH_TRIANGLE_EDGE_FACE: f64 = 0.470;

/// Weight of each face's centre in the rule of a smooth edge between faces of these numbers of sides; the ends share the
/// rest.
pub fn edge_face_weight(triangles: TriangleSubdivision, sides: [u32; 2]) -> f64 {
    let smooth = triangles == TriangleSubdivision::Smooth;
    let of = |sides: u32| if smooth && sides == 3 { SMOOTH_TRIANGLE_EDGE_FACE } else { 0.25 };
    0.5 * (of(sides[0]) + of(sides[1]))
}

/// Weights of the tangent across a boundary or crease with `face_count` faces on this side.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryTangent {
    face_count: u32,
    vertex: f64,
    /// Of the two edges along the boundary.
    end: f64,
    /// Of an edge inside, before the sine of its angle.
    inner_edge: f64,
    /// Of an opposite vertex, before the sum of the sines of its face's edges.
    face: f64,
}

impl BoundaryTangent {
    /// At a vertex of the crease rule: the left eigenvector of the largest eigenvalue below 1 that has weights inside. So it
    /// is the same tangent at every level. Biermann et al. 2000 give that of their own rules instead, which agrees with
    /// Catmull-Clark's for two faces.
    ///
    /// With t = pi / `face_count`: inside it has the sines of a closed ring's ([`smooth_tangents`]) and its eigenvalue
    /// l = (cos t + 5 + sqrt((cos t + 9) (cos t + 1))) / 16; the columns of the boundary's edges and of the vertex,
    /// (l - 1/2) x - y / 8 = l sin t and (l - 3/4) y - x = (6 l - 1) cot(t / 2), give the rest.
    pub fn new(face_count: u32) -> Self {
        if face_count == 1 {
            return Self { face_count, vertex: -2.0, end: 1.0, inner_edge: 0.0, face: 0.0 };
        }
        let theta = PI / f64::from(face_count);
        let (sin, cos) = theta.sin_cos();
        let scale = 1.0 / (f64::from(face_count) * (3.0 + cos));
        let value = (cos + 5.0 + ((cos + 9.0) * (cos + 1.0)).sqrt()) / 16.0;
        let determinant = (value - 1.0) * (value - 0.25);
        let (of_end, of_vertex) = (value * sin, (6.0 * value - 1.0) / (0.5 * theta).tan());
        Self {
            face_count,
            vertex: scale * ((value - 0.5) * of_vertex + of_end) / determinant,
            end: scale * ((value - 0.75) * of_end + 0.125 * of_vertex) / determinant,
            inner_edge: scale * (16.0 * value - 4.0),
            face: scale,
        }
    }

    /// At an interpolated vertex (Biermann et al. 2000, appendix). With several faces there is no tangent plane in general.
    pub fn at_corner(face_count: u32) -> Self {
        if face_count == 1 {
            return Self::new(1);
        }
        let (sin, cos) = (PI / f64::from(face_count)).sin_cos();
        let scale = 1.0 / (f64::from(face_count) * (3.0 + cos));
        Self {
            face_count,
            vertex: scale * 4.0 * (cos + 1.0) / sin * (cos - 1.0),
            end: -scale * (cos + 1.0) / sin * (1.0 + 2.0 * cos),
            inner_edge: 4.0 * scale,
            face: scale,
        }
    }

    /// Weight of the vertex itself.
    pub fn vertex(&self) -> f64 {
        self.vertex
    }

    /// Weight of edge i of 0..=`face_count`; the first and the last are the boundary's.
    pub fn edge(&self, i: u32) -> f64 {
        if i == 0 || i == self.face_count { self.end } else { self.inner_edge * self.sine(i) }
    }

    /// Weight of the vertex opposite in face i, between the edges i and i + 1.
    pub fn face(&self, i: u32) -> f64 {
        self.face * (self.sine(i) + self.sine(i + 1))
    }

    fn sine(&self, i: u32) -> f64 {
        (PI * f64::from(i) / f64::from(self.face_count)).sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One refinement step around a smooth vertex of valence n: the rows of (v, e.., f..).
    fn subdivision_matrix(n: usize) -> Vec<Vec<f64>> {
        let mask = smooth_vertex(n as u32);
        let size = 2 * n + 1;
        let mut rows = vec![vec![0.0; size]; size];
        rows[0][0] = mask.vertex;
        for i in 0..n {
            let (edge, face) = (1 + i, 1 + n + i);
            let (next, previous) = ((i + 1) % n, (i + n - 1) % n);
            rows[0][edge] += mask.edge;
            rows[0][face] += mask.face;
            rows[edge][0] += EDGE_END;
            rows[edge][edge] += EDGE_END;
            for far in [1 + next, 1 + previous, face, 1 + n + previous] {
                rows[edge][far] += EDGE_FAR;
            }
            for corner in [0, edge, 1 + next, face] {
                rows[face][corner] += 0.25;
            }
        }
        rows
    }

    fn left_multiply(weights: &[f64], rows: &[Vec<f64>]) -> Vec<f64> {
        (0..weights.len()).map(|j| weights.iter().zip(rows).map(|(w, row)| w * row[j]).sum()).collect()
    }

    #[test]
    fn limit_mask_is_the_left_eigenvector_of_one() {
        for n in [2_usize, 3, 4, 5, 7, 40, 400] {
            let mask = smooth_limit(n as u32);
            let mut weights = vec![mask.vertex];
            weights.extend(vec![mask.edge; n]);
            weights.extend(vec![mask.face; n]);
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (a, b) in weights.iter().zip(left_multiply(&weights, &subdivision_matrix(n))) {
                assert!((a - b).abs() < 1e-12, "valence {n}: {a} became {b}");
            }
        }
    }

    #[test]
    fn tangent_masks_are_left_eigenvectors_of_the_subdominant_eigenvalue() {
        for n in [3_usize, 4, 5, 7, 40, 400] {
            let c = (2.0 * PI / n as f64).cos();
            let eigenvalue = (c + 5.0 + ((c + 9.0) * (c + 1.0)).sqrt()) / 16.0;
            for axis in 0..2 {
                let mut weights = vec![0.0];
                weights.extend((0..n).map(|i| smooth_tangents(n as u32, i as u32).0[axis]));
                weights.extend((0..n).map(|i| smooth_tangents(n as u32, i as u32).1[axis]));
                for (a, b) in weights.iter().zip(left_multiply(&weights, &subdivision_matrix(n))) {
                    assert!((a * eigenvalue - b).abs() < 1e-12, "valence {n}: {a} became {b}");
                }
            }
        }
    }

    #[test]
    fn regular_boundary_tangent_is_the_spline_derivative() {
        let mask = BoundaryTangent::new(2);
        let expected = [-4.0, -1.0, 4.0, -1.0, 1.0, 1.0].map(|w| w / 6.0);
        let got = [mask.vertex(), mask.edge(0), mask.edge(1), mask.edge(2), mask.face(0), mask.face(1)];
        for (a, b) in expected.iter().zip(got) {
            assert!((a - b).abs() < 1e-15);
        }
    }

    #[test]
    fn boundary_tangent_masks_are_left_eigenvectors() {
        for n in [2_usize, 3, 4, 5, 12, 40] {
            // The vertex, the edges from the first to the last, the faces.
            let (size, edge, face) = (2 * n + 2, |i: usize| 1 + i, |i: usize| 2 + n + i);
            let mut rows = vec![vec![0.0; size]; size];
            (rows[0][0], rows[0][edge(0)], rows[0][edge(n)]) = (1.0 - 2.0 * CREASE_END, CREASE_END, CREASE_END);
            for i in 0..=n {
                let (end, far) = if i == 0 || i == n { (0.5, 0.0) } else { (EDGE_END, EDGE_FAR) };
                (rows[edge(i)][0], rows[edge(i)][edge(i)]) = (end, end);
                if far > 0.0 {
                    [edge(i - 1), edge(i + 1), face(i - 1), face(i)].into_iter().for_each(|j| rows[edge(i)][j] = far);
                }
            }
            for i in 0..n {
                [0, edge(i), edge(i + 1), face(i)].into_iter().for_each(|j| rows[face(i)][j] = 0.25);
            }
            let mask = BoundaryTangent::new(n as u32);
            let mut weights = vec![mask.vertex()];
            weights.extend((0..=n as u32).map(|i| mask.edge(i)));
            weights.extend((0..n as u32).map(|i| mask.face(i)));
            let carried = left_multiply(&weights, &rows);
            let cos = (PI / n as f64).cos();
            let eigenvalue = (cos + 5.0 + ((cos + 9.0) * (cos + 1.0)).sqrt()) / 16.0;
            for (a, b) in weights.iter().zip(carried) {
                assert!((a * eigenvalue - b).abs() < 1e-12, "{n} faces: {a} became {b}");
            }
        }
    }

    #[test]
    fn boundary_tangent_weights_sum_to_zero() {
        for (faces, mask) in (1..=20).flat_map(|n| [(n, BoundaryTangent::new(n)), (n, BoundaryTangent::at_corner(n))]) {
            let sum = mask.vertex()
                + (0..=faces).map(|i| mask.edge(i)).sum::<f64>()
                + (0..faces).map(|i| mask.face(i)).sum::<f64>();
            assert!(sum.abs() < 1e-12, "{faces} faces: {sum}");
        }
    }
}
