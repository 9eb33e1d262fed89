//! Scenes of other formats: the same surface whatever the format, and animation.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use glam::{Affine3A, Vec3};
use planish_scene::{LoadOptions, Scene, load};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_tests::export::{write_gltf, write_usda};
use planish_tests::folder::{contents, temporary};
use planish_tests::layers::{Layers, transform};
use planish_tests::parallel::check_all;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::{FAILED, Planish};
use planish_tests::repository::{planish, root, scene};

/// A scene of ours, of any format.
fn file(name: &str) -> std::path::PathBuf {
    let path = root().join("scenes").join(name);
    assert!(path.is_file(), "{} is missing", path.display());
    path
}

/// The bits of a dump's triangles, in one order.
fn bits(path: &Path) -> Vec<[u32; 27]> {
    let words = |vertex: &Vertex| {
        let floats = [&vertex.position[..], &vertex.normal, &vertex.uv].concat();
        let mut words = [0; 9];
        floats.iter().zip(&mut words).for_each(|(value, word)| *word = value.to_bits());
        words[8] = vertex.face;
        words
    };
    let vertices: Vec<Vertex> = Dump::read(path).unwrap().vertices().collect();
    let mut triangles: Vec<[u32; 27]> =
        vertices.chunks_exact(3).map(|triangle| std::array::from_fn(|i| words(&triangle[i / 9])[i % 9])).collect();
    triangles.sort_unstable();
    triangles
}

/// Cages with all that the three formats have in common.
const CAGES: [&str; 7] =
    ["cube", "genus_2", "crease_2_3", "corner_2_3_crease_1_5", "hole_interior", "ngon_5", "mixed_triangles_quads"];

#[test]
fn a_cage_has_the_same_surface_to_the_bit_through_obj_gltf_and_usd() {
    let folder = temporary();
    check_all(&CAGES, |name| {
        let mesh = load(scene(name), &LoadOptions::default()).map_err(|error| error.to_string())?.meshes.remove(0);
        let path = |extension: &str| folder.path().join(format!("{name}.{extension}"));
        write_gltf(&mesh.control_mesh, &path("gltf"));
        write_usda(&mesh.control_mesh, &path("usda"));
        let dump = |file: &Path, out: &Path| {
            let flags = "--edge-pixels 9 --size 320x240 --eye 3,2,4 --target 0,0,0";
            Planish::dump(file, out).flags(flags).run().silent_success().map(|_| bits(out))
        };
        let expected = dump(&scene(name), &path("obj.ply"))?;
        for format in ["gltf", "usda"] {
            if dump(&path(format), &path(&format!("{format}.ply")))? != expected {
                return Err(format!("{name}: the surface through {format} is another one"));
            }
        }
        if expected.is_empty() { Err(format!("{name}: no triangles")) } else { Ok(()) }
    });
}

#[test]
fn a_binary_gltf_file_is_the_same_scene_as_its_text() {
    let folder = temporary();
    let dump = |name: &str| {
        let out = folder.path().join(format!("{name}.ply"));
        Planish::dump(&file(name), &out).flags("--tess 3 --frames 7").run().silent_success().unwrap();
        bits(&out)
    };
    let text = dump("sprout.gltf");
    assert!(!text.is_empty() && text == dump("sprout.glb"));
}

/// A run of 24 frames of the sprout, which sways on its joints and blinks by morph targets.
fn animation(out: &Path, flags: &str) -> Command {
    std::fs::create_dir_all(out).unwrap();
    let mut command = Command::new(planish());
    command.arg("render").arg(file("sprout.glb")).arg("-o").arg(out.join("f.####.exr"));
    let all = "--frames 0-23 --size 80x60 --edge-pixels 4 --shadow-map-size 64 --aov motion,z,object,crypto_material";
    command.args(all.split_whitespace()).args(flags.split_whitespace());
    command
}

#[test]
fn a_skinned_animation_is_the_same_again_also_if_it_is_killed_and_resumed() {
    let folder = temporary();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    assert!(animation(&first, "--validation").status().unwrap().success());
    let images = |out: &Path| -> Vec<_> {
        let all = contents(out).into_iter();
        all.filter(|(path, _)| path.extension().is_some_and(|extension| extension == "exr"))
            .map(|(_, bytes)| bytes)
            .collect()
    };
    let expected = images(&first);
    assert_eq!(expected.len(), 24);
    let mut killed = animation(&second, "").spawn().unwrap();
    let start = Instant::now();
    while images(&second).len() < 4 && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(10));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    let left = images(&second);
    assert!(!left.is_empty() && left.len() < 24 && left == expected[..left.len()], "{} files", left.len());
    assert!(animation(&second, "--skip-existing").status().unwrap().success());
    assert!(images(&second) == expected, "the resumed run differs");
    let layers = Layers::read(&first.join("f.0003.exr"));
    let longest = layers.floats("motion.x").iter().fold(0.0_f32, |longest, motion| longest.max(motion.abs()));
    assert!(longest > 0.1, "{longest}");
}

/// The cages of a scene at a moment, and where its instances are.
struct Posed {
    evaluators: Vec<Evaluator>,
    transforms: Vec<Affine3A>,
}

impl Posed {
    fn new(scene: &Scene, time: f64) -> Self {
        let pose = scene.pose(time);
        let evaluator = |mesh: usize| {
            let positions = scene.posed_positions(mesh, &pose);
            Evaluator::new(&ControlMesh { positions, ..scene.meshes[mesh].control_mesh.clone() }).unwrap()
        };
        Self {
            evaluators: (0..scene.meshes.len()).map(evaluator).collect(),
            transforms: pose.instances.iter().map(|instance| instance.transform).collect(),
        }
    }

    /// Where parameters of an instance are in the world.
    fn point(&mut self, scene: &Scene, instance: usize, face: u32, [u, v]: [f32; 2]) -> Option<[f32; 3]> {
        let mesh = scene.instances[instance].mesh;
        let point = self.evaluators[mesh].evaluate(face, u.into(), v.into())?;
        let local = Vec3::from_array(point.position.map(|c| c as f32));
        Some(self.transforms[instance].transform_point3(local).to_array())
    }
}

#[test]
fn motion_of_skinned_and_morphed_surfaces_is_the_difference_of_two_frames() {
    let folder = temporary();
    let flags = "--frames 5-6 --size 160x120 --edge-pixels 0.7 --aov uv,face,object,motion";
    let path = file("sprout.glb");
    Planish::render(&path, &folder.path().join("f.####.exr")).flags(flags).run().silent_success().unwrap();
    let scene = load(&path, &LoadOptions::default()).unwrap();
    let rate = scene.frames_per_second.unwrap_or(24.0);
    let [mut now, mut then] = [5.0, 6.0].map(|frame| Posed::new(&scene, frame / rate));
    let [layers, next] = ["f.0005.exr", "f.0006.exr"].map(|name| Layers::read(&folder.path().join(name)));
    let [width, height] = layers.size.map(|pixels| pixels as f64);
    // Faces count through all instances.
    let counts =
        scene.instances.iter().map(|instance| scene.meshes[instance.mesh].control_mesh.ptex_face_count() as u32);
    let first_faces: Vec<u32> = counts.scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
    let (uv, motion) = (layers.vectors("uv", ["x", "y"]), layers.vectors("motion", ["x", "y"]));
    let (mut moving, mut worst) = (0, 0.0_f64);
    for (pixel, &object) in layers.integers("object").iter().enumerate() {
        if object == u32::MAX {
            continue;
        }
        let instance = object as usize;
        let deforms = scene.meshes[scene.instances[instance].mesh].deformation.is_some();
        let face = layers.integers("face")[pixel] - first_faces[instance];
        let points = [&mut now, &mut then].map(|posed| posed.point(&scene, instance, face, uv[pixel]));
        let [Some(from), Some(to)] = points else { panic!("pixel {pixel}: no surface at {:?}", uv[pixel]) };
        let (from, to) = (transform(from, &layers.world_to_ndc), transform(to, &next.world_to_ndc));
        let expected = [(to[0] - from[0]) * width, (to[1] - from[1]) * height];
        let error = (0..2).map(|axis| (f64::from(motion[pixel][axis]) - expected[axis]).abs()).fold(0.0, f64::max);
        worst = worst.max(error);
        moving += usize::from(deforms && expected[0].hypot(expected[1]) > 0.3);
    }
    assert!(moving > 200, "{moving} pixels of meshes that deform move");
    assert!(worst <= 0.01, "{worst} pixels");
}

#[test]
fn cryptomattes_tell_the_instances_that_the_layer_of_objects_does() {
    let folder = temporary();
    let (path, out) = (file("sprout.glb"), folder.path().join("a.exr"));
    let flags =
        "--frames 5 --size 96x72 --edge-pixels 3 --shadow-map-size 64 --aov object,crypto_object,crypto_material";
    Planish::render(&path, &out).flags(flags).run().silent_success().unwrap();
    let scene = load(&path, &LoadOptions::default()).unwrap();
    let manifest = manifest(&out, "CryptoObject");
    let layers = Layers::read(&out);
    let (ids, coverage) = (layers.floats("CryptoObject00.R"), layers.floats("CryptoObject00.G"));
    let mut seen = BTreeSet::new();
    for (pixel, &object) in layers.integers("object").iter().enumerate() {
        if object == u32::MAX {
            assert_eq!((ids[pixel], coverage[pixel]), (0.0, 0.0), "pixel {pixel}");
            continue;
        }
        let name = &scene.instances[object as usize].name;
        let id = format!("{:08x}", ids[pixel].to_bits());
        assert_eq!(
            (manifest[name.as_str()].as_str(), coverage[pixel]),
            (Some(id.as_str()), 1.0),
            "pixel {pixel}: {name}"
        );
        seen.insert(name);
    }
    assert!(seen.len() >= 4, "{seen:?}");
    let materials: Vec<String> = scene.materials.iter().map(|material| material.name.clone()).collect();
    let told = self::manifest(&out, "CryptoMaterial");
    assert!(materials.iter().all(|name| told.contains_key(name)), "{told:?}");
}

#[test]
fn a_scene_s_own_environment_is_brightened() {
    let folder = temporary();
    let shown = |flags: &str| {
        let out = folder.path().join("sky.exr");
        let view = "--size 24x18 --tess 2 --shadow-map-size 16 --eye 0,1,9 --target 0,9,0";
        Planish::render(&file("lamp.usda"), &out).flags(view).flags(flags).run().silent_success().unwrap();
        let layers = Layers::read(&out);
        ["R", "G", "B", "A"].map(|channel| layers.floats(channel)[0])
    };
    // The light's intensity times its colour, in half floats; the view's first pixel is above the scene.
    let sky = [0.2, 0.225, 0.25, 1.0];
    let is_near = |pixel: [f32; 4], expected: [f32; 4]| pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-4);
    assert!(is_near(shown(""), sky), "{:?}", shown(""));
    let brighter = sky.map(|c| if c < 1.0 { c * 2.0 } else { c });
    assert!(is_near(shown("--environment-exposure 1"), brighter));
    let obj = scene("cube");
    for flags in ["--show-environment", "--environment-rotation 90", "--environment-exposure -1"] {
        let outcome = Planish::render(&obj, &folder.path().join("none.png")).flags(flags).run();
        let message = outcome.one_error(FAILED).unwrap();
        assert!(
            message.ends_with("no environment to turn, brighten or show, expected one in the scene or --environment")
        );
    }
}

/// The manifest of a Cryptomatte in a file's header.
fn manifest(path: &Path, name: &str) -> serde_json::Map<String, serde_json::Value> {
    let meta = exr::meta::MetaData::read_from_file(path, false).unwrap();
    let attributes = &meta.headers[0].own_attributes.other;
    let text = |key: &str| match attributes.get(&exr::prelude::Text::from(key)) {
        Some(exr::prelude::AttributeValue::Text(text)) => text.to_string(),
        other => panic!("{key}: {other:?}"),
    };
    let keys = attributes.keys().map(ToString::to_string).filter(|key| key.ends_with("/name"));
    let key = keys.into_iter().find(|key| text(key) == name).unwrap_or_else(|| panic!("no Cryptomatte {name}"));
    serde_json::from_str(&text(&key.replace("/name", "/manifest"))).unwrap()
}
