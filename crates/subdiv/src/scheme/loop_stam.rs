//! Stam and Loop 2003: triangles and quads mixed. Where all faces are triangles it is Loop's scheme, where all are quads Catmull and
//! Clark's, weight by weight.
//!
//! Linear subdivision, and then an average: of a vertex with edges to M_i (middles of edges) and quads around Q_j (their centres)
//! (1 - m) v + m (2 sum M_i + sum Q_j) / (2 e + q). Stam and Loop take m = 1 - 1 / (1 + e/2 + q/4) and correct it by a factor of
//! each valence that they found numerically. Here m is Loop's and Catmull-Clark's own, 2 n beta(n) and 3 / n, for as many triangles or
//! quads as there were room for, weighed by the share of each: exact in both pure cases, and 3/4 where the mixture is regular.

use super::loop_scheme::beta;
use super::{Row, Rules};
use crate::basis::poly::{CUT, Fan, Poly};

pub(super) struct LoopStam;

/// Triangles that fill as much of a regular vertex as a quad does.
const TRIANGLES_A_QUAD: f64 = 1.5;

impl Rules for LoopStam {
    fn splits_in_triangles(&self, sides: u32) -> bool {
        sides == 3
    }

    /// 3/8 of each end, 1/8 of a triangle's far vertex, 1/16 of a quad's two.
    fn smooth_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        let twin = Some(poly.twin(h)).filter(|&twin| twin < CUT)?;
        let mut row = vec![(poly.origin(h), 0.375), (poly.head(h), 0.375)];
        for half in [h, twin] {
            let far = poly.previous(half);
            if poly.sides(poly.face[half as usize]) == 3 {
                row.push((poly.origin(far), 0.125));
            } else {
                row.extend([(poly.origin(far), 0.0625), (poly.origin(poly.previous(far)), 0.0625)]);
            }
        }
        Some(row)
    }

    fn smooth_vertex(&self, poly: &Poly, vertex: u32, fan: &Fan) -> Option<Row> {
        let edges = fan.ends.len() as f64;
        let sides = |spoke: &u32| poly.sides(poly.face[*spoke as usize]);
        let quads = fan.spokes.iter().filter(|spoke| sides(spoke) == 4).count() as f64;
        let triangles = edges - quads;
        let of_loop = |n: f64| 2.0 * n * beta(n);
        let of_catmull_clark = |n: f64| 3.0 / n;
        let share = triangles / edges;
        let moved = share * of_loop(triangles + TRIANGLES_A_QUAD * quads)
            + (1.0 - share) * of_catmull_clark(quads + triangles / TRIANGLES_A_QUAD);
        let unit = moved / (2.0 * edges + quads);
        let mut row = vec![(vertex, 1.0 - moved)];
        for &end in &fan.ends {
            row.extend([(vertex, unit), (end, unit)]);
        }
        for spoke in fan.spokes.iter().filter(|spoke| sides(spoke) == 4) {
            row.extend(self.face(poly, poly.face[*spoke as usize]).into_iter().map(|(v, w)| (v, unit * w)));
        }
        Some(row)
    }
}
