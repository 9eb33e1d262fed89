//! Level 0 from a cage: who borders whom, where fans begin, what is sharp and what is hidden.

use std::collections::{HashMap, HashSet};

use crate::error::Error;
use crate::mesh::{BoundaryInterpolation, ControlMesh, INFINITE_SHARPNESS};
use crate::rules::is_semi_sharp;
use crate::topology::{Faces, Level, Location, NONE, NonManifold};
use crate::vertex_tag::VertexTag;

impl Level {
    /// Level 0.
    pub fn from_mesh(mesh: &ControlMesh) -> Result<Self, Error> {
        mesh.validate()?;
        let mut level = Self::of_quads(mesh.face_vertices.clone(), Vec::new());
        if mesh.face_sizes.iter().any(|&n| n != 4) {
            level.faces = mixed_faces(&mesh.face_sizes);
        }
        level.options = mesh.options;
        let vertex_count = mesh.positions.len();
        let shared_edges = pair_half_edges(&mut level, vertex_count);
        level.find_fans(vertex_count, shared_edges);
        level.set_sharpness(mesh);
        level.tag_vertices(mesh);
        level.sum_semi_sharp_edges();
        level.drawn_count = mesh.face_count();
        level.hide_faces(mesh);
        let mut ptex_face = 0;
        for &sides in &mesh.face_sizes {
            level.locations.push(Location { ptex_face, ..Location::default() });
            ptex_face += if sides == 4 { 1 } else { sides };
        }
        Ok(level)
    }

    /// Finds where the fans of each vertex start.
    fn find_fans(&mut self, vertex_count: usize, shared_edges: Vec<Vec<u32>>) {
        let mut face_counts = vec![0_u32; vertex_count];
        let mut suspects = Vec::new();
        self.starts = vec![NONE; vertex_count];
        for half_edge in 0..self.origins.len() as u32 {
            let vertex = self.origin(half_edge);
            face_counts[vertex as usize] += 1;
            let start = self.starts[vertex as usize];
            if start == NONE || self.is_unpaired(half_edge) {
                if start != NONE && self.is_unpaired(start) {
                    suspects.push(vertex);
                } else {
                    self.starts[vertex as usize] = half_edge;
                }
            }
        }
        for (vertex, &count) in (0..).zip(&face_counts) {
            if count > 0 && self.spokes(vertex).count() as u32 != count {
                suspects.push(vertex);
            }
        }
        suspects.extend(shared_edges.iter().flatten().flat_map(|&h| [self.origin(h), self.head(h)]));
        if suspects.is_empty() {
            return;
        }
        let mut fans: HashMap<u32, Vec<u32>> = suspects.into_iter().map(|vertex| (vertex, Vec::new())).collect();
        let mut spokes_of: HashMap<u32, Vec<u32>> = HashMap::new();
        for half_edge in 0..self.origins.len() as u32 {
            let vertex = self.origin(half_edge);
            if fans.contains_key(&vertex) {
                spokes_of.entry(vertex).or_default().push(half_edge);
            }
        }
        for (vertex, starts) in &mut fans {
            let mut left = spokes_of.remove(vertex).unwrap_or_default();
            // Open fans start at their unpaired spoke; what is left then are closed ones.
            left.sort_by_key(|&spoke| (!self.is_unpaired(spoke), spoke));
            let mut met = HashSet::new();
            for start in left {
                if !met.contains(&start) {
                    starts.push(start);
                    met.extend(self.spokes_from(start));
                }
            }
            self.starts[*vertex as usize] = starts.first().copied().unwrap_or(NONE);
        }
        let vertices: Vec<u32> = fans.keys().copied().collect();
        let mut parts = Box::new(NonManifold::new(shared_edges, fans));
        self.non_manifold = Some(parts.clone());
        let creases = vertices.into_iter().filter(|&v| self.is_non_manifold_crease(v, face_counts[v as usize]));
        parts.creases = creases.collect();
        self.non_manifold = Some(parts);
    }

    /// Takes over the cage's creases and sharp vertices; corners come with the tags.
    fn set_sharpness(&mut self, mesh: &ControlMesh) {
        let sorted = |a: u32, b: u32| (a.min(b), a.max(b));
        // A later tag overrides an earlier one.
        let creases: HashMap<(u32, u32), f32> = mesh
            .creases
            .iter()
            .map(|crease| (sorted(crease.vertices[0], crease.vertices[1]), crease.sharpness))
            .collect();
        if creases.values().any(|&sharpness| sharpness > 0.0) {
            let mut is_end = vec![false; mesh.positions.len()];
            creases.keys().for_each(|&(a, b)| {
                is_end[a as usize] = true;
                is_end[b as usize] = true;
            });
            self.edge_sharpness = vec![0.0; self.origins.len()];
            for half_edge in 0..self.origins.len() as u32 {
                let (a, b) = (self.origin(half_edge), self.head(half_edge));
                if is_end[a as usize] && is_end[b as usize] {
                    let sharpness = creases.get(&sorted(a, b)).copied().unwrap_or(0.0);
                    self.edge_sharpness[half_edge as usize] = sharpness.clamp(0.0, INFINITE_SHARPNESS);
                }
            }
        }
        if mesh.corners.iter().any(|corner| corner.sharpness > 0.0) {
            self.vertex_sharpness = vec![0.0; mesh.positions.len()];
            for corner in &mesh.corners {
                self.vertex_sharpness[corner.vertex as usize] = corner.sharpness.clamp(0.0, INFINITE_SHARPNESS);
            }
        }
    }

    fn tag_vertices(&mut self, mesh: &ControlMesh) {
        self.tags = vec![VertexTag::default(); mesh.positions.len()];
        for vertex in 0..mesh.positions.len() as u32 {
            if self.starts[vertex as usize] != NONE {
                self.tags[vertex as usize] = self.vertex_tag(vertex);
            }
        }
    }

    /// The tag of a vertex all of whose faces are in this level.
    pub(crate) fn vertex_tag(&self, vertex: u32) -> VertexTag {
        let (mut face_count, mut beside_non_quad) = (0, false);
        for spoke in self.all_spokes(vertex) {
            face_count += 1;
            beside_non_quad |= self.sides(self.face(spoke)) != 4;
        }
        let given = self.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0);
        let topological_corner = face_count == 1 && self.options.boundary == BoundaryInterpolation::EdgeAndCorner;
        let corner = given >= INFINITE_SHARPNESS || topological_corner;
        let parts = self.non_manifold.as_ref().filter(|parts| parts.fans.contains_key(&vertex));
        let tag = match parts {
            Some(parts) => VertexTag::non_manifold(corner || !parts.creases.contains(&vertex), beside_non_quad),
            None => {
                let boundary = self.is_unpaired(self.starts[vertex as usize]);
                VertexTag::new(face_count, boundary, corner, beside_non_quad)
            }
        };
        let has_sharpness = !self.edge_sharpness.is_empty() || given > 0.0;
        let tag = if has_sharpness { self.tag_with_sharpness(vertex, tag) } else { tag };
        let is_cut = tag.is_non_manifold() || tag.has_infinite_crease();
        if is_cut && !self.has_regular_sectors(vertex, tag.is_corner()) { tag.with_irregular_sectors() } else { tag }
    }

    /// The tag of a vertex with what the sharpness at it adds.
    fn tag_with_sharpness(&self, vertex: u32, tag: VertexTag) -> VertexTag {
        let own = self.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0);
        let (mut semi_sharp, mut infinite) = (is_semi_sharp(own) && !tag.is_corner(), false);
        for spoke in self.all_spokes(vertex).filter(|&spoke| !self.is_unpaired(spoke)) {
            let sharpness = self.sharpness(spoke);
            semi_sharp |= is_semi_sharp(sharpness);
            infinite |= sharpness >= INFINITE_SHARPNESS;
        }
        tag.with_sharpness(semi_sharp, infinite)
    }

    /// Whether a vertex lies inside a crease of edges of more than two faces: two such edges, no boundary and more faces
    /// than edges. All other vertices that are not manifold are corners (OpenSubdiv's rule).
    fn is_non_manifold_crease(&self, vertex: u32, face_count: u32) -> bool {
        let edges = self.incident_edges(vertex);
        let shared_count = edges.iter().filter(|edge| self.sharing(edge).len() > 1).count();
        let has_boundary = edges.iter().any(|&edge| self.is_boundary(edge));
        shared_count == 2 && !has_boundary && face_count as usize > edges.len()
    }

    fn hide_faces(&mut self, mesh: &ControlMesh) {
        let no_boundary = mesh.options.boundary == BoundaryInterpolation::None;
        if mesh.holes.is_empty() && !no_boundary {
            return;
        }
        self.hidden = vec![false; self.face_count() as usize];
        if no_boundary {
            // A vertex on the boundary has a limit only if all its boundary edges were made infinitely sharp.
            for vertex in (0..mesh.positions.len() as u32).filter(|&v| self.starts[v as usize] != NONE) {
                let is_open = self.incident_edges(vertex).iter().any(|&edge| {
                    let given = self.edge_sharpness.get(edge as usize).copied().unwrap_or(0.0);
                    self.is_boundary(edge) && given < INFINITE_SHARPNESS
                });
                if is_open {
                    let faces: Vec<u32> = self.all_spokes(vertex).map(|spoke| self.face(spoke)).collect();
                    faces.into_iter().for_each(|face| self.hidden[face as usize] = true);
                }
            }
        }
        for &hole in &mesh.holes {
            self.hidden[hole as usize] = true;
        }
    }
}

fn mixed_faces(sizes: &[u32]) -> Faces {
    let mut first = Vec::with_capacity(sizes.len() + 1);
    let mut of = Vec::new();
    let mut end = 0;
    for (face, &sides) in sizes.iter().enumerate() {
        first.push(end);
        end += sides;
        of.resize(end as usize, face as u32);
    }
    first.push(end);
    Faces::Mixed { first, of }
}

/// Finds the twin of every half-edge: half-edges are bucketed by their lower vertex, and paired within the bucket.
/// Returns the half-edges of each edge that is not manifold (more than two faces, or two that run the same way along it);
/// those stay unpaired.
fn pair_half_edges(level: &mut Level, vertex_count: usize) -> Vec<Vec<u32>> {
    let count = level.origins.len() as u32;
    let ends = |h: u32| {
        let (a, b) = (level.origin(h), level.head(h));
        (a.min(b), a.max(b))
    };
    let mut bucket_ends = vec![0_u32; vertex_count + 1];
    for h in 0..count {
        bucket_ends[ends(h).0 as usize + 1] += 1;
    }
    for i in 0..vertex_count {
        bucket_ends[i + 1] += bucket_ends[i];
    }
    let mut cursor = bucket_ends.clone();
    let mut sorted = vec![(0_u32, 0_u32); count as usize];
    for h in 0..count {
        let (low, high) = ends(h);
        sorted[cursor[low as usize] as usize] = (high, h);
        cursor[low as usize] += 1;
    }
    let mut twins: Vec<u32> = (0..count).collect();
    let mut shared_edges = Vec::new();
    for low in 0..vertex_count {
        let bucket = &mut sorted[bucket_ends[low] as usize..bucket_ends[low + 1] as usize];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|a, b| a.0 == b.0) {
            match *edge {
                [_] => {}
                [(_, a), (_, b)] if level.origin(a) != level.origin(b) => {
                    twins[a as usize] = b;
                    twins[b as usize] = a;
                }
                _ => shared_edges.push(edge.iter().map(|&(_, h)| h).collect()),
            }
        }
    }
    level.twins = twins;
    shared_edges
}
