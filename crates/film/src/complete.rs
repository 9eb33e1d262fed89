//! Whether a file that is there needs no second rendering.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};

use crate::ImageFormat;

/// The bytes that every PNG file begins with.
const PNG_SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// Whether `path` is an EXR or PNG file, by its extension, that is whole: its header can be read, and all pixels that it
/// tells of are in the file. Pixels are not decoded. EXR files of tiles or deep pixels are none of ours: false.
///
/// Files of this crate are whole or absent; this finds those that something else cut, or that are none.
pub fn is_complete(path: &Path) -> bool {
    let check = match ImageFormat::from_path(path) {
        Ok(ImageFormat::Exr) => is_whole_exr,
        Ok(ImageFormat::Png) => is_whole_png,
        Err(_) => return false,
    };
    // Opening a pipe would wait for a writer.
    let is_file = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    is_file && File::open(path).and_then(check).unwrap_or(false)
}

/// Header and table of offsets can be read, each block begins after them, and the last ends with the file or before.
fn is_whole_exr(mut file: File) -> io::Result<bool> {
    let length = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    let mut reader = BufReader::new(file);
    let Ok(meta) = MetaData::read_from_buffered(&mut reader, false) else { return Ok(false) };
    let block_count: u64 = meta.headers.iter().map(|header| header.chunk_count as u64).sum();
    let first_block = reader.stream_position()?.saturating_add(block_count.saturating_mul(8));
    let is_scan_lines = |header: &Header| header.blocks == BlockDescription::ScanLines && !header.deep;
    if first_block > length || !meta.headers.iter().all(is_scan_lines) {
        return Ok(false);
    }
    let (mut least, mut last) = (u64::MAX, 0);
    for _ in 0..block_count {
        let offset = u64::from_le_bytes(bytes(&mut reader)?);
        (least, last) = (least.min(offset), last.max(offset));
    }
    if block_count == 0 || least < first_block || last >= length {
        return Ok(false);
    }
    let part_number = if meta.requirements.has_multiple_layers { 4 } else { 0 };
    const ROW_NUMBER: u64 = 4;
    reader.seek(SeekFrom::Start(last + part_number + ROW_NUMBER))?;
    let size = i32::from_le_bytes(bytes(&mut reader)?);
    Ok(u64::try_from(size).is_ok_and(|size| reader.stream_position().is_ok_and(|start| start + size <= length)))
}

/// From chunk to chunk up to IEND, with which the file ends. Checksums are not computed.
fn is_whole_png(mut file: File) -> io::Result<bool> {
    let length = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    let mut reader = BufReader::new(file);
    if bytes(&mut reader)? != PNG_SIGNATURE {
        return Ok(false);
    }
    loop {
        const CHECKSUM: i64 = 4;
        let size = u32::from_be_bytes(bytes(&mut reader)?);
        let kind: [u8; 4] = bytes(&mut reader)?;
        reader.seek_relative(i64::from(size) + CHECKSUM)?;
        if kind == *b"IEND" {
            return Ok(reader.stream_position()? == length);
        }
    }
}

fn bytes<const N: usize>(reader: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    reader.read_exact(&mut bytes)?;
    Ok(bytes)
}
