//! Open sheets of quads. They lie about the plane y = 0, and their outside is up.
use glam::DVec3;

use crate::cage::Cage;

/// A grid of `columns` x `rows` quads; `position` maps (column, row) lattice points, rows run towards the viewer (+z).
pub fn grid(columns: u32, rows: u32, position: impl Fn(u32, u32) -> DVec3) -> Cage {
    grid_where(columns, rows, position, |_, _| true)
}

/// The quads of a grid that `keep` keeps, without the vertices that only others use.
pub fn grid_where(
    columns: u32,
    rows: u32,
    position: impl Fn(u32, u32) -> DVec3,
    keep: impl Fn(u32, u32) -> bool,
) -> Cage {
    let mut cage = Cage::default();
    let mut index_of = vec![None; (columns + 1) as usize * (rows + 1) as usize];
    for row in 0..rows {
        for column in 0..columns {
            if !keep(column, row) {
                continue;
            }
            let corners = [(column, row), (column, row + 1), (column + 1, row + 1), (column + 1, row)];
            let face = corners.map(|(i, j)| {
                *index_of[(j * (columns + 1) + i) as usize].get_or_insert_with(|| cage.vertex(position(i, j)))
            });
            cage.face(&face);
        }
    }
    cage
}

/// A gently waved grid of faces of side 1, centred at the origin.
pub fn waved_grid(columns: u32, rows: u32) -> Cage {
    grid(columns, rows, |i, j| waved(f64::from(i) - f64::from(columns) / 2.0, f64::from(j) - f64::from(rows) / 2.0))
}

/// A sheet in the form of an L, with a boundary that turns both ways.
pub fn l_sheet(tag: &str) -> Cage {
    let mut cage = grid_where(8, 8, |i, j| waved(f64::from(i) - 4.0, f64::from(j) - 4.0), |i, j| i < 4 || j >= 4);
    cage.tags.push(tag.to_owned());
    cage
}

/// A strip one face wide, which rises and twists.
pub fn strip(length: u32) -> Cage {
    grid(length, 1, |i, j| {
        let along = f64::from(i) / f64::from(length);
        let (sin, cos) = (0.2 + 1.4 * along).sin_cos();
        let across = f64::from(j) - 0.5;
        DVec3::new(f64::from(i), 0.4 * (4.0 * along).sin() - across * sin, across * cos)
    })
}

fn waved(x: f64, z: f64) -> DVec3 {
    DVec3::new(x, 0.6 * (0.7 * x + 0.2).sin() * (0.6 * z - 0.3).cos(), z)
}
