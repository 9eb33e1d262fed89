//! A dump against OpenSubdiv's limit surface, by `osd_oracle`.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::repository::tool;

/// Largest error of a position, over the largest coordinate magnitude of the cage.
pub const POSITION_TOLERANCE: f64 = 2e-6;
/// The same at corners for which OpenSubdiv's own limit masks are no better (`tools/README.md`, "odd").
const ODD_CORNER_TOLERANCE: f64 = 1e-3;
/// Largest error of a face-varying value, over the largest magnitude of one.
pub const VALUE_TOLERANCE: f64 = 2e-6;
/// How many times the tolerance a normal may be off where tangents are nearly parallel.
const SLIVER_NORMAL_RATIO: f64 = 10.0;
/// How far the covered parameter area of a face may be from 1.
pub const AREA_TOLERANCE: f64 = 1e-5;
/// Counts that must be 0: whatever is wrong there is not a matter of precision.
const FORBIDDEN: [&str; 7] = [
    "normals_over_90deg",
    "nonfinite_positions",
    "bad_face_or_uv",
    "on_faces_without_limit",
    "uv_flipped_triangles",
    "mixed_face_triangles",
    "bad_index_triangles",
];

/// What the oracle says about a dump.
pub struct Report(Value);

impl Report {
    /// Compares a dump with the mesh that it was made of.
    pub fn of(mesh: &Path, dump: &Path) -> Result<Self, String> {
        Self::with(mesh, dump, &[])
    }

    /// Compares the face-varying values of a dump alone.
    pub fn of_values(mesh: &Path, dump: &Path) -> Result<Self, String> {
        Self::with(mesh, dump, &["--st"])
    }

    fn with(mesh: &Path, dump: &Path, flags: &[&str]) -> Result<Self, String> {
        let mut command = Command::new(tool("osd_oracle"));
        command.args([mesh, dump]).args(["-j", "1"]).args(flags);
        let output = command.output().map_err(|error| format!("osd_oracle: {error}"))?;
        let json = serde_json::from_slice(&output.stdout).ok().filter(|_| output.status.success());
        json.map(Self).ok_or_else(|| {
            let told = String::from_utf8_lossy(&output.stderr);
            format!("osd_oracle {} {}: {}: {told}", mesh.display(), dump.display(), output.status)
        })
    }

    /// A number of the report.
    pub fn number(&self, field: &str) -> f64 {
        let value = field.split('.').fold(&self.0, |value, name| &value[name]);
        value.as_f64().unwrap_or_else(|| panic!("osd_oracle reports no number {field}"))
    }

    /// What is wrong with face-varying values, all of which must have been judged.
    pub fn value_faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (field, most) in [("max_st_err", VALUE_TOLERANCE), ("nonfinite_st", 0.0)] {
            if self.number(field) > most {
                faults.push(format!("{field} is {}, expected at most {most}", self.number(field)));
            }
        }
        if self.number("st_compared") != self.number("vertices") {
            faults.push(format!("{} of {} are compared", self.number("st_compared"), self.number("vertices")));
        }
        if !faults.is_empty() {
            faults.push(format!("the worst is {}", self.0["worst_st"]));
        }
        faults
    }

    /// All that is wrong. The dump may leave out `absent_faces` Ptex faces.
    pub fn faults(&self, absent_faces: usize) -> Vec<String> {
        let special = self.number("special_corners.sharp_irregular") + self.number("special_corners.odd");
        self.faults_with(absent_faces, special, 1.0)
    }

    /// The same for a surface that is folded flat or has slivers: there need not be a normal, and where tangents are
    /// nearly parallel it loses more digits.
    pub fn faults_but_degenerate_normals(&self, absent_faces: usize) -> Vec<String> {
        self.faults_with(absent_faces, f64::INFINITY, SLIVER_NORMAL_RATIO)
    }

    fn faults_with(&self, absent_faces: usize, missing_normals: f64, normal_ratio: f64) -> Vec<String> {
        // A face that is not there covers nothing.
        let area_tolerance = if absent_faces == 0 { AREA_TOLERANCE } else { 1.0 };
        let most = [
            ("max_pos_err_rel_ordinary", POSITION_TOLERANCE),
            ("max_pos_err_rel", ODD_CORNER_TOLERANCE),
            ("worst_normal_ratio", normal_ratio),
            ("uv_area_max_dev", area_tolerance),
            ("dump_normal_bad", missing_normals),
            ("oracle_normal_degenerate", missing_normals),
        ];
        let mut faults: Vec<String> = FORBIDDEN
            .map(|field| (field, 0.0))
            .into_iter()
            .chain(most)
            .filter(|&(field, most)| self.number(field) > most)
            .map(|(field, most)| format!("{field} is {}, expected at most {most}", self.number(field)))
            .collect();
        for (field, expected) in [("ptex_faces_uncovered", absent_faces as f64), ("compared", self.number("vertices"))]
        {
            if self.number(field) != expected {
                faults.push(format!("{field} is {}, expected {expected}", self.number(field)));
            }
        }
        if self.number("compared") == 0.0 {
            faults.push("nothing was compared".to_owned());
        }
        if faults.iter().any(|fault| fault.contains("pos")) {
            faults.push(format!("worst position {}", self.0["worst_pos"]));
        }
        if faults.iter().any(|fault| fault.contains("normal")) {
            faults.push(format!("worst normal {}", self.0["worst_normal"]));
        }
        faults
    }
}
