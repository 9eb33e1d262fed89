//! Creases of one sharpness: semi-sharp and infinite, closed, crossing, ending, meeting the boundary.
use super::SceneFile;
use super::parts::{creased_rim, discs, sheet, spoke, stars};
use crate::cage::Cage;
use crate::tags::INFINITE;
use crate::{sectors, sheets, solids};

/// Quads around a torus' axis and around its tube.
const TORUS: [u32; 2] = [8, 6];

pub fn files() -> Vec<SceneFile> {
    let mut files = Vec::from([0.3, 1.5, 2.0, 2.3, 7.8, 9.9].map(rim));
    files.extend(infinite());
    files.extend(ends());
    files.extend(around_ngons());
    files.push(SceneFile::new(
        "crease_pole",
        "A pole of valence 12 within a creased ring, four of its edges creased.",
        pole(),
    ));
    files
}

fn rim(sharpness: f64) -> SceneFile {
    let name = format!("crease_{sharpness}").replace('.', "_");
    SceneFile::new(name, format!("A block whose upper rim has sharpness {sharpness}."), creased_rim(&[sharpness]))
}

fn infinite() -> Vec<SceneFile> {
    let cube = || solids::cube().map(|p| p * 0.8);
    let all = |cage: Cage, sharpness| {
        let edges = cage.edges();
        cage.creased_edges(&edges, &[sharpness])
    };
    vec![
        SceneFile::new(
            "crease_infinite",
            "A torus with an infinitely sharp loop: both its sides are regular.",
            torus_with_loops(&[0]),
        ),
        SceneFile::new(
            "crease_infinite_parallel",
            "A torus with two infinitely sharp loops one face apart.",
            torus_with_loops(&[0, 1]),
        ),
        SceneFile::new(
            "crease_infinite_extraordinary",
            "Infinitely sharp creases through vertices of valence 3, 5 and 6.",
            stars(&[3, 5, 6], &[INFINITE; 2]),
        ),
        SceneFile::new(
            "crease_crossing_3",
            "Three infinitely sharp creases meet in a vertex of valence 4, 3 and 5.",
            stars(&[4, 3, 5], &[INFINITE; 3]),
        ),
        SceneFile::new(
            "crease_crossing_4",
            "Four infinitely sharp creases meet in a vertex of valence 4 and 6.",
            stars(&[4, 6], &[INFINITE; 4]),
        ),
        SceneFile::new(
            "crease_crossing_semisharp",
            "Four creases of sharpness 2.3 meet in a vertex of valence 4 and 5.",
            stars(&[4, 5], &[2.3; 4]),
        ),
        SceneFile::new("cube_all_sharp", "A cube all of whose edges are infinitely sharp.", all(cube(), INFINITE)),
        SceneFile::new("cube_all_semisharp", "A cube all of whose edges have sharpness 2.3.", all(cube(), 2.3)),
    ]
}

/// A torus with infinitely sharp loops around its axis.
fn torus_with_loops(places: &[u32]) -> Cage {
    let [around, across] = TORUS;
    places.iter().fold(solids::torus(around, across), |cage, place| {
        let polyline: Vec<u32> = (0..=around).map(|i| i % around * across + place).collect();
        cage.creased(&polyline, INFINITE)
    })
}

/// Creases that end: inside, at an extraordinary vertex, at the boundary.
fn ends() -> Vec<SceneFile> {
    let dart = |name: &str, sharpness: f64| {
        let cage = sheet().creased_above(&[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], sharpness);
        SceneFile::new(name, format!("A crease of sharpness {sharpness} that begins and ends inside a sheet."), cage)
    };
    let extraordinary = [(3, INFINITE), (5, INFINITE), (5, 2.3), (6, 1.5)];
    let valences = extraordinary.map(|(valence, _)| valence);
    let darts = (0..).zip(extraordinary).fold(discs(&valences), |cage, (place, (valence, sharpness))| {
        cage.creased_above(&spoke(place, valence, 0), sharpness)
    });
    let lines = [(-2.0, 1.5), (0.0, INFINITE), (2.0, 9.9)].into_iter().fold(sheets::waved_grid(8, 4), |cage, line| {
        let (x, sharpness) = line;
        cage.creased_above(&[-2.0, -1.0, 0.0, 1.0, 2.0].map(|z| [x, z]), sharpness)
    });
    vec![
        dart("dart_2_3", 2.3),
        dart("dart_infinite", INFINITE),
        SceneFile::new("dart_extraordinary", "Creases that end at extraordinary vertices.", darts),
        SceneFile::new(
            "crease_boundary",
            "Creases of sharpness 1.5, infinite and 9.9 from boundary to boundary.",
            lines,
        ),
    ]
}

fn around_ngons() -> Vec<SceneFile> {
    let around = |sides: u32, sharpness: &[f64], what: &str| {
        let edges: Vec<[u32; 2]> = (0..sides).map(|i| [i, (i + 1) % sides]).collect();
        let comment = format!("A face of {sides} sides whose edges have {what}.");
        SceneFile::new(format!("crease_ngon_{sides}"), comment, sectors::ngon(sides).creased_edges(&edges, sharpness))
    };
    vec![
        around(3, &[1.5], "sharpness 1.5"),
        around(5, &[2.3], "sharpness 2.3"),
        around(6, &[INFINITE, 0.3, 2.3], "infinite sharpness, 0.3 and 2.3"),
    ]
}

fn pole() -> Cage {
    const VALENCE: u32 = 12;
    let ring: Vec<u32> = (0..=2 * VALENCE).map(|i| 1 + i % (2 * VALENCE)).collect();
    let arms = [(0, 2.3), (3, 1.5), (5, 2.3), (8, 3.7)];
    arms.into_iter()
        .fold(discs(&[VALENCE]), |cage, (index, sharpness)| cage.creased_above(&spoke(0, VALENCE, index), sharpness))
        .creased(&ring, 1.2)
}
