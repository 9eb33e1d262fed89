//! Hierarchical edits on the GPU: against the CPU, and moved without new tables.

use glam::{Mat4, Vec3};
use planish_gpu::{Device, DeviceOptions, Encoder};
use planish_render::{
    Density, FrameCamera, FrameNeeds, FrameOptions, FrameStages, ObjectDesc, Selection, Spacing, Surface, SurfaceDesc,
    limit, preprocess, subdivide,
};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{EditOperation, HierarchicalEdit};
use planish_subdiv::patch::{evaluate, reflect};
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::NONE;

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
    const CORNERS: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    const MIDDLES: [(f64, f64); 4] = [(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)];
    for face in tables.irregular.iter().filter(|face| !face.is_hidden) {
        let places = CORNERS.into_iter().zip(face.limits).chain(MIDDLES.into_iter().zip(face.midpoints));
        for ((u, v), limit) in places.filter(|&(_, limit)| limit != NONE) {
            compare(face.info.location, u, v, limits[limit as usize].position.map(f64::from));
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
    let made = preprocess(&[&mesh], &desc).expect("a legal cage");
    let surface = Surface::new(&device, &[&mesh], &[ObjectDesc::identity(0)], desc, made).expect("upload");
    let stages = FrameStages::new(&device, &FrameNeeds::all(Spacing::Equal)).expect("pipelines");
    // All that can be refined is.
    let options =
        FrameOptions { density: Density::Tess(16.0), selection: Selection::Static, ..FrameOptions::default() };
    let projection = Mat4::from_scale(Vec3::ONE);
    let camera = FrameCamera { world_to_camera: Mat4::IDENTITY, projection, size: [64, 48] };
    surface.set_frame(&camera, &options).expect("a frame");
    let mut encoder = Encoder::new(&device, "points").expect("encoder");
    stages.record(&mut encoder, &surface);
    FrameStages::record_end(&mut encoder, &surface);
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
        let (twin, limits) = (subdivide::subdivide(&tables, &mesh.positions), surface.download_limits(&device));
        let (twin_limits, limits) = (limit::limit(&tables, &twin), limits.expect("limits"));
        let mut in_use = surface.download_rows_in_use(&device).expect("rows");
        for limit in in_use.pop().expect("limit points") {
            let (made, twin) = (&limits[limit as usize], &twin_limits[limit as usize]);
            assert_eq!(made.position, twin.position);
            // Of a normal's length the quotient is not everywhere rounded as here.
            let bound = if device.is_software() { 0.0 } else { 4.0 * f32::EPSILON };
            assert!((0..3).all(|c| (made.normal[c] - twin.normal[c]).abs() <= bound), "{made:?} {twin:?}");
        }
        let rows: Vec<u32> = in_use.into_iter().flatten().collect();
        assert!(2 * rows.len() > tables.stencils.rows.len());
        for place in rows.iter().map(|row| (tables.cage_point_count + row) as usize) {
            assert_eq!(points[place], twin[place]);
        }
        let difference = largest_difference(&mesh, &tables, &twin);
        assert!(difference < 2e-6, "{difference}");
    }
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}
