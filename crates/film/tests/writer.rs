//! Films that are written on a thread of their own.

use std::fs;
use std::path::Path;
use std::time::Duration;

use planish_film::{Film, FilmWriter, Target, WriteOptions, is_complete, write_image};

fn film(seed: usize) -> Film {
    let color = (0..64 * 48).map(|i| [((i * (seed + 1)) % 97) as f32 / 97.0, 0.5, 0.25, 1.0]).collect();
    Film { width: 64, height: 48, color, ..Film::default() }
}

fn target(folder: &Path, name: &str) -> Target {
    Target { path: folder.join(name), options: WriteOptions::default() }
}

#[test]
fn films_go_to_all_their_targets_as_if_written_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut writer = FilmWriter::new().unwrap();
    for i in 0..9 {
        let targets = ["exr", "png"].map(|extension| target(path, &format!("{i}.{extension}")));
        writer.write(film(i), targets.into()).unwrap();
    }
    let report = writer.finish().unwrap();
    assert_eq!((report.film_count, report.file_count), (9, 18));
    assert!(report.busy > Duration::ZERO && report.waited > Duration::ZERO, "{report:?}");
    for (i, extension) in (0..9).flat_map(|i| ["exr", "png"].map(|extension| (i, extension))) {
        let alone = path.join(format!("alone.{extension}"));
        write_image(&film(i), &alone).unwrap();
        assert!(fs::read(path.join(format!("{i}.{extension}"))).unwrap() == fs::read(alone).unwrap(), "{i}");
    }
    assert_eq!(fs::read_dir(path).unwrap().count(), 20);
}

#[test]
fn the_first_error_is_told_once_and_later_films_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut writer = FilmWriter::new().unwrap();
    writer.write(film(0), vec![target(path, "none/0.exr"), target(path, "0.exr")]).unwrap();
    let mut told = Vec::new();
    for i in 1..8 {
        told.extend(writer.write(film(i), vec![target(path, &format!("{i}.exr"))]).err());
    }
    told.extend(writer.finish().err());
    let told: Vec<String> = told.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("there is no folder"), "{told:?}");
    assert_eq!(writer.finish().unwrap().file_count, 8);
    assert!((0..8).all(|i| is_complete(&path.join(format!("{i}.exr")))));
}

#[test]
fn errors_can_be_taken_all_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = FilmWriter::new().unwrap();
    let targets = ["a", "b", "c"].map(|name| target(folder.path(), &format!("none/{name}.png")));
    writer.write(film(0), targets.into()).unwrap();
    assert!(writer.finish().unwrap_err().to_string().contains("a.png"));
    let rest: Vec<String> = writer.take_errors().iter().map(ToString::to_string).collect();
    assert!(rest.len() == 2 && rest[0].contains("b.png") && rest[1].contains("c.png"), "{rest:?}");
    assert_eq!(writer.finish().unwrap().file_count, 0);
}

#[test]
fn a_writer_that_is_dropped_has_written_what_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = FilmWriter::new().unwrap();
    for i in 0..3 {
        writer.write(film(i), vec![target(folder.path(), &format!("{i}.exr"))]).unwrap();
    }
    drop(writer);
    assert!((0..3).all(|i| is_complete(&folder.path().join(format!("{i}.exr")))));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn nothing_follows_the_end() {
    let mut writer = FilmWriter::new().unwrap();
    assert_eq!(writer.finish().unwrap().film_count, 0);
    let message = writer.write(film(0), Vec::new()).unwrap_err().to_string();
    assert_eq!(message, "the thread that writes images has stopped");
}

#[cfg(unix)]
#[test]
fn a_full_queue_makes_the_renderer_wait() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    // A folder that takes its time cannot be had; slow films can: noise of a size that takes a while to compress.
    let noise = |i: u32| (i.wrapping_mul(0x9e37_79b9) >> 8) as f32 / 16_777_216.0;
    let color: Vec<[f32; 4]> = (0..512 * 512).map(|i| [noise(i), noise(i + 1), noise(i + 2), 1.0]).collect();
    let film = Film { width: 512, height: 512, color, ..Film::default() };
    let folder = tempfile::tempdir().unwrap();
    let mut writer = FilmWriter::new().unwrap();
    let given = AtomicUsize::new(0);
    let mut most_waiting = 0;
    for i in 0..8 {
        writer.write(film.clone(), vec![target(folder.path(), &format!("{i}.png"))]).unwrap();
        let given = given.fetch_add(1, Ordering::Relaxed) as u64 + 1;
        most_waiting = most_waiting.max(given - writer.report().film_count);
    }
    let report = writer.finish().unwrap();
    // One that is written, those in the queue.
    assert!(most_waiting <= 1 + planish_film::QUEUE_LENGTH as u64, "{most_waiting}");
    assert!(report.waited > report.busy / 4, "{report:?}");
}
