//! What scene files say of lenses, shutters, lights and materials, seen in the images of `planish render`.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use exr::prelude::{AttributeValue, MetaData, Text};
use planish_tests::folder::temporary;
use planish_tests::layers::Layers;
use planish_tests::program::{FAILED, Planish};
use planish_tests::stage::{DISTANCE, RATE, Stage, place};

/// Pixels of a side of the images.
const SIDE: usize = 64;
/// Every sample in the middle of its pixel, as good as.
const SHARP: &str = "--filter box --filter-width 0.01";
/// A material without reflections.
const DULL: &str = "int inputs:useSpecularWorkflow = 1
        color3f inputs:specularColor = (0, 0, 0)
        color3f inputs:diffuseColor = (1, 1, 1)";
const BOUND: &str = "rel material:binding = </Dull>";

fn render(scene: &Path, flags: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = temporary();
    let image = folder.path().join("out.exr");
    let flags = format!("--size {SIDE}x{SIDE} --tess 4 --shadow-map-size 256 {flags}");
    Planish::render(scene, &image).flags(&flags).run().silent_success().unwrap();
    (folder, image)
}

fn layers(scene: &Path, flags: &str) -> Layers {
    let (_folder, image) = render(scene, flags);
    Layers::read(&image)
}

/// The mean place along x of what an image covers.
fn middle(layers: &Layers) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (pixel, alpha) in layers.floats("A").into_iter().enumerate() {
        sum += f64::from(alpha) * place(pixel, SIDE)[0];
        weights += f64::from(alpha);
    }
    sum / weights
}

/// Along x by 0.3 a frame, from -1.5 on.
const PATH: &str = r#"double3 xformOp:translate.timeSamples = { 0: (-1.5, 0, 0), 10: (1.5, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]"#;

/// A square that moves.
fn moving(camera: &str, light: &str) -> Stage {
    Stage::new(camera).with_rectangle("square", [-0.25, -0.25], [0.25, 0.25], 0.0, PATH).with(light)
}

#[test]
fn an_open_shutter_sees_what_moves_where_it_is_meanwhile() {
    let folder = temporary();
    let light = sun(0.0);
    let own = "double shutter:open = -3\n    double shutter:close = -1";
    for (camera, flags, light, [open, close]) in [
        ("", "--shutter 0,2", "", [0.0, 2.0]),
        ("", "--shutter -2,1", "", [-2.0, 1.0]),
        ("", "--shutter 1,3", light.as_str(), [1.0, 3.0]),
        (own, "", "", [-3.0, -1.0]),
        (own, "--shutter 1", "", [0.0, 1.0]),
    ] {
        let scene = moving(camera, light).write(folder.path());
        let (_folder, image) = render(&scene, &format!("--frames 5 --samples 16 {SHARP} {flags}"));
        let (found, expected) = (middle(&Layers::read(&image)), 0.15 * (open + close));
        assert!((found - expected).abs() < 0.02, "{camera} {flags}: {found}, expected {expected}");
        let meta = MetaData::read_from_file(&image, false).unwrap();
        let own = &meta.headers[0].own_attributes;
        assert_eq!(own.exposure, Some(((close - open) / RATE) as f32));
        assert_eq!(own.frames_per_second, Some((48, 1)));
        let time = AttributeValue::F32((5.0 / RATE) as f32);
        assert_eq!(own.other.get(&Text::from("time")), Some(&time));
    }
}

#[test]
fn shadows_move_while_the_shutter_is_open() {
    let folder = temporary();
    let scene = Stage::new("")
        .with_rectangle("floor", [-3.0, -3.0], [3.0, 3.0], 0.0, BOUND)
        .with_rectangle("plate", [0.7, -0.25], [1.2, 0.25], 1.0, &format!("{BOUND}\n{PATH}"))
        .with_material("Dull", DULL)
        .with(&sun(0.0))
        .write(folder.path());
    let lit = 3.0 / PI * 0.5_f64.sqrt();
    // Where the shadow lies along x, its area, and how dark it is at most.
    let shadow = |flags: &str| {
        let red = layers(&scene, &format!("--frames 5 --samples 16 {SHARP} {flags}")).floats("R");
        let (mut sum, mut darkness, mut darkest) = (0.0, 0.0, 0.0_f64);
        for (pixel, red) in red.into_iter().enumerate() {
            // Not the last bits of what is lit.
            let dark = Some(1.0 - f64::from(red) / lit).filter(|&dark| dark > 0.01).unwrap_or(0.0);
            sum += dark * place(pixel, SIDE)[0];
            darkness += dark;
            darkest = darkest.max(dark);
        }
        (sum / darkness, darkness * (4.0 / SIDE as f64).powi(2), darkest)
    };
    // A unit to the left of the plate, which is a unit up; the bias of the shadow map moves it by some of its texels.
    let (still, _, darkest) = shadow("--shutter 0,0");
    assert!((still - -0.05).abs() < 0.1 && darkest > 0.99, "{still}, {darkest}");
    for [open, close] in [[0.0, 2.0], [-2.0, 1.0]] {
        let (found, area, darkest) = shadow(&format!("--shutter {open},{close}"));
        let expected = still + 0.15 * (open + close);
        assert!((found - expected).abs() < 0.03, "{open} to {close}: {found}, expected {expected}");
        assert!((area - 0.25).abs() < 0.03, "{open} to {close}: a shadow of {area}");
        // It is half a unit wide, and passes by.
        let share = 0.5 / (0.3 * (close - open));
        assert!((darkest - share).abs() < 0.1, "{open} to {close}: {darkest} dark, expected {share}");
    }
}

#[test]
fn what_stands_where_it_was_made_and_moves_on_has_motion() {
    let folder = temporary();
    let found = layers(&moving("", "").write(folder.path()), "--frames 5 --aov motion");
    let (x, alpha) = (found.floats("motion.x"), found.floats("A"));
    // 0.3 of the 4 that the image shows.
    let expected = 0.3 / 4.0 * SIDE as f32;
    assert!(x.iter().zip(&alpha).all(|(x, alpha)| (x - alpha * expected).abs() < 0.01) && alpha.contains(&1.0));
}

/// The share of a disk of radius 1 that is left of x.
fn share_of_disk(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / PI
}

#[test]
fn a_lens_blurs_an_edge_by_its_disk() {
    let folder = temporary();
    let (focal, stop) = (5.0, 10.0);
    for focus in [5.0, 25.0] {
        let camera = format!("float fStop = {stop}\n    float focusDistance = {focus}");
        let scene = Stage::new(&camera).with_rectangle("square", [0.0, -1.0], [8.0, 8.0], 0.0, "").write(folder.path());
        let found = layers(&scene, &format!("--samples 64 {SHARP}")).floats("A");
        let radius = focal / (2.0 * stop) * f64::abs(DISTANCE - focus) / focus;
        let mut partly = 0;
        for (pixel, alpha) in found.into_iter().enumerate() {
            let [x, y] = place(pixel, SIDE);
            let expected = match (x / radius, (y + 1.0) / radius) {
                (x, y) if y > 1.5 => share_of_disk(x),
                (x, y) if x > 1.5 => share_of_disk(y),
                _ => continue,
            };
            assert!((f64::from(alpha) - expected).abs() < 0.06, "{focus}: {alpha} at {x}, {y}, expected {expected}");
            partly += usize::from(expected > 0.05 && expected < 0.95);
        }
        assert!(partly > 200, "{partly}");
    }
}

/// A sun of this diameter in degrees, to the right of the floor and as high.
fn sun(angle: f64) -> String {
    format!(
        r#"def DistantLight "sun" {{
    float inputs:intensity = 3
    bool inputs:normalize = true
    float inputs:angle = {angle}
    double xformOp:rotateY = 45
    uniform token[] xformOpOrder = ["xformOp:rotateY"]
}}"#
    )
}

/// A floor, and a plate above one of its corners whose shadow falls to the left.
fn plate(light: &str) -> Stage {
    Stage::new("")
        .with_material("Dull", DULL)
        .with_rectangle("floor", [-2.0, -2.0], [2.0, 2.0], 0.0, BOUND)
        .with_rectangle("plate", [1.15, 1.15], [1.9, 1.9], 1.0, BOUND)
        .with(light)
}

#[test]
fn a_crop_of_a_lit_scene_has_the_shadows_of_what_is_outside() {
    let folder = temporary();
    let scene = plate(&sun(0.0)).write(folder.path());
    let whole = layers(&scene, "--samples 2");
    let (_folder, image) = render(&scene, "--samples 2 --crop 26,9,20x15");
    let part = Layers::read(&image);
    let window = MetaData::read_from_file(&image, false).unwrap().headers[0].shared_attributes.display_window;
    assert_eq!((window.size.x(), window.size.y(), window.position.x(), window.position.y()), (SIDE, SIDE, 0, 0));
    assert_eq!((part.size, part.position, part.world_to_ndc), ([20, 15], [26, 9], whole.world_to_ndc));
    for channel in ["R", "G", "B", "A"] {
        let (whole, part) = (whole.floats(channel), part.floats(channel));
        for (pixel, value) in part.iter().enumerate() {
            let at = (9 + pixel / 20) * SIDE + 26 + pixel % 20;
            assert_eq!(value.to_bits(), whole[at].to_bits(), "{channel} of pixel {pixel}");
        }
    }
    let red = part.floats("R");
    assert!(red.contains(&0.0) && red.iter().any(|&red| red > 0.2));
}

#[test]
fn a_turned_sun_lights_by_its_cosine_and_its_shadow_falls_away_from_it() {
    let folder = temporary();
    let red = layers(&plate(&sun(0.0)).write(folder.path()), "").floats("R");
    let light = 3.0 / PI * 0.5_f64.sqrt();
    let mut seen = [0; 2];
    for (pixel, red) in red.into_iter().enumerate() {
        let [x, y] = place(pixel, SIDE);
        // The shadow lies a unit to the left, as the plate is a unit up; the plate itself, nearer, covers more than its square.
        let inside = 0.375 - f64::max((x - 0.525).abs(), (y - 1.525).abs());
        if x > 1.1 && y > 1.1 || inside.abs() < 0.1 {
            continue;
        }
        let expected = if inside > 0.0 { 0.0 } else { light };
        assert!((f64::from(red) - expected).abs() < 0.003, "{red} at {x}, {y}, expected {expected}");
        seen[usize::from(inside > 0.0)] += 1;
    }
    assert!(seen[0] > 2000 && seen[1] > 40, "{seen:?}");
}

#[test]
fn lights_with_an_extent_have_soft_shadows() {
    let folder = temporary();
    let lamp = |radius: f64| {
        format!(
            r#"def SphereLight "lamp" {{
    float inputs:radius = {radius}
    float inputs:intensity = 20
    double3 xformOp:translate = (2.5, 1.5, 2.5)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}"#
        )
    };
    for (sharp, soft) in [(lamp(0.01), lamp(0.4)), (sun(0.1), sun(10.0))] {
        // Where no part of the light is seen.
        let dark = |light: &str| {
            let scene = plate(light).write(folder.path());
            let red = layers(&scene, &format!("--samples 12 {SHARP}")).floats("R");
            red.iter().filter(|&&red| red == 0.0).count()
        };
        let (sharp, soft) = (dark(&sharp), dark(&soft));
        assert!(soft > 10 && 10 * soft < 6 * sharp, "{sharp} {soft}");
    }
}

#[test]
fn a_veil_covers_its_share_and_its_light_is_premultiplied() {
    let folder = temporary();
    let inputs = "float inputs:opacity = 0.5\n        color3f inputs:emissiveColor = (4, 2, 1)\n        color3f inputs:diffuseColor = (0, 0, 0)\n        int inputs:useSpecularWorkflow = 1";
    let scene = Stage::new("")
        .with_material("Veil", inputs)
        .with_rectangle("veil", [-3.0, -3.0], [3.0, 3.0], 0.0, "rel material:binding = </Veil>")
        .with("def DistantLight \"off\" { float inputs:intensity = 0 }")
        .write(folder.path());
    let found = layers(&scene, "--samples 16");
    let (red, alpha) = (found.floats("R"), found.floats("A"));
    assert!(red.iter().zip(&alpha).all(|(red, alpha)| (red - 4.0 * alpha).abs() < 4e-3));
    let partly = alpha.iter().filter(|&&alpha| alpha > 0.1 && alpha < 0.9).count();
    assert!(partly > SIDE * SIDE * 9 / 10, "{partly}");
}

/// An image of all around that is red to the right of its middle and blue above.
fn write_sky(path: &Path) {
    let texel =
        |x: u32, y: u32| image::Rgb([f32::from(u8::from((44..52).contains(&x))), 0.25, f32::from(u8::from(y < 8))]);
    image::Rgb32FImage::from_fn(64, 32, texel).save(path).unwrap();
}

#[test]
fn an_environment_is_turned_and_made_brighter_as_asked_for() {
    let folder = temporary();
    let sky = folder.path().join("sky.exr");
    write_sky(&sky);
    let scene = Stage::new("").with_rectangle("speck", [-1.0, -1.0], [-0.9, -0.9], 0.0, "").write(folder.path());
    let seen = |flags: &str| {
        let image = folder.path().join("out.exr");
        let flags = format!("--size 16x16 --show-environment {flags} --environment");
        Planish::render(&scene, &image).flags(&flags).path(&sky).run().silent_success().unwrap();
        let layers = Layers::read(&image);
        ["R", "G", "B", "A"].map(|channel| layers.floats(channel)[8 * 16 + 8])
    };
    assert_eq!(seen(""), [0.0, 0.25, 0.0, 1.0]);
    // A quarter turn to the left brings what was to the right ahead.
    assert_eq!(seen("--environment-rotation 90"), [1.0, 0.25, 0.0, 1.0]);
    assert_eq!(seen("--environment-rotation 90 --environment-exposure 2"), [4.0, 1.0, 0.0, 1.0]);
    assert_eq!(seen("--environment-rotation -90"), [0.0, 0.25, 0.0, 1.0]);
}

#[test]
fn a_sky_of_bytes_is_srgb() {
    let folder = temporary();
    image::RgbImage::from_pixel(8, 4, image::Rgb([188; 3])).save(folder.path().join("sky.png")).unwrap();
    let scene = Stage::new("")
        .with_material("Dull", DULL)
        .with_rectangle("floor", [-2.0, -2.0], [2.0, 2.0], 0.0, BOUND)
        .with("def DomeLight \"dome\" { asset inputs:texture:file = @./sky.png@ }")
        .write(folder.path());
    let red = layers(&scene, "").floats("R")[SIDE * SIDE / 2 + SIDE / 2];
    assert!((red - 0.503).abs() < 4e-3, "{red}");
}

#[test]
fn a_texture_that_is_missing_is_named_by_where_it_was_looked_for() {
    let folder = temporary();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("parts/maps")).unwrap();
    let wood = r#"def Material "Wood" {
    token outputs:surface.connect = </Wood/S.outputs:surface>
    def Shader "S" {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </Wood/T.outputs:rgb>
        token outputs:surface
    }
    def Shader "T" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @./maps/wood.png@
        float3 outputs:rgb
    }
}"#;
    Stage::default().with(wood).write(&path("parts"));
    let layered = r#"def "Wood" (references = @./parts/stage.usda@</Wood>) {}"#;
    let scene = Stage::new("")
        .with(layered)
        .with_rectangle("floor", [-2.0, -2.0], [2.0, 2.0], 0.0, "rel material:binding = </Wood>")
        .write(folder.path());
    let gltf = path("square.gltf");
    fs::write(&gltf, GLTF).unwrap();
    for (scene, missing) in [(scene, "parts/maps/wood.png"), (gltf, "parts/maps/old wood.png")] {
        let outcome = Planish::render(&scene, &path("out.exr")).flags("--size 16x16").run();
        let message = outcome.stderr.lines().last().unwrap_or_default();
        assert_eq!(outcome.status.code(), Some(FAILED), "{message}");
        assert!(
            message.starts_with("planish: error: ") && message.contains(&path(missing).display().to_string()),
            "{message}"
        );
        assert!(!path("out.exr").exists());
    }
}

/// A square with a texture in a folder.
const GLTF: &str = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
    "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
    "textures": [{ "source": 0 }], "images": [{ "uri": "parts/maps/old%20wood.png" }],
    "buffers": [{ "byteLength": 92, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwA=" }],
    "bufferViews": [{ "buffer": 0, "byteOffset": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
        { "buffer": 0, "byteOffset": 80, "byteLength": 12 }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0] },
        { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
        { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" }] }"#;
