//! Tessellated surfaces to PLY.

use std::{
    borrow::Borrow,
    io::{self, Write},
    path::Path,
};

use crate::{Error, Result, atomic};

/// One corner of a triangle, as the tessellation-evaluation stage wrote it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DumpVertex {
    /// `x y z`, in object space.
    pub position: [f32; 3],
    /// `nx ny nz`, of unit length.
    pub normal: [f32; 3],
    /// `u v`, 0 to 1 on the base face.
    pub uv: [f32; 2],
    /// The base face, in Ptex order: a quad has one, an n-gon n consecutive ones.
    pub face: i32,
    /// The refinement level of the patch.
    pub level: u8,
    /// 0 regular, 1 transition, 2 patch-filling quad, 3 Gregory quad, 4 Gregory triangle, 5 table.
    pub kind: u8,
    /// `s t`, texture coordinates.
    pub tex_coord: [f32; 2],
    /// `sx sy sz`, the shading normal of a displaced surface.
    pub shading_normal: [f32; 3],
    /// `r g b`, the colour.
    pub color: [f32; 3],
}

/// What a dump says of each vertex besides what all dumps say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DumpProperties {
    /// `s t`.
    pub tex_coords: bool,
    /// `sx sy sz`.
    pub shading_normals: bool,
    /// `r g b`.
    pub colors: bool,
}

/// Bytes of a vertex at most: 8 floats, an int, 2 uchars, 8 floats.
const VERTEX_BYTES: usize = 8 * 4 + 4 + 2 + 8 * 4;
/// Bytes of a triangle: a uchar and 3 ints.
pub(crate) const TRIANGLE_BYTES: usize = 1 + 3 * 4;

impl DumpVertex {
    /// Makes bytes those of the vertex.
    fn put(self, properties: DumpProperties, bytes: &mut Vec<u8>) {
        bytes.clear();
        let mut put = |values: &[f32]| values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        put(&self.position);
        put(&self.normal);
        put(&self.uv);
        bytes.extend(self.face.to_le_bytes());
        bytes.extend([self.level, self.kind]);
        let mut put = |values: &[f32]| values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        if properties.tex_coords {
            put(&self.tex_coord);
        }
        if properties.shading_normals {
            put(&self.shading_normal);
        }
        if properties.colors {
            put(&self.color);
        }
    }
}

/// Writes a triangle soup, three vertices a triangle, as binary little-endian PLY; floats keep their bits.
///
/// # Errors
/// As [`write_ply_stream`].
pub fn write_ply(path: &Path, vertices: &[DumpVertex]) -> Result<()> {
    write_ply_stream(path, vertices.len() as u64, DumpProperties::default(), vertices)
}

/// As [`write_ply`], for `vertex_count` vertices that need not lie in memory together.
///
/// # Errors
/// [`Error::PartialTriangle`] unless `vertex_count` is a multiple of 3; [`Error::TooManyVertices`] beyond the range of
/// `int`; [`Error::StreamLength`] where `vertices` yields fewer or more; [`Error::Write`], [`Error::NoFolder`],
/// [`Error::NotAFolder`], [`Error::NotAFile`].
pub fn write_ply_stream<V>(path: &Path, vertex_count: u64, properties: DumpProperties, vertices: V) -> Result<()>
where
    V: IntoIterator,
    V::Item: Borrow<DumpVertex>,
{
    if !vertex_count.is_multiple_of(3) {
        return Err(Error::PartialTriangle { path: path.to_owned(), vertex_count });
    }
    let too_many = |_| Error::TooManyVertices { path: path.to_owned(), vertex_count };
    let index_count = i32::try_from(vertex_count).map_err(too_many)?;
    atomic::write(path, |writer| {
        let failed = |source| Error::write(path, source);
        writer.write_all(header(index_count, properties).as_bytes()).map_err(failed)?;
        let mut found = 0;
        let mut bytes = Vec::with_capacity(VERTEX_BYTES);
        for vertex in vertices {
            found += 1;
            if found > vertex_count {
                break;
            }
            vertex.borrow().put(properties, &mut bytes);
            writer.write_all(&bytes).map_err(failed)?;
        }
        if found != vertex_count {
            return Err(Error::StreamLength { path: path.to_owned(), expected: vertex_count, found });
        }
        write_triangles(writer, index_count).map_err(failed)
    })
}

fn header(vertex_count: i32, properties: DumpProperties) -> String {
    let tex_coords = if properties.tex_coords { "property float s\nproperty float t\n" } else { "" };
    let shading =
        if properties.shading_normals { "property float sx\nproperty float sy\nproperty float sz\n" } else { "" };
    let colors = if properties.colors { "property float r\nproperty float g\nproperty float b\n" } else { "" };
    format!(
        "ply\n\
         format binary_little_endian 1.0\n\
         element vertex {vertex_count}\n\
         property float x\n\
         property float y\n\
         property float z\n\
         property float nx\n\
         property float ny\n\
         property float nz\n\
         property float u\n\
         property float v\n\
         property int face\n\
         property uchar level\n\
         property uchar kind\n\
         {tex_coords}{shading}{colors}\
         element face {}\n\
         property list uchar int vertex_indices\n\
         end_header\n",
        vertex_count / 3
    )
}

/// (0, 1, 2), (3, 4, 5) ..
fn write_triangles(writer: &mut impl Write, index_count: i32) -> io::Result<()> {
    for first in (0..index_count).step_by(3) {
        writer.write_all(&triangle_bytes(first))?;
    }
    Ok(())
}

/// A triangle of the vertex `first` and the two after it.
pub(crate) fn triangle_bytes(first: i32) -> [u8; TRIANGLE_BYTES] {
    let mut bytes = [3; TRIANGLE_BYTES];
    for (target, index) in bytes[1..].chunks_exact_mut(4).zip(0..) {
        target.copy_from_slice(&first.wrapping_add(index).to_le_bytes());
    }
    bytes
}
