//! Values of a mesh's surface (UsdGeomPrimvar), and which of them every corner of a face has.
use openusd::sdf::Value;

use super::attributes::Attributes;
use super::convert;
use super::faces::{Faces, below};
use crate::gltf::fault::Fault;

/// What a value belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    Constant,
    Face,
    /// `vertex`, and `varying` if the flag is set.
    Vertex(bool),
    Corner,
}

/// A primvar: distinct values, and the elements that have them.
pub struct Primvar<T> {
    pub values: Vec<T>,
    pub element: Element,
    /// Of every element, into `values`.
    pub indices: Vec<u32>,
    /// The file says which elements share a value.
    pub is_indexed: bool,
}

impl<T> Primvar<T> {
    /// Reads a primvar; none if the prim has none of that name.
    pub fn read(
        attributes: &Attributes,
        name: &str,
        expected: &str,
        convert: fn(Value) -> Option<Vec<T>>,
        (faces, vertex_count): (&Faces, usize),
    ) -> Result<Option<Self>, Fault> {
        let Some(values) = attributes.get(name, expected, convert)? else { return Ok(None) };
        let interpolation = attributes.metadata(name, "interpolation", convert::token)?;
        let (element, count) = match interpolation.as_deref() {
            None | Some("constant") => (Element::Constant, 1),
            Some("uniform") => (Element::Face, faces.kept.len()),
            Some("vertex") => (Element::Vertex(false), vertex_count),
            Some("varying") => (Element::Vertex(true), vertex_count),
            Some("faceVarying") => (Element::Corner, faces.vertex_of.len()),
            Some(other) => {
                let expected = "constant, uniform, varying, vertex or faceVarying";
                return Err(attributes.fault(name, format!("the interpolation {other:?}"), expected));
            }
        };
        let index_name = format!("{name}:indices");
        let indices = attributes.get(&index_name, "int[]", convert::integers)?;
        let found = indices.as_ref().map_or(values.len(), Vec::len);
        if found != count {
            let name = if indices.is_some() { &index_name } else { name };
            let interpolation = interpolation.as_deref().unwrap_or("constant");
            return Err(attributes.fault(name, format!("{found} values"), format!("the {count} of {interpolation}")));
        }
        let is_indexed = indices.is_some();
        let indices = match indices {
            None => (0..count as u32).collect(),
            Some(indices) => indices
                .into_iter()
                .map(|index| u32::try_from(index).ok().filter(|&index| (index as usize) < values.len()).ok_or(index))
                .collect::<Result<_, _>>()
                .map_err(|index| attributes.fault(&index_name, format!("{index}"), below(values.len(), "values")))?,
        };
        Ok(Some(Self { values, element, indices, is_indexed }))
    }

    /// The value of a corner of the file: into `values`. `face`: the face of the file that it is of.
    pub fn index_at(&self, corner: u32, vertex: u32, face: u32) -> u32 {
        let element = match self.element {
            Element::Constant => 0,
            Element::Face => face,
            Element::Vertex(_) => vertex,
            Element::Corner => corner,
        };
        self.indices[element as usize]
    }
}
