//! Meshes of triangles, and of triangles and quads, for schemes besides Catmull and Clark's. They lie in a folder of their own:
//! what goes through all of `scenes/` takes it for that scheme's.
use glam::DVec3;

use super::SceneFile;
use crate::cage::Cage;
use crate::sheets;
use crate::solids;
use crate::tags::{BoundaryRule, INFINITE};

pub fn files() -> Vec<SceneFile> {
    let file = |name: &str, what: &str, cage: Cage| SceneFile::new(name, format!("{what}."), cage);
    vec![
        file("loop_valences", "A closed mesh of triangles whose vertices have valences 3 to 9", valences()),
        file("loop_sheet", "A sheet of triangles with creases, sharp vertices and a dart", tagged(triangles())),
        file(
            "loop_edge_only",
            "The same sheet, whose corners are not sharp",
            tagged(triangles()).with_boundary(BoundaryRule::EdgeOnly),
        ),
        file("loop_chaikin", "The same sheet by Chaikin's rule", tagged(triangles()).with_chaikin()),
        file(
            "loop_creased",
            "A closed mesh of triangles with creases and sharp vertices",
            valences().creased(&[2, 0, 3], INFINITE).creased(&[1, 4, 0], 1.3).cornered(5, 2.6),
        ),
        file(
            "stam_mixed",
            "A closed mesh of triangles and quads, around whose vertices they come in many orders",
            mixed(),
        ),
        file(
            "stam_sheet",
            "A sheet of triangles and quads with creases, sharp vertices and a dart",
            tagged(half_cut()),
        ),
        file("stam_rocket", "A closed mesh of bands of triangles and quads", solids::rocket()),
    ]
}

/// An octahedron whose faces are split at points above them, some of them twice.
fn valences() -> Cage {
    let positions =
        [[1.2, 0.0, 0.1], [-1.0, 0.1, 0.0], [0.0, 1.3, 0.0], [0.1, -1.0, 0.0], [0.0, 0.1, 1.1], [0.0, 0.0, -1.0]];
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let mut cage = Cage::new(&positions, &faces);
    for corners in [[0, 2, 4], [2, 1, 4], [2, 1, 7], [1, 2, 5], [1, 2, 9], [4, 0, 6]] {
        split_face(&mut cage, corners);
    }
    cage
}

/// Splits a triangle in three at a point above it.
fn split_face(cage: &mut Cage, corners: [u32; 3]) {
    let is_same = |face: &Vec<u32>| corners.iter().all(|corner| face.contains(corner));
    let index = cage.faces.iter().position(is_same).expect("the face is there");
    let [a, b, c] = cage.faces[index][..] else { panic!("face {index} is no triangle") };
    let middle = [a, b, c].iter().map(|&vertex| cage.positions[vertex as usize]).sum::<DVec3>() / 3.0;
    let point = cage.vertex(middle * 1.4);
    cage.faces[index] = vec![a, b, point];
    cage.face(&[b, c, point]);
    cage.face(&[c, a, point]);
}

/// A waved sheet of triangles; its vertices have whole coordinates x and z from -4 to 4.
fn triangles() -> Cage {
    cut(sheets::waved_grid(8, 8), |_| Some(0))
}

/// The same with quads among them.
fn half_cut() -> Cage {
    cut(sheets::waved_grid(8, 8), |face| [None, Some(0), None, Some(1), Some(0)][(face * 7 + face / 9) % 5])
}

/// A torus of quads, some of which are cut along one diagonal or the other.
fn mixed() -> Cage {
    cut(solids::torus(9, 6), |face| {
        [None, Some(0), Some(1), None, None, Some(1), Some(0)][(face * 5 + face / 6 * 3 + face / 11) % 7]
    })
}

/// The mesh with quads cut from a corner on.
fn cut(mut cage: Cage, corner: impl Fn(usize) -> Option<usize>) -> Cage {
    for index in 0..cage.faces.len() {
        if let Some(corner) = corner(index) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| cage.faces[index][(corner + i) % 4]);
            cage.faces[index] = vec![a, b, c];
            cage.face(&[a, c, d]);
        }
    }
    cage
}

/// The sheet with creases of all kinds: infinitely sharp through it and as a dart, less sharp ones, and sharp vertices.
fn tagged(sheet: Cage) -> Cage {
    let along_x = |from: i32, to: i32, z: f64| (from..=to).map(|x| [f64::from(x), z]).collect::<Vec<_>>();
    sheet
        .creased_above(&along_x(-4, 4, -2.0), INFINITE)
        .creased_above(&along_x(-3, 1, 2.0), 2.3)
        .creased_above(&[[1.0, 2.0], [1.0, 1.0], [1.0, 0.0], [1.0, -1.0]], 1.5)
        .creased_above(&[[1.0, 2.0], [2.0, 2.0], [3.0, 2.0], [4.0, 2.0]], 0.7)
        .creased_above(&[[-2.0, 1.0], [-2.0, 0.0], [-2.0, -1.0]], INFINITE)
        .cornered_above(3.0, 0.0, 1.7)
        .cornered_above(-1.0, -3.0, INFINITE)
}
