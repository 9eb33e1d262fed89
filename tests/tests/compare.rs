//! `planish compare`: dumps measured against each other.

use std::fs;
use std::path::{Path, PathBuf};

use planish_tests::folder::{contents, temporary};
use planish_tests::ply::Dump;
use planish_tests::program::{FAILED, Outcome, Planish, WRONG_USAGE};
use planish_tests::repository::scene;
use serde_json::Value;

const SAMPLES: &str = "--samples 20000";

fn dump(folder: &Path, mesh: &str, name: &str, flags: &str) -> PathBuf {
    let path = folder.join(name);
    Planish::dump(&scene(mesh), &path).flags("--spacing equal").flags(flags).run().silent_success().unwrap();
    path
}

fn compare(a: &Path, b: &Path, flags: &str) -> Outcome {
    Planish::new("compare").path(a).path(b).flags(SAMPLES).flags(flags).run()
}

fn measured(a: &Path, b: &Path) -> Value {
    compare(a, b, "--json").silent_success().unwrap().json().unwrap()
}

fn figure(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} of {report}"))
}

#[test]
fn a_dump_does_not_deviate_from_itself_or_from_one_of_other_patches() {
    let folder = temporary();
    let fas = dump(folder.path(), "cube", "fas.ply", "--method fas --tess 8");
    let report = measured(&fas, &fas);
    assert_eq!(figure(&report, "/parametric/distance/max"), 0.0);
    assert_eq!(figure(&report, "/parametric/normal_radians/max"), 0.0);
    assert!(figure(&report, "/nearest/both/distance_percent/max") < 1e-9);
    // Of the same surface, so vertices differ by rounding alone; and B's chords where it is coarser.
    let uniform = dump(folder.path(), "cube", "uniform.ply", "--method uniform --tess 16");
    let report = measured(&fas, &uniform);
    assert!(figure(&report, "/parametric/distance_percent/max") < 1e-3, "{report}");
    assert!(figure(&report, "/nearest/a_to_b/distance_percent/max") < 1.0, "{report}");
}

#[test]
fn gregory_patches_of_a_cube_deviate_a_little_and_less_from_the_nearest_points() {
    let folder = temporary();
    let fas = dump(folder.path(), "cube", "fas.ply", "--method fas --tess 16");
    let gregory = dump(folder.path(), "cube", "gregory.ply", "--method gregory --tess 16");
    let report = measured(&gregory, &fas);
    let [rms, max] = ["rms", "max"].map(|name| figure(&report, &format!("/parametric/distance_percent/{name}")));
    let nearest = figure(&report, "/nearest/both/distance_percent/rms");
    assert!(1e-3 < nearest && nearest <= rms && rms < max && max < 5.0, "{report}");
    let angle = figure(&report, "/parametric/normal_radians/rms");
    assert!(1e-4 < angle && angle < 0.2, "{report}");
    assert_eq!(figure(&report, "/common_faces"), 6.0);
    let table = compare(&gregory, &fas, "").silent_success().unwrap().stdout;
    assert!(table.contains("same (face, u, v): distance, % of diagonal"), "{table}");
}

#[test]
fn pictures_are_written_and_no_sample_is_needed() {
    let folder = temporary();
    let a = dump(folder.path(), "cube", "a.ply", "--method gregory --tess 4");
    let b = dump(folder.path(), "cube", "b.ply", "--method fas --tess 4");
    for metric in ["parametric", "nearest"] {
        let out = |name: &str| folder.path().join(format!("{metric}_{name}.png"));
        let command = Planish::new("compare --samples 0 --size 96x64 --metric").flags(metric).path(&a).path(&b);
        let command = command.flags("-o").path(&out("distance")).flags("--normal-view").path(&out("normal"));
        let table = command.run().silent_success().unwrap().stdout;
        assert!(!table.contains("nearest"), "{table}");
        for path in [out("distance"), out("normal")] {
            let image = image::open(&path).unwrap().into_rgb8();
            assert_eq!(image.dimensions(), (96, 64));
            assert!(image.pixels().any(|pixel| pixel[2] > pixel[0]), "{}: nothing is blue", path.display());
        }
    }
}

#[test]
fn what_cannot_be_compared_is_refused_with_one_line() {
    let folder = temporary();
    let file = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let good = dump(folder.path(), "cube", "good.ply", "--tess 2");
    let bytes = fs::read(&good).unwrap();
    let edited = |name: &str, old: &str, new: &str| {
        let header = bytes.windows(11).position(|window| window == b"end_header\n").unwrap();
        let text = String::from_utf8_lossy(&bytes[..header]).replace(old, new);
        file(name, &[text.as_bytes(), &bytes[header..]].concat())
    };
    let none = folder.path().join("none.ply");
    let (half, other) = (folder.path().join("half.ply"), folder.path().join("other.ply"));
    Dump::read(&good).unwrap().write_faces(&half, |face| face < 3).unwrap();
    Dump::read(&good).unwrap().write_faces(&other, |face| face >= 3).unwrap();
    Dump::read(&good).unwrap().write_faces(&folder.path().join("empty.ply"), |_| false).unwrap();
    let cases = [
        (none, "cannot read "),
        (folder.path().to_owned(), "cannot read "),
        (scene("cube"), "cube.obj: found a file that is no PLY, expected a dump"),
        (file("nothing.ply", b""), "nothing.ply: found a file that is no PLY, expected a dump"),
        (file("cut.ply", &bytes[..bytes.len() / 2]), "cut.ply: found the end of the file in vertex"),
        (edited("ascii.ply", "binary_little_endian", "ascii"), "expected format binary_little_endian 1.0"),
        (edited("v.ply", "property float v\n", ""), "v.ply: found vertices without v"),
        (folder.path().join("empty.ply"), "empty.ply: found no triangles, expected a surface"),
    ];
    let before = contents(folder.path());
    for (bad, words) in &cases {
        for (a, b) in [(bad, &good), (&good, bad)] {
            let outcome = compare(a, b, "");
            let message = outcome.one_error(FAILED).unwrap();
            assert!(message.contains(words), "{message}, expected {words}");
        }
    }
    assert!(compare(&half, &other, "").one_error(FAILED).unwrap().contains("have no Ptex face in common"));
    let told = compare(&half, &good, "");
    assert!(told.status.success() && told.stderr.contains("3 of the faces of "), "{told:?}");
    assert!(compare(&good, &good, "-o out.jpg").one_error(FAILED).unwrap().contains(".exr or .png"));
    for flags in ["--scale 0", "--metric euclid", "--normal-scale -1", "extra.ply"] {
        compare(&good, &good, flags).one_error(WRONG_USAGE).unwrap();
    }
    assert_eq!(contents(folder.path()), before);
}
