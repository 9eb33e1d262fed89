//! The files in `scenes/` are what the generator makes, can be read, and show what their names say.
use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;

use planish_generate::cage::Cage;
use planish_generate::random_cage::manifold::is_manifold;
use planish_generate::scenes::{SCHEMES_FOLDER, SceneFile, all, gltf, of_schemes, placed};
use planish_generate::{large, sectors, solids, terrain};

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn named(name: &str) -> Cage {
    all().into_iter().find(|file| file.name == name).expect(name).cage
}

/// Every directed edge and the number of faces that have it.
fn directed_edges(cage: &Cage) -> HashMap<[u32; 2], u32> {
    let mut edges = HashMap::new();
    for face in &cage.faces {
        for (i, &from) in face.iter().enumerate() {
            *edges.entry([from, face[(i + 1) % face.len()]]).or_insert(0) += 1;
        }
    }
    edges
}

fn boundary_edges(cage: &Cage) -> Vec<[u32; 2]> {
    let edges = directed_edges(cage);
    edges.keys().copied().filter(|&[from, to]| !edges.contains_key(&[to, from])).collect()
}

/// What surrounds a vertex.
#[derive(Clone, Default)]
struct Around {
    face_count: u32,
    edge_count: u32,
    on_boundary: bool,
}

fn around_vertices(cage: &Cage) -> Vec<Around> {
    let mut around = vec![Around::default(); cage.positions.len()];
    for face in &cage.faces {
        face.iter().for_each(|&vertex| around[vertex as usize].face_count += 1);
    }
    for [from, to] in boundary_edges(cage) {
        [from, to].iter().for_each(|&vertex| around[vertex as usize].on_boundary = true);
    }
    for vertex in &mut around {
        vertex.edge_count = vertex.face_count + u32::from(vertex.on_boundary);
    }
    around
}

/// Interior vertices whose valence is not 4, as valences in ascending order.
fn extraordinary(cage: &Cage) -> Vec<u32> {
    let inner = around_vertices(cage).into_iter().filter(|vertex| !vertex.on_boundary && vertex.face_count != 4);
    let mut valences: Vec<u32> = inner.map(|vertex| vertex.face_count).collect();
    valences.sort_unstable();
    valences
}

fn irregular_share(cage: &Cage) -> f64 {
    let around = around_vertices(cage);
    let regular = |&vertex: &u32| around[vertex as usize].face_count == 4;
    let irregular = cage.faces.iter().filter(|face| face.len() != 4 || !face.iter().all(regular));
    irregular.count() as f64 / cage.faces.len() as f64
}

fn volume(cage: &Cage) -> f64 {
    let tetrahedron = |face: &Vec<u32>, i: usize| {
        let [a, b, c] = [0, i, i + 1].map(|corner| cage.positions[face[corner] as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    cage.faces.iter().map(|face| (1..face.len() - 1).map(|i| tetrahedron(face, i)).sum::<f64>()).sum()
}

/// The connected parts of a mesh, in the order of their first faces.
fn components(cage: &Cage) -> Vec<Cage> {
    let mut part_of: Vec<u32> = (0..cage.positions.len() as u32).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for face in &cage.faces {
            let least = face.iter().map(|&vertex| part_of[vertex as usize]).min().unwrap();
            for &vertex in face {
                changed |= std::mem::replace(&mut part_of[vertex as usize], least) != least;
            }
        }
    }
    let mut parts: Vec<(u32, Cage)> = Vec::new();
    for face in &cage.faces {
        let part = part_of[face[0] as usize];
        let known = parts.iter().position(|&(known, _)| known == part);
        let place = known.unwrap_or_else(|| {
            parts.push((part, Cage { positions: cage.positions.clone(), ..Cage::default() }));
            parts.len() - 1
        });
        parts[place].1.faces.push(face.clone());
    }
    parts.into_iter().map(|(_, part)| part.welded(1e-6)).collect()
}

/// The genus of a closed connected mesh, by Euler's formula.
fn genus(cage: &Cage) -> i64 {
    let edge_count = directed_edges(cage).len() as i64 / 2;
    (2 - (cage.positions.len() as i64 - edge_count + cage.faces.len() as i64)) / 2
}

#[test]
fn committed_files_are_what_the_generator_makes() {
    let files = all();
    for SceneFile { name, .. } in &files {
        assert!(folder().join(format!("{name}.obj")).exists(), "{name}.obj is missing: planish-generate scenes scenes");
    }
    for file in &files {
        let committed = std::fs::read_to_string(folder().join(file.file_name())).unwrap();
        assert!(committed == file.text(), "{}.obj is stale: planish-generate scenes scenes", file.name);
    }
    for (name, scene) in placed() {
        let committed = std::fs::read_to_string(folder().join(format!("{name}.json"))).unwrap();
        assert!(committed == scene.to_json(), "{name}.json is stale: planish-generate scenes scenes");
    }
    for (name, scene) in gltf() {
        let committed = |extension: &str| std::fs::read(folder().join(format!("{name}.{extension}"))).unwrap();
        assert!(
            committed("gltf") == scene.to_gltf().into_bytes(),
            "{name}.gltf is stale: planish-generate scenes scenes"
        );
        assert!(committed("glb") == scene.to_glb(), "{name}.glb is stale: planish-generate scenes scenes");
    }
    let schemes = folder().join(SCHEMES_FOLDER);
    for file in of_schemes() {
        let committed = std::fs::read_to_string(schemes.join(file.file_name())).unwrap_or_default();
        assert!(committed == file.text(), "schemes/{}.obj is stale: planish-generate scenes scenes", file.name);
    }
    assert_eq!(std::fs::read_dir(schemes).unwrap().count(), of_schemes().len(), "scenes/schemes/ has another file");
    let on_disk = |wanted: &str| {
        let entries = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.extension().is_some_and(|extension| extension == wanted)).count()
    };
    let made = [files.len(), placed().len(), gltf().len(), gltf().len()];
    assert_eq!(
        ["obj", "json", "gltf", "glb"].map(on_disk),
        made,
        "scenes/ has a file that the generator does not make"
    );
}

#[test]
fn every_file_is_read_without_a_warning_and_can_be_subdivided() {
    for file in all().into_iter().chain(of_schemes()) {
        let options = planish_scene::LoadOptions::default();
        let scene = planish_scene::read_obj(file.file_name(), file.text().as_bytes(), &options).unwrap();
        assert_eq!(scene.warnings, [], "{}", file.name);
        scene.meshes[0].control_mesh.validate().unwrap();
        assert_eq!(scene.meshes[0].control_mesh.positions.len(), file.cage.positions.len());
        scene.default_view().unwrap();
    }
}

/// Whether a mesh is named after what makes it no manifold.
fn is_meant_non_manifold(name: &str) -> bool {
    name.starts_with("nonmanifold_") || name == "duplicate_quad"
}

#[test]
fn meshes_are_manifold_and_consistently_oriented_unless_their_names_say_otherwise() {
    for file in all().into_iter().chain(of_schemes()) {
        assert_eq!(is_manifold(&file.cage.faces), !is_meant_non_manifold(&file.name), "{}", file.name);
    }
}

#[test]
fn vertices_without_faces_are_in_one_mesh_only() {
    for file in all() {
        let unused = around_vertices(&file.cage).iter().filter(|vertex| vertex.face_count == 0).count();
        assert_eq!(unused, if file.name == "unused_vertices" { 2 } else { 0 }, "{}", file.name);
    }
}

#[test]
fn closed_meshes_have_their_outside_outside() {
    let mut closed_count = 0;
    let has_inside = |file: &&SceneFile| !["double_sided_quad", "flat_pair"].contains(&file.name.as_str());
    for file in all().iter().filter(|file| boundary_edges(&file.cage).is_empty()).filter(has_inside) {
        assert!(volume(&file.cage) > 0.0, "{}", file.name);
        closed_count += 1;
    }
    assert!(closed_count >= 9);
}

#[test]
fn hero_is_seven_outward_bodies_on_one_sheet_of_at_most_3000_faces() {
    let hero = named("hero");
    assert!(hero.faces.len() <= 3000);
    let parts = components(&hero);
    let (open, closed): (Vec<_>, Vec<_>) = parts.iter().partition(|part| !boundary_edges(part).is_empty());
    assert_eq!((open.len(), closed.len()), (1, 7));
    assert!(closed.iter().all(|part| volume(part) > 0.0));
    // The jug has a handle and the anvil a hole; each of the two bands is a torus.
    let mut genera: Vec<i64> = closed.iter().map(|part| genus(part)).collect();
    genera.sort_unstable();
    assert_eq!(genera, [0, 0, 0, 1, 1, 1, 1]);
}

#[test]
fn two_components_are_two_and_genus_2_is_of_genus_2() {
    assert_eq!(components(&named("two_components")).iter().map(genus).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(components(&named("genus_2")).iter().map(genus).collect::<Vec<_>>(), [2]);
}

#[test]
fn sheets_have_their_outside_above() {
    let names = [
        "valence_2",
        "valence_5",
        "valence_360",
        "ngon_3",
        "ngon_40",
        "boundary_valences",
        "boundary_none",
        "grid_8x8",
    ];
    for (name, cage) in names.map(|name| (name, named(name))) {
        for face in &cage.faces {
            let corners = face.iter().map(|&vertex| cage.positions[vertex as usize]);
            let area: glam::DVec3 = corners.clone().zip(corners.cycle().skip(1)).map(|(a, b)| a.cross(b)).sum();
            assert!(area.y > 0.0, "{name}: {face:?}");
        }
    }
}

#[test]
fn open_cylinder_has_its_outside_away_from_its_axis() {
    let cage = named("open_cylinder");
    for face in &cage.faces {
        let [a, b, c] = [0, 1, 2].map(|i| cage.positions[face[i] as usize]);
        assert!((b - a).cross(c - b).dot((a + c) * glam::DVec3::new(1.0, 0.0, 1.0)) > 0.0);
    }
}

#[test]
fn valence_meshes_have_one_extraordinary_vertex() {
    for valence in [2, 3, 5, 6, 7, 40, 360] {
        assert_eq!(extraordinary(&named(&format!("valence_{valence}"))), [valence]);
    }
    assert_eq!(extraordinary(&named("valence_2_closed")), [2, 3, 3, 3, 3, 3, 3]);
}

#[test]
fn ngon_meshes_have_one_ngon_and_no_extraordinary_vertex() {
    for sides in [3, 5, 6, 40] {
        let cage = named(&format!("ngon_{sides}"));
        let ngons: Vec<usize> = cage.faces.iter().map(Vec::len).filter(|&size| size != 4).collect();
        assert_eq!((ngons, extraordinary(&cage)), (vec![sides], vec![]));
    }
}

#[test]
fn boundary_valences_cover_2_to_21() {
    let around = around_vertices(&named("boundary_valences"));
    for valence in 2..=21 {
        assert!(around.iter().any(|vertex| vertex.on_boundary && vertex.edge_count == valence), "{valence}");
    }
    let largest = around_vertices(&named("boundary_valence_20")).iter().map(|vertex| vertex.edge_count).max();
    assert_eq!(largest, Some(20));
    assert!(extraordinary(&sectors::fan(7)).is_empty());
}

#[test]
fn all_regular_meshes_are_regular() {
    for cage in [named("torus_32"), solids::torus(3, 5)] {
        assert_eq!(irregular_share(&cage), 0.0);
    }
    assert_eq!(named("torus_32").faces.len(), 32);
}

#[test]
fn crowded_sphere_has_many_valences_and_hardly_a_regular_face() {
    let cage = named("adjacent_extraordinary");
    let mut valences = extraordinary(&cage);
    valences.dedup();
    assert_eq!(valences, [3, 5, 6, 7]);
    assert!(irregular_share(&cage) > 0.9);
    let around = around_vertices(&cage);
    let odd = |vertex: u32| around[vertex as usize].face_count != 4;
    let side_by_side = directed_edges(&cage).keys().filter(|&&[a, b]| odd(a) && odd(b)).count();
    assert!(side_by_side > 40, "{side_by_side}");
}

#[test]
fn blob_has_the_faces_and_about_the_irregular_share_asked_for() {
    for (face_count, share) in [(6_000, 0.1), (250_000, 0.15), (60_000, 0.3)] {
        let cage = large::blob(face_count, share);
        assert!(cage.faces.len() as f64 > 0.95 * f64::from(face_count) && cage.faces.len() <= face_count as usize);
        assert!(boundary_edges(&cage).is_empty());
        assert!(directed_edges(&cage).values().all(|&count| count == 1));
        let found = irregular_share(&cage);
        assert!((found - share).abs() < 0.25 * share, "asked for {share}, found {found}");
    }
}

#[test]
fn terrain_is_a_regular_grid_of_the_size_asked_for() {
    let cage = terrain::terrain(250_000, 0.0);
    assert_eq!((cage.faces.len(), extraordinary(&cage).len()), (250_000, 0));
}

#[test]
fn vertices_coincide_only_where_names_say_so() {
    let degenerate = ["coincident_vertices", "zero_area_face", "flat_pair", "unused_vertices"];
    for file in all().iter().filter(|file| !degenerate.contains(&file.name.as_str())) {
        assert_eq!(file.cage.clone().welded(1e-4).positions.len(), file.cage.positions.len(), "{}", file.name);
    }
}

#[test]
fn meshes_for_schemes_of_triangles_have_the_faces_and_vertices_that_they_are_named_after() {
    let named = |name: &str| of_schemes().into_iter().find(|file| file.name == name).expect(name).cage;
    for SceneFile { name, cage, .. } in of_schemes() {
        let sides = |count: usize| cage.faces.iter().filter(|face| face.len() == count).count();
        assert_eq!(sides(3) + sides(4), cage.faces.len(), "{name}");
        assert_eq!(sides(4) == 0, name.starts_with("loop_"), "{name}");
        assert!(sides(3) > 0, "{name}");
    }
    for name in ["loop_valences", "loop_creased", "stam_mixed", "stam_rocket"] {
        assert_eq!(boundary_edges(&named(name)), Vec::<[u32; 2]>::new(), "{name}");
    }
    let valences: BTreeSet<u32> =
        around_vertices(&named("loop_valences")).iter().map(|vertex| vertex.face_count).collect();
    assert_eq!(valences, (3..=9).collect());
    // Around a vertex of so many faces, which of them are quads, from whichever face on.
    let mixed = named("stam_mixed");
    let mut shares = BTreeSet::new();
    for vertex in 0..mixed.positions.len() as u32 {
        let at = mixed.faces.iter().filter(|face| face.contains(&vertex));
        let sides: Vec<usize> = at.map(Vec::len).collect();
        shares.insert((sides.iter().filter(|&&sides| sides == 4).count(), sides.len()));
    }
    assert!(shares.len() >= 8, "quads and faces around vertices: {shares:?}");
}
