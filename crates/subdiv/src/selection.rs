//! A frame's cut of the irregular faces: the CPU twin of the kernels that choose it (DFAS, for every irregularity).
//!
//! Density is a scalar at the cage's vertices and interpolated bilinearly in each Ptex face; an edge of level k between
//! densities a and b has the tess factor max(1, (a + b) / 2 / 2^k). An irregular face of level k is refined where a corner's
//! density exceeds 2^k, or where the densities around exceed 3 * 2^k. Then a leaf of level k - 1 never borders a refined
//! face of level k. With H = 2^(k - 1): the leaf's corners have at most H, and all around it at most 3 H. A face of level k
//! across its edge has two corners on that edge and two half way into its parent, which have at most (H + 3 H) / 2 = 2^k;
//! and all that lies around it lies around the leaf. Corners of n-gons count 1.5 times, because they come nearer at once.
//!
//! All arithmetic is in 32-bit floats and in the kernels' order of operations: both choose the same.

use crate::tables::{IndexLists, IrregularFace, MeshRanges, NGON, Tables, WIDE};
use crate::topology::{Location, NONE};

/// How many patches of each kind a level has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PatchCounts {
    /// Regular patches without a split edge.
    pub regular: u32,
    /// Regular patches with a split edge.
    pub transition: u32,
    /// Patch-filling quads.
    pub filling: u32,
    /// Gregory patches of 20 points.
    pub gregory: u32,
    /// Gregory triangles.
    pub triangle: u32,
    /// Faces that are evaluated by table.
    pub table: u32,
}

impl PatchCounts {
    /// Patches of all kinds.
    pub fn total(&self) -> u32 {
        self.regular + self.transition + self.filling + self.gregory + self.triangle + self.table
    }
}

/// What decides whether an irregular face is refined, apart from `max_level` and what is forced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Selection {
    /// The densities around it (DFAS).
    Dynamic,
    /// The largest density of the frame (FAS): all of a level or none.
    Static {
        /// That density.
        frame_density: f32,
    },
}

/// What a selection knows of the density slots of one mesh, one value a slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlotDensities {
    /// Segments that an edge of level 0 is meant to have.
    pub density: Vec<f32>,
    /// The largest density around.
    pub ring: Vec<f32>,
    /// The planes that everything around lies outside of, one bit each: 0 if some of it may be seen.
    pub ring_outside: Vec<u32>,
}

/// Gathers densities around every slot; `density` and `outside` (planes that a vertex lies outside of, one bit each) have
/// one value a cage vertex of the mesh.
///
/// Three phases, as the kernel's dispatches: n-gons from their corners, vertices, and again n-gons from the vertices.
pub fn density_rings(tables: &Tables, mesh: &MeshRanges, density: &[f32], outside: &[u32]) -> SlotDensities {
    let cage_point_count = mesh.cage_points.len() as u32;
    let ring_of = |slot: u32| tables.slots.rings.of(mesh.slots.start + slot);
    let ngons = cage_point_count..mesh.slots.len() as u32;
    let mut slots = SlotDensities {
        density: density.to_vec(),
        ring: vec![0.0; mesh.slots.len()],
        ring_outside: vec![0; mesh.slots.len()],
    };
    for ngon in ngons.clone() {
        let corners = ring_of(ngon);
        let (mut sum, mut largest, mut all_outside) = (0.0_f32, 0.0_f32, u32::MAX);
        for &corner in corners {
            sum += density[corner as usize];
            largest = largest.max(density[corner as usize]);
            all_outside &= outside[corner as usize];
        }
        // Whatever bounds the corners bounds a rounded mean too.
        slots.density.push((sum / corners.len() as f32).min(largest));
        slots.ring[ngon as usize] = if corners.len() > 4 { 1.5 * largest } else { largest };
        slots.ring_outside[ngon as usize] = all_outside;
    }
    for vertex in 0..cage_point_count {
        let (mut largest, mut all_outside) = (0.0_f32, u32::MAX);
        for &entry in ring_of(vertex) {
            let slot = (entry & !WIDE) as usize;
            let (density, outside) = if slot >= cage_point_count as usize {
                (slots.ring[slot], slots.ring_outside[slot])
            } else if entry & WIDE != 0 {
                (1.5 * density[slot], outside[slot])
            } else {
                (density[slot], outside[slot])
            };
            largest = largest.max(density);
            all_outside &= outside;
        }
        slots.ring[vertex as usize] = largest;
        slots.ring_outside[vertex as usize] = if ring_of(vertex).is_empty() { 0 } else { all_outside };
    }
    for ngon in ngons {
        let corners = ring_of(ngon).iter();
        slots.ring_outside[ngon as usize] =
            corners.fold(u32::MAX, |outside, &corner| outside & slots.ring_outside[corner as usize]);
    }
    slots
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    (1.0 - t) * a + t * b
}

/// Density in a Ptex face whose corners have these slots; u and v are multiples of a power of two.
pub fn density_at(slots: &[f32], corners: [u32; 4], u: f32, v: f32) -> f32 {
    let [d0, d1, d2, d3] = corners.map(|corner| slots[(corner & !NGON) as usize]);
    if corners[2] & NGON == 0 {
        return lerp(lerp(d0, d1, u), lerp(d3, d2, u), v);
    }
    // Along the cage's own edges as the face across has it.
    if v == 0.0 {
        return lerp(d0, d1, 0.5 * u);
    }
    if u == 0.0 {
        return lerp(d0, d3, 0.5 * v);
    }
    let (m1, m3) = (0.5 * (d0 + d1), 0.5 * (d0 + d3));
    lerp(lerp(d0, m1, u), lerp(m3, d2, u), v)
}

/// An irregular face that is drawn as a patch-filling quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Its place in [`Tables::irregular`].
    pub face: u32,
    /// Edges that the face across splits, one bit each: they have the limit point of their middle.
    pub split: u8,
}

/// What a frame draws of a mesh, and what must be computed for it. All lists are in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// Irregular faces that are refined, whether or not they may be seen.
    pub refined: Vec<u32>,
    /// Edges that they split.
    pub split_edges: Vec<u32>,
    /// Irregular faces that are drawn.
    pub leaves: Vec<Leaf>,
    /// Patches of levels from 1 on that may be seen. Those of level 0 are always there.
    pub patches: Vec<u32>,
    /// Stars whose points are in use.
    pub stars: Vec<u32>,
    /// Stencil rows of the points in use, by level and dispatch as [`MeshRanges::rows`].
    pub rows: Vec<Vec<Vec<u32>>>,
    /// Limit points in use.
    pub limits: Vec<u32>,
    /// By level; at level 0 of all patches.
    pub counts: Vec<PatchCounts>,
    /// Leaves that only `max_level` kept from being refined.
    pub truncated: u32,
}

/// Selects the cut of one mesh.
pub fn select(tables: &Tables, mesh: &MeshRanges, slots: &SlotDensities, selection: Selection) -> Cut {
    let rule = Rule { tables, mesh, slots, selection };
    let mut marks = Marks::new(tables);
    let mut cut = Cut { counts: vec![PatchCounts::default(); mesh.patches.len()], ..Cut::default() };
    let roots = mesh.irregular.first().cloned().unwrap_or_default();
    let mut faces: Vec<(u32, bool)> =
        roots.map(|root| (root, rule.is_visible(&tables.irregular[root as usize]))).collect();
    while !faces.is_empty() {
        let mut next = Vec::new();
        for (place, is_visible) in faces {
            let face = &tables.irregular[place as usize];
            if !rule.is_refined(face) {
                if is_visible && !face.is_hidden {
                    cut.leaves.push(Leaf { face: place, split: 0 });
                    cut.truncated += u32::from(rule.is_truncated(face));
                }
                continue;
            }
            cut.refined.push(place);
            face.edges.iter().filter(|&&edge| edge != NONE).for_each(|&edge| marks.edges[edge as usize] = true);
            if is_visible {
                face.stars.iter().filter(|&&star| star != NONE).for_each(|&star| marks.star(star, &tables.stars));
            }
            for &child in face.children.iter().filter(|&&child| child != NONE) {
                if child & IrregularFace::IRREGULAR != 0 {
                    next.push((child & !IrregularFace::IRREGULAR, is_visible));
                } else if is_visible {
                    cut.patches.push(child);
                }
            }
        }
        faces = next;
    }
    marks.leaves(tables, &mut cut.leaves);
    let level_0 = mesh.patches.first().cloned().unwrap_or_default();
    level_0.clone().chain(cut.patches.iter().copied()).for_each(|patch| marks.corners(tables, patch));
    marks.list(tables, mesh, &mut cut);
    for place in level_0.chain(cut.patches.iter().copied()) {
        let patch = &tables.patches[place as usize];
        let is_split = |edge: &u32| *edge != NONE && marks.edges[*edge as usize];
        let counts = &mut cut.counts[patch.info.level as usize];
        *(if patch.edges.iter().any(is_split) { &mut counts.transition } else { &mut counts.regular }) += 1;
    }
    for leaf in &cut.leaves {
        cut.counts[tables.irregular[leaf.face as usize].info.level as usize].filling += 1;
    }
    cut
}

/// The cut with everything refined as far as it goes.
pub fn deepest_cut(tables: &Tables, mesh: &MeshRanges) -> Cut {
    let count = mesh.slots.len();
    let slots = SlotDensities { density: vec![0.0; count], ring: vec![0.0; count], ring_outside: vec![0; count] };
    select(tables, mesh, &slots, Selection::Static { frame_density: f32::INFINITY })
}

/// Decides about single faces.
struct Rule<'a> {
    tables: &'a Tables,
    mesh: &'a MeshRanges,
    slots: &'a SlotDensities,
    selection: Selection,
}

impl Rule<'_> {
    fn is_visible(&self, root: &IrregularFace) -> bool {
        let corners = self.corners(&root.info.location);
        let outside = |slot: u32| self.slots.ring_outside[(slot & !NGON) as usize];
        if corners[2] & NGON != 0 {
            return outside(corners[2]) == 0;
        }
        corners.iter().fold(u32::MAX, |all, &corner| all & outside(corner)) == 0
    }

    fn is_refined(&self, face: &IrregularFace) -> bool {
        let level = u32::from(face.info.level);
        let scale = 1.0 / (1_u32 << level) as f32;
        let exceeds = || match self.selection {
            Selection::Dynamic => {
                self.own(&face.info.location) * scale > 1.0 || self.around(&face.info.location) * scale > 3.0
            }
            Selection::Static { frame_density } => frame_density * scale > 1.0,
        };
        face.is_forced || level < self.tables.max_level && exceeds()
    }

    /// Whether only the end of refinement keeps a leaf from being refined.
    fn is_truncated(&self, leaf: &IrregularFace) -> bool {
        let level = u32::from(leaf.info.level);
        let density = match self.selection {
            Selection::Dynamic => self.own(&leaf.info.location),
            Selection::Static { frame_density } => frame_density,
        };
        level >= self.tables.max_level && density * (1.0 / (1_u32 << level) as f32) > 1.0
    }

    fn corners(&self, location: &Location) -> [u32; 4] {
        self.tables.ptex_faces[(self.mesh.ptex_faces.start + location.ptex_face) as usize]
    }

    /// The largest density of the face's own corners.
    fn own(&self, location: &Location) -> f32 {
        let corners = self.corners(location);
        let scale = 1.0 / (1_u32 << location.depth) as f32;
        let along = |low: u16, i: u32| (u32::from(low) + i) as f32 * scale;
        [(0, 0), (1, 0), (1, 1), (0, 1)].into_iter().fold(0.0_f32, |largest, (i, j)| {
            let density = density_at(&self.slots.density, corners, along(location.u, i), along(location.v, j));
            largest.max(density)
        })
    }

    /// The largest density around: of the corners of the base face, and of all faces at those of its corners and edges
    /// that the face touches.
    fn around(&self, location: &Location) -> f32 {
        let corners = self.corners(location);
        let ring = |i: usize| self.slots.ring[(corners[i] & !NGON) as usize];
        let end = 1 << location.depth;
        let (low_u, high_u) = (location.u == 0, u32::from(location.u) + 1 == end);
        let (low_v, high_v) = (location.v == 0, u32::from(location.v) + 1 == end);
        // Edges 1 and 2 of an n-gon's part lie within the n-gon, the others are halves of the cage's.
        let is_ngon = corners[2] & NGON != 0;
        let edges = [low_v, high_u && !is_ngon, high_v && !is_ngon, low_u];
        let base = if is_ngon {
            ring(2)
        } else {
            corners.iter().fold(0.0, |largest: f32, &corner| largest.max(self.slots.density[corner as usize]))
        };
        (0..4).fold(base, |largest, i| {
            // Corner i lies between edges i - 1 and i; one of an n-gon's part is a corner of the cage only if both are.
            let at_corner = if edges[i] && edges[(i + 3) % 4] { ring(i) } else { 0.0 };
            let at_edge = if edges[i] { ring(i).min(ring((i + 1) % 4)) } else { 0.0 };
            largest.max(at_corner).max(at_edge)
        })
    }
}

/// What has been asked for.
struct Marks {
    edges: Vec<bool>,
    stars: Vec<bool>,
    points: Vec<bool>,
    limits: Vec<bool>,
}

impl Marks {
    fn new(tables: &Tables) -> Self {
        Self {
            edges: vec![false; tables.edge_count as usize],
            stars: vec![false; tables.stars.count() as usize],
            points: vec![false; tables.point_count() as usize],
            limits: vec![false; tables.limit_point_count() as usize],
        }
    }

    fn star(&mut self, star: u32, stars: &IndexLists) {
        if !std::mem::replace(&mut self.stars[star as usize], true) {
            stars.of(star).iter().for_each(|&point| self.points[point as usize] = true);
        }
    }

    /// Marks what the leaves' limit points need, and notes their split edges.
    fn leaves(&mut self, tables: &Tables, leaves: &mut [Leaf]) {
        for leaf in leaves {
            let face = &tables.irregular[leaf.face as usize];
            for i in 0..4 {
                self.limits[face.limits[i] as usize] = true;
                if face.star_limits >> i & 1 != 0 {
                    self.star(face.stars[i], &tables.stars);
                }
                if face.edges[i] != NONE && self.edges[face.edges[i] as usize] {
                    leaf.split |= 1 << i;
                    self.limits[face.midpoints[i] as usize] = true;
                    self.star(face.stars[i], &tables.stars);
                    self.star(face.stars[(i + 1) % 4], &tables.stars);
                }
            }
        }
    }

    /// Marks the limit points that a patch's corners are.
    fn corners(&mut self, tables: &Tables, patch: u32) {
        let seams = tables.seams.get(tables.patches[patch as usize].seams as usize);
        let limits = seams.into_iter().flat_map(|seams| seams.limits);
        limits.filter(|&limit| limit != NONE).for_each(|limit| self.limits[limit as usize] = true);
    }

    fn list(&self, tables: &Tables, mesh: &MeshRanges, cut: &mut Cut) {
        let marked = |marks: &[bool], range: std::ops::Range<u32>| range.filter(|&i| marks[i as usize]).collect();
        cut.split_edges = marked(&self.edges, mesh.edges.clone());
        cut.stars = marked(&self.stars, mesh.stars.clone());
        cut.limits = marked(&self.limits, mesh.limits.clone());
        let rows = &self.points[tables.cage_point_count as usize..];
        cut.rows =
            mesh.rows.iter().map(|level| level.iter().map(|range| marked(rows, range.clone())).collect()).collect();
        cut.leaves.sort_unstable_by_key(|leaf| leaf.face);
        cut.patches.sort_unstable();
        cut.refined.sort_unstable();
    }
}
