//! A scene file as it is written: its fields, and what is wrong with its form, by line and column.
use serde::Deserialize;
use serde_json::error::Category;

use super::Fault;
use crate::error::shown;

/// The byte order mark with which some editors begin UTF-8 files.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneText {
    /// For people; not used.
    #[serde(default, rename = "comment")]
    _comment: Option<String>,
    pub meshes: Vec<MeshText>,
    pub instances: Vec<InstanceText>,
    #[serde(default)]
    pub cameras: Vec<CameraText>,
    #[serde(default)]
    pub paths: Vec<PathText>,
}

/// A mesh, by the name that instances use.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshText {
    pub name: String,
    /// An OBJ file, looked for from the scene file's folder.
    pub file: String,
    pub displacement: Option<DisplacementText>,
}

/// A displacement map.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplacementText {
    /// An image, looked for from the scene file's folder.
    pub file: String,
    pub scale: Option<f64>,
    pub midpoint: Option<f64>,
    pub kind: Option<KindText>,
    pub layout: Option<LayoutText>,
}

/// What a texel of a displacement map says.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum KindText {
    Scalar,
    Vector,
}

/// What leads to a texel of a displacement map.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LayoutText {
    Uv,
    Faces,
}

/// Where a mesh stands: scaled, then turned, then moved; or a matrix alone.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InstanceText {
    pub mesh: String,
    pub name: Option<String>,
    pub translate: Option<[f64; 3]>,
    pub rotate: Option<RotationText>,
    pub scale: Option<ScaleText>,
    /// Three rows of four, which act on columns (x, y, z, 1).
    pub matrix: Option<[f64; 12]>,
    pub array: Option<ArrayText>,
}

/// A turn about an axis through the mesh' origin, counter-clockwise seen against the axis.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotationText {
    pub axis: [f64; 3],
    pub degrees: f64,
}

/// One scale for all axes, or one each.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "a scale of another form, expected a number or [x, y, z]")]
pub enum ScaleText {
    Same(f64),
    Each([f64; 3]),
}

/// Copies along the world's axes.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArrayText {
    pub count: [u32; 3],
    pub step: [f64; 3],
}

/// A camera that stands still.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraText {
    pub name: String,
    pub eye: [f32; 3],
    pub target: [f32; 3],
    pub up: Option<[f32; 3]>,
    /// Vertical field of view, degrees.
    pub fov: f32,
    pub lens: Option<LensText>,
}

/// A camera's thin lens.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LensText {
    /// Of the aperture, in world units.
    pub radius: f32,
    /// Distance of what is in focus, in world units.
    pub focus: f32,
}

/// A camera that moves.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathText {
    pub name: String,
    /// Vertical field of view, degrees.
    pub fov: Option<f32>,
    pub frames: u32,
    pub keys: Vec<KeyText>,
}

/// A place that a path passes through.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyText {
    pub eye: [f32; 3],
    pub target: [f32; 3],
}

impl SceneText {
    /// Reads the form of a file; whether names, counts and values make sense is checked elsewhere.
    pub fn parse(bytes: &[u8]) -> Result<Self, Fault> {
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        serde_json::from_slice(bytes).map_err(|error| malformed(&error))
    }
}

/// serde_json's words in ours: place, found, expected.
fn malformed(error: &serde_json::Error) -> Fault {
    let place = format!("line {}, column {}", error.line(), error.column());
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    if error.classify() != Category::Data {
        return Fault::new(place, shown(message), "a scene file of JSON");
    }
    if let Some((found, expected)) = message.split_once(", expected ") {
        let found = ["invalid type: ", "invalid value: ", "invalid "]
            .iter()
            .find_map(|kind| found.strip_prefix(kind))
            .unwrap_or(found);
        return Fault::new(place, shown(found), shown(expected));
    }
    match message.split_once(" field ") {
        Some(("missing", field)) => Fault::new(place, format!("no field {}", shown(field)), "one"),
        Some(("duplicate", field)) => Fault::new(place, format!("field {} twice", shown(field)), "it once"),
        _ => Fault::new(place, shown(message), "a scene file"),
    }
}
