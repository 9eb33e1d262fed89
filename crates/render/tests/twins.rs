//! Compute kernels against their CPU twins, buffer by buffer, on the real device with validation on.

use planish_gpu::{Device, DeviceOptions, Encoder};
use planish_render::{
    PointStages, Spacing, Surface, SurfaceDesc, SurfaceMethod, density, limit, preprocess, subdivide,
};
use planish_subdiv::ControlMesh;

/// An n-gonal prism whose caps are n-gons: n-gons, extraordinary vertices and many levels in few faces.
fn prism(n: u32) -> ControlMesh {
    let ring = |z: f32| {
        (0..n).map(move |i| {
            let angle = i as f32 * std::f32::consts::TAU / n as f32;
            [3.0 + angle.cos(), 1.3 * angle.sin(), z + 0.2 * (3.0 * angle).cos()]
        })
    };
    let mut face_sizes = vec![n, n];
    let mut face_vertices: Vec<u32> = (0..n).rev().chain(n..2 * n).collect();
    for i in 0..n {
        face_sizes.push(4);
        face_vertices.extend([i, (i + 1) % n, n + (i + 1) % n, n + i]);
    }
    ControlMesh { positions: ring(0.0).chain(ring(1.5)).collect(), face_sizes, face_vertices, ..ControlMesh::default() }
}

/// A sheet with a boundary, one row of its faces split into triangles.
fn sheet() -> ControlMesh {
    let (m, n) = (5_u32, 4_u32);
    let mut mesh = ControlMesh::default();
    for j in 0..=n {
        for i in 0..=m {
            mesh.positions.push([i as f32, j as f32 * 1.1, ((i * i + 3 * j) as f32).sin()]);
        }
    }
    for j in 0..n {
        for i in 0..m {
            let a = j * (m + 1) + i;
            let quad = [a, a + 1, a + m + 2, a + m + 1];
            if j == 1 {
                mesh.face_sizes.extend([3, 3]);
                mesh.face_vertices.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
            } else {
                mesh.face_sizes.push(4);
                mesh.face_vertices.extend(quad);
            }
        }
    }
    mesh
}

fn device() -> Device {
    let options = DeviceOptions { validation: true, selector: None, memory_budget: None };
    Device::open(&options).expect("a Vulkan device with the validation layer")
}

fn check(device: &Device, mesh: &ControlMesh, method: SurfaceMethod, spacing: Spacing, level: u32) {
    let desc = SurfaceDesc { method, spacing, level, ..SurfaceDesc::default() };
    let made = preprocess(mesh, &desc).expect("a manifold cage");
    let factors = density::level_factors((level as f32).exp2(), spacing, &made.tables).expect("factors");
    let surface = Surface::new(device, mesh, desc, made, &factors).expect("upload");
    let stages = PointStages::new(device).expect("pipelines");
    let mut encoder = Encoder::new(device, "points").expect("encoder");
    stages.record(&mut encoder, &surface);
    let recorded = encoder.finish().expect("recording");

    // Twice with different cages: every frame starts from its own.
    for shift in [0.0, 0.25] {
        let cage: Vec<[f32; 3]> = mesh.positions.iter().map(|p| [p[0] + shift * p[1], p[1], p[2] - shift]).collect();
        surface.set_cage(&cage).expect("cage");
        device.submit_and_wait(&recorded).expect("submission");
        let points = subdivide::subdivide(surface.tables(), &cage);
        let limits = limit::limit(surface.tables(), &points);
        assert_eq!(surface.download_points(device).expect("points"), points);
        assert_eq!(surface.download_limits(device).expect("limits"), limits);
        assert!(limits.iter().all(|l| (l.normal.iter().map(|c| c * c).sum::<f32>() - 1.0).abs() < 1e-5));
    }
}

#[test]
fn kernels_equal_their_twins_bit_for_bit() {
    let device = device();
    for mesh in [prism(3), prism(5), prism(40), sheet()] {
        for (spacing, level) in [(Spacing::FractionalOdd, 0), (Spacing::Equal, 5), (Spacing::FractionalEven, 3)] {
            check(&device, &mesh, SurfaceMethod::Fas, spacing, level);
        }
        check(&device, &mesh, SurfaceMethod::Uniform, Spacing::Equal, 3);
    }
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}
