//! The JSON of `--stats`.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use planish_film::{check_text_output, write_text};
use planish_gpu::{Device, SubmitReport};
use planish_render::SurfaceMethod;
use planish_subdiv::selection::PatchCounts;
use serde::Serialize;

use crate::cage::Cage;
use crate::console::print_output;
use crate::offline::{Drawn, Session};
use crate::split::Split;

/// The path that stands for standard output.
const STANDARD_OUTPUT: &str = "-";

/// Counts and times of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Stats {
    pub version: &'static str,
    pub device: DeviceStats,
    pub method: &'static str,
    pub scheme: &'static str,
    pub scene: String,
    pub mesh: MeshStats,
    pub preprocess_ms: PreprocessStats,
    pub memory_bytes: MemoryStats,
    pub table_configurations: TableStats,
    pub frames: Vec<FrameStats>,
    /// Where the time of all samples went, of `render`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub split_ms: Option<Split>,
}

/// What ran it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DeviceStats {
    pub name: String,
    pub driver: String,
    #[serde(rename = "type")]
    pub kind: String,
}

impl DeviceStats {
    /// Of a device.
    pub fn new(device: &Device) -> Self {
        Self { name: device.name().to_owned(), driver: device.driver().to_owned(), kind: device.kind().to_string() }
    }
}

/// The cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MeshStats {
    pub vertices: u64,
    pub faces: u64,
    pub irregular_faces: u64,
    pub extraordinary_vertices: u64,
}

/// Milliseconds of the work done once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PreprocessStats {
    pub load: f64,
    pub topology: f64,
    pub tables: f64,
    pub upload: f64,
    pub pipelines: f64,
}

/// Bytes on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MemoryStats {
    pub tables: u64,
    pub points: u64,
    pub lists: u64,
    pub images: u64,
}

/// Where tables of configurations came from, of method table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TableStats {
    pub read: u64,
    pub built: u64,
}

/// One frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameStats {
    pub frame: i32,
    pub patches: PatchStats,
    /// Tessellator patches that the transition patches were drawn as.
    pub subpatches: u64,
    /// Of all kinds.
    pub patches_by_level: Vec<u64>,
    pub triangles: u64,
    /// Points and limit points that were computed.
    pub points: u64,
    /// Commands that the frame was recorded with.
    pub calls: CallStats,
    pub gpu_ms: GpuStats,
    /// From cage upload to fence, in milliseconds.
    pub wall_ms: f64,
}

/// Commands of a frame: as many whatever is in view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CallStats {
    pub dispatches: u32,
    pub draws: u32,
}

/// Patches by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PatchStats {
    pub regular: u64,
    pub transition: u64,
    pub quad: u64,
    /// Gregory patches of 20 points.
    pub gregory_quad: u64,
    /// Gregory triangles, of 15.
    pub gregory_triangle: u64,
    /// Faces that were evaluated by table.
    pub table: u64,
    /// How many of the quads are as large as they are only because refinement had to end.
    pub truncated: u64,
}

/// Milliseconds by timestamp queries; 0 where a method lacks the stage or a device timestamps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct GpuStats {
    /// Cages copied, and deformed.
    pub animate: f64,
    pub density: f64,
    pub select: f64,
    pub subdivide: f64,
    pub limit: f64,
    pub emit: f64,
    pub draw: f64,
    /// Shadow maps, shading and sums of samples.
    pub shade: f64,
    pub total: f64,
}

impl GpuStats {
    /// From the times since the first of them: `start`, then one at the end of each stage, named after it.
    pub fn new(timestamps: &[(String, f64)]) -> Self {
        let mut stats = Self::default();
        for [(_, start), (stage, end)] in timestamps.array_windows() {
            let milliseconds = end - start;
            match stage.as_str() {
                "animate" => stats.animate += milliseconds,
                "density" => stats.density += milliseconds,
                "select" => stats.select += milliseconds,
                "subdivide" => stats.subdivide += milliseconds,
                "limit" => stats.limit += milliseconds,
                "emit" => stats.emit += milliseconds,
                "draw" => stats.draw += milliseconds,
                "shade" => stats.shade += milliseconds,
                _ => {}
            }
        }
        stats.total = timestamps.last().map_or(0.0, |(_, end)| *end);
        stats
    }
}

impl FrameStats {
    /// Of a frame that was drawn into an image.
    pub fn drawn(frame: i32, session: &Session, drawn: &Drawn) -> Self {
        Self::new(frame, session, drawn, drawn_triangle_count(&drawn.report).unwrap_or(0))
    }

    /// Of a frame of so many triangles.
    pub fn new(frame: i32, session: &Session, drawn: &Drawn, triangles: u64) -> Self {
        let tables = session.surface.tables();
        let level_count = tables.last_level as usize + 1;
        let mut counts = drawn.status.patch_counts(level_count);
        if session.surface.desc().method == SurfaceMethod::Uniform {
            counts[level_count - 1].filling = tables.filling.len() as u32;
        }
        let sum = |of: fn(&PatchCounts) -> u32| counts.iter().map(|level| u64::from(of(level))).sum();
        // Gregory patches are as fine as others.
        let has_gregory = session.surface.desc().has_gregory_patches();
        let transition = sum(|level| level.transition);
        // Levels that no patch is of are not told, but level 0 is.
        let count = |c: &PatchCounts| u64::from(c.total());
        let used = counts.iter().rposition(|level| count(level) > 0).map_or(1, |level| level + 1);
        Self {
            frame,
            patches: PatchStats {
                regular: sum(|level| level.regular),
                transition,
                quad: sum(|level| level.filling),
                gregory_quad: sum(|level| level.gregory),
                gregory_triangle: sum(|level| level.triangle),
                table: sum(|level| level.table),
                truncated: if has_gregory { 0 } else { u64::from(drawn.status.counts.truncated) },
            },
            subpatches: transition,
            patches_by_level: counts[..used].iter().map(count).collect(),
            triangles,
            points: drawn.status.computed_points(session.surface.phases().rows.len()),
            calls: CallStats { dispatches: drawn.calls.dispatches, draws: drawn.calls.draws },
            gpu_ms: GpuStats::new(&drawn.report.timestamps),
            wall_ms: drawn.wall_ms,
        }
    }
}

/// Triangles that a frame's draws sent to the rasterizer, where the device counts them.
fn drawn_triangle_count(report: &SubmitReport) -> Option<u64> {
    let counted = report.statistics.iter().filter(|(name, _)| name == "draw");
    counted.map(|(_, statistics)| statistics.clipping_invocations).reduce(|a, b| a + b)
}

impl Stats {
    /// Of a run; `image_bytes` on the device.
    pub fn new(cage: &Cage, session: &Session, image_bytes: u64, frames: Vec<FrameStats>) -> Self {
        let (times, memory) = (session.surface.times(), session.surface.memory());
        Self {
            version: env!("CARGO_PKG_VERSION"),
            device: DeviceStats::new(&session.device),
            method: method_name(session.surface.desc().method),
            scheme: session.surface.desc().scheme.name(),
            scene: cage.path().display().to_string(),
            mesh: MeshStats {
                vertices: cage.facts.vertices as u64,
                faces: cage.facts.faces as u64,
                irregular_faces: cage.facts.irregular_faces,
                extraordinary_vertices: cage.facts.extraordinary_vertices,
            },
            preprocess_ms: PreprocessStats {
                load: cage.load_ms,
                topology: times.topology,
                tables: times.tables,
                upload: times.upload,
                pipelines: session.pipelines_ms,
            },
            memory_bytes: MemoryStats {
                tables: memory.tables,
                points: memory.points,
                lists: memory.lists,
                images: image_bytes,
            },
            table_configurations: TableStats { read: session.basis_counts.read, built: session.basis_counts.built },
            frames,
            split_ms: None,
        }
    }
}

/// The method as it is written on the command line.
pub fn method_name(method: SurfaceMethod) -> &'static str {
    match method {
        SurfaceMethod::Fas => "fas",
        SurfaceMethod::Dfas => "dfas",
        SurfaceMethod::Gregory => "gregory",
        SurfaceMethod::Acc => "acc",
        SurfaceMethod::Pm => "pm",
        SurfaceMethod::Uniform => "uniform",
        SurfaceMethod::Table => "table",
        SurfaceMethod::Flat => "flat",
        SurfaceMethod::Phong => "phong",
        SurfaceMethod::Pn => "pn",
    }
}

/// Where the stats go.
pub struct StatsOutput<'a>(pub Option<&'a PathBuf>);

impl StatsOutput<'_> {
    /// Whether they could be written now, and not over one of the results.
    pub fn check<'p>(&self, mut results: impl Iterator<Item = &'p Path>) -> Result<()> {
        match self.0 {
            Some(path) if results.any(|result| result == path) => {
                bail!("{}: --stats names the same file as -o", path.display())
            }
            Some(path) if !is_standard_output(path) => Ok(check_text_output(path)?),
            _ => Ok(()),
        }
    }

    /// Writes them, whole or not at all.
    pub fn write(&self, stats: &Stats) -> Result<()> {
        let Some(path) = self.0 else { return Ok(()) };
        let mut text = serde_json::to_string_pretty(stats)?;
        text.push('\n');
        if is_standard_output(path) {
            return print_output(&text);
        }
        Ok(write_text(&text, path)?)
    }
}

fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == STANDARD_OUTPUT
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    #[test]
    fn the_shape_is_the_interface_s() {
        let stats = Stats { frames: vec![FrameStats::default()], ..Stats::default() };
        let json = serde_json::to_value(&stats).unwrap();
        let sorted = |mut names: Vec<&'static str>| {
            names.sort_unstable();
            names
        };
        let expected = sorted(vec![
            "version",
            "device",
            "method",
            "scheme",
            "scene",
            "mesh",
            "preprocess_ms",
            "memory_bytes",
            "table_configurations",
            "frames",
        ]);
        assert_eq!(keys(&json), expected);
        assert_eq!(keys(&json["device"]), ["driver", "name", "type"]);
        assert_eq!(keys(&json["mesh"]), ["extraordinary_vertices", "faces", "irregular_faces", "vertices"]);
        assert_eq!(keys(&json["preprocess_ms"]), ["load", "pipelines", "tables", "topology", "upload"]);
        assert_eq!(keys(&json["memory_bytes"]), ["images", "lists", "points", "tables"]);
        assert_eq!(keys(&json["table_configurations"]), ["built", "read"]);
        let frame = &json["frames"][0];
        let expected = sorted(vec![
            "frame",
            "patches",
            "subpatches",
            "patches_by_level",
            "triangles",
            "points",
            "calls",
            "gpu_ms",
            "wall_ms",
        ]);
        assert_eq!(keys(frame), expected);
        let kinds = ["gregory_quad", "gregory_triangle", "quad", "regular", "table", "transition", "truncated"];
        assert_eq!(keys(&frame["patches"]), kinds);
        assert_eq!(
            keys(&frame["gpu_ms"]),
            ["animate", "density", "draw", "emit", "limit", "select", "shade", "subdivide", "total"]
        );
        assert_eq!(frame["triangles"], json!(0));
    }

    #[test]
    fn stages_last_from_the_time_before_to_their_own() {
        let times = [("start", 0.0), ("subdivide", 2.0), ("limit", 2.5), ("emit", 3.0), ("draw", 10.0)];
        let stats = GpuStats::new(&times.map(|(name, time)| (name.to_owned(), time)));
        assert_eq!((stats.subdivide, stats.limit, stats.emit, stats.draw), (2.0, 0.5, 0.5, 7.0));
        assert_eq!(stats.total, 10.0);
        assert_eq!(GpuStats::new(&[]), GpuStats::default());
    }

    #[test]
    fn stats_are_written_whole_and_over_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stats.json");
        std::fs::write(&path, "old").unwrap();
        let output = StatsOutput(Some(&path));
        output.check(std::iter::empty()).unwrap();
        output.write(&Stats::default()).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(serde_json::from_str::<Value>(&text).is_ok());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn stats_do_not_replace_a_result_or_a_device() {
        let path = PathBuf::from("surface.ply");
        assert!(StatsOutput(Some(&path)).check([path.as_path()].into_iter()).is_err());
        assert!(StatsOutput(Some(&PathBuf::from("/dev/null"))).check(std::iter::empty()).is_err());
    }

    #[test]
    fn a_folder_that_is_not_there_is_found_out_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("absent").join("stats.json");
        assert!(StatsOutput(Some(&path)).check(std::iter::empty()).unwrap_err().to_string().contains("absent"));
        assert!(StatsOutput(Some(&folder.path().to_owned())).check(std::iter::empty()).is_err());
    }
}
