//! The spokes of a sector of a vertex: weights for edge points and for the vectors r.

use std::f64::consts::PI;

use super::rivals::{Terms, merged};
use crate::limit::{LimitRule, limit_mask, limit_rule};
use crate::rules::BoundaryTangent;
use crate::topology::{Level, Sector};

/// A third: a cubic's control points next to its ends are a third of its derivative away.
pub(super) const THIRD: f64 = 1.0 / 3.0;

/// A spoke's weights.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpokeWeights {
    /// The edge point is the limit position, plus these times the tangents of its limit row,
    pub along: [f64; 2],
    /// plus this times the vector to the edge's other end: where no tangent plane exists.
    pub direct: f64,
    /// Of that vector only what lies in the tangent plane: where rules are semi-sharp. Such a vertex looks sharp from afar, so that
    /// the tangents' masks say where the surface points and not how far it goes.
    pub is_projected: bool,
    /// The vertex at that end.
    pub end: u32,
    /// The vector r: vertices of the level with weights that sum to 0; that of the vertex itself is left out.
    pub beside: Terms,
}

/// The spokes of a sector, counter-clockwise.
#[derive(Clone, Debug)]
pub(crate) struct SectorSpokes {
    /// The faces, by their outgoing half-edges; face j lies between spokes j and j + 1.
    pub sector: Sector,
    /// One a face, and in an open sector one more.
    pub weights: Vec<SpokeWeights>,
    /// Cosine of the angle between the tangents of neighbouring spokes, c of equation (1): a full turn shared by all faces, half a
    /// turn on a boundary or a crease, a quarter at a corner.
    pub cosine: f64,
}

/// Where the limit row of a vertex stands: its corner there, and how many levels finer that is.
#[derive(Clone, Copy)]
pub(crate) struct RowPlace<'a> {
    pub level: &'a Level,
    pub corner: u32,
    pub levels_finer: i32,
    /// Which spoke there is the sector's first.
    pub turn: usize,
}

/// The faces of a corner's vertex that share one limit rule.
pub(crate) fn sector_of(level: &Level, corner: u32) -> Sector {
    let vertex = level.origin(corner);
    if level.tag(vertex).is_plain() {
        return Sector { spokes: level.spokes(vertex).collect(), is_closed: !level.tag(vertex).is_boundary() };
    }
    level.sector(corner)
}

/// The spokes at a corner (an outgoing half-edge).
pub(crate) fn sector_spokes(level: &Level, corner: u32, row: RowPlace<'_>) -> SectorSpokes {
    let sector = sector_of(level, corner);
    let face_count = sector.spokes.len();
    let (rule, is_semi_sharp) = limit_rule(row.level, row.corner);
    let count = face_count + usize::from(!sector.is_closed);
    let is_projected = is_semi_sharp && matches!(rule, LimitRule::Smooth(_));
    let along = if is_projected { None } else { tangents(rule, count, row) };
    let faces = face_count as f64;
    let cosine = match rule {
        LimitRule::Smooth(_) | LimitRule::Cone(_) => (2.0 * PI / faces).cos(),
        LimitRule::Boundary(_) => (PI / faces).cos(),
        LimitRule::Corner(_) => (0.5 * PI / faces).cos(),
    };
    let weights = (0..count).map(|j| {
        let (along, direct) = along.as_ref().map_or(([0.0; 2], THIRD), |along| (along[j], 0.0));
        let (end, beside) = (end(level, &sector, j), beside(level, &sector, j));
        SpokeWeights { along, direct, is_projected, end, beside }
    });
    let weights = weights.collect();
    // cos(pi / 2) and its like are to be 0.
    let cosine = if cosine.abs() < 1e-15 { 0.0 } else { cosine };
    SectorSpokes { sector, weights, cosine }
}

/// The vertex at the end of spoke j.
fn end(level: &Level, sector: &Sector, j: usize) -> u32 {
    match sector.spokes.get(j) {
        Some(&spoke) => level.head(spoke),
        None => level.origin(level.previous(sector.spokes[j - 1])),
    }
}

/// r of spoke j: 1/3 (m of the next spoke - m of the one before) + 2/3 (centre of the face after - of the face before), pointing to the
/// face after; across a boundary points are reflected (section 4.6).
fn beside(level: &Level, sector: &Sector, j: usize) -> Terms {
    let vertex = level.origin(sector.spokes[0]);
    let n = sector.spokes.len();
    let mut terms = Terms::new();
    // Of the middle of an edge from the vertex: what is not the vertex' own.
    let middle = |j: usize, weight: f64, terms: &mut Terms| terms.push((end(level, sector, j), 0.5 * weight));
    let centre = |j: usize, weight: f64, terms: &mut Terms| {
        let corners = level.vertices(level.face(sector.spokes[j]));
        terms.extend(corners.iter().map(|&v| (v, weight / corners.len() as f64)));
    };
    if sector.is_closed {
        let previous = (j + n - 1) % n;
        middle((j + 1) % n, THIRD, &mut terms);
        middle(previous, -THIRD, &mut terms);
        centre(j, 2.0 * THIRD, &mut terms);
        centre(previous, -2.0 * THIRD, &mut terms);
    } else if j == 0 || j == n {
        // m of the reflected spoke is 2 v - m, the centre of the reflected face 2 m_j - c.
        let (inner, face, sign) = if j == 0 { (1, 0, 1.0) } else { (n - 1, n - 1, -1.0) };
        middle(inner, sign * 2.0 * THIRD, &mut terms);
        centre(face, sign * 4.0 * THIRD, &mut terms);
        middle(j, -sign * 4.0 * THIRD, &mut terms);
    } else {
        middle(j + 1, THIRD, &mut terms);
        middle(j - 1, -THIRD, &mut terms);
        centre(j, 2.0 * THIRD, &mut terms);
        centre(j - 1, -2.0 * THIRD, &mut terms);
    }
    merged(terms, vertex)
}

/// A ring that lies in a plane as the limit's tangents do: its points in the order of a limit mask, and what its spokes' edge points
/// are to be, from the limit position.
struct IdealRing {
    points: Vec<[f64; 2]>,
    edge_points: Vec<[f64; 2]>,
}

impl IdealRing {
    /// All around a smooth vertex: the paper's q at unit distance (section 3.3).
    fn closed(n: usize) -> Self {
        let valence = n as f64;
        let (step, half) = (2.0 * PI / valence, (PI / valence).cos());
        let value = smooth_value(n);
        let sigma = (4.0 + half * half).powf(-0.5);
        // Of the characteristic map: (value - 1/4) f = (e_j + e_j+1) / 4.
        let face = if n == 2 { 0.0 } else { 2.0 * half / (4.0 * value - 1.0) };
        let share = if n == 2 { 1.0 } else { 0.5 };
        let length = 2.0 * THIRD * value * share * ((1.0 + sigma * half) + sigma * face);
        let at = |angle: f64, radius: f64| [radius * angle.cos(), radius * angle.sin()];
        let mut points = vec![[0.0; 2]];
        for j in 0..n {
            points.push(at(step * j as f64, 1.0));
            points.push(at(step * (j as f64 + 0.5), face));
        }
        Self { points, edge_points: (0..n).map(|j| at(step * j as f64, length)).collect() }
    }

    /// Half around: the boundary's curve along x (ratio 2 : 1, section 4.6), and the boundary's tangent across along y.
    fn open(faces: usize) -> Self {
        let step = PI / faces as f64;
        let value = boundary_value(faces);
        let face = if faces == 1 { 1.0 } else { 2.0 * (0.5 * step).cos() / (4.0 * value - 1.0) };
        let sine = |j: usize| if j == 0 || j == faces { 0.0 } else { (step * j as f64).sin() };
        let cosine = |j: usize| {
            if j == 0 {
                1.0
            } else if j == faces {
                -1.0
            } else {
                (step * j as f64).cos()
            }
        };
        let across = BoundaryTangent::new(faces as u32);
        let mut points = vec![[0.0; 2]];
        let mut height = 0.0;
        for j in 0..faces {
            let angle = step * (j as f64 + 0.5);
            points.push([cosine(j), sine(j)]);
            points.push([face * angle.cos(), face * angle.sin()]);
            height += across.edge(j as u32) * sine(j) + across.face(j as u32) * face * angle.sin();
        }
        points.push([-1.0, 0.0]);
        let edge_points = (0..=faces).map(|j| [THIRD * cosine(j), THIRD * height * sine(j)]).collect();
        Self { points, edge_points }
    }
}

/// The subdominant eigenvalue of a smooth vertex (section 3.3).
pub(super) fn smooth_value(n: usize) -> f64 {
    let step = 2.0 * PI / n as f64;
    (5.0 + step.cos() + (0.5 * step).cos() * (18.0 + 2.0 * step.cos()).sqrt()) / 16.0
}

/// The eigenvalue of the tangent across a boundary ([`BoundaryTangent::new`]).
fn boundary_value(faces: usize) -> f64 {
    let cos = (PI / faces as f64).cos();
    (cos + 5.0 + ((cos + 9.0) * (cos + 1.0)).sqrt()) / 16.0
}

/// For each spoke the weights of the two tangents of the limit row in its edge point; none where there is no tangent plane.
///
/// The tangents' masks may have any length, and be carried back over levels of semi-sharp rules: what they make of an ideal ring
/// says which combination of them the edge points are.
fn tangents(rule: LimitRule, count: usize, row: RowPlace<'_>) -> Option<Vec<[f64; 2]>> {
    let (ring, shrink) = match rule {
        LimitRule::Smooth(n) => {
            let value = smooth_value(n as usize);
            (IdealRing::closed(n as usize), [value, value])
        }
        LimitRule::Boundary(n) => (IdealRing::open(n as usize), [0.5, boundary_value(n as usize)]),
        LimitRule::Cone(_) | LimitRule::Corner(_) => return None,
    };
    if ring.edge_points.len() != count {
        // A sector of a non-manifold vertex whose rule is that of all sectors together.
        return None;
    }
    let (_, mask) = limit_mask(row.level, row.corner);
    let scale = shrink.map(|value| value.powi(row.levels_finer));
    let mut made = [[0.0; 2]; 2];
    for (point, weights) in ring.points.iter().zip(&mask) {
        for (tangent, made) in made.iter_mut().enumerate() {
            (0..2).for_each(|c| made[c] += weights[1 + tangent] * scale[c] * point[c]);
        }
    }
    let noise = 1e-12 * made.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()));
    made.iter_mut().flatten().filter(|c| c.abs() < noise).for_each(|c| *c = 0.0);
    let [a, b] = made;
    let determinant = a[0] * b[1] - a[1] * b[0];
    let square = a[0] * a[0] + a[1] * a[1];
    let combine = |target: [f64; 2]| {
        if determinant.abs() > 1e-9 * square.max(b[0] * b[0] + b[1] * b[1]) {
            let first = (target[0] * b[1] - target[1] * b[0]) / determinant;
            let second = (a[0] * target[1] - a[1] * target[0]) / determinant;
            [first, second]
        } else if square > 0.0 {
            // Valence 2, or one face along a boundary: all that is known is the direction of the curve.
            [(target[0] * a[0] + target[1] * a[1]) / square, 0.0]
        } else {
            [0.0; 2]
        }
    };
    // The row's spokes may begin at another one than the sector's.
    let n = ring.edge_points.len();
    Some((0..count).map(|j| combine(ring.edge_points[(j + row.turn) % n])).collect())
}
