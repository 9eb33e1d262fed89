//! Runs of several frames: motion from one to the next, shutters, crops, and runs that are interrupted, resumed or fail in part.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use planish_tests::folder::{contents, temporary};
use planish_tests::layers::{Layers, transform};
use planish_tests::program::{FAILED, Planish};
use planish_tests::repository::{planish, root};

/// Two meshes at places, and a camera that flies past them.
fn flight(folder: &Path) -> PathBuf {
    let mesh = |name: &str| root().join("scenes").join(format!("{name}.obj")).display().to_string();
    let scene = format!(
        r#"{{ "meshes": [ {{ "name": "a", "file": "{}" }}, {{ "name": "b", "file": "{}" }} ],
             "instances": [ {{ "mesh": "a", "scale": 1.5 }},
                            {{ "mesh": "b", "translate": [3, 0.5, -1], "scale": [-1, 1, 1] }} ],
             "paths": [ {{ "name": "flight", "fov": 50, "frames": 24, "keys": [
                 {{ "eye": [5, 3, 6], "target": [1, 0, 0] }}, {{ "eye": [-3, 2, 6], "target": [1, 0.3, 0] }} ] }} ] }}"#,
        mesh("crease_2_3"),
        mesh("ngon_5"),
    );
    let path = folder.join("flight.json");
    fs::write(&path, scene).unwrap();
    path
}

const FLIGHT: &str = "--camera flight --size 96x64 --edge-pixels 3";

/// The contents of a folder's files by their names.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    contents(folder).into_iter().map(|(path, bytes)| (path.file_name().unwrap().display().to_string(), bytes)).collect()
}

#[test]
fn motion_leads_to_where_the_next_frame_s_camera_sees_the_point() {
    let folder = temporary();
    let scene = flight(folder.path());
    let out = folder.path().join("f.####.exr");
    Planish::render(&scene, &out)
        .flags(FLIGHT)
        .flags("--frames 3-4 --aov p,motion,object")
        .run()
        .silent_success()
        .unwrap();
    let [now, next] = ["f.0003.exr", "f.0004.exr"].map(|name| Layers::read(&folder.path().join(name)));
    let [width, height] = now.size;
    let (objects, points) = (now.integers("object"), now.vectors("P", ["X", "Y", "Z"]));
    let motion = now.vectors("motion", ["x", "y"]);
    let (mut seen, mut longest) = ([0, 0], 0.0_f64);
    for pixel in 0..objects.len() {
        if objects[pixel] == u32::MAX {
            assert_eq!(motion[pixel], [0.0; 2]);
            continue;
        }
        seen[objects[pixel] as usize] += 1;
        let [x, y, _] = transform(points[pixel], &next.world_to_ndc);
        let expected =
            [x * width as f64 - (pixel % width) as f64 - 0.5, y * height as f64 - (pixel / width) as f64 - 0.5];
        for axis in 0..2 {
            let found = f64::from(motion[pixel][axis]);
            assert!((found - expected[axis]).abs() < 0.01, "pixel {pixel}: {found}, expected {}", expected[axis]);
            longest = longest.max(found.abs());
        }
    }
    assert!(seen[0] > 100 && seen[1] > 100 && longest > 1.0, "{seen:?} {longest}");
}

#[test]
fn a_crop_is_the_same_part_of_the_whole_image_to_the_bit() {
    let folder = temporary();
    let scene = flight(folder.path());
    let flags = format!("{FLIGHT} --frames 5 --samples 3 --aov z,n,face,patch,motion");
    let (whole, part) = (folder.path().join("whole.exr"), folder.path().join("part.exr"));
    Planish::render(&scene, &whole).flags(&flags).run().silent_success().unwrap();
    Planish::render(&scene, &part).flags(&flags).flags("--crop 20,11,50x40").run().silent_success().unwrap();
    let (whole, part) = (Layers::read(&whole), Layers::read(&part));
    assert_eq!((part.size, part.position), ([50, 40], [20, 11]));
    let at = |pixel: usize| (11 + pixel / 50) * 96 + 20 + pixel % 50;
    for channel in ["R", "G", "B", "A", "Z", "N.X", "motion.x"] {
        let (whole, part) = (whole.floats(channel), part.floats(channel));
        assert!(part.iter().any(|&value| value != part[0]), "{channel} is the same everywhere");
        for (pixel, value) in part.iter().enumerate() {
            assert_eq!(value.to_bits(), whole[at(pixel)].to_bits(), "{channel} of pixel {pixel}");
        }
    }
    let (whole, part) = (whole.integers("face"), part.integers("face"));
    assert!(part.iter().enumerate().all(|(pixel, &face)| face == whole[at(pixel)]));
}

#[test]
fn an_open_shutter_spreads_what_moves_and_leaves_the_layers_sharp() {
    let folder = temporary();
    let scene = flight(folder.path());
    let render = |name: &str, flags: &str| {
        let out = folder.path().join(name);
        let flags = format!("{FLIGHT} --frames 5 --samples 16 --filter box --aov z {flags}");
        Planish::render(&scene, &out).flags(&flags).run().silent_success().unwrap();
        Layers::read(&out)
    };
    let (still, blurred) = (render("still.exr", ""), render("blurred.exr", "--shutter 0,2"));
    let partly = |layers: &Layers| layers.floats("A").iter().filter(|&&alpha| alpha > 0.0 && alpha < 1.0).count();
    assert!(partly(&blurred) > 2 * partly(&still), "{} {}", partly(&blurred), partly(&still));
    assert_eq!(still.floats("Z"), blurred.floats("Z"));
    // A shutter that opens and closes at once, and one sample, see one moment.
    assert_eq!(render("closed.exr", "--shutter 0,0").floats("R"), still.floats("R"));
}

#[test]
fn filters_are_wider_the_wider_they_are_and_weigh_one() {
    let folder = temporary();
    let scene = root().join("scenes/cube.obj");
    let partly_covered = |flags: &str| {
        let out = folder.path().join("a.exr");
        let flags = format!("--size 64x64 --samples 64 --tess 8 {flags}");
        Planish::render(&scene, &out).flags(&flags).run().silent_success().unwrap();
        let alpha = Layers::read(&out).floats("A");
        assert!(alpha.contains(&1.0), "{flags}");
        alpha.iter().filter(|&&alpha| alpha > 0.0 && alpha < 1.0).count()
    };
    let (narrow, usual) = (partly_covered("--filter box"), partly_covered(""));
    let wide = partly_covered("--filter gaussian --filter-width 6");
    assert!(narrow < usual && usual < wide, "{narrow} {usual} {wide}");
}

/// A run of twelve frames, each of many samples.
fn long_run(scene: &Path, out: &Path, flags: &str) -> Command {
    let mut command = Command::new(planish());
    command.arg("render").arg(scene).arg("-o").arg(out.join("f.####.exr"));
    command.args(format!("{FLIGHT} --frames 0-11 --samples 8 --aov motion {flags}").split_whitespace());
    command
}

fn is_whole_after(command: &mut Command, out: &Path, signal: &str) -> bool {
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while fs::read_dir(out).unwrap().count() < 2 && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    let output = child.wait().unwrap();
    killed.success() && !output.success()
}

#[test]
fn a_run_that_is_killed_and_resumed_is_the_run_that_was_not() {
    let folder = temporary();
    let scene = flight(folder.path());
    let undisturbed = folder.path().join("undisturbed");
    fs::create_dir(&undisturbed).unwrap();
    assert!(long_run(&scene, &undisturbed, "").status().unwrap().success());
    let expected = files(&undisturbed);
    assert_eq!(expected.len(), 12);
    for signal in ["-INT", "-KILL"] {
        let out = folder.path().join(signal);
        fs::create_dir(&out).unwrap();
        assert!(is_whole_after(&mut long_run(&scene, &out, ""), &out, signal), "{signal}: the run ended before");
        let left: Vec<_> = files(&out).into_iter().filter(|(name, _)| name.ends_with(".exr")).collect();
        assert!(!left.is_empty() && left.len() < 12, "{signal}: {} files", left.len());
        // What is there is whole, and with Ctrl-C there is nothing else.
        assert!(left.iter().all(|file| expected.contains(file)), "{signal}: a file is not that of the other run");
        if signal == "-INT" {
            assert_eq!(files(&out).len(), left.len());
        }
        assert!(long_run(&scene, &out, "--skip-existing").status().unwrap().success());
        let resumed: Vec<_> = files(&out).into_iter().filter(|(name, _)| name.ends_with(".exr")).collect();
        assert!(resumed == expected, "{signal}: the resumed run differs");
    }
}

#[test]
fn files_that_are_whole_are_left_alone_and_others_made_again() {
    let folder = temporary();
    let scene = flight(folder.path());
    let out = folder.path().join("f.####.exr");
    let run =
        || Planish::render(&scene, &out).flags(FLIGHT).flags("--frames 0-2 --skip-existing").run().silent_success();
    run().unwrap();
    let [kept, cut, gone] = [0, 1, 2].map(|frame| folder.path().join(format!("f.000{frame}.exr")));
    let whole = fs::read(&cut).unwrap();
    fs::write(&cut, &whole[..whole.len() - 100]).unwrap();
    fs::remove_file(&gone).unwrap();
    let written = fs::metadata(&kept).unwrap().modified().unwrap();
    run().unwrap();
    assert_eq!(fs::metadata(&kept).unwrap().modified().unwrap(), written);
    assert!(fs::read(&cut).unwrap() == whole && gone.is_file());
}

#[test]
fn a_frame_is_there_only_if_all_of_its_files_are() {
    let folder = temporary();
    let scene = flight(folder.path());
    let path = |name: &str| folder.path().join(name);
    let run = || {
        let render = Planish::render(&scene, &path("f.####.exr")).flags("-o").path(&path("f.####.png"));
        render.flags(FLIGHT).flags("--frames 0-2 --skip-existing").run().silent_success().unwrap();
    };
    run();
    let expected = contents(folder.path());
    fs::remove_file(path("f.0000.png")).unwrap();
    let png = fs::read(path("f.0001.png")).unwrap();
    fs::write(path("f.0001.png"), &png[..png.len() - 9]).unwrap();
    fs::write(path("f.0002.exr"), "text").unwrap();
    run();
    assert!(contents(folder.path()) == expected);
}

#[test]
fn a_frame_that_fails_ends_the_run_unless_it_is_to_go_on() {
    let folder = temporary();
    let scene = flight(folder.path());
    let out = folder.path().join("f.####.exr");
    // Folders stand where frames should go: one in the middle, and the last.
    for name in ["f.0001.exr/x", "f.0003.exr/x"] {
        fs::create_dir_all(folder.path().join(name)).unwrap();
    }
    let run = |flags: &str| Planish::render(&scene, &out).flags(FLIGHT).flags("--frames 0-3").flags(flags).run();
    run("").one_error(FAILED).unwrap();
    let outcome = run("--continue-on-error");
    assert_eq!(outcome.status.code(), Some(FAILED));
    let told = ["f.0001.exr", "f.0003.exr"].iter().all(|name| outcome.stderr.contains(name));
    assert!(told && outcome.stderr.ends_with("2 of 4 frames failed\n"), "{outcome:?}");
    assert!([0, 2].iter().all(|frame| folder.path().join(format!("f.000{frame}.exr")).is_file()));
}

#[test]
fn a_lens_blurs_what_is_out_of_focus_and_leaves_what_is_in_focus() {
    let folder = temporary();
    let mesh = root().join("scenes/cube.obj").display().to_string();
    let camera = |name: &str, lens: &str| {
        format!(r#"{{ "name": "{name}", "eye": [0, 0, 8], "target": [0, 0, 0], "fov": 30{lens} }}"#)
    };
    let cameras = [
        camera("pinhole", ""),
        camera("focused", r#", "lens": { "radius": 0.4, "focus": 8 }"#),
        camera("near", r#", "lens": { "radius": 0.4, "focus": 3 }"#),
    ];
    let text = format!(
        r#"{{ "meshes": [ {{ "name": "a", "file": "{mesh}" }} ],
             "instances": [ {{ "mesh": "a", "scale": [1, 1, 0.05] }} ], "cameras": [ {} ] }}"#,
        cameras.join(", ")
    );
    let scene = folder.path().join("lens.json");
    fs::write(&scene, text).unwrap();
    let partly_covered = |camera: &str, flags: &str| {
        let out = folder.path().join("a.exr");
        let flags = format!("--camera {camera} --size 64x64 --samples 32 --tess 8 {flags}");
        Planish::render(&scene, &out).flags(&flags).run().silent_success().unwrap();
        Layers::read(&out).floats("A").iter().filter(|&&alpha| alpha > 0.0 && alpha < 1.0).count()
    };
    let [pinhole, focused, near] = ["pinhole", "focused", "near"].map(|camera| partly_covered(camera, ""));
    assert!(focused < pinhole * 3 / 2 && near > pinhole * 3, "{pinhole} {focused} {near}");
    assert_eq!(partly_covered("near", "--no-depth-of-field"), pinhole);
}
