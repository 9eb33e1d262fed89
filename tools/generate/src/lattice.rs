//! The surface of a set of cells of a lattice, bent into shape: how a body of boxes is modelled.
use std::collections::HashMap;

use glam::DVec3;

use crate::cage::Cage;

/// Counter-clockwise corners, seen from outside, of a cell's sides towards -x, +x, -y, +y, -z, +z.
const SIDES: [([i32; 3], [[i32; 3]; 4]); 6] = [
    ([-1, 0, 0], [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]),
    ([1, 0, 0], [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]),
    ([0, -1, 0], [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]),
    ([0, 1, 0], [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]]),
    ([0, 0, -1], [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]]),
    ([0, 0, 1], [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]),
];

/// The surface of the cells for which `inside` holds, among `size` cells; `position` maps lattice points.
/// Cells that touch only in an edge or a corner would make it non-manifold.
pub fn surface(size: [i32; 3], inside: impl Fn([i32; 3]) -> bool, position: impl Fn([i32; 3]) -> DVec3) -> Cage {
    let within = |cell: [i32; 3]| (0..3).all(|axis| (0..size[axis]).contains(&cell[axis]));
    let solid = |cell| within(cell) && inside(cell);
    let add = |a: [i32; 3], b: [i32; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let mut cage = Cage::default();
    let mut index_of = HashMap::new();
    let cells = (0..size[0]).flat_map(|i| (0..size[1]).flat_map(move |j| (0..size[2]).map(move |k| [i, j, k])));
    for cell in cells.filter(|&cell| solid(cell)) {
        for (neighbor, corners) in SIDES {
            if solid(add(cell, neighbor)) {
                continue;
            }
            let face = corners.map(|corner| {
                let point = add(cell, corner);
                *index_of.entry(point).or_insert_with(|| cage.vertex(position(point)))
            });
            cage.face(&face);
        }
    }
    cage
}

/// A slab with two holes: a surface of genus 2.
pub fn slab_with_two_holes() -> Cage {
    let position = |point: [i32; 3]| DVec3::from(point.map(f64::from)) - DVec3::new(2.5, 0.5, 1.5);
    surface([5, 1, 3], |cell| cell != [1, 0, 1] && cell != [3, 0, 1], position)
}
