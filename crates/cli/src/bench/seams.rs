//! What it costs that seams have the same bits on both sides: frames with and without (FAS section 5).

use anyhow::Result;
use planish_gpu::Device;
use planish_render::SurfaceMethod;
use planish_render::density::isolation_level;
use planish_subdiv::refine::CreasePatches;
use serde::Serialize;

use super::measure::{Measured, Setting, measure};
use super::{Bench, Row};
use crate::cage::Cage;
use crate::text_table::milliseconds_text;

/// One method at one tess factor.
#[derive(Serialize)]
pub struct SeamRow {
    tess: f32,
    method: &'static str,
    watertight: Measured,
    by_themselves: Measured,
    /// Time of the watertight frame over that of the other.
    ratio: f64,
}

/// Measures all factors asked for.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<SeamRow>> {
    let mut rows = Vec::new();
    for &tess in &bench.arguments.tess {
        let level = isolation_level(tess, bench.arguments.max_level);
        for (name, method) in [("fas", SurfaceMethod::Fas), ("dfas", SurfaceMethod::Dfas)] {
            bench.console.progress(format_args!("{}: tess factor {tess}, {name}", cage.path().display()));
            let crease_patches = CreasePatches::default();
            let setting = |watertight| Setting {
                method,
                level,
                tess_factor: tess,
                crease_patches,
                watertight,
                ..Setting::default()
            };
            let by_themselves = measure(bench, device, cage, setting(false))?;
            let watertight = measure(bench, device, cage, setting(true))?;
            let ratio = watertight.wall_ms / by_themselves.wall_ms;
            rows.push(SeamRow { tess, method: name, watertight, by_themselves, ratio });
        }
    }
    Ok(rows)
}

impl Row for SeamRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec![
            "tess",
            "method",
            "patches",
            "triangles",
            "points",
            "draw ms",
            "wall ms",
            "without: points",
            "draw ms",
            "wall ms",
            "ratio",
        ]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let (with, without) = (&self.watertight, &self.by_themselves);
        let mut cells = vec![self.tess.to_string(), self.method.to_owned()];
        cells.extend([with.patch_count(), with.triangles, with.points].map(|count| count.to_string()));
        cells.extend([with.gpu_ms.draw, with.wall_ms].map(milliseconds_text));
        cells.push(without.points.to_string());
        cells.extend([without.gpu_ms.draw, without.wall_ms].map(milliseconds_text));
        cells.push(format!("{:.2}", self.ratio));
        cells
    }
}
