//! Patches, points and bytes follow the theory: feature-adaptive refinement grows linearly with depth.

use std::fs;
use std::path::{Path, PathBuf};

use planish_generate::large::blob;
use planish_tests::folder::temporary;
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;
use planish_tests::repository::{model, scene};
use serde_json::{Value, json};

/// Deepest level that `--max-level` is tried at; the first is 1, as n-gons are refined once in any case.
const DEEPEST: usize = 10;
/// From this level on three rings of points around one extraordinary vertex have none in common with those around
/// another: at level 1 two are at least two edges apart, at level k so are at least 2^k.
const ISOLATED_FROM: usize = 3;
/// The same where there are n-gons, whose middles are as near as one face to their corners at level 1.
const ISOLATED_FROM_WITH_N_GONS: usize = 4;
/// Faces of the generated mesh.
const BLOB_FACES: u32 = 3000;
/// How far the bytes that a level adds may be from those of the level before: tables are rounded up.
const BYTES_TOLERANCE: f64 = 0.01;

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no count"))
}

/// The frame of `--stats -`, and the dump that it describes.
fn dumped(mesh: &Path, flags: &str) -> Result<(Value, Dump), String> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let outcome = Planish::dump(mesh, &path).flags(flags).flags("--stats -").run().silent_success()?;
    Ok((outcome.json()?["frames"][0].clone(), Dump::read(&path)?))
}

#[test]
fn an_isolated_vertex_gives_three_patches_a_face_and_level_two_of_them_transition() {
    let valences = [2, 5, 360];
    let cases: Vec<(u64, usize)> =
        valences.iter().flat_map(|&valence| [0, 1, 4].map(|depth| (valence, depth))).collect();
    check_all(&cases, |&(n, depth)| {
        // Around the n faces of the vertex lie 3n regular ones, 2n of them beside the irregular ones.
        let levels = depth as u64;
        let transition = 2 * n * levels;
        let patches = json!({
            "regular": 3 * n * (levels + 1) - transition, "transition": transition,
            "quad": n, "gregory_quad": 0, "gregory_triangle": 0, "table": 0, "truncated": 0,
        });
        let by_level: Vec<u64> = (0..=levels).map(|level| 3 * n + if level == levels { n } else { 0 }).collect();
        let tess = 1 << depth;
        let (frame, _) = dumped(&scene(&format!("valence_{n}")), &format!("--tess {tess}"))?;
        let is_right = frame["patches"] == patches && frame["patches_by_level"] == json!(by_level);
        if is_right { Ok(()) } else { Err(format!("valence {n}, depth {depth}: expected {patches}, found {frame}")) }
    });
}

/// What there is of irregularity from the first level on.
struct Irregularity {
    /// Interior extraordinary vertices; an n-gon's middle is one.
    vertices: u64,
    /// Faces around them.
    faces: u64,
    isolated_from: usize,
}

fn irregularity(mesh: &Value) -> Irregularity {
    let entries = |field: &str| -> Vec<(u64, u64)> {
        let by_size = mesh[field].as_object().unwrap_or_else(|| panic!("info has no {field}"));
        by_size.iter().map(|(size, count)| (size.parse().expect("a size is a number"), number(count))).collect()
    };
    let n_gons: Vec<_> = entries("faces_by_sides").into_iter().filter(|&(sides, _)| sides != 4).collect();
    let isolated_from = if n_gons.is_empty() { ISOLATED_FROM } else { ISOLATED_FROM_WITH_N_GONS };
    let all = [entries("extraordinary_by_valence"), n_gons].concat();
    Irregularity {
        vertices: all.iter().map(|&(_, count)| count).sum(),
        faces: all.iter().map(|&(size, count)| size * count).sum(),
        isolated_from,
    }
}

/// Refines a closed mesh to every level and compares what each further one adds with the theory.
fn check_growth(path: &Path) {
    let bytes_and_levels: Vec<(f64, Vec<Value>)> = (1..=DEEPEST)
        .map(|depth| {
            let outcome = Planish::info(path).flags(&format!("--max-level {depth}")).run().silent_success().unwrap();
            let info = outcome.json().unwrap();
            let refinement = &info["refinement"];
            let bytes = number(&refinement["memory_bytes"]["tables"]) + number(&refinement["memory_bytes"]["points"]);
            let levels = refinement["levels"].as_array().unwrap().clone();
            assert_eq!(levels.len(), depth + 1);
            let Irregularity { vertices, faces, isolated_from } = irregularity(&info["mesh"]);
            assert!(vertices > 0, "{} is all regular", path.display());
            for (index, level) in levels.iter().enumerate().skip(isolated_from) {
                let is_last = index == depth;
                let transition = if is_last { 0 } else { 2 * faces };
                // Three rings of points around a vertex of valence n: 1 + 2n + 4n + 6n.
                let points = vertices + 12 * faces;
                let expected = json!({
                    "points": points, "regular": 3 * faces - transition, "transition": transition,
                    "quad": if is_last { faces } else { 0 }, "gregory_quad": 0, "gregory_triangle": 0,
                    "table": 0,
                });
                assert_eq!(level, &expected, "{} level {index} of {depth}", path.display());
            }
            (bytes as f64, levels)
        })
        .collect();
    for pair in bytes_and_levels.windows(2) {
        let [(_, before), (_, after)] = pair else { unreachable!("windows of two") };
        let kept = before.len() - 1;
        assert_eq!(after[..kept], before[..kept], "{}: a level changed what lies above it", path.display());
    }
    let added: Vec<f64> = bytes_and_levels.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    // Between depths 1 and 2 lies the first entry.
    for pair in added[ISOLATED_FROM_WITH_N_GONS - 1..].windows(2) {
        let growth = pair[1] / pair[0];
        assert!((growth - 1.0).abs() < BYTES_TOLERANCE, "{}: bytes added by level {added:?}", path.display());
    }
}

#[test]
fn big_guy_grows_linearly_with_depth() {
    if let Some(path) = model("bigguy") {
        check_growth(&path);
    }
}

#[test]
fn monster_frog_grows_linearly_with_depth() {
    if let Some(path) = model("monsterfrog") {
        check_growth(&path);
    }
}

#[test]
fn generated_and_n_gon_meshes_grow_linearly_with_depth() {
    let folder = temporary();
    let path: PathBuf = folder.path().join("blob.obj");
    fs::write(&path, blob(BLOB_FACES, 0.15).to_obj("A blob.")).unwrap();
    check_growth(&path);
    for name in ["tetrahedron", "cube", "mixed_triangles_quads", "genus_2"] {
        check_growth(&scene(name));
    }
}

#[test]
fn refinement_cut_short_is_told_as_truncated() {
    let mesh = scene("valence_5");
    let truncated = |flags: &str| number(&dumped(&mesh, flags).unwrap().0["patches"]["truncated"]);
    assert_eq!(truncated("--tess 8 --max-level 2"), 5);
    assert_eq!(truncated("--tess 8 --max-level 3"), 0);
    assert_eq!(truncated("--tess 8"), 0);
}

#[test]
fn every_timed_frame_has_its_stats() {
    let folder = temporary();
    let image = folder.path().join("out.png");
    let render = Planish::render(&scene("valence_5"), &image).flags("--size 64x64 --tess 4 --repeat 3 --stats -");
    let stats = render.run().silent_success().unwrap().json().unwrap();
    let frames = stats["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 3);
    for frame in frames {
        let milliseconds = |stage: &str| frame["gpu_ms"][stage].as_f64().unwrap();
        let stages: f64 = ["density", "select", "subdivide", "limit", "emit", "draw"].map(milliseconds).iter().sum();
        assert!(milliseconds("subdivide") > 0.0 && milliseconds("draw") > 0.0, "{frame}");
        assert!(stages <= milliseconds("total") * 1.001, "{frame}");
        assert!(frame["wall_ms"].as_f64().unwrap() > 0.0, "{frame}");
        assert_eq!(frame["patches"], frames[0]["patches"]);
        // 5 sectors of 3 faces at level 0 and factor 4, one of level 1 at 2, one of level 2 at 1, and the quads.
        assert!(number(&frame["triangles"]) > 0, "{frame}");
    }
    for field in ["version", "device", "method", "scheme", "scene", "mesh", "preprocess_ms", "memory_bytes"] {
        assert!(!stats[field].is_null(), "no {field}");
    }
    assert_eq!(stats["mesh"], json!({"vertices": 31, "faces": 20, "irregular_faces": 5, "extraordinary_vertices": 1}));
}
