//! `extras.planish` of a mesh: creases, corners, holes and options (docs: formats).
use ::gltf::json::extras::Extras;
use planish_subdiv::mesh::{
    BoundaryInterpolation, Creasing, FaceVaryingInterpolation, INFINITE_SHARPNESS, MeshOptions, TriangleSubdivision,
};
use serde::Deserialize;
use serde_json::Value;

use super::fault::Fault;

/// The tags of a mesh as they are written. Vertices are file vertices: those of all primitives of triangles, one primitive after
/// another. Faces are counted after polygons are restored and before triangles are paired.
#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "camelCase")]
pub struct Tags {
    pub creases: Vec<(u32, u32, f64)>,
    pub corners: Vec<(u32, f64)>,
    pub holes: Vec<u32>,
    interpolate_boundary: Boundary,
    face_varying: FaceVarying,
    crease_method: Method,
    triangle_subdivision: Triangles,
    /// Whether vertices of one position are one.
    pub weld: bool,
}

impl Default for Tags {
    fn default() -> Self {
        Self {
            creases: Vec::new(),
            corners: Vec::new(),
            holes: Vec::new(),
            interpolate_boundary: Boundary::default(),
            face_varying: FaceVarying::default(),
            crease_method: Method::default(),
            triangle_subdivision: Triangles::default(),
            weld: true,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
enum Boundary {
    None,
    EdgeOnly,
    #[default]
    EdgeAndCorner,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
enum FaceVarying {
    None,
    CornersOnly,
    #[default]
    CornersPlus1,
    CornersPlus2,
    Boundaries,
    All,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
enum Method {
    #[default]
    Uniform,
    Chaikin,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
enum Triangles {
    #[default]
    CatmullClark,
    Smooth,
}

impl Tags {
    /// The tags that a mesh' extras hold, if any.
    pub fn read(extras: &Extras, place: &str) -> Result<Self, Fault> {
        let Some(Value::Object(mut fields)) = value(extras) else { return Ok(Self::default()) };
        let Some(tags) = fields.remove("planish") else { return Ok(Self::default()) };
        serde_json::from_value(tags).map_err(|error| {
            Fault::new(format!("{place}.extras.planish"), error.to_string(), "creases, corners, holes and options")
        })
    }

    /// The options of the cage.
    pub fn options(&self) -> MeshOptions {
        MeshOptions {
            boundary: match self.interpolate_boundary {
                Boundary::None => BoundaryInterpolation::None,
                Boundary::EdgeOnly => BoundaryInterpolation::EdgeOnly,
                Boundary::EdgeAndCorner => BoundaryInterpolation::EdgeAndCorner,
            },
            creasing: match self.crease_method {
                Method::Uniform => Creasing::Uniform,
                Method::Chaikin => Creasing::Chaikin,
            },
            triangles: match self.triangle_subdivision {
                Triangles::CatmullClark => TriangleSubdivision::CatmullClark,
                Triangles::Smooth => TriangleSubdivision::Smooth,
            },
            face_varying: match self.face_varying {
                FaceVarying::None => FaceVaryingInterpolation::None,
                FaceVarying::CornersOnly => FaceVaryingInterpolation::CornersOnly,
                FaceVarying::CornersPlus1 => FaceVaryingInterpolation::CornersPlus1,
                FaceVarying::CornersPlus2 => FaceVaryingInterpolation::CornersPlus2,
                FaceVarying::Boundaries => FaceVaryingInterpolation::Boundaries,
                FaceVarying::All => FaceVaryingInterpolation::All,
            },
        }
    }
}

/// The names of a mesh' morph targets, by the convention `extras.targetNames`.
pub fn target_names(extras: &Extras) -> Vec<String> {
    let Some(Value::Object(fields)) = value(extras) else { return Vec::new() };
    let names = fields.get("targetNames").and_then(Value::as_array).into_iter().flatten();
    names.map(|name| name.as_str().unwrap_or_default().to_owned()).collect()
}

fn value(extras: &Extras) -> Option<Value> {
    serde_json::from_str(extras.as_ref()?.get()).ok()
}

/// A sharpness that is not negative; beyond the floats' range it is infinite sharpness, whose number is finite.
pub fn sharpness(value: f64, place: &str) -> Result<f32, Fault> {
    if value.is_nan() || value < 0.0 {
        return Err(Fault::new(place, format!("sharpness {value}"), "0 or more"));
    }
    let rounded = value as f32;
    Ok(if rounded.is_finite() { rounded } else { INFINITE_SHARPNESS })
}
