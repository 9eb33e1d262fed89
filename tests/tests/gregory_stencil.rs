//! `--gregory stencil` beside `--gregory two-stage`: the same surface, and equal to the bit along every seam by itself.

use std::collections::BTreeMap;
use std::path::Path;

use planish_tests::folder::temporary;
use planish_tests::judge::check_edges;
use planish_tests::parallel::check_all;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::{Outcome, Planish};
use planish_tests::repository::{root, scene};

/// Of the largest coordinate.
const TOLERANCE: f32 = 2e-6;

/// Scenes of all that a face may be made of, and flags.
const CASES: [(&str, &str); 19] = [
    ("adjacent_extraordinary", "--tess 5.3"),
    ("boundary_edge_and_corner", "--tess 4"),
    ("boundary_valences", "--tess 3.5"),
    ("corner_infinite_crease_1_5", "--tess 4"),
    ("crease_2_3", "--tess 5.3"),
    ("crease_infinite_extraordinary", "--tess 4.4"),
    ("crease_mixed_3", "--tess 3"),
    ("crease_ngon_5", "--tess 3.3"),
    ("dart_extraordinary", "--tess 4"),
    ("far_from_origin", "--tess 3"),
    ("genus_2", "--tess 2.7"),
    ("mixed_triangles_quads", "--tess 5.3"),
    ("ngon_6", "--tess 5.3"),
    ("nonmanifold_sectors", "--tess 3"),
    ("smooth_triangles_creased", "--tess 4"),
    ("tetrahedron", "--tess 70"),
    ("triangles_creased", "--tess 4"),
    ("valence_40", "--tess 4"),
    ("valence_7", "--tess 66"),
];

fn dump(mesh: &Path, flags: &str) -> Result<(Vec<Vertex>, Outcome), String> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    let outcome = Planish::dump(mesh, &path).flags("--method gregory").flags(flags).run().silent_success()?;
    let vertices = Dump::read(&path)?.vertices().collect();
    Ok((vertices, outcome))
}

/// Positions by face and parameters; those of a point that several patches have, by their bits in order.
fn by_parameter(vertices: &[Vertex]) -> BTreeMap<(u32, [u32; 2]), Vec<[u32; 3]>> {
    let mut points: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for vertex in vertices {
        let place = (vertex.face, vertex.uv.map(f32::to_bits));
        points.entry(place).or_default().push(vertex.position.map(f32::to_bits));
    }
    points.values_mut().for_each(|positions| positions.sort_unstable());
    points
}

/// Unless both dumps have the same points to the tolerance: what is off. Returns how many are not equal to the bit.
fn compare(a: &[Vertex], b: &[Vertex]) -> Result<usize, String> {
    let largest = a.iter().flat_map(|vertex| vertex.position).fold(0.0_f32, |m, c| m.max(c.abs()));
    let (a, b) = (by_parameter(a), by_parameter(b));
    if !a.keys().eq(b.keys()) {
        return Err(format!("{} and {} places", a.len(), b.len()));
    }
    let mut unequal = 0;
    for ((place, a), b) in a.iter().zip(b.values()) {
        let difference = |(a, b): (&u32, &u32)| (f32::from_bits(*a) - f32::from_bits(*b)).abs();
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        let off = pairs.map(difference).fold(0.0, f32::max);
        if a.len() != b.len() || off.is_nan() || off > TOLERANCE * largest {
            return Err(format!("face {} at {:?}: off by {off}", place.0, place.1.map(f32::from_bits)));
        }
        unequal += usize::from(off > 0.0);
    }
    Ok(unequal)
}

#[test]
fn stencils_draw_the_surface_of_two_stages_and_are_watertight_to_the_bit_by_themselves() {
    check_all(&CASES, |&(name, flags)| {
        let mesh = scene(name);
        let (two_stage, _) = dump(&mesh, &format!("{flags} --gregory two-stage"))?;
        let (stencil, outcome) = dump(&mesh, &format!("{flags} --gregory stencil"))?;
        compare(&two_stage, &stencil).map_err(|fault| outcome.told(&fault))?;
        check_edges(&mesh, &stencil, &outcome)
    });
}

#[test]
fn merged_meshes_and_instances_are_drawn_by_stencils_as_in_two_stages() {
    let several = root().join("scenes/several.json");
    let (two_stage, _) = dump(&several, "--tess 3.3 --gregory two-stage").unwrap();
    let (stencil, outcome) = dump(&several, "--tess 3.3 --gregory stencil").unwrap();
    let unequal = compare(&two_stage, &stencil).unwrap_or_else(|fault| panic!("{}", outcome.told(&fault)));
    assert!(unequal > 0, "the stencils were not used");
}

#[test]
fn culling_leaves_an_image_by_stencils_as_it_is() {
    let folder = temporary();
    let image = |name: &str, flags: &str| {
        let path = folder.path().join(name);
        let view = "--method gregory --gregory stencil --size 200x150 --tess 6 --eye 1,1,4 --target 2.6,0.5,0 --fov 40";
        let mesh = scene("mixed_triangles_quads");
        Planish::render(&mesh, &path).flags(view).flags(flags).run().silent_success().unwrap();
        std::fs::read(path).unwrap()
    };
    assert!(image("culled.png", "") == image("whole.png", "--no-cull"), "culling changes the image");
}

#[test]
fn info_tells_what_the_tables_of_stencils_take() {
    let info = |name: &str, flags: &str| {
        let outcome = Planish::info(&scene(name)).flags("--method gregory").flags(flags).run();
        outcome.silent_success().unwrap().json().unwrap()["refinement"].clone()
    };
    // All faces of a cube are alike: three of eight vertices are round each corner of a face, which are all.
    let cube = info("cube", "--gregory stencil");
    let stencils = &cube["gregory_stencils"];
    assert_eq!((&stencils["connectivities"], &stencils["faces"]), (&1.into(), &6.into()));
    // Six faces of 8 words and of 8 points of 3 words; 32 rows of 8 weights.
    assert_eq!(stencils["bytes"], 4 * (6 * (8 + 8 * 3) + 32 * 8));
    assert!(info("cube", "")["gregory_stencils"].is_null());
    assert_eq!(info("valence_7", "--gregory stencil")["gregory_stencils"]["faces_of_spokes"], 0);
    let ngon = info("ngon_5", "--gregory stencil");
    assert!(ngon["gregory_stencils"]["faces_of_spokes"].as_u64() > Some(0), "{ngon}");
}
