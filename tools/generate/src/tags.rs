//! Subdivision tags of a mesh under construction, and the vertices, edges and faces that they are for.
use std::collections::HashSet;
use std::fmt::Write as _;

use glam::DVec3;

use crate::cage::Cage;

/// The sharpness from which on an edge or a vertex is infinitely sharp.
pub const INFINITE: f64 = 10.0;

/// How the boundary shapes the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundaryRule {
    /// Faces at the boundary have no surface.
    None = 0,
    /// Boundary edges are sharp, and so are boundary vertices of one face.
    EdgeAndCorner = 1,
    /// Boundary edges are sharp.
    EdgeOnly = 2,
}

impl Cage {
    /// The vertex nearest to (x, z), seen from above.
    ///
    /// # Panics
    /// On a mesh without vertices.
    pub fn above(&self, x: f64, z: f64) -> u32 {
        nearest(self.positions.iter().copied(), x, z)
    }

    /// The face whose middle is nearest to (x, z), seen from above.
    ///
    /// # Panics
    /// On a mesh without faces.
    pub fn face_above(&self, x: f64, z: f64) -> u32 {
        let middle = |face: &Vec<u32>| {
            face.iter().map(|&vertex| self.positions[vertex as usize]).sum::<DVec3>() / face.len() as f64
        };
        nearest(self.faces.iter().map(middle), x, z)
    }

    /// The vertices nearest to points (x, z), seen from above.
    pub fn polyline(&self, points: &[[f64; 2]]) -> Vec<u32> {
        points.iter().map(|&[x, z]| self.above(x, z)).collect()
    }

    /// Every edge once, in the order of the faces.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let mut known = HashSet::new();
        let sides = self.faces.iter().flat_map(|face| (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]]));
        sides.filter(|&[a, b]| known.insert((a.min(b), a.max(b)))).collect()
    }

    /// The edges whose two ends are meant.
    pub fn edges_where(&self, is_meant: impl Fn(DVec3) -> bool) -> Vec<[u32; 2]> {
        let mut edges = self.edges();
        edges.retain(|edge| edge.iter().all(|&vertex| is_meant(self.positions[vertex as usize])));
        edges
    }

    /// The mesh with a crease along a polyline.
    pub fn creased(mut self, polyline: &[u32], sharpness: f64) -> Self {
        self.tag("crease", polyline, &[sharpness], &[]);
        self
    }

    /// The mesh with a crease along a polyline given by points seen from above.
    pub fn creased_above(self, points: &[[f64; 2]], sharpness: f64) -> Self {
        let polyline = self.polyline(points);
        self.creased(&polyline, sharpness)
    }

    /// The mesh with creased edges, which have the given values of sharpness in turn.
    pub fn creased_edges(mut self, edges: &[[u32; 2]], sharpness: &[f64]) -> Self {
        for (edge, &sharpness) in edges.iter().zip(sharpness.iter().cycle()) {
            self.tag("crease", edge, &[sharpness], &[]);
        }
        self
    }

    /// The mesh with a sharp vertex.
    pub fn cornered(mut self, vertex: u32, sharpness: f64) -> Self {
        self.tag("corner", &[vertex], &[sharpness], &[]);
        self
    }

    /// The mesh with a sharp vertex given by a point seen from above.
    pub fn cornered_above(self, x: f64, z: f64, sharpness: f64) -> Self {
        let vertex = self.above(x, z);
        self.cornered(vertex, sharpness)
    }

    /// The mesh with faces that are not drawn.
    pub fn with_holes(mut self, faces: &[u32]) -> Self {
        self.tag("hole", faces, &[], &[]);
        self
    }

    /// The mesh with a boundary rule.
    pub fn with_boundary(mut self, rule: BoundaryRule) -> Self {
        self.tag("interpolateboundary", &[rule as u32], &[], &[]);
        self
    }

    /// The mesh with Chaikin's rule for creases.
    pub fn with_chaikin(mut self) -> Self {
        self.tag("creasemethod", &[], &[], &["chaikin"]);
        self
    }

    /// The mesh with the rule for smooth triangles.
    pub fn with_smooth_triangles(mut self) -> Self {
        self.tag("smoothtriangles", &[], &[], &["smooth"]);
        self
    }

    /// Adds a tag's line.
    pub fn tag(&mut self, name: &str, ints: &[u32], floats: &[f64], strings: &[&str]) {
        let mut line = format!("t {name} {}/{}/{}", ints.len(), floats.len(), strings.len());
        ints.iter().for_each(|int| write!(line, " {int}").expect("writing to a string cannot fail"));
        floats.iter().for_each(|float| write!(line, " {float}").expect("writing to a string cannot fail"));
        strings.iter().for_each(|string| write!(line, " {string}").expect("writing to a string cannot fail"));
        self.tags.push(line);
    }
}

fn nearest(points: impl Iterator<Item = DVec3>, x: f64, z: f64) -> u32 {
    let distance = |p: DVec3| (p.x - x).hypot(p.z - z);
    let (index, _) = (0..)
        .zip(points.map(distance))
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .expect("a mesh that is tagged has vertices and faces");
    index
}
