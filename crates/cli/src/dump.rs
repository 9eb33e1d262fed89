//! `planish dump`: the tessellated limit surface to PLY.

use std::borrow::Cow;
use std::path::Path;
use std::sync::mpsc::sync_channel;
use std::time::Instant;

use anyhow::{Result, anyhow};
use glam::Vec3;
use planish_film::{DumpProperties, DumpVertex, check_dump_output, write_ply_stream};
use planish_render::{CapturedVertex, Density, DumpPasses};
use planish_scene::Camera;

use crate::args::DumpArguments;
use crate::cage::{Cage, milliseconds};
use crate::console::Console;
use crate::frames::frame_path;
use crate::moment::Moment;
use crate::offline::{Drawn, Plan, Session, check_validation, open_device};
use crate::render::check_placeholder;
use crate::stats::{FrameStats, Stats, StatsOutput};
use crate::table_cache::TableCache;
use crate::values::FrameRate;

/// Captured parts that may wait for the disk.
const QUEUED_PARTS: usize = 2;

/// Runs the command.
pub fn run(arguments: &DumpArguments, console: &Console) -> Result<()> {
    let mut cage = Cage::load(&arguments.scene, console)?;
    cage.displace(&arguments.displacement, console)?;
    let rate = cage.frame_rate(arguments.frames.fps);
    let range = cage.frame_range(arguments.frames.frames, rate);
    check_placeholder(&arguments.output, range)?;
    check_dump_output(&frame_path(&arguments.output, range.frames().next().unwrap_or_default()))?;
    let stats_output = StatsOutput(arguments.frames.stats.as_ref());
    stats_output.check([arguments.output.as_path()].into_iter())?;
    let plan = Plan::unseen(&cage, &arguments.surface, &arguments.view, rate, range)?;
    let device = open_device(&arguments.device, console)?;
    let cache = TableCache::new(arguments.surface.table_cache.as_deref(), console);
    let mut session = Session::new(&device, &cage, &plan, &cache, console)?;
    if cage.has_uv() {
        session.surface.set_tex_coords(&device, &cage.meshes())?;
    }
    if cage.has_colors() {
        session.surface.set_colors(&device, &cage.meshes())?;
    }
    let start = Instant::now();
    let passes = DumpPasses::new(&device, &plan.desc, &plan.needs)?;
    session.pipelines_ms += milliseconds(start);
    let properties =
        DumpProperties { tex_coords: cage.has_uv(), shading_normals: cage.is_displaced(), colors: cage.has_colors() };
    let mut dump = Dump { passes, session, cages: cage.positions(), properties };

    let mut frames = Vec::new();
    if cage.deforms() {
        let first = range.frames().next().unwrap_or_default();
        dump.session.set_moment(moment(&cage, arguments, rate, first)?, None);
    }
    if arguments.frames.repeat.is_some() {
        dump.frame(|_| Ok(()))?;
    }
    for (done, frame) in (0_u64..).zip(range.frames()) {
        console.progress(format_args!("frame {frame} ({done} of {} done)", range.count()));
        if cage.is_animated(&arguments.view) {
            dump.session.set_moment(moment(&cage, arguments, rate, frame)?, None);
        }
        let path = frame_path(&arguments.output, frame);
        let mut timed = Vec::new();
        for _ in 0..arguments.frames.repeat.unwrap_or(0) {
            timed.push(dump.frame(|_| Ok(()))?);
        }
        let written = dump.write(&path)?;
        if timed.is_empty() {
            timed.push(written);
        }
        frames.extend(timed.iter().map(|done| FrameStats::new(frame, &dump.session, &done.drawn, done.triangles)));
        console.explain(format_args!("wrote {}", path.display()));
    }
    console.end_progress();
    stats_output.write(&Stats::new(&cage, &dump.session, 0, frames))?;
    check_validation(&device)
}

/// The scene in a frame. With a given tess factor there need not be a camera that sees it.
fn moment(cage: &Cage, arguments: &DumpArguments, rate: FrameRate, frame: i32) -> Result<Moment> {
    let frames = f64::from(frame);
    match (Moment::new(cage, &arguments.view, rate, frames), arguments.surface.density()) {
        (Err(_), Density::Tess(_)) => {
            let nowhere = Camera::upright("none", Vec3::Z, Vec3::ZERO, 45.0, 1.0)?;
            Ok(Moment::seen_by(cage, &nowhere, rate.seconds(frames)))
        }
        (moment, _) => moment,
    }
}

/// What a frame of a dump needs.
struct Dump<'a> {
    session: Session,
    cages: Vec<&'a [[f32; 3]]>,
    passes: DumpPasses,
    properties: DumpProperties,
}

/// A frame that was captured.
struct Done {
    drawn: Drawn,
    triangles: u64,
}

impl Dump<'_> {
    /// Makes the lists and captures all triangles. What the sink does with them is not timed.
    fn frame(&mut self, sink: impl FnMut(&[CapturedVertex]) -> Result<()>) -> Result<Done> {
        let drawn = self.session.make_lists(&self.cages)?;
        self.capture(drawn, sink)
    }

    fn capture(&self, mut drawn: Drawn, mut sink: impl FnMut(&[CapturedVertex]) -> Result<()>) -> Result<Done> {
        let start = Instant::now();
        let (mut triangles, mut sink_ms) = (0, 0.0);
        self.passes.capture(&self.session.device, &self.session.surface, |vertices| {
            let start = Instant::now();
            let vertices = self.kept(vertices);
            triangles += vertices.len() as u64 / 3;
            let taken = sink(&vertices);
            sink_ms += milliseconds(start);
            taken
        })?;
        drawn.wall_ms += milliseconds(start) - sink_ms;
        Ok(Done { drawn, triangles })
    }

    /// What a part of a capture has to show: all of it, but for the triangles that lie folded on a side of a patch's grid.
    fn kept<'v>(&self, vertices: &'v [CapturedVertex]) -> Cow<'v, [CapturedVertex]> {
        if !self.session.surface.desc().method.is_grid() {
            return Cow::Borrowed(vertices);
        }
        vertices.chunks_exact(3).filter(|triangle| has_three_corners(triangle)).flatten().copied().collect()
    }

    /// Vertices of the frame whose lists were made.
    fn vertex_count(&self) -> Result<u64> {
        if !self.session.surface.desc().method.is_grid() {
            return Ok(3 * planish_render::listed_triangle_count(&self.session.device, &self.session.surface)?);
        }
        // How many are folded depends on the factors of edges: captured once more to count them.
        let mut count = 0;
        self.passes.capture(&self.session.device, &self.session.surface, |vertices| {
            count += self.kept(vertices).len() as u64;
            anyhow::Ok(())
        })?;
        Ok(count)
    }

    /// Writes a frame while it is captured: a dump of any size needs the memory of a few parts.
    fn write(&mut self, path: &Path) -> Result<Done> {
        let drawn = self.session.make_lists(&self.cages)?;
        let vertex_count = self.vertex_count()?;
        let (sender, receiver) = sync_channel::<Vec<DumpVertex>>(QUEUED_PARTS);
        let properties = self.properties;
        std::thread::scope(|scope| {
            let vertices = receiver.into_iter().flatten();
            let writer = scope.spawn(move || write_ply_stream(path, vertex_count, properties, vertices));
            let captured = self.capture(drawn, move |vertices| {
                sender.send(vertices.iter().map(dump_vertex).collect()).map_err(|_| anyhow!("the writer has stopped"))
            });
            let written = writer.join().map_err(|_| anyhow!("writing {} failed", path.display()))?;
            match written {
                // A capture that fails leaves the file too short: its own reason is the one to tell.
                Err(planish_film::Error::StreamLength { .. }) if captured.is_err() => captured,
                Err(error) => Err(error.into()),
                Ok(()) => captured,
            }
        })
    }
}

/// Whether no two of a triangle's vertices are one point.
fn has_three_corners(triangle: &[CapturedVertex]) -> bool {
    let place = |i: usize| (triangle[i].position.map(f32::to_bits), triangle[i].uv.map(f32::to_bits));
    let [a, b, c] = [0, 1, 2].map(place);
    a != b && b != c && c != a
}

fn dump_vertex(vertex: &CapturedVertex) -> DumpVertex {
    let [level, kind, ..] = vertex.level_and_kind.to_le_bytes();
    let &CapturedVertex { position, normal, uv, ptex_face, tex_coord, shading_normal, color, .. } = vertex;
    DumpVertex { position, normal, uv, face: ptex_face as i32, level, kind, tex_coord, shading_normal, color }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_and_kind_are_unpacked() {
        let captured = CapturedVertex {
            position: [1.0, 2.0, 3.0],
            normal: [0.0, 1.0, 0.0],
            uv: [0.25, 0.5],
            ptex_face: 7,
            level_and_kind: 5 | 2 << 8,
            tex_coord: [0.125, 2.0],
            shading_normal: [1.0, 0.0, 0.0],
            color: [0.5, 0.25, 0.0],
        };
        let vertex = dump_vertex(&captured);
        assert_eq!((vertex.level, vertex.kind, vertex.face, vertex.uv), (5, 2, 7, [0.25, 0.5]));
    }
}
