//! The rule for smooth triangles.
use super::SceneFile;
use super::parts::sheet;
use crate::cage::Cage;
use crate::tags::INFINITE;
use crate::{sectors, solids};

/// Vertices around the rocket.
const ROCKET_SIDES: u32 = 7;

pub fn files() -> Vec<SceneFile> {
    let file = |name: &str, what: &str, cage: Cage| {
        SceneFile::new(name, format!("Smooth triangles: {what}."), cage.with_smooth_triangles())
    };
    let ring = |ring: u32| (0..=ROCKET_SIDES).map(|i| ring * ROCKET_SIDES + i % ROCKET_SIDES).collect::<Vec<u32>>();
    let creased = || {
        split_sheet()
            .creased_above(&[[-2.0, -1.0], [-1.0, 0.0], [0.0, 0.0], [0.0, 1.0]], 2.3)
            .creased_above(&[[1.0, -3.0], [1.0, -2.0], [1.0, -1.0], [1.0, 0.0], [2.0, 1.0]], INFINITE)
            .cornered_above(-1.0, 2.0, 1.5)
    };
    vec![
        file("smooth_triangles", "a rocket of triangles and quads", solids::rocket()),
        file("smooth_triangles_closed", "a tetrahedron", solids::tetrahedron()),
        file("smooth_triangles_ngon", "one among quads, beside a face of five sides", split(sectors::ngon(5), &[1])),
        file("smooth_triangles_boundary", "a sheet of triangles and quads", split_sheet()),
        file(
            "smooth_triangles_creased",
            "a rocket with creases around both ends of its band of triangles",
            solids::rocket().creased(&ring(2), 1.5).creased(&ring(3), INFINITE),
        ),
        file("smooth_triangles_creased_boundary", "a sheet with creases and a sharp vertex", creased()),
        SceneFile::new("triangles_creased", "The same sheet by the usual rule for triangles.", creased()),
    ]
}

/// A sheet of quads, with some of them split in two.
fn split_sheet() -> Cage {
    split(sheet(), &[0, 1, 5, 7, 8, 9, 13, 14, 15, 16, 17, 20, 21, 22, 25, 26, 27, 28, 33, 35])
}

/// The mesh with some of its quads split in two triangles.
fn split(mut cage: Cage, quads: &[usize]) -> Cage {
    for &quad in quads {
        let [a, b, c, d] = cage.faces[quad][..] else { panic!("face {quad} is no quad") };
        cage.faces[quad] = vec![a, b, c];
        cage.face(&[a, c, d]);
    }
    cage
}
