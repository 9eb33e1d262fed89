//! OpenSubdiv's times: `osd_bench` (tools/bench) run on the same mesh, in the same view.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use planish_subdiv::mesh::BoundaryInterpolation;
use serde::{Deserialize, Serialize};

use super::Bench;
use crate::cage::Cage;
use crate::text_table::milliseconds_text;

/// Levels that OpenSubdiv isolates to.
const LEVELS: std::ops::RangeInclusive<u32> = 1..=10;

/// The program.
pub struct Peer {
    program: PathBuf,
}

/// Its median times of a frame, in milliseconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeerFrame {
    pub update_refine_ms: f64,
    pub draw_ms: f64,
    pub total_ms: f64,
}

impl PeerFrame {
    /// The times as text.
    pub fn cells(frame: Option<&Self>) -> [String; 3] {
        match frame {
            Some(frame) => [frame.update_refine_ms, frame.draw_ms, frame.total_ms].map(milliseconds_text),
            None => std::array::from_fn(|_| "-".to_owned()),
        }
    }
}

/// What it prints of its tables.
#[derive(Deserialize)]
struct PeerTables {
    preprocess_ms: PeerPreprocess,
}

/// The stages that planish has too, in milliseconds.
#[derive(Deserialize)]
struct PeerPreprocess {
    refiner: f64,
    refine_adaptive: f64,
    patch_table: f64,
    stencil_table: f64,
}

impl Peer {
    /// Looks for the program in a folder.
    pub fn find(folder: &Path) -> Result<Self> {
        let program = folder.join("osd_bench");
        ensure!(program.is_file(), "{}: there is no osd_bench; `make -C tools` builds it", folder.display());
        Ok(Self { program })
    }

    /// Times frames: isolation to `level`, tess factor `tess` with equal spacing.
    pub fn frame(&self, bench: &Bench, cage: &Cage, level: u32, tess: f32) -> Result<PeerFrame> {
        let [width, height] = bench.arguments.size.map(|pixels| pixels.to_string());
        let (tess, frames) = (tess.to_string(), bench.arguments.repeat.to_string());
        let text = self.run(cage, level, &["-t", &tess, "--frames", &frames, "--size", &width, &height])?;
        serde_json::from_str(&text).with_context(|| format!("{} printed no times", self.program.display()))
    }

    /// Times the building of its tables, in milliseconds.
    pub fn tables_ms(&self, cage: &Cage, level: u32) -> Result<f64> {
        let text = self.run(cage, level, &["--cpu-only"])?;
        let PeerTables { preprocess_ms: times } =
            serde_json::from_str(&text).with_context(|| format!("{} printed no times", self.program.display()))?;
        Ok(times.refiner + times.refine_adaptive + times.patch_table + times.stencil_table)
    }

    fn run(&self, cage: &Cage, level: u32, arguments: &[&str]) -> Result<String> {
        let level = level.clamp(*LEVELS.start(), *LEVELS.end()).to_string();
        let boundary = match cage.mesh()?.options.boundary {
            BoundaryInterpolation::None => "none",
            BoundaryInterpolation::EdgeOnly => "edge",
            BoundaryInterpolation::EdgeAndCorner => "edgecorner",
        };
        let program = || format!("cannot run {}", self.program.display());
        let output = Command::new(&self.program)
            .arg(cage.path())
            .args(["-l", &level, "--boundary", boundary])
            .args(arguments)
            .output()
            .with_context(program)?;
        if !output.status.success() {
            bail!("{}: {}", program(), String::from_utf8_lossy(&output.stderr).trim());
        }
        String::from_utf8(output.stdout).with_context(program)
    }
}
