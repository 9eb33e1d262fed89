//! What the USD reader's tests share: small stages of text.
use planish_scene::{Error, LoadOptions, Scene, load};

/// A quad and a triangle on it; vertices 0 to 4.
pub const FACES: &str = "\
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.1, 0)]
";

/// Reads a stage of this text.
pub fn read(text: &str) -> Result<Scene, Error> {
    read_with(text, &LoadOptions::default())
}

pub fn read_with(text: &str, options: &LoadOptions) -> Result<Scene, Error> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("name.usda");
    std::fs::write(&path, format!("#usda 1.0\n{text}")).unwrap();
    load(path, options)
}

/// A stage with one mesh, `/World/Mesh`, of two faces and these lines.
pub fn mesh_with(lines: &str) -> String {
    format!("def Xform \"World\" {{\n    def Mesh \"Mesh\" {{\n{FACES}{lines}\n    }}\n}}\n")
}

/// The scene of one mesh with these lines, which must not cause a warning.
pub fn scene_of(lines: &str) -> Scene {
    let scene = read(&mesh_with(lines)).unwrap();
    assert_eq!(scene.warnings, []);
    scene
}

/// Asserts that a stage is refused with exactly this message after the file's name.
pub fn assert_refused(text: &str, message: &str) {
    let error = read(text).expect_err("the stage should be refused").to_string();
    assert!(!error.contains('\n'), "{error}");
    let after = error.split_once("name.usda: ").expect("the file's name").1;
    assert_eq!(after, message);
}
