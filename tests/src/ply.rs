//! Dumps: binary little-endian PLY, a triangle soup of three vertices a triangle.

use std::fs;
use std::ops::Range;
use std::path::Path;

/// The properties of a vertex, in the order and with the types of the interface.
const VERTEX_PROPERTIES: &str = "float x, float y, float z, float nx, float ny, float nz, float u, float v, int face, \
                                 uchar level, uchar kind";
/// Those that follow where the mesh has texture coordinates.
const TEX_COORD_PROPERTIES: &str = ", float s, float t";
/// Those that follow where the surface is displaced.
const SHADING_PROPERTIES: &str = ", float sx, float sy, float sz";
/// Those that follow where the mesh has colours.
const COLOR_PROPERTIES: &str = ", float r, float g, float b";
/// Bytes of a vertex without those: eight floats, an int and two bytes.
const VERTEX_BYTES: usize = 8 * 4 + 4 + 2;
/// Bytes of a triangle: its size in a byte, and three ints.
const TRIANGLE_BYTES: usize = 1 + 3 * 4;
/// What ends the header.
const HEADER_END: &[u8] = b"end_header\n";

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position on the limit surface.
    pub position: [f32; 3],
    /// Normal.
    pub normal: [f32; 3],
    /// Parameters in the Ptex face.
    pub uv: [f32; 2],
    /// Ptex face.
    pub face: u32,
    /// Level of its patch.
    pub level: u8,
    /// Kind of its patch.
    pub kind: u8,
    /// Texture coordinates; 0 where there are none.
    pub tex_coord: [f32; 2],
    /// Normal of the displaced surface; 0 where it is not.
    pub shading_normal: [f32; 3],
    /// Colour; 0 where there is none.
    pub color: [f32; 3],
}

/// Which properties a dump's vertices have besides those of all dumps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Properties {
    /// `s t`.
    pub tex_coords: bool,
    /// `sx sy sz`.
    pub shading_normals: bool,
    /// `r g b`.
    pub colors: bool,
}

impl Properties {
    /// Every combination.
    fn all() -> impl Iterator<Item = Self> {
        (0..8).map(|bits| Self { tex_coords: bits & 1 != 0, shading_normals: bits & 2 != 0, colors: bits & 4 != 0 })
    }

    /// How many floats precede the shading normal, precede the colour, and follow the other properties in all.
    fn ends(self) -> [usize; 3] {
        let tex_coords = if self.tex_coords { 2 } else { 0 };
        let shading = tex_coords + if self.shading_normals { 3 } else { 0 };
        [tex_coords, shading, shading + if self.colors { 3 } else { 0 }]
    }

    fn vertex_bytes(self) -> usize {
        VERTEX_BYTES + 4 * self.ends()[2]
    }
}

/// A dump, as its file has it.
pub struct Dump {
    /// What its vertices have.
    pub properties: Properties,
    bytes: Vec<u8>,
    vertices: Range<usize>,
}

impl Dump {
    /// Reads a file; says what is wrong with one that is not as the interface describes.
    pub fn read(path: &Path) -> Result<Self, String> {
        let fault = |what: &str| format!("{}: {what}", path.display());
        let bytes = fs::read(path).map_err(|error| fault(&error.to_string()))?;
        let start = bytes.windows(HEADER_END.len()).position(|window| window == HEADER_END);
        let start = start.ok_or_else(|| fault("no header"))? + HEADER_END.len();
        let header = String::from_utf8_lossy(&bytes[..start]).into_owned();
        let vertex_count = count_after(&header, "element vertex ").ok_or_else(|| fault("no vertex count"))?;
        let properties = Properties::all().find(|&all| header == expected_header(vertex_count, all));
        let properties = properties.ok_or_else(|| fault(&format!("not the header of the interface:\n{header}")))?;
        let vertices = start..start + vertex_count * properties.vertex_bytes();
        let expected = vertices.end + vertex_count / 3 * TRIANGLE_BYTES;
        if bytes.len() != expected {
            return Err(fault(&format!("{} bytes, expected {expected}", bytes.len())));
        }
        let triangles = bytes[vertices.end..].chunks_exact(TRIANGLE_BYTES);
        if let Some(index) = (0..).zip(triangles).position(|(index, bytes)| bytes != triangle_bytes(3 * index)) {
            return Err(fault(&format!("triangle {index} is not made of the next three vertices")));
        }
        Ok(Self { properties, bytes, vertices })
    }

    /// The bytes of all triangles' vertices, sorted by them: patches are listed in any order.
    pub fn sorted_triangles(&self) -> Vec<u8> {
        let bytes = &self.bytes[self.vertices.clone()];
        let mut triangles: Vec<&[u8]> = bytes.chunks_exact(3 * self.properties.vertex_bytes()).collect();
        triangles.sort_unstable();
        triangles.concat()
    }

    /// All vertices, three a triangle.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = Vertex> {
        let properties = self.properties;
        self.bytes[self.vertices.clone()].chunks_exact(properties.vertex_bytes()).map(move |bytes| {
            let word_at = |first: usize| [0, 1, 2, 3].map(|byte| bytes[first + byte]);
            let word = |index: usize| word_at(4 * index);
            let float = |index: usize| f32::from_le_bytes(word(index));
            let last_float = |index: usize| f32::from_le_bytes(word_at(VERTEX_BYTES + 4 * index));
            let [shading, color, _] = properties.ends();
            let vector = |is_there, first: usize| {
                if is_there { [0, 1, 2].map(|axis| last_float(first + axis)) } else { [0.0; 3] }
            };
            Vertex {
                position: [0, 1, 2].map(float),
                normal: [3, 4, 5].map(float),
                uv: [6, 7].map(float),
                face: u32::from_le_bytes(word(8)),
                level: bytes[VERTEX_BYTES - 2],
                kind: bytes[VERTEX_BYTES - 1],
                tex_coord: if properties.tex_coords { [0, 1].map(last_float) } else { [0.0; 2] },
                shading_normal: vector(properties.shading_normals, shading),
                color: vector(properties.colors, color),
            }
        })
    }

    /// Writes the triangles of the Ptex faces that `keep` keeps.
    pub fn write_faces(&self, path: &Path, keep: impl Fn(u32) -> bool) -> Result<(), String> {
        let triangles = self.bytes[self.vertices.clone()].chunks_exact(3 * self.properties.vertex_bytes());
        let face = |triangle: &[u8]| u32::from_le_bytes([32, 33, 34, 35].map(|byte: usize| triangle[byte]));
        let kept: Vec<&[u8]> = triangles.filter(|triangle| keep(face(triangle))).collect();
        let mut bytes = expected_header(3 * kept.len(), self.properties).into_bytes();
        bytes.extend_from_slice(&kept.concat());
        bytes.extend((0..kept.len() as u32).flat_map(|index| triangle_bytes(3 * index)));
        fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// The parameter area that the triangles of each Ptex face cover, counter-clockwise ones counted positive.
pub fn covered_areas(vertices: &[Vertex], face_count: usize) -> Result<Vec<f64>, String> {
    let mut areas = vec![0.0; face_count];
    for (index, [a, b, c]) in vertices.as_chunks::<3>().0.iter().enumerate() {
        let area = areas.get_mut(a.face as usize).filter(|_| a.face == b.face && a.face == c.face);
        let area = area.ok_or_else(|| {
            format!("triangle {index} has Ptex faces {} {} {} of {face_count}", a.face, b.face, c.face)
        })?;
        let [[au, av], [bu, bv], [cu, cv]] = [a, b, c].map(|vertex| vertex.uv.map(f64::from));
        *area += 0.5 * ((bu - au) * (cv - av) - (cu - au) * (bv - av));
    }
    Ok(areas)
}

fn count_after(header: &str, words: &str) -> Option<usize> {
    header.lines().find_map(|line| line.strip_prefix(words))?.parse().ok()
}

fn expected_header(vertex_count: usize, properties: Properties) -> String {
    let mut names = VERTEX_PROPERTIES.to_owned();
    names.push_str(if properties.tex_coords { TEX_COORD_PROPERTIES } else { "" });
    names.push_str(if properties.shading_normals { SHADING_PROPERTIES } else { "" });
    names.push_str(if properties.colors { COLOR_PROPERTIES } else { "" });
    let properties: String = names.split(", ").map(|property| format!("property {property}\n")).collect();
    let triangle_count = vertex_count / 3;
    format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertex_count}\n{properties}element face \
         {triangle_count}\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

fn triangle_bytes(first: u32) -> [u8; TRIANGLE_BYTES] {
    let mut bytes = [3; TRIANGLE_BYTES];
    for (word, vertex) in bytes[1..].chunks_exact_mut(4).zip(first..) {
        word.copy_from_slice(&vertex.to_le_bytes());
    }
    bytes
}
