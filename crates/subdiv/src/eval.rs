//! The limit surface at any (Ptex face, u, v) on the CPU, in double precision: the project's second oracle.
//!
//! The face is split by the plain rules of FAS section 3.1 until the piece that holds the point is a bicubic patch, or
//! the point is a corner, where the limit mask answers. Points are kept relative to an origin of the piece, so that
//! derivatives do not lose digits however deep it goes.

use std::collections::HashMap;

use crate::edits::PathEdits;
use crate::error::Error;
use crate::limit::limit_mask;
use crate::mesh::{ControlMesh, EditOperation};
use crate::patch::{SurfacePoint, control_points, evaluate, reflect};
use crate::refine::{Split, split_level};
use crate::rules::{self, VertexRule};
use crate::sharpness::{SharpnessAtVertex, child_sharpness};
use crate::topology::Level;

/// Halvings of a base face after which a piece is taken as its corner.
const MAX_DEPTH: u32 = 60;

/// Evaluates the limit surface of one cage.
#[derive(Debug)]
pub struct Evaluator {
    /// The levels down to the deepest edit; only the first if there are none.
    stages: Vec<Stage>,
    /// Base face and side of each Ptex face.
    ptex: Vec<(u32, u32)>,
    /// The base face that was asked for last, and the pieces made for it, by level and face.
    cached: (u32, HashMap<(usize, u32), Piece>),
}

/// A level with its points, and what edits made of its faces.
#[derive(Debug)]
struct Stage {
    level: Level,
    points: Vec<[f64; 3]>,
    /// First child of each face that an edit of a finer level reaches.
    first_children: HashMap<u32, u32>,
}

impl Evaluator {
    /// Prepares a cage; fails as refinement does.
    pub fn new(mesh: &ControlMesh) -> Result<Self, Error> {
        let ptex = (0..)
            .zip(&mesh.face_sizes)
            .flat_map(|(face, &sides)| (0..if sides == 4 { 1 } else { sides }).map(move |side| (face, side)))
            .collect();
        let mut level = Level::from_mesh(mesh)?;
        let mut points: Vec<_> = mesh.positions.iter().map(|p| p.map(f64::from)).collect();
        let mut edits = PathEdits::new(mesh);
        let mut stages = Vec::new();
        loop {
            for (vertex, edit) in edits.apply(&mut level) {
                let point = &mut points[vertex as usize];
                match mesh.edits[edit as usize].operation {
                    EditOperation::SetPosition(p) => *point = p.map(f64::from),
                    EditOperation::AddPosition(p) => *point = add(*point, p.map(f64::from), 1.0),
                    _ => {}
                }
            }
            let forced = edits.forced_faces(&level);
            if forced.is_empty() {
                stages.push(Stage { level, points, first_children: HashMap::new() });
                return Ok(Self { stages, ptex, cached: (0, HashMap::new()) });
            }
            let (split, child) = split_level(&level, &forced, stages.len() as u32 + 1)?;
            edits.descend(&level, &forced);
            let child_points = subdivide_points(&level, &split, &points);
            let mut next = 0;
            let first_children = forced.iter().map(|&face| {
                next += level.sides(face);
                (face, next - level.sides(face))
            });
            let first_children = first_children.collect();
            stages.push(Stage { level, points, first_children });
            (level, points) = (child, child_points);
        }
    }

    /// Number of Ptex faces.
    pub fn ptex_face_count(&self) -> u32 {
        self.ptex.len() as u32
    }

    /// The limit at (u, v) of a Ptex face, both 0 to 1; `None` if the face has none (a hole, or a boundary face without
    /// boundary interpolation) or does not exist. Derivatives are those along the Ptex face's u and v, except at
    /// irregular corners, where they are two vectors that span the tangent plane.
    pub fn evaluate(&mut self, ptex_face: u32, u: f64, v: f64) -> Option<SurfacePoint> {
        let &(base_face, side) = self.ptex.get(ptex_face as usize)?;
        let mut face = base_face;
        let (mut k, mut u, mut v) = (0, u, v);
        while let Some(&first) = self.stages[k].first_children.get(&face) {
            if self.stages[k].level.sides(face) == 4 {
                let (i, low_u, low_v) = quarter(u, v);
                (face, u, v) = (first + i, 2.0 * (u - low_u), 2.0 * (v - low_v));
            } else {
                face = first + side;
            }
            k += 1;
        }
        let stage = &self.stages[k];
        if !stage.level.is_drawn(face) {
            return None;
        }
        if stage.level.is_regular(face) {
            let base = stage.points[stage.level.vertices(face)[0] as usize];
            let relative = |i: u32| add(stage.points[i as usize], base, -1.0);
            return Some(placed(evaluate_face(&stage.level, face, relative, u, v), base, (k as f64).exp2()));
        }
        if self.cached.0 != base_face {
            self.cached = (base_face, HashMap::new());
        }
        let make = || Piece::new(stage.level.clone(), stage.points.clone(), face, [0.0; 3], k as u32);
        let piece = self.cached.1.entry((k, face)).or_insert_with(make);
        Some(if piece.level.sides(face) == 4 { piece.evaluate(u, v) } else { piece.child(side).evaluate(u, v) })
    }
}

/// The quarter of the unit square that holds a point, and its lower corner.
fn quarter(u: f64, v: f64) -> (u32, f64, f64) {
    match (u > 0.5, v > 0.5) {
        (false, false) => (0, 0.0, 0.0),
        (true, false) => (1, 0.5, 0.0),
        (true, true) => (2, 0.5, 0.5),
        (false, true) => (3, 0.0, 0.5),
    }
}

/// A face with what surrounds it, and its children as they are asked for.
#[derive(Debug)]
struct Piece {
    level: Level,
    /// Relative to `origin`.
    points: Vec<[f64; 3]>,
    origin: [f64; 3],
    face: u32,
    depth: u32,
    children: Vec<Option<Piece>>,
}

impl Piece {
    fn new(level: Level, mut points: Vec<[f64; 3]>, face: u32, origin: [f64; 3], depth: u32) -> Self {
        let base = points[level.vertices(face)[0] as usize];
        points.iter_mut().for_each(|p| *p = add(*p, base, -1.0));
        let sides = level.sides(face) as usize;
        Self {
            level,
            points,
            origin: add(origin, base, 1.0),
            face,
            depth,
            children: (0..sides).map(|_| None).collect(),
        }
    }

    fn evaluate(&mut self, u: f64, v: f64) -> SurfacePoint {
        if self.level.is_regular(self.face) {
            let point = evaluate_face(&self.level, self.face, |i| self.points[i as usize], u, v);
            return self.placed(point, (f64::from(self.depth)).exp2());
        }
        let corner = match (u, v) {
            (0.0, 0.0) => Some(0),
            (1.0, 0.0) => Some(1),
            (1.0, 1.0) => Some(2),
            (0.0, 1.0) => Some(3),
            _ if self.depth >= MAX_DEPTH => Some(0),
            _ => None,
        };
        // Where rules still change, the corner is followed until they do not.
        let corner = corner.map(|i: u32| self.level.half_edges(self.face).start + i).filter(|&corner| {
            let tag = self.level.tag(self.level.origin(corner));
            tag.touches_only_quads() && !tag.is_semi_sharp()
        });
        if let Some(corner) = corner {
            return self.placed(self.limit(corner), 1.0);
        }
        let (i, low_u, low_v) = quarter(u, v);
        self.child(i).evaluate(2.0 * (u - low_u), 2.0 * (v - low_v))
    }

    fn child(&mut self, i: u32) -> &mut Self {
        let slot = &mut self.children[i as usize];
        slot.get_or_insert_with(|| {
            // The split fails only on counts that one face's neighbourhood cannot reach.
            let (split, child) = split_level(&self.level, &[self.face], self.depth + 1).expect("one face's ring");
            let points = subdivide_points(&self.level, &split, &self.points);
            Self::new(child, points, i, self.origin, self.depth + 1)
        })
    }

    fn limit(&self, corner: u32) -> SurfacePoint {
        let (points, weights) = limit_mask(&self.level, corner);
        let mut result = SurfacePoint::default();
        for (point, weight) in points.iter().zip(weights) {
            let p = add(self.points[*point as usize], self.points[points[0] as usize], -1.0);
            result.position = add(result.position, p, weight[0]);
            result.du = add(result.du, p, weight[1]);
            result.dv = add(result.dv, p, weight[2]);
        }
        result.position = add(result.position, self.points[points[0] as usize], 1.0);
        result
    }

    fn placed(&self, point: SurfacePoint, derivative_scale: f64) -> SurfacePoint {
        placed(point, self.origin, derivative_scale)
    }
}

/// A point of a regular face, whose points are asked for by index.
fn evaluate_face(level: &Level, face: u32, point: impl Fn(u32) -> [f64; 3], u: f64, v: f64) -> SurfacePoint {
    let (indices, boundary) = control_points(level, face);
    let mut points = indices.map(point);
    reflect(&mut points, boundary);
    evaluate(&points, u, v)
}

fn placed(point: SurfacePoint, origin: [f64; 3], derivative_scale: f64) -> SurfacePoint {
    SurfacePoint {
        position: add(point.position, origin, 1.0),
        du: point.du.map(|c| c * derivative_scale),
        dv: point.dv.map(|c| c * derivative_scale),
    }
}

/// The points of a split in f64 by the rules as FAS section 3.1 prints them: face points first, then edges and vertices
/// from them. Written apart from the stencils, which it checks.
pub fn subdivide_points(parent: &Level, split: &Split, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let at = |vertex: u32| points[vertex as usize];
    let centre = |face: u32| {
        let vertices = parent.vertices(face);
        vertices.iter().fold([0.0; 3], |sum, &v| add(sum, at(v), 1.0 / vertices.len() as f64))
    };
    let smooth = |vertex: u32| {
        let spokes: Vec<u32> = parent.spokes(vertex).collect();
        let n = spokes.len() as f64;
        spokes.iter().fold(at(vertex).map(|c| c * (n - 2.0) / n), |sum, &spoke| {
            let sum = add(sum, at(parent.head(spoke)), 1.0 / (n * n));
            add(sum, centre(parent.face(spoke)), 1.0 / (n * n))
        })
    };
    let vertex_point = |vertex: u32| {
        let sharpness = SharpnessAtVertex::of(parent, vertex);
        let by_rule = |(rule, ends): (VertexRule, [usize; 2])| match rule {
            VertexRule::Corner => at(vertex),
            VertexRule::Crease => {
                let [a, b] = ends.map(|end| at(sharpness.ends[end]));
                add(add(at(vertex).map(|c| 0.75 * c), a, 0.125), b, 0.125)
            }
            VertexRule::Smooth | VertexRule::Dart => smooth(vertex),
        };
        let blend = sharpness.blend(parent.options.creasing);
        let (before, after) = (by_rule(blend.before), by_rule(blend.after));
        add(before.map(|c| c * blend.weight), after, 1.0 - blend.weight)
    };
    let edge_point = |half_edge: u32| {
        let (a, b) = (at(parent.origin(half_edge)), at(parent.head(half_edge)));
        let middle = add(a.map(|c| 0.5 * c), b, 0.5);
        if parent.is_unpaired(half_edge) {
            return middle;
        }
        let faces = [half_edge, parent.twin(half_edge)].map(|h| parent.face(h));
        let weight = rules::edge_face_weight(parent.options.triangles, faces.map(|face| parent.sides(face)));
        let smooth =
            faces.iter().fold(middle.map(|c| c * (1.0 - 2.0 * weight)), |sum, &face| add(sum, centre(face), weight));
        let crease = rules::edge_crease_weight(parent.sharpness(half_edge), child_sharpness(parent, half_edge));
        add(smooth.map(|c| c * (1.0 - crease)), middle, crease)
    };
    let vertices = split.vertices.iter().map(|&v| vertex_point(v));
    let edges = split.edges.iter().map(|&e| edge_point(e));
    vertices.chain(edges).chain(split.faces.iter().map(|&f| centre(f))).collect()
}

fn add(a: [f64; 3], b: [f64; 3], weight: f64) -> [f64; 3] {
    [a[0] + weight * b[0], a[1] + weight * b[1], a[2] + weight * b[2]]
}
