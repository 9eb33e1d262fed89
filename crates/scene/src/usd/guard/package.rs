//! Entries of packages: archives of ZIP, whose sizes are not trusted.
use std::io::{Cursor, Read, Seek};

use zip::ZipArchive;

use crate::gltf::fault::Fault;

/// What an archive begins with: an entry, or the end of an empty one.
const MAGICS: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];
/// Packages store entries as they are. Those of other tools are expanded, up to so many times the whole package.
const EXPANSION: u64 = 16;

pub fn is_package(bytes: &[u8]) -> bool {
    MAGICS.iter().any(|magic| bytes.starts_with(magic))
}

/// Refuses what is no archive.
pub fn check(bytes: &[u8]) -> Result<(), Fault> {
    open(Cursor::new(bytes)).map(|_| ())
}

fn open<R: Read + Seek>(package: R) -> Result<ZipArchive<R>, Fault> {
    ZipArchive::new(package).map_err(|error| Fault::new("package", format!("a damaged archive: {error}"), "one of ZIP"))
}

/// The content of an entry, of at most so many bytes.
pub fn entry(package: impl Read + Seek, size: u64, name: &str, most: u64) -> Result<Vec<u8>, Fault> {
    let mut archive = open(package)?;
    let place = || format!("package entry {name:?}");
    let damaged = |error: &dyn std::fmt::Display| Fault::new(place(), error.to_string(), "an entry that can be read");
    let entry = archive.by_name(name).map_err(|error| damaged(&error))?;
    let most = most.min(size.saturating_mul(EXPANSION));
    let mut content = Vec::new();
    entry.take(most.saturating_add(1)).read_to_end(&mut content).map_err(|error| damaged(&error))?;
    if content.len() as u64 > most {
        let found = format!("more than {most} bytes in a package of {size}");
        return Err(Fault::new(place(), found, "an entry that is stored as it is"));
    }
    Ok(content)
}
