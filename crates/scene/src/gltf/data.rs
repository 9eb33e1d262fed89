//! The file's bytes: buffers, views into them, and how much may be made of them.
use std::borrow::Cow;
use std::cell::Cell;
use std::io::Read as _;
use std::path::Path;

use ::gltf::json::{Index, Root, buffer};

use super::fault::{Fault, at};
use super::uri::{Target, follow};

/// Bytes that may be made of every byte of a file: accessors may share bytes, and need have none (sparse ones).
const EXPANSION: u64 = 128;
/// Bytes that may be made of any file, however small.
const LEAST_BUDGET: u64 = 64 << 20;

/// A file and what it refers to.
pub struct Data<'a> {
    pub path: &'a Path,
    pub root: &'a Root,
    buffers: Vec<Cow<'a, [u8]>>,
    budget: Cell<u64>,
}

impl<'a> Data<'a> {
    /// Reads the buffers. `byte_count`: of the scene file.
    pub fn read(path: &'a Path, root: &'a Root, blob: Option<&'a [u8]>, byte_count: usize) -> Result<Self, Fault> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            buffers.push(read_buffer(path, index, buffer, blob)?);
        }
        let held = buffers.iter().map(|buffer| buffer.len() as u64).sum::<u64>() + byte_count as u64;
        Ok(Self { path, root, buffers, budget: Cell::new(held.saturating_mul(EXPANSION).max(LEAST_BUDGET)) })
    }

    /// Takes note of memory that is about to be used for what stands at `place`; refuses what no honest file needs.
    pub fn spend(&self, byte_count: u64, place: &str) -> Result<(), Fault> {
        let left = self.budget.get();
        self.budget.set(left.checked_sub(byte_count).ok_or_else(|| {
            Fault::new(place, format!("a claim of {byte_count} bytes"), format!("at most {left}: the file is small"))
        })?);
        Ok(())
    }

    /// The bytes of a view, and its stride.
    pub fn view(&self, index: Index<buffer::View>, place: &str) -> Result<(&[u8], Option<usize>), Fault> {
        let view = at(&self.root.buffer_views, index.value(), "bufferViews", || place.to_owned())?;
        let place = || format!("bufferViews[{}]", index.value());
        let bytes = at(&self.buffers, view.buffer.value(), "buffers", place)?;
        let offset = view.byte_offset.unwrap_or_default().0;
        let content = offset.checked_add(view.byte_length.0).and_then(|end| {
            let range = usize::try_from(offset).ok()?..usize::try_from(end).ok()?;
            bytes.get(range)
        });
        let content = content.ok_or_else(|| {
            let found = format!("bytes {offset} and {} more", view.byte_length.0);
            Fault::new(place(), found, format!("at most the {} of buffer {}", bytes.len(), view.buffer.value()))
        })?;
        let stride = view.byte_stride.map(|stride| stride.0);
        match stride {
            Some(stride) if !(buffer::MIN_BYTE_STRIDE..=buffer::MAX_BYTE_STRIDE).contains(&stride) => {
                Err(Fault::new(place(), format!("a stride of {stride}"), "4 to 252"))
            }
            _ => Ok((content, stride)),
        }
    }
}

fn read_buffer<'a>(
    path: &Path,
    index: usize,
    buffer: &buffer::Buffer,
    blob: Option<&'a [u8]>,
) -> Result<Cow<'a, [u8]>, Fault> {
    let place = format!("buffers[{index}]");
    let length = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
    let mut bytes = match (&buffer.uri, blob) {
        (Some(uri), _) => match follow(path, uri, &place)? {
            Target::Bytes(bytes) => Cow::Owned(bytes),
            Target::File(file) => Cow::Owned(read_file(&file, length, &place)?),
        },
        (None, Some(blob)) if index == 0 => Cow::Borrowed(blob),
        (None, _) => return Err(Fault::new(place, "no uri", "one, or the first buffer of a GLB with a binary chunk")),
    };
    if bytes.len() < length {
        return Err(Fault::new(place, format!("{} bytes", bytes.len()), format!("the {length} of byteLength")));
    }
    // A GLB's chunk is padded.
    match &mut bytes {
        Cow::Owned(bytes) => bytes.truncate(length),
        Cow::Borrowed(bytes) => *bytes = &bytes[..length],
    }
    Ok(bytes)
}

/// At most the first `length` bytes of a plain file.
fn read_file(file: &Path, length: usize, place: &str) -> Result<Vec<u8>, Fault> {
    let refuse = |error: &dyn std::fmt::Display| {
        Fault::new(place, format!("{}, which cannot be read: {error}", file.display()), "a file of bytes")
    };
    let metadata = std::fs::metadata(file).map_err(|error| refuse(&error))?;
    if !metadata.is_file() {
        return Err(refuse(&"not a plain file"));
    }
    let mut bytes = Vec::new();
    let opened = std::fs::File::open(file).map_err(|error| refuse(&error))?;
    opened.take(length as u64).read_to_end(&mut bytes).map_err(|error| refuse(&error))?;
    Ok(bytes)
}
