//! Wrong usage, requests that cannot be met and devices that cannot run planish: one line each.

use std::process::{Command, Stdio};

use planish_tests::folder::{contents, temporary};
use planish_tests::parallel::check_all;
use planish_tests::program::{FAILED, Planish, WRONG_USAGE};
use planish_tests::repository::{planish, scene};

#[test]
fn wrong_usage_ends_with_status_2_and_one_line() {
    let lines = [
        "",
        "paint",
        "render",
        "render a.obj",
        "render -o a.exr",
        "dump a.obj",
        "bench",
        "--colour",
        "render a.obj -o a.exr --tess 0.5",
        "render a.obj -o a.exr --tess 0",
        "render a.obj -o a.exr --tess -2",
        "render a.obj -o a.exr --tess nan",
        "render a.obj -o a.exr --tess inf",
        "render a.obj -o a.exr --tess many",
        "render a.obj -o a.exr --tess 2 --edge-pixels 2",
        "render a.obj -o a.exr --edge-pixels 0",
        "render a.obj -o a.exr --edge-pixels -1",
        "render a.obj -o a.exr --spacing odd",
        "render a.obj -o a.exr --method paint",
        "render a.obj -o a.exr --scheme paint",
        "render a.obj -o a.exr --view paint",
        "render a.obj -o a.exr --aov z,paint",
        "render a.obj -o a.exr --size 0x10",
        "render a.obj -o a.exr --size 10",
        "render a.obj -o a.exr --size 100000x100000",
        "render a.obj -o a.exr --samples 0",
        "render a.obj -o a.exr --max-level -1",
        "render a.obj -o a.exr --eye 1,2,3",
        "render a.obj -o a.exr --eye 1,2 --target 0,0,0",
        "render a.obj -o a.exr --eye 1,2,nan --target 0,0,0",
        "render a.obj -o a.exr --fov 180",
        "render a.obj -o a.exr --fov 0",
        "render a.obj -o a.exr --frames 3-1",
        "render a.obj -o a.exr --repeat 0",
        "info a.obj --device 0",
    ];
    for line in lines {
        let outcome = Planish::new(line).run();
        outcome.one_error(WRONG_USAGE).unwrap();
    }
}

#[test]
fn requests_that_cannot_be_met_are_refused_with_one_line() {
    let folder = temporary();
    let out = folder.path().join("out.exr");
    let cases = [
        ("--method gregory", "gregory"),
        ("--method table", "table"),
        ("--scheme loop", "loop"),
        ("--scheme bilinear", "bilinear"),
        ("--camera nobody", "nobody"),
        ("--frames 1-3", "####"),
        ("--aov z,motion", "motion"),
        ("--device nobody", "nobody"),
        ("--device 99", "99"),
        ("--eye 1,1,1 --target 1,1,1", "camera"),
    ];
    check_all(&cases, |(flags, words)| {
        let outcome = Planish::render(&scene("cube"), &out).flags(flags).run();
        let message = outcome.one_error(FAILED)?;
        let is_told = message.contains(words);
        if is_told { Ok(()) } else { Err(outcome.told(&format!("expected the line to say {words:?}"))) }
    });
    assert!(contents(folder.path()).is_empty(), "{:?}", contents(folder.path()).keys());
}

#[test]
fn factors_above_those_of_the_tessellator_and_cameras_inside_are_not_refused() {
    let folder = temporary();
    let out = folder.path().join("out.ply");
    let cases = [
        "--tess 65 --size 64x36",
        "--tess 64.5 --spacing equal --size 64x36",
        "--edge-pixels 0.2 --size 16x9",
        "--eye 0,0,0 --target 0.3,0.2,1 --size 64x36",
        "--eye 0.5,0.5,0.5 --target 1,0.5,0.5 --size 64x36 --fov 150",
    ];
    for flags in cases {
        Planish::dump(&scene("cube"), &out).flags(flags).run().silent_success().unwrap();
        let image = folder.path().join("out.png");
        Planish::render(&scene("cube"), &image).flags(flags).run().silent_success().unwrap();
    }
}

#[test]
fn without_a_vulkan_device_only_what_needs_one_is_refused() {
    let folder = temporary();
    let mesh = scene("cube");
    let out = |extension| folder.path().join(format!("out.{extension}"));
    let without =
        |command: Planish| command.env("VK_ICD_FILENAMES", "/nonexistent").env("VK_DRIVER_FILES", "/nonexistent").run();
    for command in [
        Planish::new("render").path(&mesh).flags("-o").path(&out("exr")),
        Planish::render(&mesh, &out("png")),
        Planish::new("dump").path(&mesh).flags("--tess 2 -o").path(&out("ply")),
        Planish::new("bench").path(&mesh),
    ] {
        let outcome = without(command);
        let message = outcome.one_error(FAILED).unwrap();
        assert!(message.contains("no Vulkan driver"), "{message}");
    }
    assert!(contents(folder.path()).is_empty());
    without(Planish::info(&mesh)).silent_success().unwrap();
    without(Planish::new("bench").path(&mesh).flags("--cpu")).silent_success().unwrap();
}

#[test]
fn a_device_without_what_is_needed_is_refused_with_the_reason() {
    let folder = temporary();
    let mesh = scene("cube");
    let hiding = |feature: &str, command: Planish| command.env("PLANISH_HIDE_FEATURE", feature).run();
    let (image, dump) = (folder.path().join("out.exr"), folder.path().join("out.ply"));
    for command in [Planish::render(&mesh, &image), Planish::dump(&mesh, &dump), Planish::new("bench").path(&mesh)] {
        let outcome = hiding("tessellationShader", command);
        let message = outcome.one_error(FAILED).unwrap();
        assert!(message.contains("tessellationShader"), "{message}");
    }
    let outcome = hiding("transformFeedback", Planish::dump(&mesh, &dump));
    assert!(outcome.one_error(FAILED).unwrap().contains("transform_feedback"), "{outcome:?}");
    let outcome = hiding("fillModeNonSolid", Planish::render(&mesh, &image).flags("--view wire"));
    assert!(outcome.one_error(FAILED).unwrap().contains("fillModeNonSolid"), "{outcome:?}");
    let outcome = hiding("unheardOf", Planish::render(&mesh, &image));
    assert!(outcome.one_error(FAILED).unwrap().contains("unheardOf"), "{outcome:?}");
    assert!(contents(folder.path()).is_empty());

    // What does not need a feature runs without it.
    let small = "--size 16x16 --tess 2";
    hiding("transformFeedback,fillModeNonSolid", Planish::render(&mesh, &image).flags(small)).silent_success().unwrap();
    let devices = hiding("tessellationShader", Planish::new("devices"));
    assert!(devices.status.success() && devices.stdout.contains("tessellationShader"), "{devices:?}");
    assert!(!Planish::new("devices").run().stdout.contains("tessellationShader"));
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut command = Command::new(planish());
    command.args(["info", "--json"]).arg(scene("cube")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // Reading a file takes planish longer than this.
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}
