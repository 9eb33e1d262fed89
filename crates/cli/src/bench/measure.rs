//! What is measured of a frame: medians of frames in each of which the cage has moved.

use anyhow::Result;
use planish_gpu::{Device, SubmitReport};
use planish_render::{
    Density, EndCap, FrameNeeds, GregoryPoints, Layers, SurfaceDesc, SurfaceMethod, TableNormals, TableWeights, View,
};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::NoCache;
use serde::Serialize;

use super::gregory::fetched_points;
use super::grids::bytes_a_point;
use super::{Bench, median};
use crate::cage::Cage;
use crate::moment::Moment;
use crate::offline::{Images, Plan, Session, frame_camera, frame_needs, frame_options};
use crate::stats::{FrameStats, GpuStats, PatchStats};

/// A method's frames at one setting.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Level of the irregular leaves.
    pub level: u32,
    /// Patches that were drawn.
    pub patches: PatchStats,
    pub triangles: u64,
    /// Points and limit points that were computed.
    pub points: u64,
    /// Bytes of what depends on connectivity alone.
    pub table_bytes: u64,
    /// Time of refinement and tables, once a topology.
    pub preprocess_ms: f64,
    /// Runs of the tessellation stages.
    pub tessellation: TessellationRuns,
    /// Points and vectors that a control shader reads for a Gregory patch, in the mean.
    pub gregory_fetched_points: f64,
    /// Bytes that an evaluation shader reads for a point inside a face that is a grid, in the mean.
    pub grid_bytes: f64,
    /// Median times of the stages.
    pub gpu_ms: GpuStats,
    /// Median time from cage upload to fence.
    pub wall_ms: f64,
}

/// What pipeline statistics count of a frame's draws; 0 where a device has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TessellationRuns {
    pub control_patches: u64,
    pub evaluations: u64,
}

impl TessellationRuns {
    fn new(report: &SubmitReport) -> Self {
        let draws = report.statistics.iter().filter(|(name, _)| name == "draw");
        draws.fold(Self::default(), |sum, (_, counted)| Self {
            control_patches: sum.control_patches + counted.tessellation_control_patches,
            evaluations: sum.evaluations + counted.tessellation_evaluation_invocations,
        })
    }
}

impl Measured {
    /// Number of patches of all kinds.
    pub fn patch_count(&self) -> u64 {
        let patches = &self.patches;
        let gregory = patches.gregory_quad + patches.gregory_triangle;
        patches.regular + patches.transition + patches.quad + gregory + patches.table
    }
}

/// Draws and times a scene in its default view.
pub fn measure(bench: &Bench, device: &Device, cage: &Cage, setting: Setting) -> Result<Measured> {
    let mut timed = Timed::new(bench, device, cage, setting)?;
    for _ in 0..bench.arguments.repeat {
        timed.draw()?;
    }
    Ok(timed.measured())
}

/// A method at one setting, frame by frame: so that those of several can be drawn in turns, and a machine that is busy for a while is
/// so for all of them.
pub struct Timed<'a> {
    session: Session,
    images: Images,
    cage_motion: CageMotion<'a>,
    frames: Vec<FrameStats>,
    tessellation: TessellationRuns,
}

impl<'a> Timed<'a> {
    /// Draws one frame, which does not count.
    pub fn new(bench: &Bench, device: &Device, cage: &'a Cage, setting: Setting) -> Result<Self> {
        let arguments = bench.arguments;
        let camera = cage.default_view()?;
        let Setting { method, level, tess_factor, crease_patches, watertight, gregory_points, .. } = setting;
        let objects = Moment::seen_by(cage, &camera, 0.0).objects;
        let mut plan = Plan {
            frame_camera: frame_camera(&camera, arguments.size),
            needs: FrameNeeds {
                watertight,
                displaced: cage.is_displaced(),
                gregory: method.is_one_patch_a_face(),
                rival: method.rival(),
                filling: !method.is_one_patch_a_face(),
                gregory_points,
                ..frame_needs(arguments.spacing.into(), tess_factor, &objects)
            },
            objects,
            desc: SurfaceDesc {
                method,
                level,
                crease_patches,
                end_cap: EndCap::Quad,
                displaced: cage.is_displaced(),
                gregory_points,
                scheme: setting.scheme,
                table_normals: setting.table_normals,
                table_weights: setting.table_weights,
            },
            options: frame_options(method, Density::Tess(tess_factor), false),
        };
        plan.needs.grids = method.is_grid();
        plan.needs.vertex_normals = plan.desc.has_vertex_normals();
        plan.cull(arguments.no_cull || !setting.is_culled);
        let mut session = Session::new(device, cage, &plan, &NoCache, bench.console)?;
        let images = session.images(View::Shaded, Layers::None)?;
        let mut cage_motion = CageMotion::new(cage);
        let camera = session.camera;
        session.draw(&images, &camera, &cage_motion.positions(0))?;
        Ok(Self { session, images, cage_motion, frames: Vec::new(), tessellation: TessellationRuns::default() })
    }

    /// Draws and times the next frame.
    pub fn draw(&mut self) -> Result<()> {
        let frame = self.frames.len() as i32 + 1;
        let (camera, cages) = (self.session.camera, self.cage_motion.positions(frame));
        let drawn = self.session.draw(&self.images, &camera, &cages)?;
        self.frames.push(FrameStats::drawn(frame, &self.session, &drawn));
        self.tessellation = TessellationRuns::new(&drawn.report);
        Ok(())
    }

    /// What was measured.
    pub fn measured(&self) -> Measured {
        let (surface, times) = (&self.session.surface, self.session.surface.times());
        Measured {
            table_bytes: surface.memory().tables,
            preprocess_ms: times.topology + times.tables,
            tessellation: self.tessellation,
            gregory_fetched_points: fetched_points(surface.tables()),
            grid_bytes: bytes_a_point(surface.tables(), surface.desc().table_normals, surface.desc().table_weights),
            ..medians(surface.tables().last_level, &self.frames)
        }
    }
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub method: SurfaceMethod,
    pub level: u32,
    pub tess_factor: f32,
    pub crease_patches: CreasePatches,
    pub watertight: bool,
    pub gregory_points: GregoryPoints,
    pub scheme: Scheme,
    pub table_normals: TableNormals,
    pub table_weights: TableWeights,
    /// What cannot be seen is left out, unless that is not wanted.
    pub is_culled: bool,
}

impl Default for Setting {
    fn default() -> Self {
        Self {
            method: SurfaceMethod::default(),
            level: 0,
            tess_factor: 1.0,
            crease_patches: CreasePatches::default(),
            watertight: true,
            gregory_points: GregoryPoints::default(),
            scheme: Scheme::default(),
            table_normals: TableNormals::default(),
            table_weights: TableWeights::default(),
            is_culled: true,
        }
    }
}

fn medians(level: u32, frames: &[FrameStats]) -> Measured {
    let of = |value: fn(&FrameStats) -> f64| median(frames.iter().map(value).collect());
    let last = frames.last().cloned().unwrap_or_default();
    Measured {
        level,
        patches: last.patches,
        triangles: last.triangles,
        points: last.points,
        gpu_ms: GpuStats {
            animate: of(|frame| frame.gpu_ms.animate),
            density: of(|frame| frame.gpu_ms.density),
            select: of(|frame| frame.gpu_ms.select),
            subdivide: of(|frame| frame.gpu_ms.subdivide),
            limit: of(|frame| frame.gpu_ms.limit),
            emit: of(|frame| frame.gpu_ms.emit),
            draw: of(|frame| frame.gpu_ms.draw),
            shade: of(|frame| frame.gpu_ms.shade),
            total: of(|frame| frame.gpu_ms.total),
        },
        wall_ms: of(|frame| frame.wall_ms),
        ..Measured::default()
    }
}

/// Cages that sway a little, as the peer's does: in frame k a vertex moves by 0.002 d sin(k / 2 + 3 y / d) along x, d
/// being the diagonal of the bounding box.
struct CageMotion<'a> {
    rest: Vec<&'a [[f32; 3]]>,
    moved: Vec<Vec<[f32; 3]>>,
    diagonal: f64,
}

impl<'a> CageMotion<'a> {
    fn new(cage: &'a Cage) -> Self {
        let rest = cage.positions();
        let moved = rest.iter().map(|positions| positions.to_vec()).collect();
        Self { rest, moved, diagonal: cage.diagonal() }
    }

    fn positions(&mut self, frame: i32) -> Vec<&[[f32; 3]]> {
        /// Amplitude in diagonals.
        const AMPLITUDE: f64 = 0.002;
        for (moved, rest) in self.moved.iter_mut().zip(&self.rest) {
            for (moved, &[x, y, _]) in moved.iter_mut().zip(*rest) {
                let phase = 0.5 * f64::from(frame) + 3.0 * f64::from(y) / self.diagonal;
                moved[0] = x + (AMPLITUDE * self.diagonal * phase.sin()) as f32;
            }
        }
        self.moved.iter().map(Vec::as_slice).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_time_has_its_own_median() {
        let frame = |wall_ms, draw| {
            let gpu_ms = GpuStats { draw, ..GpuStats::default() };
            FrameStats { wall_ms, gpu_ms, triangles: 7, ..FrameStats::default() }
        };
        let measured = medians(3, &[frame(1.0, 9.0), frame(5.0, 2.0), frame(9.0, 3.0)]);
        assert_eq!((measured.wall_ms, measured.gpu_ms.draw, measured.triangles, measured.level), (5.0, 3.0, 7, 3));
    }
}
