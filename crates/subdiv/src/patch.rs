//! Leaf patches: which points a face's limit surface is made of, and how they are evaluated.

use crate::topology::{Level, Location, NONE};

/// Where a patch lies, which level it is of and what it borders, in three words.
///
/// | word | bits | meaning |
/// |---|---|---|
/// | `corner` | 0-15 | u of the lower corner, in units of 2^-depth |
/// | | 16-31 | v of the lower corner |
/// | `flags` | 0-4 | depth: halvings of the Ptex face |
/// | | 5-9 | level of subdivision |
/// | | 10-13 | boundary edges and infinite creases: their row of control points is a reflection |
/// | | 14-17 | transition edges: the neighbour was split, in this frame; 0 in the tables |
/// | | 18-21 | leaf edges: the neighbour is an irregular leaf at the end of refinement, whatever the density |
/// | | 22-25 | crease edge: a semi-sharp crease passes along it; at most one |
///
/// Edge i runs from corner i to corner i + 1: 0 is v = 0, 1 is u = 1, 2 is v = 1, 3 is u = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchInfo {
    /// Location and level.
    pub location: Location,
    /// Level of subdivision.
    pub level: u8,
    /// Boundary edges, one bit each.
    pub boundary: u8,
    /// Edges whose neighbour was split, one bit each: a frame's choice, so 0 in the tables.
    pub transition: u8,
    /// Edges that are drawn as one segment because refinement ends at the other side, one bit each: an irregular face of
    /// `max_level` or deeper that nothing forces lies across, or across the edge of the parent that this is a half of.
    pub leaf: u8,
    /// The edge that a semi-sharp crease passes along, one bit each.
    pub crease: u8,
}

impl PatchInfo {
    /// `[ptex face, corner, flags]`; the table above.
    pub fn pack(&self) -> [u32; 3] {
        let l = &self.location;
        let flags = u32::from(l.depth)
            | u32::from(self.level) << 5
            | u32::from(self.boundary) << 10
            | u32::from(self.transition) << 14
            | u32::from(self.leaf) << 18
            | u32::from(self.crease) << 22;
        [l.ptex_face, u32::from(l.u) | u32::from(l.v) << 16, flags]
    }

    /// The inverse of [`Self::pack`].
    pub fn unpack([ptex_face, corner, flags]: [u32; 3]) -> Self {
        let field = |shift: u32, bits: u32| (flags >> shift & ((1 << bits) - 1)) as u8;
        Self {
            location: Location { ptex_face, u: corner as u16, v: (corner >> 16) as u16, depth: field(0, 5) },
            level: field(5, 5),
            boundary: field(10, 4),
            transition: field(14, 4),
            leaf: field(18, 4),
            crease: field(22, 4),
        }
    }
}

/// A bicubic B-spline patch of one level: 16 control points, row by row (v), u running fastest, and where it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularPatch {
    /// Indices of the control points; where `info.boundary` says that a row is a reflection its entries are unused
    /// and name a corner of the face.
    pub points: [u32; 16],
    /// Where it lies and what it borders.
    pub info: PatchInfo,
    /// Sharpness of the crease edge, if there is one; else 0.
    pub sharpness: f32,
    /// Number of each edge that the face across may split, among the split edges of [`crate::tables::Tables`]; else
    /// [`NONE`].
    pub edges: [u32; 4],
    /// Its place among [`crate::tables::Tables::seams`], or [`NONE`] if it takes nothing from other patches.
    pub seams: u32,
}

/// A face of uniform refinement's last level, drawn between limit points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FillingQuad {
    /// Limit points at (0,0), (1,0), (1,1), (0,1).
    pub corners: [u32; 4],
    /// Where it lies.
    pub info: PatchInfo,
}

/// Place in the 4 x 4 control points of each corner of the face.
pub(crate) const CORNERS: [usize; 4] = [5, 6, 10, 9];
/// Places of the two points across edge i, beside its first and its second vertex.
pub(crate) const ACROSS: [[usize; 2]; 4] = [[1, 2], [7, 11], [14, 13], [8, 4]];
/// Place of the point diagonally across corner i.
pub(crate) const DIAGONAL: [usize; 4] = [0, 3, 15, 12];

/// The control points of a regular face, as vertices of its level, and the mask of its boundary edges: those that are
/// infinitely sharp, whether or not a face lies beyond.
///
/// The outer row of such an edge is left to [`reflect`]; its entries name corner 0 of the face.
pub fn control_points(level: &Level, face: u32) -> ([u32; 16], u8) {
    let edges = level.half_edges(face);
    let mut points = [level.origin(edges.start); 16];
    let mut boundary = 0;
    for (i, half_edge) in edges.clone().enumerate() {
        points[CORNERS[i]] = level.origin(half_edge);
        let twin = level.twin(half_edge);
        debug_assert_ne!(twin, NONE, "a drawn face has its whole one-ring");
        if level.is_infinite(half_edge) {
            boundary |= 1 << i;
            continue;
        }
        // The neighbour's half-edges from the twin on: back along the edge, out from corner i, across, and back in.
        let out = level.next(twin);
        let across = level.next(out);
        points[ACROSS[i][0]] = level.origin(across);
        points[ACROSS[i][1]] = level.head(across);
        let diagonal = level.twin(out);
        if !level.is_infinite(out) {
            points[DIAGONAL[i]] = level.origin(level.previous(diagonal));
        }
    }
    (points, boundary)
}

/// Fills in the reflected rows of control points: 2 P - Q across each boundary edge of the mask.
pub fn reflect(points: &mut [[f64; 3]; 16], boundary: u8) {
    let mut set = |at: usize, near: usize, far: usize| {
        points[at] = std::array::from_fn(|c| 2.0 * points[near][c] - points[far][c]);
    };
    // Columns first (u = 0 and u = 1), over the rows that exist; then whole rows, which makes the outer corners too.
    for row in 0..4 {
        if boundary & 8 != 0 {
            set(4 * row, 4 * row + 1, 4 * row + 2);
        }
        if boundary & 2 != 0 {
            set(4 * row + 3, 4 * row + 2, 4 * row + 1);
        }
    }
    for column in 0..4 {
        if boundary & 1 != 0 {
            set(column, 4 + column, 8 + column);
        }
        if boundary & 4 != 0 {
            set(12 + column, 8 + column, 4 + column);
        }
    }
}

/// Uniform cubic B-spline basis and its derivative at t (FAS section 5.1, divided by 6 and by 2).
pub fn cubic_basis(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    (
        [
            s * s * s / 6.0,
            (4.0 * s * s * s + t * t * t + 12.0 * s * t * s + 6.0 * t * s * t) / 6.0,
            (4.0 * t * t * t + s * s * s + 12.0 * t * s * t + 6.0 * s * t * s) / 6.0,
            t * t * t / 6.0,
        ],
        [-s * s / 2.0, (-t * t - 4.0 * t * s) / 2.0, (s * s + 4.0 * s * t) / 2.0, t * t / 2.0],
    )
}

/// Weights of the four rows of control points across a semi-sharp crease at distance t from it, and their derivatives:
/// row 0 lies beyond the crease, row 1 on it (Niessner, Loop and Greiner 2012, derived anew).
///
/// Along the crease the surface is the uniform B-spline; across it is a cubic curve whose second control point has a
/// sharpness s. In each of k = floor(s) steps that point stays where it is, so that beyond t = 2^-k the curve is that of
/// infinite sharpness. In step k + 1 it moves by 1 - (s - k) of the smooth rule, which reaches to t = 2^-k; nearer than
/// 2^-(k+1), or 2^-k for whole s, the curve is the smooth one of the refined points.
pub fn crease_basis(t: f64, sharpness: f64) -> ([f64; 4], [f64; 4]) {
    let steps = sharpness.floor();
    let rest = sharpness - steps;
    let scale = steps.exp2();
    if t * scale >= 1.0 {
        // Infinitely sharp: the row beyond is the reflection 2 p1 - p2.
        let (n, d) = cubic_basis(t);
        let reflected = |w: [f64; 4]| [0.0, w[1] + 2.0 * w[0], w[2] - w[0], w[3]];
        return (reflected(n), reflected(d));
    }
    // Rows after k steps, as sums of the rows given: p1 stays, its neighbours come closer by halves, and p3 follows
    // a' = (6 b + a) / 8 with b halved each time.
    let near = 1.0 / scale;
    let cube = near * near * near;
    let rows = [
        [near, 1.0 - near, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 1.0 - near, near, 0.0],
        [0.0, 1.0 - 2.0 * near + cube, 2.0 * (near - cube), cube],
    ];
    let sum = |terms: &[(f64, [f64; 4])]| -> [f64; 4] {
        std::array::from_fn(|i| terms.iter().map(|&(weight, row)| weight * row[i]).sum())
    };
    let combined = |quad: [[f64; 4]; 4], local: f64, scale: f64| {
        let (n, d) = cubic_basis(local);
        let of = |w: [f64; 4]| sum(&[(w[0], quad[0]), (w[1], quad[1]), (w[2], quad[2]), (w[3], quad[3])]);
        (of(n), of(d).map(|w| w * scale))
    };
    if rest == 0.0 {
        return combined(rows, t * scale, scale);
    }
    let [p0, p1, p2, p3] = rows;
    let smooth = sum(&[(0.125, p0), (0.75, p1), (0.125, p2)]);
    let q0 = sum(&[(0.5, p0), (0.5, p1)]);
    let q1 = sum(&[(rest, p1), (1.0 - rest, smooth)]);
    let q2 = sum(&[(0.5, p1), (0.5, p2)]);
    let q3 = sum(&[(0.125, p1), (0.75, p2), (0.125, p3)]);
    let local = 2.0 * t * scale;
    if local < 1.0 {
        return combined([q0, q1, q2, q3], local, 2.0 * scale);
    }
    let q4 = sum(&[(0.5, p2), (0.5, p3)]);
    combined([q1, q2, q3, q4], local - 1.0, 2.0 * scale)
}

/// A point of the limit surface with its first derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub position: [f64; 3],
    /// Derivative along u.
    pub du: [f64; 3],
    /// Derivative along v.
    pub dv: [f64; 3],
}

impl SurfacePoint {
    /// The unit normal, or `None` where the derivatives do not span a plane.
    pub fn normal(&self) -> Option<[f64; 3]> {
        let (a, b) = (self.du, self.dv);
        let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let size = length(n);
        (size > 1e-9 * length(a) * length(b)).then(|| n.map(|c| c / size))
    }
}

/// Evaluates a bicubic B-spline patch at (u, v) in its own domain.
pub fn evaluate(points: &[[f64; 3]; 16], u: f64, v: f64) -> SurfacePoint {
    evaluate_with(points, cubic_basis(u), cubic_basis(v))
}

/// Evaluates a patch that a crease of this sharpness passes along the edge of the mask (one bit, as
/// [`PatchInfo::crease`]).
pub fn evaluate_crease(points: &[[f64; 3]; 16], crease: u8, sharpness: f64, u: f64, v: f64) -> SurfacePoint {
    let reversed = |t: f64| {
        let (n, d) = crease_basis(1.0 - t, sharpness);
        ([n[3], n[2], n[1], n[0]], [-d[3], -d[2], -d[1], -d[0]])
    };
    let (along_u, along_v) = match crease {
        1 => (cubic_basis(u), crease_basis(v, sharpness)),
        2 => (reversed(u), cubic_basis(v)),
        4 => (cubic_basis(u), reversed(v)),
        8 => (crease_basis(u, sharpness), cubic_basis(v)),
        _ => (cubic_basis(u), cubic_basis(v)),
    };
    evaluate_with(points, along_u, along_v)
}

fn evaluate_with(
    points: &[[f64; 3]; 16],
    (nu, du): ([f64; 4], [f64; 4]),
    (nv, dv): ([f64; 4], [f64; 4]),
) -> SurfacePoint {
    let mut result = SurfacePoint::default();
    for row in 0..4 {
        for column in 0..4 {
            for (c, p) in points[4 * row + column].into_iter().enumerate() {
                result.position[c] += nu[column] * nv[row] * p;
                result.du[c] += du[column] * nv[row] * p;
                result.dv[c] += nu[column] * dv[row] * p;
            }
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patch_info_survives_packing() {
        let info = PatchInfo {
            location: Location { ptex_face: 1_234_567, u: 65_535, v: 4_711, depth: 16 },
            level: 15,
            boundary: 0b1001,
            transition: 0b0110,
            leaf: 0b1111,
            crease: 0b0100,
        };
        assert_eq!(PatchInfo::unpack(info.pack()), info);
    }

    #[test]
    fn basis_sums_to_one_and_its_derivative_to_zero() {
        for i in 0..=16 {
            let (n, d) = cubic_basis(f64::from(i) / 16.0);
            assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(d.iter().sum::<f64>().abs() < 1e-15);
        }
    }

    /// The curve across a crease, by refining its points `steps` times: their positions and the curve's values there.
    fn refined_curve(mut points: Vec<f64>, mut sharpness: f64, steps: u32) -> Vec<f64> {
        // Points stand at -1, 0, 1, 2, ..; the crease is at 0. Of each step the points from -1 on are kept.
        for _ in 0..steps {
            let smooth = |i: usize| 0.125 * points[i - 1] + 0.75 * points[i] + 0.125 * points[i + 1];
            let weight = sharpness.min(1.0);
            let mut next = vec![0.5 * (points[0] + points[1]), weight * points[1] + (1.0 - weight) * smooth(1)];
            for i in 2..points.len() - 1 {
                next.extend([0.5 * (points[i - 1] + points[i]), smooth(i)]);
            }
            next.push(0.5 * (points[points.len() - 2] + points[points.len() - 1]));
            points = next;
            sharpness = (sharpness - 1.0).max(0.0);
        }
        (1..points.len() - 1).map(|i| (points[i - 1] + 4.0 * points[i] + points[i + 1]) / 6.0).collect()
    }

    #[test]
    fn the_curve_across_a_crease_is_the_limit_of_its_refinement() {
        let rows = [0.3, -0.7, 1.1, 0.2];
        for sharpness in [0.3, 1.0, 1.5, 2.0, 2.3, 3.7, 5.0] {
            let steps = 8;
            let refined = refined_curve(rows.to_vec(), sharpness, steps);
            for (i, expected) in refined.iter().enumerate().take(1 << steps) {
                let t = i as f64 / f64::from(1 << steps);
                let (n, d) = crease_basis(t, sharpness);
                let got: f64 = n.iter().zip(rows).map(|(w, p)| w * p).sum();
                assert!((got - expected).abs() < 1e-12, "sharpness {sharpness}, t = {t}: {got}, expected {expected}");
                assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-14 && d.iter().sum::<f64>().abs() < 1e-11);
                let h = 1e-6;
                let value = |t: f64| crease_basis(t, sharpness).0.iter().zip(rows).map(|(w, p)| w * p).sum::<f64>();
                let slope: f64 = d.iter().zip(rows).map(|(w, p)| w * p).sum();
                assert!((slope - (value(t + h) - value(t)) / h).abs() < 1e-3, "sharpness {sharpness}, t = {t}");
            }
        }
    }

    #[test]
    fn a_reflected_corner_is_interpolated() {
        let mut points: [[f64; 3]; 16] =
            std::array::from_fn(|i| [(i % 4) as f64, (i / 4) as f64, (i * i) as f64 * 0.1]);
        let corner = points[5];
        reflect(&mut points, 0b1001);
        let got = evaluate(&points, 0.0, 0.0).position;
        for c in 0..3 {
            assert!((got[c] - corner[c]).abs() < 1e-14);
        }
    }
}
