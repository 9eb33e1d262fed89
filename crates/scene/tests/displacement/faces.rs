//! One tile a Ptex face: no seams, to the bit.
use std::path::Path;

use crate::common::{faces, mesh, refusal, tempdir, without_warning, write_exr, write_scalar};
use exr::prelude::{Encoding, FlatSamples};
use planish_scene::Mesh;
use planish_scene::displacement::{
    DisplacementKind, DisplacementMap, DisplacementRequest, TileLayout, load_displacement,
};
use proptest::prelude::*;

/// Meshes whose faces meet in every way: quads alone, n-gons, non-manifold edges and vertices, faces turned against each other.
const MESHES: [&str; 6] = [
    "cube",
    "mixed_triangles_quads",
    "nonmanifold_edge_4",
    "nonmanifold_moebius",
    "nonmanifold_flipped_face",
    "ngon_5",
];

fn scene_mesh(name: &str) -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.obj"));
    planish_scene::load(path, &Default::default()).unwrap().meshes.remove(0)
}

/// Numbers that look random, from -1 to 1; some are zero.
fn noise(index: usize, seed: u32) -> f32 {
    let bits = (index as u32).wrapping_mul(2_654_435_761).wrapping_add(seed.wrapping_mul(40_503)).rotate_left(13);
    let bits = bits.wrapping_mul(2_246_822_519) >> 8;
    if bits.is_multiple_of(13) { 0.0 } else { bits as f32 / (1 << 23) as f32 - 1.0 }
}

/// An atlas of noise, `columns` tiles in a row.
fn noise_map(mesh: &Mesh, segments: usize, columns: usize, kind: DisplacementKind, seed: u32) -> DisplacementMap {
    let tiles = mesh.control_mesh.ptex_face_count() as usize;
    let size = (columns * (segments + 1), tiles.div_ceil(columns) * (segments + 1));
    let folder = tempdir().unwrap();
    let path = folder.path().join("atlas.exr");
    let channel = |offset: u32| FlatSamples::F32((0..size.0 * size.1).map(|i| noise(i, seed + offset)).collect());
    write_exr(&path, size, Encoding::UNCOMPRESSED, vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))]);
    let request = DisplacementRequest { kind, ..faces(&path) };
    without_warning(load_displacement(&request, mesh).unwrap())
}

/// A point of an edge as a Ptex face sees it: u, 1 - u, v, 1 - v.
type Place = (u32, [f32; 2], [f32; 2]);

/// Where all faces of a mesh have the point at `t` and `rest` = 1 - t of the edge between two vertices, seen from the lower.
fn places(mesh: &Mesh, ends: [u32; 2], [t, rest]: [f32; 2]) -> Vec<Place> {
    let (mut places, mut first, mut ptex_face) = (Vec::new(), 0, 0);
    for &size in &mesh.control_mesh.face_sizes {
        let n = size as usize;
        let vertices = &mesh.control_mesh.face_vertices[first..first + n];
        for i in 0..n {
            let (from, to) = (vertices[i], vertices[(i + 1) % n]);
            if [from.min(to), from.max(to)] != ends {
                continue;
            }
            let [s, rest_s] = if from < to { [t, rest] } else { [rest, t] };
            let (forward, backward) = ([s, rest_s], [rest_s, s]);
            if n == 4 {
                let (low, high) = ([0.0, 1.0], [1.0, 0.0]);
                let place = [(forward, low), (high, forward), (backward, high), (low, backward)][i];
                places.push((ptex_face, place.0, place.1));
                continue;
            }
            // Part i has the first half on v = 0, part i + 1 the last on u = 0.
            if s <= rest_s {
                places.push((ptex_face + i as u32, [2.0 * s, 1.0 - 2.0 * s], [0.0, 1.0]));
            }
            if rest_s <= s {
                places.push((ptex_face + ((i + 1) % n) as u32, [0.0, 1.0], [2.0 * rest_s, 1.0 - 2.0 * rest_s]));
            }
        }
        first += n;
        ptex_face += if n == 4 { 1 } else { n as u32 };
    }
    places
}

fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let (mut edges, mut first) = (Vec::new(), 0);
    for &size in &mesh.control_mesh.face_sizes {
        let vertices = &mesh.control_mesh.face_vertices[first..first + size as usize];
        let ends = |i: usize| (vertices[i], vertices[(i + 1) % vertices.len()]);
        edges.extend((0..vertices.len()).map(ends).map(|(a, b)| [a.min(b), a.max(b)]));
        first += size as usize;
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn bits(value: [f32; 3]) -> [u32; 3] {
    value.map(f32::to_bits)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn faces_that_meet_on_an_edge_have_the_same_bits_there(
        name in prop::sample::select(MESHES.as_slice()),
        power in 1_u32..5, seed in 0_u32..1000, lod in -0.5_f32..5.0, is_vector: bool,
        ts in prop::collection::vec(0.0_f32..=1.0, 8),
    ) {
        let mesh = scene_mesh(name);
        let kind = if is_vector { DisplacementKind::Vector } else { DisplacementKind::Scalar };
        let map = noise_map(&mesh, 1 << power, 3, kind, seed);
        for ends in edges(&mesh) {
            for &t in ts.iter().chain(&[0.0, 0.1, 0.25, 0.3, 0.5, 1.0]) {
                // Of a float below 1/2 what is left to 1 is rounded: the two need not add up to 1.
                let point = [t, 1.0 - t];
                let found: Vec<_> =
                    places(&mesh, ends, point).iter().map(|&(face, u, v)| bits(map.sample_face(face, u, v, lod))).collect();
                prop_assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "{name} {ends:?} {t}: {found:?}");
            }
        }
    }

    #[test]
    fn parts_of_an_n_gon_have_the_same_bits_on_their_spokes(
        power in 1_u32..5, seed in 0_u32..1000, lod in -0.5_f32..4.0, t in 0.0_f32..=1.0,
    ) {
        let mesh = mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
        let map = noise_map(&mesh, 1 << power, 3, DisplacementKind::Scalar, seed);
        for i in 0..3 {
            let part = map.sample_face(i, [1.0, 0.0], [t, 1.0 - t], lod);
            let next = map.sample_face((i + 1) % 3, [t, 1.0 - t], [1.0, 0.0], lod);
            prop_assert_eq!(bits(part), bits(next));
        }
        let center = |i| bits(map.sample_face(i, [1.0, 0.0], [1.0, 0.0], lod));
        prop_assert!(center(0) == center(1) && center(1) == center(2));
    }

    #[test]
    fn inside_of_a_face_the_surface_goes_on_from_its_edges(
        name in prop::sample::select(MESHES.as_slice()),
        power in 1_u32..4, seed in 0_u32..1000, t in 0.01_f32..0.99, lod in 0.0_f32..3.0,
    ) {
        let mesh = scene_mesh(name);
        let map = noise_map(&mesh, 1 << power, 4, DisplacementKind::Scalar, seed);
        let near = 1e-6;
        for face in 0..map.ptex_face_count() {
            let along = [t, 1.0 - t];
            for (edge, inside) in [([0.0, 1.0], [near, 1.0 - near]), ([1.0, 0.0], [1.0 - near, near])] {
                let close = |a: [f32; 3], b: [f32; 3]| (a[0] - b[0]).abs() < 1e-4;
                prop_assert!(close(map.sample_face(face, along, edge, lod), map.sample_face(face, along, inside, lod)));
                prop_assert!(close(map.sample_face(face, edge, along, lod), map.sample_face(face, inside, along, lod)));
            }
        }
    }
}

#[test]
fn tiles_are_in_ptex_order_with_row_0_at_v_0_and_averaged_where_they_meet() {
    // Two quads side by side: face 1's side u = 0 is face 0's side u = 1.
    let mesh = mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nf 1 2 5 4\nf 2 3 6 5\n");
    let folder = tempdir().unwrap();
    let path = folder.path().join("atlas.exr");
    #[rustfmt::skip]
    let rows = vec![
        0.0, 1.0, 2.0,   4.0, 5.0, 6.0,
        10.0, 11.0, 12.0,   14.0, 15.0, 16.0,
        20.0, 21.0, 22.0,   24.0, 25.0, 26.0,
    ];
    write_scalar(&path, (6, 3), rows);
    let map = without_warning(load_displacement(&faces(&path), &mesh).unwrap());
    assert_eq!((map.layout, map.ptex_face_count(), map.parts.as_slice()), (TileLayout::Faces, 2, &[0][..]));
    let sides: Vec<_> = map.levels.iter().map(|level| (level.first_texel, level.width, level.height)).collect();
    assert_eq!(sides, [(0, 3, 3), (18, 2, 2)]);
    let finest =
        [[0.0, 1.0, 3.0, 10.0, 11.0, 13.0, 20.0, 21.0, 23.0], [3.0, 5.0, 6.0, 13.0, 15.0, 16.0, 23.0, 25.0, 26.0]];
    assert_eq!(map.texels[..18], finest.concat());
    assert_eq!(map.texels[18..], [0.0, 3.0, 20.0, 23.0, 3.0, 6.0, 23.0, 26.0]);
    let at = |face, u: f32, v: f32| map.sample_face(face, [u, 1.0 - u], [v, 1.0 - v], 0.0)[0];
    assert_eq!([at(0, 0.5, 0.0), at(0, 0.0, 0.5), at(0, 0.5, 0.5), at(1, 0.75, 0.5)], [1.0, 10.0, 11.0, 15.5]);
    assert_eq!(map.sample_face(2, [0.5; 2], [0.5; 2], 0.0), [0.0; 3]);
}

#[test]
fn a_map_that_is_the_same_everywhere_stays_so_at_every_level() {
    for name in MESHES {
        let mesh = scene_mesh(name);
        let tiles = mesh.control_mesh.ptex_face_count() as usize;
        let folder = tempdir().unwrap();
        let path = folder.path().join("atlas.exr");
        write_scalar(&path, (9, 9 * tiles), vec![0.7; 81 * tiles]);
        let map = without_warning(load_displacement(&faces(&path), &mesh).unwrap());
        assert!(map.texels.iter().all(|&value| value == 0.7), "{name}");
        let has_n_gons = mesh.control_mesh.face_sizes.iter().any(|&size| size != 4);
        assert_eq!(map.level_count(), if has_n_gons { 3 } else { 4 }, "{name}");
    }
}

#[test]
fn holes_do_not_take_part_in_means() {
    let obj = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nf 1 2 5 4\nf 2 3 6 5\nt hole 1/0/0 1\n";
    let folder = tempdir().unwrap();
    let path = folder.path().join("atlas.exr");
    let rows: Vec<f32> = (0..18).map(|i| if i % 6 < 3 { 1.0 } else { 100.0 }).collect();
    write_scalar(&path, (6, 3), rows);
    let map = without_warning(load_displacement(&faces(&path), &mesh(obj)).unwrap());
    assert!(map.texels[..9].iter().all(|&value| value == 1.0));
}

#[test]
fn resolution_follows_from_the_size_and_the_number_of_faces() {
    let cube = scene_mesh("cube");
    for (segments, columns) in [(1, 6), (2, 3), (8, 2), (16, 4), (32, 1)] {
        let map = noise_map(&cube, segments, columns, DisplacementKind::Scalar, 0);
        assert_eq!(map.levels[0].width as usize, segments + 1, "{segments} {columns}");
    }
    let folder = tempdir().unwrap();
    let path = folder.path().join("atlas.exr");
    // 6 tiles in rows of 4 leave 2 spare ones; a third row would be spare altogether.
    write_scalar(&path, (20, 15), vec![0.0; 300]);
    assert_eq!(
        refusal(&faces(&path), &cube),
        "an atlas of 20 x 15 texels, expected rows of 6 tiles, one a Ptex face, of 2^k + 1 texels a side (2 or more), \
         such as 27 x 18"
    );
    write_scalar(&path, (6, 2), vec![0.0; 12]);
    assert!(refusal(&faces(&path), &mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")).contains("(3 or more)"));
}
