//! Method table end to end, scheme by scheme: dumps are the limit surface and closed, images are the other methods', and what there are
//! no tables for is refused.

use std::path::{Path, PathBuf};

use planish_tests::cage::Cage;
use planish_tests::folder::temporary;
use planish_tests::judge;
use planish_tests::oracle::Report;
use planish_tests::parallel::check_all;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::{FAILED, Planish};
use planish_tests::repository::{is_about_rules, is_edited, root, scene, scenes, scheme_scene, stem};
use planish_tests::weld::{Weld, faults, unbalanced_edge_count};

const LOOP_SCENES: [&str; 5] = ["loop_valences", "loop_sheet", "loop_edge_only", "loop_chaikin", "loop_creased"];
const MIXED_SCENES: [&str; 3] = ["stam_mixed", "stam_sheet", "stam_rocket"];
/// Two views from near by.
const VIEWS: [&str; 2] = [
    "--edge-pixels 6 --size 320x200 --eye 2.1,1.4,3.3 --target 0.2,0.1,-0.1",
    "--edge-pixels 6 --size 320x200 --eye -3,0.4,0.7 --target 0,0.3,0",
];
/// How much a view changes the factors from edge to edge is what is tested, not how many there are.
const FACTORS: [&str; 3] = ["--tess 1", "--tess 5.3", "--tess 16"];

fn dump(mesh: &Path, flags: &str) -> Result<Vec<Vertex>, String> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    Planish::dump(mesh, &path).flags("--method table").flags(flags).run().silent_success()?;
    Ok(Dump::read(&path)?.vertices().collect())
}

/// Scenes by the schemes that take their faces.
fn of_schemes() -> Vec<(PathBuf, &'static str)> {
    let of = |names: &[&str], scheme: &'static str| {
        names.iter().map(|name| (scheme_scene(name), scheme)).collect::<Vec<_>>()
    };
    // Where every edge is of another sharpness few faces share a table: one scheme is enough there, and where boundaries differ alone.
    let of_loop = of(&LOOP_SCENES, "loop");
    let of_others =
        ["loop-stam", "butterfly"].map(|scheme| of(&["loop_valences", "loop_sheet", "loop_creased"], scheme));
    let mixed = [of(&MIXED_SCENES, "loop-stam"), of(&["stam_rocket"], "catmull-clark")];
    [of_loop, of_others.concat(), mixed.concat()].concat()
}

#[test]
fn catmull_clark_dumps_are_the_closed_limit_surface() {
    let mut meshes = scenes();
    // Colours that are subdivided are refused.
    meshes.retain(|mesh| !is_edited(mesh) && Cage::read(mesh).is_manifold());
    meshes.retain(|mesh| !stem(mesh).starts_with("nonmanifold_") && stem(mesh) != "color_vertex");
    assert!(meshes.len() > 100);
    // Rules are judged point by point without a device too: half of those scenes.
    let mut rules = 0;
    meshes.retain(|mesh| {
        rules += usize::from(is_about_rules(mesh));
        !is_about_rules(mesh) || rules.is_multiple_of(2)
    });
    check_all(&meshes, |mesh| judge::check(mesh, "--method table --tess 8"));
}

#[test]
fn catmull_clark_dumps_at_the_largest_factor_are_the_closed_limit_surface() {
    let meshes = ["cube", "valence_5", "boundary_edge_only", "crease_ngon_5"].map(scene);
    check_all(&meshes, |mesh| judge::check(mesh, "--method table --tess 64"));
}

#[test]
fn loop_dumps_are_opensubdiv_s_limit_surface() {
    let cases: Vec<_> =
        LOOP_SCENES.iter().flat_map(|name| ["--tess 2", "--tess 16"].map(|flags| (*name, flags))).collect();
    check_all(&cases, |(name, flags)| {
        let (mesh, folder) = (scheme_scene(name), temporary());
        let path = folder.path().join("dump.ply");
        let all = format!("--method table --scheme loop {flags}");
        let outcome = Planish::dump(&mesh, &path).flags(&all).run().silent_success()?;
        let faults = Report::of(&mesh, &path)?.faults(0);
        if faults.is_empty() { Ok(()) } else { Err(outcome.told(&faults.join("\n  "))) }
    });
}

#[test]
fn another_scheme_s_surface_is_not_taken_for_loop_s() {
    let (mesh, folder) = (scheme_scene("loop_valences"), temporary());
    let path = folder.path().join("dump.ply");
    Planish::dump(&mesh, &path).flags("--method table --scheme butterfly --tess 4").run().silent_success().unwrap();
    let faults = Report::of(&mesh, &path).unwrap().faults(0);
    assert!(faults.iter().any(|fault| fault.starts_with("max_pos_err_rel")), "{faults:?}");
}

/// Edges of a mesh that one face has.
fn boundary_edge_count(cage: &Cage) -> usize {
    let edges = || cage.faces.iter().flat_map(|face| (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]]));
    let all: std::collections::HashSet<[usize; 2]> = edges().collect();
    all.iter().filter(|[a, b]| !all.contains(&[*b, *a])).count()
}

#[test]
fn dumps_of_every_scheme_are_welded() {
    // Halves of edges have half the factor, and points of the next power of two.
    let segments = [2, 8, 16];
    let mut cases: Vec<_> = of_schemes().into_iter().flat_map(|case| (0..3).map(move |i| (case.clone(), i))).collect();
    // Tables of sheets take the longest, and do not know what factors they are for.
    cases.retain(|((mesh, _), i)| *i == 1 || boundary_edge_count(&Cage::read(mesh)) == 0);
    check_all(&cases, |((mesh, scheme), i)| {
        let flags = format!("--scheme {scheme} {}", FACTORS[*i]);
        let (vertices, cage) = (dump(mesh, &flags)?, Cage::read(mesh));
        let told = |what: &str| format!("{} {flags}: {what}", mesh.display());
        check_closed(&vertices, &cage).map_err(|what| told(&what))?;
        let (open, expected) = (unbalanced_edge_count(&vertices), segments[*i] * boundary_edge_count(&cage));
        if open == expected { Ok(()) } else { Err(told(&format!("{open} open edges, expected {expected}"))) }
    });
}

/// Unless a closed mesh' triangles meet edge to edge by positions, and of smooth ones by normals too.
fn check_closed(vertices: &[Vertex], cage: &Cage) -> Result<(), String> {
    if boundary_edge_count(cage) > 0 {
        return Ok(());
    }
    let mut found = faults(vertices, cage, Weld::Position);
    if cage.is_smooth() {
        found.extend(faults(vertices, cage, Weld::PositionAndNormal));
    }
    if found.is_empty() { Ok(()) } else { Err(format!("{} faults, the first: {}", found.len(), found[0])) }
}

#[test]
fn dumps_of_factors_by_a_view_are_welded() {
    let closed = ["loop_valences", "loop_creased", "stam_mixed", "stam_rocket"].map(scheme_scene);
    let of_schemes = of_schemes().into_iter().filter(|(mesh, _)| closed.contains(mesh));
    let of_catmull_clark = ["genus_2", "ngon_40", "cube", "valence_7"].map(|name| (scene(name), "catmull-clark"));
    let cases: Vec<_> =
        of_schemes.chain(of_catmull_clark).flat_map(|case| VIEWS.map(|view| (case.clone(), view))).collect();
    check_all(&cases, |((mesh, scheme), view)| {
        let flags = format!("--scheme {scheme} {view}");
        let told = |what: String| format!("{} {flags}: {what}", mesh.display());
        let cage = Cage::read(mesh);
        let vertices = dump(mesh, &flags)?;
        if boundary_edge_count(&cage) == 0 { check_closed(&vertices, &cage).map_err(told) } else { Ok(()) }
    });
}

#[test]
fn stats_count_patches_under_table() {
    let folder = temporary();
    for (mesh, scheme, expected) in [
        (scene("cube"), "catmull-clark", 24),
        (scene("tetrahedron"), "catmull-clark", 12),
        (scene("tetrahedron"), "loop", 16),
        (scheme_scene("loop_sheet"), "butterfly", 512),
    ] {
        let flags = format!("--method table --scheme {scheme} --tess 3 --stats -");
        let outcome = Planish::dump(&mesh, &folder.path().join("dump.ply")).flags(&flags).run();
        let stats = outcome.silent_success().unwrap().json().unwrap();
        assert_eq!(stats["scheme"], scheme);
        let frame = &stats["frames"][0];
        assert_eq!(frame["patches"]["table"], expected, "{frame}");
        assert_eq!(
            (&frame["patches"]["regular"], &frame["patches_by_level"][1]),
            (&0.into(), &expected.into()),
            "{frame}"
        );
    }
}

fn image(mesh: &Path, flags: &str) -> image::RgbImage {
    let folder = temporary();
    let path = folder.path().join("image.png");
    Planish::render(mesh, &path).flags(flags).run().silent_success().unwrap();
    image::open(&path).unwrap().into_rgb8()
}

/// The mean difference of two images' bytes.
fn mean_difference(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    f64::from(a.iter().zip(b.iter()).map(|(a, b)| u32::from(a.abs_diff(*b))).sum::<u32>()) / a.len() as f64
}

#[test]
fn images_show_what_dfas_shows() {
    for view in ["shaded", "normal", "uv"] {
        let flags = |method: &str| format!("--method {method} --view {view} --edge-pixels 2 --size 160x120");
        let [table, dfas] = ["table", "dfas"].map(|method| image(&scene("genus_2"), &flags(method)));
        let mean = mean_difference(&table, &dfas);
        assert!(mean < 0.5, "{view}: {mean}");
    }
}

#[test]
fn culling_does_not_change_what_is_seen_of_any_scheme() {
    // So near that much of the mesh is outside of the view.
    let view = "--method table --view normal --tess 8 --size 96x64 --eye 0.3,0.5,1.6 --target 0.9,0.2,0 --fov 30";
    for (name, scheme) in [("loop_valences", "loop"), ("loop_valences", "butterfly"), ("stam_mixed", "loop-stam")] {
        let [culled, all] =
            ["", "--no-cull"].map(|flags| image(&scheme_scene(name), &format!("{view} --scheme {scheme} {flags}")));
        assert!(culled == all, "{name} by {scheme}");
    }
}

#[test]
fn a_deforming_scene_moves_and_says_nothing() {
    let folder = temporary();
    let flags = "--method table --tess 4 --size 120x90 --frames 3-4 --aov motion,z";
    let path = root().join("scenes/sprout.glb");
    Planish::render(&path, &folder.path().join("f.####.exr")).flags(flags).run().silent_success().unwrap();
    let [a, b] =
        ["f.0003.exr", "f.0004.exr"].map(|name| planish_tests::layers::Layers::read(&folder.path().join(name)));
    assert!(a.floats("Z") != b.floats("Z"));
    assert!(a.floats("motion.x").iter().any(|motion| motion.abs() > 0.1));
}

#[test]
fn what_there_are_no_tables_for_is_refused() {
    let folder = temporary();
    let out = folder.path().join("dump.ply");
    let manifold = "is not manifold: method table expects edges of one or two faces and one fan a vertex";
    let cases = [
        (
            "cube",
            "--method table --scheme butterfly",
            "face 0 (from 0) has 4 sides: scheme butterfly expects triangles".to_owned(),
        ),
        (
            "ngon_5",
            "--method table --scheme loop",
            "face 0 (from 0) has 5 sides: scheme loop expects triangles".to_owned(),
        ),
        (
            "ngon_5",
            "--method table --scheme loop-stam",
            "face 0 (from 0) has 5 sides: scheme loop-stam expects triangles and quads".to_owned(),
        ),
        ("nonmanifold_edge_3", "--method table", format!("vertex 0 (from 0) {manifold}")),
        ("edit_hole_1", "--method table", "tables are over the cage itself: expected no hierarchical edits".to_owned()),
    ];
    for (name, flags, expected) in cases {
        let mesh = scene(name);
        let outcome = Planish::dump(&mesh, &out).flags(flags).flags("--tess 2").run();
        assert_eq!(outcome.one_error(FAILED).unwrap(), format!("{}: {expected}", mesh.display()));
    }
    let outcome = Planish::dump(&scene("cube"), &out).flags("--scheme loop --tess 2").run();
    let expected = "scheme loop is evaluated by table: found --method dfas, expected --method table";
    assert_eq!(outcome.one_error(FAILED).unwrap(), expected);
    let (map, mesh) = (folder.path().join("map.png"), scene("uv_torus"));
    image::GrayImage::new(4, 4).save(&map).unwrap();
    let outcome = Planish::dump(&mesh, &out).flags("--method table --tess 2 --displacement").path(&map).run();
    let expected = "method table is not displaced: expected no displacement map";
    assert_eq!(outcome.one_error(FAILED).unwrap(), format!("{}: {expected}", mesh.display()));
    assert!(!out.exists());
}
