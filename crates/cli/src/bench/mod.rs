//! `planish bench`: the surface methods side by side, and beside OpenSubdiv's own pipeline.
//!
//! | module | compares |
//! |---|---|
//! | `levels` | fas with uniform refinement, level by level: FAS section 8.1, Table I |
//! | `factors` | fas at several tess factors |
//! | `creases` | crease patches of every kind with refined creases |
//! | `seams` | frames whose seams have the same bits on both sides with frames of patches by themselves |
//! | `gregory` | both implementations of Gregory patches with fas, dfas, ACC and Pm-patches |
//! | `grids` | basis function tables with flat faces, Phong tessellation, PN triangles, fas and dfas |
//! | `path` | fas with dfas, along a camera path or from the scene's cameras; `chart` draws it |
//! | `cpu` | the building of tables alone |
//! | `cached` | the building of basis function tables with reading them |
//! | `measure` | what all of them measure of a frame |
//! | `peer` | OpenSubdiv's times for the same |

mod cached;
mod chart;
mod cpu;
mod creases;
mod factors;
mod gregory;
mod grids;
mod levels;
mod measure;
mod path;
mod peer;
mod seams;

use anyhow::Result;
use planish_gpu::Device;
use serde::Serialize;

use crate::args::{BenchArguments, SceneArguments};
use crate::cage::Cage;
use crate::console::{Console, print_output};
use crate::offline::{check_validation, open_device};
use crate::stats::DeviceStats;
use crate::text_table::TextTable;
use peer::Peer;

/// Runs the command.
pub fn run(arguments: &BenchArguments, console: &Console) -> Result<()> {
    let peer = arguments.peer.as_deref().map(Peer::find).transpose()?;
    let bench = Bench { arguments, console, peer };
    if arguments.cpu && arguments.tables {
        return bench.scenes(None, |cage| cached::run(&bench, cage));
    }
    if arguments.cpu {
        return bench.scenes(None, |cage| cpu::run(&bench, cage));
    }
    let device = open_device(&arguments.device, console)?;
    if arguments.path.is_some() || arguments.cameras {
        bench.scenes(Some(&device), |cage| path::run(&bench, &device, cage))?;
    } else if arguments.creases {
        bench.scenes(Some(&device), |cage| creases::run(&bench, &device, cage))?;
    } else if arguments.seams {
        bench.scenes(Some(&device), |cage| seams::run(&bench, &device, cage))?;
    } else if arguments.gregory {
        bench.scenes(Some(&device), |cage| gregory::run(&bench, &device, cage))?;
    } else if arguments.tables {
        bench.scenes(Some(&device), |cage| grids::run(&bench, &device, cage))?;
    } else if arguments.tess.is_empty() {
        bench.scenes(Some(&device), |cage| levels::run(&bench, &device, cage))?;
    } else {
        bench.scenes(Some(&device), |cage| factors::run(&bench, &device, cage))?;
    }
    check_validation(&device)
}

/// What is asked for.
struct Bench<'a> {
    arguments: &'a BenchArguments,
    console: &'a Console,
    peer: Option<Peer>,
}

/// The rows of a table.
trait Row: Serialize {
    /// The headings of the text table.
    fn headings(with_peer: bool) -> Vec<&'static str>;
    /// The cells under them.
    fn cells(&self, with_peer: bool) -> Vec<String>;
    /// Whether the text table has it.
    fn is_shown(&self) -> bool {
        true
    }
    /// What all rows come to.
    fn summary(_rows: &[Self]) -> Option<String>
    where
        Self: Sized,
    {
        None
    }
    /// What does not fit in a cell.
    fn note(&self) -> Option<String> {
        None
    }
}

/// What JSON output holds.
#[derive(Serialize)]
struct Report<R> {
    version: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    device: Option<DeviceStats>,
    size: [u32; 2],
    repeat: u32,
    scenes: Vec<SceneReport<R>>,
}

/// A scene's rows.
#[derive(Serialize)]
struct SceneReport<R> {
    scene: String,
    vertices: usize,
    faces: usize,
    rows: Vec<R>,
}

impl Bench<'_> {
    /// Runs every scene, and prints its table when it is done; or all in JSON at the end.
    fn scenes<R: Row>(&self, device: Option<&Device>, rows: impl Fn(&Cage) -> Result<Vec<R>>) -> Result<()> {
        let mut scenes = Vec::new();
        for path in &self.arguments.scenes {
            let mut cage = Cage::load(&SceneArguments::plain(path.clone(), self.arguments.repair), self.console)?;
            cage.displace(&self.arguments.displacement, self.console)?;
            let scene = SceneReport {
                scene: path.display().to_string(),
                vertices: cage.facts.vertices,
                faces: cage.facts.faces,
                rows: rows(&cage)?,
            };
            self.console.end_progress();
            if !self.arguments.json {
                let separator = if scenes.is_empty() { "" } else { "\n" };
                print_output(&(separator.to_owned() + &self.scene_text(&scene, device)))?;
            }
            scenes.push(scene);
        }
        if !self.arguments.json {
            return Ok(());
        }
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            device: device.map(DeviceStats::new),
            size: self.arguments.size,
            repeat: self.arguments.repeat,
            scenes,
        };
        print_output(&(serde_json::to_string_pretty(&report)? + "\n"))
    }

    fn scene_text<R: Row>(&self, scene: &SceneReport<R>, device: Option<&Device>) -> String {
        let where_it_ran = device.map_or_else(
            || "one thread of the CPU".to_owned(),
            |device| format!("{}, {}x{}", device.name(), self.arguments.size[0], self.arguments.size[1]),
        );
        let repeat = self.arguments.repeat;
        let SceneReport { scene: name, vertices, faces, rows } = scene;
        let mut text = format!("{name}: {vertices} vertices, {faces} faces; {where_it_ran}, medians of {repeat}\n");
        let with_peer = self.peer.is_some();
        let mut table = TextTable::new(&R::headings(with_peer));
        for row in rows.iter().filter(|row| row.is_shown()) {
            table.push(row.cells(with_peer));
        }
        text.push_str(&table.to_text());
        for note in rows.iter().filter_map(R::note) {
            text.push_str(&format!("{note}\n"));
        }
        if let Some(summary) = R::summary(rows) {
            text.push_str(&format!("{summary}\n"));
        }
        text
    }
}

/// The middle value, or the mean of the two; 0 of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.as_slice() {
        [] => 0.0,
        values if values.len() % 2 == 1 => values[values.len() / 2],
        values => 0.5 * (values[values.len() / 2 - 1] + values[values.len() / 2]),
    }
}

/// "0.62", or nothing.
fn ratio_text(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_does_not_mind_outliers() {
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(median(vec![3.0, 1.0, 100.0]), 3.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 100.0]), 3.0);
    }
}
