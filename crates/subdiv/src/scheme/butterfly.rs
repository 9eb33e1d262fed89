//! Modified Butterfly: Dyn, Levin and Gregory 1990 with the stencils of Zorin, Schroeder and Sweldens 1996 at extraordinary vertices.
//! It interpolates: vertices stay.
//!
//! Along boundaries and creases points are interpolated by the four-point rule, at their ends by a parabola. Beside them a triangle
//! that is not there stands mirrored, a + c - b for the triangle a b c: what is linear is reproduced.

use std::f64::consts::PI;

use super::{Row, Rules};
use crate::basis::poly::{BORDER, CUT, Fan, Poly};
use crate::mesh::INFINITE_SHARPNESS;

pub(super) struct Butterfly;

/// Weights around a vertex of valence K, of the edge's other end first: (1/4 + cos(2 pi j / K) + cos(4 pi j / K) / 2) / K, and special
/// ones for 3 and 4. The vertex itself has 3/4.
fn spoke_weights(valence: usize) -> Vec<f64> {
    match valence {
        3 => vec![5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0],
        4 => vec![0.375, 0.0, -0.125, 0.0],
        _ => {
            let k = valence as f64;
            let weight = |j: usize| {
                let angle = 2.0 * PI * j as f64 / k;
                (0.25 + angle.cos() + 0.5 * (2.0 * angle).cos()) / k
            };
            (0..valence).map(weight).collect()
        }
    }
}

/// Whether the surface does not go on smoothly across an edge.
fn is_barrier(poly: &Poly, h: u32) -> bool {
    poly.twin(h) == BORDER || poly.sharpness(h) >= INFINITE_SHARPNESS
}

/// Whether a vertex has the stencil of extraordinary ones: inside, smooth all around, and of other than six triangles.
fn is_extraordinary(poly: &Poly, vertex: u32) -> Option<bool> {
    if !poly.is_whole[vertex as usize] {
        return None;
    }
    let fan = poly.fan(vertex, None);
    let is_inside = fan.is_closed && fan.spokes.iter().all(|&spoke| !is_barrier(poly, spoke));
    Some(is_inside && fan.spokes.len() != 6)
}

/// The vertex across edge `h` from its triangle, `weight` times; mirrored where there is none.
fn wing(poly: &Poly, h: u32, weight: f64, row: &mut Row) -> Option<()> {
    if is_barrier(poly, h) {
        let far = poly.origin(poly.previous(h));
        row.extend([(poly.origin(h), weight), (poly.head(h), weight), (far, -weight)]);
        return Some(());
    }
    let twin = Some(poly.twin(h)).filter(|&twin| twin < CUT)?;
    row.push((poly.origin(poly.previous(twin)), weight));
    Some(())
}

/// The edge's point by the stencil around the origin of one of its half-edges.
fn around(poly: &Poly, h: u32) -> Row {
    let vertex = poly.origin(h);
    let fan = poly.fan(vertex, Some(h));
    let mut row = vec![(vertex, 0.75)];
    row.extend(fan.ends.iter().copied().zip(spoke_weights(fan.ends.len())));
    row
}

/// Where the crease or boundary goes on at an end of an edge: the other sharp edge's end, if there are two and the vertex is smooth.
fn beyond(poly: &Poly, edge: u32, vertex: u32) -> Option<Option<u32>> {
    if !poly.is_whole[vertex as usize] {
        return None;
    }
    let fan = poly.fan(vertex, None);
    let around = fan.edges.iter().zip(&fan.ends).filter(|(other, _)| **other != edge);
    let others: Vec<u32> =
        around.filter(|(other, _)| poly.edge_sharpness[**other as usize] > 0.0).map(|(_, &end)| end).collect();
    let goes_on = poly.vertex_sharpness[vertex as usize] <= 0.0 && others.len() == 1;
    Some(goes_on.then(|| others[0]))
}

impl Rules for Butterfly {
    fn splits_in_triangles(&self, _sides: u32) -> bool {
        true
    }

    fn width(&self) -> u32 {
        2
    }

    fn smooth_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        let twin = Some(poly.twin(h)).filter(|&twin| twin < CUT)?;
        let special: Vec<u32> =
            [(h, is_extraordinary(poly, poly.origin(h))?), (twin, is_extraordinary(poly, poly.head(h))?)]
                .into_iter()
                .filter_map(|(half, is)| is.then_some(half))
                .collect();
        if !special.is_empty() {
            let share = 1.0 / special.len() as f64;
            let rows = special.into_iter().flat_map(|half| around(poly, half));
            return Some(rows.map(|(vertex, weight)| (vertex, share * weight)).collect());
        }
        // Ends 1/2, vertices across 1/8, wings -1/16.
        let mut row = vec![(poly.origin(h), 0.5), (poly.head(h), 0.5)];
        for half in [h, twin] {
            row.push((poly.origin(poly.previous(half)), 0.125));
            wing(poly, poly.next(half), -0.0625, &mut row)?;
            wing(poly, poly.previous(half), -0.0625, &mut row)?;
        }
        Some(row)
    }

    /// (-1, 9, 9, -1) / 16; at an end of the curve (6, 3, -1) / 8.
    fn crease_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        let (a, b) = (poly.origin(h), poly.head(h));
        let edge = poly.edge[h as usize];
        Some(match (beyond(poly, edge, a)?, beyond(poly, edge, b)?) {
            (Some(far), Some(near)) => vec![(a, 0.5625), (b, 0.5625), (far, -0.0625), (near, -0.0625)],
            (None, Some(near)) => vec![(a, 0.375), (b, 0.75), (near, -0.125)],
            (Some(far), None) => vec![(b, 0.375), (a, 0.75), (far, -0.125)],
            (None, None) => vec![(a, 0.5), (b, 0.5)],
        })
    }

    fn smooth_vertex(&self, _poly: &Poly, vertex: u32, _fan: &Fan) -> Option<Row> {
        Some(vec![(vertex, 1.0)])
    }

    fn crease_vertex(&self, vertex: u32, _ends: [u32; 2]) -> Row {
        vec![(vertex, 1.0)]
    }

    fn interpolates(&self) -> bool {
        true
    }
}
