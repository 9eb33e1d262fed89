//! A device that shades: surfaces of materials, and lights.

use std::sync::MutexGuard;

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use half::f16;
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, Encoder};
use planish_render::shading::{
    EnvironmentDesc, LightDesc, LightKind, MaterialDesc, SceneSphere, ShadePass, ShadedFrame, Shading, ShadingDesc,
    Shadows,
};
use planish_render::{
    DrawOptions, DrawPasses, FrameCamera, FrameNeeds, FrameOptions, FrameStages, Layers, ObjectDesc, Spacing, Surface,
    SurfaceDesc, Targets, View, preprocess,
};
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::{FaceVaryingChannel, FaceVaryingInterpolation, MeshOptions};

use super::lab;

/// Texels of a shadow map.
const MAP_SIZE: u32 = 512;

/// A device with the programs that shade.
pub struct Darkroom {
    pub device: Device,
    desc: SurfaceDesc,
    needs: FrameNeeds,
    stages: FrameStages,
    passes: DrawPasses,
    // Given back last.
    _turn: MutexGuard<'static, ()>,
}

/// A surface with its materials.
pub struct Subject {
    pub surface: Surface,
    shading: Shading,
    sphere: SceneSphere,
}

impl Darkroom {
    pub fn new(cutouts: bool) -> Self {
        Self::with_desc(cutouts, SurfaceDesc { level: 4, ..SurfaceDesc::default() })
    }

    pub fn with_desc(cutouts: bool, desc: SurfaceDesc) -> Self {
        let turn = lab::turn();
        let device = lab::device();
        let needs = FrameNeeds {
            tex_coords: true,
            colors: true,
            displaced: desc.displaced,
            cutouts,
            gregory: desc.has_gregory_patches(),
            rival: desc.method.rival(),
            ..FrameNeeds::all(Spacing::FractionalOdd)
        };
        let options = DrawOptions { view: View::Shaded, layers: Layers::Shading, cull_back: false };
        Self {
            stages: FrameStages::new(&device, &needs).expect("pipelines"),
            passes: DrawPasses::new(&device, &desc, &needs, &options).expect("pipelines"),
            device,
            desc,
            needs,
            _turn: turn,
        }
    }

    pub fn subject(&self, meshes: &[ControlMesh], objects: &[ObjectDesc], desc: &ShadingDesc<'_>) -> Subject {
        let all: Vec<&ControlMesh> = meshes.iter().collect();
        let made = preprocess(&all, &self.desc).expect("tables");
        let mut surface = Surface::new(&self.device, &all, objects, self.desc, made).expect("upload");
        surface.set_tex_coords(&self.device, &all).expect("texture coordinates");
        surface.set_colors(&self.device, &all).expect("colours");
        let shading = Shading::new(&self.device, &mut surface, desc).expect("materials");
        let points: Vec<Vec3> = objects
            .iter()
            .flat_map(|object| {
                let points = &meshes[object.mesh].positions;
                points.iter().map(|&p| object.to_world.transform_point3(Vec3::from(p)))
            })
            .collect();
        let center = points.iter().sum::<Vec3>() / points.len() as f32;
        let radius = points.iter().map(|p| p.distance(center)).fold(0.0, f32::max);
        Subject { surface, shading, sphere: SceneSphere { center, radius } }
    }

    fn submit(&self, name: &str, surface: &mut Surface, record: impl Fn(&mut Encoder, &Surface)) {
        loop {
            let mut encoder = Encoder::new(&self.device, name).expect("encoder");
            record(&mut encoder, surface);
            self.device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
            if !surface.grow(&self.device).expect("room") {
                return;
            }
        }
    }

    /// Shades so many samples of a frame.
    pub fn shoot(
        &self,
        subject: &mut Subject,
        camera: &FrameCamera,
        lights: &[LightDesc],
        samples: u32,
    ) -> ShadedFrame {
        let device = &self.device;
        let mut shadows = Shadows::new(device, &self.desc, &self.needs, MAP_SIZE).expect("shadow maps");
        let targets = Targets::new(device, camera.size, Layers::Shading).expect("images");
        let pass = ShadePass::new(device, camera.size, true).expect("a pass");
        let options = FrameOptions::default();
        let Subject { surface, shading, sphere } = subject;
        let mut encoder = Encoder::new(device, "clear").expect("encoder");
        pass.record_clear(&mut encoder);
        device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
        for sample in 0..samples {
            let several = (samples > 1).then_some(sample);
            shading.set_sample(sample).expect("a sample");
            let maps = shadows.set_lights(device, lights, sphere, several).expect("lights");
            for view in 0..maps {
                shadows.set_frame(surface, view, &options).expect("a frame");
                self.submit("shadows", surface, |encoder, surface| {
                    shadows.record(encoder, surface, &self.stages, shading, view);
                });
            }
            let offset = if samples > 1 { sample_offset(sample) } else { Vec2::ZERO };
            let camera = camera.jittered(offset);
            surface.set_frame(&camera, &options).expect("a frame");
            self.submit("frame", surface, |encoder, surface| {
                self.stages.record(encoder, surface);
                self.passes.record(encoder, surface, &camera, &targets);
                FrameStages::record_end(encoder, surface);
            });
            pass.set_sample(&camera, shading, &shadows, sample).expect("a sample");
            let mut encoder = Encoder::new(device, "shade").expect("encoder");
            pass.record(&mut encoder, &targets, shading, &shadows);
            device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
        }
        pass.read(device, samples).expect("a frame")
    }

    /// What is drawn without materials, in halves.
    pub fn draw_plainly(&self, subject: &mut Subject, camera: &FrameCamera) -> Vec<[f16; 4]> {
        let device = &self.device;
        let options = DrawOptions { view: View::Shaded, layers: Layers::None, cull_back: false };
        let passes = DrawPasses::new(device, &self.desc, &self.needs, &options).expect("pipelines");
        let targets = Targets::new(device, camera.size, Layers::None).expect("images");
        let size = targets.color().copy_size();
        let desc = BufferDesc { name: "image", kind: BufferKind::Readback, size };
        let read = Buffer::new(device, &desc).expect("a buffer");
        subject.surface.set_frame(camera, &FrameOptions::default()).expect("a frame");
        self.submit("plain", &mut subject.surface, |encoder, surface| {
            self.stages.record(encoder, surface);
            passes.record(encoder, surface, camera, &targets);
            encoder.copy_image_to_buffer(targets.color(), &read, 0);
            FrameStages::record_end(encoder, surface);
        });
        let words: Vec<[u16; 4]> = read.read(0, (size / 8) as usize).expect("pixels");
        words.into_iter().map(|words| words.map(f16::from_bits)).collect()
    }

    pub fn assert_silent(&self) {
        assert_eq!(self.device.validation_messages(), Vec::<String>::new());
    }
}

fn sample_offset(sample: u32) -> Vec2 {
    let fraction = |step: f32| (0.5 + step * sample as f32).fract() - 0.5;
    Vec2::new(fraction(0.754_877_7), fraction(0.569_840_3))
}

/// A square in the plane z = 0 from -1 to 1, facing +z, of `count` faces a side; texture coordinates are 0 at its upper left corner and
/// `repeats` at the lower right one.
pub fn wall(count: u32, repeats: f32) -> ControlMesh {
    let share = |i: u32| i as f32 / count as f32;
    let side = count + 1;
    let places = (0..side * side).map(|i| [share(i % side), share(i / side)]);
    let faces = (0..count * count).map(|i| (i % count, i / count));
    // Counter-clockwise, seen from +z: rows go down.
    let corners = faces.flat_map(|(x, y)| [(x, y + 1), (x + 1, y + 1), (x + 1, y), (x, y)]);
    let face_vertices: Vec<u32> = corners.map(|(x, y)| y * side + x).collect();
    ControlMesh {
        positions: places.clone().map(|[x, y]| [2.0 * x - 1.0, 1.0 - 2.0 * y, 0.0]).collect(),
        face_sizes: vec![4; (count * count) as usize],
        face_varying: vec![FaceVaryingChannel {
            name: "st".to_owned(),
            values: places.map(|place| place.map(|at| repeats * at)).collect(),
            indices: face_vertices.clone(),
        }],
        face_vertices,
        options: MeshOptions { face_varying: FaceVaryingInterpolation::All, ..MeshOptions::default() },
        ..ControlMesh::default()
    }
}

/// A camera at `eye` that looks at `target`, this many degrees high.
pub fn camera(eye: [f32; 3], target: [f32; 3], degrees: f32, size: [u32; 2]) -> FrameCamera {
    let (eye, target) = (Vec3::from(eye), Vec3::from(target));
    let up = if (target - eye).normalize().y.abs() > 0.99 { Vec3::NEG_Z } else { Vec3::Y };
    let aspect = size[0] as f32 / size[1] as f32;
    FrameCamera {
        world_to_camera: glam::camera::rh::view::look_at_mat4(eye, target, up),
        projection: glam::camera::rh::proj::directx::perspective_infinite_reverse(degrees.to_radians(), aspect, 0.01),
        size,
    }
}

/// The point of the plane z = 0 that a pixel's middle shows.
pub fn on_wall(camera: &FrameCamera, x: u32, y: u32) -> Vec3 {
    let inverse = camera.view_projection().as_dmat4().inverse();
    let [width, height] = camera.size.map(f64::from);
    let (u, v) = ((f64::from(x) + 0.5) / width * 2.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / height * 2.0);
    let eye = camera.eye().as_dvec3();
    let far = inverse.project_point3(glam::DVec3::new(u, v, 0.5));
    let way = far - eye;
    (eye - way * (eye.z / way.z)).as_vec3()
}

/// Something that shines by itself, as its texture or this color says, and reflects nothing.
pub fn glowing(emissive: [f32; 3]) -> MaterialDesc {
    MaterialDesc { emissive, base_color: [0.0; 3], ior: 1.0, ..MaterialDesc::default() }
}

/// Parallel light from a direction.
pub fn sun(from: [f32; 3], irradiance: f32, angle: f32) -> LightDesc {
    let turn = Quat::from_rotation_arc(Vec3::Z, Vec3::from(from).normalize());
    LightDesc {
        kind: LightKind::Distant { angle },
        to_world: Affine3A::from_quat(turn),
        intensity: [irradiance; 3],
        casts_shadows: true,
    }
}

/// The same light from everywhere.
pub fn even(radiance: f32) -> EnvironmentDesc<'static> {
    EnvironmentDesc { image: None, color: [radiance; 3], to_world: Mat3::IDENTITY, is_visible: false }
}

pub fn halves(color: [f32; 4]) -> [f16; 4] {
    color.map(f16::from_f32)
}
