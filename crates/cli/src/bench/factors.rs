//! Fas at several tess factors.

use anyhow::Result;
use planish_gpu::Device;
use planish_render::SurfaceMethod;
use planish_render::density::isolation_level;
use planish_subdiv::refine::CreasePatches;
use serde::Serialize;

use super::measure::{Measured, Setting, measure};
use super::peer::PeerFrame;
use super::{Bench, Row, ratio_text};
use crate::cage::Cage;
use crate::text_table::milliseconds_text;

/// One tess factor.
#[derive(Serialize)]
pub struct FactorRow {
    tess: f32,
    #[serde(flatten)]
    fas: Measured,
    peer: Option<PeerFrame>,
    /// Our wall time over the peer's.
    ratio: Option<f64>,
}

/// Measures all factors asked for.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<FactorRow>> {
    let row = |&tess: &f32| {
        bench.console.progress(format_args!("{}: tess factor {tess}", cage.path().display()));
        let level = isolation_level(tess, bench.arguments.max_level);
        let crease_patches = CreasePatches::default();
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
        let peer = bench.peer.as_ref().map(|peer| peer.frame(bench, cage, level, tess)).transpose()?;
        let ratio = peer.as_ref().map(|peer| fas.wall_ms / peer.total_ms);
        Ok(FactorRow { tess, fas, peer, ratio })
    };
    bench.arguments.tess.iter().map(row).collect()
}

impl Row for FactorRow {
    fn headings(with_peer: bool) -> Vec<&'static str> {
        let mut headings = vec![
            "tess",
            "level",
            "patches",
            "triangles",
            "subdivide ms",
            "limit ms",
            "emit ms",
            "draw ms",
            "total ms",
            "wall ms",
        ];
        if with_peer {
            headings.extend(["peer refine ms", "peer draw ms", "peer total ms", "wall / peer"]);
        }
        headings
    }

    fn cells(&self, with_peer: bool) -> Vec<String> {
        let (fas, gpu) = (&self.fas, &self.fas.gpu_ms);
        let times = [gpu.subdivide, gpu.limit, gpu.emit, gpu.draw, gpu.total, fas.wall_ms];
        let counts = [u64::from(fas.level), fas.patch_count(), fas.triangles];
        let mut cells = vec![self.tess.to_string()];
        cells.extend(counts.iter().map(u64::to_string));
        cells.extend(times.map(milliseconds_text));
        if with_peer {
            cells.extend(PeerFrame::cells(self.peer.as_ref()));
            cells.push(ratio_text(self.ratio));
        }
        cells
    }
}
