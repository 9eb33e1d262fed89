//! `planish render`: frames to EXR and PNG.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use planish_film::{Film, ImageFormat, Metadata, check_image_output, write_image};

use crate::aov::{Aov, drawn_layers};
use crate::args::RenderArguments;
use crate::cage::Cage;
use crate::console::Console;
use crate::frames::{FrameRange, frame_path, has_placeholder};
use crate::image::{ColorSum, read_layers};
use crate::jitter::sample_offsets;
use crate::offline::{Images, Plan, Session, aspect, check_validation, frame_camera, open_device};
use crate::stats::{FrameStats, Stats, StatsOutput};

/// Runs the command.
pub fn run(arguments: &RenderArguments, console: &Console) -> Result<()> {
    let mut cage = Cage::load(&arguments.scene.path, arguments.scene.repair, console)?;
    cage.displace(&arguments.displacement, console)?;
    let aovs = arguments.aov.available()?;
    check_outputs(arguments, aovs, console)?;
    let stats_output = StatsOutput(arguments.frames.stats.as_ref());
    stats_output.check(arguments.outputs.iter().map(PathBuf::as_path))?;
    let mut plan = Plan::new(&cage, &arguments.surface, &arguments.view, arguments.frames.range())?;
    plan.cull(arguments.frames.no_cull);
    let device = open_device(&arguments.device, console)?;
    let mut session = Session::new(&device, &cage, &plan, console)?;
    let images = session.images(arguments.shown.into(), drawn_layers(aovs))?;
    if images.targets.has_vertex_colors() {
        session.surface.set_colors(&device, &cage.meshes())?;
    }
    let mut sum = ColorSum::new(&device, &images.targets)?;

    let mut frames = Vec::new();
    let range = arguments.frames.range();
    for (done, frame) in (0_u64..).zip(range.frames()) {
        console.progress(format_args!("frame {frame} ({done} of {} done)", range.count()));
        let is_first = done == 0;
        plan.camera = cage.camera(&arguments.view, frame)?;
        session.camera = frame_camera(&plan.camera, arguments.view.size);
        timed_frames(arguments, &cage, &mut session, &images, frame, is_first, &mut frames)?;
        let film = film(arguments, &cage, &plan, &mut session, &images, &mut sum, frame, console)?;
        for output in &arguments.outputs {
            let path = frame_path(output, frame);
            write_image(&film, &path)?;
            console.explain(format_args!("wrote {}", path.display()));
        }
    }
    console.end_progress();
    stats_output.write(&Stats::new(&cage, &session, images.targets.bytes(), frames))?;
    check_validation(&device)
}

/// Finds out before any work whether the images can be written.
fn check_outputs(arguments: &RenderArguments, aovs: &[Aov], console: &Console) -> Result<()> {
    let range = arguments.frames.range();
    let mut has_exr = false;
    for output in &arguments.outputs {
        check_placeholder(output, range)?;
        let first = range.frames().next().unwrap_or_default();
        has_exr |= check_image_output(&frame_path(output, first))? == ImageFormat::Exr;
    }
    if !aovs.is_empty() && !has_exr {
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

/// Draws a frame as often as it is to be timed, with a sample at the centre of every pixel.
fn timed_frames(
    arguments: &RenderArguments,
    cage: &Cage,
    session: &mut Session,
    images: &Images,
    frame: i32,
    is_first: bool,
    frames: &mut Vec<FrameStats>,
) -> Result<()> {
    let (cages, camera) = (cage.positions(), session.camera);
    if arguments.frames.repeat.is_some() && is_first {
        session.draw(images, &camera, &cages)?;
    }
    for _ in 0..arguments.frames.repeat.unwrap_or(1) {
        let drawn = session.draw(images, &camera, &cages)?;
        frames.push(FrameStats::drawn(frame, session, &drawn));
    }
    Ok(())
}

/// Reads the frame that was just drawn, and draws the samples that it needs besides.
#[expect(clippy::too_many_arguments, reason = "a film is made of all that a render has")]
fn film(
    arguments: &RenderArguments,
    cage: &Cage,
    plan: &Plan,
    session: &mut Session,
    images: &Images,
    sum: &mut ColorSum,
    frame: i32,
    console: &Console,
) -> Result<Film> {
    let device = &session.device.clone();
    let aovs = arguments.aov.available()?;
    let layers = if aovs.is_empty() {
        Vec::new()
    } else {
        let packed = read_layers(device, &images.targets)?;
        aovs.iter().map(|&aov| packed.layer(aov)).collect()
    };
    if arguments.samples == 1 {
        sum.add(device)?;
    } else {
        for (done, offset) in (0..).zip(sample_offsets(arguments.samples)) {
            console.progress(format_args!("frame {frame}: sample {done} of {}", arguments.samples));
            let camera = session.camera.jittered(offset);
            session.draw(images, &camera, &cage.positions())?;
            sum.add(device)?;
        }
    }
    let [width, height] = session.camera.size;
    Ok(Film { width, height, color: sum.take(), layers, metadata: metadata(arguments, plan, frame, [width, height]) })
}

fn metadata(arguments: &RenderArguments, plan: &Plan, frame: i32, size: [u32; 2]) -> Metadata {
    let rate = arguments.frames.fps;
    let mut metadata = Metadata {
        software: format!("planish {}", env!("CARGO_PKG_VERSION")),
        frame,
        time: rate.time(frame),
        frames_per_second: Some(rate.as_fraction()),
        ..Metadata::default()
    };
    let camera = &plan.camera;
    metadata.set_camera(
        &camera.view_matrix().to_cols_array_2d(),
        &camera.projection_matrix(aspect(size)).to_cols_array_2d(),
    );
    metadata
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
