//! Texture coordinates: seams, charts and the rules at their boundaries.
use glam::{DVec2, DVec3};

use super::SceneFile;
use super::parts::{discs, sheet, spoke, stars};
use crate::cage::Cage;
use crate::tags::{BoundaryRule, INFINITE};
use crate::{sheets, solids};

/// Where the random shifts of charts begin.
const SEED: u64 = 17;

/// Values of `facevaryinginterpolateboundary` and what files are called after them.
const MODES: [(u32, &str); 6] =
    [(0, "none"), (1, "corners_only"), (2, "corners_plus_1"), (3, "corners_plus_2"), (4, "boundaries"), (5, "all")];

pub fn files() -> Vec<SceneFile> {
    let mut files: Vec<SceneFile> = MODES
        .iter()
        .map(|&(mode, name)| {
            let mut cage = charted_sheet();
            cage.tag("facevaryinginterpolateboundary", &[mode], &[], &[]);
            let comment = format!("Charts of a sheet, linear as {} says.", name.replace('_', " "));
            SceneFile::new(format!("uv_linear_{name}"), comment, cage)
        })
        .collect();
    files.extend(closed());
    files.extend(sharp());
    files.extend(odd());
    files
}

/// From above.
fn above(p: DVec3) -> DVec2 {
    0.5 * DVec2::new(p.x, p.z)
}

/// From aside, so that closed meshes do not collapse.
fn aslant(p: DVec3) -> DVec2 {
    DVec2::new(p.x + 0.3 * p.y, p.z - 0.4 * p.y + 0.1 * p.x)
}

/// A mesh cut along the edges between points given from above.
fn cut_above(cage: Cage, lines: &[&[[f64; 2]]]) -> Cage {
    let pairs: Vec<[u32; 2]> = lines
        .iter()
        .flat_map(|line| {
            let vertices = cage.polyline(line);
            vertices.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
        })
        .collect();
    cage.with_seams(SEED, |[a, b]| pairs.contains(&[a, b]) || pairs.contains(&[b, a]), above)
}

/// Points of a line from above, a unit apart.
fn line(from: [f64; 2], step: [f64; 2], count: u32) -> Vec<[f64; 2]> {
    (0..=count).map(f64::from).map(|i| [from[0] + i * step[0], from[1] + i * step[1]]).collect()
}

/// Charts that meet along lines, at corners of one, two and three faces, at crossings, and a seam that ends inside.
fn charted_sheet() -> Cage {
    let sheet = sheet();
    let middle = |cage: &Cage, face: usize| {
        cage.faces[face].iter().map(|&vertex| cage.positions[vertex as usize]).sum::<DVec3>() / 4.0
    };
    let middles: Vec<DVec3> = (0..sheet.faces.len()).map(|face| middle(&sheet, face)).collect();
    sheet.with_charts(
        SEED,
        |face| match (middles[face].x, middles[face].z) {
            (x, z) if x < -1.0 && z < -1.0 => 0,
            (x, _) if x < 0.0 => 1,
            (x, z) if x > 1.0 && z > 0.0 => 2,
            (_, z) if z < -2.0 => 3,
            _ => 4,
        },
        above,
    )
}

fn closed() -> Vec<SceneFile> {
    let cube = solids::cube();
    let all_sides = cube.clone().with_seams(SEED, |_| true, aslant);
    let top = cube.clone();
    let is_upper = |cage: &Cage, vertex: u32| cage.positions[vertex as usize].y > 0.0;
    let unfolded = cube.clone().with_seams(SEED, |edge| edge.iter().any(|&end| is_upper(&top, end)), aslant);
    let (torus, across) = (solids::torus(8, 6), 6);
    let is_on_seam = |edge: [u32; 2]| edge.iter().all(|&end| end < across) || edge.iter().all(|&end| end % across == 0);
    vec![
        SceneFile::new("uv_cube_sides", "A cube of six charts: three meet at each vertex.", all_sides),
        SceneFile::new("uv_cube_unfolded", "A cube cut open along its upper and upright edges.", unfolded),
        SceneFile::new(
            "uv_torus",
            "A torus cut open along two circles that cross.",
            torus.with_seams(SEED, is_on_seam, aslant),
        ),
        SceneFile::new(
            "uv_continuous",
            "Texture coordinates without a seam: they follow the vertices' rules.",
            solids::cube_sphere(2).with_seams(SEED, |_| false, aslant),
        ),
        SceneFile::new(
            "uv_shared",
            "One texture coordinate for all corners of two sides, another for all others.",
            shared_values(solids::cube()),
        ),
    ]
}

/// Two texture coordinates for all corners.
fn shared_values(mut cage: Cage) -> Cage {
    cage.uvs = vec![DVec2::new(0.25, 0.5), DVec2::new(1.0, 0.75)];
    cage.face_uvs = (0..).zip(&cage.faces).map(|(face, corners)| vec![u32::from(face > 1); corners.len()]).collect();
    cage
}

fn sharp() -> Vec<SceneFile> {
    let down = |x: f64| line([x, -3.0], [0.0, 1.0], 6);
    let across = |z: f64| line([-3.0, z], [1.0, 0.0], 6);
    let creased = |name: &str, comment: &str, tag: &dyn Fn(Cage) -> Cage| {
        SceneFile::new(name, comment, tag(cut_above(sheet(), &[&down(0.0)])))
    };
    vec![
        creased("uv_crease_across", "Creases that cross a seam: infinite, and of sharpness 1.5 and 2.3.", &|cage| {
            cage.creased_above(&across(-1.0), INFINITE)
                .creased_above(&across(0.0), 1.5)
                .creased_above(&across(1.0), 2.3)
        }),
        creased("uv_crease_along", "Creases of sharpness 2.3 and infinite along parts of a seam.", &|cage| {
            cage.creased_above(&down(0.0)[..3], 2.3).creased_above(&down(0.0)[4..], INFINITE)
        }),
        creased("uv_crease_dependent", "Creases that end at a seam: one side depends on the other's.", &|cage| {
            cage.creased_above(&across(-1.0)[..4], 2.5)
                .creased_above(&across(0.0)[3..], 0.7)
                .creased_above(&across(1.0)[..4], INFINITE)
                .creased_above(&across(2.0)[..4], 1.5)
                .creased_above(&across(2.0)[3..], 3.2)
        }),
        creased("uv_crease_outlasted", "Creases along a seam that outlast those that end at it.", &|cage| {
            cage.creased_above(&down(0.0), 4.6).creased_above(&across(-1.0)[..4], 1.3).creased_above(&across(1.0), 2.0)
        }),
        creased("uv_corner", "Vertices of sharpness 0.7, 2.3 and infinite on a seam.", &|cage| {
            cage.cornered_above(0.0, -1.0, 0.7).cornered_above(0.0, 0.0, 2.3).cornered_above(0.0, 1.0, INFINITE)
        }),
        creased("uv_crease_chaikin", "Uneven creases across and along a seam by Chaikin's rule.", &|cage| {
            cage.with_chaikin()
                .creased_above(&across(-1.0)[..5], 3.2)
                .creased_above(&across(-1.0)[4..], 1.4)
                .creased_above(&across(1.0)[..4], 2.2)
                .creased_above(&down(0.0)[4..], 1.7)
        }),
    ]
}

fn odd() -> Vec<SceneFile> {
    let valences = [3, 5, 6];
    let spokes = |arms: u32| -> Vec<Vec<[f64; 2]>> {
        let ends = (0..)
            .zip(valences)
            .flat_map(|(place, valence)| (0..arms.min(valence)).map(move |arm| spoke(place, valence, arm).to_vec()));
        ends.collect()
    };
    let cut_discs = |arms: u32| {
        let lines = spokes(arms);
        let lines: Vec<&[[f64; 2]]> = lines.iter().map(Vec::as_slice).collect();
        cut_above(discs(&valences), &lines)
    };
    let dart = |cage: Cage| cut_above(cage, &[&line([-2.0, -1.0], [1.0, 0.0], 3), &line([1.0, 3.0], [0.0, -1.0], 2)]);
    let boundary = |rule| {
        cut_above(sheets::waved_grid(4, 4), &[&line([-2.0, 0.0], [1.0, 0.0], 4), &line([-1.0, 2.0], [0.0, -1.0], 1)])
            .with_boundary(rule)
    };
    let rocket = solids::rocket().with_charts(SEED, |face| (face % 7 / 3) as u32, aslant);
    vec![
        SceneFile::new("uv_dart", "Seams that end inside a sheet, one at both ends.", dart(sheet())),
        SceneFile::new("uv_disc_dart", "Seams that end at vertices of valence 3, 5 and 6.", cut_discs(1)),
        SceneFile::new("uv_disc_two", "Seams through vertices of valence 3, 5 and 6.", cut_discs(2)),
        SceneFile::new("uv_disc_many", "Three seams meet at vertices of valence 3, 5 and 6.", cut_discs(3)),
        SceneFile::new(
            "uv_disc_creased",
            "Creases through vertices of valence 3, 5 and 6 on seams.",
            cut_creased(&valences),
        ),
        SceneFile::new(
            "uv_boundary_none",
            "A seam that ends at a boundary without a surface.",
            boundary(BoundaryRule::None),
        ),
        SceneFile::new(
            "uv_boundary_edge_only",
            "Seams that end at a boundary of which only edges are sharp.",
            boundary(BoundaryRule::EdgeOnly),
        ),
        SceneFile::new(
            "uv_boundary_edge_and_corner",
            "Seams that end at a boundary with sharp corners.",
            boundary(BoundaryRule::EdgeAndCorner),
        ),
        SceneFile::new("uv_ngon", "Charts of triangles and quads.", rocket),
    ]
}

/// Discs cut through their middles, with a crease of sharpness 1.5 to one side.
fn cut_creased(valences: &[u32]) -> Cage {
    let cage = stars(valences, &[1.5]);
    let lines: Vec<Vec<[f64; 2]>> = (0..)
        .zip(valences)
        .flat_map(|(place, &valence)| [1, valence - 1].map(|arm| spoke(place, valence, arm).to_vec()))
        .collect();
    let lines: Vec<&[[f64; 2]]> = lines.iter().map(Vec::as_slice).collect();
    cut_above(cage, &lines)
}
