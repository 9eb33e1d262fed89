//! A device with the programs of all spacings.

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use planish_gpu::{
    Buffer, BufferDesc, BufferKind, Device, DeviceOptions, Encoder, Image, Instance, PipelineStatistics,
};
use planish_render::emit::Emitted;
use planish_render::{
    CapturedVertex, DrawOptions, DrawPasses, DumpPasses, FrameCamera, FrameNeeds, FrameOptions, FrameStages, Layers,
    PatchKind, Spacing, Status, Surface, SurfaceDesc, Targets, View,
};
use planish_shaders::LimitPoint;
use planish_subdiv::gregory::Rival;

/// All spacings.
pub const SPACINGS: [Spacing; 3] = [Spacing::Equal, Spacing::FractionalOdd, Spacing::FractionalEven];

/// One device at a time: the software driver has all cores at work for one already, and several of its devices in one process,
/// each with its own validation, have been seen to corrupt the heap now and then.
static TURN: Mutex<()> = Mutex::new(());

/// Waits until it is this test's turn to have a device. A test that failed leaves nothing behind that the next one minds.
pub fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps the driver loaded while the process lives: a hardware driver that was loaded for every device anew has been seen to be refused
/// after some dozens of times. Why is not known.
static DRIVER: OnceLock<Instance> = OnceLock::new();

/// A device with the validation layer.
pub fn device() -> Device {
    DRIVER.get_or_init(|| Instance::new(false).expect("a Vulkan driver"));
    let options = DeviceOptions { validation: true, selector: None, memory_budget: None };
    Device::open(&options).expect("a Vulkan device with the validation layer")
}

/// A device, and the stages of each spacing.
pub struct Lab {
    pub device: Device,
    needs: [FrameNeeds; 3],
    stages: [FrameStages; 3],
    // Given back last.
    _turn: MutexGuard<'static, ()>,
}

impl Lab {
    /// For limit surfaces.
    pub fn new() -> Self {
        Self::with_needs(FrameNeeds::all)
    }

    /// For displaced surfaces.
    pub fn displaced() -> Self {
        Self::with_needs(|spacing| FrameNeeds { displaced: true, ..FrameNeeds::all(spacing) })
    }

    /// For Gregory patches.
    pub fn gregory() -> Self {
        Self::with_needs(|spacing| FrameNeeds { gregory: true, ..FrameNeeds::all(spacing) })
    }

    /// For patches of another scheme.
    pub fn of_rival(rival: Rival) -> Self {
        Self::with_needs(|spacing| FrameNeeds { gregory: true, rival: Some(rival), ..FrameNeeds::all(spacing) })
    }

    /// For displaced Gregory patches.
    pub fn displaced_gregory() -> Self {
        Self::with_needs(|spacing| FrameNeeds { gregory: true, displaced: true, ..FrameNeeds::all(spacing) })
    }

    pub fn with_needs(of: impl Fn(Spacing) -> FrameNeeds) -> Self {
        let turn = turn();
        let device = device();
        let needs = SPACINGS.map(of);
        let stages = needs.map(|needs| FrameStages::new(&device, &needs).expect("pipelines"));
        Self { device, needs, stages, _turn: turn }
    }

    /// Whether quotients and roots are rounded as the CPU rounds them. Vulkan asks that of sums and products alone; hardware may be a few
    /// last places off in what is divided or has a length taken of it, as densities and normals.
    pub fn is_exact(&self) -> bool {
        self.device.is_software()
    }

    /// Asserts that limit points and their normals are their twins: positions, which are sums and products, to the bit.
    pub fn assert_limits(&self, made: &[LimitPoint], expected: &[LimitPoint], named: &str) {
        assert_eq!(made.len(), expected.len(), "{named}");
        for (place, (made, expected)) in made.iter().zip(expected).enumerate() {
            assert_eq!(made.position, expected.position, "{named}: limit point {place}");
            self.assert_normal(made.normal, expected.normal, named);
        }
    }

    /// Asserts that a normal is its twin.
    pub fn assert_normal(&self, made: [f32; 3], expected: [f32; 3], named: &str) {
        let is_near = |c: usize| (made[c] - expected[c]).abs() <= 4.0 * f32::EPSILON;
        let is_same = made == expected || !self.is_exact() && (0..3).all(is_near);
        assert!(is_same, "{named}: normal {made:?}, of its twin {expected:?}");
    }

    /// What its frames may need.
    pub fn needs(&self, spacing: Spacing) -> &FrameNeeds {
        &self.needs[spacing.constant() as usize]
    }

    fn stages(&self, spacing: Spacing) -> &FrameStages {
        &self.stages[spacing.constant() as usize]
    }

    /// Runs the stages before drawing, once, with the lists as large as they are.
    pub fn run_once(
        &self,
        surface: &Surface,
        spacing: Spacing,
        camera: &FrameCamera,
        options: &FrameOptions,
    ) -> Status {
        surface.set_frame(camera, options).expect("a frame");
        let mut encoder = Encoder::new(&self.device, "stages").expect("encoder");
        self.stages(spacing).record(&mut encoder, surface);
        FrameStages::record_end(&mut encoder, surface);
        self.device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
        surface.status().expect("status")
    }

    /// Runs the stages until the lists have room.
    pub fn run(&self, surface: &mut Surface, spacing: Spacing, camera: &FrameCamera, options: &FrameOptions) -> Status {
        loop {
            let status = self.run_once(surface, spacing, camera, options);
            if !surface.grow(&self.device).expect("room") {
                return status;
            }
        }
    }

    /// Draws a frame, once.
    pub fn draw_once(
        &self,
        surface: &Surface,
        easel: &Easel,
        camera: &FrameCamera,
        options: &FrameOptions,
    ) -> PipelineStatistics {
        surface.set_frame(camera, options).expect("a frame");
        let mut encoder = Encoder::new(&self.device, "frame").expect("encoder");
        self.stages(easel.spacing).record(&mut encoder, surface);
        easel.passes.record(&mut encoder, surface, camera, &easel.targets);
        FrameStages::record_end(&mut encoder, surface);
        let report = self.device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
        report.statistics[0].1
    }

    /// Draws a frame, until the lists have room.
    pub fn draw(
        &self,
        surface: &mut Surface,
        easel: &Easel,
        camera: &FrameCamera,
        options: &FrameOptions,
    ) -> Vec<Vec<u32>> {
        loop {
            let statistics = self.draw_once(surface, easel, camera, options);
            if !surface.grow(&self.device).expect("room") {
                let entries = entry_count(&surface.status().expect("status"));
                let is_tessellated = surface.desc().method != planish_render::SurfaceMethod::Uniform;
                assert!(
                    !is_tessellated || statistics.tessellation_control_patches == entries,
                    "not every entry was drawn once"
                );
                return easel.words(&self.device);
            }
        }
    }

    /// Entries of each kind that the last frame listed, in ascending order.
    pub fn entries(&self, surface: &Surface) -> Emitted {
        self.unsorted_entries(surface).map(|mut entries| {
            entries.sort_by_key(|entry| (entry.object, entry.place, entry.flags));
            entries
        })
    }

    /// Entries of each kind that the last frame listed, in their order.
    pub fn unsorted_entries(&self, surface: &Surface) -> Emitted {
        surface.status().expect("status").draw_heads.map(|head| {
            let range = head.first..head.first + head.count.min(head.capacity);
            surface.download_entries(&self.device, range).expect("entries")
        })
    }

    pub fn dump_passes(&self, desc: &SurfaceDesc, spacing: Spacing) -> DumpPasses {
        DumpPasses::new(&self.device, desc, self.needs(spacing)).expect("pipelines")
    }

    /// The triangles of what the last frame listed, three vertices each.
    pub fn dump(&self, surface: &Surface, passes: &DumpPasses) -> Vec<CapturedVertex> {
        let mut vertices = Vec::new();
        let captured = passes.capture(&self.device, surface, |part| {
            vertices.extend_from_slice(part);
            Ok::<_, planish_render::Error>(())
        });
        captured.expect("capture");
        vertices
    }

    pub fn assert_silent(&self) {
        assert_eq!(self.device.validation_messages(), Vec::<String>::new());
    }
}

/// Number of patches that are drawn.
pub fn entry_count(status: &Status) -> u64 {
    PatchKind::ALL.iter().map(|&kind| u64::from(status.draw_heads[kind as usize].count)).sum()
}

/// Images with all layers, and the passes that draw into them.
pub struct Easel {
    pub spacing: Spacing,
    passes: DrawPasses,
    targets: Targets,
}

impl Easel {
    pub fn new(lab: &Lab, spacing: Spacing, cull_back: bool, size: [u32; 2]) -> Self {
        Self::with_desc(lab, &SurfaceDesc::default(), spacing, cull_back, size)
    }

    /// For surfaces that are made so.
    pub fn with_desc(lab: &Lab, desc: &SurfaceDesc, spacing: Spacing, cull_back: bool, size: [u32; 2]) -> Self {
        Self::of(lab, desc, spacing, size, &DrawOptions { view: View::Shaded, layers: Layers::Geometry, cull_back })
    }

    /// With these layers.
    pub fn with_layers(lab: &Lab, desc: &SurfaceDesc, spacing: Spacing, size: [u32; 2], layers: Layers) -> Self {
        Self::of(lab, desc, spacing, size, &DrawOptions { view: View::Shaded, layers, cull_back: false })
    }

    fn of(lab: &Lab, desc: &SurfaceDesc, spacing: Spacing, size: [u32; 2], options: &DrawOptions) -> Self {
        Self {
            spacing,
            passes: DrawPasses::new(&lab.device, desc, lab.needs(spacing), options).expect("pipelines"),
            targets: Targets::new(&lab.device, size, options.layers).expect("images"),
        }
    }

    /// Everything that the images hold.
    pub fn words(&self, device: &Device) -> Vec<Vec<u32>> {
        std::iter::once(self.targets.color()).chain(self.targets.layers()).map(|image| words(device, image)).collect()
    }
}

fn words(device: &Device, image: &Image) -> Vec<u32> {
    let desc = BufferDesc { name: "image", kind: BufferKind::Readback, size: image.copy_size() };
    let buffer = Buffer::new(device, &desc).expect("a buffer");
    let mut encoder = Encoder::new(device, "read-back").expect("encoder");
    encoder.copy_image_to_buffer(image, &buffer, 0);
    device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
    buffer.read(0, (image.copy_size() / 4) as usize).expect("pixels")
}
