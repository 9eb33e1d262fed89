//! A channel at any (Ptex face, u, v), through the tables.

use std::collections::HashMap;

use super::FaceVaryingTable;
use crate::patch::{SurfacePoint, evaluate, evaluate_crease};
use crate::tables::Tables;
use crate::topology::NONE;

/// Evaluates one channel of one mesh's tables in f64: exactly in patches, at the corners of irregular faces at the end of
/// refinement and in those middles of their edges that are there; between these bilinearly, as the face is drawn.
#[derive(Debug)]
pub struct FaceVaryingEvaluator<'a> {
    tables: &'a Tables,
    table: &'a FaceVaryingTable,
    /// What covers each square of a Ptex face that is no further divided.
    cells: HashMap<(u32, u8, u16, u16), Cell>,
    /// Halvings of the smallest square.
    depth: u8,
}

/// What lies in a square of a Ptex face: a place among the tables' patches, irregular faces or filling quads.
#[derive(Clone, Copy, Debug)]
enum Cell {
    Patch(u32),
    Face(u32),
    Filling(u32),
}

impl<'a> FaceVaryingEvaluator<'a> {
    /// Of a channel of tables of one mesh; `None` if there is no such channel.
    pub fn new(tables: &'a Tables, channel: usize) -> Option<Self> {
        let table = tables.face_varying.get(channel)?;
        let mut evaluator = Self { tables, table, cells: HashMap::new(), depth: 0 };
        let faces = (0..).zip(&tables.irregular).filter(|(_, face)| face.limits != [NONE; 4]);
        let patches = (0..).zip(&tables.patches).map(|(i, patch)| (patch.info.location, Cell::Patch(i)));
        let faces = faces.map(|(i, face)| (face.info.location, Cell::Face(i)));
        let quads = (0..).zip(&tables.filling).map(|(i, quad)| (quad.info.location, Cell::Filling(i)));
        for (location, cell) in patches.chain(faces).chain(quads) {
            evaluator.depth = evaluator.depth.max(location.depth);
            evaluator.cells.insert((location.ptex_face, location.depth, location.u, location.v), cell);
        }
        Some(evaluator)
    }

    /// The value at (u, v) of a Ptex face, both 0 to 1; `None` where the face has no surface. Where a point lies on the
    /// border of a patch and of an irregular face, the patch answers.
    pub fn evaluate(&self, ptex_face: u32, u: f64, v: f64) -> Option<[f64; 2]> {
        let mut found = None;
        for depth in (0..=self.depth).rev() {
            for (i, local_u) in squares(u, depth) {
                for (j, local_v) in squares(v, depth) {
                    match self.cells.get(&(ptex_face, depth, i, j)) {
                        Some(&Cell::Patch(patch)) => return Some(self.in_patch(patch, local_u, local_v)),
                        // A coarser square may be that of the face's parent.
                        Some(&cell) if found.is_none() => found = Some((cell, local_u, local_v)),
                        _ => {}
                    }
                }
            }
        }
        let (cell, u, v) = found?;
        Some(match cell {
            Cell::Patch(patch) => self.in_patch(patch, u, v),
            Cell::Face(face) => self.in_face(&self.table.faces[face as usize], u, v),
            Cell::Filling(quad) => {
                let [a, b, c, d] = self.table.filling[quad as usize];
                self.in_face(&[a, b, c, d, NONE, NONE, NONE, NONE], u, v)
            }
        })
    }

    fn value(&self, value: u32) -> [f64; 2] {
        self.table.values[value as usize].map(f64::from)
    }

    fn in_patch(&self, patch: u32, u: f64, v: f64) -> [f64; 2] {
        let points = self.table.patches[patch as usize].map(|value| {
            let [s, t] = self.value(value);
            [s, t, 0.0]
        });
        let of = &self.tables.patches[patch as usize];
        let point: SurfacePoint = match of.info.crease {
            0 => evaluate(&points, u, v),
            crease => evaluate_crease(&points, crease, f64::from(of.sharpness), u, v),
        };
        [point.position[0], point.position[1]]
    }

    fn in_face(&self, values: &[u32; 8], u: f64, v: f64) -> [f64; 2] {
        let middles = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)];
        let middle = (4..).zip(middles).find(|&(i, at)| at == (u, v) && values[i] != NONE);
        if let Some((i, _)) = middle {
            return self.value(values[i]);
        }
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
        let corners = values.iter().zip(weights).map(|(&value, weight)| self.value(value).map(|c| weight * c));
        corners.fold([0.0; 2], |sum, corner| [sum[0] + corner[0], sum[1] + corner[1]])
    }
}

/// The squares of a depth that a coordinate lies in or on the border of, and where in them.
fn squares(t: f64, depth: u8) -> impl Iterator<Item = (u16, f64)> {
    let count = f64::from(1_u32 << depth);
    let place = (t * count).floor().clamp(0.0, count - 1.0);
    let local = t * count - place;
    let below = (local == 0.0 && place > 0.0).then_some((place as u16).wrapping_sub(1));
    std::iter::once((place as u16, local)).chain(below.map(|place| (place, 1.0)))
}
