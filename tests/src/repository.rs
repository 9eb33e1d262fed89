//! Where scenes, models and programs are.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// The repository's root folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the tests lie in a folder of the repository").to_owned()
}

/// A mesh of `scenes/` by its file's stem.
pub fn scene(name: &str) -> PathBuf {
    let path = root().join("scenes").join(format!("{name}.obj"));
    assert!(path.is_file(), "{} is missing", path.display());
    path
}

/// All meshes of `scenes/`, the largest file first, so that the longest check does not start last.
pub fn scenes() -> Vec<PathBuf> {
    meshes_in(&root().join("scenes"))
}

/// A mesh of `scenes/schemes/` by its file's stem: triangles, and triangles and quads, for other schemes than Catmull and Clark's.
/// The oracle takes those for Loop's that are called so.
pub fn scheme_scene(name: &str) -> PathBuf {
    let path = root().join("scenes/schemes").join(format!("{name}.obj"));
    assert!(path.is_file(), "{} is missing", path.display());
    path
}

/// The models that lie beside the repository; none, with a word about it, where it stands alone.
pub fn models() -> Vec<PathBuf> {
    let folder = root().join("../shared/models");
    if folder.is_dir() {
        return meshes_in(&folder);
    }
    eprintln!("skipped: there is no folder {} with models", folder.display());
    Vec::new()
}

/// One of [`models`] by its file's stem, where they are.
pub fn model(name: &str) -> Option<PathBuf> {
    models().into_iter().find(|path| stem(path) == name)
}

/// Beginnings of the names of scenes that are about rules. Rules do not change how patches are tessellated: where that is
/// what is tested, one factor is enough for them.
const RULES: [&str; 13] = [
    "boundary_",
    "chaikin_",
    "color_",
    "corner_",
    "crease_",
    "cube_all_",
    "dart_",
    "edit_",
    "hole_",
    "nonmanifold_",
    "smooth_triangles",
    "triangles_",
    "uv_",
];

/// Whether a scene is about rules and not about shapes.
pub fn is_about_rules(mesh: &Path) -> bool {
    RULES.iter().any(|rule| stem(mesh).starts_with(rule))
}

/// Whether a scene has hierarchical edits, which OpenSubdiv does not know.
pub fn is_edited(mesh: &Path) -> bool {
    stem(mesh).starts_with("edit_")
}

/// A file's name without its extension.
pub fn stem(path: &Path) -> &str {
    path.file_stem().and_then(OsStr::to_str).expect("mesh files have plain names")
}

fn meshes_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let paths = entries.map(|entry| entry.expect("the folder can be listed").path());
    let mut meshes: Vec<PathBuf> = paths.filter(|path| path.extension() == Some(OsStr::new("obj"))).collect();
    assert!(!meshes.is_empty(), "{} has no meshes", folder.display());
    let size = |path: &PathBuf| fs::metadata(path).map_or(0, |metadata| metadata.len());
    meshes.sort_by_key(|path| (std::cmp::Reverse(size(path)), path.clone()));
    meshes
}

/// The `planish` program: `PLANISH_PROGRAM`, or the one that cargo built beside the tests.
pub fn planish() -> PathBuf {
    if let Some(path) = env::var_os("PLANISH_PROGRAM") {
        return path.into();
    }
    let test = env::current_exe().expect("a test knows where it lies");
    let profile = test.ancestors().nth(2).expect("tests lie in the deps folder of a profile's");
    let program = profile.join(format!("planish{}", env::consts::EXE_SUFFIX));
    assert!(program.is_file(), "{} is missing: build it with cargo build --release -p planish", program.display());
    program
}

/// One of the C++ programs of `tools/`: in `PLANISH_ORACLE_DIR`, or where `make -C tools` puts it.
pub fn tool(name: &str) -> PathBuf {
    let folder = env::var_os("PLANISH_ORACLE_DIR").map_or_else(|| root().join("tools/build"), PathBuf::from);
    let program = folder.join(name);
    assert!(program.is_file(), "{} is missing: build it with make -C tools", program.display());
    program
}
