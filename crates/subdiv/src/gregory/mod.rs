//! Gregory patches (Loop, Schaefer, Ni and Castano 2009): one patch for each face that is no bicubic patch.
//!
//! What a corner of a face gives to its patch are a *spoke* for each of its two edges there: the edge point of the boundary curve,
//! the transversal `across` of the tangent plane there and the vector `beside` (r of the paper). Everything on a shared edge is made of
//! the spokes at its ends, which both sides read; so both have the same bits. Here in f64, for tests and for measuring; the shaders are
//! `glsl/shared/gregory.glsl`.

mod acc;
mod forms;
mod part;
mod pm;
mod quad;
mod rivals;
mod rivals_surface;
mod spokes;
mod surface;
mod triangle;

pub use acc::AccPatch;
pub(crate) use forms::{Composer, Form, SpokeForms, sum_forms};
pub use part::part_points;
pub use pm::PmPatch;
pub use quad::{evaluate_quad, quad_points};
pub use rivals::Rival;
pub(crate) use rivals::{RivalSpoke, Terms, rival_spokes};
pub use rivals_surface::{RivalPatch, RivalSurface};
pub(crate) use spokes::{RowPlace, SectorSpokes, sector_of, sector_spokes};
pub use surface::{GregoryPatch, GregorySurface};
pub use triangle::{evaluate_triangle, part_barycentric, triangle_points};

use crate::patch::SurfacePoint;

/// A point or a vector.
pub type Vec3 = [f64; 3];

/// What a vertex gives to the patches along one of its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpokePoints {
    /// Edge point e: the curve's control point next to the corner (section 3.3).
    pub edge: Vec3,
    /// Derivative across the edge at the vertex, to the left of the edge seen from the vertex: 3/2 (e of the next edge - e of the
    /// one before), which is v_0 - c u_0 of equation (2).
    pub across: Vec3,
    /// r of section 3.4, to the left.
    pub beside: Vec3,
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// Limit position p.
    pub position: Vec3,
    /// Cosine of the angle between neighbouring tangents: c of equation (1).
    pub cosine: f64,
    /// The spoke of the edge that begins here.
    pub out: SpokePoints,
    /// The spoke of the edge that ends here.
    pub into: SpokePoints,
}

/// Which normals: those of the Bezier form, which are right along edges and continuous inside (section 4.4), or of the rational
/// patch itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// Of the Bezier form.
    #[default]
    Approximate,
    /// Of the patch.
    Exact,
}

/// Control points that each corner has: p, e+, e-, f+, f-. Point j of corner i is number 5 i + j.
pub const POINTS_PER_CORNER: usize = 5;

pub(crate) fn sum<const N: usize>(terms: [(f64, Vec3); N]) -> Vec3 {
    std::array::from_fn(|c| terms.iter().map(|(w, p)| w * p[c]).sum())
}

/// Equation (6): the weights of the corner, of an edge point of it, of the edge's other edge point and of r, that make the face point
/// beside the edge point. `degree` is 3 for quads, 4 for triangles; `own` and `other` are the cosines at the corner and at the edge's
/// other end.
pub(crate) fn face_point_weights(degree: f64, own: f64, other: f64) -> [f64; 4] {
    let scale = 1.0 / degree;
    [scale * other, scale * (degree - 2.0 * own - other), scale * 2.0 * own, scale]
}

/// The face point beside an edge point `edge` of a corner, the edge's other one being `far`; `r` points into the face.
pub(crate) fn face_point(degree: f64, corner: &Corner, edge: Vec3, far_cosine: f64, far: Vec3, r: Vec3) -> Vec3 {
    let [of_corner, of_edge, of_far, of_r] = face_point_weights(degree, corner.cosine, far_cosine);
    sum([(of_corner, corner.position), (of_edge, edge), (of_far, far), (of_r, r)])
}

/// The control points of a face of N corners: p, e+, e-, f+, f- of each.
pub(crate) fn face_points<const N: usize>(degree: f64, corners: &[Corner; N]) -> Vec<Vec3> {
    let mut points = Vec::with_capacity(POINTS_PER_CORNER * N);
    for (i, corner) in corners.iter().enumerate() {
        let (next, previous) = (&corners[(i + 1) % N], &corners[(i + N - 1) % N]);
        let out = face_point(degree, corner, corner.out.edge, next.cosine, next.into.edge, corner.out.beside);
        let r = corner.into.beside.map(|c| -c);
        let into = face_point(degree, corner, corner.into.edge, previous.cosine, previous.out.edge, r);
        points.extend([corner.position, corner.out.edge, corner.into.edge, out, into]);
    }
    points
}

/// The four control points of the curve along an edge and the four control vectors of the field across it (to the left), by its
/// two ends. Their tangent plane is that of both patches there: both sides of equation (1) are u(t) times a factor, plus or minus this field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFields {
    /// Control points of the curve.
    pub curve: [Vec3; 4],
    /// Control vectors of the field.
    pub across: [Vec3; 4],
}

impl EdgeFields {
    /// From corner to corner.
    pub fn new(from: &Corner, to: &Corner) -> Self {
        let turned = |v: Vec3| v.map(|c| -c);
        Self {
            curve: [from.position, from.out.edge, to.into.edge, to.position],
            across: [from.out.across, from.out.beside, turned(to.into.beside), turned(to.into.across)],
        }
    }

    /// Position, derivative along the edge, and the field across, at t.
    pub fn evaluate(&self, t: f64) -> SurfacePoint {
        let (n, d) = bernstein(t);
        let along = |points: &[Vec3; 4], w: [f64; 4]| sum([0, 1, 2, 3].map(|i| (w[i], points[i])));
        SurfacePoint { position: along(&self.curve, n), du: along(&self.curve, d), dv: along(&self.across, n) }
    }
}

/// Cubic Bernstein polynomials and their derivatives.
pub(crate) fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    (
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t],
    )
}

/// `(a p + b q) / (a + b)`, p where both are 0, and its derivative by a; that by b is -a / b times it.
pub(crate) fn blend(a: f64, p: Vec3, b: f64, q: Vec3) -> (Vec3, Vec3) {
    let total = a + b;
    if total == 0.0 {
        return (p, [0.0; 3]);
    }
    (sum([(a / total, p), (b / total, q)]), sum([(b / (total * total), p), (-b / (total * total), q)]))
}
