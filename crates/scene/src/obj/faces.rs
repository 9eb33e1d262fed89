//! `f` lines, and what is checked of them once the whole file is read.
use std::num::NonZeroU32;

use planish_subdiv::mesh::MAX_FACE_SIDES;

use super::lines::{Tokens, leading_integer, quoted};
use super::warnings::Warnings;
use crate::error::Fault;

/// The faces of a file, one after another.
#[derive(Default)]
pub struct Faces {
    pub sizes: Vec<u32>,
    /// Vertex indices from 0, not yet checked against the vertex count.
    pub vertices: Vec<u32>,
    /// Per face-vertex: the texture coordinate's index from 1, not yet checked against their count.
    pub uvs: Vec<Option<NonZeroU32>>,
    /// Per face: its line.
    lines: Vec<u32>,
}

/// Where the file's faces went: `repair` drops some, tags name them as the file counts them.
pub struct FaceMap {
    /// Sides of the file's faces, the dropped ones included.
    pub original_sizes: Vec<u32>,
    /// Indices of the dropped faces, ascending.
    dropped: Vec<u32>,
}

impl FaceMap {
    /// Today's index of the file's face; none when it was dropped.
    pub fn get(&self, original: u32) -> Option<u32> {
        match self.dropped.binary_search(&original) {
            Ok(_) => None,
            Err(dropped_before) => Some(original - dropped_before as u32),
        }
    }
}

impl Faces {
    /// Reads the corners of an `f` line. Negative indices count back from the vertices that are there so far.
    pub fn read(&mut self, line: u32, tokens: Tokens, vertex_count: usize, uv_count: usize) -> Result<(), Fault> {
        let mut size = 0;
        for token in tokens {
            if size == MAX_FACE_SIDES {
                return Err(Fault::at(line, "a face of more sides", format!("at most {MAX_FACE_SIDES}")));
            }
            let corner = Corner::split(token)
                .ok_or_else(|| Fault::at(line, quoted(token), "a corner like 1, 1/2, 1//3 or 1/2/3"))?;
            let vertex = resolve(corner.vertex, vertex_count)
                .map_err(|expected| Fault::at(line, format!("vertex index {}", corner.vertex), expected))?;
            let resolve_uv =
                |uv: i64| resolve(uv, uv_count).map_err(|expected| Fault::at(line, format!("vt index {uv}"), expected));
            self.vertices.push(vertex.get() - 1);
            self.uvs.push(corner.uv.map(resolve_uv).transpose()?);
            size += 1;
        }
        self.sizes.push(size);
        self.lines.push(line);
        Ok(())
    }

    /// Checks every face against the number of vertices. Degenerate faces are refused, or dropped with `repair`.
    pub fn check(&self, vertex_count: usize, repair: bool, warnings: &mut Warnings) -> Result<FaceMap, Fault> {
        let mut dropped = Vec::new();
        // The last face that named each vertex, from 1.
        let mut named_by = vec![0u32; vertex_count];
        for (face, (line, vertices)) in (1u32..).zip(self.iter()) {
            if let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= vertex_count) {
                let found = format!("vertex index {}", u64::from(*vertex) + 1);
                return Err(Fault::at(line, found, format!("1 to {vertex_count}")));
            }
            let repeated = vertices.iter().find(|&&v| std::mem::replace(&mut named_by[v as usize], face) == face);
            let (found, expected) = match repeated {
                Some(vertex) => (format!("a face with vertex {} twice", vertex + 1), "different vertices".to_owned()),
                None if vertices.len() < 3 => {
                    (format!("a face of {} vertices", vertices.len()), "3 or more".to_owned())
                }
                None => continue,
            };
            if !repair {
                return Err(Fault::at(line, found, expected));
            }
            warnings.push(Some(line), format!("{found}: dropped"));
            dropped.push(face - 1);
        }
        Ok(FaceMap { original_sizes: self.sizes.clone(), dropped })
    }

    /// Removes the dropped faces.
    pub fn drop_unmapped(&mut self, map: &FaceMap) {
        if map.dropped.is_empty() {
            return;
        }
        let mut kept = Self::default();
        let mut start = 0;
        for (face, &size) in (0u32..).zip(&self.sizes) {
            let end = start + size as usize;
            if map.get(face).is_some() {
                kept.sizes.push(size);
                kept.lines.push(self.lines[face as usize]);
                kept.vertices.extend_from_slice(&self.vertices[start..end]);
                kept.uvs.extend_from_slice(&self.uvs[start..end]);
            }
            start = end;
        }
        *self = kept;
    }

    /// Checks every texture coordinate index against their count.
    pub fn check_uvs(&self, uv_count: usize) -> Result<(), Fault> {
        match self.uvs.iter().position(|uv| uv.is_some_and(|uv| uv.get() as usize > uv_count)) {
            None => Ok(()),
            Some(corner) => {
                let found = format!("vt index {}", self.uvs[corner].map_or(0, NonZeroU32::get));
                Err(Fault::at(self.line_of_corner(corner), found, format!("1 to {uv_count}")))
            }
        }
    }

    /// Line of the first face with a corner that has no texture coordinate.
    pub fn first_line_without_uv(&self) -> Option<u32> {
        self.uvs.iter().position(Option::is_none).map(|corner| self.line_of_corner(corner))
    }

    fn line_of_corner(&self, corner: usize) -> u32 {
        let mut end = 0;
        let face = self.sizes.iter().position(|&size| {
            end += size as usize;
            corner < end
        });
        face.map_or(0, |face| self.lines[face])
    }

    /// Line and vertices of every face.
    fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mut rest = self.vertices.as_slice();
        self.lines.iter().zip(&self.sizes).map(move |(&line, &size)| {
            let (face, after) = rest.split_at(size as usize);
            rest = after;
            (line, face)
        })
    }
}

/// A face's corner as it stands in the file.
struct Corner {
    vertex: i64,
    uv: Option<i64>,
}

impl Corner {
    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; normals are not used. Most of a file's bytes pass through here, each once.
    fn split(token: &[u8]) -> Option<Self> {
        let (vertex, rest) = leading_integer(token)?;
        let (uv, rest) = optional_part(rest)?;
        let (_normal, rest) = optional_part(rest)?;
        rest.is_empty().then_some(Self { vertex, uv })
    }
}

/// A `/` and the integer after it, where there are any.
fn optional_part(rest: &[u8]) -> Option<(Option<i64>, &[u8])> {
    match rest {
        [] | [b'/'] => Some((None, &[])),
        [b'/', b'/', ..] => Some((None, &rest[1..])),
        [b'/', part @ ..] => leading_integer(part).map(|(integer, rest)| (Some(integer), rest)),
        _ => None,
    }
}

/// A file's index to one from 1; too great ones are found at the end of the file. The error says what was expected.
fn resolve(index: i64, count: usize) -> Result<NonZeroU32, String> {
    let expected = || match count {
        0 => "1 or more".to_owned(),
        _ => format!("1 or more, or -{count} to -1"),
    };
    let from_one = if index < 0 { index + count as i64 + 1 } else { index };
    u32::try_from(from_one).ok().and_then(NonZeroU32::new).ok_or_else(expected)
}
