//! Formats: raw values, whatever they are stored as.
use crate::common::{finest, halves, map, tempdir, write_exr, write_png, write_scalar};
use exr::prelude::{Encoding, FlatSamples};
use image::ExtendedColorType;
use planish_scene::displacement::DisplacementKind::{Scalar, Vector};
use planish_scene::displacement::DisplacementRequest;
use tiff::encoder::{TiffEncoder, colortype};

#[test]
fn exr_channels_of_any_type_are_read_from_their_names() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.EXR");
    let size = (2, 1);
    let rgb = || vec![("R", halves(&[1.0, 2.0])), ("G", halves(&[3.0, 4.0])), ("B", halves(&[-0.5, 6.0]))];
    for encoding in [Encoding::UNCOMPRESSED, Encoding::FAST_LOSSLESS, Encoding::SMALL_LOSSLESS] {
        write_exr(&path, size, encoding, rgb());
        assert_eq!(finest(&map(&path, Scalar)), [1.0, 2.0]);
        assert_eq!(finest(&map(&path, Vector)), [1.0, 3.0, -0.5, 2.0, 4.0, 6.0]);
    }
    let mut channels = rgb();
    channels.push(("Y", FlatSamples::F32(vec![0.1, -7.0])));
    write_exr(&path, size, Encoding::SMALL_LOSSLESS, channels);
    assert_eq!(finest(&map(&path, Scalar)), [0.1, -7.0]);
    write_exr(&path, size, Encoding::SMALL_LOSSLESS, vec![("height", FlatSamples::U32(vec![u32::MAX, 0]))]);
    assert_eq!(finest(&map(&path, Scalar)), [1.0, 0.0]);
}

#[test]
fn png_values_are_divided_by_their_maximum_and_never_decoded_as_srgb() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    write_png(&path, (3, 1), &[0, 51, 255], ExtendedColorType::L8);
    assert_eq!(finest(&map(&path, Scalar)), [0.0, 0.2, 1.0]);
    write_png(&path, (1, 1), &[51, 102, 255, 7], ExtendedColorType::Rgba8);
    assert_eq!(finest(&map(&path, Scalar)), [0.2]);
    assert_eq!(finest(&map(&path, Vector)), [0.2, 0.4, 1.0]);
    let words: Vec<u8> = [13107_u16, 65535].into_iter().flat_map(u16::to_ne_bytes).collect();
    write_png(&path, (2, 1), &words, ExtendedColorType::L16);
    assert_eq!(finest(&map(&path, Scalar)), [0.2, 1.0]);
}

#[test]
fn tiff_integers_and_floats_are_read_grey_and_coloured() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.tif");
    let encoder = || TiffEncoder::new(std::fs::File::create(&path).unwrap()).unwrap();
    encoder().write_image::<colortype::Gray8>(2, 1, &[51, 255]).unwrap();
    assert_eq!(finest(&map(&path, Scalar)), [0.2, 1.0]);
    encoder().write_image::<colortype::Gray16>(2, 1, &[13107, 0]).unwrap();
    assert_eq!(finest(&map(&path, Scalar)), [0.2, 0.0]);
    encoder().write_image::<colortype::Gray32Float>(2, 2, &[0.1, -2.0, 3e4, 4.0]).unwrap();
    assert_eq!(finest(&map(&path, Scalar)), [0.1, -2.0, 3e4, 4.0]);
    encoder().write_image::<colortype::RGB32Float>(1, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    assert_eq!(finest(&map(&path, Vector)), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(finest(&map(&path, Scalar)), [1.0, 4.0]);
    let compressed =
        |compression| TiffEncoder::new(std::fs::File::create(&path).unwrap()).unwrap().with_compression(compression);
    for compression in [
        tiff::encoder::Compression::Lzw,
        tiff::encoder::Compression::Packbits,
        tiff::encoder::Compression::Deflate(tiff::encoder::DeflateLevel::Fast),
    ] {
        compressed(compression).write_image::<colortype::Gray32Float>(2, 1, &[0.25, -2.0]).unwrap();
        assert_eq!(finest(&map(&path, Scalar)), [0.25, -2.0]);
    }
}

#[test]
fn scale_and_midpoint_are_folded_into_texels() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_scalar(&path, (3, 1), vec![0.5, 1.0, 0.0]);
    let request = DisplacementRequest { scale: -4.0, midpoint: 0.5, ..DisplacementRequest::new(&path) };
    let (map, _) = crate::common::load(&request).unwrap();
    assert_eq!(finest(&map), [0.0, -2.0, 2.0]);
    assert!(map.bound > 2.0 && map.bound < 2.001);
}

#[test]
fn texels_that_are_not_finite_do_not_displace_and_are_warned_of_once() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_scalar(&path, (4, 1), vec![f32::NAN, 1.0, f32::INFINITY, f32::NEG_INFINITY]);
    let (map, warning) = crate::common::load(&DisplacementRequest::new(&path)).unwrap();
    assert_eq!(finest(&map), [0.0, 1.0, 0.0, 0.0]);
    let expected = format!("{}: 3 texels are not finite, ", path.display());
    assert!(warning.unwrap().text.starts_with(&expected));
}
