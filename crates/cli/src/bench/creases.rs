//! Creases as patches of their own beside creases that are refined to the last level.

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

/// One tess factor with one kind of crease patches.
#[derive(Serialize)]
pub struct CreaseRow {
    tess: f32,
    crease_patches: &'static str,
    #[serde(flatten)]
    fas: Measured,
    /// Wall time over that without crease patches.
    ratio: f64,
}

/// Measures all factors asked for.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<CreaseRow>> {
    let kinds =
        [("none", CreasePatches::None), ("infinite", CreasePatches::Infinite), ("single", CreasePatches::Single)];
    let mut rows = Vec::new();
    for &tess in &bench.arguments.tess {
        let level = isolation_level(tess, bench.arguments.max_level);
        let mut refined_ms = None;
        for (name, crease_patches) in kinds {
            bench.console.progress(format_args!("{}: tess factor {tess}, {name}", cage.path().display()));
            let watertight = !bench.arguments.no_watertight;
            let setting = Setting {
                method: SurfaceMethod::Fas,
                level,
                tess_factor: tess,
                crease_patches,
                watertight,
                ..Setting::default()
            };
            let fas = measure(bench, device, cage, setting)?;
            let ratio = fas.wall_ms / *refined_ms.get_or_insert(fas.wall_ms);
            rows.push(CreaseRow { tess, crease_patches: name, fas, ratio });
        }
    }
    Ok(rows)
}

impl Row for CreaseRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec![
            "tess",
            "crease patches",
            "patches",
            "points",
            "table bytes",
            "triangles",
            "preprocess ms",
            "subdivide ms",
            "draw ms",
            "wall ms",
            "wall / none",
        ]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let fas = &self.fas;
        let counts = [fas.patch_count(), fas.points, fas.table_bytes, fas.triangles];
        let times = [fas.preprocess_ms, fas.gpu_ms.subdivide, fas.gpu_ms.draw, fas.wall_ms];
        let mut cells = vec![self.tess.to_string(), self.crease_patches.to_owned()];
        cells.extend(counts.iter().map(u64::to_string));
        cells.extend(times.map(milliseconds_text));
        cells.push(format!("{:.2}", self.ratio));
        cells
    }
}
