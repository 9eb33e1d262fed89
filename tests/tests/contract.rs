//! Bad input, bad output and bad devices: one line each, exit status 1 or 2, and nothing half written.

use std::fs;
use std::path::{Path, PathBuf};

use planish_tests::folder::{SmallDisk, contents, temporary};
use planish_tests::parallel::check_all;
use planish_tests::program::{FAILED, Outcome, Planish};
use planish_tests::repository::scene;

/// The four commands that read a scene, at little cost.
fn readers(mesh: &Path, folder: &Path) -> [Planish; 4] {
    [
        Planish::new("info").path(mesh),
        Planish::dump(mesh, &folder.join("out.ply")).flags("--tess 2"),
        Planish::render(mesh, &folder.join("out.exr")).flags("--size 8x8 --tess 2"),
        Planish::new("bench").path(mesh).flags("--cpu"),
    ]
}

/// Every command refuses a scene with one line that names the file and holds all of `words`, and writes nothing.
fn refuses(mesh: &Path, words: &[&str]) -> Result<(), String> {
    let folder = temporary();
    for command in readers(mesh, folder.path()) {
        names(&command.run(), mesh, words)?;
    }
    let left = contents(folder.path());
    if left.is_empty() { Ok(()) } else { Err(format!("{}: left {:?}", mesh.display(), left.keys())) }
}

/// A command failed with one line that names the file and holds all of `words`.
fn names(outcome: &Outcome, path: &Path, words: &[&str]) -> Result<(), String> {
    let message = outcome.one_error(FAILED)?;
    let path = path.display().to_string();
    let absent = words.iter().copied().chain([path.as_str()]).find(|words| !message.contains(words));
    absent.map_or(Ok(()), |words| Err(outcome.told(&format!("expected the line to say {words:?}"))))
}

/// A text that is no mesh, what it is, and what the error line must say.
struct BadText {
    what: &'static str,
    text: String,
    words: &'static [&'static str],
}

/// A mesh of four vertices followed by further lines.
fn after_four_vertices(what: &'static str, lines: &str, words: &'static [&'static str]) -> BadText {
    BadText { what, text: format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n{lines}\n"), words }
}

/// A quad of which one coordinate is something else.
fn with_coordinate(what: &'static str, coordinate: &str, words: &'static [&'static str]) -> BadText {
    BadText { what, text: format!("v 0 0 0\nv 1 0 0\nv 1 {coordinate} 0\nv 0 1 0\nf 1 2 3 4\n"), words }
}

/// A quad with a tag.
fn edit(what: &'static str, tag: &str, words: &'static [&'static str]) -> BadText {
    after_four_vertices(what, &format!("f 1 2 3 4\nt {tag}"), words)
}

fn bad_texts() -> Vec<BadText> {
    let text = |what, text: &str, words| BadText { what, text: text.to_owned(), words };
    let deep_edit = format!("vertexedit 21/3/3 20{} 0 0 1 add P value", " 0".repeat(20));
    let ten_million = " 1 2 3 4".repeat(2_500_000);
    vec![
        text("an empty file", "", &["no vertices"]),
        text("a comment alone", "# nothing\n", &["no vertices"]),
        text("vertices alone", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", &["no faces"]),
        text("faces alone", "f 1 2 3\n", &["no vertices"]),
        text("a vertex of two coordinates", "v 0 0\nf 1 1 1\n", &["line 1"]),
        after_four_vertices("face index zero", "f 0 1 2", &["line 5", "index 0"]),
        after_four_vertices("a face index past the end", "f 1 2 5", &["line 5", "index 5", "1 to 4"]),
        after_four_vertices("a face index before the start", "f 1 2 -5", &["line 5", "-5"]),
        after_four_vertices("a face index of 33 bits", "f 1 2 8589934593", &["line 5", "8589934593"]),
        after_four_vertices("a face index of 65 bits", "f 1 2 36893488147419103233", &["line 5"]),
        after_four_vertices("a face index that is no number", "f 1 2 x", &["line 5", "x"]),
        after_four_vertices("a face of no vertices", "f", &["line 5"]),
        after_four_vertices("a face of one vertex", "f 1", &["line 5"]),
        after_four_vertices("a face of two vertices", "f 1 2", &["line 5", "2 vertices"]),
        after_four_vertices("a face with a vertex twice", "f 1 2 3 2", &["line 5", "vertex 2 twice"]),
        after_four_vertices("a face of ten million sides", &format!("f{ten_million}"), &["line 5"]),
        after_four_vertices("a crease of ten million", "f 1 2 3 4\nt crease 10000000/1/0 0 1 2", &["line 6"]),
        after_four_vertices("a count of 64 bits", "f 1 2 3 4\nt hole 18446744073709551615/0/0 0", &["line 6"]),
        after_four_vertices("a negative count", "f 1 2 3 4\nt hole -1/0/0 0", &["line 6"]),
        after_four_vertices("a tag of a vertex that is not", "f 1 2 3 4\nt corner 1/1/0 4 1.5", &["line 6"]),
        after_four_vertices("an unknown boundary mode", "f 1 2 3 4\nt interpolateboundary 1/0/0 7", &["line 6", "7"]),
        text("a colour that is no number", "v 0 0 0 1 0 x\nf 1 1 1\n", &["line 1", "`x`", "a number"]),
        text("a colour that is infinite", "v 0 0 0 1 -inf 0\nf 1 1 1\n", &["line 1", "-inf", "finite colour"]),
        after_four_vertices("an unknown colour mode", "f 1 2 3 4\nt colorinterpolation 1/0/0 2", &["line 6", "0 or 1"]),
        with_coordinate("NaN", "nan", &["line 3", "nan"]),
        with_coordinate("infinity", "inf", &["line 3", "inf"]),
        with_coordinate("negative infinity", "-infinity", &["line 3"]),
        with_coordinate("a number past the floats", "1e39", &["line 3", "1e39"]),
        with_coordinate("a number past the doubles", "-1e999", &["line 3"]),
        with_coordinate("a word for a number", "one", &["line 3", "one"]),
        after_four_vertices("a crease of one vertex", "f 1 2 3 4\nt crease 1/1/0 0 2.0", &["line 6", "1 vertices"]),
        after_four_vertices("a crease of too few values", "f 1 2 3 4\nt crease 2/2/0 0 1 2.0", &["line 6", "2/2/0"]),
        after_four_vertices("a sharpness too many", "f 1 2 3 4\nt crease 3/3/0 0 1 2 1 1 1", &["line 6", "sharpness"]),
        after_four_vertices("a negative sharpness", "f 1 2 3 4\nt crease 2/1/0 0 1 -2.0", &["line 6", "-2"]),
        after_four_vertices("a sharpness that is NaN", "f 1 2 3 4\nt crease 2/1/0 0 1 nan", &["line 6", "nan"]),
        after_four_vertices("a corner that is NaN", "f 1 2 3 4\nt corner 1/1/0 0 nan", &["line 6", "nan"]),
        after_four_vertices("a crease past the vertices", "f 1 2 3 4\nt crease 2/1/0 0 4 2.0", &["line 6", "vertex 4"]),
        after_four_vertices("a hole past the faces", "f 1 2 3 4\nt hole 1/0/0 1", &["line 6", "face 1"]),
        after_four_vertices("an unknown crease method", "f 1 2 3 4\nt creasemethod 0/0/1 round", &["line 6", "round"]),
        edit("an edit of a face that is not", "vertexedit 3/3/3 2 1 0 0 0 1 add P value", &["face 1"]),
        edit("an edit of a child that is not", "vertexedit 4/3/3 3 0 4 0 0 0 1 add P value", &["child 4"]),
        edit("an edit of a vertex that is not", "vertexedit 4/3/3 3 0 3 4 0 0 1 add P value", &["vertex 4"]),
        edit("an edit of an edge that is not", "edgeedit 4/1/3 3 0 3 4 2 set P sharpness", &["edge 4"]),
        edit("an edit of a level too deep", &deep_edit, &["level 18"]),
        edit("an edit of too few floats", "vertexedit 3/2/3 2 0 0 0 0 add P value", &["2 floats"]),
        edit("an edit of a path too long", "vertexedit 3/3/3 3 0 0 0 0 1 add P value", &["path of length 3"]),
        edit("an edit with a value that is NaN", "vertexedit 3/3/3 2 0 0 0 0 nan add P value", &["nan"]),
        edit("an edit that says neither", "vertexedit 3/3/3 2 0 0 0 0 1 move P value", &["move"]),
    ]
}

#[test]
fn every_bad_file_is_refused_with_one_line_that_names_it() {
    check_all(&bad_texts(), |bad| {
        let folder = temporary();
        let mesh = folder.path().join("bad.obj");
        fs::write(&mesh, &bad.text).expect("a file can be written");
        refuses(&mesh, bad.words).map_err(|failure| format!("{}: {failure}", bad.what))
    });
}

#[test]
fn files_that_cannot_be_read_are_refused() {
    let folder = temporary();
    let directory = folder.path().join("directory.obj");
    fs::create_dir(&directory).unwrap();
    let unknown = folder.path().join("mesh.stl");
    fs::write(&unknown, "solid").unwrap();
    refuses(&folder.path().join("missing.obj"), &["No such file"]).unwrap();
    refuses(&directory, &["directory"]).unwrap();
    refuses(&directory.join("below.obj"), &["No such file"]).unwrap();
    refuses(&unknown.join("below.obj"), &["Not a directory"]).unwrap();
    refuses(&unknown, &["unknown format", ".obj"]).unwrap();
}

#[test]
fn binary_junk_is_refused() {
    let folder = temporary();
    let mesh = folder.path().join("junk.obj");
    // A linear congruential generator's high bytes.
    let bytes = |seed: u32| {
        (0..4096).scan(seed, |state, _| {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Some((*state >> 24) as u8)
        })
    };
    for seed in 0..50 {
        fs::write(&mesh, bytes(seed).collect::<Vec<u8>>()).unwrap();
        names(&Planish::info(&mesh).run(), &mesh, &[]).unwrap();
        let after_a_mesh = fs::read(scene("cube")).unwrap().into_iter().chain(bytes(seed));
        fs::write(&mesh, after_a_mesh.collect::<Vec<u8>>()).unwrap();
        names(&Planish::info(&mesh).run(), &mesh, &[]).unwrap();
    }
    fs::copy(planish_tests::repository::planish(), &mesh).unwrap();
    refuses(&mesh, &["not an OBJ file"]).unwrap();
}

/// A mesh with every kind of tag that is supported.
const TAGGED: &str = "v 0 0 0\nv 1 0 0.5\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0.5\nvt 0 0\nvt 1 0\nvt 1 1\n\
                      f 1/1 2/2 5/3 4/1\nf 2/1 3/2 6/3\nf 2/1 6/3 5/2\nt interpolateboundary 1/0/0 2\n\
                      t facevaryinginterpolateboundary 1/0/0 1\nt creasemethod 0/0/1 chaikin\n\
                      t smoothtriangles 0/0/1 smooth\n";

#[test]
fn a_file_cut_short_anywhere_is_drawn_or_refused_with_one_line() {
    let folder = temporary();
    let mesh = |length: usize| folder.path().join(format!("cut_{length}.obj"));
    let info = |&length: &usize| {
        fs::write(mesh(length), &TAGGED[..length]).expect("a file can be written");
        Planish::info(&mesh(length)).flags("-q").run().success_or_one_error()
    };
    check_all(&(0..=TAGGED.len()).collect::<Vec<_>>(), info);
    let line_ends: Vec<usize> = TAGGED.match_indices('\n').map(|(at, _)| at).collect();
    check_all(&line_ends, |&length| {
        let out = folder.path().join(format!("cut_{length}.ply"));
        let outcome = Planish::dump(&mesh(length), &out).flags("--tess 2 -q").run();
        outcome.success_or_one_error()?;
        let ended_well = outcome.status.success() == out.exists();
        if ended_well { Ok(()) } else { Err(outcome.told("expected a dump if and only if it succeeded")) }
    });
}

#[test]
fn degenerate_faces_are_dropped_with_a_warning_on_request() {
    let folder = temporary();
    for bad_face in ["f 1 2", "f 1 2 2", "f 1 2 3 1", "f 3"] {
        let mesh = folder.path().join("degenerate.obj");
        fs::write(&mesh, format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n{bad_face}\nf 1 2 3 4\n")).unwrap();
        let outcome = Planish::info(&mesh).flags("--repair").run();
        assert!(outcome.status.success(), "{}", outcome.told("expected success"));
        assert_eq!(outcome.json().unwrap()["mesh"]["faces"], 1, "{bad_face}");
        let warning = outcome.stderr.strip_prefix("planish: warning: ").expect("a warning");
        assert!(warning.contains("line 5") && warning.lines().count() == 1, "{warning}");
        Planish::info(&mesh).flags("--repair -q").run().silent_success().unwrap();
    }
    let mesh = folder.path().join("nothing_left.obj");
    fs::write(&mesh, "v 0 0 0\nv 1 0 0\nf 1 2\n").unwrap();
    let outcome = Planish::info(&mesh).flags("--repair -q").run();
    names(&outcome, &mesh, &["no faces"]).unwrap();
}

/// Every command that writes, into a path with a given extension.
fn writers(path_of: impl Fn(&str) -> PathBuf) -> Vec<(Planish, PathBuf)> {
    let mesh = scene("cube");
    let (exr, png, ply) = (path_of("exr"), path_of("png"), path_of("ply"));
    let small = "--size 320x320 --tess 2";
    vec![
        (Planish::render(&mesh, &exr).flags(small).flags("--aov z,n,p"), exr),
        (Planish::render(&mesh, &png).flags(small), png),
        (Planish::dump(&mesh, &ply).flags("--tess 40"), ply),
    ]
}

#[test]
fn an_output_that_cannot_be_written_is_told_before_any_work() {
    let folder = temporary();
    let file = folder.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    for extension in ["exr", "png", "ply"] {
        fs::create_dir(folder.path().join(format!("folder.{extension}"))).unwrap();
    }
    let before = contents(folder.path());
    let places: [&dyn Fn(&str) -> PathBuf; 4] = [
        &|extension| folder.path().join(format!("absent/out.{extension}")),
        &|extension| file.join(format!("out.{extension}")),
        &|extension| folder.path().join(format!("folder.{extension}")),
        &|extension| PathBuf::from(format!("/proc/out.{extension}")),
    ];
    for place in places {
        for (command, path) in writers(place) {
            // A device would be told about next, so its absence shows that the output was looked at before.
            let outcome = command.env("VK_ICD_FILENAMES", "/nonexistent").env("VK_DRIVER_FILES", "/nonexistent").run();
            names(&outcome, &path, &["cannot write"]).unwrap();
        }
    }
    for name in ["out.jpg", "out", ".exr"] {
        let path = folder.path().join(name);
        names(&Planish::render(&scene("cube"), &path).run(), &path, &["extension"]).unwrap();
    }
    assert_eq!(contents(folder.path()), before);
}

#[test]
fn a_full_disk_leaves_old_files_untouched_and_no_new_ones() {
    let Some(disk) = SmallDisk::mount(16) else { return };
    for (command, path) in writers(|extension| disk.path().join(format!("new.{extension}"))) {
        names(&command.run(), &path, &["No space left on device"]).unwrap();
    }
    assert!(contents(disk.path()).is_empty(), "{:?}", contents(disk.path()).keys());
    for extension in ["exr", "png", "ply"] {
        fs::write(disk.path().join(format!("old.{extension}")), "old").unwrap();
    }
    let before = contents(disk.path());
    for (command, path) in writers(|extension| disk.path().join(format!("old.{extension}"))) {
        names(&command.run(), &path, &["No space left on device"]).unwrap();
    }
    let stats = disk.path().join("stats.json");
    // As much of it as there is room for.
    let _ = fs::write(disk.path().join("filler"), vec![0; 16 << 10]);
    let outcome =
        Planish::dump(&scene("cube"), &temporary().path().join("out.ply")).flags("--tess 1 --stats").path(&stats).run();
    outcome.one_error(FAILED).unwrap();
    fs::remove_file(disk.path().join("filler")).unwrap();
    assert_eq!(contents(disk.path()), before);
}
