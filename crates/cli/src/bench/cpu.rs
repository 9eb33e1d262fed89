//! The building of tables alone, on one thread of the CPU.

use anyhow::{Context, Result};
use planish_render::{SurfaceDesc, preprocess};
use serde::Serialize;

use super::{Bench, Row, median, ratio_text};
use crate::cage::Cage;
use crate::info::table_bytes;
use crate::text_table::{bytes_text, milliseconds_text};

/// One level.
#[derive(Serialize)]
pub struct CpuRow {
    level: u32,
    patches: u64,
    table_bytes: u64,
    topology_ms: f64,
    tables_ms: f64,
    total_ms: f64,
    /// OpenSubdiv's refiner, adaptive refinement, patch table and stencil table.
    peer_total_ms: Option<f64>,
    /// Our total over the peer's.
    ratio: Option<f64>,
}

/// Measures all levels asked for.
pub fn run(bench: &Bench, cage: &Cage) -> Result<Vec<CpuRow>> {
    bench.arguments.levels.clone().map(|level| row(bench, cage, level)).collect()
}

fn row(bench: &Bench, cage: &Cage, level: u32) -> Result<CpuRow> {
    bench.console.progress(format_args!("{}: tables to level {level}", cage.path().display()));
    let desc = SurfaceDesc { level, ..SurfaceDesc::default() };
    let (mut topology, mut tables, mut total) = (Vec::new(), Vec::new(), Vec::new());
    let (mut patches, mut bytes) = (0, 0);
    for _ in 0..=bench.arguments.repeat {
        let made = preprocess(&cage.meshes(), &desc).with_context(|| cage.path().display().to_string())?;
        topology.push(made.times.topology);
        tables.push(made.times.tables);
        total.push(made.times.topology + made.times.tables);
        patches =
            (made.tables.patches.len() + made.tables.irregular_ranges[made.tables.last_level as usize].len()) as u64;
        bytes = table_bytes(&made.tables);
    }
    // The first is not timed.
    let times = [topology, tables, total].map(|times| median(times[1..].to_vec()));
    let peer_total_ms = match &bench.peer {
        Some(peer) => {
            let runs: Result<Vec<f64>> = (0..bench.arguments.repeat).map(|_| peer.tables_ms(cage, level)).collect();
            Some(median(runs?))
        }
        None => None,
    };
    Ok(CpuRow {
        level,
        patches,
        table_bytes: bytes,
        topology_ms: times[0],
        tables_ms: times[1],
        total_ms: times[2],
        peer_total_ms,
        ratio: peer_total_ms.map(|peer| times[2] / peer),
    })
}

impl Row for CpuRow {
    fn headings(with_peer: bool) -> Vec<&'static str> {
        let mut headings = vec!["level", "patches", "table bytes", "topology ms", "tables ms", "total ms"];
        if with_peer {
            headings.extend(["peer total ms", "total / peer"]);
        }
        headings
    }

    fn cells(&self, with_peer: bool) -> Vec<String> {
        let mut cells = vec![self.level.to_string(), self.patches.to_string(), bytes_text(self.table_bytes)];
        cells.extend([self.topology_ms, self.tables_ms, self.total_ms].map(milliseconds_text));
        if with_peer {
            cells.push(self.peer_total_ms.map_or_else(|| "-".to_owned(), milliseconds_text));
            cells.push(ratio_text(self.ratio));
        }
        cells
    }
}
