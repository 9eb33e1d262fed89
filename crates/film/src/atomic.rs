//! Files that are complete or absent.

use std::{
    ffi::OsStr,
    fs::{self, File},
    io::{self, BufWriter, Write},
    path::Path,
    time::{Duration, SystemTime},
};

use tempfile::NamedTempFile;

use crate::{Error, Result};

/// Bytes gathered before they go to the system: large enough that a call costs nothing next to its copy.
const BUFFER_BYTES: usize = 1 << 20;

/// Writes `path` by `fill`: into a temporary file in the same folder, flushed to the device, then renamed over `path`.
///
/// On any error the temporary file is gone and what was at `path` is untouched. The result has the permissions of an
/// ordinary new file. A symbolic link at `path` is replaced, not followed.
///
/// # Errors
/// Those of `fill`; [`Error::Write`] and the errors of [`check_target`].
pub(crate) fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<&File>) -> Result<()>) -> Result<()> {
    write_with(path, fill, File::sync_all)
}

/// Writes bytes that can be made again: as other files, but not flushed to the device, which takes longer than what small files hold is
/// worth. After a power failure the file may be cut off or hold zeros: whoever reads it needs a checksum.
///
/// # Errors
/// [`Error::NoFolder`], [`Error::NotAFolder`], [`Error::NotAFile`], [`Error::Write`].
pub fn write_scratch(path: &Path, bytes: &[u8]) -> Result<()> {
    write_with(path, |writer| writer.write_all(bytes).map_err(|source| Error::write(path, source)), |_| Ok(()))
}

fn write_with(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&File>) -> Result<()>,
    finish: impl FnOnce(&File) -> io::Result<()>,
) -> Result<()> {
    check_target(path)?;
    let failed = |source| Error::write(path, source);
    let temporary = create_beside(path).map_err(failed)?;
    let mut writer = BufWriter::with_capacity(BUFFER_BYTES, temporary.as_file());
    let filled = fill(&mut writer).and_then(|()| writer.flush().map_err(failed));
    // What an error left in the buffer must not be written on drop: the file is about to go.
    let (file, _) = writer.into_parts();
    filled?;
    finish(file).map_err(failed)?;
    temporary.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Whether a file could be written to `path` now: its folder takes new files, and nothing but a regular file is in the
/// way.
///
/// # Errors
/// [`Error::NoFolder`], [`Error::NotAFolder`], [`Error::NotAFile`]; [`Error::Write`] where the folder refuses a file.
pub(crate) fn check(path: &Path) -> Result<()> {
    check_target(path)?;
    create_beside(path).and_then(NamedTempFile::close).map_err(|source| Error::write(path, source))
}

fn check_target(path: &Path) -> Result<()> {
    let to_path = || path.to_owned();
    match fs::metadata(folder(path)) {
        Ok(metadata) if metadata.is_dir() => {}
        Ok(_) => return Err(Error::NotAFolder { path: to_path(), folder: folder(path).to_owned() }),
        Err(error) => {
            return Err(match error.kind() {
                io::ErrorKind::NotFound => Error::NoFolder { path: to_path(), folder: folder(path).to_owned() },
                _ => Error::write(path, error),
            });
        }
    }
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => Ok(()),
        Ok(_) => Err(Error::NotAFile { path: to_path() }),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Error::write(path, error)),
    }
}

/// The folder that `path` lies in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What names of temporary files begin with; random letters and digits follow.
const TEMPORARY_PREFIX: &str = ".planish-";

/// How many of them.
const RANDOM_LENGTH: usize = 6;

/// A temporary file that was not written to for so long belongs to a process that is gone.
const STALE: Duration = Duration::from_secs(3600);

/// Removes the temporary files that a process which was killed left beside `path`: those with names of ours that were
/// not written to for an hour. Returns how many; what cannot be listed or removed is left.
pub fn remove_stale_files(path: &Path) -> usize {
    let Ok(entries) = fs::read_dir(folder(path)) else { return 0 };
    let stale = entries.flatten().filter(|entry| {
        let is_old = |modified: SystemTime| modified.elapsed().is_ok_and(|age| age >= STALE);
        let metadata = entry.metadata();
        is_temporary(&entry.file_name())
            && metadata.is_ok_and(|metadata| metadata.is_file() && metadata.modified().is_ok_and(is_old))
    });
    stale.filter(|entry| fs::remove_file(entry.path()).is_ok()).count()
}

fn is_temporary(name: &OsStr) -> bool {
    let random = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY_PREFIX));
    random.is_some_and(|random| random.len() == RANDOM_LENGTH && random.bytes().all(|b| b.is_ascii_alphanumeric()))
}

/// Opened as any new file, so with its permissions; `tempfile` by itself would make it its owner's alone.
fn create_beside(path: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY_PREFIX).rand_bytes(RANDOM_LENGTH);
    builder.make_in(folder(path), |temporary| File::create_new(temporary))
}

impl Error {
    /// [`Error::Write`].
    pub(crate) fn write(path: &Path, source: io::Error) -> Self {
        Error::Write { path: path.to_owned(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_half_way_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("old.exr");
        fs::write(&path, "old").unwrap();
        let error = write(&path, |writer| {
            let bytes = vec![7; 3 * BUFFER_BYTES / 2];
            writer.write_all(&bytes).unwrap();
            Err(Error::EmptyFilm { width: 0, height: 0 })
        });
        assert!(matches!(error, Err(Error::EmptyFilm { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new.exr");
        fs::write(&path, "old and longer").unwrap();
        write(&path, |writer| writer.write_all(b"new").map_err(|source| Error::write(&path, source))).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn scratch_is_replaced_whole_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.table");
        for content in [b"old and longer".as_slice(), b"new", b""] {
            write_scratch(&path, content).unwrap();
            assert_eq!(fs::read(&path).unwrap(), content);
        }
        assert!(write_scratch(&folder.path().join("none/a.table"), b"new").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn only_old_files_with_names_of_ours_are_stale() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let old = SystemTime::now() - 2 * STALE;
        let make = |name: &str, modified: SystemTime| {
            File::create(folder.path().join(name)).unwrap().set_modified(modified).unwrap();
        };
        let own = create_beside(&path).unwrap();
        own.as_file().set_modified(old).unwrap();
        make(".planish-abcDE1", SystemTime::now());
        for name in ["a.exr", ".planish-", ".planish-abc", ".planish-notes!", ".planish-abcdef.exr"] {
            make(name, old);
        }
        fs::create_dir(folder.path().join(".planish-folder")).unwrap();
        assert_eq!(remove_stale_files(&path), 1);
        assert!(!own.path().exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 7);
        assert_eq!(remove_stale_files(&folder.path().join("none/a.exr")), 0);
    }

    #[test]
    fn a_bare_file_name_lies_in_the_current_folder() {
        assert_eq!(folder(Path::new("a.exr")), Path::new("."));
        assert_eq!(folder(Path::new("b/a.exr")), Path::new("b"));
        assert_eq!(folder(Path::new("/a.exr")), Path::new("/"));
    }
}
