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

/// Layers that other layers name: texts by file name; the first is read.
fn read_layers(layers: &[(&str, &[u8])]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in layers {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let start = Instant::now();
    let read = load(folder.path().join(layers[0].0), &LoadOptions::default());
    assert!(start.elapsed() < Duration::from_secs(2), "{:?}", start.elapsed());
    read.map_err(|error| {
        let error = error.to_string();
        assert!(!error.contains('\n'), "{error}");
        error.replace(folder.path().to_str().unwrap(), "")
    })
}

#[test]
#[ignore]
fn byte_scan() {
    let bytes = std::fs::read(lamp("usdc")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.usdc");
    let step: usize = std::env::var("STEP").map_or(7, |s| s.parse().unwrap());
    let first: usize = std::env::var("FIRST").map_or(0, |s| s.parse().unwrap());
    let mut kinds = std::collections::BTreeMap::<String, usize>::new();
    let begin = Instant::now();
    for at in (first..bytes.len()).step_by(step) {
        for change in 0..5u8 {
            let mut changed = bytes.clone();
            changed[at] = match change { 0 => 0, 1 => 0xff, 2 => changed[at] ^ 0x80, 3 => changed[at].wrapping_add(1), _ => 0x7f };
            std::fs::write(&path, &changed).unwrap();
            eprintln!("AT {at} {change}");
            let start = Instant::now();
            let read = load(&path, &LoadOptions::default());
            let took = start.elapsed();
            if took > Duration::from_millis(100) { println!("SLOW {at} {change} {took:?}"); }
            let text = match read { Ok(_) => "ok".to_owned(), Err(e) => e.to_string() };
            let text = text.split(": ").skip(1).collect::<Vec<_>>().join(": ");
            let text: String = text.chars().filter(|c| !c.is_ascii_digit()).take(90).collect();
            *kinds.entry(text).or_default() += 1;
        }
    }
    println!("bytes {} took {:?}", bytes.len(), begin.elapsed());
    for (kind, count) in kinds { println!("{count:6} {kind}"); }
}
