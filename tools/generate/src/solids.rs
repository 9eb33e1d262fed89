//! Closed meshes and other simple bodies, counter-clockwise seen from outside.
use std::f64::consts::{FRAC_PI_4, TAU};

use glam::DVec3;

use crate::cage::Cage;

/// A cube of side 2.
pub fn cube() -> Cage {
    cube_sphere(1).map(|p| p * 3f64.sqrt())
}

/// A regular tetrahedron with vertices of a cube of side 2.
pub fn tetrahedron() -> Cage {
    let positions = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    Cage::new(&positions, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

/// A torus about the y axis of `around` x `across` quads; every vertex is regular.
pub fn torus(around: u32, across: u32) -> Cage {
    let (major, minor) = (1.0, 0.4);
    tube(around, across, true, |u, v| {
        let (sin_u, cos_u) = (TAU * u).sin_cos();
        let (sin_v, cos_v) = (TAU * v).sin_cos();
        let radius = major + minor * cos_v;
        DVec3::new(radius * cos_u, minor * sin_v, -radius * sin_u)
    })
}

/// A cylinder about the y axis, open at both ends and waisted.
pub fn open_cylinder(around: u32, rows: u32) -> Cage {
    tube(rows, around, false, |u, v| {
        let radius = 1.0 - 0.5 * (TAU * u / 2.0).sin();
        DVec3::new(radius * (TAU * v).cos(), 3.0 * u, radius * (TAU * v).sin())
    })
    .moved(DVec3::new(0.0, -1.5, 0.0))
}

/// A tube of quads, closed in v and, if `closed`, in u; `position` maps u and v from 0 to 1, their cross product points out.
pub fn tube(rows: u32, columns: u32, closed: bool, position: impl Fn(f64, f64) -> DVec3) -> Cage {
    let mut cage = Cage::default();
    let row_count = if closed { rows } else { rows + 1 };
    for i in 0..row_count {
        for j in 0..columns {
            cage.vertex(position(f64::from(i) / f64::from(rows), f64::from(j) / f64::from(columns)));
        }
    }
    let vertex = |i: u32, j: u32| (i % row_count) * columns + j % columns;
    for i in 0..rows {
        for j in 0..columns {
            cage.face(&[vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
        }
    }
    cage
}

/// A sphere of radius 1 of six faces of a cube with n x n quads each, which all span about the same angle.
pub fn cube_sphere(n: u32) -> Cage {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut cage = Cage::default();
    for (side, sign) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let (normal, u, v) = (axes[side] * sign, axes[(side + 1) % 3] * sign, axes[(side + 2) % 3]);
        let slope = |i: u32| (FRAC_PI_4 * (2.0 * f64::from(i) / f64::from(n) - 1.0)).tan();
        let first = cage.positions.len() as u32;
        for j in 0..=n {
            for i in 0..=n {
                cage.vertex((normal + u * slope(i) + v * slope(j)).normalize());
            }
        }
        for j in 0..n {
            for i in 0..n {
                let corner = first + j * (n + 1) + i;
                cage.face(&[corner, corner + 1, corner + n + 2, corner + n + 1]);
            }
        }
    }
    cage.welded(0.01 / f64::from(n))
}

/// A cube with a vertex of valence 2 in its upper side, whose two faces share two edges.
pub fn cube_with_valence_2() -> Cage {
    let mut cage = cube();
    let is_upper = |face: &Vec<u32>| face.iter().all(|&vertex| cage.positions[vertex as usize].y > 0.0);
    let upper = cage.faces.iter().position(is_upper).expect("a cube has an upper side");
    let [a, b, c, d] = cage.faces[upper][..] else { unreachable!("a cube's sides are quads") };
    let middle = cage.vertex(DVec3::new(0.2, 1.6, -0.1));
    cage.faces[upper] = vec![a, b, c, middle];
    cage.face(&[a, middle, c, d]);
    cage
}

/// A rocket of triangles and quads: fans of triangles at both ends, a band of triangles between bands of quads.
pub fn rocket() -> Cage {
    const SIDES: u32 = 7;
    let profile = [(0.6, -1.6), (0.9, -0.9), (1.0, 0.0), (0.8, 0.9), (0.5, 1.6)];
    let ring_point = |ring: usize, i: f64| {
        let (radius, y) = profile[ring];
        let (sin, cos) = (TAU * i / f64::from(SIDES)).sin_cos();
        DVec3::new(radius * cos, y, -radius * sin)
    };
    let mut cage = Cage::default();
    for ring in 0..profile.len() {
        // From the band of triangles on, the vertices stand over the middles of the edges below.
        let shift = if ring < 3 { 0.0 } else { 0.5 };
        for i in 0..SIDES {
            cage.vertex(ring_point(ring, f64::from(i) + shift));
        }
    }
    let (bottom, top) = (cage.vertex(DVec3::new(0.0, -1.8, 0.0)), cage.vertex(DVec3::new(0.0, 2.4, 0.0)));
    let vertex = |ring: u32, i: u32| ring * SIDES + i % SIDES;
    for i in 0..SIDES {
        cage.face(&[bottom, vertex(0, i + 1), vertex(0, i)]);
        for ring in [0, 1, 3] {
            cage.face(&[vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1), vertex(ring + 1, i)]);
        }
        cage.face(&[vertex(2, i), vertex(2, i + 1), vertex(3, i)]);
        cage.face(&[vertex(2, i + 1), vertex(3, i + 1), vertex(3, i)]);
        cage.face(&[vertex(4, i), vertex(4, i + 1), top]);
    }
    cage
}
