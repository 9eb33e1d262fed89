//! Tables of limit weights that were made before: a file each, named after what the table follows from.
//!
//! | bytes | |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 8 | u64: bytes of the key |
//! | 8 | u64: bytes of the content |
//! | | the key: all that the table follows from, so that two keys of one name are no more than a miss |
//! | | the content |
//! | 8 | u64: XXH3 of all before |
//!
//! Little-endian. A file that is anything else is as good as none, and written anew. Files are written beside their place and renamed, so
//! processes may share a folder, and anything in it may be deleted at any time.

use std::cell::Cell;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use planish_film::{remove_stale_files, write_scratch};
use planish_subdiv::tables::BasisCache;
use twox_hash::{XxHash3_64, XxHash3_128};

use crate::console::Console;

/// First bytes of a file, with the version of its layout.
const MAGIC: &[u8; 8] = b"PLTABLE1";
/// Bytes before the key, and after the content.
const HEAD_BYTES: usize = 24;
const CHECKSUM_BYTES: usize = 8;
/// Larger files are neither written nor read: 13 KB a point, of which a face at a vertex of valence 2,000 has 4,000.
const MAX_FILE_BYTES: u64 = 64 << 20;
/// What the files of a folder may take before a run adds some: ten scenes where hardly two faces are alike.
const MAX_FOLDER_BYTES: u64 = 1 << 30;
/// A file that was last used longer ago than this is marked as used.
const USE_PRECISION: Duration = Duration::from_secs(24 * 3600);
/// What names of files end with, after the hash of the key in hexadecimal digits.
const EXTENSION: &str = "table";
const HASH_DIGITS: usize = 32;
/// Stands for no folder on the command line.
const NONE: &str = "none";

/// A folder of tables, or none.
pub struct TableCache<'a> {
    folder: Option<PathBuf>,
    /// Somebody wants to know where nothing can be written.
    is_asked_for: bool,
    console: &'a Console,
    /// A file could not be written: no other is tried.
    has_failed: Cell<bool>,
    has_room: Cell<bool>,
}

impl<'a> TableCache<'a> {
    /// In the folder that is asked for, else the user's own.
    pub fn new(asked: Option<&Path>, console: &'a Console) -> Self {
        let own = || default_folder(std::env::var_os("XDG_CACHE_HOME"), std::env::var_os("HOME"));
        let folder = match asked {
            Some(folder) => Some(folder.to_owned()).filter(|folder| folder != Path::new(NONE)),
            None => own(),
        };
        let is_asked_for = asked.is_some();
        Self { folder, is_asked_for, console, has_failed: Cell::new(false), has_room: Cell::new(false) }
    }

    fn write(&self, folder: &Path, key: &[u8], content: &[u8]) -> Result<(), String> {
        let told = |error: io::Error| format!("cannot make {}: {error}", folder.display());
        let path = path_of(folder, key);
        if !self.has_room.replace(true) {
            fs::create_dir_all(folder).map_err(told)?;
            remove_stale_files(&path);
            make_room(folder, MAX_FOLDER_BYTES);
        }
        write_scratch(&path, &encoded(key, content)).map_err(|error| error.to_string())
    }
}

impl BasisCache for TableCache<'_> {
    fn load(&self, key: &[u8]) -> Option<Vec<u8>> {
        let path = path_of(self.folder.as_ref()?, key);
        // A pipe would be waited for.
        let metadata = fs::metadata(&path).ok().filter(fs::Metadata::is_file)?;
        let mut file = File::open(&path).ok()?;
        let content = decoded(&mut file, metadata.len(), key)?;
        let is_old = |used: SystemTime| used.elapsed().is_ok_and(|age| age > USE_PRECISION);
        if metadata.modified().is_ok_and(is_old) {
            // Where that is not allowed it seems older than it is.
            let _ = file.set_modified(SystemTime::now());
        }
        Some(content)
    }

    fn store(&self, key: &[u8], content: &[u8]) {
        let Some(folder) = self.folder.as_ref().filter(|_| !self.has_failed.get()) else { return };
        if file_bytes(key.len() as u64, content.len() as u64).is_none() {
            return;
        }
        if let Err(why) = self.write(folder, key, content) {
            self.has_failed.set(true);
            let told = format!("tables are not kept: {why}");
            if self.is_asked_for { self.console.warn(told) } else { self.console.explain(told) }
        }
    }
}

/// As the XDG base directory specification has it: paths that are not absolute do not count.
fn default_folder(cache_home: Option<OsString>, home: Option<OsString>) -> Option<PathBuf> {
    let absolute = |path: OsString| Some(PathBuf::from(path)).filter(|path| path.is_absolute());
    let caches = cache_home.and_then(absolute).or_else(|| Some(home.and_then(absolute)?.join(".cache")));
    Some(caches?.join("planish").join("tables"))
}

fn path_of(folder: &Path, key: &[u8]) -> PathBuf {
    folder.join(format!("{:0HASH_DIGITS$x}.{EXTENSION}", XxHash3_128::oneshot(key)))
}

/// Length of a file, unless that is too long.
fn file_bytes(key_bytes: u64, content_bytes: u64) -> Option<u64> {
    let frame = (HEAD_BYTES + CHECKSUM_BYTES) as u64;
    key_bytes.checked_add(content_bytes)?.checked_add(frame).filter(|&bytes| bytes <= MAX_FILE_BYTES)
}

fn encoded(key: &[u8], content: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend([key, content].map(|part| (part.len() as u64).to_le_bytes()).as_flattened());
    bytes.extend(key);
    bytes.extend(content);
    bytes.extend(XxHash3_64::oneshot(&bytes).to_le_bytes());
    bytes
}

/// The content of a file of this length, if it is one of this key. Nothing is allocated that the file does not hold.
fn decoded(file: &mut impl Read, length: u64, key: &[u8]) -> Option<Vec<u8>> {
    let mut head = [0; HEAD_BYTES];
    file.read_exact(&mut head).ok()?;
    let (magic, lengths) = head.split_first_chunk()?;
    let [key_bytes, content_bytes] = [0, 1].map(|i| u64::from_le_bytes(lengths.as_chunks().0[i]));
    let is_ours = magic == MAGIC && key_bytes == key.len() as u64;
    if !is_ours || file_bytes(key_bytes, content_bytes) != Some(length) {
        return None;
    }
    let mut bytes = head.to_vec();
    bytes.reserve_exact(length as usize - HEAD_BYTES);
    // A file that has grown meanwhile is not read to its end.
    file.take(length - HEAD_BYTES as u64).read_to_end(&mut bytes).ok()?;
    let (told, checksum) = bytes.split_last_chunk()?;
    let is_whole = bytes.len() as u64 == length && XxHash3_64::oneshot(told) == u64::from_le_bytes(*checksum);
    let content = told.get(HEAD_BYTES..)?.strip_prefix(key)?;
    is_whole.then(|| content.to_vec())
}

fn is_table(path: &Path) -> bool {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let is_hash = stem.len() == HASH_DIGITS && stem.bytes().all(|digit| digit.is_ascii_hexdigit());
    is_hash && path.extension().is_some_and(|extension| extension == EXTENSION)
}

/// Removes the tables that were not used for the longest, until the others take no more than `most` bytes.
fn make_room(folder: &Path, most: u64) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let tables = entries.flatten().map(|entry| (entry.path(), entry.metadata())).filter(|(path, _)| is_table(path));
    let mut tables: Vec<(SystemTime, PathBuf, u64)> = tables
        .filter_map(|(path, metadata)| {
            let metadata = metadata.ok().filter(fs::Metadata::is_file)?;
            Some((metadata.modified().ok()?, path, metadata.len()))
        })
        .collect();
    tables.sort_unstable();
    let mut sum: u64 = tables.iter().map(|(_, _, bytes)| bytes).sum();
    for (_, path, bytes) in tables {
        if sum <= most {
            break;
        }
        // Another process may have been faster.
        let _ = fs::remove_file(path);
        sum -= bytes;
    }
}

#[cfg(test)]
mod tests;
