//! Density slots: where the density of tessellation is known, one a cage vertex and one an n-gon, and whose densities
//! decide about the faces there.

use crate::stencil::MAX_SUBSTITUTED_SIDES;
use crate::tables::IndexLists;
use crate::topology::{Level, NONE};

/// Marks an entry of [`DensitySlots::rings`]: a vertex of a face of more than four sides, whose density counts 1.5 times.
pub const WIDE: u32 = 1 << 31;

/// Marks the third entry of a Ptex face that is a part of an n-gon: the n-gon's slot.
pub const NGON: u32 = 1 << 31;

/// The density slots of a mesh: slot v below the number of cage points is vertex v; then one for each n-gon (a face of
/// other than four sides). Indices are slots of the mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DensitySlots {
    /// Number of n-gons.
    pub ngon_count: u32,
    /// For each vertex those at the other ends of its edges, each once; for an n-gon nothing.
    pub neighbours: IndexLists,
    /// For each vertex at an irregular face the vertices of all faces there, itself among them, each once and marked as
    /// [`WIDE`] if one of these faces has more than four sides; but a face of more than [`MAX_SUBSTITUTED_SIDES`] sides
    /// is one entry, its slot: n lists of n would cost n^2. Nothing for other vertices. For an n-gon its corners, in
    /// their order.
    pub rings: IndexLists,
}

impl DensitySlots {
    /// The slots of level 0; `irregular_faces` are those of which some frames are refined, or draw limit points.
    pub(crate) fn new(level: &Level, irregular_faces: &[u32]) -> Self {
        let vertex_count = level.tags.len() as u32;
        let ngons = ngons(level);
        let mut slot_of_face = vec![NONE; level.face_count() as usize];
        for (&face, slot) in ngons.iter().zip(vertex_count..) {
            slot_of_face[face as usize] = slot;
        }
        let mut is_asked_for = vec![false; vertex_count as usize];
        for &vertex in irregular_faces.iter().flat_map(|&face| level.vertices(face)) {
            is_asked_for[vertex as usize] = true;
        }
        let mut slots = Self { ngon_count: ngons.len() as u32, ..Self::default() };
        for vertex in 0..vertex_count {
            let is_used = level.starts[vertex as usize] != NONE;
            let edges = if is_used { level.incident_edges(vertex) } else { Vec::new() };
            let mut ends: Vec<u32> = edges.into_iter().map(|edge| level.other_end(edge, vertex)).collect();
            ends.sort_unstable();
            ends.dedup();
            slots.neighbours.push(ends);
            slots.rings.push(if is_asked_for[vertex as usize] { ring(level, vertex, &slot_of_face) } else { vec![] });
        }
        for &face in &ngons {
            slots.neighbours.push([]);
            slots.rings.push(level.vertices(face).iter().copied());
        }
        slots
    }
}

impl DensitySlots {
    /// Those of vertices alone.
    pub(crate) fn of_vertices(&self, vertex_count: u32) -> Self {
        let mut slots = Self::default();
        for vertex in 0..vertex_count {
            slots.neighbours.push(self.neighbours.of(vertex).iter().copied());
            slots.rings.push([]);
        }
        slots
    }
}

/// The faces of level 0 that are no quads.
fn ngons(level: &Level) -> Vec<u32> {
    (0..level.face_count()).filter(|&face| level.sides(face) != 4).collect()
}

/// The entries of a vertex' ring, in ascending order of their slots.
fn ring(level: &Level, vertex: u32, slot_of_face: &[u32]) -> Vec<u32> {
    let mut entries = Vec::new();
    for spoke in level.all_spokes(vertex) {
        let face = level.face(spoke);
        match level.sides(face) {
            sides if sides > MAX_SUBSTITUTED_SIDES => entries.push(slot_of_face[face as usize]),
            sides if sides > 4 => entries.extend(level.vertices(face).iter().map(|vertex| vertex | WIDE)),
            _ => entries.extend(level.vertices(face)),
        }
    }
    // Of the two entries of one vertex the marked one wins.
    entries.sort_unstable_by_key(|&entry| (entry & !WIDE, entry & WIDE == 0));
    entries.dedup_by_key(|entry| *entry & !WIDE);
    entries
}

/// For each Ptex face the slots of its four corners. Those of a part of an n-gon: its vertex, the next one, the n-gon
/// ([`NGON`]) and the previous vertex; the corners that are middles of edges are halves of their ends.
pub(crate) fn ptex_faces(level: &Level) -> Vec<[u32; 4]> {
    let mut slot = level.tags.len() as u32;
    let mut faces = Vec::new();
    for face in 0..level.face_count() {
        let vertices = level.vertices(face);
        if let &[a, b, c, d] = vertices {
            faces.push([a, b, c, d]);
            continue;
        }
        let n = vertices.len();
        faces.extend((0..n).map(|i| [vertices[i], vertices[(i + 1) % n], slot | NGON, vertices[(i + n - 1) % n]]));
        slot += 1;
    }
    faces
}
