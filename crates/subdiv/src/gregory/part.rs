//! Faces of more than four sides: an extension of the paper. Such a face is split once, into a quad patch at each corner, without
//! splitting its neighbours: the two halves of each outer edge are halves of the edge's one cubic curve, and of its one field across.
//! So it meets its neighbours as any other face does, and is smooth inside by the same conditions: at the middle of an edge
//! four patches would meet if the neighbour were split too, at the centre all parts do.

use super::{Corner, EdgeFields, Vec3, face_point, sum};

/// Size of a part's derivatives across a half edge, over those of the whole face.
const SCALE: f64 = 0.5;

/// Control points of one half of a cubic.
fn half(whole: [Vec3; 4], is_second: bool) -> [Vec3; 4] {
    let [a, b, c, d] = if is_second { [whole[3], whole[2], whole[1], whole[0]] } else { whole };
    let first = [
        a,
        sum([(0.5, a), (0.5, b)]),
        sum([(0.25, a), (0.5, b), (0.25, c)]),
        sum([(0.125, a), (0.375, b), (0.375, c), (0.125, d)]),
    ];
    if is_second { [first[3], first[2], first[1], first[0]] } else { first }
}

/// An outer edge of a face as its parts see it: curve, and derivatives into the face.
struct Outer {
    curve: [Vec3; 4],
    inward: [Vec3; 4],
    /// The field across at the middle: half the difference of both sides' derivatives.
    middle_across: Vec3,
}

impl Outer {
    fn new(from: &Corner, to: &Corner) -> Self {
        let EdgeFields { curve, across } = EdgeFields::new(from, to);
        let along = [0, 1, 2].map(|i| sum([(3.0, curve[i + 1]), (-3.0, curve[i])]));
        let (c0, c1) = (from.cosine, to.cosine);
        // Equations (2) to (5): ((1 - t) c0 - t c1) u(t), and the field.
        let third = 1.0 / 3.0;
        let inward = [
            sum([(c0, along[0]), (1.0, across[0])]),
            sum([(2.0 * third * c0, along[1]), (-third * c1, along[0]), (1.0, across[1])]),
            sum([(third * c0, along[2]), (-2.0 * third * c1, along[1]), (1.0, across[2])]),
            sum([(-c1, along[2]), (1.0, across[3])]),
        ];
        Self { curve, inward, middle_across: half(along_half(&curve), false)[3] }
    }

    /// The half at the first or at the second end, with derivatives of the part's size.
    fn half(&self, is_second: bool) -> ([Vec3; 4], [Vec3; 4]) {
        (half(self.curve, is_second), half(self.inward, is_second).map(|v| v.map(|c| SCALE * c)))
    }
}

/// The derivative of a curve as a cubic of its own, times [`SCALE`]: what runs across the inner edge at the curve's middle.
fn along_half(curve: &[Vec3; 4]) -> [Vec3; 4] {
    let d = [0, 1, 2].map(|i| sum([(3.0 * SCALE, curve[i + 1]), (-3.0 * SCALE, curve[i])]));
    let third = 1.0 / 3.0;
    [d[0], sum([(third, d[0]), (2.0 * third, d[1])]), sum([(2.0 * third, d[1]), (third, d[2])]), d[2]]
}

/// The 20 points of the part at corner `own` of a face, whose corners before and after are given: corners of the part are that one,
/// the middle of the next edge, the centre, the middle of the edge before. `centre.out` is the spoke of the centre to the middle of the
/// edge before, `centre.into` that to the middle of the next edge.
pub fn part_points(previous: &Corner, own: &Corner, next: &Corner, centre: &Corner) -> Vec<Vec3> {
    let after = Outer::new(own, next);
    let before = Outer::new(previous, own);
    let ((curve, inward), (curve_before, inward_before)) = (after.half(false), before.half(true));
    let third = 1.0 / 3.0;
    let step = |point: Vec3, vector: Vec3| sum([(1.0, point), (third, vector)]);
    let turned = |v: Vec3| v.map(|c| -c);
    // The middle of the next edge: its inner edge begins here, with the part to the left; across it lies the edge, backwards.
    let middle = |outer: &Outer, point: Vec3, inward: Vec3, far: Vec3, far_across: Vec3| {
        let across = turned(outer.middle_across);
        // As a linear field, of which this is the second control vector.
        let beside = sum([(2.0 * third, across), (third, far_across)]);
        let corner = Corner { position: point, cosine: 0.0, ..Corner::default() };
        let edge = step(point, inward);
        (edge, face_point(3.0, &corner, edge, centre.cosine, far, beside), beside)
    };
    // Seen from the middles, the centre's spokes run backwards.
    let to_next = turned(centre.into.across);
    let to_previous = turned(centre.out.across);
    let (edge, inner, _) = middle(&after, curve[3], inward[3], centre.into.edge, to_next);
    let (edge_before, _, beside) = middle(&before, curve_before[0], inward_before[0], centre.out.edge, to_previous);
    let middle_before = Corner { position: curve_before[0], ..Corner::default() };
    let inner_before = face_point(3.0, &middle_before, edge_before, centre.cosine, centre.out.edge, turned(beside));
    let far_out = face_point(3.0, centre, centre.out.edge, 0.0, edge_before, centre.out.beside);
    let far_into = face_point(3.0, centre, centre.into.edge, 0.0, edge, turned(centre.into.beside));
    vec![
        own.position,
        curve[1],
        curve_before[2],
        step(curve[1], inward[1]),
        step(curve_before[2], inward_before[2]),
        // The middle of the next edge.
        curve[3],
        edge,
        curve[2],
        inner,
        step(curve[2], inward[2]),
        // The centre.
        centre.position,
        centre.out.edge,
        centre.into.edge,
        far_out,
        far_into,
        // The middle of the edge before.
        curve_before[0],
        curve_before[1],
        edge_before,
        step(curve_before[1], inward_before[1]),
        inner_before,
    ]
}
