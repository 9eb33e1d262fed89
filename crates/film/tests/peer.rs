//! EXR files as OpenEXR's own library reads them, by `tools/exr`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use half::f16;
use planish_film::{
    Compression, Cryptomatte, DEFAULT_RANK_COUNT, ExrOptions, Film, Layer, Metadata, Samples, Window, write_exr_with,
};
use serde_json::{Value, json};
use tempfile::TempDir;

const WIDTH: u32 = 21;
/// Two whole blocks of 32 rows and a part of one.
const HEIGHT: u32 = 70;
const PIXEL_COUNT: usize = (WIDTH * HEIGHT) as usize;

/// `exr_dump` in `PLANISH_ORACLE_DIR`, or where `make -C tools` puts it.
fn exr_dump() -> Command {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the crate lies in the repository");
    let folder = env::var_os("PLANISH_ORACLE_DIR").map_or_else(|| root.join("tools/build"), PathBuf::from);
    let program = folder.join("exr_dump");
    assert!(program.is_file(), "{} is missing: build it with make -C tools", program.display());
    Command::new(program)
}

/// A film that was written, and what OpenEXR says about the file.
struct Read {
    folder: TempDir,
    dump: Value,
}

impl Read {
    fn new(film: &Film, compression: Compression, multipart: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.exr");
        write_exr_with(film, &path, &ExrOptions { compression, multipart }).unwrap();
        let output = exr_dump().arg(path).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Self { folder, dump: serde_json::from_slice(&output.stdout).unwrap() }
    }

    fn part_count(&self) -> usize {
        self.dump["parts"].as_array().unwrap().len()
    }

    fn attribute(&self, part: usize, name: &str) -> &Value {
        &self.dump["parts"][part]["attributes"][name]
    }

    fn channels(&self, part: usize) -> BTreeMap<String, String> {
        serde_json::from_value(self.dump["parts"][part]["channels"].clone()).unwrap()
    }

    /// The only part that has a channel.
    fn part_of(&self, channel: &str) -> usize {
        let parts: Vec<_> = (0..self.part_count()).filter(|&part| self.channels(part).contains_key(channel)).collect();
        assert_eq!(parts.len(), 1, "{channel}");
        parts[0]
    }

    fn bytes(&self, channel: &str) -> Vec<u8> {
        let (film, out) = (self.folder.path().join("film.exr"), self.folder.path().join("samples"));
        let part = self.part_of(channel).to_string();
        let output =
            exr_dump().arg(film).args(["--part", &part, "--channel", channel, "-o"]).arg(&out).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(out).unwrap()
    }

    fn halves(&self, channel: &str) -> Vec<f32> {
        let halves = self.bytes(channel);
        halves.as_chunks().0.iter().map(|&bytes| f16::from_le_bytes(bytes).to_f32()).collect()
    }

    fn words(&self, channel: &str) -> Vec<u32> {
        self.bytes(channel).as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect()
    }
}

/// Bits without pattern.
fn noise(i: usize, seed: u32) -> u32 {
    let mut bits = (i as u32 ^ seed.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0x9e37_79b9);
    bits ^= bits >> 15;
    bits.wrapping_mul(0x2c1b_3c6d)
}

fn floats(channel_count: usize, seed: u32) -> Vec<f32> {
    (0..PIXEL_COUNT * channel_count).map(|i| (noise(i, seed) >> 8) as f32 / 65_536.0 - 128.0).collect()
}

fn uints(seed: u32) -> Vec<u32> {
    (0..PIXEL_COUNT).map(|i| noise(i, seed)).collect()
}

/// Names beyond ASCII and JSON's plain characters, and more than a pixel has ranks.
fn names() -> Vec<String> {
    let mut names: Vec<String> = ["bunny", "default", "/world/\"quoted\"\\path", "größe"].map(str::to_owned).into();
    names.extend((0..40).map(|i| format!("/terrain/rock[{i},0,0]")));
    names
}

fn matte(name: &str, seed: u32) -> Cryptomatte {
    let names = names();
    let ranks = (0..PIXEL_COUNT * DEFAULT_RANK_COUNT).map(|i| {
        // Names of one pixel differ; some entries are empty.
        let index = (noise(i / DEFAULT_RANK_COUNT, seed) as usize + 7 * i) % (names.len() + 8);
        let index = if index < names.len() { index as u32 } else { Cryptomatte::NONE };
        (index, (noise(i, seed + 1) % 9) as f32 / 64.0)
    });
    Cryptomatte { name: name.to_owned(), rank_count: DEFAULT_RANK_COUNT, ranks: ranks.collect(), names }
}

fn film() -> Film {
    let smooth = |i: usize, rate: f32| 0.5 + 0.4 * (i as f32 * rate).sin();
    let albedo = floats(3, 12);
    Film {
        width: WIDTH,
        height: HEIGHT,
        window: Some(Window { x: 11, y: -3, full_width: 64, full_height: 48 }),
        color: (0..PIXEL_COUNT)
            .map(|i| [smooth(i, 0.1), smooth(i, 0.03), smooth(i, 0.07), (i % 3) as f32 / 2.0])
            .collect(),
        layers: vec![
            Layer::float("Z", &[], floats(1, 1)),
            Layer::float("N", &["X", "Y", "Z"], floats(3, 2)),
            Layer::float("uv", &["x", "y"], floats(2, 3)),
            Layer::float("motion", &["x", "y"], floats(2, 4)),
            Layer::uint("face", uints(5)),
            Layer::float("color", &["R", "G", "B"], floats(3, 6)),
            Layer::half("albedo", &["R", "G", "B"], &albedo),
        ],
        cryptomattes: vec![matte("CryptoObject", 7), matte("CryptoMaterial", 8)],
        metadata: metadata(),
    }
}

fn metadata() -> Metadata {
    let matrix = |seed: f32| std::array::from_fn(|row| std::array::from_fn(|column| seed + (4 * row + column) as f32));
    Metadata {
        world_to_camera: Some(matrix(100.0)),
        world_to_ndc: Some(matrix(200.0)),
        software: "planish 0.1.0".to_owned(),
        frame: -3,
        time: 1.25,
        frames_per_second: Some((30_000, 1001)),
        shutter_seconds: Some(0.125),
        aperture: Some(2.75),
        focus: Some(3.5),
        screen_window_width: Some(1.5),
        extra: [("scene".to_owned(), "a \"b\".json".to_owned()), ("samples".to_owned(), "16".to_owned())].into(),
    }
}

/// All data of a film that a file holds bit for bit.
fn assert_layers_are_kept(film: &Film, read: &Read) {
    for layer in &film.layers {
        let stride = layer.channel_count();
        for (offset, name) in layer.channel_names().iter().enumerate() {
            let expected: Vec<u8> = match &layer.samples {
                Samples::Half(s) => s.iter().skip(offset).step_by(stride).flat_map(|s| s.to_le_bytes()).collect(),
                Samples::Float(s) => s.iter().skip(offset).step_by(stride).flat_map(|s| s.to_le_bytes()).collect(),
                Samples::Uint(s) => s.iter().skip(offset).step_by(stride).flat_map(|s| s.to_le_bytes()).collect(),
            };
            assert!(read.bytes(name) == expected, "{name}");
        }
    }
}

#[test]
fn every_lossless_compression_keeps_every_bit() {
    let film = film();
    for compression in [Compression::Zip, Compression::Zips, Compression::Piz, Compression::Rle, Compression::None] {
        for multipart in [false, true] {
            let read = Read::new(&film, compression, multipart);
            assert_layers_are_kept(&film, &read);
            for (component, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
                let expected: Vec<f32> =
                    film.color.iter().map(|pixel| f16::from_f32(pixel[component]).to_f32()).collect();
                assert_eq!(read.halves(name), expected, "{compression:?} {name}");
            }
        }
    }
}

#[test]
fn a_single_part_has_all_channels_with_their_types() {
    let read = Read::new(&film(), Compression::Zip, false);
    assert_eq!(read.part_count(), 1);
    let mut expected: BTreeMap<String, String> = BTreeMap::new();
    let mut expect = |names: &str, kind: &str| {
        expected.extend(names.split(' ').map(|name| (name.to_owned(), kind.to_owned())));
    };
    expect("R G B A albedo.R albedo.G albedo.B", "half");
    expect("Z N.X N.Y N.Z uv.x uv.y motion.x motion.y color.R color.G color.B", "float");
    expect("face", "uint");
    for name in ["CryptoObject", "CryptoMaterial"] {
        for layer in ["00", "01", "02"] {
            expect(&["R", "G", "B", "A"].map(|channel| format!("{name}{layer}.{channel}")).join(" "), "float");
        }
    }
    assert_eq!(read.channels(0), expected);
}

#[test]
fn the_header_tells_the_camera_the_time_and_the_windows() {
    for multipart in [false, true] {
        let read = Read::new(&film(), Compression::Zips, multipart);
        let matrix = |seed: u32| (seed..seed + 16).collect::<Vec<_>>();
        for part in 0..read.part_count() {
            let is = |name: &str, kind: &str, value: Value| {
                let expected = json!({"type": kind, "value": value});
                assert_eq!(read.attribute(part, name), &expected, "{name}");
            };
            is("worldToCamera", "m44f", json!(matrix(100)));
            is("worldToNDC", "m44f", json!(matrix(200)));
            is("software", "string", json!("planish 0.1.0"));
            is("frame", "int", json!([-3]));
            is("time", "float", json!([1.25]));
            is("framesPerSecond", "rational", json!([30_000, 1001]));
            is("expTime", "float", json!([0.125]));
            is("aperture", "float", json!([2.75]));
            is("focus", "float", json!([3.5]));
            is("planish/scene", "string", json!("a \"b\".json"));
            is("planish/samples", "string", json!("16"));
            is("dataWindow", "box2i", json!([11, -3, 31, 66]));
            is("displayWindow", "box2i", json!([0, 0, 63, 47]));
            is("pixelAspectRatio", "float", json!([1]));
            is("screenWindowWidth", "float", json!([1.5]));
            is("screenWindowCenter", "v2f", json!([0, 0]));
            let primaries = read.attribute(part, "chromaticities");
            assert_eq!(primaries["type"], "chromaticities");
            let found: Vec<f64> = serde_json::from_value(primaries["value"].clone()).unwrap();
            let rec_709 = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];
            assert!(found.iter().zip(rec_709).all(|(found, expected)| (found - expected).abs() < 1e-7), "{found:?}");
        }
    }
}

#[test]
fn a_whole_frame_has_one_window_and_no_more_attributes_than_it_has_values() {
    let film = Film { width: 3, height: 2, color: vec![[0.5; 4]; 6], ..Film::default() };
    let read = Read::new(&film, Compression::Zip, false);
    assert_eq!(read.attribute(0, "dataWindow")["value"], json!([0, 0, 2, 1]));
    assert_eq!(read.attribute(0, "displayWindow")["value"], json!([0, 0, 2, 1]));
    assert_eq!(read.attribute(0, "screenWindowWidth")["value"], json!([1]));
    for name in ["worldToCamera", "software", "framesPerSecond", "expTime", "aperture", "focus", "name", "capDate"] {
        assert!(read.attribute(0, name).is_null(), "{name}");
    }
}

#[test]
fn layers_are_parts_of_their_own_on_request() {
    let read = Read::new(&film(), Compression::Zip, true);
    let name = |part| read.attribute(part, "name")["value"].as_str().unwrap().to_owned();
    let names: Vec<_> = (0..read.part_count()).map(name).collect();
    let expected = ["rgba", "depth", "N", "uv", "motion", "face", "color", "albedo", "CryptoObject", "CryptoMaterial"];
    assert_eq!(names, expected);
    assert_eq!(read.channels(0).len(), 4);
    assert_eq!(read.channels(1).into_keys().collect::<Vec<_>>(), ["Z"]);
    assert_eq!(read.channels(2).into_keys().collect::<Vec<_>>(), ["N.X", "N.Y", "N.Z"]);
    assert_eq!(read.channels(8).len(), 12);
}

/// Numbers of `Imf::Compression`.
const ZIP: u32 = 3;
const DWAA: u32 = 8;

#[test]
fn dwaa_is_the_colour_s_alone_in_a_file_of_parts() {
    let film = film();
    let read = Read::new(&film, Compression::Dwaa(45.0), true);
    for part in 0..read.part_count() {
        let expected = if part == 0 { DWAA } else { ZIP };
        assert_eq!(read.attribute(part, "compression")["value"], json!([expected]), "{part}");
    }
    assert_eq!(read.attribute(0, "dwaCompressionLevel")["value"], json!([45]));
    assert_layers_are_kept(&film, &read);
    assert_mattes_are_kept(&film, &read);
    let mut largest = 0.0_f32;
    for (component, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        for (found, pixel) in read.halves(name).iter().zip(&film.color) {
            let error = (found - pixel[component]).abs();
            assert!(error < 0.05 && (component < 3 || error == 0.0), "{name} {found} for {}", pixel[component]);
            largest = largest.max(error);
        }
    }
    assert!(largest > 0.0005, "nothing was lost: {largest}");
}

#[test]
fn dwaa_keeps_every_bit_of_what_it_does_not_take_for_light() {
    let mut film = film();
    film.layers.retain(|layer| ["Z", "uv", "motion", "face"].contains(&layer.name.as_str()));
    film.cryptomattes.clear();
    let read = Read::new(&film, Compression::Dwaa(200.0), false);
    assert_eq!(read.attribute(0, "compression")["value"], json!([DWAA]));
    assert_layers_are_kept(&film, &read);
}

/// What a compositor finds in a pixel: names and coverages, the largest first.
type Decoded = Vec<(String, f32)>;

fn decode(read: &Read, matte: &Cryptomatte) -> Vec<Decoded> {
    let part = read.part_of(&format!("{}00.R", matte.name));
    let attributes = read.dump["parts"][part]["attributes"].as_object().unwrap();
    // The key is found by the name, as compositors do.
    let is_name = |(attribute, value): &(&String, &Value)| {
        attribute.starts_with("cryptomatte/") && attribute.ends_with("/name") && value["value"] == matte.name.as_str()
    };
    let key = attributes.iter().find(is_name).unwrap().0.strip_suffix("name").unwrap();
    assert_eq!(key.len(), "cryptomatte/0123456/".len());
    let text = |field: &str| attributes[&format!("{key}{field}")]["value"].as_str().unwrap().to_owned();
    assert_eq!((text("hash"), text("conversion")), ("MurmurHash3_32".to_owned(), "uint32_to_float32".to_owned()));
    let manifest: BTreeMap<String, String> = serde_json::from_str(&text("manifest")).unwrap();
    assert_eq!(manifest.len(), matte.names.len());
    let names: BTreeMap<u32, &String> =
        manifest.iter().map(|(name, id)| (u32::from_str_radix(id, 16).unwrap(), name)).collect();

    let mut pixels = vec![Decoded::new(); PIXEL_COUNT];
    for layer in 0..3 {
        for [id, coverage] in [["R", "G"], ["B", "A"]] {
            let words = |channel: &str| read.words(&format!("{}{layer:02}.{channel}", matte.name));
            for ((pixel, id), coverage) in pixels.iter_mut().zip(words(id)).zip(words(coverage)) {
                let coverage = f32::from_bits(coverage);
                if coverage > 0.0 {
                    pixel.push((names[&id].clone(), coverage));
                } else {
                    assert_eq!((id, coverage), (0, 0.0));
                }
            }
        }
    }
    pixels
}

fn assert_mattes_are_kept(film: &Film, read: &Read) {
    for matte in &film.cryptomattes {
        for (decoded, ranks) in decode(read, matte).iter().zip(matte.ranks.chunks(matte.rank_count)) {
            assert!(decoded.is_sorted_by(|a, b| a.1 >= b.1), "{decoded:?}");
            let mut decoded: BTreeMap<_, _> = decoded.iter().cloned().collect();
            for &(index, coverage) in ranks.iter().filter(|&&(index, share)| index != Cryptomatte::NONE && share > 0.0)
            {
                let found = decoded.remove(&matte.names[index as usize]);
                assert_eq!(found, Some(coverage));
            }
            assert!(decoded.is_empty(), "{decoded:?}");
        }
    }
}

#[test]
fn cryptomattes_are_decoded_by_their_manifest() {
    for multipart in [false, true] {
        let film = film();
        let read = Read::new(&film, Compression::Zip, multipart);
        assert_mattes_are_kept(&film, &read);
        for part in 0..read.part_count() {
            let attributes = read.dump["parts"][part]["attributes"].as_object().unwrap();
            let count = attributes.keys().filter(|name| name.starts_with("cryptomatte/")).count();
            let expected = if !multipart {
                8
            } else if part < 8 {
                0
            } else {
                4
            };
            assert_eq!(count, expected, "part {part}");
        }
    }
}
