//! The paper's fixed set of configurations: faces with one extraordinary vertex, of valence 3 to 18, inside and on a boundary. Cages need
//! no such set: theirs are the configurations that they have.

use std::collections::BTreeMap;

use crate::basis::build::BasisOptions;
use crate::error::Error;
use crate::mesh::ControlMesh;
use crate::scheme::Scheme;
use crate::tables::Tables;

/// Valences that the paper's tables are for.
pub const FIXED_VALENCES: std::ops::RangeInclusive<u32> = 3..=18;
/// Rings of faces around the vertex: more than any scheme looks at.
const RINGS: u32 = 4;

/// How large a set of tables is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableSet {
    /// Distinct tables of faces.
    pub configurations: usize,
    /// Weights of positions in all of them.
    pub weights: usize,
}

impl TableSet {
    /// Of the faces of tables.
    pub fn of(tables: &Tables) -> Self {
        let rows_of = |is_triangle: bool| {
            let points = (1_usize << tables.basis.level) + 1;
            if is_triangle { points * (points + 1) / 2 } else { points * points }
        };
        let is_triangle = |flags: u32| flags & crate::tables::TABLE_TRIANGLE != 0;
        let sizes: BTreeMap<u32, usize> = tables
            .basis
            .patches
            .iter()
            .map(|patch| (patch.first_weight, patch.control_count as usize * rows_of(is_triangle(patch.flags))))
            .collect();
        Self { configurations: sizes.len(), weights: sizes.values().sum() }
    }

    /// Bytes of the weights of positions as floats: what the paper counts.
    pub fn bytes(&self) -> usize {
        4 * self.weights
    }
}

/// The paper's set for a scheme, with 2^`level` segments a side.
///
/// # Errors
/// When refinement fails.
pub fn fixed_set(scheme: Scheme, level: u32) -> Result<TableSet, Error> {
    let mut set = TableSet::default();
    let options = BasisOptions { scheme, steps: 0, level, ring_level: None, has_weights: true };
    for valence in FIXED_VALENCES {
        for is_closed in [true, false] {
            let (mesh, faces) = pole(scheme.is_triangle(3), valence, is_closed);
            let mut tables = Tables::of_basis(&mesh, &options)?;
            tables.basis.patches.truncate(faces);
            let own = TableSet::of(&tables);
            set.configurations += own.configurations;
            set.weights += own.weights;
        }
    }
    Ok(set)
}

/// A disc, or half of one, around a vertex with so many edges, and the number of faces there, which come first.
fn pole(of_triangles: bool, valence: u32, is_closed: bool) -> (ControlMesh, usize) {
    let sectors = if is_closed { valence } else { valence - 1 };
    let rays = if is_closed { sectors } else { sectors + 1 };
    // Point (i, j) of sector s: i along its first ray, j along the next; points with i = 0 are the next sector's.
    let inner = RINGS + 1;
    let at = |s: u32, i: u32, j: u32| match (i, j) {
        (0, 0) => 0,
        (0, j) => 1 + (s + 1) % rays * RINGS * inner + (j - 1) * inner,
        (i, j) => 1 + s * RINGS * inner + (i - 1) * inner + j,
    };
    let mut near = Vec::new();
    let mut far = Vec::new();
    for s in 0..sectors {
        for (i, j) in (0..RINGS).flat_map(|i| (0..RINGS).map(move |j| (i, j))) {
            let corners = [at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)];
            let to = if i + j == 0 { &mut near } else { &mut far };
            if !of_triangles {
                to.push(corners.to_vec());
                continue;
            }
            if i + j < RINGS {
                to.push(vec![corners[0], corners[1], corners[3]]);
            }
            if i + j + 1 < RINGS {
                far.push(vec![corners[1], corners[2], corners[3]]);
            }
        }
    }
    let count = near.len();
    let faces = [near, far].concat();
    let vertex_count = 1 + rays * RINGS * inner;
    let mesh = ControlMesh {
        // Tables know nothing of positions.
        positions: vec![[0.0; 3]; vertex_count as usize],
        face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..ControlMesh::default()
    };
    (mesh, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_s_set_has_a_table_for_each_valence_inside_and_for_each_face_of_a_boundary() {
        let inside = FIXED_VALENCES.count();
        // With its own vertex of 2 to 17 faces; some faces are alike.
        let most = inside + FIXED_VALENCES.map(|valence| valence as usize - 1).sum::<usize>();
        for scheme in [Scheme::Loop, Scheme::CatmullClark] {
            let set = fixed_set(scheme, 1).expect("tables");
            assert!((inside + 16..=most).contains(&set.configurations), "{scheme:?}: {set:?}");
        }
    }
}
