//! A mesh' patches by ACC or as Pm-patches in f64, from the tables that the GPU reads.

use super::surface::weigh;
use super::{AccPatch, EdgeFields, PmPatch, Rival, SpokePoints, Vec3, bernstein, sum};
use crate::patch::SurfacePoint;
use crate::tables::{GregoryFace, GregoryKind, Tables};

/// A corner of a quad.
#[derive(Clone, Copy, Debug)]
pub(super) struct RivalCorner {
    pub position: Vec3,
    pub cosine: f64,
    pub out: SpokePoints,
    pub out_middle: Vec3,
    pub into: SpokePoints,
    pub into_middle: Vec3,
}

impl RivalCorner {
    /// The point of the face next to the corner along both axes.
    pub fn inner(&self) -> Vec3 {
        sum([(1.0, self.out_middle), (1.0 / 3.0, self.out.beside)])
    }
}

/// The limit points and spokes of a mesh.
#[derive(Debug)]
pub struct RivalSurface<'a> {
    tables: &'a Tables,
    rival: Rival,
    limits: Vec<Vec3>,
    spokes: Vec<(SpokePoints, Vec3)>,
}

/// The patch of an irregular face.
#[derive(Clone, Debug, PartialEq)]
pub struct RivalPatch {
    shape: Shape,
    corners: [RivalCornerFields; 4],
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Acc(Box<AccPatch>),
    Pm(Box<PmPatch>),
}

/// Of an edge: the curve along it, the control vectors of the tangent along it and of the field across.
type RivalCornerFields = ([Vec3; 4], [Vec3; 3], [Vec3; 4]);

impl<'a> RivalSurface<'a> {
    /// For these positions of the cage.
    ///
    /// # Panics
    /// If the tables are not of this scheme, or there are fewer positions than cage points.
    pub fn new(tables: &'a Tables, rival: Rival, cage: &[[f32; 3]]) -> Self {
        assert_eq!(tables.gregory.rival, Some(rival), "tables of another scheme");
        let points: Vec<Vec3> = cage[..tables.cage_point_count as usize].iter().map(|p| p.map(f64::from)).collect();
        let origin_of =
            |row: &crate::stencil::StencilRow, indices: &[u32]| points[indices[row.first_index as usize] as usize];
        let limits: Vec<Vec3> = tables
            .limits
            .rows
            .iter()
            .map(|row| {
                let weights = |i: usize| tables.limits.weights[i].map(f64::from);
                let [offset, ..] = weigh(&points, &tables.limits.indices, row, weights);
                sum([(1.0, origin_of(row, &tables.limits.indices)), (1.0, offset)])
            })
            .collect();
        let table = &tables.gregory;
        let mut spokes = vec![(SpokePoints::default(), [0.0; 3]); table.rival_spokes.len()];
        for (&[first, count], limit) in table.of_limit.iter().zip(&limits) {
            let own = first as usize..(first + count) as usize;
            for (rows, spoke) in table.rival_spokes[own.clone()].iter().zip(&mut spokes[own]) {
                let weight = |i: usize| [f64::from(table.weights[i]), 0.0, 0.0];
                let [edge, across, beside, middle] = [rows.edge, rows.across, rows.beside, rows.middle]
                    .map(|row| weigh(&points, &table.indices, &row, weight)[0]);
                let made = SpokePoints { edge: sum([(1.0, *limit), (1.0, edge)]), across, beside };
                *spoke = (made, sum([(1.0, origin_of(&rows.middle, &table.indices)), (1.0, middle)]));
            }
        }
        Self { tables, rival, limits, spokes }
    }

    /// The patch of an irregular face; none if it is not drawn as one.
    pub fn patch(&self, irregular_face: u32) -> Option<RivalPatch> {
        let face = &self.tables.gregory.faces[irregular_face as usize];
        if face.kind == GregoryKind::None {
            return None;
        }
        let corners = [0, 1, 2, 3].map(|i| self.corner(face, i));
        let shape = match self.rival {
            Rival::Acc => Shape::Acc(Box::new(AccPatch::new(&corners))),
            Rival::Pm => Shape::Pm(Box::new(PmPatch::new(&corners))),
        };
        Some(RivalPatch { shape, corners: [0, 1, 2, 3].map(|i| self.edge(&corners[i], &corners[(i + 1) % 4])) })
    }

    fn corner(&self, face: &GregoryFace, i: usize) -> RivalCorner {
        let (out, into) = (self.spokes[face.first[i] as usize], self.spokes[face.last[(i + 3) % 4] as usize]);
        RivalCorner {
            position: self.limits[face.limits[i] as usize],
            cosine: f64::from(face.cosines[i]),
            out: out.0,
            out_middle: out.1,
            into: into.0,
            into_middle: into.1,
        }
    }

    fn edge(&self, from: &RivalCorner, to: &RivalCorner) -> RivalCornerFields {
        let sine = |corner: &RivalCorner| (1.0 - corner.cosine * corner.cosine).sqrt();
        let (curve, scale) = match self.rival {
            Rival::Acc => ([from.position, from.out_middle, to.into_middle, to.position], 1.0),
            Rival::Pm => ([from.position, from.out.edge, to.into.edge, to.position], 2.0 / (sine(from) + sine(to))),
        };
        let step = |a: Vec3, b: Vec3| sum([(3.0, b), (-3.0, a)]);
        let along = [step(from.position, from.out.edge), step(curve[1], curve[2]), step(to.into.edge, to.position)];
        let turned = |v: Vec3, scale: f64| v.map(|c| -scale * c);
        let across = [
            from.out.across,
            from.out.beside.map(|c| scale * c),
            turned(to.into.beside, scale),
            turned(to.into.across, 1.0),
        ];
        (curve, along, across)
    }
}

impl RivalPatch {
    /// Position and tangents at (u, v) of its Ptex face; of ACC the tangents are those of its normals.
    pub fn evaluate(&self, u: f64, v: f64) -> SurfacePoint {
        match &self.shape {
            Shape::Acc(patch) => patch.evaluate(u, v),
            Shape::Pm(patch) => patch.evaluate(u, v),
        }
    }

    /// What both sides of edge i have at t: position, tangent along it, and the field across it to the left ([`EdgeFields`]).
    pub fn on_edge(&self, i: usize, t: f64) -> SurfacePoint {
        let (curve, along, across) = self.corners[i];
        let s = 1.0 - t;
        let du = sum([(s * s, along[0]), (2.0 * s * t, along[1]), (t * t, along[2])]);
        let (n, _) = bernstein(t);
        let point = EdgeFields { curve, across }.evaluate(t);
        SurfacePoint { du, dv: sum([0, 1, 2, 3].map(|i| (n[i], across[i]))), ..point }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{rival_spokes, spokes::sector_of};
    use super::*;
    use crate::mesh::ControlMesh;
    use crate::patch::evaluate;
    use crate::topology::Level;

    /// A sheet of 5 by 5 faces whose vertices lie anywhere near their place.
    fn sheet() -> ControlMesh {
        let place = |i: u32| {
            let bump = |k: u32| (f64::from(i * 7 + k).sin() * 0.3) as f32;
            [(i % 6) as f32 + bump(0), (i / 6) as f32 + bump(1), bump(2)]
        };
        let faces = (0..25_u32).flat_map(|face| {
            let first = face / 5 * 6 + face % 5;
            [first, first + 1, first + 7, first + 6]
        });
        ControlMesh {
            positions: (0..36).map(place).collect(),
            face_sizes: vec![4; 25],
            face_vertices: faces.collect(),
            ..ControlMesh::default()
        }
    }

    #[test]
    fn a_regular_face_is_its_bicubic_patch_by_either_scheme() {
        let mesh = sheet();
        let level = Level::from_mesh(&mesh).expect("a cage");
        let at = |v: u32| mesh.positions[v as usize].map(f64::from);
        let points: [Vec3; 16] = std::array::from_fn(|i| at(7 + (i / 4) as u32 * 6 + (i % 4) as u32));
        for rival in [Rival::Acc, Rival::Pm] {
            // The face in the middle.
            let start = level.half_edges(12).start;
            let corners = [0, 1, 2, 3].map(|i| {
                let corner = start + i;
                let sector = sector_of(&level, corner);
                let spokes = rival_spokes(&level, &sector, rival);
                let place = sector.spokes.iter().position(|&spoke| spoke == corner).expect("its own spoke");
                let vertex = at(level.origin(corner));
                let (u, v) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][i as usize];
                let position = evaluate(&points, u, v).position;
                let sum_of = |terms: &super::super::Terms| {
                    terms.iter().fold([0.0; 3], |made, &(v, w)| sum([(1.0, made), (w, at(v)), (-w, vertex)]))
                };
                let made = |j: usize| {
                    let spoke = &spokes[j % 4];
                    let edge = sum([(1.0, position), (1.0, sum_of(&spoke.edge))]);
                    let points = SpokePoints { edge, across: sum_of(&spoke.across), beside: sum_of(&spoke.beside) };
                    (points, sum([(1.0, vertex), (1.0, sum_of(&spoke.middle))]))
                };
                let ((out, out_middle), (into, into_middle)) = (made(place), made(place + 1));
                RivalCorner { position, cosine: 0.0, out, out_middle, into, into_middle }
            });
            let at = |u: f64, v: f64| match rival {
                Rival::Acc => AccPatch::new(&corners).evaluate(u, v),
                Rival::Pm => PmPatch::new(&corners).evaluate(u, v),
            };
            let off = |a: Vec3, b: Vec3| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
            // Four quartic triangles cannot be a bicubic patch inside, but have its edges, the planes along them and its middle.
            let inside = if rival == Rival::Acc { vec![(0.3, 0.4), (0.9, 0.2)] } else { vec![] };
            for (u, v) in [(0.3, 0.0), (1.0, 0.7), (0.6, 1.0), (0.0, 0.2)].into_iter().chain(inside) {
                let (point, expected) = (at(u, v), evaluate(&points, u, v));
                for (a, b) in [(point.position, expected.position), (point.du, expected.du), (point.dv, expected.dv)] {
                    assert!(off(a, b) < 1e-12, "{rival:?} at {u}, {v}: {a:?}, expected {b:?}");
                }
            }
            assert!(off(at(0.5, 0.5).position, evaluate(&points, 0.5, 0.5).position) < 1e-12, "{rival:?}");
        }
    }
}
