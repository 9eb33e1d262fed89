//! What method table's options change, and what they leave as it is.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use planish_tests::cage::Cage;
use planish_tests::folder::temporary;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::{scene, scheme_scene};
use planish_tests::weld::{Weld, faults};
use serde_json::Value;

fn dump(folder: &Path, mesh: &Path, flags: &str) -> PathBuf {
    let path = folder.join(format!("{}.ply", flags.replace(' ', "_")));
    Planish::dump(mesh, &path).flags("--method table --tess 8").flags(flags).run().silent_success().unwrap();
    path
}

/// The largest distance between two dumps at the same parameters, and the mean and the largest angle between normals in degrees.
fn apart(a: &Path, b: &Path) -> [f64; 3] {
    let outcome = Planish::new("compare").path(a).path(b).flags("--json --samples 0").run().silent_success().unwrap();
    let found = &outcome.json().unwrap()["parametric"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let normals = &found["normal_degrees"];
    [number(&found["distance"]["max"]), number(&normals["mean"]), number(&normals["max"])]
}

#[test]
fn weights_of_16_bits_are_near_those_of_32_and_close_too() {
    for (name, scheme) in [("loop_valences", "loop"), ("loop_valences", "butterfly"), ("stam_rocket", "loop-stam")] {
        let (folder, mesh) = (temporary(), scheme_scene(name));
        let cage = Cage::read(&mesh);
        let float = dump(folder.path(), &mesh, &format!("--scheme {scheme}"));
        let short = dump(folder.path(), &mesh, &format!("--scheme {scheme} --table-weights short"));
        let [distance, mean, most] = apart(&short, &float);
        // Weights of 16 bits are off by up to half a 2^-15th of the largest, a dozen and more of them.
        assert!(distance > 0.0 && distance < 5e-5 * cage.diagonal(), "{name} {scheme}: {distance:e}");
        assert!(mean > 0.0 && mean < 0.1 && most < 1.0, "{name} {scheme}: {mean} and {most} degrees");
        let vertices: Vec<_> = Dump::read(&short).unwrap().vertices().collect();
        assert_eq!(faults(&vertices, &cage, Weld::PositionAndNormal), Vec::<String>::new(), "{name} {scheme}");
    }
}

#[test]
fn each_way_of_normals_has_its_own_on_the_same_points() {
    let (folder, mesh) = (temporary(), scheme_scene("loop_valences"));
    let ways = ["tangent", "subdivision0", "subdivision1", "subdivision2", "geometric"];
    let of = |way: &str| dump(folder.path(), &mesh, &format!("--scheme loop --table-normals {way}"));
    let dumps = ways.map(of);
    let size = Cage::read(&mesh).diagonal();
    for (i, a) in dumps.iter().enumerate() {
        for (j, b) in dumps.iter().enumerate().skip(i + 1) {
            let place = format!("{} and {}", ways[i], ways[j]);
            let [distance, mean, most] = apart(a, b);
            // Tables over M2 are others.
            let is_other = ways[i].ends_with('2') || ways[j].ends_with('2');
            assert!(if is_other { distance < 1e-6 * size } else { distance == 0.0 }, "{place}: {distance:e}");
            assert!(mean > 0.2 && most < 40.0, "{place}: {mean} and {most} degrees");
        }
    }
    // The later the geometric normals are taken, the nearer is what is made of them to the surface's own.
    let [far, near, nearest] = [1, 2, 3].map(|way| apart(&dumps[way], &dumps[0])[1]);
    assert!(far > near && near > nearest, "{far}, {near}, {nearest} degrees");
}

#[test]
fn geometric_normals_are_interpolated_between_those_of_the_mesh_split_once() {
    let (folder, mesh) = (temporary(), scene("genus_2"));
    let vertices = |way: &str| -> Vec<_> {
        let flags = format!("--scheme catmull-clark --table-normals {way}");
        Dump::read(&dump(folder.path(), &mesh, &flags)).unwrap().vertices().collect()
    };
    // The largest angle at the middle of an edge of the split mesh, to the mean of the normals at its ends: eight segments are two such
    // edges of four.
    let largest_angle = |way: &str| {
        let place = |vertex: &Vertex| (vertex.face, vertex.uv.map(|t| (8.0 * t).round() as i32));
        let normals: HashMap<_, _> = vertices(way).iter().map(|vertex| (place(vertex), vertex.normal)).collect();
        let mut largest = 0.0_f32;
        for (&(face, [u, v]), normal) in normals.iter().filter(|((_, [u, v]), _)| u % 4 == 2 && v % 4 == 0) {
            let [a, b] = [u - 2, u + 2].map(|u| normals[&(face, [u, v])]);
            let sum: [f32; 3] = std::array::from_fn(|c| a[c] + b[c]);
            let length = |v: [f32; 3]| v.iter().map(|c| c * c).sum::<f32>().sqrt();
            let off: [f32; 3] = std::array::from_fn(|c| sum[c] / length(sum) - normal[c]);
            largest = largest.max(length(off).to_degrees());
        }
        largest
    };
    let [geometric, subdivision] = ["geometric", "subdivision1"].map(largest_angle);
    assert!(geometric < 1e-4 && subdivision > 1.0, "{geometric} and {subdivision} degrees");
}
