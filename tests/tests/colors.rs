//! Colours of vertices are what the f64 evaluator makes of them as if they were positions, or bilinear in each Ptex face:
//! in dumps, in layers, and by every method.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use planish_generate::random::Random;
use planish_scene::{LoadOptions, load};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::EditOperation;
use planish_tests::folder::temporary;
use planish_tests::layers::Layers;
use planish_tests::parallel::check_all;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::{is_edited, scene};
use serde_json::json;

/// How far colours may be off, of the largest.
const TOLERANCE: f64 = 2e-6;

/// Every kind of feature: extraordinary vertices, boundaries by each rule, n-gons, creases, corners, holes, edits, and what is not
/// manifold.
const SCENES: [&str; 20] = [
    "adjacent_extraordinary",
    "boundary_none",
    "boundary_edge_only_creased",
    "boundary_valences",
    "chaikin_crossing",
    "corner_1_5_crease_2_3",
    "crease_2_3",
    "crease_infinite_extraordinary",
    "crease_mixed_3",
    "cube_all_semisharp",
    "edit_edge_sharpness_set",
    "edit_hole_ngon",
    "edit_vertex_layers",
    "edit_vertex_set_2",
    "hole_ngon",
    "mixed_triangles_quads",
    "ngon_40",
    "nonmanifold_sectors",
    "smooth_triangles_creased",
    "valence_7",
];

/// By every method, with and without transition patches, crease patches and watertight seams.
const WAYS: [&str; 5] = [
    "--tess 5.3",
    "--tess 6 --method fas --spacing equal --crease-patches single",
    "--edge-pixels 5 --size 160x90 --crease-patches single",
    "--edge-pixels 5 --size 160x90 --spacing fractional-even --no-watertight",
    "--tess 8 --method uniform --max-level 2",
];

/// Affine functions of positions.
fn affine([x, y, z]: [f64; 3]) -> [f64; 3] {
    [0.5 * x - 0.25 * y + 0.75, 0.25 - 0.5 * z + 0.125 * x, 1.5 * y + 0.25 * z - 1.0]
}

/// Writes a mesh whose vertices have these colours, with a further line; by their positions, in turn.
fn write_colored(mesh: &Path, folder: &Path, tag: &str, mut color: impl FnMut([f64; 3]) -> [f64; 3]) -> PathBuf {
    let mut text = String::new();
    for line in fs::read_to_string(mesh).expect("scenes can be read").lines() {
        text.push_str(line);
        if let Some(numbers) = line.strip_prefix("v ") {
            let position: Vec<f64> = numbers.split_whitespace().map(|word| word.parse().expect("a number")).collect();
            let [r, g, b] = color([position[0], position[1], position[2]]);
            write!(text, " {r} {g} {b}").expect("a string takes all");
        }
        text.push('\n');
    }
    let path = folder.join(mesh.file_name().expect("a scene has a name"));
    fs::write(&path, format!("{text}{tag}\n")).expect("a temporary file can be written");
    path
}

/// Any colour, some of them beyond 0 and 1.
fn random_color(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| 3.0 * random.unit() - 1.0)
}

fn dumped(mesh: &Path, flags: &str) -> Result<Vec<Vertex>, String> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let outcome = Planish::dump(mesh, &path).flags(flags).run().silent_success()?;
    let dump = Dump::read(&path)?;
    if !dump.properties.colors || dump.vertices().len() == 0 {
        return Err(outcome.told("expected a dump with colours"));
    }
    Ok(dump.vertices().collect())
}

fn control_mesh(mesh: &Path) -> ControlMesh {
    load(mesh, &LoadOptions::default()).expect("scenes can be read").meshes.remove(0).control_mesh
}

fn colors_of(mesh: &ControlMesh) -> &[[f32; 3]] {
    &mesh.colors.as_ref().expect("the mesh has colours").values
}

/// Compares vertices with the colours that are expected of them; none is expected where the evaluator knows no surface.
fn compare(
    vertices: &[Vertex],
    mesh: &ControlMesh,
    mut expected: impl FnMut(&Vertex) -> Option<[f64; 3]>,
) -> Result<(), String> {
    let largest = colors_of(mesh).iter().flatten().fold(0.0_f64, |largest, c| largest.max(f64::from(c.abs())));
    let mut compared = 0;
    for vertex in vertices {
        let Some(color) = expected(vertex) else { continue };
        compared += 1;
        let errors = color.iter().zip(vertex.color).map(|(expected, found)| (expected - f64::from(found)).abs());
        let worst = errors.fold(0.0, f64::max) / largest;
        if worst.is_nan() || worst > TOLERANCE {
            return Err(format!("off by {worst}: {vertex:?}, expected {color:?}"));
        }
    }
    if 10 * compared > 9 * vertices.len() { Ok(()) } else { Err(format!("{compared} of {} compared", vertices.len())) }
}

/// Every scene in two of the ways, so that every way has scenes of all kinds; and patches that are cut.
fn cases() -> Vec<(PathBuf, &'static str)> {
    let ways = |index: usize| [index, index + 2].map(|way| WAYS[way % WAYS.len()]);
    let scenes = SCENES.iter().enumerate().flat_map(|(index, name)| ways(index).map(|way| (scene(name), way)));
    scenes.chain([(scene("strip_1x5"), "--tess 70")]).collect()
}

#[test]
fn colours_that_are_affine_in_the_position_are_so_on_the_surface() {
    let cases: Vec<_> = cases().into_iter().filter(|(mesh, _)| !is_edited(mesh)).collect();
    check_all(&cases, |(mesh, way)| {
        let folder = temporary();
        let path = write_colored(mesh, folder.path(), "", affine);
        compare(&dumped(&path, way)?, &control_mesh(&path), |vertex| Some(affine(vertex.position.map(f64::from))))
            .map_err(|fault| format!("{} {way}: {fault}", mesh.display()))
    });
}

#[test]
fn colours_of_gregory_patches_are_made_as_their_points_are() {
    // Where nothing is semi-sharp: edge points there are projected, colours are not.
    let names = [
        "adjacent_extraordinary",
        "boundary_valences",
        "crease_infinite_extraordinary",
        "mixed_triangles_quads",
        "ngon_40",
    ];
    let ways = [
        "--tess 5.3 --method gregory",
        "--tess 4 --method gregory --gregory stencil",
        "--tess 9 --max-level 1 --end-cap gregory",
    ];
    let cases: Vec<_> = names.into_iter().zip(ways.into_iter().cycle()).collect();
    check_all(&cases, |(name, way)| {
        let folder = temporary();
        let path = write_colored(&scene(name), folder.path(), "", affine);
        let vertices = dumped(&path, way)?;
        if !vertices.iter().any(|vertex| vertex.kind >= 3) {
            return Err(format!("{name} {way}: no Gregory patches"));
        }
        compare(&vertices, &control_mesh(&path), |vertex| Some(affine(vertex.position.map(f64::from))))
            .map_err(|fault| format!("{name} {way}: {fault}"))
    });
}

/// The mesh whose positions are the colours. Edits that move points move none of them, but refine as they do.
fn as_positions(mesh: &ControlMesh) -> ControlMesh {
    let mut result = ControlMesh { positions: colors_of(mesh).to_vec(), ..mesh.clone() };
    for edit in &mut result.edits {
        if matches!(edit.operation, EditOperation::SetPosition(_) | EditOperation::AddPosition(_)) {
            edit.operation = EditOperation::AddPosition([0.0; 3]);
        }
    }
    result
}

#[test]
fn vertex_colours_are_the_limit_of_a_cage_with_these_positions() {
    check_all(&cases(), |(mesh, way)| {
        let (folder, mut random) = (temporary(), Random::new(5));
        let path = write_colored(mesh, folder.path(), "", |_| random_color(&mut random));
        let cage = control_mesh(&path);
        let mut evaluator = Evaluator::new(&as_positions(&cage)).expect("scenes are legal");
        let mut vertices = dumped(&path, way)?;
        // Faces one after another: the evaluator keeps what it made for the last.
        vertices.sort_by_key(|vertex| vertex.face);
        compare(&vertices, &cage, |vertex| {
            let [u, v] = vertex.uv.map(f64::from);
            evaluator.evaluate(vertex.face, u, v).map(|point| point.position)
        })
        .map_err(|fault| format!("{} {way}: {fault}", mesh.display()))
    });
}

fn mean(colors: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|c| colors.iter().map(|color| color[c]).sum::<f64>() / colors.len() as f64)
}

/// The colours at (0, 0), (1, 0), (1, 1) and (0, 1) of each Ptex face.
fn ptex_corners(mesh: &ControlMesh) -> Vec<[[f64; 3]; 4]> {
    let mut rest = mesh.face_vertices.as_slice();
    let mut corners = Vec::new();
    for &sides in &mesh.face_sizes {
        let (face, after) = rest.split_at(sides as usize);
        rest = after;
        let colors: Vec<[f64; 3]> = face.iter().map(|&v| colors_of(mesh)[v as usize].map(f64::from)).collect();
        if let &[a, b, c, d] = colors.as_slice() {
            corners.push([a, b, c, d]);
            continue;
        }
        let at = |i: usize| colors[i % colors.len()];
        corners.extend((0..colors.len()).map(|i| {
            let (own, next, previous) = (at(i), at(i + 1), at(i + colors.len() - 1));
            [own, mean(&[own, next]), mean(&colors), mean(&[own, previous])]
        }));
    }
    corners
}

fn bilinear(corners: &[[f64; 3]; 4], [u, v]: [f64; 2]) -> [f64; 3] {
    let [a, b, c, d] = corners;
    std::array::from_fn(|i| (1.0 - v) * ((1.0 - u) * a[i] + u * b[i]) + v * ((1.0 - u) * d[i] + u * c[i]))
}

const VARYING: &str = "t colorinterpolation 1/0/0 1";

#[test]
fn varying_colours_are_bilinear_in_each_ptex_face() {
    check_all(&cases(), |(mesh, way)| {
        let (folder, mut random) = (temporary(), Random::new(6));
        let path = write_colored(mesh, folder.path(), VARYING, |_| random_color(&mut random));
        let cage = control_mesh(&path);
        let corners = ptex_corners(&cage);
        compare(&dumped(&path, way)?, &cage, |vertex| {
            Some(bilinear(&corners[vertex.face as usize], vertex.uv.map(f64::from)))
        })
        .map_err(|fault| format!("{} {way}: {fault}", mesh.display()))
    });
}

/// Vertices by what is the same whatever the positions are.
fn by_place(vertices: &[Vertex]) -> HashMap<(u32, [u32; 2], u8, u8), Vertex> {
    let key = |vertex: &Vertex| (vertex.face, vertex.uv.map(f32::to_bits), vertex.level, vertex.kind);
    vertices.iter().map(|vertex| (key(vertex), *vertex)).collect()
}

/// Two dumps have the same places, the same colours there, and other positions here and there.
fn have_same_colors(one: &[Vertex], other: &[Vertex]) {
    let (one, other) = (by_place(one), by_place(other));
    assert_eq!(one.len(), other.len());
    for (place, vertex) in &one {
        assert_eq!(vertex.color, other[place].color, "{vertex:?}");
    }
    assert!(one.iter().any(|(place, vertex)| vertex.position != other[place].position));
}

#[test]
fn edits_of_positions_leave_colours_alone() {
    let (folder, mut random) = (temporary(), Random::new(7));
    let mesh = write_colored(&scene("cube"), folder.path(), "", |_| random_color(&mut random));
    let text = fs::read_to_string(&mesh).unwrap();
    let with_edits = |by: f64, to: &str| {
        let edits =
            format!("t vertexedit 4/3/3 3 0 2 0 0 0 {by} add P value\nt vertexedit 5/3/3 4 3 1 2 1 {to} P value\n");
        fs::write(&mesh, format!("{text}{edits}")).unwrap();
        dumped(&mesh, "--tess 7").unwrap()
    };
    have_same_colors(&with_edits(0.0, "0 0 0 add"), &with_edits(0.5, "0.3 -1 0.2 set"));
}

#[test]
fn displacement_leaves_colours_alone() {
    let (folder, mut random) = (temporary(), Random::new(8));
    let map = folder.path().join("map.png");
    image::GrayImage::from_fn(8, 8, |x, y| image::Luma([(31 * x + 17 * y * y) as u8])).save(&map).unwrap();
    let displaced = format!("--tess 6.5 --displacement {} --displacement-scale 0.2", map.display());
    let meshes = ["uv_continuous", "uv_crease_across"].map(scene);
    for mesh in meshes {
        let path = write_colored(&mesh, folder.path(), "", |_| random_color(&mut random));
        let (still, moved) = (dumped(&path, "--tess 6.5").unwrap(), dumped(&path, &displaced).unwrap());
        // Creases are refined as deep; what patches are made of differs where texture coordinates ask for more.
        let colors = |vertices: &[Vertex]| -> HashMap<(u32, [u32; 2]), [f32; 3]> {
            vertices.iter().map(|vertex| ((vertex.face, vertex.uv.map(f32::to_bits)), vertex.color)).collect()
        };
        let (still, moved) = (colors(&still), colors(&moved));
        let common = still.iter().filter_map(|(place, color)| Some((color, moved.get(place)?)));
        let errors = common.map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max));
        let errors: Vec<f32> = errors.collect();
        assert!(2 * errors.len() > still.len(), "{} of {} places in common", errors.len(), still.len());
        assert!(errors.into_iter().fold(0.0, f32::max) < 2.0 * TOLERANCE as f32, "{}", mesh.display());
    }
}

/// A scene of meshes with colours of both interpolations and one without, some of them at several places.
fn write_scene(folder: &Path) -> PathBuf {
    write_colored(&scene("valence_7"), folder, "", affine);
    write_colored(&scene("mixed_triangles_quads"), folder, VARYING, affine);
    fs::copy(scene("cube"), folder.join("cube.obj")).unwrap();
    let path = folder.join("scene.json");
    let files = ["valence_7", "cube", "mixed_triangles_quads"];
    let meshes = files.map(|name| json!({"name": name, "file": format!("{name}.obj")}));
    let instances = json!([
        {"mesh": "cube"}, {"mesh": "valence_7", "translate": [3, 4, 5]}, {"mesh": "mixed_triangles_quads"},
        {"mesh": "cube", "scale": [-1, 1, 1]}, {"mesh": "mixed_triangles_quads", "translate": [9, 0, 0]},
        {"mesh": "valence_7", "scale": [-2, 2, 2]}
    ]);
    fs::write(&path, json!({"meshes": meshes, "instances": instances}).to_string()).unwrap();
    path
}

#[test]
fn every_instance_has_its_meshs_colours_and_those_without_are_white() {
    let folder = temporary();
    let path = write_scene(folder.path());
    let meshes =
        ["valence_7", "mixed_triangles_quads"].map(|name| control_mesh(&folder.path().join(format!("{name}.obj"))));
    let corners = ptex_corners(&meshes[1]);
    let order =
        [("cube", 6), ("disc", 28), ("mixed", corners.len()), ("cube", 6), ("mixed", corners.len()), ("disc", 28)];
    assert_eq!(meshes[0].face_sizes.len(), 28);
    for way in ["--tess 4.5", "--tess 4 --method fas"] {
        let vertices = dumped(&path, way).unwrap();
        let mut first = 0;
        for (number, &(name, count)) in order.iter().enumerate() {
            let faces = first..first + count as u32;
            let own: Vec<Vertex> = vertices.iter().filter(|vertex| faces.contains(&vertex.face)).copied().collect();
            assert!(own.len() > 100, "{name}");
            match name {
                "cube" => assert!(own.iter().all(|vertex| vertex.color == [1.0; 3])),
                "disc" => {
                    let back = |[x, y, z]: [f64; 3]| {
                        if number == 1 { [x - 3.0, y - 4.0, z - 5.0] } else { [-0.5 * x, 0.5 * y, 0.5 * z] }
                    };
                    compare(&own, &meshes[0], |vertex| Some(affine(back(vertex.position.map(f64::from))))).unwrap();
                }
                _ => compare(&own, &meshes[1], |vertex| {
                    Some(bilinear(&corners[(vertex.face - first) as usize], vertex.uv.map(f64::from)))
                })
                .unwrap(),
            }
            first = faces.end;
        }
    }
}

/// The layers of an image of a mesh.
fn layers(mesh: &Path, flags: &str) -> Layers {
    let folder = temporary();
    let image = folder.path().join("out.exr");
    Planish::render(mesh, &image).flags("--size 64x48").flags(flags).run().silent_success().unwrap();
    Layers::read(&image)
}

#[test]
fn the_layer_has_the_colours_of_the_points_that_are_seen_and_the_view_shows_them() {
    const RGB: [&str; 3] = ["R", "G", "B"];
    let folder = temporary();
    let mesh = write_colored(&scene("mixed_triangles_quads"), folder.path(), "", affine);
    for way in ["--tess 5.3", "--edge-pixels 4", "--tess 4 --method uniform --max-level 2"] {
        let found = layers(&mesh, &format!("{way} --aov p,color,face --view color"));
        let (points, colors) = (found.vectors("P", ["X", "Y", "Z"]), found.vectors("color", RGB));
        let beauty = RGB.map(|name| found.floats(name));
        let mut seen = 0;
        for (pixel, &face) in found.integers("face").iter().enumerate() {
            if face == u32::MAX {
                assert_eq!((colors[pixel], beauty[0][pixel]), ([0.0; 3], 0.0));
                continue;
            }
            seen += 1;
            let expected = affine(points[pixel].map(f64::from));
            for c in 0..3 {
                let color = f64::from(colors[pixel][c]);
                // Rasterizers interpolate each value by itself, in floats.
                assert!((color - expected[c]).abs() < 1e-4, "{way} {pixel}: {color}, expected {}", expected[c]);
                // The beauty image has halves, rounded in any way.
                let shown = f64::from(beauty[c][pixel]);
                assert!((shown - color).abs() <= color.abs() / 1024.0 + 1e-7, "{way} {pixel}: {shown} of {color}");
            }
        }
        assert!(seen > 100, "{seen} pixels");
    }
}

#[test]
fn meshes_without_colours_are_white() {
    for way in ["", "--method uniform --tess 4 --max-level 2"] {
        let found = layers(&scene("cube"), &format!("{way} --aov color --view color"));
        let (colors, alpha) = (found.vectors("color", ["R", "G", "B"]), found.floats("A"));
        assert!(alpha.contains(&1.0));
        let is_white = |color: [f32; 3], alpha: f32| color.iter().all(|c| (c - alpha).abs() < 1e-6);
        assert!(colors.iter().zip(alpha).all(|(&color, alpha)| is_white(color, alpha)));
    }
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    Planish::dump(&scene("cube"), &path).flags("--tess 2").run().silent_success().unwrap();
    assert!(!Dump::read(&path).unwrap().properties.colors);
}

#[test]
fn other_layers_and_views_are_the_same_beside_colours() {
    let folder = temporary();
    let mesh = write_colored(&scene("mixed_triangles_quads"), folder.path(), "", affine);
    let [plain, colored] = ["p,n,z", "p,n,z,color"].map(|aov| layers(&mesh, &format!("--tess 5.3 --aov {aov}")));
    for name in ["R", "G", "B", "A", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z"] {
        assert_eq!(plain.floats(name), colored.floats(name), "{name}");
    }
}

#[test]
fn info_tells_of_colours() {
    let folder = temporary();
    for (tag, expected) in [("", json!("vertex")), (VARYING, json!("varying"))] {
        let mesh = write_colored(&scene("cube"), folder.path(), tag, affine);
        let info = Planish::info(&mesh).run().silent_success().unwrap().json().unwrap();
        assert_eq!(info["features"]["colors"], expected);
    }
    let info = Planish::info(&scene("cube")).run().silent_success().unwrap().json().unwrap();
    assert_eq!(info["features"]["colors"], json!(null));
}

#[test]
fn vertices_without_a_colour_among_others_are_warned_of_once() {
    let folder = temporary();
    let mesh = folder.path().join("mesh.obj");
    fs::write(&mesh, "v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n").unwrap();
    let outcome = Planish::info(&mesh).run();
    let lines: Vec<&str> = outcome.stderr.lines().collect();
    assert!(outcome.status.success() && lines.len() == 1, "{}", outcome.stderr);
    assert!(lines[0].ends_with("mesh.obj: 3 of 4 vertices have no colour: white"), "{}", lines[0]);
}
