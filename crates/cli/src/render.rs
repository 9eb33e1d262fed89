//! `planish render`: frames to EXR and PNG.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use planish_film::{
    Cryptomatte, ExrOptions, Film, FilmWriter, ImageFormat, Layer, Metadata, PngOptions, Target, Window, WriteOptions,
    check_image_output, is_complete, remove_stale_files,
};
use planish_gpu::Device;
use planish_render::{FrameCamera, Layers, View};
use planish_scene::{Camera, Lens};

use crate::aov::{Aov, drawn_layers};
use crate::args::RenderArguments;
use crate::cage::{Cage, milliseconds};
use crate::console::{Console, WrongUsage, error_text};
use crate::frames::{FrameRange, frame_path, has_placeholder};
use crate::image::{ColorSum, Crop, read_layers};
use crate::interrupt;
use crate::mattes::{material_matte, object_matte};
use crate::moment::Moment;
use crate::offline::{Drawn, Images, Plan, Session, aspect, check_validation, open_device};
use crate::progress::Progress;
use crate::sampling::{PixelFilter, Sample, samples};
use crate::shading::{self, SceneShading};
use crate::split::Split;
use crate::stats::{FrameStats, GpuStats, Stats, StatsOutput};
use crate::table_cache::TableCache;
use crate::values::FrameRate;

/// Runs the command.
pub fn run(arguments: &RenderArguments, console: &Console) -> Result<()> {
    let mut cage = Cage::load(&arguments.scene, console)?;
    cage.displace(&arguments.displacement, console)?;
    cage.light(&arguments.light)?;
    let rate = cage.frame_rate(arguments.frames.fps);
    let range = cage.frame_range(arguments.frames.frames, rate);
    check_outputs(arguments, range, console)?;
    let crop = Crop::new(arguments.crop, arguments.view.size)?;
    let stats_output = StatsOutput(arguments.frames.stats.as_ref());
    stats_output.check(arguments.outputs.iter().map(PathBuf::as_path))?;
    interrupt::listen()?;
    let (device, mut renderer) = Renderer::open(arguments, &cage, rate, range, crop, console)?;
    let done = renderer.frames(range);
    console.end_progress();
    let stats = Stats::new(&cage, &renderer.session, renderer.image_bytes(), renderer.frames.clone());
    stats_output.write(&Stats { split_ms: Some(renderer.split), ..stats })?;
    console.explain(format_args!("{}", renderer.split));
    done?;
    check_validation(&device)
}

/// Finds out before any work whether the images can be written.
fn check_outputs(arguments: &RenderArguments, range: FrameRange, console: &Console) -> Result<()> {
    let mut has_exr = false;
    for output in &arguments.outputs {
        check_placeholder(output, range)?;
        let first = range.frames().next().unwrap_or_default();
        has_exr |= check_image_output(&frame_path(output, first))? == ImageFormat::Exr;
        remove_stale_files(output);
    }
    if !arguments.aov.aovs().is_empty() && !has_exr {
        console.warn("--aov has no effect: only EXR files have layers");
    }
    Ok(())
}

/// Several frames need several files.
pub fn check_placeholder(output: &Path, range: FrameRange) -> Result<()> {
    if range.count() > 1 && !has_placeholder(output) {
        bail!("{}: {} frames need a name with #### where the number goes", output.display(), range.count());
    }
    Ok(())
}

/// How files are written.
fn write_options(arguments: &RenderArguments) -> WriteOptions {
    let output = &arguments.output;
    WriteOptions {
        exr: ExrOptions { compression: output.compression, multipart: output.multipart },
        png: PngOptions { tone_map: output.tone_map, exposure: output.exposure },
    }
}

/// Images that are shaded as they are drawn, with layers, and the sum of their samples.
struct Plain {
    images: Images,
    /// None where a scene is shaded: these are its layers then.
    sum: Option<ColorSum>,
}

/// What is drawn for shading, and what shades it.
struct Shaded {
    images: Images,
    shading: SceneShading,
}

/// Everything that a run of frames needs.
struct Renderer<'a> {
    arguments: &'a RenderArguments,
    console: &'a Console,
    cage: &'a Cage,
    rate: FrameRate,
    crop: Crop,
    aovs: &'a [Aov],
    samples: Vec<Sample>,
    /// When the shutter opens and closes, in frames from the frame's own; none: everything stands still.
    shutter: Option<[f64; 2]>,
    session: Session,
    /// What is drawn without shading, and with layers: none of a scene that is shaded and has no layers.
    plain: Option<Plain>,
    /// What a scene with materials or light is shaded with.
    shaded: Option<Shaded>,
    frames: Vec<FrameStats>,
    /// What could not be made or written of a run that goes on.
    failed_count: u64,
    split: Split,
}

impl<'a> Renderer<'a> {
    fn open(
        arguments: &'a RenderArguments,
        cage: &'a Cage,
        rate: FrameRate,
        range: FrameRange,
        crop: Crop,
        console: &'a Console,
    ) -> Result<(Device, Self)> {
        let aovs = arguments.aov.aovs();
        let shutter = shutter(arguments, cage, rate, range)?;
        let offsets = offsets(shutter, aovs);
        let mut plan = Plan::new(cage, &arguments.surface, &arguments.view, rate, range, &offsets)?;
        plan.cull(arguments.frames.no_cull);
        plan.needs.moves = aovs.contains(&Aov::Motion);
        let has_mattes = aovs.iter().any(|aov| aov.is_matte());
        let is_shaded = View::from(arguments.shown) == View::Shaded && (has_mattes || shading::is_shaded(cage.scene()));
        if has_mattes && !is_shaded {
            return Err(WrongUsage("Cryptomattes are made with --view shaded alone".to_owned()).into());
        }
        if is_shaded {
            shading::add_needs(cage.scene(), &mut plan.needs);
        }
        let device = open_device(&arguments.device, console)?;
        let cache = TableCache::new(arguments.surface.table_cache.as_deref(), console);
        let mut session = Session::new(&device, cage, &plan, &cache, console)?;
        session.surface.set_crop(crop.part());
        let layers = drawn_layers(aovs);
        let plain = if is_shaded && layers == Layers::None {
            None
        } else {
            let images = session.images(arguments.shown.into(), layers)?;
            if images.targets.has_vertex_colors() && !is_shaded {
                shading::set_channels(&device, &mut session.surface, cage.scene())?;
            }
            let count = arguments.samples as usize;
            let sum = if is_shaded { None } else { Some(ColorSum::new(&device, &images.targets, count)?) };
            Some(Plain { images, sum })
        };
        let shaded = if is_shaded {
            let images = session.images(View::Shaded, shading::LAYERS)?;
            let (scene, size, map_size) = (cage.scene(), arguments.view.size, arguments.light.shadow_map_size);
            let named = || cage.path().display().to_string();
            let shading =
                SceneShading::new(&device, &mut session.surface, scene, &plan.needs, size, has_mattes, map_size);
            Some(Shaded { images, shading: shading.with_context(named)? })
        } else {
            None
        };
        let filter = PixelFilter::from(arguments.sampling.filter);
        let width = arguments.sampling.filter_width.unwrap_or_else(|| filter.default_width());
        let samples = samples(arguments.samples, filter, width);
        let renderer = Self {
            arguments,
            console,
            cage,
            rate,
            crop,
            aovs,
            samples,
            shutter,
            session,
            plain,
            shaded,
            frames: Vec::new(),
            failed_count: 0,
            split: Split::default(),
        };
        Ok((device, renderer))
    }

    /// Renders and writes them all, or until Ctrl-C.
    fn frames(&mut self, range: FrameRange) -> Result<()> {
        let start = Instant::now();
        let mut writer = FilmWriter::new()?;
        let rendered = self.render_all(range, &mut writer);
        let finished = writer.finish();
        let report = writer.report();
        self.split.write = report.busy.as_secs_f64() * 1e3;
        self.split.write_waited = report.waited.as_secs_f64() * 1e3;
        self.split.wall = milliseconds(start);
        rendered?;
        let errors: Vec<_> = finished.err().into_iter().chain(writer.take_errors()).collect();
        errors.into_iter().try_for_each(|error| self.go_on(error.into()))?;
        if self.failed_count > 0 {
            bail!("{} of {} frames failed", self.failed_count, range.count());
        }
        if interrupt::is_requested() {
            bail!("interrupted after {} files", report.file_count);
        }
        Ok(())
    }

    /// Counts and tells what failed where the run goes on nevertheless; else gives it back.
    fn go_on(&mut self, error: anyhow::Error) -> Result<()> {
        if !self.arguments.continue_on_error {
            return Err(error);
        }
        self.failed_count += 1;
        self.console.warn(error_text(&error));
        Ok(())
    }

    /// Renders them.
    fn render_all(&mut self, range: FrameRange, writer: &mut FilmWriter) -> Result<()> {
        let options = write_options(self.arguments);
        let mut progress = Progress::new(self.console, range.count());
        for frame in range.frames() {
            let paths = self.arguments.outputs.iter().map(|output| frame_path(output, frame));
            let targets: Vec<Target> = paths.map(|path| Target { path, options }).collect();
            if self.arguments.skip_existing && targets.iter().all(|target| is_complete(&target.path)) {
                self.console.explain(format_args!("frame {frame} is there"));
                progress.frame_done(false);
                continue;
            }
            match self.frame(frame, &progress).with_context(|| format!("frame {frame}")) {
                Ok(None) => break,
                Ok(Some(film)) => {
                    let told: Vec<String> = targets.iter().map(|target| target.path.display().to_string()).collect();
                    // What this tells of is an earlier film, with its path.
                    writer.write(film, targets).or_else(|error| self.go_on(error.into()))?;
                    told.iter().for_each(|path| self.console.explain(format_args!("writing {path}")));
                }
                Err(error) => self.go_on(error)?,
            }
            progress.patches = self.frames.last().map_or(0, |frame| frame.patches_by_level.iter().sum());
            progress.frame_done(true);
        }
        Ok(())
    }

    /// Renders a frame; none if Ctrl-C was pressed meanwhile.
    fn frame(&mut self, frame: i32, progress: &Progress<'_>) -> Result<Option<Film>> {
        progress.show(frame, 0, self.arguments.samples);
        let camera = self.set_frame(frame)?;
        self.timed_frames(frame)?;
        let read = Instant::now();
        let layers = self.layers()?;
        // A single sample is what was just drawn.
        let is_done = self.samples.len() == 1 && self.shaded.is_none();
        if let Some(Plain { sum: Some(sum), .. }) = &mut self.plain {
            sum.begin(&self.session.device)?;
            if is_done {
                sum.add(&self.session.device)?;
            }
        }
        self.split.read_back += milliseconds(read);
        if let Some(Shaded { shading, .. }) = &self.shaded {
            shading.begin(&self.session.device)?;
        }
        for (done, sample) in (0..).zip(self.samples.clone()).filter(|_| !is_done) {
            if interrupt::is_requested() {
                return Ok(None);
            }
            progress.show(frame, done, self.arguments.samples);
            self.sample(frame, done, &sample)?;
        }
        let (color, cryptomattes) = self.finish()?;
        let [width, height] = self.crop.size();
        let window = self.crop.part().map(|[x, y, _, _]| Window {
            x: x.cast_signed(),
            y: y.cast_signed(),
            full_width: self.arguments.view.size[0],
            full_height: self.arguments.view.size[1],
        });
        let metadata = self.metadata(&camera, frame);
        Ok(Some(Film { width, height, window, color, layers, cryptomattes, metadata }))
    }

    /// The layers of what was drawn last.
    fn layers(&self) -> Result<Vec<Layer>> {
        let Some(Plain { images, .. }) = self.plain.as_ref().filter(|_| !self.aovs.is_empty()) else {
            return Ok(Vec::new());
        };
        let mut packed = read_layers(&self.session.device, &images.targets, &self.crop)?;
        packed.first_faces = self.session.surface.objects().iter().map(|object| object.first_face).collect();
        Ok(self.aovs.iter().filter_map(|&aov| packed.layer(aov)).collect())
    }

    /// The mean of the samples, and what they covered.
    fn finish(&mut self) -> Result<(Vec<[f32; 4]>, Vec<Cryptomatte>)> {
        let read = Instant::now();
        let Some(Shaded { shading, .. }) = &self.shaded else {
            let sum = self.plain.as_ref().and_then(|plain| plain.sum.as_ref());
            let mean = sum.map_or_else(|| Ok(Vec::new()), |sum| sum.mean(&self.session.device))?;
            self.split.read_back += milliseconds(read);
            return Ok((self.crop.pixels(&mean), Vec::new()));
        };
        let shaded = shading.finish(&self.session.device, self.samples.len() as u32)?;
        let (scene, crop) = (self.cage.scene(), &self.crop);
        let matte = |&aov: &Aov| match aov {
            Aov::CryptoObject => Some(object_matte(scene, &shaded.objects, crop)),
            Aov::CryptoMaterial => Some(material_matte(scene, &shaded.materials, crop)),
            _ => None,
        };
        let mattes = self.aovs.iter().filter_map(matte).collect();
        self.split.read_back += milliseconds(read);
        Ok((crop.pixels(&shaded.color), mattes))
    }

    /// Puts the scene where it is in a frame; returns what sees it.
    fn set_frame(&mut self, frame: i32) -> Result<Camera> {
        let moment = self.moment(f64::from(frame))?;
        let next = if self.aovs.contains(&Aov::Motion) { Some(self.moment(f64::from(frame) + 1.0)?) } else { None };
        let camera = moment.camera.clone();
        self.session.set_moment(moment, next);
        Ok(camera)
    }

    fn moment(&mut self, frames: f64) -> Result<Moment> {
        let moment = Moment::new(self.cage, &self.arguments.view, self.rate, frames)?;
        self.split.animate += moment.milliseconds;
        Ok(moment)
    }

    /// Draws a frame as often as it is to be timed, with a sample at the centre of every pixel.
    fn timed_frames(&mut self, frame: i32) -> Result<()> {
        let camera = self.session.camera;
        if self.arguments.frames.repeat.is_some() && self.frames.is_empty() {
            self.draw(&camera)?;
        }
        for _ in 0..self.arguments.frames.repeat.unwrap_or(1) {
            let drawn = self.draw(&camera)?;
            let stats = FrameStats::drawn(frame, &self.session, &drawn);
            self.split.add(&stats.gpu_ms);
            self.frames.push(stats);
        }
        Ok(())
    }

    /// Draws a frame, with layers where there are any.
    fn draw(&mut self, camera: &FrameCamera) -> Result<Drawn> {
        let plain = self.plain.as_ref().map(|plain| &plain.images);
        let images = plain.or_else(|| self.shaded.as_ref().map(|shaded| &shaded.images)).expect("images");
        self.session.draw(images, camera, &self.cage.positions())
    }

    /// Draws one sample of all pixels, and adds it to the image.
    fn sample(&mut self, frame: i32, number: u32, sample: &Sample) -> Result<()> {
        if let Some([open, close]) = self.shutter {
            let moment = self.moment(f64::from(frame) + open + sample.time * (close - open))?;
            self.session.set_moment(moment, None);
        }
        let mut camera = self.session.camera;
        let lens = self.session.camera_lens().filter(|_| !self.arguments.sampling.no_depth_of_field);
        if let Some(Lens { radius, focus_distance }) = lens {
            camera = camera.through_lens(radius * sample.lens, focus_distance);
        }
        let camera = camera.jittered(sample.pixel);
        let (cages, scene) = (self.cage.positions(), self.cage.scene());
        if let Some(Shaded { images, shading }) = &mut self.shaded {
            let start = Instant::now();
            let pose = self.session.pose().cloned().unwrap_or_default();
            let which = (number, self.samples.len() as u32);
            shading.draw_shadow_maps(&mut self.session.parts(&cages)?, scene, &pose, which, self.shutter.is_some())?;
            self.split.shade += milliseconds(start);
            let drawn = self.session.draw(images, &camera, &cages)?;
            self.split.add(&GpuStats::new(&drawn.report.timestamps));
            let start = Instant::now();
            shading.shade(&self.session.device, &images.targets, &camera, number)?;
            self.split.shade += milliseconds(start);
        } else if let Some(Plain { images, sum: Some(sum) }) = &mut self.plain {
            let drawn = self.session.draw(images, &camera, &cages)?;
            self.split.add(&GpuStats::new(&drawn.report.timestamps));
            let read = Instant::now();
            sum.add(&self.session.device)?;
            self.split.read_back += milliseconds(read);
        }
        Ok(())
    }

    fn image_bytes(&self) -> u64 {
        let plain = self.plain.as_ref().map_or(0, |plain| plain.images.targets.bytes());
        plain + self.shaded.as_ref().map_or(0, |shaded| shaded.images.targets.bytes())
    }

    fn metadata(&self, camera: &Camera, frame: i32) -> Metadata {
        let shutter = self.shutter.map(|[open, close]| self.rate.seconds(close - open) as f32);
        let mut metadata = Metadata {
            software: format!("planish {}", env!("CARGO_PKG_VERSION")),
            frame,
            time: self.rate.time(frame),
            frames_per_second: Some(self.rate.as_fraction()),
            shutter_seconds: shutter,
            ..Metadata::default()
        };
        metadata.set_camera(
            &camera.view_matrix().to_cols_array_2d(),
            &camera.projection_matrix(aspect(self.arguments.view.size)).to_cols_array_2d(),
        );
        metadata
    }
}

/// When the shutter opens and closes, in frames: as asked for, or as the camera says. None where nothing moves meanwhile, or a
/// single sample sees one moment alone.
fn shutter(arguments: &RenderArguments, cage: &Cage, rate: FrameRate, range: FrameRange) -> Result<Option<[f64; 2]>> {
    let first = f64::from(range.frames().next().unwrap_or_default());
    let camera = Moment::new(cage, &arguments.view, rate, first)?.camera;
    let of_camera = camera.rig.as_ref().and_then(|rig| rig.shutter);
    let in_frames = of_camera.map(|seconds| seconds.map(|second| second / rate.seconds(1.0)));
    let shutter = arguments.sampling.shutter.or(in_frames);
    let sees_motion =
        |[open, close]: &[f64; 2]| open < close && arguments.samples > 1 && cage.is_animated(&arguments.view);
    Ok(shutter.filter(sees_motion))
}

/// When in a frame something of it is seen, in frames from the frame's own time.
fn offsets(shutter: Option<[f64; 2]>, aovs: &[Aov]) -> Vec<f64> {
    let next = aovs.contains(&Aov::Motion).then_some(1.0);
    std::iter::once(0.0).chain(shutter.into_iter().flatten()).chain(next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_frames_need_a_placeholder() {
        let range: FrameRange = "1-3".parse().unwrap();
        let message = check_placeholder(Path::new("a.exr"), range).unwrap_err().to_string();
        assert_eq!(message, "a.exr: 3 frames need a name with #### where the number goes");
        assert!(check_placeholder(Path::new("a.####.exr"), range).is_ok());
        assert!(check_placeholder(Path::new("a.exr"), FrameRange::single(3)).is_ok());
    }
}
