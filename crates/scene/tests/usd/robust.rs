//! Files that are cut, that claim too much, or are no USD at all end in one line; text and binary say the same.
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use planish_scene::{LoadOptions, Scene, load};

use crate::common::{FACES, mesh_with, read};

/// Longest time that a file may take.
const IN_TIME: Duration = Duration::from_secs(2);

/// A scene of ours; `lamp.usdc` is what OpenUSD makes of `lamp.usda`.
fn lamp(extension: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/lamp").with_extension(extension)
}

/// Reads a file, in time; what is wrong is said in one line.
fn read_in_time(path: &Path) -> Option<Scene> {
    let start = Instant::now();
    let read = load(path, &LoadOptions::default());
    assert!(start.elapsed() < IN_TIME, "{} took {:?}", path.display(), start.elapsed());
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

/// Changes bytes of the lamp over its whole length, in turn to one of several values.
fn changes(extension: &str, step: usize) {
    let bytes = std::fs::read(lamp(extension)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed").with_extension(extension);
    for at in (0..bytes.len()).step_by(step) {
        for byte in [0, 0xFF, 0x7F, bytes[at] ^ 0x80, bytes[at].wrapping_add(1)] {
            let mut changed = bytes.clone();
            changed[at] = byte;
            std::fs::write(&path, &changed).unwrap();
            read_in_time(&path);
        }
    }
}

#[test]
fn binaries_with_any_byte_replaced_are_read_or_refused() {
    changes("usdc", 23);
}

#[test]
fn text_with_any_byte_replaced_is_read_or_refused() {
    changes("usda", 181);
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
pub fn read_layers(layers: &[(&str, &[u8])]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in layers {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let start = Instant::now();
    let read = load(folder.path().join(layers[0].0), &LoadOptions::default());
    assert!(start.elapsed() < IN_TIME, "{:?}", start.elapsed());
    read.map_err(|error| {
        let error = error.to_string();
        assert!(!error.contains('\n'), "{error}");
        error.replace(folder.path().to_str().unwrap(), "")
    })
}

const ROOT: &[u8] = b"#usda 1.0\ndef \"x\" (references = @./other.usda@</a>) {}\n";

#[test]
fn layers_that_are_named_are_checked_as_the_first_is() {
    let huge = [b"#usda 1.0\n".as_slice(), "def \"a\" {".repeat(100_000).as_bytes()].concat();
    for (content, expected) in [
        (&huge[..], "/other.usda: line 2: found brackets nested deeper than 400, expected fewer"),
        (b"v 0 0 0\n", "/other.usda"),
        (
            b"\xFF\xFF",
            "/other.usda: found bytes that are no text, the first at 0, expected a layer of USD: text, binary or a package",
        ),
        (
            b"PXR-USDC\0\x09",
            "/other.usda: header: found 8 bytes from byte 16 on, expected bytes within the 10 of the file",
        ),
    ] {
        let error = read_layers(&[("root.usda", ROOT), ("other.usda", content)]).unwrap_err();
        assert!(error.contains(expected), "{error}");
        let root = b"#usda 1.0\n(subLayers = [@./other.usda@])\n";
        assert!(read_layers(&[("root.usda", root), ("other.usda", content)]).unwrap_err().contains(expected));
        let root = b"#usda 1.0\ndef \"x\" (payload = @./other.usda@</a>) {}\n";
        assert!(read_layers(&[("root.usda", root), ("other.usda", content)]).unwrap_err().contains(expected));
    }
}

#[test]
fn a_layer_of_gigabytes_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("root.usda"), ROOT).unwrap();
    let file = std::fs::File::create(folder.path().join("other.usda")).unwrap();
    if file.set_len(3 << 30).is_err() {
        return;
    }
    let error = load(folder.path().join("root.usda"), &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with("other.usda: found 3221225472 bytes, expected a layer of at most 2147483648"), "{error}");
}

#[test]
fn text_nests_only_outside_of_strings_comments_and_paths() {
    let deep = "[".repeat(500);
    for (open, close) in [
        ("string s = \"", "\""),
        ("string s = 'it\\'s ", "'"),
        ("string s = \"\"\"one \" two \"\" ", "\"\"\""),
        ("string s = \'\'\'it's ", "\'\'\'"),
        ("asset s = @", "@"),
        ("asset s = @@@a@b", "@@@"),
        ("# \"", "\n"),
        ("/* \" * @ */ /*", "*/"),
    ] {
        let quoted = mesh_with(&format!("{open}{deep}{close}\n"));
        assert!(read(&quoted).is_ok(), "{open}");
        // What follows counts again.
        let after = mesh_with(&format!("{open}{close}\n string[] t = {deep}\n"));
        let error = read(&after).unwrap_err().to_string();
        assert!(error.contains("brackets nested deeper than 400"), "{open}: {error}");
    }
    for path in [format!("rel r = <{}>", "/a".repeat(100_000)), format!("def \"{}\" {{}}", "a/".repeat(100_000))] {
        let error = read(&mesh_with(&path)).unwrap_err().to_string();
        assert!(error.contains("a path of 100000 names, expected at most 400"), "{error}");
    }
}

/// A package of stored entries; every size that it says of them is so many times too large.
pub fn package(entries: &[(&str, &[u8])], lie: u32) -> Vec<u8> {
    let mut zip = Vec::new();
    let mut directory = Vec::new();
    for (name, content) in entries {
        let place = zip.len() as u32;
        let size = (content.len() as u32).wrapping_mul(lie).to_le_bytes();
        let name_length = (name.len() as u16).to_le_bytes();
        let common = [&[0; 8][..], &crc(content).to_le_bytes(), &size, &size, &name_length, &[0; 2]].concat();
        zip.extend([b"PK\x03\x04", &[20, 0][..], &common, name.as_bytes(), content].concat());
        let rest = [&[0; 10][..], &place.to_le_bytes(), name.as_bytes()].concat();
        directory.extend([b"PK\x01\x02", &[20, 0, 20, 0][..], &common, &rest].concat());
    }
    let (place, count) = (zip.len() as u32, (entries.len() as u16).to_le_bytes());
    let size = directory.len() as u32;
    zip.extend(directory);
    zip.extend(
        [b"PK\x05\x06", &[0; 4][..], &count, &count, &size.to_le_bytes(), &place.to_le_bytes(), &[0; 2]].concat(),
    );
    zip
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

#[test]
fn packages_are_read_and_their_layers_checked() {
    let lamp = std::fs::read(lamp("usdc")).unwrap();
    let text = format!("#usda 1.0\n{}", mesh_with(""));
    for (name, content) in [("lamp.usdc", &lamp[..]), ("text.usda", text.as_bytes())] {
        let zip = package(&[(name, content)], 1);
        read_layers(&[("a.usdz", &zip)]).unwrap();
        for lie in [2, 0x10_0001] {
            read_layers(&[("a.usdz", &package(&[(name, content)], lie))]).unwrap_err();
        }
        for at in (0..zip.len()).step_by(zip.len() / 100) {
            for byte in [0, 0xFF, zip[at] ^ 0x80] {
                let mut zip = zip.clone();
                zip[at] = byte;
                let _ = read_layers(&[("a.usdz", &zip)]);
            }
        }
        for at in zip.len() - 70..zip.len() {
            let mut zip = zip.clone();
            zip[at] ^= 0xFF;
            let _ = read_layers(&[("a.usdz", &zip)]);
        }
    }
    let deep = format!("#usda 1.0\n{}", "def \"a\" {".repeat(100_000));
    let root = b"#usda 1.0\ndef \"x\" (references = @other.usda@</a>) {}\n";
    let zip = package(&[("root.usda", root), ("other.usda", deep.as_bytes())], 1);
    let error = read_layers(&[("a.usdz", &zip)]).unwrap_err();
    assert_eq!(error, "/a.usdz[other.usda]: line 2: found brackets nested deeper than 400, expected fewer");
}

#[test]
fn tuples_have_as_many_elements_as_their_type() {
    let read = |property: &str| read(&mesh_with(&format!("{property}\n"))).map_err(|error| error.to_string());
    for (property, found, size) in [
        ("float3 a = (1, 2)", 2, 3),
        ("uniform float3[] a = [(1, 2, 3), (1, 2, 3, 4)]", 4, 3),
        ("texCoord2f[] a = [(1 2)(3)]", 1, 2),
        ("quatf a = (1, 0, 0)", 3, 4),
        ("color3h a = (1, 2)", 2, 3),
        ("point3d[] a = [(1, 2, 3), (1, 2)]", 2, 3),
        ("matrix4d a = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1), (0, 0, 0, 1))", 3, 4),
        ("double3 a.timeSamples = { 0: (1, 2, 3), 1: (1, 2) }", 2, 3),
        ("bool a = true\nfloat3 scale = (1)", 1, 3),
        ("float[] a = [nan, inf]\nhalf4[] float2 = [(nan inf), ()]", 2, 4),
        ("float a = 1 ( customData = { int2 b = (1, 2, 3) } )", 3, 2),
        ("double a.spline = { bezier, 1: 2; pre (1) }", 1, 2),
        ("double a.spline = { bezier, loop: (1, 2, 3) }", 3, 5),
    ] {
        let error = read(property).unwrap_err();
        assert!(error.contains(&format!("a tuple of {found}, expected {size} elements")), "{property}: {error}");
    }
    for property in [
        "float3 float2 = (1, 2, 3) ( doc = \"it\" )",
        "float3[] a = [(1 2 3)(4 5 6),]\nfloat2 b = (nan, inf)",
        "point3f[] a = [] ( interpolation = \"vertex\" )\nint2 b = (1, 2)",
        "matrix2d[] a = [((1, 0), (0, 1))]",
        "double a.spline = { bezier, pre: linear (1), 1: 2; pre (1, 2); post curve (3, 4) }",
    ] {
        read(property).unwrap_or_else(|error| panic!("{property}: {error}"));
    }
}
