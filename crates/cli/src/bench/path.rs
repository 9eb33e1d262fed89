//! Fas and dfas side by side, frame by frame: along a camera path (DFAS figure 11), or as the scene's cameras see it
//! (DFAS Table 1). Both have the same densities and the same culling; they differ in how deep irregularities are isolated.

use anyhow::{Result, bail};
use planish_gpu::Device;
use planish_render::{Density, EndCap, GregoryPoints, Layers, SurfaceMethod, TableNormals, TableWeights, View};
use planish_scene::Camera;
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::NoCache;
use serde::Serialize;

use super::chart::{Chart, Series};
use super::{Bench, Row, median};
use crate::cage::Cage;
use crate::moment::Moment;
use crate::offline::{Images, Plan, PlanSetting, Session, frame_camera, frame_options};
use crate::stats::{CallStats, FrameStats};
use crate::text_table::milliseconds_text;

/// Rows of the text table are thinned to about this many.
const SHOWN_FRAMES: usize = 20;

/// One frame of one method.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MethodFrame {
    /// Patches that were drawn.
    patches: u64,
    /// Those of level 1 and finer.
    refined: u64,
    triangles: u64,
    /// Runs of the tessellation-evaluation shader.
    evaluations: u64,
    /// Points and limit points that were computed.
    points: u64,
    /// Commands of the frame.
    calls: CallStats,
    /// Median milliseconds of the stages up to drawing.
    stages_ms: f64,
    /// Median milliseconds of the whole frame, from cage upload to fence.
    wall_ms: f64,
}

/// One frame, or the sum of all.
#[derive(Clone, Debug, Serialize)]
pub struct PathRow {
    frame: String,
    #[serde(skip)]
    is_shown: bool,
    fas: MethodFrame,
    dfas: MethodFrame,
    /// dfas over fas.
    patch_ratio: f64,
    refined_ratio: f64,
    time_ratio: f64,
}

/// Measures the frames asked for, and their mean.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<PathRow>> {
    let frames = frames(bench, cage)?;
    let cameras: Vec<Camera> = frames.iter().map(|(_, camera)| camera.clone()).collect();
    let mut fas = Method::new(bench, device, cage, SurfaceMethod::Fas, &cameras)?;
    let mut dfas = Method::new(bench, device, cage, SurfaceMethod::Dfas, &cameras)?;
    let mut rows = Vec::new();
    let step = frames.len().div_ceil(SHOWN_FRAMES);
    for (place, (name, camera)) in frames.iter().enumerate() {
        bench.console.progress(format_args!("{}: {name} ({place} of {})", cage.path().display(), frames.len()));
        // In turns, so that a noisy machine is as noisy for both.
        let measured = measure(bench, cage, [&mut fas, &mut dfas], camera)?;
        let [fas, dfas] = measured;
        rows.push(PathRow::new(name.clone(), place.is_multiple_of(step), fas, dfas));
    }
    rows.push(mean(&rows));
    if let Some(path) = &bench.arguments.chart {
        chart(cage, &rows).write(path)?;
    }
    Ok(rows)
}

/// The frames, by name.
fn frames(bench: &Bench, cage: &Cage) -> Result<Vec<(String, Camera)>> {
    let Some(name) = &bench.arguments.path else {
        let cameras = &cage.scene().cameras;
        if cameras.is_empty() {
            return Ok(vec![("default view".to_owned(), cage.default_view()?)]);
        }
        return Ok(cameras.iter().map(|camera| (camera.name.clone(), camera.clone())).collect());
    };
    let path = cage.scene().path(name)?;
    let numbers = (0..path.frame_count()).step_by(bench.arguments.step as usize);
    let frames: Vec<(String, Camera)> = numbers.map(|frame| (frame.to_string(), path.camera(frame))).collect();
    if frames.is_empty() {
        bail!("{}: path {name} has no frames", cage.path().display());
    }
    Ok(frames)
}

/// A method ready to draw.
struct Method {
    session: Session,
    images: Images,
}

impl Method {
    fn new(bench: &Bench, device: &Device, cage: &Cage, method: SurfaceMethod, cameras: &[Camera]) -> Result<Self> {
        let arguments = bench.arguments;
        let setting = PlanSetting {
            scheme: Scheme::CatmullClark,
            table_normals: TableNormals::Tangents,
            table_weights: TableWeights::Float,
            method,
            max_level: arguments.max_level,
            crease_patches: CreasePatches::default(),
            end_cap: EndCap::default(),
            spacing: arguments.spacing.into(),
            size: arguments.size,
            watertight: !arguments.no_watertight,
            gregory_points: GregoryPoints::TwoStage,
            exact_normals: false,
            options: frame_options(method, Density::EdgePixels(arguments.edge_pixels), false),
        };
        let mut plan = Plan::of(cage, &setting, cameras.iter().map(|camera| Ok(Moment::seen_by(cage, camera, 0.0))))?;
        plan.cull(arguments.no_cull);
        let mut session = Session::new(device, cage, &plan, &NoCache, bench.console)?;
        let images = session.images(View::Shaded, Layers::None)?;
        let camera = session.camera;
        session.draw(&images, &camera, &cage.positions())?;
        Ok(Self { session, images })
    }
}

fn measure(bench: &Bench, cage: &Cage, mut methods: [&mut Method; 2], camera: &Camera) -> Result<[MethodFrame; 2]> {
    let camera = frame_camera(camera, bench.arguments.size);
    let mut found = [Vec::new(), Vec::new()];
    for _ in 0..bench.arguments.repeat {
        for (method, found) in methods.iter_mut().zip(&mut found) {
            let drawn = method.session.draw(&method.images, &camera, &cage.positions())?;
            let statistics = drawn.report.statistics.iter().find(|(name, _)| name == "draw");
            let evaluations = statistics.map_or(0, |(_, counts)| counts.tessellation_evaluation_invocations);
            found.push((FrameStats::drawn(0, &method.session, &drawn), evaluations));
        }
    }
    Ok(found.map(|frames| summary(&frames)))
}

fn summary(frames: &[(FrameStats, u64)]) -> MethodFrame {
    let Some((last, evaluations)) = frames.last() else { return MethodFrame::default() };
    let of = |value: fn(&FrameStats) -> f64| median(frames.iter().map(|(frame, _)| value(frame)).collect());
    MethodFrame {
        patches: last.patches_by_level.iter().sum(),
        refined: last.patches_by_level[1..].iter().sum(),
        triangles: last.triangles,
        evaluations: *evaluations,
        points: last.points,
        calls: last.calls,
        stages_ms: of(|frame| frame.gpu_ms.total - frame.gpu_ms.draw),
        wall_ms: of(|frame| frame.wall_ms),
    }
}

impl PathRow {
    fn new(frame: String, is_shown: bool, fas: MethodFrame, dfas: MethodFrame) -> Self {
        Self {
            frame,
            is_shown,
            patch_ratio: ratio(dfas.patches as f64, fas.patches as f64),
            refined_ratio: ratio(dfas.refined as f64, fas.refined as f64),
            time_ratio: dfas.wall_ms / fas.wall_ms,
            fas,
            dfas,
        }
    }
}

/// 1 where there is nothing on either side.
fn ratio(a: f64, b: f64) -> f64 {
    if a == b { 1.0 } else { a / b }
}

/// Sums, and means of the frames' ratios.
fn mean(rows: &[PathRow]) -> PathRow {
    let sum = |of: fn(&PathRow) -> &MethodFrame| {
        rows.iter().map(of).fold(MethodFrame::default(), |sum, frame| MethodFrame {
            patches: sum.patches + frame.patches,
            refined: sum.refined + frame.refined,
            triangles: sum.triangles + frame.triangles,
            evaluations: sum.evaluations + frame.evaluations,
            points: sum.points + frame.points,
            calls: frame.calls,
            stages_ms: sum.stages_ms + frame.stages_ms,
            wall_ms: sum.wall_ms + frame.wall_ms,
        })
    };
    let mean_of = |of: fn(&PathRow) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
    PathRow {
        patch_ratio: mean_of(|row| row.patch_ratio),
        refined_ratio: mean_of(|row| row.refined_ratio),
        time_ratio: mean_of(|row| row.time_ratio),
        ..PathRow::new("all".to_owned(), true, sum(|row| &row.fas), sum(|row| &row.dfas))
    }
}

fn chart(cage: &Cage, rows: &[PathRow]) -> Chart {
    let frames = &rows[..rows.len() - 1];
    let series = |name: &str, value: fn(&PathRow) -> f64| Series {
        name: name.to_owned(),
        values: frames.iter().map(value).collect(),
    };
    Chart {
        title: cage.path().file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(),
        panels: vec![
            (
                "patches".to_owned(),
                vec![series("fas", |r| r.fas.patches as f64), series("dfas", |r| r.dfas.patches as f64)],
            ),
            (
                "points".to_owned(),
                vec![series("fas", |r| r.fas.points as f64), series("dfas", |r| r.dfas.points as f64)],
            ),
            ("ms a frame".to_owned(), vec![series("fas", |r| r.fas.wall_ms), series("dfas", |r| r.dfas.wall_ms)]),
        ],
    }
}

impl Row for PathRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec![
            "frame",
            "fas patches",
            "refined",
            "triangles",
            "points",
            "stages ms",
            "wall ms",
            "dfas patches",
            "refined",
            "triangles",
            "points",
            "stages ms",
            "wall ms",
            "patches",
            "refined",
            "time",
        ]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let mut cells = vec![self.frame.clone()];
        for method in [&self.fas, &self.dfas] {
            let counts = [method.patches, method.refined, method.triangles, method.points];
            cells.extend(counts.iter().map(u64::to_string));
            cells.extend([method.stages_ms, method.wall_ms].map(milliseconds_text));
        }
        cells.extend([self.patch_ratio, self.refined_ratio, self.time_ratio].map(|ratio| format!("{ratio:.2}")));
        cells
    }

    fn is_shown(&self) -> bool {
        self.is_shown
    }

    fn summary(rows: &[Self]) -> Option<String> {
        let frames = &rows[..rows.len().saturating_sub(1)];
        let largest = |of: fn(&PathRow) -> f64| frames.iter().map(of).fold(0.0, f64::max);
        Some(format!(
            "dfas / fas, mean and largest of {} frames: patches {:.2} {:.2}, refined {:.2} {:.2}, time {:.2} {:.2}",
            frames.len(),
            rows.last()?.patch_ratio,
            largest(|row| row.patch_ratio),
            rows.last()?.refined_ratio,
            largest(|row| row.refined_ratio),
            rows.last()?.time_ratio,
            largest(|row| row.time_ratio),
        ))
    }
}
