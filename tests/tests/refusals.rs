//! Wrong usage, requests that cannot be met and devices that cannot run planish: one line each.

use std::io::Cursor;
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
        "compare",
        "compare a.ply",
        "compare a.ply b.ply --samples -1",
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
        "render a.obj -o a.exr --shutter 1,0",
        "render a.obj -o a.exr --filter-width 0",
        "render a.obj -o a.exr --compression jpeg",
        "render a.obj -o a.exr --tone-map film",
        "render a.obj -o a.exr --max-level -1",
        "render a.obj -o a.exr --eye 1,2,3",
        "render a.obj -o a.exr --eye 1,2 --target 0,0,0",
        "render a.obj -o a.exr --eye 1,2,nan --target 0,0,0",
        "render a.obj -o a.exr --fov 180",
        "render a.obj -o a.exr --fov 0",
        "render a.obj -o a.exr --frames 3-1",
        "render a.obj -o a.exr --repeat 0",
        "info a.obj --device 0",
        "info a.obj --displacement a.exr",
        "render a.obj -o a.exr --displacement",
        "render a.obj -o a.exr --displacement a.exr --displacement-scale nan",
        "render a.obj -o a.exr --displacement a.exr --displacement-midpoint inf",
        "render a.obj -o a.exr --displacement a.exr --displacement-kind normal",
        "render a.obj -o a.exr --displacement a.exr --displacement-layout ptex",
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
        ("--method table --scheme butterfly", "butterfly"),
        ("--scheme loop", "loop"),
        ("--scheme bilinear", "bilinear"),
        ("--camera nobody", "nobody"),
        ("--frames 1-3", "####"),
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
fn details_of_a_displacement_map_that_there_is_not_are_wrong_usage() {
    let folder = temporary();
    for (flags, flag) in [
        ("--displacement-scale 2", "--displacement-scale"),
        ("--displacement-midpoint -0.5", "--displacement-midpoint"),
        ("--displacement-kind vector", "--displacement-kind"),
        ("--displacement-layout faces", "--displacement-layout"),
    ] {
        for command in [
            Planish::render(&scene("cube"), &folder.path().join("out.exr")),
            Planish::dump(&scene("cube"), &folder.path().join("out.ply")),
            Planish::new("bench --cpu").path(&scene("cube")),
        ] {
            let outcome = command.flags(flags).run();
            let message = outcome.one_error(WRONG_USAGE).unwrap();
            assert!(message.contains(&format!("{flag} needs --displacement")), "{message}");
        }
    }
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn displacement_maps_that_cannot_be_used_are_refused_with_one_line() {
    let folder = temporary();
    let inputs = temporary();
    let file = |name: &str, content: &[u8]| {
        let path = inputs.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    };
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1.5 0\nvt 1.5 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    let quad = file("quad.obj", quad.as_bytes());
    let mut gray = Vec::new();
    image::GrayImage::new(3, 3).write_to(&mut Cursor::new(&mut gray), image::ImageFormat::Png).unwrap();
    let (good, tile) = (file("good.png", &gray), file("map.1001.png", &gray));
    let mut claiming = gray.clone();
    claiming[16..24].copy_from_slice(&[0, 0x0f, 0x42, 0x40, 0, 0x0f, 0x42, 0x40]);
    let cases = [
        (quad.clone(), file("text.png", b"v 0 0 0"), "", "text.png: found no PNG image"),
        (quad.clone(), file("cut.png", &gray[..gray.len() / 2]), "", "cut.png: found no PNG image"),
        (quad.clone(), file("huge.png", &claiming), "", "huge.png: found "),
        (quad.clone(), file("a.jpg", &gray), "", "a.jpg: found a file of unknown format, expected a displacement map"),
        (quad.clone(), inputs.path().to_owned(), "", "found a directory, expected a displacement map"),
        (quad.clone(), inputs.path().join("none.exr"), "", "none.exr: found no file that can be read"),
        (quad.clone(), tile.with_file_name("map.<UDIM>.png"), "", "no file for tile 1002, which UV (1.5, 0) uses"),
        (quad.clone(), good.clone(), "--displacement-kind vector", "channels R, G and B"),
        (scene("cube"), good.clone(), "", "without texture coordinates"),
        (
            scene("cube"),
            good.clone(),
            "--displacement-layout faces",
            "an atlas of 3 x 3 texels, expected rows of 6 tiles",
        ),
    ];
    check_all(&cases, |(mesh, map, flags, words)| {
        let out = folder.path().join("out.exr");
        let outcome = Planish::render(mesh, &out).flags(flags).flags("--displacement").path(map).run();
        let message = outcome.one_error(FAILED)?;
        if message.contains(words) { Ok(()) } else { Err(outcome.told(&format!("expected the line to say {words:?}"))) }
    });
    assert!(contents(folder.path()).is_empty());
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
