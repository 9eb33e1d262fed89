//! A stage whose prims are counted before the crate composes them.
use std::ops::Deref;

use openusd::{sdf, usd};

use super::resolver::{Checked, Findings};
use crate::gltf::fault::Fault;

/// A stage whose prims are counted before the crate composes them.
pub struct Stage {
    stage: usd::Stage,
    findings: Findings,
}

impl Stage {
    /// Opens the stage of a file, whose name is UTF-8.
    pub fn open(name: &str, findings: &Findings) -> Result<Self, Fault> {
        let stage = usd::Stage::builder().resolver(Checked::new(findings)).open(name);
        let stage = stage.map_err(|error| Fault::new("layers", format!("{error:#}"), "a USD file that can be read"))?;
        Ok(Self { stage, findings: findings.clone() })
    }

    /// A prim that may be composed.
    pub fn prim(&self, path: impl Into<sdf::Path>) -> Result<usd::Prim, Fault> {
        let prim = self.stage.prim(path);
        self.findings.check_places(prim.path().as_str())?;
        // Composed now: layers that are opened on the way are counted for the prim that was asked for last. What fails is told by
        // whoever reads it.
        let _ = prim.specifier();
        Ok(prim)
    }

    /// The children of a prim, which may be composed too.
    pub fn children(&self, prim: &usd::Prim) -> Result<Vec<usd::Prim>, Fault> {
        let names = prim.child_names();
        let names = names.map_err(|error| {
            Fault::new(prim.path().as_str(), error.to_string(), "a prim whose children can be read")
        })?;
        names
            .iter()
            .filter_map(|name| prim.path().append_path(name.as_str()).ok())
            .map(|path| self.prim(path))
            .collect()
    }

    /// How many bytes all layers have so far.
    pub fn bytes(&self) -> u64 {
        self.findings.bytes()
    }
}

impl Deref for Stage {
    type Target = usd::Stage;

    fn deref(&self) -> &usd::Stage {
        &self.stage
    }
}
