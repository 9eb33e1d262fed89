use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::*;
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, DeviceOptions, Encoder};
use planish_render::*;
use planish_subdiv::ControlMesh;
use std::io::Write as _;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&a[1]).unwrap();
    let t: f32 = a[2].parse().unwrap();
    let spacing = match a[3].as_str() {
        "equal" => Spacing::Equal,
        "odd" => Spacing::FractionalOdd,
        _ => Spacing::FractionalEven,
    };
    let mode = a[4].as_str();
    let mut m = ControlMesh::default();
    for l in text.lines() {
        let mut w = l.split_whitespace();
        match w.next() {
            Some("v") => {
                let p: Vec<f64> = w.map(|x| x.parse().unwrap()).collect();
                m.positions.push([p[0] as f32, p[1] as f32, p[2] as f32]);
            }
            Some("f") => {
                let n = m.face_vertices.len();
                m.face_vertices.extend(w.map(|x| x.split('/').next().unwrap().parse::<u32>().unwrap() - 1));
                m.face_sizes.push((m.face_vertices.len() - n) as u32);
            }
            _ => {}
        }
    }
    let device = Device::open(&DeviceOptions {
        validation: std::env::var_os("VAL").is_some(),
        selector: None,
        memory_budget: None,
    })
    .unwrap();
    let method = if mode.contains('u') { SurfaceMethod::Uniform } else { SurfaceMethod::Fas };
    let level = density::isolation_level(t, 10);
    let desc = SurfaceDesc { method, spacing, level };
    let made = preprocess(&m, &desc).unwrap();
    let factors = density::level_factors(t, spacing, &made.tables).unwrap();
    let c = made.tables.total_counts();
    let surface = Surface::new(&device, &m, desc, made, &factors).unwrap();
    eprintln!("level {level} counts {c:?} times {:?} memory {:?}", surface.times(), surface.memory());
    let [lo, hi] = m.bounding_box().unwrap().map(Vec3::from);
    let (cen, diag) = (0.5 * (lo + hi), (hi - lo).length());
    let eye = cen + 1.1 * diag * Vec3::new(1.0, 0.6, 1.2).normalize();
    let size = std::env::var("SIZE").map_or([1280u32, 720], |s| {
        let v: Vec<u32> = s.split('x').map(|x| x.parse().unwrap()).collect();
        [v[0], v[1]]
    });
    let camera = FrameCamera {
        world_to_camera: look_at_mat4(eye, cen, Vec3::Y),
        projection: perspective_infinite_reverse(45f32.to_radians(), 16.0 / 9.0, 0.05 * diag),
        size,
    };
    let frame = FrameConstants::new(&device).unwrap();
    frame.set(&camera, &factors).unwrap();
    let stages = PointStages::new(&device).unwrap();
    if mode.starts_with('d') {
        let mut e = Encoder::new(&device, "points").unwrap();
        stages.record(&mut e, &surface);
        device.submit_and_wait(&e.finish().unwrap()).unwrap();
        let mut vs: Vec<CapturedVertex> = vec![];
        DumpPasses::new(&device, method, spacing)
            .unwrap()
            .capture::<Error>(&device, &surface, &frame, &factors, |v| {
                vs.extend_from_slice(v);
                Ok(())
            })
            .unwrap();
        let mut f = std::io::BufWriter::new(std::fs::File::create(&a[5]).unwrap());
        write!(f, "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\nproperty int face\nproperty uchar level\nproperty uchar kind\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n", vs.len(), vs.len() / 3).unwrap();
        for v in &vs {
            f.write_all(&bytemuck::bytes_of(v)[..36]).unwrap();
            f.write_all(&(v.level_and_kind as u16).to_le_bytes()).unwrap();
        }
        for i in 0..vs.len() as u32 / 3 {
            f.write_all(&[3]).unwrap();
            for k in 0..3 {
                f.write_all(&(3 * i + k).to_le_bytes()).unwrap();
            }
        }
    } else {
        let view = match a.get(6).map(|s| s.as_str()) {
            Some("patch") => View::Patch,
            Some("level") => View::Level,
            Some("normal") => View::Normal,
            Some("tess") => View::Tess,
            Some("wire") => View::Wire,
            _ => View::Shaded,
        };
        let opt = DrawOptions { method, spacing, view, layers: false, cull_back: mode.contains('c') };
        let passes = DrawPasses::new(&device, &opt).unwrap();
        let targets = Targets::new(&device, size, opt.needs_layers()).unwrap();
        let mut e = Encoder::new(&device, "frame").unwrap();
        stages.record(&mut e, &surface);
        passes.record(&mut e, &surface, &frame, &targets);
        let r = e.finish().unwrap();
        device.submit_and_wait(&r).unwrap();
        let cpu = || -> f64 {
            let s = std::fs::read_to_string("/proc/self/stat").unwrap();
            let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
            (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) * 10.0
        };
        let c0 = cpu();
        let mut walls = vec![];
        let mut rep = None;
        for _ in 0..std::env::var("REP").map_or(7, |s| s.parse().unwrap()) {
            let s = std::time::Instant::now();
            surface.set_cage(&m.positions).unwrap();
            rep = Some(device.submit_and_wait(&r).unwrap());
            walls.push(s.elapsed().as_secs_f64() * 1e3);
        }
        eprintln!("cpu ms per frame {:.1}", (cpu() - c0) / walls.len() as f64);
        walls.sort_by(f64::total_cmp);
        let rep = rep.unwrap();
        eprintln!(
            "wall median {:.2} min {:.2} ts {:?} tris {} tes {}",
            walls[walls.len() / 2],
            walls[0],
            rep.timestamps,
            rep.statistics[0].1.clipping_invocations,
            rep.statistics[0].1.tessellation_evaluation_invocations
        );
        let rb = Buffer::new(
            &device,
            &BufferDesc { name: "rb", kind: BufferKind::Readback, size: targets.color().copy_size() },
        )
        .unwrap();
        let mut e = Encoder::new(&device, "rb").unwrap();
        e.copy_image_to_buffer(targets.color(), &rb, 0);
        device.submit_and_wait(&e.finish().unwrap()).unwrap();
        let px: Vec<u16> = rb.read(0, (size[0] * size[1] * 4) as usize).unwrap();
        let mut f = std::io::BufWriter::new(std::fs::File::create(&a[5]).unwrap());
        write!(f, "P6\n{} {}\n255\n", size[0], size[1]).unwrap();
        for p in px.chunks(4) {
            for c in 0..3 {
                let h = p[c];
                let (ex, ma) = ((h >> 10) & 31, h & 1023);
                let v = if ex == 0 {
                    ma as f32 / 16777216.0
                } else {
                    (1.0 + ma as f32 / 1024.0) * 2f32.powi(ex as i32 - 15)
                };
                f.write_all(&[(v.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8]).unwrap();
            }
        }
    }
    for m in device.validation_messages() {
        eprintln!("VALIDATION {m}");
    }
}
