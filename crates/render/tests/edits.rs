//! Hierarchical edits on the GPU: against the CPU, and moved without new tables.

use planish_gpu::{Device, DeviceOptions, Encoder};
use planish_render::{PointStages, Surface, SurfaceDesc, density, limit, preprocess, subdivide};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{EditOperation, HierarchicalEdit};
use planish_subdiv::patch::{evaluate, reflect};
use planish_subdiv::tables::Tables;

/// A cube of 2 x 2 quads a side, with edits at three levels; two of them move the same point.
fn edited_cube() -> ControlMesh {
    let mut mesh = ControlMesh::default();
    let mut index_of = std::collections::HashMap::new();
    let axes = [([1, 2], 0, 0), ([2, 1], 0, 2), ([2, 0], 1, 0), ([0, 2], 1, 2), ([0, 1], 2, 0), ([1, 0], 2, 2)];
    for ([u, v], axis, side) in axes {
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            mesh.face_sizes.push(4);
            for (di, dj) in [(0, 0), (0, 1), (1, 1), (1, 0)] {
                let mut p = [0_i32; 3];
                (p[axis], p[u], p[v]) = (side, i + di, j + dj);
                let next = mesh.positions.len() as u32;
                mesh.face_vertices.push(*index_of.entry(p).or_insert_with(|| {
                    mesh.positions.push(p.map(|c| c as f32 - 0.75));
                    next
                }));
            }
        }
    }
    let edit = |path: &[u32], operation| HierarchicalEdit { path: path.to_vec(), operation };
    mesh.edits = vec![
        edit(&[0, 2], EditOperation::AddPosition([-0.2, 0.1, 0.0])),
        edit(&[5, 1, 2], EditOperation::AddPosition([0.3, 0.0, 0.1])),
        edit(&[5, 1, 1, 0], EditOperation::SetPosition([0.9, 0.9, 0.9])),
        edit(&[9, 0, 2], EditOperation::AddPosition([0.0, 0.2, 0.0])),
        edit(&[9, 2, 0], EditOperation::AddPosition([0.0, 0.2, 0.1])),
        edit(&[14, 3, 1], EditOperation::SetEdgeSharpness(2.3)),
        edit(&[17, 0, 3, 2], EditOperation::SetVertexSharpness(10.0)),
    ];
    mesh
}

/// Compares every patch and limit point with the f64 evaluator; returns the largest difference.
fn largest_difference(mesh: &ControlMesh, tables: &Tables, points: &[[f32; 3]]) -> f64 {
    let mut evaluator = Evaluator::new(mesh).expect("a legal cage");
    let mut largest = 0.0_f64;
    let mut compare = |location: planish_subdiv::topology::Location, u: f64, v: f64, got: [f64; 3]| {
        let scale = (-f64::from(location.depth)).exp2();
        let (u, v) = ((f64::from(location.u) + u) * scale, (f64::from(location.v) + v) * scale);
        let expected = evaluator.evaluate(location.ptex_face, u, v).expect("a limit").position;
        (0..3).for_each(|c| largest = largest.max((got[c] - expected[c]).abs()));
    };
    for patch in &tables.patches {
        let mut control = patch.points.map(|p| points[p as usize].map(f64::from));
        reflect(&mut control, patch.info.boundary);
        for (u, v) in [(0.0, 0.0), (1.0, 0.25), (0.3, 1.0), (0.6, 0.7)] {
            compare(patch.info.location, u, v, evaluate(&control, u, v).position);
        }
    }
    let limits = limit::limit(tables, points);
    for quad in &tables.filling {
        for ((u, v), corner) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].into_iter().zip(quad.corners) {
            compare(quad.info.location, u, v, limits[corner as usize].position.map(f64::from));
        }
    }
    largest
}

#[test]
fn edits_on_the_gpu_equal_those_of_the_cpu_and_move_without_new_tables() {
    let options = DeviceOptions { validation: true, selector: None, memory_budget: None };
    let device = Device::open(&options).expect("a Vulkan device with the validation layer");
    let mut mesh = edited_cube();
    let desc = SurfaceDesc { level: 4, ..SurfaceDesc::default() };
    let made = preprocess(&mesh, &desc).expect("a legal cage");
    let factors = density::level_factors(16.0, desc.spacing, &made.tables).expect("factors");
    let surface = Surface::new(&device, &mesh, desc, made, &factors).expect("upload");
    let stages = PointStages::new(&device).expect("pipelines");
    let mut encoder = Encoder::new(&device, "points").expect("encoder");
    stages.record(&mut encoder, &surface);
    let recorded = encoder.finish().expect("recording");
    for shift in [0.0, 0.05] {
        for edit in &mut mesh.edits {
            if let EditOperation::AddPosition(p) | EditOperation::SetPosition(p) = &mut edit.operation {
                p[1] += shift;
            }
        }
        surface.set_edits(&mesh.edits).expect("offsets");
        // The same tables and the same recording: only offsets are new.
        device.submit_and_wait(&recorded).expect("submission");
        let points = surface.download_points(&device).expect("points");
        let mut tables = surface.tables().clone();
        tables.edits = tables.point_edits(&mesh.edits);
        assert_eq!(points, subdivide::subdivide(&tables, &mesh.positions));
        assert_eq!(surface.download_limits(&device).expect("limits"), limit::limit(&tables, &points));
        let difference = largest_difference(&mesh, &tables, &points);
        assert!(difference < 2e-6, "{difference}");
    }
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}
