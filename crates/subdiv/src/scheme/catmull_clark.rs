//! Catmull and Clark 1978, as FAS section 3.1 has it; smooth triangles are OpenSubdiv's.

use super::{Row, Rules};
use crate::basis::poly::{CUT, Fan, Poly};
use crate::mesh::TriangleSubdivision;
use crate::rules::edge_face_weight;

pub(super) struct CatmullClark {
    pub triangles: TriangleSubdivision,
}

impl Rules for CatmullClark {
    fn splits_in_triangles(&self, _sides: u32) -> bool {
        false
    }

    /// (v + e + f + f) / 4.
    fn smooth_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        let twin = Some(poly.twin(h)).filter(|&twin| twin < CUT)?;
        let faces = [poly.face[h as usize], poly.face[twin as usize]];
        let weight = edge_face_weight(self.triangles, faces.map(|face| poly.sides(face)));
        let end = 0.5 - weight;
        let mut row = vec![(poly.origin(h), end), (poly.head(h), end)];
        for face in faces {
            row.extend(self.face(poly, face).into_iter().map(|(vertex, w)| (vertex, weight * w)));
        }
        Some(row)
    }

    /// (n-2)/n v + 1/n^2 sum e + 1/n^2 sum f.
    fn smooth_vertex(&self, poly: &Poly, vertex: u32, fan: &Fan) -> Option<Row> {
        let n = fan.spokes.len() as f64;
        let share = 1.0 / (n * n);
        let mut row = vec![(vertex, (n - 2.0) / n)];
        row.extend(fan.ends.iter().map(|&end| (end, share)));
        for &spoke in &fan.spokes {
            row.extend(self.face(poly, poly.face[spoke as usize]).into_iter().map(|(v, w)| (v, share * w)));
        }
        Some(row)
    }
}
