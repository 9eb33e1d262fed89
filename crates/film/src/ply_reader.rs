//! Dumps, read back.

use std::{
    fs::File,
    io::{self, BufRead, BufReader, Read},
    path::Path,
};

use crate::ply::{TRIANGLE_BYTES, triangle_bytes};
use crate::ply_header::{self, Fault, Header, Layout, MAX_HEADER_BYTES, fault};
use crate::{DumpVertex, Error};

/// Bytes that are read at once.
const BUFFER_BYTES: usize = 1 << 20;

/// Why reading stopped.
enum Stop {
    System(io::Error),
    Fault(Fault),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Stop::System(error)
    }
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Stop::Fault(fault)
    }
}

/// Reads what [`crate::write_ply_stream`] writes, vertex by vertex, three a triangle; what a dump does not have of
/// [`DumpVertex`] is 0. No memory is taken for what the header merely claims, and on an error some vertices may have
/// been handed out.
///
/// # Errors
/// [`Error::Read`]; [`Error::NotADump`] where the file is no binary little-endian PLY of a triangle soup with all
/// properties of a dump, ends early, or goes on.
pub fn read_ply_stream(path: &Path, take: impl FnMut(DumpVertex)) -> crate::Result<()> {
    let to_path = || path.to_owned();
    let file = File::open(path).map_err(|source| Error::Read { path: to_path(), source })?;
    read(&mut BufReader::with_capacity(BUFFER_BYTES, file), take).map_err(|stop| match stop {
        Stop::System(source) => Error::Read { path: to_path(), source },
        Stop::Fault((found, expected)) => Error::NotADump { path: to_path(), found, expected },
    })
}

fn read(reader: &mut impl BufRead, mut take: impl FnMut(DumpVertex)) -> Result<(), Stop> {
    let Header { vertex_count, layout } = read_header(reader)?;
    let mut row = vec![0; layout.stride];
    for index in 0..vertex_count {
        let end = || fault(format!("the end of the file in vertex {index}"), format!("{vertex_count} vertices"));
        fill(reader, &mut row, end)?;
        take(layout.vertex(&row));
    }
    let mut bytes = [0; TRIANGLE_BYTES];
    let triangle_count = vertex_count / 3;
    for index in 0..triangle_count {
        let end = || fault(format!("the end of the file in triangle {index}"), format!("{triangle_count} triangles"));
        fill(reader, &mut bytes, end)?;
        if i32::try_from(3 * index).ok().map(triangle_bytes) != Some(bytes) {
            return Err(fault(format!("triangle {index} of other vertices"), "the next three").into());
        }
    }
    if reader.fill_buf()?.is_empty() { Ok(()) } else { Err(fault("bytes after the last triangle", "none").into()) }
}

/// Fills `bytes`, or says where the file ended.
fn fill(reader: &mut impl BufRead, bytes: &mut [u8], end: impl FnOnce() -> Fault) -> Result<(), Stop> {
    reader.read_exact(bytes).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => Stop::Fault(end()),
        _ => Stop::System(error),
    })
}

fn read_header(reader: &mut impl BufRead) -> Result<Header, Stop> {
    let mut reader = reader.take(MAX_HEADER_BYTES);
    let mut first = [0; 3];
    fill(&mut reader, &mut first, || fault("a file that is no PLY", "a dump"))?;
    let mut lines = Vec::new();
    loop {
        let mut line = Vec::new();
        reader.read_until(b'\n', &mut line)?;
        if first != *b"ply" || (lines.is_empty() && !line.trim_ascii().is_empty()) {
            return Err(fault("a file that is no PLY", "a dump").into());
        }
        if line.pop() != Some(b'\n') {
            return Err(fault("a header without an end", "end_header").into());
        }
        let line = String::from_utf8_lossy(line.trim_ascii_end()).into_owned();
        if line == "end_header" {
            return Ok(ply_header::parse(&lines[1..])?);
        }
        lines.push(line);
    }
}

impl Layout {
    fn vertex(&self, row: &[u8]) -> DumpVertex {
        let word = |at: usize| [0, 1, 2, 3].map(|byte| row[at + byte]);
        let float = |index: usize| self.floats[index].map_or(0.0, |at| f32::from_le_bytes(word(at)));
        DumpVertex {
            position: [0, 1, 2].map(float),
            normal: [3, 4, 5].map(float),
            uv: [6, 7].map(float),
            face: i32::from_le_bytes(word(self.face)),
            level: row[self.level],
            kind: row[self.kind],
            tex_coord: [8, 9].map(float),
            shading_normal: [10, 11, 12].map(float),
            color: [13, 14, 15].map(float),
        }
    }
}
