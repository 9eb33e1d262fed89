//! Maps over texture coordinates: where texels are, and how they are filtered.
use crate::common::{map, tempdir, write_exr, write_scalar};
use exr::prelude::{Encoding, FlatSamples};
use planish_scene::displacement::{DisplacementKind, DisplacementMap, TileLayout};
use proptest::prelude::*;

fn scalar_map(size: (usize, usize), values: &[f32]) -> DisplacementMap {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    write_scalar(&path, size, values.to_vec());
    map(&path, DisplacementKind::Scalar)
}

#[test]
fn the_first_texel_is_at_the_upper_left_and_v_0_at_the_bottom() {
    let map = scalar_map((2, 2), &[1.0, 2.0, 3.0, 4.0]);
    assert_eq!((map.layout, map.tile_of.as_slice(), map.tile_columns), (TileLayout::Repeat, &[0][..], 1));
    let at = |u, v| map.sample([u, v], 0.0)[0];
    assert_eq!([at(0.25, 0.75), at(0.75, 0.75), at(0.25, 0.25), at(0.75, 0.25)], [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(at(0.5, 0.5), 2.5);
}

#[test]
fn one_image_repeats() {
    let map = scalar_map((4, 2), &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let at = |u, v| map.sample([u, v], 0.0)[0];
    assert_eq!([at(0.0, 0.75), at(1.0, 0.75), at(-3.0, 1.75)], [2.5; 3]);
    assert_eq!([at(0.125, 0.0), at(0.125, 1.0), at(4.125, -1.0)], [3.0; 3]);
    assert_eq!(at(-0.125, 0.25), 8.0);
}

#[test]
fn levels_are_blended_and_lod_is_clamped() {
    let map = scalar_map((4, 4), &(0..16).map(|i| i as f32).collect::<Vec<_>>());
    let at = |lod| map.sample([0.125, 0.875], lod)[0];
    assert_eq!([at(-1.0), at(f32::NAN), at(0.0)], [0.0; 3]);
    assert_eq!([at(2.0), at(7.0), at(f32::INFINITY)], [7.5; 3]);
    assert_eq!(at(1.5), 0.5 * at(1.0) + 0.5 * at(2.0));
    assert_eq!(map.level_count(), 3);
}

#[test]
fn vectors_are_filtered_by_component() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let channel = |values: [f32; 2]| FlatSamples::F32(values.to_vec());
    let channels = vec![("R", channel([1.0, 2.0])), ("G", channel([-1.0, 3.0])), ("B", channel([0.0, 8.0]))];
    write_exr(&path, (2, 1), Encoding::UNCOMPRESSED, channels);
    let map = map(&path, DisplacementKind::Vector);
    assert_eq!((map.channels, map.sample([0.5, 0.3], 0.0)), (3, [1.5, 1.0, 4.0]));
    assert!(map.bound > 77f32.sqrt() && map.bound < 8.776);
}

proptest! {
    #[test]
    fn no_sample_is_longer_than_the_bound(
        (width, height) in (1_usize..9, 1_usize..9),
        seed in 0_u32..1000,
        u in -2.0_f32..2.0, v in -2.0_f32..2.0, lod in -1.0_f32..5.0,
    ) {
        let values: Vec<f32> = (0..width * height)
            .map(|i| ((i as u32 * 2_654_435_761 + seed).rotate_left(7) % 2001) as f32 / 100.0 - 10.0).collect();
        let map = scalar_map((width, height), &values);
        let [sample, ..] = map.sample([u, v], lod);
        prop_assert!(sample.abs() <= map.bound);
    }
}
