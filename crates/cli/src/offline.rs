//! Device, surface and passes: what `render`, `dump` and `bench` share.

use std::time::Instant;

use anyhow::{Context, Result, bail};
use glam::{Mat4, Vec3};
use planish_gpu::{Device, Encoder, Recorded, SubmitReport};
use planish_render::density::{FACTOR_COUNT, isolation_level, level_factors, tess_factor};
use planish_render::tessellation::triangle_count;
use planish_render::{
    Density, DrawOptions, DrawPasses, FrameCamera, FrameConstants, PointStages, Surface, SurfaceDesc, Targets, View,
    preprocess,
};
use planish_scene::Camera;
use planish_subdiv::tables::PatchCounts;

use crate::args::{DeviceArguments, SurfaceArguments, ViewArguments};
use crate::cage::{Cage, milliseconds};
use crate::console::Console;

/// How a cage is to be evaluated and seen: all that is decided before a device is needed.
pub struct Plan {
    /// The camera, as the scene describes it.
    pub camera: Camera,
    /// The same, as the passes want it.
    pub frame_camera: FrameCamera,
    /// What the surface is made as.
    pub desc: SurfaceDesc,
    /// Tess factor of the base edges.
    pub tess_factor: f32,
}

impl Plan {
    /// Decides for a cage that is to be seen.
    pub fn new(cage: &Cage, surface: &SurfaceArguments, view: &ViewArguments) -> Result<Self> {
        let camera = cage.camera(view)?;
        Self::with_camera(cage, surface, view, camera)
    }

    /// Decides for a cage that is not drawn: with a given tess factor there need not be a camera that sees it.
    pub fn unseen(cage: &Cage, surface: &SurfaceArguments, view: &ViewArguments) -> Result<Self> {
        let camera = match (cage.camera(view), surface.density()) {
            (Err(_), Density::Tess(_)) => Camera::upright("none", Vec3::Z, Vec3::ZERO, 45.0, 1.0)?,
            (camera, _) => camera?,
        };
        Self::with_camera(cage, surface, view, camera)
    }

    fn with_camera(cage: &Cage, surface: &SurfaceArguments, view: &ViewArguments, camera: Camera) -> Result<Self> {
        surface.check_available()?;
        let method = surface.method()?;
        let frame_camera = frame_camera(&camera, view.size);
        let tess_factor = tess_factor(cage.mesh(), &frame_camera, surface.density())?;
        let level = isolation_level(tess_factor, surface.max_level());
        let crease_patches = surface.crease_patches.into();
        let desc = SurfaceDesc { method, spacing: surface.spacing.into(), level, crease_patches };
        Ok(Self { camera, frame_camera, desc, tess_factor })
    }
}

/// A scene's camera, for an image of this size.
pub fn frame_camera(camera: &Camera, size: [u32; 2]) -> FrameCamera {
    let clip_y_up = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    FrameCamera {
        world_to_camera: camera.view_matrix(),
        projection: clip_y_up * camera.projection_matrix(aspect(size)),
        size,
    }
}

/// Width over height.
pub fn aspect([width, height]: [u32; 2]) -> f32 {
    width as f32 / height as f32
}

/// Opens the device asked for.
pub fn open_device(arguments: &DeviceArguments, console: &Console) -> Result<Device> {
    let device = Device::open(&arguments.options())?;
    console.explain(format_args!("device: {} ({}, {})", device.name(), device.kind(), device.driver()));
    Ok(device)
}

/// Fails if the validation layer has said anything.
pub fn check_validation(device: &Device) -> Result<()> {
    let messages = device.validation_messages();
    if let Some(first) = messages.first() {
        bail!("validation gave {} messages, the first: {first}", messages.len());
    }
    Ok(())
}

/// A cage on a device, ready for frames.
pub struct Session {
    pub device: Device,
    pub surface: Surface,
    pub constants: FrameConstants,
    pub factors: [f32; FACTOR_COUNT],
    pub tess_factor: f32,
    pub camera: FrameCamera,
    stages: PointStages,
    /// How long making pipelines took, in milliseconds.
    pub pipelines_ms: f64,
}

impl Session {
    /// Builds the cage's tables and uploads them.
    pub fn new(device: &Device, cage: &Cage, plan: &Plan, console: &Console) -> Result<Self> {
        let named = || cage.path().display().to_string();
        let made = preprocess(cage.mesh(), &plan.desc).with_context(named)?;
        let factors = level_factors(plan.tess_factor, plan.desc.spacing, &made.tables).with_context(named)?;
        let surface = Surface::new(device, cage.mesh(), plan.desc, made, &factors).with_context(named)?;
        let start = Instant::now();
        let stages = PointStages::new(device)?;
        let pipelines_ms = milliseconds(start);
        let constants = FrameConstants::new(device, &plan.frame_camera, &factors)?;
        let counts = surface.tables().total_counts();
        console.explain(format_args!(
            "tess factor {}, irregularities isolated to level {}: {} regular, {} transition and {} filling patches",
            plan.tess_factor,
            surface.tables().last_level,
            counts.regular,
            counts.transition,
            counts.filling
        ));
        Ok(Self {
            device: device.clone(),
            surface,
            constants,
            factors,
            tess_factor: plan.tess_factor,
            camera: plan.frame_camera,
            stages,
            pipelines_ms,
        })
    }

    /// Records the stages that make points, alone.
    pub fn record_points(&self) -> Result<Recorded> {
        let mut encoder = Encoder::new(&self.device, "points")?;
        self.stages.record(&mut encoder, &self.surface);
        Ok(encoder.finish()?)
    }

    /// Makes images and the passes that draw into them, and records a whole frame.
    pub fn images(&mut self, view: View, layers: bool, culling: Culling) -> Result<Images> {
        let desc = self.surface.desc();
        let options =
            DrawOptions { view, layers, cull_back: culling == Culling::UnseenAndBacks, emit: culling != Culling::Off };
        let start = Instant::now();
        let passes = DrawPasses::new(&self.device, desc, &options)?;
        self.pipelines_ms += milliseconds(start);
        let targets = Targets::new(&self.device, self.camera.size, options.needs_layers())?;
        let frame = self.record_frame(&passes, &targets, &self.camera)?;
        Ok(Images { targets, passes, frame })
    }

    /// Records a frame of its own for a camera that is the session's but for a fraction of a pixel.
    pub fn record_sample(&self, images: &Images, camera: &FrameCamera) -> Result<Recorded> {
        self.record_frame(&images.passes, &images.targets, camera)
    }

    fn record_frame(&self, passes: &DrawPasses, targets: &Targets, camera: &FrameCamera) -> Result<Recorded> {
        let mut encoder = Encoder::new(&self.device, "frame")?;
        self.stages.record(&mut encoder, &self.surface);
        passes.record(&mut encoder, &self.surface, &self.constants, camera, targets);
        Ok(encoder.finish()?)
    }

    /// Uploads the cage and runs what was recorded; the report and the wall time from upload to fence in milliseconds.
    pub fn run(&self, positions: &[[f32; 3]], frame: &Recorded) -> Result<(SubmitReport, f64)> {
        let start = Instant::now();
        self.surface.set_cage(positions)?;
        let report = self.device.submit_and_wait(frame)?;
        Ok((report, milliseconds(start)))
    }

    /// Patches of each level that the frame of `images` that ran last has drawn.
    pub fn drawn_counts(&self, images: &Images) -> Result<Vec<PatchCounts>> {
        if images.passes.has_emit() {
            return Ok(self.surface.download_visible_counts(&self.device)?);
        }
        Ok(self.surface.tables().counts.clone())
    }

    /// Number of triangles, by the rules of the tessellator.
    pub fn expected_triangle_count(&self) -> u64 {
        let desc = self.surface.desc();
        triangle_count(self.surface.tables(), &self.factors, desc.method, desc.spacing)
    }
}

/// What is left out of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Culling {
    /// Nothing.
    Off,
    /// Patches outside of the view.
    Unseen,
    /// These, and what shows its back.
    UnseenAndBacks,
}

impl Culling {
    /// Of a cage as a camera sees it.
    pub fn new(cage: &Cage, camera: &Camera, no_cull: bool) -> Self {
        match (no_cull, cage.hides_backs(camera)) {
            (true, _) => Self::Off,
            (false, false) => Self::Unseen,
            (false, true) => Self::UnseenAndBacks,
        }
    }
}

/// Images, and a frame recorded into them.
pub struct Images {
    /// The images.
    pub targets: Targets,
    passes: DrawPasses,
    /// Points and draws; can run any number of times.
    pub frame: Recorded,
}
