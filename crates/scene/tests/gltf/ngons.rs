//! Cages through OBJ and through FB_ngon_encoding are the same.
use std::collections::HashSet;
use std::path::Path;

use crate::common::{File, keep_ngons};
use planish_scene::{LoadOptions, load, read_obj};
use planish_subdiv::mesh::{
    BoundaryInterpolation, ControlMesh, Creasing, FaceVaryingInterpolation, TriangleSubdivision,
};
use serde_json::{Value, json};

/// Fans of polygons by the extension's rule: each around one of its vertices, its first if the polygon before is not around that.
/// Returns how many polygons begin at another than their first.
fn encode<'a>(polygons: impl Iterator<Item = &'a [u32]>) -> (Vec<u32>, usize) {
    let (mut triangles, mut last, mut turned_count) = (Vec::new(), None, 0);
    for polygon in polygons {
        let start = usize::from(last == Some(polygon[0]));
        turned_count += start;
        let corner = |i: usize| polygon[(start + i) % polygon.len()];
        (1..polygon.len() - 1).for_each(|i| triangles.extend([corner(0), corner(i), corner(i + 1)]));
        last = Some(corner(0));
    }
    (triangles, turned_count)
}

fn polygons(sizes: &[u32], corners: &[u32]) -> Vec<Vec<u32>> {
    let mut rest = corners;
    let polygon = |&size: &u32| {
        let (polygon, after) = rest.split_at(size as usize);
        rest = after;
        polygon.to_vec()
    };
    sizes.iter().map(polygon).collect()
}

fn tags(mesh: &ControlMesh, is_welded: bool) -> Value {
    let options = &mesh.options;
    json!({
        "creases": mesh.creases.iter().map(|c| json!([c.vertices[0], c.vertices[1], c.sharpness])).collect::<Vec<_>>(),
        "corners": mesh.corners.iter().map(|c| json!([c.vertex, c.sharpness])).collect::<Vec<_>>(),
        "holes": mesh.holes,
        "interpolateBoundary": match options.boundary {
            BoundaryInterpolation::None => "none",
            BoundaryInterpolation::EdgeOnly => "edgeOnly",
            BoundaryInterpolation::EdgeAndCorner => "edgeAndCorner",
        },
        "faceVarying": match options.face_varying {
            FaceVaryingInterpolation::None => "none",
            FaceVaryingInterpolation::CornersOnly => "cornersOnly",
            FaceVaryingInterpolation::CornersPlus1 => "cornersPlus1",
            FaceVaryingInterpolation::CornersPlus2 => "cornersPlus2",
            FaceVaryingInterpolation::Boundaries => "boundaries",
            FaceVaryingInterpolation::All => "all",
        },
        "creaseMethod": if options.creasing == Creasing::Chaikin { "chaikin" } else { "uniform" },
        "triangleSubdivision": if options.triangles == TriangleSubdivision::Smooth { "smooth" } else { "catmullClark" },
        "weld": is_welded,
    })
}

/// Writes a cage as exporters do that share vertices, reads it, and returns it with how many of its polygons were turned.
fn through_gltf(mesh: &ControlMesh) -> (ControlMesh, usize) {
    let different: HashSet<[u32; 3]> = mesh.positions.iter().map(|p| p.map(|c| (c + 0.0).to_bits())).collect();
    let polygons = polygons(&mesh.face_sizes, &mesh.face_vertices);
    let (triangles, turned_count) = encode(polygons.iter().map(Vec::as_slice));
    let mut file = File::new();
    file.mesh(&mesh.positions, &triangles);
    keep_ngons(&mut file, 0);
    file.json["meshes"][0]["extras"] = json!({ "planish": tags(mesh, different.len() == mesh.positions.len()) });
    file.root(json!({ "mesh": 0 }));
    let mut scene = file.scene();
    (scene.meshes.remove(0).control_mesh, turned_count)
}

#[test]
fn every_scene_of_ours_is_the_same_cage_through_obj_and_gltf() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let (mut same_count, mut turned) = (0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "obj") {
            continue;
        }
        let mut expected = load(&path, &LoadOptions::default()).unwrap().meshes.remove(0).control_mesh;
        if expected.positions.len() > usize::from(u16::MAX) {
            continue;
        }
        // What glTF has no word for, and what is tested elsewhere.
        (expected.edits, expected.density, expected.colors) = (vec![], vec![], None);
        expected.face_varying.clear();
        let (found, turned_count) = through_gltf(&expected);
        if turned_count == 0 {
            assert_eq!(found, expected, "{}", path.display());
            same_count += 1;
            continue;
        }
        turned += 1;
        assert_eq!(found.positions, expected.positions);
        assert_eq!(found.face_sizes, expected.face_sizes);
        let faces = polygons(&found.face_sizes, &found.face_vertices);
        for (mut found, expected) in faces.into_iter().zip(polygons(&expected.face_sizes, &expected.face_vertices)) {
            let start = found.iter().position(|vertex| *vertex == expected[0]).unwrap();
            found.rotate_left(start);
            assert_eq!(found, expected, "{}", path.display());
        }
    }
    assert!(same_count > 40 && turned > 5, "{same_count} the same, {turned} turned");
}

#[test]
fn split_vertices_become_one_and_seams_stay() {
    // A prism unfolded: a pentagon, quads around it, each quad with texture coordinates of its own.
    let pentagon = |i: u32, y: f32| {
        let angle = i as f32 * 1.256_637;
        [angle.cos(), y, angle.sin()]
    };
    let positions: Vec<[f32; 3]> = (0..10).map(|i| pentagon(i % 5, (i / 5) as f32)).collect();
    let mut obj = positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect::<String>();
    let (mut faces, mut uvs): (Vec<Vec<u32>>, Vec<Vec<[f32; 2]>>) =
        (vec![vec![4, 3, 2, 1, 0]], vec![vec![[0.5; 2]; 5]]);
    for i in 0..5u32 {
        let next = (i + 1) % 5;
        faces.push(vec![i, next, next + 5, i + 5]);
        let [from, to] = [i as f32 / 8.0, (i + 1) as f32 / 8.0];
        uvs.push(vec![[from, 0.0], [to, 0.0], [to, 0.25], [from, 0.25]]);
    }
    let values: Vec<[f32; 2]> = uvs.concat();
    obj.extend(values.iter().map(|[s, t]| format!("vt {s} {t}\n")));
    let mut next = 0;
    for face in &faces {
        let corner = |vertex: &u32| {
            next += 1;
            format!(" {}/{next}", vertex + 1)
        };
        obj += &format!("f{}\n", face.iter().map(corner).collect::<String>());
    }
    let expected = read_obj("a.obj", obj.as_bytes(), &LoadOptions::default()).unwrap().meshes.remove(0).control_mesh;

    // Every corner is a vertex of its own, in the order of the OBJ file's vertices.
    let mut corners: Vec<(u32, usize)> = faces.concat().into_iter().zip(0..).collect();
    corners.sort_unstable();
    let mut vertex_of = vec![0u32; corners.len()];
    corners.iter().zip(0u32..).for_each(|(&(_, corner), vertex)| vertex_of[corner] = vertex);
    let mut file = File::new();
    let split: Vec<[f32; 3]> = corners.iter().map(|&(vertex, _)| positions[vertex as usize]).collect();
    let split_uvs: Vec<[f32; 2]> = corners.iter().map(|&(_, corner)| values[corner]).collect();
    let sizes: Vec<u32> = faces.iter().map(|face| face.len() as u32).collect();
    let (triangles, turned_count) = encode(polygons(&sizes, &vertex_of).iter().map(Vec::as_slice));
    assert_eq!(turned_count, 0);
    let mesh = file.mesh(&split, &triangles);
    let uv = file.floats(&split_uvs);
    file.primitive(mesh)["attributes"]["TEXCOORD_0"] = json!(uv);
    keep_ngons(&mut file, mesh);
    file.root(json!({ "mesh": mesh }));
    let found = file.scene().meshes.remove(0).control_mesh;

    assert_eq!((&found.positions, &found.face_sizes), (&expected.positions, &expected.face_sizes));
    assert_eq!(found.face_vertices, expected.face_vertices);
    let at_corners = |mesh: &ControlMesh| -> Vec<[f32; 2]> {
        let channel = &mesh.face_varying[0];
        channel.indices.iter().map(|&index| channel.values[index as usize]).collect()
    };
    assert_eq!(at_corners(&found), at_corners(&expected));
    let channel = &found.face_varying[0];
    // Six columns of two values each, and the pentagon's one.
    assert_eq!((channel.name.as_str(), channel.values.len()), ("st", 13));
}
