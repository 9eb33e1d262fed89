//! Films to EXR and back through an independent reader's eyes.

use std::{fs, path::Path};

use exr::prelude::*;
use planish_film::{Film, Layer as FilmLayer, Metadata, Samples, write_exr};

const WIDTH: u32 = 5;
/// Two whole blocks of 16 rows and a part of one.
const HEIGHT: u32 = 37;
const PIXEL_COUNT: usize = (WIDTH * HEIGHT) as usize;

type Read = Image<Layer<AnyChannels<FlatSamples>>>;

fn floats(channel_count: usize, seed: f32) -> Vec<f32> {
    (0..PIXEL_COUNT * channel_count).map(|i| seed + i as f32 * 0.37).collect()
}

fn uints(seed: u32) -> Vec<u32> {
    (0..PIXEL_COUNT as u32).map(|i| seed.wrapping_mul(i + 1)).collect()
}

fn film() -> Film {
    let matrix = |seed: f32| std::array::from_fn(|row| std::array::from_fn(|column| seed + (4 * row + column) as f32));
    Film {
        width: WIDTH,
        height: HEIGHT,
        color: (0..PIXEL_COUNT).map(|i| [i as f32 * 0.01, -(i as f32), 1.0 / (i + 1) as f32, 0.5]).collect(),
        layers: vec![
            FilmLayer::float("Z", &[], floats(1, 0.1)),
            FilmLayer::float("N", &["X", "Y", "Z"], floats(3, -9.0)),
            FilmLayer::float("P", &["X", "Y", "Z"], floats(3, 1e6)),
            FilmLayer::float("uv", &["x", "y"], floats(2, 0.0)),
            FilmLayer::float("tess", &[], floats(1, 1.0)),
            FilmLayer::uint("face", uints(0x9e37_79b9)),
            FilmLayer::uint("patch", uints(3)),
            FilmLayer::uint("level", uints(1)),
        ],
        metadata: Metadata {
            world_to_camera: Some(matrix(100.0)),
            world_to_ndc: Some(matrix(200.0)),
            software: "planish 0.1.0".to_owned(),
            frame: -3,
            time: 1.25,
            frames_per_second: Some((30_000, 1001)),
        },
    }
}

fn read_back(path: &Path) -> Read {
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .unwrap()
}

fn write_and_read(film: &Film) -> Read {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    write_exr(film, &path).unwrap();
    read_back(&path)
}

fn channel<'a>(image: &'a Read, name: &str) -> &'a FlatSamples {
    let channels = &image.layer_data.channel_data.list;
    &channels.iter().find(|channel| channel.name.eq(name)).unwrap_or_else(|| panic!("no channel {name}")).sample_data
}

#[test]
fn channels_have_the_documented_names_and_types() {
    let image = write_and_read(&film());
    let mut found: Vec<_> = (image.layer_data.channel_data.list.iter())
        .map(|channel| {
            let kind = match &channel.sample_data {
                FlatSamples::F16(_) => "half",
                FlatSamples::F32(_) => "float",
                FlatSamples::U32(_) => "uint",
            };
            (channel.name.to_string(), kind)
        })
        .collect();
    found.sort();
    let expected = [
        ("A", "half"),
        ("B", "half"),
        ("G", "half"),
        ("N.X", "float"),
        ("N.Y", "float"),
        ("N.Z", "float"),
        ("P.X", "float"),
        ("P.Y", "float"),
        ("P.Z", "float"),
        ("R", "half"),
        ("Z", "float"),
        ("face", "uint"),
        ("level", "uint"),
        ("patch", "uint"),
        ("tess", "float"),
        ("uv.x", "float"),
        ("uv.y", "float"),
    ];
    assert_eq!(found, expected.map(|(name, kind)| (name.to_owned(), kind)));
}

#[test]
fn samples_come_back_bit_for_bit() {
    let film = film();
    let image = write_and_read(&film);
    assert_eq!(image.layer_data.size, Vec2(WIDTH as usize, HEIGHT as usize));
    for (component, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let expected = film.color.iter().map(|pixel| f16::from_f32(pixel[component])).collect();
        assert_eq!(*channel(&image, name), FlatSamples::F16(expected), "{name}");
    }
    for layer in &film.layers {
        let stride = layer.channel_count();
        for (offset, name) in layer.channel_names().iter().enumerate() {
            let expected = match &layer.samples {
                Samples::Float(s) => FlatSamples::F32(s.iter().skip(offset).step_by(stride).copied().collect()),
                Samples::Uint(s) => FlatSamples::U32(s.iter().skip(offset).step_by(stride).copied().collect()),
            };
            assert_eq!(*channel(&image, name), expected, "{name}");
        }
    }
}

#[test]
fn the_first_row_is_the_top_row() {
    let mut film = film();
    film.color = (0..PIXEL_COUNT).map(|i| [(i / WIDTH as usize) as f32; 4]).collect();
    let image = write_and_read(&film);
    let FlatSamples::F16(red) = channel(&image, "R") else { panic!("R is not half") };
    assert_eq!(red[0], f16::from_f32(0.0));
    assert_eq!(red[PIXEL_COUNT - 1], f16::from_f32((HEIGHT - 1) as f32));
    assert_eq!(image.layer_data.attributes.layer_position, Vec2(0, 0));
}

#[test]
fn colours_beyond_half_become_infinite_and_the_rest_is_rounded() {
    let mut film = film();
    film.color[0] = [65_504.0, 65_519.0, 65_520.0, 1e30];
    film.color[1] = [-1e30, f32::INFINITY, 1e-10, 0.1];
    film.color[2] = [f32::NAN, f32::NEG_INFINITY, -0.0, 1.0];
    let image = write_and_read(&film);
    let value = |name: &str, i: usize| {
        let FlatSamples::F16(samples) = channel(&image, name) else { panic!("{name} is not half") };
        samples[i].to_f32()
    };
    let pixel = |i| ["R", "G", "B", "A"].map(|name| value(name, i));
    assert_eq!(pixel(0), [65_504.0, 65_504.0, f32::INFINITY, f32::INFINITY]);
    assert_eq!(pixel(1), [f32::NEG_INFINITY, f32::INFINITY, 0.0, f16::from_f32(0.1).to_f32()]);
    assert!(value("R", 2).is_nan());
    assert_eq!(pixel(2)[1..], [f32::NEG_INFINITY, -0.0, 1.0]);
}

#[test]
fn the_header_has_the_camera_and_the_time() {
    let film = film();
    let image = write_and_read(&film);
    let attributes = &image.layer_data.attributes;
    let rows = |seed: f32| Some(std::array::from_fn(|i| seed + i as f32));
    assert_eq!(attributes.world_to_camera, rows(100.0));
    assert_eq!(attributes.world_to_normalized_device, rows(200.0));
    assert_eq!(attributes.software_name.as_ref().unwrap().to_string(), "planish 0.1.0");
    assert_eq!(attributes.frames_per_second, Some((30_000, 1001)));
    // The reader cannot tell custom attributes of the image from those of its only layer.
    let custom = |name: &str| {
        let name = Text::from(name);
        attributes.other.get(&name).or(image.attributes.other.get(&name)).cloned()
    };
    assert_eq!(custom("frame"), Some(AttributeValue::I32(-3)));
    assert_eq!(custom("time"), Some(AttributeValue::F32(1.25)));
}

#[test]
fn the_file_is_one_zip_part_with_standard_attribute_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    write_exr(&film(), &path).unwrap();
    let header = MetaData::read_from_file(&path, true).unwrap().headers;
    assert_eq!(header.len(), 1);
    assert_eq!(header[0].compression, Compression::ZIP16);
    let bytes = fs::read(&path).unwrap();
    for attribute in
        ["worldToCamera\0m44f\0", "worldToNDC\0m44f\0", "software\0string\0", "frame\0int\0", "time\0float\0"]
    {
        assert!(bytes.windows(attribute.len()).any(|window| window == attribute.as_bytes()), "{attribute:?}");
    }
}

#[test]
fn absent_metadata_is_left_out() {
    let film = Film { width: 1, height: 1, color: vec![[0.0; 4]], ..Film::default() };
    let image = write_and_read(&film);
    let attributes = &image.layer_data.attributes;
    assert_eq!(attributes.world_to_camera, None);
    assert_eq!(attributes.software_name, None);
    assert_eq!(attributes.frames_per_second, None);
}

#[test]
fn equal_films_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |name: &str| {
        let path = folder.path().join(name);
        write_exr(&film(), &path).unwrap();
        fs::read(path).unwrap()
    };
    let first = bytes("first.exr");
    for _ in 0..8 {
        assert_eq!(first, bytes("again.exr"));
    }
}

#[test]
fn unfit_films_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let message = |change: fn(&mut Film)| {
        let mut film = film();
        change(&mut film);
        let message = write_exr(&film, &path).unwrap_err().to_string();
        assert!(!message.contains('\n'), "{message}");
        message
    };
    assert_eq!(message(|film| film.height = 0), "a film of 5x0 pixels cannot be written; expected at least 1x1");
    assert_eq!(message(|film| film.color.truncate(7)), "the film's colour has 7 pixels; expected 185");
    assert_eq!(
        message(|film| film.layers.push(FilmLayer::float("motion", &["x", "y"], vec![0.0; PIXEL_COUNT]))),
        "layer motion has 185 samples; expected 370, 2 a pixel"
    );
    assert_eq!(message(|film| film.layers.push(film.layers[0].clone())), "two channels of the film are named \"Z\"");
    assert_eq!(
        message(|film| film.layers.push(FilmLayer::uint("R", uints(1)))),
        "two channels of the film are named \"R\""
    );
    assert_eq!(
        message(|film| film.layers.push(FilmLayer::uint("a\nb", uints(1)))),
        "layer \"a\\nb\" gives a channel the name \"a\\nb\"; expected 1 to 255 printable ASCII characters"
    );
    assert_eq!(
        message(|film| film.layers.push(FilmLayer::uint("", uints(1)))),
        "layer \"\" gives a channel the name \"\"; expected 1 to 255 printable ASCII characters"
    );
    assert!(!path.exists());
}
