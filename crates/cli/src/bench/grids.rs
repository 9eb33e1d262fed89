//! Basis function tables beside the substitutes that the paper compares them with (Hollaender and Boubekeur 2010, Table I), and beside
//! feature-adaptive subdivision of the same cage.

use anyhow::Result;
use planish_gpu::Device;
use planish_render::density::isolation_level;
use planish_render::{SurfaceMethod, TableNormals, TableWeights};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::Tables;
use serde::Serialize;

use super::measure::{Measured, Setting, Timed};
use super::{Bench, Row};
use crate::cage::Cage;
use crate::text_table::milliseconds_text;

/// Segments along an edge of the cage at the paper's levels 2, 4 and 5.
const TESS_FACTORS: [f32; 3] = [4.0, 16.0, 32.0];

/// What is compared; the first is the measure of the others.
fn methods(is_of_triangles: bool) -> Vec<(&'static str, Setting)> {
    let setting = |method| Setting { method, is_culled: false, ..Setting::default() };
    let table = |scheme, table_normals| Setting { scheme, table_normals, ..setting(SurfaceMethod::Table) };
    let short = |setting| Setting { table_weights: TableWeights::Short, ..setting };
    let shading = TableNormals::Subdivision(1);
    let mut methods = vec![("flat", setting(SurfaceMethod::Flat)), ("phong", setting(SurfaceMethod::Phong))];
    if is_of_triangles {
        methods.extend([
            ("pn", setting(SurfaceMethod::Pn)),
            ("table loop", table(Scheme::Loop, TableNormals::Tangents)),
            ("table loop, Subdivision Shading", table(Scheme::Loop, shading)),
            ("table loop, 16 bits", short(table(Scheme::Loop, TableNormals::Tangents))),
            ("table butterfly", table(Scheme::Butterfly, TableNormals::Tangents)),
        ]);
    }
    methods.extend([
        ("table catmull-clark", table(Scheme::CatmullClark, TableNormals::Tangents)),
        ("table catmull-clark, Subdivision Shading", table(Scheme::CatmullClark, shading)),
        ("table catmull-clark, 16 bits", short(table(Scheme::CatmullClark, TableNormals::Tangents))),
        ("fas", setting(SurfaceMethod::Fas)),
        ("dfas", setting(SurfaceMethod::Dfas)),
    ]);
    methods
}

/// One method at one tess factor.
#[derive(Serialize)]
pub struct GridRow {
    tess: f32,
    method: &'static str,
    #[serde(flatten)]
    measured: Measured,
    /// Bytes of weights, indices and points that an evaluation shader reads for a point inside, in the mean; 0 for bicubic patches,
    /// whose 16 points are the control shader's.
    bytes_a_point: f64,
    /// Times over those of the first method.
    draw_ratio: f64,
    wall_ratio: f64,
}

/// Measures all methods at all factors, those asked for or the paper's.
pub fn run(bench: &Bench, device: &Device, cage: &Cage) -> Result<Vec<GridRow>> {
    let is_of_triangles = cage.meshes().iter().all(|mesh| mesh.face_sizes.iter().all(|&sides| sides == 3));
    let asked = bench.arguments.tess.as_slice();
    let mut rows = Vec::new();
    for &tess in if asked.is_empty() { &TESS_FACTORS } else { asked } {
        let mut of_factor = Vec::new();
        for (name, setting) in methods(is_of_triangles) {
            bench.console.progress(format_args!("{}: tess factor {tess}, {name}", cage.path().display()));
            let is_grid = setting.method.is_grid();
            let level = if is_grid { 0 } else { isolation_level(tess, bench.arguments.max_level) };
            of_factor.push((name, Timed::new(bench, device, cage, Setting { tess_factor: tess, level, ..setting })?));
        }
        for round in 1..=bench.arguments.repeat {
            bench.console.progress(format_args!("{}: tess factor {tess}, frame {round}", cage.path().display()));
            of_factor.iter_mut().try_for_each(|(_, timed)| timed.draw())?;
        }
        let of_factor: Vec<_> = of_factor.into_iter().map(|(name, timed)| (name, timed.measured())).collect();
        let (wall_ms, draw_ms) = (of_factor[0].1.wall_ms, of_factor[0].1.gpu_ms.draw);
        rows.extend(of_factor.into_iter().map(|(method, measured)| GridRow {
            tess,
            method,
            bytes_a_point: measured.grid_bytes,
            draw_ratio: measured.gpu_ms.draw / draw_ms,
            wall_ratio: measured.wall_ms / wall_ms,
            measured,
        }));
    }
    Ok(rows)
}

/// Bytes that are read for a point inside a face, in the mean over the faces.
pub fn bytes_a_point(tables: &Tables, normals: TableNormals, weights: TableWeights) -> f64 {
    /// An index and a point; and a normal of it.
    const POINT: u32 = 4 + 12;
    const NORMAL: u32 = 12;
    let weight = if weights == TableWeights::Short { 2 } else { 4 };
    let basis = &tables.basis;
    let of_control = match normals {
        _ if basis.weights.is_empty() => POINT + NORMAL,
        TableNormals::Tangents => POINT + 3 * weight,
        TableNormals::Subdivision(_) => POINT + weight + NORMAL,
        TableNormals::Geometric => POINT + weight,
    };
    let controls: u64 = basis.patches.iter().map(|patch| u64::from(patch.control_count)).sum();
    f64::from(of_control) * controls as f64 / (basis.patches.len().max(1) as f64)
}

impl Row for GridRow {
    fn headings(_with_peer: bool) -> Vec<&'static str> {
        vec![
            "tess",
            "method",
            "patches",
            "triangles",
            "TES runs",
            "bytes / point",
            "table bytes",
            "draw ms",
            "wall ms",
            "draw / flat",
            "wall / flat",
        ]
    }

    fn cells(&self, _with_peer: bool) -> Vec<String> {
        let measured = &self.measured;
        let mut cells = vec![self.tess.to_string(), self.method.to_owned()];
        let counts = [measured.patch_count(), measured.triangles, measured.tessellation.evaluations];
        cells.extend(counts.map(|count| count.to_string()));
        cells.push(format!("{:.0}", self.bytes_a_point));
        cells.push(measured.table_bytes.to_string());
        cells.extend([measured.gpu_ms.draw, measured.wall_ms].map(milliseconds_text));
        cells.extend([self.draw_ratio, self.wall_ratio].map(|ratio| format!("{ratio:.2}")));
        cells
    }
}
