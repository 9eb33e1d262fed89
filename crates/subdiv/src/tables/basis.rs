//! Basis function tables (Hollaender and Boubekeur 2010) as the GPU reads them: faces of the cage after its first steps, edges between them,
//! and the weights of the points of their grids.

use crate::tables::merge::following;

/// Flag of a [`BasisPatch`]: it has three sides.
pub const TABLE_TRIANGLE: u32 = 1 << 8;

/// A face of the cage after its first steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BasisPatch {
    /// Limit points; of a triangle the last is the first.
    pub corners: [u32; 4],
    /// For each edge, from corner i on: its number in [`BasisTable::edges`] times 2, plus 1 where it runs the other way.
    pub edges: [u32; 4],
    /// Place of its controls in [`BasisTable::controls`].
    pub first_control: u32,
    /// How many it has: weights a row.
    pub control_count: u32,
    /// Place of row 0 in the weights.
    pub first_weight: u32,
    /// Ptex face, counted within the mesh.
    pub ptex_face: u32,
    /// Parameters of the corners on the Ptex face in 2^-steps: bits 6i and on of corner i, three for u and three for v.
    pub corner_uvs: u32,
    /// Bits 0-3: edges whose normals are the face's own; 4-7: corners; and [`TABLE_TRIANGLE`].
    pub flags: u32,
}

/// An edge between such faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BasisEdge {
    /// Place of its controls in [`BasisTable::controls`].
    pub first_control: u32,
    /// How many it has: weights a row.
    pub control_count: u32,
    /// Place of row 0 in the weights.
    pub first_weight: u32,
}

/// All of a mesh's, or of several meshes as one; empty for other methods than `table`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BasisTable {
    /// A side of a face has 2^level segments.
    pub level: u32,
    /// The faces are those of the cage split so often.
    pub steps: u32,
    /// Level of the vertices that have rings.
    pub ring_level: u32,
    /// For each vertex of that level the ends of its edges, counter-clockwise, and whether the last lies beside the first; empty where
    /// no geometric normals are asked for.
    pub rings: Vec<(Vec<u32>, bool)>,
    /// Faces that have a surface.
    pub patches: Vec<BasisPatch>,
    /// Their edges.
    pub edges: Vec<BasisEdge>,
    /// Points that are weighed.
    pub controls: Vec<u32>,
    /// Weights of positions: configuration by configuration, row by row.
    pub weights: Vec<f32>,
    /// Weights of the tangents along u and v, at the same places.
    pub tangents: Vec<[f32; 2]>,
}

impl BasisTable {
    /// Appends another mesh's; `points` says where its points are now, `first_limit` where its limit points begin. Returns the range
    /// of its patches.
    pub(super) fn append(&mut self, part: &Self, points: &[u32], first_limit: u32) -> std::ops::Range<u32> {
        (self.level, self.steps, self.ring_level) = (part.level, part.steps, part.ring_level);
        let range = following(self.patches.len() as u32, part.patches.len() as u32);
        let (first_control, first_edge) = (self.controls.len() as u32, self.edges.len() as u32);
        let first_weight = self.weights.len() as u32;
        self.patches.extend(part.patches.iter().map(|patch| BasisPatch {
            corners: patch.corners.map(|limit| limit + first_limit),
            edges: patch.edges.map(|edge| edge + 2 * first_edge),
            first_control: patch.first_control + first_control,
            first_weight: patch.first_weight + first_weight,
            ..*patch
        }));
        self.edges.extend(part.edges.iter().map(|edge| BasisEdge {
            first_control: edge.first_control + first_control,
            first_weight: edge.first_weight + first_weight,
            ..*edge
        }));
        self.rings.extend(
            part.rings
                .iter()
                .map(|(ring, is_closed)| (ring.iter().map(|&point| points[point as usize]).collect(), *is_closed)),
        );
        self.controls.extend(part.controls.iter().map(|&point| points[point as usize]));
        self.weights.extend(&part.weights);
        self.tangents.extend(&part.tangents);
        range
    }
}
