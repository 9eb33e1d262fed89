//! Basis function tables built from the rules, and read from a cache on disk, on one thread of the CPU.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use planish_render::{SurfaceDesc, SurfaceMethod, preprocess_cached};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisCache, BasisCounts, NoCache};
use serde::Serialize;

use super::{Bench, Row, median};
use crate::cage::Cage;
use crate::table_cache::TableCache;
use crate::text_table::{bytes_text, milliseconds_text};

/// One scheme.
#[derive(Serialize)]
pub struct CachedRow {
    scheme: &'static str,
    /// Distinct ones, of faces, edges and vertices.
    configurations: u64,
    /// Of all files.
    cache_bytes: u64,
    built_ms: f64,
    /// With the files written.
    stored_ms: f64,
    read_ms: f64,
    /// Built without a cache over read.
    ratio: f64,
}

/// Measures all schemes that take the faces, in turns: each round has a new folder.
pub fn run(bench: &Bench, cage: &Cage) -> Result<Vec<CachedRow>> {
    let takes =
        |scheme: Scheme| cage.meshes().iter().all(|mesh| mesh.face_sizes.iter().all(|&sides| scheme.accepts(sides)));
    Scheme::ALL.into_iter().filter(|&scheme| takes(scheme)).map(|scheme| row(bench, cage, scheme)).collect()
}

fn row(bench: &Bench, cage: &Cage, scheme: Scheme) -> Result<CachedRow> {
    let desc = SurfaceDesc { method: SurfaceMethod::Table, scheme, ..SurfaceDesc::default() };
    let time = |cache: &dyn BasisCache| -> Result<(f64, BasisCounts)> {
        let made =
            preprocess_cached(&cage.meshes(), &desc, cache).with_context(|| cage.path().display().to_string())?;
        Ok((made.times.tables, made.basis_counts))
    };
    let (mut built, mut stored, mut read) = (Vec::new(), Vec::new(), Vec::new());
    let (mut configurations, mut cache_bytes) = (0, 0);
    for round in 0..=bench.arguments.repeat {
        bench.console.progress(format_args!("{}: tables of {}, {round}", cage.path().display(), scheme.name()));
        let folder = tempfile::tempdir()?;
        let cache = TableCache::new(Some(folder.path()), bench.console);
        built.push(time(&NoCache)?.0);
        stored.push(time(&cache)?.0);
        let (ms, counts) = time(&cache)?;
        read.push(ms);
        configurations = counts.read;
        cache_bytes = folder_bytes(folder.path())?;
    }
    // The first is not timed.
    let [built_ms, stored_ms, read_ms] = [built, stored, read].map(|times| median(times[1..].to_vec()));
    let ratio = built_ms / read_ms;
    Ok(CachedRow { scheme: scheme.name(), configurations, cache_bytes, built_ms, stored_ms, read_ms, ratio })
}

fn folder_bytes(folder: &Path) -> Result<u64> {
    fs::read_dir(folder)?.map(|entry| Ok(entry?.metadata()?.len())).sum()
}

impl Row for CachedRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec!["scheme", "configurations", "cache", "built ms", "built and stored ms", "read ms", "built / read"]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let mut cells = vec![self.scheme.to_owned(), self.configurations.to_string(), bytes_text(self.cache_bytes)];
        cells.extend([self.built_ms, self.stored_ms, self.read_ms].map(milliseconds_text));
        cells.push(format!("{:.1}", self.ratio));
        cells
    }
}
