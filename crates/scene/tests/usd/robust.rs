//! Files that are cut, that claim too much, or are no USD at all end in one line; text and binary say the same.
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use planish_scene::{LoadOptions, Scene, load};

use crate::common::{FACES, read};

/// A scene of ours; `lamp.usdc` is what OpenUSD makes of `lamp.usda`.
fn lamp(extension: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/lamp").with_extension(extension)
}

/// Reads a file, in two seconds at most; what is wrong is said in one line.
fn read_in_time(path: &Path) -> Option<Scene> {
    let start = Instant::now();
    let read = load(path, &LoadOptions::default());
    assert!(start.elapsed() < Duration::from_secs(2), "{} took {:?}", path.display(), start.elapsed());
    read.map_err(|error| assert!(!error.to_string().contains('\n'), "{error}")).ok()
}

fn truncations(bytes: &[u8], name: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    for length in (0..bytes.len()).step_by(64) {
        std::fs::write(&path, &bytes[..length]).unwrap();
        read_in_time(&path);
    }
}

#[test]
fn the_lamp_is_the_same_as_text_and_as_binary() {
    let read = |extension| load(lamp(extension), &LoadOptions::default()).unwrap();
    let (text, binary) = (read("usda"), read("usdc"));
    assert_eq!(text.warnings, []);
    assert_eq!((text.meshes.len(), text.instances.len(), text.lights.len()), (5, 6, 2));
    assert_eq!(text.time_range, Some([1.0 / 24.0, 1.0]));
    assert!(text.meshes.iter().filter(|mesh| mesh.deformation.is_some()).count() == 2 && text.is_animated());
    assert_eq!(text.images[0].name, "lamp.png");
    assert_eq!(text, binary);
}

#[test]
fn truncated_text_never_panics() {
    truncations(&std::fs::read(lamp("usda")).unwrap(), "cut.usda");
}

#[test]
fn truncated_binaries_never_panic() {
    truncations(&std::fs::read(lamp("usdc")).unwrap(), "cut.usdc");
}

#[test]
fn what_is_no_usd_is_refused_in_a_line() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["usd", "usda", "usdc", "usdz"] {
        let path = folder.path().join(format!("no.{extension}"));
        for content in [&b""[..], b"PXR-USDC", b"PK\x03\x04", b"v 0 0 0\n", &[0xFF; 100]] {
            std::fs::write(&path, content).unwrap();
            assert!(read_in_time(&path).is_none(), "{extension}");
        }
    }
}

#[test]
fn huge_claims_are_refused() {
    let mesh = format!("def Mesh \"m\" {{\n{}}}", FACES.replace("[4, 3]", "[2147483647, 2147483647]"));
    assert!(read(&mesh).unwrap_err().to_string().contains("expected the 4294967294 of faceVertexCounts"));
    let deep = format!("{}{}", "def \"a\" {\n".repeat(300), "}\n".repeat(300));
    assert!(read(&deep).unwrap_err().to_string().contains("256 deep"));
}
