//! Files that are no displacement maps: one line each, no panic, and nothing allocated for what a header merely claims.
use std::path::Path;

use crate::common::{QUAD, halves, load, mesh, refusal, request, tempdir, write_exr, write_png, write_scalar};
use exr::prelude::{Encoding, FlatSamples};
use image::ExtendedColorType;
use planish_scene::displacement::{DisplacementKind, DisplacementRequest};
use tiff::encoder::{TiffEncoder, colortype};

/// Three intact files of noise, of the same size.
fn intact(folder: &Path) -> Vec<std::path::PathBuf> {
    let noise: Vec<f32> = (0..64 * 48).map(|i| ((i * 7919) % 1009) as f32 / 1009.0).collect();
    let bytes: Vec<u8> = noise.iter().map(|value| (value * 255.0) as u8).collect();
    let names = ["zip.exr", "rle.exr", "plain.exr", "a.png", "a.tif", "lzw.tiff"];
    let paths: Vec<_> = names.iter().map(|name| folder.join(name)).collect();
    let encodings = [Encoding::SMALL_LOSSLESS, Encoding::FAST_LOSSLESS, Encoding::UNCOMPRESSED];
    for (path, encoding) in paths.iter().zip(encodings) {
        write_exr(path, (64, 48), encoding, vec![("Y", FlatSamples::F32(noise.clone()))]);
    }
    write_png(&paths[3], (64, 48), &bytes, ExtendedColorType::L8);
    let encoder = |path| TiffEncoder::new(std::fs::File::create(path).unwrap()).unwrap();
    encoder(&paths[4]).write_image::<colortype::Gray32Float>(64, 48, &noise).unwrap();
    let mut lzw = encoder(&paths[5]).with_compression(tiff::encoder::Compression::Lzw);
    lzw.write_image::<colortype::Gray8>(64, 48, &bytes).unwrap();
    paths
}

fn refused(path: &Path) -> String {
    refusal(&DisplacementRequest::new(path), &mesh(QUAD))
}

#[test]
fn files_cut_short_anywhere_are_refused() {
    let folder = tempdir().unwrap();
    for path in intact(folder.path()) {
        assert!(load(&DisplacementRequest::new(&path)).is_ok(), "{path:?}");
        let bytes = std::fs::read(&path).unwrap();
        for sixteenth in 0..16 {
            std::fs::write(&path, &bytes[..bytes.len() * sixteenth / 16]).unwrap();
            refused(&path);
        }
    }
}

#[test]
fn files_with_bytes_exchanged_are_read_or_refused_without_a_panic() {
    let folder = tempdir().unwrap();
    let panicked = "content that the decoder cannot cope with";
    for path in intact(folder.path()) {
        let bytes = std::fs::read(&path).unwrap();
        let mut state = 1_u64;
        for at in (0..bytes.len().min(600)).chain((600..bytes.len()).step_by(197)) {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mut bad = bytes.clone();
            bad[at] ^= (state >> 56) as u8 | 1;
            std::fs::write(&path, &bad).unwrap();
            if let Err(error) = load(&DisplacementRequest::new(&path)) {
                let message = error.to_string();
                assert!(!message.contains(char::is_control) && !message.contains(panicked), "{path:?} {at}: {message}");
            }
        }
    }
}

#[test]
fn files_of_another_type_are_refused_by_what_they_should_be() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, format) in [("a.exr", "OpenEXR"), ("a.png", "PNG"), ("a.tif", "TIFF"), ("a.TIFF", "TIFF")] {
        for content in ["", "x", "v 0 0 0\nf 1 2 3\n", "\u{89}PNG\r\n\u{1a}\n"] {
            std::fs::write(path(name), content).unwrap();
            let told = refused(&path(name));
            assert!(told.starts_with(&format!("no {format} image that can be decoded (")), "{told}");
        }
    }
    std::fs::write(path("a.jpg"), "x").unwrap();
    assert!(refused(&path("a.jpg")).starts_with("a file of unknown format, expected a displacement map: an .exr, "));
    std::fs::create_dir(path("b.png")).unwrap();
    assert!(refused(&path("b.png")).starts_with("a directory, expected a displacement map"));
    assert!(refused(&path("none.exr")).starts_with("no file that can be read ("));
}

#[test]
fn missing_channels_are_refused_with_those_that_there_are() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let vector = |path: &Path| refusal(&request(path, DisplacementKind::Vector), &mesh(QUAD));
    let two = || vec![("R", halves(&[1.0])), ("G", halves(&[1.0]))];
    write_exr(&path("a.exr"), (1, 1), Encoding::UNCOMPRESSED, two());
    let expected = "expected channels R, G and B for a vector displacement";
    assert_eq!(vector(&path("a.exr")), format!("the channels G, R, {expected}"));
    write_exr(&path("a.exr"), (1, 1), Encoding::UNCOMPRESSED, vec![("A", halves(&[1.0])), ("G", halves(&[1.0]))]);
    let told = refused(&path("a.exr"));
    assert_eq!(told, "the channels A, G, expected channel Y or R, or one channel alone, for a scalar displacement");
    write_png(&path("a.png"), (1, 1), &[1, 2], ExtendedColorType::La8);
    assert_eq!(vector(&path("a.png")), format!("a grey image, {expected}"));
    let mut encoder = TiffEncoder::new(std::fs::File::create(path("a.tif")).unwrap()).unwrap();
    encoder.write_image::<colortype::Gray8>(1, 1, &[1]).unwrap();
    assert_eq!(vector(&path("a.tif")), format!("a grey image, {expected}"));
}

/// Replaces the only place where a file has these bytes.
fn replace(bytes: &mut [u8], from: &[u8], to: &[u8]) {
    let places: Vec<_> = (0..=bytes.len() - from.len()).filter(|&at| bytes[at..].starts_with(from)).collect();
    for at in &places {
        bytes[*at..at + to.len()].copy_from_slice(to);
    }
    assert!(!places.is_empty());
}

#[test]
fn sizes_that_headers_merely_claim_are_refused() {
    let folder = tempdir().unwrap();
    let (exr, png, tif) = (folder.path().join("a.exr"), folder.path().join("a.png"), folder.path().join("a.tif"));
    for side in [0_u32, 16_000, 16_385, 1_000_000, i32::MAX as u32, u32::MAX] {
        write_scalar(&exr, (64, 48), vec![0.5; 64 * 48]);
        let mut bytes = std::fs::read(&exr).unwrap();
        let window = |x: u32, y: u32| [0, 0, x.wrapping_sub(1), y.wrapping_sub(1)].map(u32::to_le_bytes).concat();
        replace(&mut bytes, &window(64, 48), &window(side, side));
        std::fs::write(&exr, &bytes).unwrap();
        refused(&exr);

        let mut bytes = png_of(side, side);
        bytes.extend([0; 100]);
        std::fs::write(&png, &bytes).unwrap();
        let told = refused(&png);
        if (16_000..i32::MAX as u32).contains(&side) {
            assert!(told.contains("16000 x 16000") || told.ends_with("expected 1 to 16384 texels a side"), "{told}");
        }

        let mut encoder = TiffEncoder::new(std::fs::File::create(&tif).unwrap()).unwrap();
        encoder.write_image::<colortype::Gray8>(77, 78, &[0; 77 * 78]).unwrap();
        let mut bytes = std::fs::read(&tif).unwrap();
        let tag =
            |number: u16, value: u32| [&number.to_le_bytes()[..], &[4, 0, 1, 0, 0, 0], &value.to_le_bytes()].concat();
        replace(&mut bytes, &tag(256, 77), &tag(256, side));
        replace(&mut bytes, &tag(257, 78), &tag(257, side));
        std::fs::write(&tif, &bytes).unwrap();
        refused(&tif);
    }
}

/// A PNG file's signature and header, with a good checksum.
fn png_of(width: u32, height: u32) -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend([width.to_be_bytes(), height.to_be_bytes()].concat());
    chunk.extend([8, 0, 0, 0, 0]);
    let crc = chunk.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    });
    [b"\x89PNG\r\n\x1a\n\0\0\0\x0d", chunk.as_slice(), &(!crc).to_be_bytes(), b"\x7f\xff\xff\xffIDAT"].concat()
}

#[test]
fn a_mesh_without_texture_coordinates_has_no_map_over_them() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_scalar(&path, (1, 1), vec![0.5]);
    let told = refusal(&DisplacementRequest::new(&path), &mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"));
    assert!(told.starts_with("mesh `mesh` without texture coordinates, expected a `vt` "), "{told}");
}
