//! What `planish render` writes: channels and what they hold, sizes, samples, and the same bytes every time.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use exr::prelude::SampleType;
use planish_tests::cage::Cage;
use planish_tests::folder::{contents, temporary};
use planish_tests::golden::read;
use planish_tests::layers::{Layers, transform};
use planish_tests::parallel::check_all;
use planish_tests::program::Planish;
use planish_tests::repository::{models, scene};
use serde_json::Value;

/// What a layer holds where there is no surface, if it holds ids.
const NO_SURFACE: u32 = u32::MAX;
/// All layers.
const ALL_LAYERS: &str = "--aov z,n,p,uv,face,patch,level,tess,color";
/// A view from near by, not along any axis.
const OBLIQUE: &str = "--eye 2.1,1.4,3.3 --target 0.2,0.1,-0.1 --fov 50";

fn render(mesh: &str, flags: &str, name: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = temporary();
    let image = folder.path().join(name);
    Planish::render(&scene(mesh), &image).flags(flags).run().silent_success().unwrap();
    (folder, image)
}

fn layers(mesh: &str, flags: &str) -> Layers {
    let (_folder, image) = render(mesh, flags, "out.exr");
    Layers::read(&image)
}

/// Whether each pixel shows the surface.
fn covered(layers: &Layers) -> Vec<bool> {
    layers.integers("face").iter().map(|&face| face != NO_SURFACE).collect()
}

#[test]
fn channels_have_the_names_and_types_of_the_interface() {
    let found = layers("cube", &format!("--size 40x30 --tess 2 {ALL_LAYERS}"));
    let floats = "N.X N.Y N.Z P.X P.Y P.Z Z color.B color.G color.R tess uv.x uv.y";
    let mut expected: Vec<(&str, SampleType)> = floats.split(' ').map(|name| (name, SampleType::F32)).collect();
    expected.extend(["A", "B", "G", "R"].map(|name| (name, SampleType::F16)));
    expected.extend(["face", "level", "patch"].map(|name| (name, SampleType::U32)));
    expected.sort_by_key(|&(name, _)| name);
    assert_eq!(found.types(), expected);
    assert_eq!(found.size, [40, 30]);
    assert!(found.software.starts_with("planish "), "{}", found.software);

    let colour_alone = layers("cube", "--size 7x5 --tess 2");
    assert_eq!(colour_alone.types(), ["A", "B", "G", "R"].map(|name| (name, SampleType::F16)));
}

#[test]
fn layers_agree_with_each_other_and_with_the_camera() {
    for (mesh, tess, flags) in [
        ("mixed_triangles_quads", 6.0_f32, "--size 160x90"),
        ("adjacent_extraordinary", 9.5, "--size 90x121"),
        ("grid_8x8", 3.0, "--size 101x60"),
        ("boundary_none", 5.0, "--size 64x64"),
    ] {
        let found = layers(mesh, &format!("{flags} {OBLIQUE} --tess {tess} {ALL_LAYERS}"));
        let [width, height] = found.size;
        let (z, alpha, factors) = (found.floats("Z"), found.floats("A"), found.floats("tess"));
        let (normals, positions) = (found.vectors("N", ["X", "Y", "Z"]), found.vectors("P", ["X", "Y", "Z"]));
        let (uv, levels, faces) = (found.vectors("uv", ["x", "y"]), found.integers("level"), found.integers("face"));
        let cage = Cage::read(&scene(mesh));
        let mut seen = 0;
        for (pixel, is_covered) in covered(&found).into_iter().enumerate() {
            let place = format!("{mesh}: pixel {}, {}", pixel % width, pixel / width);
            assert_eq!(alpha[pixel], f32::from(u8::from(is_covered)), "{place}: alpha");
            if !is_covered {
                assert!(z[pixel].is_infinite() && z[pixel] > 0.0, "{place}: Z");
                assert_eq!((normals[pixel], positions[pixel], uv[pixel]), ([0.0; 3], [0.0; 3], [0.0; 2]), "{place}");
                assert_eq!((levels[pixel], found.integers("patch")[pixel]), (NO_SURFACE, NO_SURFACE), "{place}");
                continue;
            }
            seen += 1;
            let length = normals[pixel].map(|x| f64::from(x).powi(2)).iter().sum::<f64>().sqrt();
            assert!((length - 1.0).abs() < 1e-5, "{place}: normal of length {length}");
            let depth = transform(positions[pixel], &found.world_to_camera)[2];
            assert!((depth / f64::from(z[pixel]) - 1.0).abs() < 1e-5, "{place}: Z {} of depth {depth}", z[pixel]);
            let [x, y, _] = transform(positions[pixel], &found.world_to_ndc);
            let off = [x * width as f64 - (pixel % width) as f64, y * height as f64 - (pixel / width) as f64];
            // Rasterizers snap corners to 1/256 of a pixel.
            assert!(off.iter().all(|off| (off - 0.5).abs() < 0.02), "{place}: P is seen at {off:?} of the pixel");
            assert!((faces[pixel] as usize) < cage.ptex_face_count(), "{place}: face {}", faces[pixel]);
            // At a silhouette, where they change by 1 within a pixel, the corners' snapping takes them past the end.
            assert!(uv[pixel].iter().all(|value| (-0.01..=1.01).contains(value)), "{place}: uv {:?}", uv[pixel]);
            // No level is finer than one that has the factor 1.
            assert!(f64::from(levels[pixel]) <= f64::from(tess).log2().ceil(), "{place}: level {}", levels[pixel]);
            let expected = (tess / (levels[pixel] as f32).exp2()).max(1.0);
            assert_eq!(factors[pixel], expected, "{place}: tess factor at level {}", levels[pixel]);
        }
        assert!(seen > width * height / 10, "{mesh}: only {seen} pixels show it");
        let patches: HashSet<u32> = found.integers("patch").iter().copied().collect();
        let distinct_faces: HashSet<u32> = faces.iter().copied().collect();
        assert!(patches.len() >= distinct_faces.len(), "{mesh}: fewer patches than faces");
    }
}

#[test]
fn closed_surfaces_face_the_eye() {
    let found = layers("genus_2", &format!("--size 120x90 {OBLIQUE} --tess 16 --aov z,n,p,face"));
    let eye = [2.1, 1.4, 3.3];
    let (normals, positions) = (found.vectors("N", ["X", "Y", "Z"]), found.vectors("P", ["X", "Y", "Z"]));
    for (pixel, _) in covered(&found).into_iter().enumerate().filter(|&(_, is_covered)| is_covered) {
        let cosine: f32 = (0..3).map(|axis| normals[pixel][axis] * (eye[axis] - positions[pixel][axis])).sum();
        // Normals are interpolated: at a silhouette one may just turn away.
        assert!(cosine > -0.5, "pixel {pixel}: the normal {:?} looks away", normals[pixel]);
    }
}

#[test]
fn samples_smooth_edges_and_leave_layers_alone() {
    let flags = format!("--size 80x60 {OBLIQUE} --tess 4 {ALL_LAYERS}");
    let one = layers("cube", &flags);
    let many = layers("cube", &format!("{flags} --samples 16"));
    for (name, kind) in one.types() {
        match kind {
            SampleType::U32 => assert_eq!(one.integers(name), many.integers(name), "{name}"),
            SampleType::F32 => assert_eq!(one.floats(name), many.floats(name), "{name}"),
            SampleType::F16 => {}
        }
    }
    let is_partial = |alpha: &f32| *alpha > 0.0 && *alpha < 1.0;
    assert_eq!(one.floats("A").iter().filter(|&alpha| is_partial(alpha)).count(), 0);
    let (before, after) = (one.floats("A"), many.floats("A"));
    let partial = after.iter().filter(|&alpha| is_partial(alpha)).count();
    assert!(partial > 80, "only {partial} pixels are partly covered");
    // Coverage in sixteenths, and the same area.
    assert!(after.iter().all(|alpha| (alpha * 16.0 - (alpha * 16.0).round()).abs() < 1e-2));
    let [before, after] = [before, after].map(|alpha| alpha.iter().sum::<f32>());
    assert!((before - after).abs() < 0.01 * before, "{before} pixels covered, with samples {after}");
}

#[test]
fn png_holds_the_colours_of_exr() {
    let flags = format!("--size 121x95 {OBLIQUE} --tess 4 --samples 4");
    let (_folder, png) = render("cube", &flags, "out.png");
    let image = read(&png).unwrap();
    assert_eq!(image.dimensions(), (121, 95));
    let found = layers("cube", &flags);
    let (alpha, channels) = (found.floats("A"), ["R", "G", "B"].map(|name| found.floats(name)));
    let mut compared = 0;
    for (pixel, colour) in image.pixels().enumerate().filter(|&(pixel, _)| alpha[pixel] == 1.0) {
        for (channel, stored) in channels.iter().zip(colour.0) {
            let linear = channel[pixel].clamp(0.0, 1.0);
            let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
            assert!((encoded * 255.0 - f32::from(stored)).abs() < 1.0, "pixel {pixel}: {stored} for {linear}");
            compared += 1;
        }
    }
    assert!(compared > 1000);
}

#[test]
fn images_of_any_size_are_written() {
    check_all(&["1x1", "1x7", "2x3", "17x9", "300x2", "33x64"], |size| {
        let folder = temporary();
        let (exr, png) = (folder.path().join("out.exr"), folder.path().join("out.png"));
        let flags = format!("--size {size} --tess 2 {ALL_LAYERS} -o");
        Planish::render(&scene("cube"), &exr).flags(&flags).path(&png).run().silent_success()?;
        let [width, height] = Layers::read(&exr).size;
        let image = read(&png)?;
        let is_right = format!("{width}x{height}") == *size && image.dimensions() == (width as u32, height as u32);
        if is_right { Ok(()) } else { Err(format!("{size}: {width}x{height} and {:?}", image.dimensions())) }
    });
}

#[test]
fn culling_changes_no_pixel_of_a_closed_mesh() {
    let flags = format!("--size 100x100 {OBLIQUE} --tess 8 --view normal");
    let pixels = |more: &str| {
        let (_folder, image) = render("genus_2", &format!("{flags} {more}"), "a.png");
        fs::read(image).unwrap()
    };
    assert!(pixels("") == pixels("--no-cull"));
}

/// The frame of `--stats -`, and the bytes of the image.
fn frame_and_image(mesh: &Path, flags: &str) -> Result<(Value, Vec<u8>), String> {
    let folder = temporary();
    let image = folder.path().join("out.exr");
    let outcome = Planish::render(mesh, &image).flags(flags).flags("--stats -").run().silent_success()?;
    let bytes = fs::read(&image).map_err(|error| error.to_string())?;
    Ok((outcome.json()?["frames"][0].clone(), bytes))
}

/// Number of patches of all kinds in a frame.
fn patch_count(frame: &Value) -> u64 {
    ["regular", "transition", "quad"].iter().map(|kind| frame["patches"][kind].as_u64().expect("a count")).sum()
}

/// Compares a frame with one in which nothing is left out, and returns the share of the patches that were drawn.
fn drawn_share(mesh: &Path, flags: &str, compares_images: bool) -> Result<f64, String> {
    let (frame, image) = frame_and_image(mesh, flags)?;
    let (whole, whole_image) = frame_and_image(mesh, &format!("{flags} --no-cull"))?;
    let wrong = |what: &str| Err(format!("{} {flags}: {what}: {frame} and {whole}", mesh.display()));
    if compares_images && image != whole_image {
        return wrong("another image");
    }
    let levels = frame["patches_by_level"].as_array().expect("counts by level");
    if levels.iter().filter_map(Value::as_u64).sum::<u64>() != patch_count(&frame) {
        return wrong("the levels are not the sum of the kinds");
    }
    if (patch_count(&frame) < patch_count(&whole)) != (frame["triangles"].as_u64() < whole["triangles"].as_u64()) {
        return wrong("fewer patches have fewer triangles");
    }
    Ok(patch_count(&frame) as f64 / patch_count(&whole) as f64)
}

#[test]
fn patches_outside_of_the_image_are_left_out_without_a_trace() {
    let meshes = ["grid_8x8", "hero", "boundary_valences", "boundary_none", "open_cylinder", "mixed_triangles_quads"];
    let ways = ["--edge-pixels 3", "--tess 3.3 --spacing fractional-even --samples 3"];
    check_all(&meshes, |mesh| {
        for way in ways {
            let flags = format!("--size 90x70 {ALL_LAYERS} --fov 10 {way}");
            let share = drawn_share(&scene(mesh), &flags, true)?;
            if share > 0.9 {
                return Err(format!("{mesh} {flags}: {share} of the patches are drawn"));
            }
        }
        Ok(())
    });
}

#[test]
fn patches_that_are_turned_away_are_left_out() {
    let meshes = [["genus_2", "cube", "two_components"].map(scene).to_vec(), models()].concat();
    check_all(&meshes, |mesh| {
        for way in ["--edge-pixels 2 --spacing equal", "--tess 5.3"] {
            // Images are compared where only the emit stage differs, in the tests of the render crate: two sides of an
            // edge agree to rounding, and backs may be seen between them.
            let share = drawn_share(mesh, &format!("--size 90x70 {way}"), false)?;
            if !(0.4..0.85).contains(&share) {
                return Err(format!("{} {way}: {share} of the patches are drawn", mesh.display()));
            }
        }
        Ok(())
    });
}

#[test]
fn frames_are_numbered_and_those_of_a_still_scene_are_equal() {
    let (folder, _) = render("cube", "--size 20x20 --tess 2 --frames 8-12x2", "cube.###.png");
    let files = contents(folder.path());
    let names: Vec<_> = files.keys().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["cube.008.png", "cube.010.png", "cube.012.png"]);
    assert_eq!(files.values().collect::<HashSet<_>>().len(), 1);
}

#[test]
fn an_image_that_is_read_in_parts_is_whole() {
    // Two parts, of which the crop lies in the second.
    let flags = format!("--size 320x240 {OBLIQUE} --tess 4 --samples 2");
    let whole = layers("genus_2", &flags);
    let part = layers("genus_2", &format!("{flags} --crop 100,210,120x30"));
    for channel in ["R", "G", "B", "A"] {
        let (whole, part) = (whole.floats(channel), part.floats(channel));
        let rows = (210..240).flat_map(|y| &whole[320 * y + 100..320 * y + 220]);
        assert!(rows.clone().any(|&value| value > 0.0) && rows.eq(&part), "{channel}");
    }
}
