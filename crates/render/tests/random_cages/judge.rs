//! Points, normals and coverage against the f64 evaluator.

use std::collections::{BTreeMap, HashMap, HashSet};

use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::INFINITE_SHARPNESS;
use planish_subdiv::patch::{PatchInfo, SurfacePoint};
use planish_subdiv::topology::Location;

use crate::vector::{Vector, cross, dot, length, subtract};

/// Largest distance from the evaluator's point, over the largest coordinate magnitude of the cage.
const POSITION_TOLERANCE: f64 = 2e-6;
/// Least tolerance of a normal, in degrees.
const NORMAL_TOLERANCE: f64 = 0.01;
/// Corners of a face.
pub const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// A cage with its evaluator, and what tolerances depend on.
pub struct Judge {
    evaluator: Evaluator,
    largest_coordinate: f64,
    /// Of each Ptex face.
    domains: Vec<Domain>,
}

/// What is known of a Ptex face.
struct Domain {
    /// Shortest edge of the base face.
    shortest_edge: f64,
    /// Whether the normals at its corners (0, 0), (1, 0), (1, 1) and (0, 1) are not compared.
    is_singular: [bool; 4],
}

/// The vertices at which the surface need not have one tangent plane, or the tangent masks, OpenSubdiv's, are not its
/// limit: on boundaries, infinite creases and non-manifold edges, infinitely sharp ones, and those of two faces.
fn singular_vertices(mesh: &ControlMesh, faces: &[&[u32]]) -> HashSet<u32> {
    let mut face_counts: HashMap<u32, u32> = HashMap::new();
    let mut edge_runs: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for face in faces {
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            *face_counts.entry(a).or_default() += 1;
            edge_runs.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    let mut singular: HashSet<u32> = face_counts.iter().filter(|&(_, &count)| count < 3).map(|(&v, _)| v).collect();
    singular.extend(edge_runs.iter().filter(|&(_, &runs)| runs != [1, 1]).flat_map(|(&ends, _)| ends));
    let is_infinite = |sharpness: f32| sharpness >= INFINITE_SHARPNESS;
    singular
        .extend(mesh.creases.iter().filter(|crease| is_infinite(crease.sharpness)).flat_map(|crease| crease.vertices));
    singular.extend(mesh.corners.iter().filter(|corner| is_infinite(corner.sharpness)).map(|corner| corner.vertex));
    singular
}

fn domains(mesh: &ControlMesh) -> Vec<Domain> {
    let mut rest = mesh.face_vertices.as_slice();
    let faces: Vec<&[u32]> = mesh.face_sizes.iter().map(|&size| rest.split_off(..size as usize).unwrap()).collect();
    let singular = singular_vertices(mesh, &faces);
    let point = |vertex: u32| mesh.positions[vertex as usize].map(f64::from);
    let mut domains = Vec::new();
    for face in faces {
        let edges = face.iter().zip(face.iter().cycle().skip(1));
        let shortest_edge = edges.map(|(&a, &b)| length(subtract(point(a), point(b)))).fold(f64::MAX, f64::min);
        let is_singular: Vec<bool> = face.iter().map(|vertex| singular.contains(vertex)).collect();
        if let &[a, b, c, d] = is_singular.as_slice() {
            domains.push(Domain { shortest_edge, is_singular: [a, b, c, d] });
        } else {
            let of_corner = |is_singular| Domain { shortest_edge, is_singular: [is_singular, false, false, false] };
            domains.extend(is_singular.into_iter().map(of_corner));
        }
    }
    domains
}

impl Judge {
    /// Fails as refinement does.
    pub fn new(mesh: &ControlMesh) -> Result<Self, String> {
        let evaluator = Evaluator::new(mesh).map_err(|error| error.to_string())?;
        let coordinates = mesh.face_vertices.iter().flat_map(|&vertex| mesh.positions[vertex as usize]);
        let largest_coordinate = coordinates.fold(0.0, |largest, c| f64::from(c.abs()).max(largest));
        Ok(Self { evaluator, largest_coordinate, domains: domains(mesh) })
    }

    /// Compares a point at (u, v) of a patch with the evaluator's.
    pub fn check(
        &mut self,
        info: &PatchInfo,
        uv: [f64; 2],
        position: Vector,
        normal: Option<Vector>,
    ) -> Result<(), String> {
        let ptex_face = info.location.ptex_face;
        let [u, v] = in_ptex_face(&info.location, uv);
        let wrong = |what: String| Err(format!("{what} at Ptex face {ptex_face} ({u}, {v}), {info:?}"));
        let Some(expected) = self.evaluator.evaluate(ptex_face, u, v) else {
            return wrong("a patch where there is no surface".to_owned());
        };
        let distance = length(subtract(position, expected.position)) / self.largest_coordinate;
        // Also where it is NaN.
        if distance.is_nan() || distance > POSITION_TOLERANCE {
            return wrong(format!("position {position:?} is off {:?} by {distance:e}", expected.position));
        }
        let domain = &self.domains[ptex_face as usize];
        let corner = CORNERS.iter().position(|&corner| corner == [u, v]);
        let is_singular = corner.is_some_and(|corner| domain.is_singular[corner]);
        let is_compared = !is_singular && spans_a_plane(&expected);
        let Some(expected_normal) = expected.normal().filter(|_| is_compared) else { return Ok(()) };
        let edge = domain.shortest_edge / f64::from(info.level).exp2();
        let Some(normal) = normal else { return wrong(format!("no normal, expected {expected_normal:?}")) };
        let angle = length(cross(normal, expected_normal)).atan2(dot(normal, expected_normal)).to_degrees();
        if angle <= normal_tolerance(self.largest_coordinate / edge, &expected) {
            return Ok(());
        }
        let tolerance = normal_tolerance(self.largest_coordinate / edge.min(self.shortest_side(info)), &expected);
        if angle <= tolerance {
            return Ok(());
        }
        wrong(format!("normal {normal:?} is off {expected_normal:?} by {angle} degrees, at most {tolerance} expected"))
    }

    /// Half the shortest side of a patch, as it lies on the surface: near irregular vertices it is shorter than an edge
    /// of its level, and where a quad has limit points in the middles of its sides they belong to the next level.
    fn shortest_side(&mut self, info: &PatchInfo) -> f64 {
        let corners = CORNERS.map(|[u, v]| {
            let [u, v] = in_ptex_face(&info.location, [u, v]);
            self.evaluator.evaluate(info.location.ptex_face, u, v).unwrap_or_default().position
        });
        let side = |i: usize| length(subtract(corners[i], corners[(i + 1) % 4]));
        0.5 * (0..4).map(side).fold(f64::MAX, f64::min)
    }

    /// Checks that the patches cover what has a surface, and that once.
    pub fn check_coverage(&mut self, patches: &[PatchInfo]) -> Result<(), String> {
        let mut by_face: BTreeMap<u32, Vec<Location>> = BTreeMap::new();
        for info in patches {
            by_face.entry(info.location.ptex_face).or_default().push(info.location);
        }
        for face in 0..self.evaluator.ptex_face_count() {
            let locations = by_face.remove(&face).unwrap_or_default();
            let depth = locations.iter().map(|location| location.depth).max().unwrap_or(2);
            let mut covered = vec![0; 1 << (2 * depth)];
            for location in &locations {
                let shift = depth - location.depth;
                let [low_u, low_v] = [location.u, location.v].map(|low| usize::from(low) << shift);
                for v in low_v..low_v + (1 << shift) {
                    (low_u..low_u + (1 << shift)).for_each(|u| covered[(v << depth) + u] += 1);
                }
            }
            for (cell, &count) in covered.iter().enumerate() {
                let [u, v] =
                    [cell & ((1 << depth) - 1), cell >> depth].map(|low| (low as f64 + 0.5) / f64::from(depth).exp2());
                // What is covered once has been compared with the surface.
                if count > 1 || count == 0 && self.evaluator.evaluate(face, u, v).is_some() {
                    return Err(format!("Ptex face {face} is covered {count} times at ({u}, {v})"));
                }
            }
        }
        if by_face.is_empty() { Ok(()) } else { Err(format!("patches on Ptex faces {:?}", by_face.keys())) }
    }
}

/// How far a normal may be off, in degrees: points of one level have lost so many bits in their differences, and the
/// more the shorter one of the tangents is and the flatter the angle between them.
fn normal_tolerance(coordinate_by_edge: f64, expected: &SurfacePoint) -> f64 {
    let rounding = 4.0 * (-24_f64).exp2() * coordinate_by_edge;
    let longest = length(expected.du).max(length(expected.dv));
    let flatness = length(cross(expected.du, expected.dv)) / (longest * longest);
    NORMAL_TOLERANCE.max((rounding / flatness).to_degrees())
}

/// Whether no derivative is nothing but rounding, as across an edge between two faces on the same vertices.
fn spans_a_plane(point: &SurfacePoint) -> bool {
    const LEAST_RATIO: f64 = 1e-6;
    let lengths = [length(point.du), length(point.dv)];
    lengths[0].min(lengths[1]) > LEAST_RATIO * lengths[0].max(lengths[1])
}

/// A point of a patch in its Ptex face.
fn in_ptex_face(location: &Location, [u, v]: [f64; 2]) -> [f64; 2] {
    let scale = f64::from(location.depth).exp2();
    [(f64::from(location.u) + u) / scale, (f64::from(location.v) + v) / scale]
}
