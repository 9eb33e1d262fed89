//! Subdivision schemes: each is the rules in its own file, and its line in [`Scheme`].
//!
//! A scheme says how faces are split, and how smooth edges, vertices and creases are weighed. Sharpness, boundaries and blends
//! between rules are DeRose, Kass and Truong's for all of them, in OpenSubdiv's reading; limits follow from the rules.

mod butterfly;
mod catmull_clark;
mod loop_scheme;
mod loop_stam;

use crate::basis::poly::{Fan, Poly};
use crate::mesh::TriangleSubdivision;

/// A new point as weights of points before; a point may come twice.
pub(crate) type Row = Vec<(u32, f64)>;

/// A stationary subdivision scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Catmull and Clark 1978: faces of any number of sides.
    #[default]
    CatmullClark,
    /// Loop 1987: triangles.
    Loop,
    /// Stam and Loop 2003: triangles and quads.
    LoopStam,
    /// Modified Butterfly, Zorin, Schroeder and Sweldens 1996: triangles, whose vertices it interpolates.
    Butterfly,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::CatmullClark, Self::Loop, Self::LoopStam, Self::Butterfly];

    /// Its name as it is written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::CatmullClark => "catmull-clark",
            Self::Loop => "loop",
            Self::LoopStam => "loop-stam",
            Self::Butterfly => "butterfly",
        }
    }

    /// Whether the limit surface of a face lies within the convex hull of its neighbourhood: no weight is negative.
    pub fn is_within_hull(self) -> bool {
        self != Self::Butterfly
    }

    /// Whether a face of so many sides is one Ptex face of three corners.
    pub fn is_triangle(self, sides: u32) -> bool {
        sides == 3 && self != Self::CatmullClark
    }

    /// Numbers of sides that faces may have, in words.
    pub fn accepted(self) -> &'static str {
        match self {
            Self::CatmullClark => "faces of any number of sides",
            Self::LoopStam => "triangles and quads",
            Self::Loop | Self::Butterfly => "triangles",
        }
    }

    /// Whether a face may have so many sides.
    pub fn accepts(self, sides: u32) -> bool {
        match self {
            Self::CatmullClark => sides >= 3,
            Self::LoopStam => sides == 3 || sides == 4,
            Self::Loop | Self::Butterfly => sides == 3,
        }
    }

    pub(crate) fn rules(self, triangles: TriangleSubdivision) -> Box<dyn Rules> {
        match self {
            Self::CatmullClark => Box::new(catmull_clark::CatmullClark { triangles }),
            Self::Loop => Box::new(loop_scheme::Loop),
            Self::LoopStam => Box::new(loop_stam::LoopStam),
            Self::Butterfly => Box::new(butterfly::Butterfly),
        }
    }
}

/// What is particular to a scheme. Rules return nothing where they would look beyond a piece of a mesh.
pub(crate) trait Rules {
    /// Whether a face of so many sides becomes four triangles, rather than a quad at each corner.
    fn splits_in_triangles(&self, sides: u32) -> bool;

    /// Rings of faces that the limit surface of a face depends on.
    fn width(&self) -> u32 {
        1
    }

    /// The point of a face that has one: its centroid.
    fn face(&self, poly: &Poly, face: u32) -> Row {
        let vertices = poly.vertices(face);
        vertices.iter().map(|&vertex| (vertex, 1.0 / vertices.len() as f64)).collect()
    }

    /// The point of an edge with a face on both sides, by one of its half-edges.
    fn smooth_edge(&self, poly: &Poly, h: u32) -> Option<Row>;

    /// The point of an edge of a boundary or crease.
    fn crease_edge(&self, poly: &Poly, h: u32) -> Option<Row> {
        Some(vec![(poly.origin(h), 0.5), (poly.head(h), 0.5)])
    }

    /// A vertex inside.
    fn smooth_vertex(&self, poly: &Poly, vertex: u32, fan: &Fan) -> Option<Row>;

    /// A vertex between two others of a boundary or crease.
    fn crease_vertex(&self, vertex: u32, ends: [u32; 2]) -> Row {
        vec![(vertex, 0.75), (ends[0], 0.125), (ends[1], 0.125)]
    }

    /// Whether vertices stay where they are.
    fn interpolates(&self) -> bool {
        false
    }
}
