//! Files that are whole are told from those that are not.

use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use planish_film::{Compression, ExrOptions, Film, Layer, is_complete, write_exr_with, write_png};

fn film() -> Film {
    let color = (0_u32..9 * 40).map(|i| [(i.wrapping_mul(0x9e37_79b9) >> 8) as f32, 0.5, 0.25, 1.0]).collect();
    Film { width: 9, height: 40, color, layers: vec![Layer::uint("face", (0..360).collect())], ..Film::default() }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let exr = |name: &str, compression, multipart| {
        let path = folder.join(name);
        write_exr_with(&film(), &path, &ExrOptions { compression, multipart }).unwrap();
        path
    };
    let png = folder.join("film.png");
    write_png(&film(), &png).unwrap();
    vec![
        exr("zip.exr", Compression::Zip, false),
        exr("none.exr", Compression::None, false),
        exr("parts.exr", Compression::Zips, true),
        png,
    ]
}

#[test]
fn whole_files_are_complete() {
    let folder = tempfile::tempdir().unwrap();
    for file in files(folder.path()) {
        assert!(is_complete(&file), "{}", file.display());
    }
}

#[test]
fn no_file_that_is_cut_is_complete() {
    let folder = tempfile::tempdir().unwrap();
    for file in files(folder.path()) {
        let handle = File::options().write(true).open(&file).unwrap();
        for length in (0..handle.metadata().unwrap().len()).rev() {
            handle.set_len(length).unwrap();
            assert!(!is_complete(&file), "{length} bytes of {}", file.display());
        }
    }
}

#[test]
fn a_file_whose_offsets_were_never_written_is_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    let file = &files(folder.path())[0];
    let bytes = fs::read(file).unwrap();
    // Three blocks of 16 rows; the first follows the table at once.
    let table = (0..bytes.len() - 8).find(|&at| bytes[at..at + 8] == (at as u64 + 24).to_le_bytes()).unwrap();
    let mut broken = bytes;
    broken[table + 16..table + 24].fill(0);
    fs::write(file, &broken).unwrap();
    assert!(!is_complete(file));
}

#[test]
fn no_byte_of_a_file_that_is_wrong_ends_the_program() {
    let folder = tempfile::tempdir().unwrap();
    for file in files(folder.path()) {
        let bytes = fs::read(&file).unwrap();
        let mut handle = File::options().write(true).open(&file).unwrap();
        let mut put = |at: usize, byte: u8| {
            handle.seek(SeekFrom::Start(at as u64)).unwrap();
            handle.write_all(&[byte]).unwrap();
        };
        for (at, &right) in bytes.iter().enumerate().take(1200) {
            for wrong in [0x00, 0x7f, 0xff] {
                put(at, wrong);
                is_complete(&file);
            }
            put(at, right);
        }
        assert!(is_complete(&file));
    }
}

#[test]
fn what_is_no_image_is_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("text.exr"), "text").unwrap();
    fs::write(path.join("image.txt"), fs::read(&files(path)[0]).unwrap()).unwrap();
    fs::create_dir(path.join("folder.exr")).unwrap();
    for name in ["text.exr", "image.txt", "folder.exr", "none.exr.png"] {
        assert!(!is_complete(&path.join(name)), "{name}");
    }
}
