//! Fas against uniform refinement, level by level (FAS section 8.1, Table I): the irregularities isolated to level L and
//! drawn at tess factor 2^L, against all faces refined to level L and drawn as triangles.

use anyhow::{Error, Result};
use planish_gpu::{Device, Error as GpuError};
use planish_render::{Error as RenderError, SurfaceMethod};
use planish_subdiv::ControlMesh;
use planish_subdiv::refine::CreasePatches;
use serde::Serialize;

use super::measure::{Measured, Setting, measure};
use super::peer::PeerFrame;
use super::{Bench, Row, ratio_text};
use crate::cage::Cage;
use crate::text_table::{bytes_text, milliseconds_text};

/// Bytes of device memory that uniform refinement takes for each face of its last level: 112 for a quad, its place in the
/// list, and a limit point with its row of nine; and 49 for a point with its row of six or seven, of which the levels
/// together have four thirds as many.
const UNIFORM_BYTES_A_FACE: u64 = 112 + 49 * 4 / 3;

/// One level.
#[derive(Serialize)]
pub struct LevelRow {
    level: u32,
    fas: Measured,
    uniform: Option<Measured>,
    /// Why uniform refinement was not measured.
    uniform_skipped: Option<String>,
    /// The total time of uniform refinement over that of fas.
    ratio: Option<f64>,
    peer: Option<PeerFrame>,
}

/// Measures all levels asked for.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<LevelRow>> {
    let row = |level: u32| {
        let tess_factor = (level as f32).exp2();
        let (crease_patches, watertight) = (CreasePatches::default(), !bench.arguments.no_watertight);
        let setting = |method| Setting { method, level, tess_factor, crease_patches, watertight, ..Setting::default() };
        bench.console.progress(format_args!("{}: fas, level {level}", cage.path().display()));
        let fas = measure(bench, device, cage, setting(SurfaceMethod::Fas))?;
        bench.console.progress(format_args!("{}: uniform, level {level}", cage.path().display()));
        let uniform = match refusal(cage.mesh()?, level, device.memory_budget()) {
            Some(reason) => Err(reason),
            None => match measure(bench, device, cage, setting(SurfaceMethod::Uniform)) {
                Ok(measured) => Ok(measured),
                Err(error) if is_out_of_memory(&error) => Err(format!("{error:#}")),
                Err(error) => return Err(error),
            },
        };
        let peer = bench.peer.as_ref().map(|peer| peer.frame(bench, cage, level, tess_factor)).transpose()?;
        let ratio = uniform.as_ref().ok().map(|uniform| uniform.gpu_ms.total / fas.gpu_ms.total);
        let uniform_skipped = uniform.as_ref().err().cloned();
        Ok(LevelRow { level, fas, uniform: uniform.ok(), uniform_skipped, ratio, peer })
    };
    bench.arguments.levels.clone().map(row).collect()
}

/// Why uniform refinement to a level would not fit the memory, if so.
fn refusal(mesh: &ControlMesh, level: u32, budget: u64) -> Option<String> {
    // A face of n sides has n children, and each of those four.
    let faces = match level.checked_sub(1) {
        None => mesh.face_sizes.len() as u64,
        Some(halvings) => (mesh.face_vertices.len() as u64) << (2 * halvings),
    };
    let bytes = faces.saturating_mul(UNIFORM_BYTES_A_FACE);
    let message = || format!("about {} needed, the memory budget is {}", bytes_text(bytes), bytes_text(budget));
    (bytes > budget).then(message)
}

fn is_out_of_memory(error: &Error) -> bool {
    use GpuError::{NoMemory, OutOfBudget, OverLimit};
    matches!(error.downcast_ref(), Some(RenderError::Gpu(NoMemory { .. } | OutOfBudget { .. } | OverLimit { .. })))
}

impl Row for LevelRow {
    fn headings(with_peer: bool) -> Vec<&'static str> {
        let method = ["triangles", "draw ms", "total ms"];
        let mut headings = vec!["level", "fas patches"];
        headings.extend(method);
        headings.push("uniform quads");
        headings.extend(method);
        headings.push("uniform / fas");
        if with_peer {
            headings.extend(["peer refine ms", "peer draw ms", "peer total ms"]);
        }
        headings
    }

    fn cells(&self, with_peer: bool) -> Vec<String> {
        let mut cells = vec![self.level.to_string()];
        cells.extend(method_cells(Some(&self.fas)));
        cells.extend(method_cells(self.uniform.as_ref()));
        cells.push(ratio_text(self.ratio));
        if with_peer {
            cells.extend(PeerFrame::cells(self.peer.as_ref()));
        }
        cells
    }

    fn note(&self) -> Option<String> {
        let reason = self.uniform_skipped.as_ref()?;
        Some(format!("uniform refinement to level {} was skipped: {reason}", self.level))
    }
}

fn method_cells(measured: Option<&Measured>) -> [String; 4] {
    let Some(measured) = measured else { return std::array::from_fn(|_| "-".to_owned()) };
    [
        measured.patch_count().to_string(),
        measured.triangles.to_string(),
        milliseconds_text(measured.gpu_ms.draw),
        milliseconds_text(measured.gpu_ms.total),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_refinement_that_cannot_fit_is_refused_before_it_is_tried() {
        let mesh = ControlMesh { face_sizes: vec![4; 1000], face_vertices: vec![0; 4000], ..ControlMesh::default() };
        let needed = 256_000 * UNIFORM_BYTES_A_FACE;
        assert_eq!(refusal(&mesh, 4, needed), None);
        assert!(refusal(&mesh, 4, needed - 1).unwrap().contains("43.2 MiB needed"));
        assert_eq!(refusal(&mesh, 0, 1000 * UNIFORM_BYTES_A_FACE), None);
    }
}
