//! Gregory patches, in both implementations, beside feature-adaptive subdivision (Loop et al. 2009, Table 1).

use anyhow::Result;
use planish_gpu::Device;
use planish_render::density::isolation_level;
use planish_render::{GregoryPoints, SurfaceMethod};
use planish_subdiv::refine::CreasePatches;
use planish_subdiv::tables::{GregoryKind, Tables};
use serde::Serialize;

use super::measure::{Measured, Setting, Timed};
use super::{Bench, Row};
use crate::cage::Cage;
use crate::text_table::milliseconds_text;

/// Segments along an edge that the paper has (6 and 10), and finer ones.
const TESS_FACTORS: [f32; 4] = [6.0, 10.0, 17.0, 25.0];
/// What is compared; the third is the measure of the others.
const METHODS: [(&str, SurfaceMethod, GregoryPoints); 6] = [
    ("fas", SurfaceMethod::Fas, GregoryPoints::TwoStage),
    ("dfas", SurfaceMethod::Dfas, GregoryPoints::TwoStage),
    ("gregory two-stage", SurfaceMethod::Gregory, GregoryPoints::TwoStage),
    ("gregory stencil", SurfaceMethod::Gregory, GregoryPoints::Stencil),
    ("acc", SurfaceMethod::Acc, GregoryPoints::TwoStage),
    ("pm", SurfaceMethod::Pm, GregoryPoints::TwoStage),
];
/// Place of that.
const TWO_STAGE: usize = 2;

/// One method at one tess factor.
#[derive(Serialize)]
pub struct GregoryRow {
    tess: f32,
    method: &'static str,
    #[serde(flatten)]
    measured: Measured,
    /// Points and vectors that an evaluation shader reads for a point of an irregular face; 0 for methods that have bicubic patches alone.
    evaluated_points: u32,
    /// Times over those of the two-stage method.
    wall_ratio: f64,
    draw_ratio: f64,
}

/// Measures all methods at all factors, those asked for or the paper's.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<GregoryRow>> {
    let asked = bench.arguments.tess.as_slice();
    let mut rows = Vec::new();
    for &tess in if asked.is_empty() { &TESS_FACTORS } else { asked } {
        let mut of_factor = Vec::new();
        for (name, method, gregory_points) in METHODS {
            bench.console.progress(format_args!("{}: tess factor {tess}, {name}", cage.path().display()));
            let is_gregory = method.is_one_patch_a_face();
            let setting = Setting {
                method,
                level: if is_gregory { 0 } else { isolation_level(tess, bench.arguments.max_level) },
                tess_factor: tess,
                crease_patches: CreasePatches::default(),
                watertight: !bench.arguments.no_watertight,
                gregory_points,
                // Of ACC and Pm-patches nothing is.
                is_culled: false,
                ..Setting::default()
            };
            match Timed::new(bench, device, cage, setting) {
                Ok(timed) => of_factor.push((name, method, timed)),
                // The paper's rivals are for closed meshes of quads.
                Err(error) if method.rival().is_some() && is_no_cage_of_rivals(&error) => {
                    bench.console.explain(format_args!("{error:#}: left out"));
                }
                Err(error) => return Err(error),
            }
        }
        for round in 1..=bench.arguments.repeat {
            bench.console.progress(format_args!("{}: tess factor {tess}, frame {round}", cage.path().display()));
            of_factor.iter_mut().try_for_each(|(_, _, timed)| timed.draw())?;
        }
        let of_factor: Vec<_> =
            of_factor.into_iter().map(|(name, method, timed)| (name, method, timed.measured())).collect();
        let (wall_ms, draw_ms) = (of_factor[TWO_STAGE].2.wall_ms, of_factor[TWO_STAGE].2.gpu_ms.draw);
        rows.extend(of_factor.into_iter().map(|(name, method, measured)| GregoryRow {
            tess,
            method: name,
            evaluated_points: evaluated_points(method),
            wall_ratio: measured.wall_ms / wall_ms,
            draw_ratio: measured.gpu_ms.draw / draw_ms,
            measured,
        }));
    }
    Ok(rows)
}

/// Points and vectors that an evaluation shader reads for a point of a quad: what its patch is stored as, but for Pm-patches, of whose 24
/// those of one triangle.
fn evaluated_points(method: SurfaceMethod) -> u32 {
    match method {
        SurfaceMethod::Gregory => 20,
        SurfaceMethod::Acc => 32,
        SurfaceMethod::Pm => 14,
        _ => 0,
    }
}

fn is_no_cage_of_rivals(error: &anyhow::Error) -> bool {
    use planish_render::Error;
    matches!(
        error.downcast_ref::<Error>(),
        Some(Error::Rival { .. } | Error::Subdivision(planish_subdiv::Error::RivalCage { .. }))
    )
}

/// Points and vectors that a control shader reads for a Gregory patch, in the mean; each is read by more than one of its threads.
pub fn fetched_points(tables: &Tables) -> f64 {
    let table = &tables.gregory;
    let of_stencil = |face: usize| {
        let stencil = table.stencils.faces.get(face).filter(|stencil| !stencil.is_of_spokes())?;
        let connectivity = table.stencils.connectivities[stencil.connectivity as usize];
        // Limit points and origins at the corners, and the ring.
        Some(2 * connectivity.corner_count + connectivity.point_count)
    };
    // Limit points, and the three of each spoke; four of other schemes.
    let of_spokes = |kind| match kind {
        GregoryKind::Quad if table.rival.is_some() => 4 + 4 * 8,
        GregoryKind::None => 0,
        GregoryKind::Quad => 4 + 3 * 8,
        GregoryKind::PartOfTriangle(_) => 3 + 3 * 6,
        GregoryKind::PartOfNgon => 4 + 3 * 6,
    };
    let counts = table.faces.iter().enumerate().map(|(i, face)| of_stencil(i).unwrap_or(of_spokes(face.kind)));
    let drawn: Vec<u32> = counts.filter(|&count| count > 0).collect();
    f64::from(drawn.iter().sum::<u32>()) / (drawn.len().max(1) as f64)
}

impl Row for GregoryRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec![
            "tess",
            "method",
            "patches",
            "triangles",
            "TCS patches",
            "TES runs",
            "points / patch",
            "points / TES run",
            "table bytes",
            "limit ms",
            "emit ms",
            "draw ms",
            "wall ms",
            "draw / two-stage",
            "wall / two-stage",
        ]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let measured = &self.measured;
        let runs = measured.tessellation;
        let mut cells = vec![self.tess.to_string(), self.method.to_owned()];
        let counts = [measured.patch_count(), measured.triangles, runs.control_patches, runs.evaluations];
        cells.extend(counts.map(|count| count.to_string()));
        cells.push(format!("{:.1}", measured.gregory_fetched_points));
        cells.push(self.evaluated_points.to_string());
        cells.push(measured.table_bytes.to_string());
        let times = [measured.gpu_ms.limit, measured.gpu_ms.emit, measured.gpu_ms.draw, measured.wall_ms];
        cells.extend(times.map(milliseconds_text));
        cells.extend([self.draw_ratio, self.wall_ratio].map(|ratio| format!("{ratio:.2}")));
        cells
    }
}
