//! Several objects in one frame: each is whole, closed and its own mesh, moved.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use planish_scene::{Instance, LoadOptions, load};
use planish_tests::cage::Cage;
use planish_tests::folder::temporary;
use planish_tests::judge::{check_coverage, check_edges};
use planish_tests::oracle::POSITION_TOLERANCE;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::{Outcome, Planish};
use planish_tests::repository::{root, scene};

/// An object of a dump.
struct Object {
    instance: Instance,
    /// File of its mesh.
    mesh: PathBuf,
    /// Its triangles' corners, their faces counted from its own first.
    vertices: Vec<Vertex>,
}

fn dump(path: &Path, flags: &str) -> (Outcome, Vec<Vertex>) {
    let folder = temporary();
    let out = folder.path().join("dump.ply");
    let outcome = Planish::dump(path, &out).flags(flags).run().silent_success().unwrap();
    (outcome, Dump::read(&out).unwrap().vertices().collect())
}

/// The objects of a scene file, whose meshes are files of `scenes/` named as the meshes; each is judged by itself: faces are
/// covered once, and triangles meet edge to edge.
fn judged_objects(path: &Path, flags: &str) -> Vec<Object> {
    let loaded = load(path, &LoadOptions::default()).unwrap();
    let (outcome, vertices) = dump(path, flags);
    let mut first = 0;
    let mut judged = 0;
    let objects: Vec<Object> = loaded
        .instances
        .into_iter()
        .map(|instance| {
            let mesh = scene(&loaded.meshes[instance.mesh].name);
            let cage = Cage::read(&mesh);
            let faces = first..first + cage.ptex_face_count() as u32;
            let own = vertices.iter().filter(|vertex| faces.contains(&vertex.face));
            let vertices: Vec<Vertex> = own.map(|&vertex| Vertex { face: vertex.face - first, ..vertex }).collect();
            check_coverage(&vertices, &cage).and_then(|()| check_edges(&mesh, &vertices, &outcome)).unwrap();
            first = faces.end;
            judged += vertices.len();
            Object { instance, mesh, vertices }
        })
        .collect();
    assert_eq!(judged, vertices.len(), "faces past the last object's");
    objects
}

/// Corners by face, level, kind and parameters: those of a mesh are the same whatever its object.
fn by_place(vertices: &[Vertex]) -> BTreeMap<[u32; 5], Vec<[f32; 3]>> {
    let mut places: BTreeMap<[u32; 5], Vec<[f32; 3]>> = BTreeMap::new();
    for Vertex { position, uv: [u, v], face, level, kind, .. } in vertices {
        let place = [*face, u32::from(*level), u32::from(*kind), u.to_bits(), v.to_bits()];
        places.entry(place).or_default().push(*position);
    }
    places
}

#[test]
fn every_object_is_its_mesh_moved() {
    let flags = "--tess 5.3";
    let objects = judged_objects(&root().join("scenes/several.json"), flags);
    assert!(objects.iter().any(|object| object.instance.is_mirrored()) && objects.len() > 10);
    let mut alone = BTreeMap::new();
    for Object { instance, mesh, vertices } in &objects {
        let alone = alone.entry(mesh).or_insert_with(|| by_place(&dump(mesh, flags).1));
        let found = by_place(vertices);
        assert!(found.keys().eq(alone.keys()), "{}: other triangles", instance.name);
        for (place, positions) in &found {
            let expected = instance.transform.transform_point3(alone[place][0].into());
            let size = expected.abs().max_element().max(1.0);
            for position in positions {
                let distance = f64::from(expected.distance((*position).into()) / size);
                assert!(distance < POSITION_TOLERANCE, "{} {place:?}: off by {distance}", instance.name);
            }
        }
    }
}

#[test]
fn objects_seen_from_near_are_whole_and_closed() {
    let path = root().join("scenes/several.json");
    judged_objects(&path, "--edge-pixels 3 --size 160x90");
    judged_objects(&path, "--edge-pixels 2 --size 80x45 --eye -6,0.6,3 --target 1,0.4,0 --spacing fractional-even");
}

/// A scene of the same mesh at several distances.
fn write_row(folder: &Path, mesh: &str) -> PathBuf {
    let path = folder.join("row.json");
    let text = format!(
        r#"{{"meshes": [{{"name": "{mesh}", "file": "{}"}}],
            "instances": [{{"mesh": "{mesh}", "array": {{"count": [1, 1, 4], "step": [0, 0, -12]}}}}],
            "cameras": [{{"name": "near", "eye": [0, 3, 7], "target": [0, 0, 0], "fov": 45}}]}}"#,
        scene(mesh).display()
    );
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn with_a_density_an_object_farther_ones_are_coarser_and_all_are_uniform() {
    let folder = temporary();
    for mesh in ["adjacent_extraordinary", "mixed_triangles_quads"] {
        let path = write_row(folder.path(), mesh);
        let objects = judged_objects(&path, "--edge-pixels 4 --size 320x180 --lod object --spacing equal");
        let counts: Vec<usize> = objects.iter().map(|object| object.vertices.len()).collect();
        assert!(counts.is_sorted_by(|near, far| near >= far) && counts[0] > counts[3], "{mesh}: {counts:?}");
        for object in &objects {
            // One density: with whole segments the object is what some whole factor gives.
            let is_factor = |factor: &u32| {
                let (_, vertices) = dump(&object.mesh, &format!("--tess {factor} --spacing equal"));
                by_place(&vertices).keys().eq(by_place(&object.vertices).keys())
            };
            assert!((1..=40).any(|factor| is_factor(&factor)), "{mesh}: {}", object.instance.name);
        }
    }
}

#[test]
fn a_density_tag_scales_the_tess_factor() {
    let folder = temporary();
    let path = folder.path().join("dense.obj");
    let text = fs::read_to_string(scene("valence_5")).unwrap();
    let vertices: Vec<String> = (0..Cage::read(&scene("valence_5")).positions.len()).map(|v| v.to_string()).collect();
    let tag = |floats: &str, count: usize| {
        format!("{text}t density {}/{count}/0 {} {floats}\n", vertices.len(), vertices.join(" "))
    };
    fs::write(&path, tag("4", 1)).unwrap();
    assert_eq!(by_place(&dump(&path, "--tess 2").1), by_place(&dump(&scene("valence_5"), "--tess 8").1));

    // One factor a vertex, from nothing to ten.
    let floats: Vec<String> = (0..vertices.len()).map(|v| format!("{}", (v * 7 % 21) as f32 * 0.5)).collect();
    fs::write(&path, tag(&floats.join(" "), vertices.len())).unwrap();
    for flags in ["--tess 6", "--tess 6 --spacing fractional-even", "--edge-pixels 4 --size 96x54 --spacing equal"] {
        planish_tests::judge::check(&path, flags).unwrap();
    }
}
