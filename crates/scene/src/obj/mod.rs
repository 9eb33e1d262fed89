//! The OBJ reader: `v vt vn f o g s usemtl mtllib`, and the `t` lines with which OpenSubdiv's test shapes say creases,
//! corners, holes, options, hierarchical edits and, tags of ours, densities and the interpolation of colours.
//!
//! One file is one mesh: groups, objects and materials do not split it. What the reader does not know it ignores.
//! Faces and tags may come before the vertices and faces that they name, so indices are checked at the end of the file.
//!
//! | module | idea |
//! |---|---|
//! | `lines` | bytes to logical lines and tokens |
//! | `colors` | colours of `v` lines |
//! | `faces` | `f` lines, and what is checked of them at the end |
//! | `tags` | `t` lines to names and values |
//! | `apply` | tags to creases, corners, holes, densities and options |
//! | `edits` | tags to hierarchical edits |
//! | `warnings` | a bounded list of warnings |
mod apply;
mod colors;
mod edits;
mod faces;
mod lines;
mod tags;
mod warnings;

pub(crate) use lines::quoted;
pub(crate) use warnings::Warnings;

use planish_subdiv::mesh::{ControlMesh, FaceVaryingChannel, MAX_ELEMENTS};

use crate::error::Fault;
use crate::{LoadOptions, Mesh, Warning};
use colors::Colors;
use faces::Faces;
use lines::{Line, Lines, Tokens, number};
use tags::Tag;

/// What the channel of texture coordinates is called, as in USD.
const UV_NAME: &str = "st";

/// The byte order mark with which some editors begin UTF-8 files.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Reads an OBJ file's bytes into a mesh. `name` is its name if the file gives none.
pub(crate) fn read(name: &str, bytes: &[u8], options: &LoadOptions) -> Result<(Mesh, Vec<Warning>), Fault> {
    let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    refuse_zero_bytes(bytes)?;
    let mut reader = Reader::default();
    for line in Lines::new(bytes) {
        reader.statement(&line)?;
    }
    reader.finish(name, options)
}

/// A zero byte stands in no text: the file is binary, UTF-16, or was cut short by a full disk.
fn refuse_zero_bytes(bytes: &[u8]) -> Result<(), Fault> {
    if !bytes.contains(&0) {
        return Ok(());
    }
    let before = bytes.iter().take_while(|&&byte| byte != 0);
    let line = 1 + before.filter(|&&byte| byte == b'\n').count();
    Err(Fault::at(u32::try_from(line).unwrap_or(u32::MAX), "a zero byte", "text: this is not an OBJ file"))
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    colors: Colors,
    uvs: Vec<[f32; 2]>,
    faces: Faces,
    tags: Vec<Tag>,
    object_name: Option<String>,
    warnings: Warnings,
}

impl Reader {
    fn statement(&mut self, line: &Line) -> Result<(), Fault> {
        let mut tokens = line.tokens();
        match tokens.next() {
            Some(b"v") => {
                self.positions.push(coordinates(line.number, &mut tokens, "v", 3)?);
                self.colors.read(line.number, tokens, self.positions.len())?;
            }
            Some(b"vt") => self.uvs.push(coordinates(line.number, &mut tokens, "vt", 1)?),
            Some(b"f") => self.faces.read(line.number, tokens, self.positions.len(), self.uvs.len())?,
            Some(b"t") => self.tags.extend(Tag::read(line.number, tokens, &mut self.warnings)?),
            Some(b"o") if self.object_name.is_none() => {
                let words: Vec<_> = tokens.map(String::from_utf8_lossy).collect();
                self.object_name = Some(words.join(" ")).filter(|name| !name.is_empty());
            }
            Some(keyword) if keyword.iter().any(|byte| byte.is_ascii_control()) => {
                return Err(Fault::at(line.number, quoted(keyword), "text: this is not an OBJ file"));
            }
            _ => {}
        }
        Ok(())
    }

    fn finish(mut self, name: &str, options: &LoadOptions) -> Result<(Mesh, Vec<Warning>), Fault> {
        if self.positions.is_empty() {
            return Err(Fault::whole("no vertices", "lines `v x y z` and `f 1 2 3 ..`: an OBJ file"));
        }
        refuse_too_many(self.positions.len(), "vertices")?;
        refuse_too_many(self.faces.vertices.len(), "face-vertices")?;
        let face_map = self.faces.check(self.positions.len(), options.repair, &mut self.warnings)?;
        self.faces.drop_unmapped(&face_map);
        if self.faces.sizes.is_empty() {
            return Err(Fault::whole("no faces", "lines `f 1 2 3 ..`"));
        }
        let face_varying = self.uv_channel()?.into_iter().collect();
        let colors = self.colors.finish(self.positions.len(), &mut self.warnings);
        let mut control_mesh = ControlMesh {
            positions: self.positions,
            face_sizes: self.faces.sizes,
            face_vertices: self.faces.vertices,
            face_varying,
            colors,
            ..ControlMesh::default()
        };
        apply::apply(&self.tags, &face_map, &mut control_mesh, &mut self.warnings)?;
        let name = self.object_name.unwrap_or_else(|| name.to_owned());
        let mesh = Mesh { name, control_mesh, ..Mesh::default() };
        Ok((mesh, self.warnings.into_vec()))
    }

    /// The texture coordinates, when corners have them: then every corner must. What face has none could be guessed at,
    /// but its seams could not. Without a single `vt` line there is no channel either, with a warning.
    fn uv_channel(&mut self) -> Result<Option<FaceVaryingChannel>, Fault> {
        let present = self.faces.uvs.iter().filter(|uv| uv.is_some()).count();
        if present == 0 {
            return Ok(None);
        }
        if self.uvs.is_empty() {
            self.warnings.push(None, "faces name vt indices but there are no vt lines: ignored");
            return Ok(None);
        }
        self.faces.check_uvs(self.uvs.len())?;
        if let Some(line) = self.faces.first_line_without_uv() {
            return Err(Fault::at(line, "a corner without vt", "one at every corner of every face, or at none"));
        }
        let indices = self.faces.uvs.iter().flatten().map(|uv| uv.get() - 1).collect();
        Ok(Some(FaceVaryingChannel { name: UV_NAME.to_owned(), values: std::mem::take(&mut self.uvs), indices }))
    }
}

/// Reads up to `N` coordinates, at least `least`, each finite as a 32-bit float; absent ones are 0, further values ignored.
fn coordinates<const N: usize>(line: u32, tokens: &mut Tokens, keyword: &str, least: usize) -> Result<[f32; N], Fault> {
    let mut values = [0.0; N];
    for (index, value) in values.iter_mut().enumerate() {
        let Some(token) = tokens.next() else {
            if index >= least {
                break;
            }
            return Err(Fault::at(line, format!("{keyword} with {index} coordinates"), format!("{least} or more")));
        };
        *value = finite(line, token, "coordinate")?;
    }
    Ok(values)
}

/// A number that is finite as a 32-bit float; `what` it is.
fn finite(line: u32, token: &[u8], what: &str) -> Result<f32, Fault> {
    let parsed = number(token).ok_or_else(|| Fault::at(line, quoted(token), "a number"))?;
    let value = parsed as f32;
    if value.is_finite() {
        return Ok(value);
    }
    Err(Fault::at(line, quoted(token), format!("a finite {what} within 32-bit floating point")))
}

fn refuse_too_many(count: usize, what: &str) -> Result<(), Fault> {
    if count < MAX_ELEMENTS as usize {
        return Ok(());
    }
    Err(Fault::whole(format!("{count} {what}"), format!("fewer than {MAX_ELEMENTS}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_that_indices_cannot_hold_are_refused() {
        assert_eq!(refuse_too_many((1 << 31) - 1, "vertices"), Ok(()));
        let fault = refuse_too_many(1 << 31, "vertices").unwrap_err();
        assert_eq!(fault, Fault::whole("2147483648 vertices", "fewer than 2147483648"));
    }
}
