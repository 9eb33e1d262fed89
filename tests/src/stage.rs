//! Small USD stages, seen by a camera that shows a square of four by four at z = 0.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Frames a second of a stage.
pub const RATE: f64 = 48.0;
/// Half of what the camera sees of the plane z = 0, from the middle to an edge of the image.
pub const HALF: f64 = 2.0;
/// How far that plane is from it.
pub const DISTANCE: f64 = 10.0;

/// A stage under construction.
#[derive(Default)]
pub struct Stage(String);

impl Stage {
    /// With a camera of these lines more at (0, 0, 10), which looks along -z.
    pub fn new(camera: &str) -> Self {
        Self(String::new()).with(&format!(
            r#"def Camera "eye" {{
    float focalLength = 50
    float verticalAperture = 20
    double3 xformOp:translate = (0, 0, {DISTANCE})
    uniform token[] xformOpOrder = ["xformOp:translate"]
    {camera}
}}"#
        ))
    }

    /// With another prim.
    #[must_use]
    pub fn with(mut self, prim: &str) -> Self {
        writeln!(self.0, "{prim}").expect("a string takes what is written");
        self
    }

    /// With a rectangle that faces +z, from a corner to the other, of these lines more.
    #[must_use]
    pub fn with_rectangle(
        self,
        name: &str,
        [left, low]: [f64; 2],
        [right, high]: [f64; 2],
        z: f64,
        more: &str,
    ) -> Self {
        self.with(&format!(
            r#"def Mesh "{name}" {{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [({left}, {low}, {z}), ({right}, {low}, {z}), ({right}, {high}, {z}), ({left}, {high}, {z})]
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
    {more}
}}"#
        ))
    }

    /// With a UsdPreviewSurface of these inputs; meshes have it by `rel material:binding = </NAME>`.
    #[must_use]
    pub fn with_material(self, name: &str, inputs: &str) -> Self {
        self.with(&format!(
            r#"def Material "{name}" {{
    token outputs:surface.connect = </{name}/S.outputs:surface>
    def Shader "S" {{
        uniform token info:id = "UsdPreviewSurface"
        token outputs:surface
        {inputs}
    }}
}}"#
        ))
    }

    /// Writes it into a folder.
    pub fn write(&self, folder: &Path) -> PathBuf {
        let path = folder.join("stage.usda");
        let header = format!(
            "#usda 1.0\n(\n    endTimeCode = 10\n    startTimeCode = 0\n    timeCodesPerSecond = {RATE}\n    framesPerSecond = {RATE}\n    upAxis = \"Y\"\n)\n"
        );
        fs::write(&path, header + &self.0).expect("a folder that can be written to");
        path
    }
}

/// Where the middle of a pixel of a square image lies at z = 0.
pub fn place(pixel: usize, side: usize) -> [f64; 2] {
    let at = |pixel: usize| ((pixel as f64 + 0.5) / side as f64 * 2.0 - 1.0) * HALF;
    [at(pixel % side), -at(pixel / side)]
}
