//! What tables make, in f64, against the evaluator.

use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{EditOperation, HierarchicalEdit};
use planish_subdiv::patch::{PatchInfo, SurfacePoint, evaluate_crease, reflect};
use planish_subdiv::selection::deepest_cut;
use planish_subdiv::stencil::StencilRow;
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::{Level, NONE};

/// Largest distance from the limit surface, in the largest coordinate.
const TOLERANCE: f64 = 2e-6;
/// Largest angle between normals, where both are well defined: rows have 32-bit weights.
const ANGLE: f64 = 2e-4;
/// Corners of a face, then the middles of its edges.
const CORNERS: [[f64; 2]; 8] =
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]];

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
}

/// A row's sums: the first point counts as the origin.
fn sum<const N: usize>(
    row: StencilRow,
    indices: &[u32],
    points: &[[f64; 3]],
    weight: impl Fn(u32) -> [f64; N],
) -> [[f64; 3]; N] {
    let origin = points[indices[row.first_index as usize] as usize];
    let mut sums = [[0.0; 3]; N];
    sums[0] = origin;
    for i in 0..row.count {
        let p = points[indices[(row.first_index + i) as usize] as usize];
        for (sum, weight) in sums.iter_mut().zip(weight(row.first_weight + i)) {
            (0..3).for_each(|c| sum[c] += weight * (p[c] - origin[c]));
        }
    }
    sums
}

/// All points of all levels, by the stencil rows and the edits.
pub fn points(positions: &[[f32; 3]], tables: &Tables) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = positions.iter().map(|p| p.map(f64::from)).collect();
    points.resize(tables.point_count() as usize, [f64::NAN; 3]);
    for level in &tables.levels {
        for row_index in level.dispatches.iter().cloned().flatten() {
            let row = tables.stencils.rows[row_index as usize];
            let weight = |i: u32| [f64::from(tables.stencils.weights[i as usize])];
            let [point] = sum(row, &tables.stencils.indices, &points, weight);
            points[(row_index + tables.cage_point_count) as usize] = point;
        }
        for edit in &tables.edits[level.edits.start as usize..level.edits.end as usize] {
            let point = &mut points[edit.point as usize];
            *point = std::array::from_fn(|c| f64::from(edit.keep) * point[c] + f64::from(edit.offset[c]));
        }
    }
    points
}

/// A limit point.
pub fn limit(tables: &Tables, points: &[[f64; 3]], index: u32) -> SurfacePoint {
    let weight = |i: u32| tables.limits.weights[i as usize].map(f64::from);
    let [position, du, dv] = sum(tables.limits.rows[index as usize], &tables.limits.indices, points, weight);
    SurfacePoint { position, du, dv }
}

struct Judge {
    evaluator: Evaluator,
    size: f64,
    has_normals: bool,
    has_hole_edits: bool,
}

impl Judge {
    fn judge(&mut self, info: &PatchInfo, [u, v]: [f64; 2], found: &SurfacePoint) {
        let l = info.location;
        let scale = (-f64::from(l.depth)).exp2();
        let (u, v) = ((f64::from(l.u) + u) * scale, (f64::from(l.v) + v) * scale);
        let Some(expected) = self.evaluator.evaluate(l.ptex_face, u, v) else {
            // A corner may be a hole's too, and the evaluator asks that one.
            return assert!(self.has_hole_edits, "{info:?} has no limit at {u}, {v}");
        };
        let error = distance(found.position, expected.position);
        assert!(
            error < TOLERANCE * self.size,
            "{info:?} at {u}, {v}: {found:?}, expected {expected:?}, error {error:e}"
        );
        let well_defined = |p: &SurfacePoint| {
            let sine = distance(cross(p.du, p.dv), [0.0; 3]);
            let lengths = [p.du, p.dv].map(|d| distance(d, [0.0; 3]));
            // Differences of points of a fine level carry the rounding of weights.
            (self.has_normals && sine > 0.1 * lengths[0] * lengths[1] && lengths.iter().all(|&l| l > 1e-3 * self.size))
                .then(|| p.normal())
        };
        if let (Some(Some(a)), Some(Some(b))) = (well_defined(found), well_defined(&expected)) {
            assert!(distance(a, b) < ANGLE, "{info:?} at {u}, {v}: normal {a:?}, expected {b:?}");
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Compares every patch and every limit point of the tables, of all levels, with the evaluator; returns the area of the
/// Ptex faces that the deepest cut covers, or uniform refinement's faces.
pub fn check(mesh: &ControlMesh, tables: &Tables) -> f64 {
    let points = points(&mesh.positions, tables);
    let size = mesh.positions.iter().flatten().fold(0.0_f64, |m, &c| m.max(f64::from(c.abs())));
    let has_normals = has_normals(mesh);
    let has_hole_edits = mesh.edits.iter().any(|edit| edit.operation == EditOperation::Hole);
    let mut judge = Judge { evaluator: Evaluator::new(mesh).expect("a legal cage"), size, has_normals, has_hole_edits };
    for patch in &tables.patches {
        let mut control = patch.points.map(|p| points[p as usize]);
        reflect(&mut control, patch.info.boundary);
        for [u, v] in [[0.0, 0.0], [1.0, 0.25], [0.3, 1.0], [0.6, 0.7]] {
            let found = evaluate_crease(&control, patch.info.crease, f64::from(patch.sharpness), u, v);
            judge.judge(&patch.info, [u, v], &found);
        }
    }
    for face in &tables.irregular {
        for (sample, &index) in CORNERS.iter().zip(face.limits.iter().chain(&face.midpoints)) {
            if index != NONE {
                judge.judge(&face.info, *sample, &limit(tables, &points, index));
            }
        }
    }
    for quad in &tables.filling {
        for (sample, &index) in CORNERS.iter().zip(&quad.corners) {
            judge.judge(&quad.info, *sample, &limit(tables, &points, index));
        }
    }
    let cut = deepest_cut(tables, &tables.ranges());
    let level_0 = tables.patch_ranges[0].clone();
    let patches = level_0.chain(cut.patches).map(|patch| tables.patches[patch as usize].info);
    let leaves = cut.leaves.iter().map(|leaf| tables.irregular[leaf.face as usize].info);
    let filling = tables.filling.iter().map(|quad| quad.info);
    patches.chain(leaves).chain(filling).map(|info| (-2.0 * f64::from(info.location.depth)).exp2()).sum()
}

/// Whether the surface has a tangent plane everywhere: it has none in general where infinitely sharp edges meet, and at
/// vertices of two faces.
fn has_normals(mesh: &ControlMesh) -> bool {
    let level = Level::from_mesh(mesh).expect("a legal cage");
    let of_edit = |edit: &HierarchicalEdit| match edit.operation {
        EditOperation::SetEdgeSharpness(sharpness) | EditOperation::SetVertexSharpness(sharpness) => sharpness,
        _ => 0.0,
    };
    let of_cage = mesh.creases.iter().map(|crease| crease.sharpness);
    let of_cage = of_cage.chain(mesh.corners.iter().map(|corner| corner.sharpness));
    let mut used = (0..level.tags.len() as u32).filter(|&vertex| level.starts[vertex as usize] != NONE);
    level.non_manifold_edge_count() == 0
        && of_cage.chain(mesh.edits.iter().map(of_edit)).all(|sharpness| sharpness < 10.0)
        && used.all(|v| {
            let tag = level.tag(v);
            !tag.is_non_manifold() && (tag.is_boundary() || level.incident_edges(v).len() > 2)
        })
}
