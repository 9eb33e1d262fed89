//! Films to EXR and back through an independent reader's eyes.

use std::{fs, path::Path};

use exr::prelude::*;
use planish_film::{
    Cryptomatte, ExrOptions, Film, Layer as FilmLayer, Metadata, Samples, Window, write_exr, write_exr_with,
};

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
            ..Metadata::default()
        },
        ..Film::default()
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
                Samples::Half(s) => FlatSamples::F16(s.iter().skip(offset).step_by(stride).copied().collect()),
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

/// With attributes enough that a hash map would hardly give one order twice.
fn film_with_mattes() -> Film {
    let mut film = film();
    film.metadata.extra = (0..9).map(|i| (format!("note {i}"), format!("value {i}"))).collect();
    for name in ["CryptoObject", "CryptoMaterial"] {
        film.cryptomattes.push(Cryptomatte {
            name: name.to_owned(),
            names: vec!["a".to_owned(), "b".to_owned()],
            rank_count: 2,
            ranks: (0..2 * PIXEL_COUNT as u32).map(|i| (i % 2, 0.5)).collect(),
        });
    }
    film
}

#[test]
fn equal_films_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for multipart in [false, true] {
        let bytes = |name: &str| {
            let path = folder.path().join(name);
            let options = ExrOptions { multipart, ..ExrOptions::default() };
            write_exr_with(&film_with_mattes(), &path, &options).unwrap();
            fs::read(path).unwrap()
        };
        let first = bytes("first.exr");
        for _ in 0..20 {
            assert!(first == bytes("again.exr"));
        }
    }
}

#[test]
fn attributes_are_sorted_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    write_exr(&film_with_mattes(), &path).unwrap();
    let bytes = fs::read(path).unwrap();
    // Magic number and version, then name, type, size and value of each.
    let mut rest = &bytes[8..];
    let mut names = Vec::new();
    while rest[0] != 0 {
        let mut word = || {
            let end = rest.iter().position(|&byte| byte == 0).unwrap();
            let word = String::from_utf8(rest[..end].to_vec()).unwrap();
            rest = &rest[end + 1..];
            word
        };
        names.push(word());
        word();
        let size = u32::from_le_bytes(rest[..4].try_into().unwrap()) as usize;
        rest = &rest[4 + size..];
    }
    assert!(names.is_sorted() && names.contains(&"planish/note 3".to_owned()), "{names:?}");
    assert_eq!(names.iter().filter(|name| name.starts_with("cryptomatte/")).count(), 8);
}

#[test]
fn dwaa_is_refused_where_one_part_would_lose_data() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let write = |layers: Vec<FilmLayer>, level: f32, multipart: bool| {
        let options = ExrOptions { compression: planish_film::Compression::Dwaa(level), multipart };
        write_exr_with(&Film { layers, ..film() }, &path, &options).map_err(|error| error.to_string())
    };
    let vectors = |name: &str| vec![FilmLayer::float(name, &["X", "Y", "Z"], floats(3, 0.0))];
    let colors = |name: &str| vec![FilmLayer::half(name, &["R", "G", "B"], &floats(3, 0.0))];
    let lost = |channel: &str| {
        Err(format!(
            "DWAA would lose bits of channel {channel}: layers that are no light need parts of their own (multipart)"
        ))
    };
    assert_eq!(write(vectors("N"), 45.0, false), lost("N.Y"));
    assert_eq!(write(colors("albedo"), 45.0, false), lost("albedo.B"));
    assert_eq!(write(vec![FilmLayer::float("Y", &[], floats(1, 0.0))], 45.0, false), lost("Y"));
    assert_eq!(write(vec![FilmLayer::uint("id.R", uints(1))], 45.0, false), Ok(()));
    assert_eq!(write(vectors("N"), 45.0, true), Ok(()));
    // A layer that would join the colour's part.
    assert_eq!(write(colors("rgba"), 45.0, true), lost("rgba.B"));
    assert_eq!(write(Vec::new(), -1.0, true), Err("DWAA's level is -1; expected a number of at least 0".to_owned()));
    fs::remove_file(path).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn unfit_cryptomattes_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let message = |change: fn(&mut Film)| {
        let mut film = film_with_mattes();
        change(&mut film);
        write_exr(&film, &path).unwrap_err().to_string()
    };
    assert_eq!(
        message(|film| film.cryptomattes[0].ranks[7].0 = 2),
        "Cryptomatte CryptoObject has a rank of name 2, but only 2 names"
    );
    assert_eq!(
        message(|film| film.cryptomattes[0].ranks[7].1 = f32::NAN),
        "Cryptomatte CryptoObject has a coverage of NaN; expected a number of at least 0"
    );
    assert_eq!(
        message(|film| film.cryptomattes[1].ranks.truncate(9)),
        "Cryptomatte CryptoMaterial has 9 ranks; expected 370, 2 a pixel"
    );
    for rank_count in [0, 201] {
        let mut film = film_with_mattes();
        film.cryptomattes[0].rank_count = rank_count;
        let expected = format!("Cryptomatte CryptoObject has {rank_count} ranks a pixel; expected 1 to 200");
        assert_eq!(write_exr(&film, &path).unwrap_err().to_string(), expected);
    }
    assert_eq!(
        message(|film| film.cryptomattes[1] = film.cryptomattes[0].clone()),
        "two channels of the film are named \"CryptoObject00.R\""
    );
    assert!(!path.exists());
}

#[test]
fn windows_beyond_the_format_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    let write = |x: i32, y: i32, full_width: u32, full_height: u32| {
        let window = Some(Window { x, y, full_width, full_height });
        write_exr(&Film { window, ..film() }, &path).map_err(|error| error.to_string())
    };
    let refused = |place: &str, size: &str| {
        Err(format!(
            "a film of 5x37 pixels at {place} in a frame of {size} cannot be written; expected a frame of at least 1x1 \
             and coordinates within 1073741823"
        ))
    };
    assert_eq!(write(0, 0, 0, 9), refused("0,0", "0x9"));
    assert_eq!(write(i32::MAX, 0, 9, 9), refused("2147483647,0", "9x9"));
    assert_eq!(write(0, i32::MIN, 9, 9), refused("0,-2147483648", "9x9"));
    assert_eq!(write(0, 0, 9, u32::MAX), refused("0,0", "9x4294967295"));
    // Beside the frame, too, is a place.
    assert_eq!(write(-100, 100, 9, 9), Ok(()));
}

#[test]
fn attributes_have_names_that_the_format_can_hold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.exr");
    for name in ["a\nb", "größe", &"n".repeat(248)] {
        let mut film = film();
        film.metadata.extra.insert(name.to_owned(), String::new());
        let message = write_exr(&film, &path).unwrap_err().to_string();
        assert!(message.ends_with("has an unfit name; expected at most 255 printable ASCII characters"), "{message}");
        assert!(!message.contains('\n'), "{message:?}");
    }
    let mut film = film();
    film.metadata.extra.insert("n".repeat(247), String::new());
    write_exr(&film, &path).unwrap();
    read_back(&path);
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
