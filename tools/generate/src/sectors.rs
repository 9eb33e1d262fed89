//! Discs and fans around one vertex, and rings around one n-gon: everything else about them is regular.
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::cage::Cage;

/// Rings of faces around the middle: with two, the one-ring of the faces in the middle ends before the boundary.
const RINGS: u32 = 2;

/// A disc around an interior vertex of any valence. Its other interior vertices have valence 4.
pub fn disc(valence: u32) -> Cage {
    sectors(valence, TAU, true)
}

/// Half a disc around a boundary vertex with `face_count` faces; a quarter for one face.
pub fn fan(face_count: u32) -> Cage {
    sectors(face_count, if face_count == 1 { PI / 2.0 } else { PI }, false)
}

/// Sectors of [`RINGS`] x [`RINGS`] quads around a vertex; ring r of a sector has 2r edges.
///
/// A sector's diagonal bulges by the tangent of a quarter of its angle, as a square's does: without it the edges at a
/// corner of a narrow sector lie on one line, and the surface has no well-defined normal there.
fn sectors(count: u32, angle: f64, closed: bool) -> Cage {
    let bulge = (angle / f64::from(count) / 4.0).tan();
    let mut cage = Cage::default();
    let center = cage.vertex(dome(0.0, 0.0));
    let mut rings = vec![vec![center; count as usize + 1]];
    for ring in 1..=RINGS {
        let edge_count = 2 * ring * count;
        let vertex_count = if closed { edge_count } else { edge_count + 1 };
        let mut vertices: Vec<u32> = (0..vertex_count)
            .map(|i| {
                let inward = ring - (i % (2 * ring)).abs_diff(ring);
                let radius = f64::from(ring) + bulge * f64::from(inward);
                cage.vertex(dome(radius, f64::from(i) * angle / f64::from(edge_count)))
            })
            .collect();
        if closed {
            vertices.push(vertices[0]);
        }
        rings.push(vertices);
    }
    for sector in 0..count {
        for ring in 1..=RINGS {
            // Edge j of the sector's outer ring; the inner ring has two fewer, and the outer corner takes both.
            let outer = |j: u32| rings[ring as usize][(2 * ring * sector + j) as usize];
            let inner = |j: u32| match ring {
                1 => center,
                _ => rings[ring as usize - 1][(2 * (ring - 1) * sector + j) as usize],
            };
            for j in 0..ring - 1 {
                cage.face(&[inner(j), inner(j + 1), outer(j + 1), outer(j)]);
            }
            cage.face(&[inner(ring - 1), outer(ring + 1), outer(ring), outer(ring - 1)]);
            for j in ring + 1..2 * ring {
                cage.face(&[inner(j - 2), inner(j - 1), outer(j + 1), outer(j)]);
            }
        }
    }
    cage
}

/// A face of any number of sides among quads; its vertices have valence 4.
pub fn ngon(sides: u32) -> Cage {
    let mut cage = Cage::default();
    let mut rings: Vec<Vec<u32>> = Vec::new();
    for ring in 0..=RINGS {
        let count = sides * (1 + 2 * ring);
        // The middle of side 0 lies at angle 0 in every ring, so that sides lie above sides.
        let angle = |i: u32| (f64::from(i) - f64::from(ring) - 0.5) * TAU / f64::from(count);
        rings.push((0..count).map(|i| cage.vertex(dome(f64::from(ring) + 0.8, angle(i)))).collect());
    }
    let mut middle = rings[0].clone();
    middle.reverse();
    cage.faces.push(middle);
    for ring in 0..RINGS {
        let (inner_edges, outer_edges) = (1 + 2 * ring, 3 + 2 * ring);
        let inner = |i: u32| rings[ring as usize][(i % (sides * inner_edges)) as usize];
        let outer = |i: u32| rings[ring as usize + 1][(i % (sides * outer_edges)) as usize];
        for side in 0..sides {
            let (first, outer_first) = (side * inner_edges, side * outer_edges);
            for edge in 0..inner_edges {
                let (i, o) = (first + edge, outer_first + edge + 1);
                cage.face(&[inner(i), inner(i + 1), outer(o + 1), outer(o)]);
            }
            let (corner, after) = (first + inner_edges, outer_first + outer_edges);
            cage.face(&[inner(corner), outer(after + 1), outer(after), outer(after - 1)]);
        }
    }
    cage
}

/// A point of a waved dome, given in polar coordinates; angles run from +x towards +z.
fn dome(radius: f64, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    let (x, z) = (radius * cos, radius * sin);
    DVec3::new(x, 0.9 * (0.55 * x + 0.3).cos() * (0.5 * z - 0.2).cos() + 0.1 * x * z, z)
}
