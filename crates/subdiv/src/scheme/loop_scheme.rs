//! Loop 1987.

use std::f64::consts::PI;

use super::{Row, Rules};
use crate::basis::poly::{CUT, Fan, Poly};

pub(super) struct Loop;

/// Weight of each of n neighbours of a vertex: (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n. Of a number between whole ones too.
pub(super) fn beta(n: f64) -> f64 {
    let base = 0.375 + 0.25 * (2.0 * PI / n).cos();
    (0.625 - base * base) / n
}

impl Rules for Loop {
    fn splits_in_triangles(&self, _sides: u32) -> bool {
        true
    }

    /// 3/8 of each end, 1/8 of the vertex across in each triangle.
    fn smooth_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        let twin = Some(poly.twin(h)).filter(|&twin| twin < CUT)?;
        let far = [h, twin].map(|half| (poly.origin(poly.previous(half)), 0.125));
        Some(vec![(poly.origin(h), 0.375), (poly.head(h), 0.375), far[0], far[1]])
    }

    fn smooth_vertex(&self, _poly: &Poly, vertex: u32, fan: &Fan) -> Option<Row> {
        let n = fan.ends.len() as f64;
        let weight = beta(n);
        let mut row = vec![(vertex, 1.0 - n * weight)];
        row.extend(fan.ends.iter().map(|&end| (end, weight)));
        Some(row)
    }
}
