//! The two schemes that the Gregory patch paper measures itself against (Loop et al. 2009, section 5): what their vertices give to the
//! patches around them. For quads alone, irregular ones away from boundaries and creases, as their papers are.

use std::f64::consts::PI;

use super::spokes::{THIRD, sector_of, smooth_value};
use crate::error::Error;
use crate::topology::{Level, Sector};

/// Which scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// Loop and Schaefer 2008, *Approximating Catmull-Clark Subdivision Surfaces with Bicubic Patches*: a bicubic patch for positions
    /// and two patches of tangents for normals.
    Acc,
    /// Myles, Ni and Peters 2008, *Fast Parallel Construction of Smooth Surfaces from Meshes with Tri/Quad/Pent Facets*: four quartic
    /// triangles around the middle of a quad.
    Pm,
}

impl Rival {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Acc => "acc",
            Self::Pm => "pm",
        }
    }

    /// Refuses a cage that it has no patches for.
    pub(crate) fn check(self, level: &Level, irregular: &[u32]) -> Result<(), Error> {
        let refuse = |face: u32, found: String| Err(Error::RivalCage { method: self.name(), face, found });
        for face in (0..level.drawn_count).filter(|&face| level.is_drawn(face)) {
            if level.sides(face) != 4 {
                return refuse(face, format!("has {} sides", level.sides(face)));
            }
        }
        for &face in irregular.iter().filter(|&&face| level.is_drawn(face)) {
            for corner in level.half_edges(face) {
                let vertex = level.origin(corner);
                let (sector, tag) = (sector_of(level, corner), level.tag(vertex));
                if tag.is_corner() {
                    return refuse(face, format!("has a sharp vertex {vertex}"));
                }
                // A hole counts: it is no patch, but its points are those of the patches beside it.
                if !tag.touches_only_quads() {
                    return refuse(face, format!("touches a face of other than four sides at vertex {vertex}"));
                }
                if !tag.is_plain() || !sector.is_closed {
                    return refuse(face, format!("touches a boundary or crease at vertex {vertex}"));
                }
                if sector.spokes.len() < 3 {
                    return refuse(face, format!("has vertex {vertex} of valence 2"));
                }
            }
        }
        Ok(())
    }
}

/// Weights over the vertices of a level that sum to 0; the vertex itself is left out.
pub(crate) type Terms = Vec<(u32, f64)>;

/// What a vertex gives to the patches along one of its edges: [`super::SpokePoints`] of its own making, and a point more.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RivalSpoke {
    /// From the limit position to the end of a third of the tangent along the edge. Pm: the curve's control point.
    pub edge: Terms,
    /// Derivative across the edge at the vertex, as of Gregory patches.
    pub across: Terms,
    /// 3/2 (inner point of the face to the left - of that to the right).
    pub beside: Terms,
    /// From the vertex to the mean of both inner points. ACC: the curve's control point.
    pub middle: Terms,
}

/// The spokes of a vertex that [`Rival::check`] lets pass.
pub(crate) fn rival_spokes(level: &Level, sector: &Sector, rival: Rival) -> Vec<RivalSpoke> {
    let n = sector.spokes.len();
    let step = 2.0 * PI / n as f64;
    // Of each face around: its first neighbour, its second, and the vertex opposite.
    let faces: Vec<[u32; 3]> = sector
        .spokes
        .iter()
        .map(|&spoke| {
            let (near, far) = (level.next(spoke), level.next(level.next(spoke)));
            [level.origin(near), level.head(far), level.origin(far)]
        })
        .collect();
    // Offset of a face's inner point from the vertex.
    let inner = |j: usize, weight: f64| -> [(u32, f64); 3] {
        let scale = match rival {
            // The valence in place of the regular 4: (n v + 2 (d + d') + q) / (n + 5).
            Rival::Acc => weight / (n as f64 + 5.0),
            Rival::Pm => weight / 9.0,
        };
        let [first, second, opposite] = faces[j % n];
        [(first, 2.0 * scale), (second, 2.0 * scale), (opposite, scale)]
    };
    let before = |j: usize| (j + n - 1) % n;
    let middle = |j: usize, weight: f64| inner(j, 0.5 * weight).into_iter().chain(inner(before(j), 0.5 * weight));
    let edge = |j: usize, weight: f64| -> Terms {
        match rival {
            Rival::Acc => {
                // The limit tangent, as long as that of a regular vertex is.
                let half = (0.5 * step).cos();
                let sigma = (4.0 + half * half).powf(-0.5);
                let scale = THIRD * weight / n as f64;
                (0..n)
                    .flat_map(|i| {
                        let angle = step * (i as f64 - j as f64);
                        let [first, _, opposite] = faces[i];
                        let of_edge = scale * (1.0 + sigma * half) * angle.cos();
                        [(first, of_edge), (opposite, scale * sigma * (angle + 0.5 * step).cos())]
                    })
                    .collect()
            }
            Rival::Pm => {
                let scale = weight / (smooth_value(n) * n as f64);
                (0..n).flat_map(|i| middle(i, scale * (step * (i as f64 - j as f64)).cos())).collect()
            }
        }
    };
    let vertex = level.origin(sector.spokes[0]);
    let made = (0..n).map(|j| RivalSpoke {
        edge: merged(edge(j, 1.0), vertex),
        across: merged([edge((j + 1) % n, 1.5), edge(before(j), -1.5)].concat(), vertex),
        beside: merged(inner(j, 1.5).into_iter().chain(inner(before(j), -1.5)).collect(), vertex),
        middle: merged(middle(j, 1.0).collect(), vertex),
    });
    made.collect()
}

/// Each vertex once, in ascending order, without the vertex that the others are taken from.
pub(crate) fn merged(mut terms: Terms, vertex: u32) -> Terms {
    terms.sort_by_key(|term| term.0);
    let mut merged: Terms = Vec::with_capacity(terms.len());
    for (v, weight) in terms.into_iter().filter(|&(v, _)| v != vertex) {
        match merged.last_mut() {
            Some(last) if last.0 == v => last.1 += weight,
            _ => merged.push((v, weight)),
        }
    }
    merged.retain(|(_, weight)| weight.abs() > 1e-12);
    merged
}
