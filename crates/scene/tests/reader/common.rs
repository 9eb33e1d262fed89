//! What the reader's tests share: small files and short ways to read them.
use planish_scene::{Error, LoadOptions, Mesh, Scene, read_json, read_obj};
use planish_subdiv::mesh::ControlMesh;
use tempfile::TempDir;

/// A cube; faces 0 to 5, vertices 0 to 7.
pub const CUBE: &str = "\
v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 -1\nv 1 -1 -1
f 1 2 4 3\nf 3 4 6 5\nf 5 6 8 7\nf 7 8 2 1\nf 2 8 6 4\nf 7 1 3 5\n";

pub fn read(text: impl AsRef<[u8]>) -> Result<Scene, Error> {
    read_obj("folder/name.obj", text.as_ref(), &LoadOptions::default())
}

pub fn repair(text: &str) -> Scene {
    read_obj("name.obj", text.as_bytes(), &LoadOptions { repair: true, ..LoadOptions::default() }).unwrap()
}

/// The one mesh of a file that must be read without a warning.
pub fn mesh(text: impl AsRef<[u8]>) -> Mesh {
    let mut scene = read(text).unwrap();
    assert_eq!(scene.warnings, []);
    assert_eq!(scene.meshes.len(), 1);
    scene.meshes.remove(0)
}

/// The cube with further lines, from line 15 on.
pub fn cube_with(lines: &str) -> Result<Scene, Error> {
    read(format!("{CUBE}{lines}"))
}

/// The cage of the cube with further lines, which must not cause a warning.
pub fn tagged(lines: &str) -> ControlMesh {
    mesh(format!("{CUBE}{lines}")).control_mesh
}

/// Asserts that a text is refused with exactly this message after the file's name.
pub fn assert_refused(text: impl AsRef<[u8]>, message: &str) {
    let error = read(text.as_ref()).expect_err("the file should be refused");
    assert_eq!(error.to_string(), format!("folder/name.obj: {message}"));
    assert!(!error.to_string().contains('\n'));
}

/// A folder of meshes for scene files to name: `cube.obj`, and `sub/strip.OBJ` of one quad. `folder.obj` is a folder.
pub fn scene_folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::create_dir(path("sub")).unwrap();
    std::fs::create_dir(path("folder.obj")).unwrap();
    std::fs::write(path("cube.obj"), CUBE).unwrap();
    std::fs::write(path("sub/strip.OBJ"), "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    folder
}

/// A scene file that has the cube and these instances.
pub fn scene_of(instances: &str) -> String {
    format!(r#"{{ "meshes": [{{ "name": "cube", "file": "cube.obj" }}], "instances": [{instances}] }}"#)
}

/// Reads a scene file that lies in a folder of meshes.
pub fn scene_in(folder: &TempDir, text: &str) -> Result<Scene, Error> {
    read_json(folder.path().join("scene.json"), text.as_bytes(), &LoadOptions::default())
}

pub fn scene(text: &str) -> Result<Scene, Error> {
    scene_in(&scene_folder(), text)
}

/// Asserts that a scene file is refused with exactly this message after the file's name.
pub fn assert_scene_refused(text: &str, message: &str) {
    let folder = scene_folder();
    let error = scene_in(&folder, text).expect_err("the file should be refused");
    assert_eq!(error.to_string(), format!("{}: {message}", folder.path().join("scene.json").display()));
}
