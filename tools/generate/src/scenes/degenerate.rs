//! Cages that are legal but degenerate: their surface has points without a normal.
use glam::DVec3;

use super::SceneFile;
use super::parts::sheet;
use crate::cage::Cage;
use crate::solids;

pub fn files() -> Vec<SceneFile> {
    let collapsed = |from: [f64; 2], to: [f64; 2]| {
        let mut cage = sheet();
        let [from, to] = [from, to].map(|[x, z]| cage.above(x, z) as usize);
        cage.positions[from] = cage.positions[to];
        cage
    };
    vec![
        SceneFile::new("coincident_vertices", "A sheet with an edge of length 0 inside and one on the boundary.", {
            let mut cage = collapsed([0.0, 0.0], [1.0, 0.0]);
            let [from, to] = [cage.above(-3.0, 0.0), cage.above(-3.0, 1.0)].map(|vertex| vertex as usize);
            cage.positions[from] = cage.positions[to];
            cage
        }),
        SceneFile::new("zero_area_face", "A sheet with a face all of whose vertices are in one place.", zero_area()),
        SceneFile::new("collinear_face", "A sheet with a face whose vertices lie on a line.", collinear()),
        SceneFile::new("unused_vertices", "A cube, and two vertices that no face uses.", unused()),
        SceneFile::new(
            "flat_pair",
            "A cube pressed flat: faces lie upon each other.",
            solids::cube().map(|p| DVec3::new(p.x, 0.0, p.z)),
        ),
    ]
}

fn middle_face(cage: &Cage) -> [usize; 4] {
    let face = cage.face_above(0.5, 0.5) as usize;
    [0, 1, 2, 3].map(|corner| cage.faces[face][corner] as usize)
}

fn zero_area() -> Cage {
    let mut cage = sheet();
    let corners = middle_face(&cage);
    let middle = corners.iter().map(|&vertex| cage.positions[vertex]).sum::<DVec3>() / 4.0;
    corners.iter().for_each(|&vertex| cage.positions[vertex] = middle);
    cage
}

fn collinear() -> Cage {
    let mut cage = sheet();
    let [a, b, c, d] = middle_face(&cage);
    let (start, end) = (cage.positions[a], cage.positions[c]);
    for (vertex, part) in [(b, 0.25), (d, 0.75)] {
        cage.positions[vertex] = start.lerp(end, part);
    }
    cage
}

/// The first and the last vertex are those without a face.
fn unused() -> Cage {
    let cube = solids::cube();
    let mut cage = Cage::default();
    cage.vertex(DVec3::new(0.5, 0.2, 0.1));
    cage.append(&cube);
    cage.vertex(DVec3::new(-0.3, 0.4, 0.2));
    cage
}
