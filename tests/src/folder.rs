//! Folders to write into, which must end as they were meant to.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// A new folder that goes when it is dropped.
pub fn temporary() -> TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// What every file of a folder holds, those in folders below it included. Two are equal if nothing has changed.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.expect("the folder can be listed").path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                contents(&path)
            } else {
                let bytes = fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                BTreeMap::from([(path, bytes)])
            }
        })
        .collect()
}

/// A file system of a few kilobytes, which is soon full.
pub struct SmallDisk {
    folder: TempDir,
}

impl SmallDisk {
    /// Mounts one; none, with a word about it, where this user may not.
    pub fn mount(kilobytes: u32) -> Option<Self> {
        let folder = temporary();
        let mut command = Command::new("mount");
        command.args(["-t", "tmpfs", "-o", &format!("size={kilobytes}k"), "planish-small-disk"]).arg(folder.path());
        match command.output() {
            Ok(output) if output.status.success() => Some(Self { folder }),
            Ok(output) => {
                let told = String::from_utf8_lossy(&output.stderr);
                eprintln!("skipped: no small disk can be mounted: {}", told.trim_end());
                None
            }
            Err(error) => {
                eprintln!("skipped: no small disk can be mounted: {error}");
                None
            }
        }
    }

    /// Where it is mounted.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let unmounted = Command::new("umount").arg(self.path()).status();
        if !unmounted.is_ok_and(|status| status.success()) {
            eprintln!("{} is still mounted", self.path().display());
        }
    }
}
