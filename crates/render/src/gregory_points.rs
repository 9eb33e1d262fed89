//! Control points of Gregory patches from limit points and spokes: CPU twin of `glsl/shared/gregory_points.glsl` and `gregory.glsl`,
//! operation by operation. In f64: [`planish_subdiv::gregory`].

use std::array::from_fn;

use planish_shaders::{LimitPoint, SpokePoint};
use planish_subdiv::tables::{GregoryFace, GregoryKind};

use crate::visibility::{Vec3, add, over, sub, times};

/// What patches are made of.
#[derive(Clone, Copy)]
pub(crate) struct Seats<'a> {
    pub limits: &'a [LimitPoint],
    pub spokes: &'a [SpokePoint],
}

/// The curve along an edge and the field across it.
#[derive(Clone, Copy)]
struct EdgeFields {
    curve: [Vec3; 4],
    across: [Vec3; 4],
}

fn minus(a: Vec3) -> Vec3 {
    a.map(|c| -c)
}

/// A corner of a face: cosines at it and at the edge's other end.
#[derive(Clone, Copy)]
struct Cosines {
    own: f32,
    far: f32,
}

fn face_point(degree: f32, p: Vec3, cosines: Cosines, edge: Vec3, far: Vec3, r: Vec3) -> Vec3 {
    let Cosines { own, far: far_cosine } = cosines;
    let near = add(times(p, far_cosine), times(edge, (degree - 2.0 * own) - far_cosine));
    over(add(near, add(times(far, 2.0 * own), r)), degree)
}

fn middle_of([a, b, c, d]: [Vec3; 4]) -> Vec3 {
    add(add(times(a, 0.125), times(d, 0.125)), add(times(b, 0.375), times(c, 0.375)))
}

/// Point i of the half of a cubic at its first end.
fn half_cubic(p: [Vec3; 4], i: usize) -> Vec3 {
    match i {
        0 => p[0],
        1 => add(times(p[0], 0.5), times(p[1], 0.5)),
        2 => add(add(times(p[0], 0.25), times(p[2], 0.25)), times(p[1], 0.5)),
        _ => middle_of(p),
    }
}

fn third_step(point: Vec3, vector: Vec3, scale: f32) -> Vec3 {
    add(point, over(times(vector, scale), 3.0))
}

impl EdgeFields {
    fn turned(self) -> Self {
        Self { curve: from_fn(|i| self.curve[3 - i]), across: from_fn(|i| minus(self.across[3 - i])) }
    }

    /// Derivatives into the face along the edge: equations (2) to (5).
    fn inward(&self, c0: f32, c1: f32) -> [Vec3; 4] {
        let [u0, u1, u2] = from_fn(|i| times(sub(self.curve[i + 1], self.curve[i]), 3.0));
        let across = &self.across;
        [
            add(across[0], times(u0, c0)),
            add(across[1], over(sub(times(u1, 2.0 * c0), times(u0, c1)), 3.0)),
            add(across[2], over(sub(times(u2, c0), times(u1, 2.0 * c1)), 3.0)),
            sub(across[3], times(u2, c1)),
        ]
    }
}

impl Seats<'_> {
    fn position(&self, limit: u32) -> Vec3 {
        self.limits[limit as usize].position
    }

    fn spoke(&self, spoke: u32) -> &SpokePoint {
        &self.spokes[spoke as usize]
    }

    fn edge_fields(&self, from: u32, first: u32, last: u32, to: u32) -> EdgeFields {
        let (a, b) = (self.spoke(first), self.spoke(last));
        EdgeFields {
            curve: [self.position(from), a.edge, b.edge, self.position(to)],
            across: [a.across, a.beside, minus(b.beside), minus(b.across)],
        }
    }

    /// The control points of a face, from a corner on: 20 or 15; none of a face that is no Gregory patch.
    pub fn control_points(&self, face: &GregoryFace) -> Vec<Vec3> {
        match face.kind {
            GregoryKind::None => Vec::new(),
            GregoryKind::Quad => (0..20).map(|i| self.corner_point(face, i, 4)).collect(),
            GregoryKind::PartOfTriangle(part) => {
                (0..15).map(|i| self.corner_point(face, (i + 5 * usize::from(part)) % 15, 3)).collect()
            }
            GregoryKind::PartOfNgon => (0..20).map(|i| self.ngon_point(face, i)).collect(),
        }
    }

    fn corner_point(&self, face: &GregoryFace, i: usize, corners: usize) -> Vec3 {
        let (corner, which) = (i / 5, i % 5);
        let (next, previous) = ((corner + 1) % corners, (corner + corners - 1) % corners);
        let p = self.position(face.limits[corner]);
        let is_out = which == 1 || which == 3;
        let spoke = self.spoke(if is_out { face.first[corner] } else { face.last[previous] });
        match which {
            0 => p,
            1 | 2 => spoke.edge,
            _ => {
                let far = self.spoke(if is_out { face.last[corner] } else { face.first[previous] }).edge;
                let end = if is_out { next } else { previous };
                let cosines = Cosines { own: face.cosines[corner], far: face.cosines[end] };
                let r = if is_out { spoke.beside } else { minus(spoke.beside) };
                face_point(if corners == 3 { 4.0 } else { 3.0 }, p, cosines, spoke.edge, far, r)
            }
        }
    }

    /// The inner edge of a face of more than four sides from the middle of an outer edge to the centre.
    fn inner_edge(&self, outer: &EdgeFields, [c0, c1]: [f32; 2], centre: u32, spoke: u32) -> EdgeFields {
        let (EdgeFields { curve, .. }, spoke) = (outer, self.spoke(spoke));
        let middle = middle_of(*curve);
        let inward = middle_of(outer.inward(c0, c1));
        let back = times(add(sub(curve[0], curve[3]), sub(curve[1], curve[2])), 0.375);
        let end = minus(spoke.across);
        EdgeFields {
            curve: [middle, third_step(middle, inward, 0.5), spoke.edge, self.position(centre)],
            across: [back, over(add(times(back, 2.0), end), 3.0), minus(spoke.beside), end],
        }
    }

    fn ngon_edge(&self, face: &GregoryFace, edge: usize) -> EdgeFields {
        let (limits, first) = (&face.limits, &face.first);
        let after = usize::from(edge < 2);
        let outer = self.edge_fields(limits[after], first[after], face.last[after], limits[after + 1]);
        if edge == 0 || edge == 3 {
            return outer;
        }
        let cosines = [face.cosines[after], face.cosines[after + 1]];
        let inner = self.inner_edge(&outer, cosines, limits[3], first[after + 2]);
        if edge == 1 { inner } else { inner.turned() }
    }

    fn ngon_point(&self, face: &GregoryFace, i: usize) -> Vec3 {
        let (corner, which) = (i / 5, i % 5);
        let is_out = which == 1 || which == 3;
        let edge = match (which, corner) {
            (0, 1) => 0,
            (0, _) => corner,
            _ if is_out => corner,
            _ => (corner + 3) % 4,
        };
        let own = self.ngon_edge(face, edge);
        if edge == 0 || edge == 3 {
            return outer_point(face, &own, edge, corner, which);
        }
        let (near, next) = if is_out { (0, 1) } else { (3, 2) };
        match which {
            0 => own.curve[0],
            1 | 2 => own.curve[next],
            _ => {
                let centre = face.cosines[3];
                let (own_cosine, far) = if corner == 2 { (centre, 0.0) } else { (0.0, centre) };
                let cosines = Cosines { own: own_cosine, far };
                face_point(3.0, own.curve[near], cosines, own.curve[next], own.curve[3 - next], own.across[next])
            }
        }
    }
}

/// A point along the outer edges of a part, seen from the corner of the cage: 0 is its own end of the half edge, 3 the middle.
fn outer_point(face: &GregoryFace, own: &EdgeFields, edge: usize, corner: usize, which: usize) -> Vec3 {
    let seen = if edge == 3 { own.turned() } else { *own };
    let is_middle = corner == 1 || corner == 3;
    let place = match (which, is_middle) {
        (0, true) => 3,
        (0, false) => 0,
        (_, true) => 2,
        (_, false) => 1,
    };
    let on_curve = half_cubic(seen.curve, place);
    if which < 3 {
        return on_curve;
    }
    let after = usize::from(edge == 0);
    let mut inward = own.inward(face.cosines[after], face.cosines[after + 1]);
    if edge == 3 {
        inward.reverse();
    }
    third_step(on_curve, half_cubic(inward, place), 0.5)
}
