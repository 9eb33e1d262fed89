//! Where files may go, what is said when they may not, and what is left behind.

use std::{
    fs::{self, File},
    path::Path,
    process::Command,
};

use planish_film::{
    DumpProperties, DumpVertex, Film, ImageFormat, check_dump_output, check_image_output, write_image, write_ply_stream,
};

/// Pixels that do not compress: each channel takes the bits of a counter's hash.
fn noise(width: u32, height: u32) -> Film {
    let value = |i: u32| (i.wrapping_mul(0x9e37_79b9) ^ (i >> 7)).wrapping_mul(0x85eb_ca6b) as f32 / u32::MAX as f32;
    let color = (0..width * height).map(|i| [value(4 * i), value(4 * i + 1), value(4 * i + 2), 1.0]).collect();
    Film { width, height, color, ..Film::default() }
}

fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_extension_chooses_the_format() {
    let folder = tempfile::tempdir().unwrap();
    for (name, magic) in [("a.exr", &b"\x76\x2f\x31\x01"[..]), ("b.PNG", b"\x89PNG"), ("c.ExR", b"\x76\x2f\x31\x01")] {
        let path = folder.path().join(name);
        write_image(&noise(4, 4), &path).unwrap();
        assert!(fs::read(path).unwrap().starts_with(magic), "{name}");
    }
    assert_eq!(check_image_output(&folder.path().join("x.Exr")).unwrap(), ImageFormat::Exr);
    assert_eq!(check_image_output(&folder.path().join("x.png")).unwrap(), ImageFormat::Png);
    check_dump_output(&folder.path().join("x.PLY")).unwrap();
    assert_eq!(entries(folder.path()), ["a.exr", "b.PNG", "c.ExR"]);
}

#[test]
fn other_extensions_are_refused_with_those_accepted() {
    for name in ["a.jpg", "exr", ".exr", "a.exr.", ""] {
        let message = check_image_output(Path::new(name)).unwrap_err().to_string();
        assert_eq!(message, format!("cannot write {name}: its extension must be .exr or .png"));
        assert_eq!(write_image(&noise(1, 1), Path::new(name)).unwrap_err().to_string(), message);
    }
    let message = check_dump_output(Path::new("a.obj")).unwrap_err().to_string();
    assert_eq!(message, "cannot write a.obj: its extension must be .ply");
}

#[test]
fn what_is_in_the_way_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    File::create(at("file")).unwrap();
    fs::create_dir(at("folder.exr")).unwrap();
    let message = |name: &str| {
        let checked = check_image_output(&at(name)).unwrap_err().to_string();
        assert_eq!(write_image(&noise(1, 1), &at(name)).unwrap_err().to_string(), checked);
        checked.replace(&format!("{}/", folder.path().display()), "")
    };
    assert_eq!(message("none/a.exr"), "cannot write none/a.exr: there is no folder none");
    assert_eq!(message("file/a.exr"), "cannot write file/a.exr: file is not a folder");
    assert_eq!(message("folder.exr"), "cannot write folder.exr: it exists and is not a regular file");
    assert_eq!(entries(folder.path()), ["file", "folder.exr"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_the_system_refuses_is_found_before_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("{}.exr", "x".repeat(300)));
    let message = check_image_output(&path).unwrap_err().to_string();
    assert_eq!(message, format!("cannot write {}: File name too long (os error 36)", path.display()));
    assert_eq!(write_image(&noise(2, 2), &path).unwrap_err().to_string(), message);
    assert!(entries(folder.path()).is_empty());
}

/// Renaming over a socket, a pipe or a device would replace it.
#[cfg(unix)]
#[test]
fn what_is_not_a_regular_file_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let (socket, link) = (folder.path().join("socket.png"), folder.path().join("link.png"));
    let _socket = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    std::os::unix::fs::symlink(&socket, &link).unwrap();
    for path in [socket, link] {
        let message = write_image(&noise(1, 1), &path).unwrap_err().to_string();
        assert_eq!(message, format!("cannot write {}: it exists and is not a regular file", path.display()));
    }
    assert_eq!(entries(folder.path()), ["link.png", "socket.png"]);
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_an_ordinary_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (plain, film) = (folder.path().join("plain"), folder.path().join("film.exr"));
    File::create(&plain).unwrap();
    write_image(&noise(2, 2), &film).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&film), mode(&plain));
}

/// A file system that no one can create files in, root included.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_refuses_files_is_found_before_rendering() {
    let path = Path::new("/sys/planish.exr");
    if !Path::new("/sys/kernel").is_dir() {
        eprintln!("skipped: /sys is not mounted");
        return;
    }
    let message = check_image_output(path).unwrap_err().to_string();
    assert!(message.starts_with("cannot write /sys/planish.exr: ") && message.contains("(os error"), "{message}");
    assert!(!message.contains(".planish-"), "{message}");
}

/// A file system of 128 KiB, unmounted on drop.
struct SmallDisk(tempfile::TempDir);

impl SmallDisk {
    /// Nothing where mounting is not permitted.
    fn mount() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let mounted =
            Command::new("mount").args(["-t", "tmpfs", "-o", "size=128k", "tmpfs"]).arg(folder.path()).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(Self(folder))
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let unmounted = Command::new("umount").arg(self.0.path()).status();
        assert!(unmounted.is_ok_and(|status| status.success()), "{} stays mounted", self.0.path().display());
    }
}

#[test]
fn a_full_disk_leaves_the_old_file_and_no_other() {
    let Some(disk) = SmallDisk::mount() else {
        eprintln!("skipped: mounting a small file system is not permitted here");
        return;
    };
    let folder = disk.0.path();
    let large = noise(256, 256);
    for name in ["film.exr", "film.png", "dump.ply"] {
        let path = folder.join(name);
        fs::write(&path, "old").unwrap();
        let written = match name {
            "dump.ply" => {
                write_ply_stream(&path, 30_000, DumpProperties::default(), (0..30_000).map(|_| DumpVertex::default()))
            }
            _ => write_image(&large, &path),
        };
        let message = written.unwrap_err().to_string();
        assert_eq!(message, format!("cannot write {}: No space left on device (os error 28)", path.display()));
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }
    assert_eq!(entries(folder), ["dump.ply", "film.exr", "film.png"]);
}
