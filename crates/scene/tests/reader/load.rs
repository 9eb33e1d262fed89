//! Files on disk: which are opened, and what is said of those that are not.
use crate::common::CUBE;
use planish_scene::{Error, LoadOptions, load};

fn message(result: Result<planish_scene::Scene, Error>) -> String {
    let message = result.unwrap_err().to_string();
    assert!(!message.contains('\n'));
    message
}

#[test]
fn an_obj_file_is_loaded_whatever_the_case_of_its_extension() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["cube.obj", "cube.OBJ"] {
        let path = folder.path().join(name);
        std::fs::write(&path, CUBE).unwrap();
        let scene = load(&path, &LoadOptions::default()).unwrap();
        assert_eq!((scene.name.as_str(), scene.meshes.len()), ("cube", 1));
    }
}

#[test]
fn a_missing_file_is_named() {
    let message = message(load("no/such/file.obj", &LoadOptions::default()));
    assert!(message.starts_with("no/such/file.obj: cannot be read: "), "{message}");
    assert!(
        message.ends_with("; expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file"),
        "{message}"
    );
}

#[test]
fn a_directory_is_not_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.obj");
    std::fs::create_dir(&path).unwrap();
    let expected = format!(
        "{}: found a directory, expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file",
        path.display()
    );
    assert_eq!(message(load(&path, &LoadOptions::default())), expected);
}

#[test]
fn files_of_other_formats_are_refused_with_what_is_accepted() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.fbx", "a", "a.obj.gz"] {
        let path = folder.path().join(name);
        std::fs::write(&path, CUBE).unwrap();
        let expected = format!(
            "{}: found a file of unknown format, expected an .obj, .json, .gltf, .glb or USD (.usd, .usda, .usdc, .usdz) file",
            path.display()
        );
        assert_eq!(message(load(&path, &LoadOptions::default())), expected);
    }
}

#[test]
fn an_empty_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("empty.obj");
    std::fs::write(&path, "").unwrap();
    assert!(message(load(&path, &LoadOptions::default())).contains("found no vertices, expected"));
}

#[test]
fn a_scene_without_cameras_is_seen_in_the_default_view() {
    let scene = planish_scene::read_obj("cube.obj", CUBE.as_bytes(), &LoadOptions::default()).unwrap();
    assert_eq!(scene.cameras, []);
    let camera = scene.camera(None).unwrap();
    assert_eq!(camera, scene.default_view().unwrap());
    assert_eq!(camera.target.to_array(), [0.0; 3]);
    let missing = scene.camera(Some("front")).unwrap_err().to_string();
    assert_eq!(missing, "camera: found the name \"front\", expected no name: the scene has no cameras");
}

#[test]
fn the_first_camera_is_used_and_others_by_name() {
    let mut scene = planish_scene::read_obj("cube.obj", CUBE.as_bytes(), &LoadOptions::default()).unwrap();
    for name in ["front", "side"] {
        let camera = planish_scene::Camera { name: name.to_owned(), ..scene.default_view().unwrap() };
        scene.cameras.push(camera);
    }
    assert_eq!(scene.camera(None).unwrap().name, "front");
    assert_eq!(scene.camera(Some("side")).unwrap().name, "side");
    let missing = scene.camera(Some("top")).unwrap_err().to_string();
    assert_eq!(missing, "camera: found the name \"top\", expected one of \"front\", \"side\"");
}

#[test]
fn a_scene_without_points_has_no_default_view() {
    let error = planish_scene::Scene::default().default_view().unwrap_err().to_string();
    assert_eq!(error, "camera: found a scene without points, expected something to look at");
}
