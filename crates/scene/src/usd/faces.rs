//! Faces of a mesh as they are read: checked, turned to counter-clockwise, and which of the file they are.
use planish_subdiv::mesh::MAX_ELEMENTS;

use super::attributes::Attributes;
use super::convert;
use crate::LoadOptions;
use crate::gltf::fault::Fault;
use crate::obj::Warnings;

const COUNTS: &str = "faceVertexCounts";
const INDICES: &str = "faceVertexIndices";

/// Faces that are kept.
#[derive(Debug, Default)]
pub struct Faces {
    pub sizes: Vec<u32>,
    /// Corners of all faces, by their place in the file's `faceVertexIndices`.
    pub corners: Vec<u32>,
    /// The vertex of every corner of the file.
    pub vertex_of: Vec<u32>,
    /// The face of the file of every corner of the file.
    pub face_of: Vec<u32>,
    /// What each face of the file has become; none: it was dropped.
    pub kept: Vec<Option<u32>>,
}

impl Faces {
    /// Reads and checks faces. Degenerate ones are refused, or dropped if they shall be repaired.
    pub fn read(
        attributes: &Attributes,
        vertex_count: usize,
        options: &LoadOptions,
        warnings: &mut Warnings,
    ) -> Result<Self, Fault> {
        let counts = attributes.get(COUNTS, "int[]", convert::integers)?.unwrap_or_default();
        let indices = attributes.get(INDICES, "int[]", convert::integers)?.unwrap_or_default();
        let expected = counts.iter().try_fold(0i64, |sum, &count| sum.checked_add(count.max(0)));
        if expected != Some(indices.len() as i64) || indices.len() as u64 >= u64::from(MAX_ELEMENTS) {
            let found = format!("{} indices", indices.len());
            let expected = expected.map_or_else(|| "fewer".to_owned(), |expected| expected.to_string());
            return Err(attributes.fault(INDICES, found, format!("the {expected} of {COUNTS}")));
        }
        let mut faces = Self { vertex_of: Vec::with_capacity(indices.len()), ..Self::default() };
        for (corner, &index) in indices.iter().enumerate() {
            let vertex = u32::try_from(index).ok().filter(|&vertex| (vertex as usize) < vertex_count);
            let Some(vertex) = vertex else {
                let found = format!("vertex {index} at corner {corner}");
                return Err(attributes.fault(INDICES, found, below(vertex_count, "points")));
            };
            faces.vertex_of.push(vertex);
        }
        let is_left_handed = attributes.get("orientation", "a token", convert::token)?.as_deref() == Some("leftHanded");
        faces.keep(attributes, (&counts, vertex_count), is_left_handed, options, warnings)?;
        Ok(faces)
    }

    fn keep(
        &mut self,
        attributes: &Attributes,
        (counts, vertex_count): (&[i64], usize),
        is_left_handed: bool,
        options: &LoadOptions,
        warnings: &mut Warnings,
    ) -> Result<(), Fault> {
        let mut seen_in = vec![usize::MAX; vertex_count];
        let mut first = 0;
        for (face, &count) in counts.iter().enumerate() {
            let sides = u32::try_from(count).unwrap_or_default();
            let corners = first..first + sides;
            first += sides;
            self.face_of.extend(std::iter::repeat_n(face as u32, sides as usize));
            let vertices = &self.vertex_of[corners.start as usize..corners.end as usize];
            let repeated = vertices.iter().find(|&&v| std::mem::replace(&mut seen_in[v as usize], face) == face);
            let found = match repeated {
                Some(vertex) => format!("face {face} with vertex {vertex} twice"),
                None if sides < 3 => format!("face {face} of {count} vertices"),
                None => {
                    self.kept.push(Some(self.sizes.len() as u32));
                    self.sizes.push(sides);
                    match is_left_handed {
                        // The first corner stays the first.
                        true => self.corners.extend(corners.clone().take(1).chain(corners.skip(1).rev())),
                        false => self.corners.extend(corners),
                    }
                    continue;
                }
            };
            if !options.repair {
                return Err(attributes.fault(INDICES, found, "3 or more different vertices"));
            }
            warnings.push(None, format!("{}: {found}: dropped", attributes.path()));
            self.kept.push(None);
        }
        Ok(())
    }

    /// The vertices of all faces.
    pub fn vertices(&self) -> Vec<u32> {
        self.corners.iter().map(|&corner| self.vertex_of[corner as usize]).collect()
    }
}

/// What was expected of an index into so many.
pub fn below(count: usize, of: &str) -> String {
    match count {
        0 => format!("none: there are no {of}"),
        _ => format!("0 to {}", count - 1),
    }
}
