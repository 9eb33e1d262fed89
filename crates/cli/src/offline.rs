//! Device, surface and passes: what `render`, `dump` and `bench` share.

use std::time::Instant;

use anyhow::{Context, Result, bail};
use glam::{Affine3A, Mat4, Vec3};
use planish_gpu::{Calls, Device, Encoder, Recorded, SubmitReport};
use planish_render::density::{MAX_UNCUT_DENSITY, isolation_level, largest_density};
use planish_render::{
    Culling, Density, DrawOptions, DrawPasses, EndCap, FrameCamera, FrameNeeds, FrameOptions, FrameStages,
    GregoryPoints, Layers, ObjectDesc, Selection, Spacing, Status, Surface, SurfaceDesc, SurfaceMethod, TableNormals,
    TableWeights, Targets, View, preprocess_cached,
};
use planish_scene::{Camera, Lens, Pose};
use planish_subdiv::ControlMesh;
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisCache, BasisCounts};

use crate::args::{DeviceArguments, SurfaceArguments, ViewArguments};
use crate::cage::{Cage, milliseconds};
use crate::console::Console;
use crate::frames::FrameRange;
use crate::moment::{Moment, deform_surface};
use crate::names::{GregoryNormalsName, LodName};
use crate::shading::FrameParts;
use crate::stats::method_name;
use crate::values::FrameRate;

/// What a plan is made for.
pub struct PlanSetting {
    pub method: SurfaceMethod,
    pub scheme: Scheme,
    pub table_normals: TableNormals,
    pub table_weights: TableWeights,
    /// No irregularity is isolated deeper.
    pub max_level: u32,
    pub crease_patches: CreasePatches,
    pub end_cap: EndCap,
    pub spacing: Spacing,
    /// Size of the image in pixels.
    pub size: [u32; 2],
    /// Seams have the same bits on both sides.
    pub watertight: bool,
    /// How control points of Gregory patches are made.
    pub gregory_points: GregoryPoints,
    /// Gregory patches have the normals of the rational patch.
    pub exact_normals: bool,
    pub options: FrameOptions,
}

/// How a cage is to be evaluated and seen: all that is decided before a device is needed.
pub struct Plan {
    /// The same, as the passes want it.
    pub frame_camera: FrameCamera,
    /// The scene's instances, as the camera sees them.
    pub objects: Vec<ObjectDesc>,
    /// What the surface is made as.
    pub desc: SurfaceDesc,
    /// What its frames may need.
    pub needs: FrameNeeds,
    /// How frames are selected and culled.
    pub options: FrameOptions,
}

impl Plan {
    /// Decides for a cage that is to be seen, in all frames of a range. `offsets`: when in each frame it is, in frames from the frame's
    /// own time, which is the first of them.
    pub fn new(
        cage: &Cage,
        surface: &SurfaceArguments,
        view: &ViewArguments,
        rate: FrameRate,
        range: FrameRange,
        offsets: &[f64],
    ) -> Result<Self> {
        let moment = |frames: f64| Moment::new(cage, view, rate, frames);
        let setting = Self::setting(surface, view)?;
        if cage.is_animated(view) {
            let moments = range.frames().flat_map(|frame| offsets.iter().map(move |offset| f64::from(frame) + offset));
            return Self::of(cage, &setting, moments.map(moment));
        }
        Self::of(cage, &setting, range.frames().take(1).map(|frame| moment(f64::from(frame))))
    }

    /// Decides for a cage that is not drawn: with a given tess factor there need not be a camera that sees it.
    pub fn unseen(
        cage: &Cage,
        surface: &SurfaceArguments,
        view: &ViewArguments,
        rate: FrameRate,
        range: FrameRange,
    ) -> Result<Self> {
        let first = f64::from(range.frames().next().unwrap_or_default());
        match (cage.camera(view, rate, first), surface.density()) {
            (Err(_), Density::Tess(_)) => {
                let nowhere = Camera::upright("none", Vec3::Z, Vec3::ZERO, 45.0, 1.0)?;
                let setting = Self::setting(surface, view)?;
                Self::of(cage, &setting, [Ok(Moment::seen_by(cage, &nowhere, rate.seconds(first)))])
            }
            _ => Self::new(cage, surface, view, rate, range, &[0.0]),
        }
    }

    fn setting(surface: &SurfaceArguments, view: &ViewArguments) -> Result<PlanSetting> {
        let method = surface.method();
        Ok(PlanSetting {
            method,
            scheme: surface.scheme()?,
            table_normals: surface.table_normals.into(),
            table_weights: surface.table_weights.into(),
            max_level: surface.max_level(),
            crease_patches: surface.crease_patches.into(),
            end_cap: surface.end_cap.into(),
            spacing: surface.spacing.into(),
            size: view.size,
            watertight: !surface.no_watertight,
            gregory_points: surface.gregory.into(),
            exact_normals: surface.gregory_normals == GregoryNormalsName::Exact,
            options: frame_options(method, surface.density(), surface.lod == LodName::Object),
        })
    }

    /// Decides for frames of these moments, of which there is one at least: deep enough for all of them, and no back is
    /// hidden that one of them sees.
    pub fn of(cage: &Cage, setting: &PlanSetting, moments: impl IntoIterator<Item = Result<Moment>>) -> Result<Self> {
        let mut first: Option<(Camera, Vec<ObjectDesc>)> = None;
        let (mut density, mut is_placed) = (0.0_f32, false);
        for moment in moments {
            let moment = moment?;
            let frame_camera = moment.frame_camera(setting.size);
            let meshes = moment.meshes(cage);
            let meshes: Vec<&ControlMesh> = meshes.iter().map(AsRef::as_ref).collect();
            density = density.max(largest_density(&meshes, &moment.objects, &frame_camera, &setting.options)?);
            is_placed |= moment.objects.iter().any(|object| object.to_world != Affine3A::IDENTITY);
            match &mut first {
                None => first = Some((moment.camera, moment.objects)),
                Some((_, objects)) => {
                    objects
                        .iter_mut()
                        .zip(&moment.objects)
                        .for_each(|(object, seen)| object.hides_backs &= seen.hides_backs);
                }
            }
        }
        let (camera, objects) = first.expect("a frame at least");
        let is_gregory = setting.method.is_one_patch_a_face();
        // Tables are over the cage subdivided once.
        let level =
            if is_gregory || setting.method.is_grid() { 0 } else { isolation_level(density, setting.max_level) };
        // Stencils are over the cage: end caps lie deeper.
        let gregory_points =
            if setting.method == SurfaceMethod::Gregory { setting.gregory_points } else { GregoryPoints::TwoStage };
        let desc = SurfaceDesc {
            method: setting.method,
            level,
            crease_patches: setting.crease_patches,
            end_cap: setting.end_cap,
            displaced: cage.is_displaced(),
            gregory_points,
            scheme: setting.scheme,
            table_normals: setting.table_normals,
            table_weights: setting.table_weights,
        };
        let needs = FrameNeeds {
            watertight: setting.watertight,
            displaced: cage.is_displaced(),
            tex_coords: cage.has_uv(),
            gregory: desc.has_gregory_patches(),
            rival: desc.method.rival(),
            filling: !is_gregory,
            gregory_points,
            exact_normals: setting.exact_normals,
            colors: cage.has_colors(),
            grids: desc.method.is_grid(),
            vertex_normals: desc.has_vertex_normals(),
            deforms: cage.deforms(),
            placed: is_placed,
            ..frame_needs(setting.spacing, density, &objects)
        };
        Ok(Self { frame_camera: frame_camera(&camera, setting.size), objects, desc, needs, options: setting.options })
    }

    /// What culling is left out of a frame.
    pub fn cull(&mut self, no_cull: bool) {
        self.needs.culls = !no_cull;
        self.options.culling = if no_cull { Culling::Off } else { Culling::UnseenAndBacks };
    }

    /// Whether no triangle that shows its back is seen.
    fn hides_backs(&self) -> bool {
        let hides = |object: &ObjectDesc| object.hides_backs && !object.is_mirrored();
        self.options.culling == Culling::UnseenAndBacks && self.objects.iter().all(hides)
    }
}

/// Refuses what tables do not have.
pub fn check_table(cage: &Cage, plan: &Plan) -> Result<()> {
    if plan.desc.method.is_grid() && cage.is_displaced() {
        bail!("method {} is not displaced: expected no displacement map", method_name(plan.desc.method));
    }
    Ok(())
}

/// Refuses what Gregory patches do not have, for surfaces that have some.
pub fn check_gregory(cage: &Cage, desc: &SurfaceDesc) -> Result<()> {
    if !desc.has_gregory_patches() {
        return Ok(());
    }
    if !desc.method.is_one_patch_a_face() && cage.is_displaced() {
        bail!("Gregory patches as end caps are not displaced: expected no displacement map");
    }
    if desc.crease_patches == CreasePatches::Single {
        bail!("Gregory patches have no closed form of semi-sharp creases: expected --crease-patches infinite or none");
    }
    Ok(())
}

/// Refuses what motion is not known of.
fn check_motion(cage: &Cage, plan: &Plan) -> Result<()> {
    if plan.needs.moves && cage.deforms() && plan.desc.has_gregory_patches() {
        bail!(
            "motion of meshes that deform is not known on Gregory patches: expected method dfas, fas, table or uniform"
        );
    }
    if plan.needs.moves && cage.deforms() && plan.desc.method.is_substitute() {
        bail!("motion of meshes that deform is not known on substitutes: expected method dfas, fas, table or uniform");
    }
    if plan.needs.moves && cage.displaces_what_deforms() {
        bail!("motion of meshes that deform is that of the limit surface: expected no displacement map");
    }
    Ok(())
}

/// What frames of about this density need; nothing is culled, and seams are watertight. Twice as dense a frame, of a cage that moves, has all it needs.
pub fn frame_needs(spacing: Spacing, density: f32, objects: &[ObjectDesc]) -> FrameNeeds {
    let placed = objects.iter().any(|object| object.to_world != Affine3A::IDENTITY);
    FrameNeeds { culls: false, placed, cuts: 2.0 * density > MAX_UNCUT_DENSITY, ..FrameNeeds::all(spacing) }
}

/// How a method selects; nothing is culled.
pub fn frame_options(method: SurfaceMethod, density: Density, object_lod: bool) -> FrameOptions {
    let selection = if method == SurfaceMethod::Fas { Selection::Static } else { Selection::Dynamic };
    FrameOptions { density, selection, culling: Culling::Off, object_lod }
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

/// A scene on a device, ready for frames.
pub struct Session {
    pub device: Device,
    pub surface: Surface,
    pub camera: FrameCamera,
    pub options: FrameOptions,
    /// Where tables of configurations came from, of method table.
    pub basis_counts: BasisCounts,
    needs: FrameNeeds,
    hides_backs: bool,
    stages: FrameStages,
    moment: Option<Moment>,
    next: Option<(Moment, FrameCamera)>,
    /// How long making pipelines took, in milliseconds.
    pub pipelines_ms: f64,
}

impl Session {
    /// Builds the scene's tables, as far as the cache does not have them, and uploads them.
    pub fn new(device: &Device, cage: &Cage, plan: &Plan, cache: &dyn BasisCache, console: &Console) -> Result<Self> {
        let named = || cage.path().display().to_string();
        if plan.desc.method == SurfaceMethod::Uniform && (plan.objects.len() != 1 || plan.needs.placed) {
            bail!("{}: method uniform draws one mesh where it is: expected no instances", named());
        }
        if plan.desc.method == SurfaceMethod::Uniform && cage.is_displaced() {
            bail!("{}: method uniform draws the limit surface: expected no displacement map", named());
        }
        check_gregory(cage, &plan.desc).with_context(named)?;
        check_table(cage, plan).with_context(named)?;
        if cage.has_uv() && !plan.desc.has_tex_coords() {
            console
                .warn(format_args!("{}: texture coordinates are those of Catmull-Clark's scheme: left out", named()));
        }
        check_motion(cage, plan).with_context(named)?;
        let made = preprocess_cached(&cage.meshes(), &plan.desc, cache).with_context(named)?;
        let basis_counts = made.basis_counts;
        let mut surface = Surface::new(device, &cage.meshes(), &plan.objects, plan.desc, made).with_context(named)?;
        cage.displace_surface(device, &mut surface)?;
        deform_surface(device, &mut surface, cage, plan.needs.moves)?;
        let start = Instant::now();
        let stages = FrameStages::new(device, &plan.needs)?;
        let pipelines_ms = milliseconds(start);
        console.explain(format_args!(
            "{} objects, irregularities isolated to level {} at most",
            plan.objects.len(),
            surface.tables().last_level,
        ));
        if basis_counts != BasisCounts::default() {
            let BasisCounts { read, built } = basis_counts;
            console.explain(format_args!("tables of {read} configurations read from the cache, {built} built"));
        }
        Ok(Self {
            device: device.clone(),
            surface,
            camera: plan.frame_camera,
            options: plan.options,
            basis_counts,
            needs: plan.needs,
            hides_backs: plan.hides_backs(),
            stages,
            moment: None,
            next: None,
            pipelines_ms,
        })
    }

    /// Says when all frames from now on are, and where their motion leads to.
    pub fn set_moment(&mut self, moment: Moment, next: Option<Moment>) {
        self.camera = moment.frame_camera(self.camera.size);
        let next_camera = |next: Moment| {
            let camera = next.frame_camera(self.camera.size);
            (next, camera)
        };
        self.next = next.map(next_camera);
        self.moment = Some(moment);
    }

    /// The pose that frames have.
    pub fn pose(&self) -> Option<&Pose> {
        self.moment.as_ref().map(|moment| &moment.pose)
    }

    /// The lens of the moment's camera.
    pub fn camera_lens(&self) -> Option<Lens> {
        self.moment.as_ref().and_then(|moment| moment.camera.lens)
    }

    /// Records the stages before drawing, alone.
    fn record_stages(&self) -> Result<Recorded> {
        let mut encoder = Encoder::new(&self.device, "stages")?;
        self.stages.record(&mut encoder, &self.surface);
        FrameStages::record_end(&mut encoder, &self.surface);
        Ok(encoder.finish()?)
    }

    /// Makes images and the passes that draw into them.
    pub fn images(&mut self, view: View, layers: Layers) -> Result<Images> {
        let options = DrawOptions { view, layers, cull_back: self.hides_backs };
        let start = Instant::now();
        let passes = DrawPasses::new(&self.device, self.surface.desc(), &self.needs, &options)?;
        self.pipelines_ms += milliseconds(start);
        let targets = Targets::new(&self.device, self.camera.size, options.needed_layers())?;
        Ok(Images { targets, passes })
    }

    /// What shadow maps are drawn with: the cages of these positions, at the moment that was set.
    pub fn parts(&mut self, cages: &[&[[f32; 3]]]) -> Result<FrameParts<'_>> {
        self.set_cages(cages)?;
        Ok(FrameParts {
            device: &self.device,
            surface: &mut self.surface,
            stages: &self.stages,
            options: &self.options,
        })
    }

    fn set_cages(&mut self, cages: &[&[[f32; 3]]]) -> Result<()> {
        for (mesh, positions) in cages.iter().enumerate() {
            self.surface.set_cage(mesh, positions)?;
        }
        if let Some(moment) = &self.moment {
            moment.apply(&mut self.surface, self.next.as_ref().map(|(next, camera)| (next, camera)))?;
        }
        Ok(())
    }

    fn record_frame(&self, images: &Images, camera: &FrameCamera) -> Result<Recorded> {
        let mut encoder = Encoder::new(&self.device, "frame")?;
        self.stages.record(&mut encoder, &self.surface);
        images.passes.record(&mut encoder, &self.surface, camera, &images.targets);
        FrameStages::record_end(&mut encoder, &self.surface);
        Ok(encoder.finish()?)
    }

    /// Draws a frame of cages at these positions; again, with more room, while a list overflows.
    pub fn draw(&mut self, images: &Images, camera: &FrameCamera, cages: &[&[[f32; 3]]]) -> Result<Drawn> {
        self.run(cages, camera, |session| session.record_frame(images, camera))
    }

    /// Runs the stages before drawing, alone.
    pub fn make_lists(&mut self, cages: &[&[[f32; 3]]]) -> Result<Drawn> {
        let camera = self.camera;
        self.run(cages, &camera, Self::record_stages)
    }

    fn run(
        &mut self,
        cages: &[&[[f32; 3]]],
        camera: &FrameCamera,
        record: impl Fn(&Self) -> Result<Recorded>,
    ) -> Result<Drawn> {
        loop {
            let frame = record(self)?;
            let start = Instant::now();
            self.set_cages(cages)?;
            self.surface.set_frame(camera, &self.options)?;
            let report = self.device.submit_and_wait(&frame)?;
            let wall_ms = milliseconds(start);
            let status = self.surface.status()?;
            if !self.surface.grow(&self.device)? {
                return Ok(Drawn { report, wall_ms, status, calls: frame.calls() });
            }
        }
    }
}

/// A frame that was drawn.
pub struct Drawn {
    /// Times and counts of the device.
    pub report: SubmitReport,
    /// From cage upload to fence, in milliseconds.
    pub wall_ms: f64,
    /// What the frame left in its lists.
    pub status: Status,
    /// Dispatches and draws that were recorded.
    pub calls: Calls,
}

/// Images, and the passes that draw into them.
pub struct Images {
    /// The images.
    pub targets: Targets,
    passes: DrawPasses,
}
