//! A mesh prim's cage.
use std::collections::HashMap;

use openusd::sdf::Value;
use planish_subdiv::mesh::{ControlMesh, FaceVaryingChannel, MAX_ELEMENTS, VertexColors, VertexInterpolation};

use super::attributes::Attributes;
use super::faces::Faces;
use super::primvar::{Element, Primvar};
use super::{convert, tags};
use crate::LoadOptions;
use crate::curve::{Curve, Interpolation};
use crate::gltf::fault::Fault;
use crate::obj::Warnings;

/// What the channel of texture coordinates is called.
const UV_NAME: &str = "st";
const POINTS: &str = "points";
const COLORS: &str = "primvars:displayColor";

/// A cage and what its prim says beside.
pub struct Cage {
    pub control_mesh: ControlMesh,
    /// Positions over time; none: they stay.
    pub points: Option<Curve<Vec<[f32; 3]>>>,
    pub faces: Faces,
    /// The colour that all of it has, if a material has none.
    pub color: Option<[f32; 3]>,
}

/// Makes the cage of a mesh; none if it has no faces. `uv_names`: primvars of texture coordinates that its materials name.
pub fn read(
    attributes: &Attributes,
    uv_names: &[String],
    options: &LoadOptions,
    warnings: &mut Warnings,
) -> Result<Option<Cage>, Fault> {
    let points = attributes.curve(POINTS, ("point3f[]", Interpolation::Linear), convert::vec3s)?;
    let positions = points.as_ref().map_or_else(Vec::new, |points| points.values()[0].clone());
    if positions.len() as u64 >= u64::from(MAX_ELEMENTS) {
        return Err(attributes.fault(POINTS, format!("{} points", positions.len()), format!("below {MAX_ELEMENTS}")));
    }
    let faces = Faces::read(attributes, positions.len(), options, warnings)?;
    if faces.sizes.is_empty() {
        warnings.push(None, format!("{}: a mesh without faces: left out", attributes.path()));
        return Ok(None);
    }
    if let Some(points) = &points {
        refuse_other_counts(attributes, points, positions.len())?;
    }
    let (face_sizes, face_vertices) = (faces.sizes.clone(), faces.vertices());
    let mut mesh = ControlMesh { positions, face_sizes, face_vertices, ..ControlMesh::default() };
    tags::apply(attributes, &faces, &mut mesh, warnings)?;
    let first_name = uv_names.first().map_or(UV_NAME, String::as_str);
    if let Some(channel) = channel(attributes, first_name, &faces, mesh.positions.len())? {
        mesh.face_varying.push(channel);
    }
    let color = colors(attributes, &faces, &mut mesh, warnings)?;
    mesh.validate()
        .map_err(|error| Fault::new(attributes.path(), error.to_string(), "a cage that can be subdivided"))?;
    let points = points.filter(|points| !points.is_constant());
    Ok(Some(Cage { control_mesh: mesh, points, faces, color }))
}

fn refuse_other_counts(attributes: &Attributes, points: &Curve<Vec<[f32; 3]>>, count: usize) -> Result<(), Fault> {
    let other = points.values().iter().find(|points| points.len() != count);
    let is_finite = |points: &Vec<[f32; 3]>| points.iter().flatten().all(|c| c.is_finite());
    match other {
        Some(other) => {
            let found = format!("{} points and {count} at the first moment", other.len());
            Err(attributes.fault(POINTS, found, "as many at all times"))
        }
        None if !points.values().iter().all(is_finite) => {
            Err(attributes.fault(POINTS, "a point that is not finite", "finite coordinates"))
        }
        None => Ok(()),
    }
}

/// Texture coordinates. Without indices, equal values at a vertex are one, so that there is a seam where they differ.
fn channel(
    attributes: &Attributes,
    name: &str,
    faces: &Faces,
    vertex_count: usize,
) -> Result<Option<FaceVaryingChannel>, Fault> {
    let primvar_name = format!("primvars:{name}");
    let expected = "texCoord2f[] or float2[]";
    let primvar = Primvar::read(attributes, &primvar_name, expected, convert::vec2s, (faces, vertex_count))?;
    let Some(primvar) = primvar else { return Ok(None) };
    let index = |&corner: &u32| {
        let (vertex, face) = (faces.vertex_of[corner as usize], faces.face_of[corner as usize]);
        (vertex, primvar.index_at(corner, vertex, face))
    };
    let at_corners = faces.corners.iter().map(index);
    if primvar.is_indexed || primvar.element != Element::Corner {
        let indices = at_corners.map(|(_, index)| index).collect();
        return Ok(Some(FaceVaryingChannel { name: UV_NAME.to_owned(), values: primvar.values, indices }));
    }
    let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
    let mut channel = FaceVaryingChannel { name: UV_NAME.to_owned(), ..FaceVaryingChannel::default() };
    for (vertex, index) in at_corners {
        let value = primvar.values[index as usize];
        let place = *known.entry((vertex, value.map(f32::to_bits))).or_insert_with(|| {
            channel.values.push(value);
            channel.values.len() as u32 - 1
        });
        channel.indices.push(place);
    }
    Ok(Some(channel))
}

/// Colours of vertices, or the one that all of the mesh has.
fn colors(
    attributes: &Attributes,
    faces: &Faces,
    mesh: &mut ControlMesh,
    warnings: &mut Warnings,
) -> Result<Option<[f32; 3]>, Fault> {
    let convert: fn(Value) -> Option<Vec<[f32; 3]>> = convert::vec3s;
    if attributes.get(COLORS, "color3f[]", convert)?.is_none_or(|colors| colors.is_empty()) {
        return Ok(None);
    }
    let Some(primvar) = Primvar::read(attributes, COLORS, "color3f[]", convert, (faces, mesh.positions.len()))? else {
        return Ok(None);
    };
    let value = |index: &u32| primvar.values[*index as usize];
    match primvar.element {
        Element::Constant => return Ok(Some(value(&primvar.indices[0]))),
        Element::Vertex(is_varying) => {
            let interpolation = if is_varying { VertexInterpolation::Varying } else { VertexInterpolation::Vertex };
            mesh.colors = Some(VertexColors { values: primvar.indices.iter().map(value).collect(), interpolation });
        }
        Element::Face | Element::Corner => {
            warnings.push(None, format!("{}: {COLORS} of faces or corners: ignored", attributes.path()));
        }
    }
    Ok(None)
}
