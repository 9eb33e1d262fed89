//! Displaced dumps: every point lies where its map says, looked up by the reader's own sampler.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use planish_scene::displacement::{
    DisplacementKind, DisplacementLayout, DisplacementMap, DisplacementRequest, load_displacement,
};
use planish_scene::{LoadOptions, load};
use planish_tests::folder::temporary;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::scene;

/// Far denser than the maps' texels: the finest level is looked up.
const FLAGS: &str = "--tess 24 --method fas --max-level 2";
/// Over the scene's size of a few units: rounding of positions, and of parameters times the maps' slopes.
const TOLERANCE: f32 = 2e-5;

/// Grey and coloured texels that differ from each other.
fn write_map(path: &Path, size: u32, value: impl Fn(u32, u32) -> [u8; 3]) {
    image::RgbImage::from_fn(size, size, |x, y| image::Rgb(value(x, y))).save(path).expect("a file");
}

fn waves(x: u32, y: u32) -> [u8; 3] {
    [(x * 37 + y * 91) % 256, (x * 53 + y * 17) % 256, (x * 71 + y * 29) % 256].map(|value| value as u8)
}

fn dump(mesh: &Path, flags: &str) -> Vec<Vertex> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    Planish::dump(mesh, &path).flags(FLAGS).flags(flags).run().silent_success().unwrap();
    Dump::read(&path).unwrap().vertices().collect()
}

fn load_map(mesh: &Path, request: &DisplacementRequest) -> DisplacementMap {
    let scene = load(mesh, &LoadOptions::default()).expect("the scene can be read");
    load_displacement(request, &scene.meshes[0]).expect("the map can be read").0
}

/// Checks that each displaced point is its point of the limit surface moved by what `by` says of it.
fn check(mesh: &Path, flags: &str, by: impl Fn(&Vertex) -> [f32; 3]) {
    let at = |vertex: &Vertex| (vertex.face, vertex.uv.map(f32::to_bits));
    let limit: HashMap<_, Vertex> = dump(mesh, "").into_iter().map(|vertex| (at(&vertex), vertex)).collect();
    let displaced = dump(mesh, flags);
    assert!(displaced.len() > 10_000 && displaced.len().is_multiple_of(3));
    let mut farthest = 0.0_f32;
    for vertex in &displaced {
        let from = limit[&at(vertex)];
        assert_eq!(vertex.normal, from.normal, "the direction is the limit's normal: {vertex:?}");
        let moved = by(vertex);
        let axes = from.position.into_iter().zip(moved).zip(vertex.position);
        for ((from, moved), found) in axes {
            let expected = from + moved;
            assert!((found - expected).abs() < TOLERANCE, "{found}, expected {expected}: {vertex:?}");
            farthest = farthest.max((found - from).abs());
        }
    }
    assert!(farthest > 0.1, "points move");
}

fn map_in(folder: &Path) -> PathBuf {
    let path = folder.join("map.png");
    write_map(&path, 8, waves);
    path
}

#[test]
fn points_move_along_the_normal_by_what_the_map_says() {
    let (mesh, folder) = (scene("uv_continuous"), temporary());
    let path = map_in(folder.path());
    let request = DisplacementRequest { scale: 0.3, midpoint: 0.25, ..DisplacementRequest::new(&path) };
    let map = load_map(&mesh, &request);
    let flags = format!("--displacement {} --displacement-scale 0.3 --displacement-midpoint 0.25", path.display());
    check(&mesh, &flags, |vertex| {
        let [length, ..] = map.sample(vertex.tex_coord, 0.0);
        vertex.normal.map(|n| length * n)
    });
}

#[test]
fn points_move_by_the_vector_that_the_map_says() {
    let (mesh, folder) = (scene("uv_continuous"), temporary());
    let path = map_in(folder.path());
    let request = DisplacementRequest { scale: 0.3, kind: DisplacementKind::Vector, ..DisplacementRequest::new(&path) };
    let map = load_map(&mesh, &request);
    let flags = format!("--displacement {} --displacement-scale 0.3 --displacement-kind vector", path.display());
    check(&mesh, &flags, |vertex| map.sample(vertex.tex_coord, 0.0));
}

#[test]
fn points_move_by_what_the_tile_of_their_face_says() {
    let (mesh, folder) = (scene("adjacent_extraordinary"), temporary());
    let face_count = load(&mesh, &LoadOptions::default()).expect("the scene").meshes[0].control_mesh.face_sizes.len();
    // Tiles of 5 x 5 texels, in rows of as many.
    let columns = (face_count as f64).sqrt().ceil() as u32;
    let rows = (face_count as u32).div_ceil(columns);
    let path = folder.path().join("atlas.png");
    image::RgbImage::from_fn(5 * columns, 5 * rows, |x, y| image::Rgb(waves(x, y))).save(&path).expect("a file");
    let request =
        DisplacementRequest { scale: 0.3, layout: DisplacementLayout::Faces, ..DisplacementRequest::new(&path) };
    let map = load_map(&mesh, &request);
    let flags = format!("--displacement {} --displacement-scale 0.3 --displacement-layout faces", path.display());
    check(&mesh, &flags, |vertex| {
        let [u, v] = vertex.uv;
        let [length, ..] = map.sample_face(vertex.face, [u, 1.0 - u], [v, 1.0 - v], 0.0);
        vertex.normal.map(|n| length * n)
    });
}

#[test]
fn a_surface_that_moves_everywhere_alike_keeps_its_normals() {
    let (mesh, folder) = (scene("uv_continuous"), temporary());
    let path = folder.path().join("white.png");
    write_map(&path, 4, |_, _| [255; 3]);
    for vertex in dump(&mesh, &format!("--displacement {} --displacement-scale 0.3", path.display())) {
        let off = (0..3).map(|axis| (vertex.shading_normal[axis] - vertex.normal[axis]).abs()).fold(0.0, f32::max);
        assert!(off < 1e-5, "{vertex:?}");
    }
}

/// A sheet of 4 x 4 faces whose texture coordinates lie in the middle of a map, with a hole at (1, 1).
fn holed_sheet() -> String {
    let mut text = String::new();
    let places = || (0..5).flat_map(|j| (0..5).map(move |i| (f64::from(i), f64::from(j))));
    places().for_each(|(x, y)| text += &format!("v {x} {y} 0\n"));
    places().for_each(|(x, y)| text += &format!("vt {} {}\n", 0.4 + 0.1 * x, 0.4 + 0.1 * y));
    for a in (0..4).flat_map(|j| (1..5).map(move |i| 5 * j + i)) {
        let corner = |v: u32| format!("{v}/{v}");
        text += &format!("f {} {} {} {}\n", corner(a), corner(a + 1), corner(a + 6), corner(a + 5));
    }
    text + "t hole 1/0/0 5\n"
}

#[test]
fn beside_a_hole_a_point_is_looked_up_at_its_own_texture_coordinates() {
    let folder = temporary();
    let mesh = folder.path().join("sheet.obj");
    std::fs::write(&mesh, holed_sheet()).expect("a file");
    // The map moves what is at (0, 0), where the hole's faces would be looked up, and nothing else.
    let map = folder.path().join("map.png");
    write_map(&map, 16, |x, y| if x < 4 && y >= 12 { [255; 3] } else { [0; 3] });
    for method in ["gregory", "fas"] {
        let path = folder.path().join("dump.ply");
        let flags = format!("--tess 6 --method {method} --displacement-scale 1 --displacement");
        Planish::dump(&mesh, &path).flags(&flags).path(&map).run().silent_success().unwrap();
        let heights = Dump::read(&path).unwrap().vertices().map(|vertex| vertex.position[2].abs()).collect::<Vec<_>>();
        assert!(heights.len() > 500 && heights.iter().all(|&height| height < 1e-6), "{method}");
    }
}
