//! What a comparison found, as a table and as JSON.

use serde::Serialize;

use super::deviation::{Moments, Place, Summary};
use crate::text_table::TextTable;

/// All that is told.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub a: Described,
    pub b: Described,
    /// Ptex faces of both dumps, which alone are compared parametrically.
    pub common_faces: usize,
    /// Diagonal of the box around B.
    pub diagonal: f64,
    pub parametric: Measured,
    /// Absent without samples.
    pub nearest: Option<NearestReport>,
}

/// One of the dumps.
#[derive(Clone, Debug, Serialize)]
pub struct Described {
    pub path: String,
    pub triangles: usize,
    /// Ptex faces that the other lacks.
    pub other_faces: usize,
    pub area: f64,
}

/// Nearest points.
#[derive(Clone, Debug, Serialize)]
pub struct NearestReport {
    /// On each surface.
    pub samples: u32,
    pub a_to_b: Measured,
    pub b_to_a: Measured,
    /// The greater of each.
    pub both: Measured,
}

/// Deviations in the units in which they are read.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measured {
    pub distance: Moments,
    /// Of the diagonal.
    pub distance_percent: Figures,
    pub normal_radians: Moments,
    pub normal_degrees: Figures,
}

/// [`Moments`] in other units.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Figures {
    pub rms: f64,
    pub mean: f64,
    pub max: f64,
}

impl Figures {
    fn scaled(moments: Moments, scale: f64) -> Self {
        Self { rms: scale * moments.rms, mean: scale * moments.mean, max: scale * moments.max }
    }

    fn cells(self) -> [String; 3] {
        [self.rms, self.mean, self.max].map(number)
    }
}

impl Measured {
    pub fn new(summary: Summary, diagonal: f64) -> Self {
        let Summary { distance, normal } = summary;
        Self {
            distance,
            distance_percent: Figures::scaled(distance, 100.0 / diagonal),
            normal_radians: normal,
            normal_degrees: Figures::scaled(normal, 1_f64.to_degrees()),
        }
    }

    /// Distance, its part of the diagonal, and the angles.
    fn rows(self, name: &str) -> [(String, [String; 3], Option<Place>); 4] {
        [
            ("distance", Figures::scaled(self.distance, 1.0), Some(self.distance.at)),
            ("distance, % of diagonal", self.distance_percent, None),
            ("normals, radians", Figures::scaled(self.normal_radians, 1.0), Some(self.normal_radians.at)),
            ("normals, degrees", self.normal_degrees, None),
        ]
        .map(|(what, figures, place)| (format!("{name}: {what}"), figures.cells(), place))
    }
}

impl Report {
    pub fn to_text(&self) -> String {
        let mut table = TextTable::new(&["", "rms", "mean", "max", "max at face, u, v"]);
        let mut add = |name: &str, measured: Measured| {
            for (what, cells, place) in measured.rows(name) {
                let place =
                    place.map_or(String::new(), |place| format!("{}, {:.6}, {:.6}", place.face, place.u, place.v));
                table.push([vec![what], cells.to_vec(), vec![place]].concat());
            }
        };
        add("same (face, u, v)", self.parametric);
        if let Some(nearest) = &self.nearest {
            add("nearest, A to B", nearest.a_to_b);
            add("nearest, B to A", nearest.b_to_a);
            add("nearest, greater", nearest.both);
        }
        let dump = |name: &str, dump: &Described| {
            format!("{name}  {}: {} triangles, area {}\n", dump.path, dump.triangles, number(dump.area))
        };
        format!(
            "{}{}{} common faces, diagonal of B's box {}{}\n\n{}",
            dump("A", &self.a),
            dump("B", &self.b),
            self.common_faces,
            number(self.diagonal),
            self.nearest.as_ref().map_or(String::new(), |nearest| format!(", {} samples", nearest.samples)),
            table.to_text()
        )
    }
}

/// Four digits, whatever the size.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value) {
        let decimals = (3.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 6.0);
        format!("{value:.0$}", if value == 0.0 { 0 } else { decimals as usize })
    } else {
        format!("{value:.3e}")
    }
}
