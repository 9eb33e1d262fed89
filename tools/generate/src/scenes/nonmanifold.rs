//! Edges of more than two faces or of opposite orientation, and vertices with more than one fan of faces.
use std::f64::consts::TAU;

use glam::DVec3;

use super::SceneFile;
use super::parts::sheet;
use crate::cage::Cage;
use crate::tags::{BoundaryRule, INFINITE};
use crate::{lattice, sectors};

/// Rows of quads along the spine of a book, and columns of a page.
const BOOK: [u32; 2] = [3, 2];
/// Edges closer than this are made one.
const WELD_DISTANCE: f64 = 1e-6;

pub fn files() -> Vec<SceneFile> {
    let mut files = edges();
    files.extend(vertices());
    files.extend(creased());
    files
}

fn edges() -> Vec<SceneFile> {
    let flipped = |cage: Cage, x: f64, z: f64| {
        let face = cage.face_above(x, z) as usize;
        let mut cage = cage;
        cage.faces[face].reverse();
        cage
    };
    let pillow = [[-1.0, 0.0, -1.0], [-1.2, 0.3, 1.0], [1.0, -0.2, 1.2], [1.1, 0.4, -0.9]];
    vec![
        SceneFile::new("nonmanifold_opposite", "Two sheets of opposite orientation share edges.", book(2)),
        SceneFile::new("nonmanifold_edge_3", "Three sheets share edges.", book(3)),
        SceneFile::new("nonmanifold_edge_4", "Four sheets share edges.", book(4)),
        SceneFile::new("nonmanifold_book_5", "Five sheets share edges.", book(5)),
        SceneFile::new(
            "nonmanifold_flipped_face",
            "A sheet with a face turned over inside.",
            flipped(sheet(), 0.5, 0.5),
        ),
        SceneFile::new(
            "nonmanifold_flipped_boundary",
            "A sheet with a face turned over at the boundary.",
            flipped(sheet(), -2.5, 0.5),
        ),
        SceneFile::new(
            "nonmanifold_moebius",
            "A strip with half a twist: one edge joins opposite orientations.",
            moebius(),
        ),
        SceneFile::new(
            "double_sided_quad",
            "A quad with two sides.",
            Cage::new(&pillow, &[[0, 1, 2, 3], [3, 2, 1, 0]]),
        ),
        SceneFile::new("duplicate_quad", "The same quad twice.", Cage::new(&pillow, &[[0, 1, 2, 3], [1, 2, 3, 0]])),
        SceneFile::new("nonmanifold_cubes_edge", "Two cubes share an edge.", cells([2, 1, 2], &[[0, 0, 0], [1, 0, 1]])),
    ]
}

fn vertices() -> Vec<SceneFile> {
    vec![
        SceneFile::new(
            "nonmanifold_cubes_vertex",
            "Two cubes share a vertex.",
            cells([2, 2, 2], &[[0, 0, 0], [1, 1, 1]]),
        ),
        SceneFile::new("nonmanifold_sectors", "Sheets of 1, 2 and 3 faces meet in a vertex.", fans(&[1, 2, 3])),
        SceneFile::new(
            "nonmanifold_sectors_edge_only",
            "Sheets of 1 and 2 faces meet in a vertex; boundary rule edge only.",
            fans(&[1, 1, 2]).with_boundary(BoundaryRule::EdgeOnly),
        ),
        SceneFile::new("nonmanifold_discs", "Two sheets touch in a vertex inside both.", discs()),
        SceneFile::new("nonmanifold_disc_and_fan", "A sheet's corner touches another sheet inside.", disc_and_fan()),
        SceneFile::new(
            "nonmanifold_discs_none",
            "Two sheets touch in a vertex inside both; boundary rule none.",
            discs().with_boundary(BoundaryRule::None),
        ),
    ]
}

fn creased() -> Vec<SceneFile> {
    let pages = book(3);
    // The spine's vertices come first; a page's follow row by row.
    let page_row = |page: u32, row: u32| [row, 1 + BOOK[0] + page * (BOOK[0] + 1) * BOOK[1] + row * BOOK[1]];
    let rows = [page_row(0, 1), page_row(1, 1), page_row(2, 2)];
    let spine: Vec<u32> = (0..=BOOK[0]).collect();
    let touching = discs();
    let center = touching.above(0.0, 0.0);
    let [near, far] = [touching.above(1.0, 0.0), touching.above(2.0, 0.0)];
    vec![
        SceneFile::new(
            "nonmanifold_creased_pages",
            "Three sheets share edges; creases of sharpness 1.5, 2.3 and infinite reach them.",
            pages.clone().creased_edges(&rows, &[1.5, 2.3, INFINITE]),
        ),
        SceneFile::new(
            "nonmanifold_creased_spine",
            "Three sheets share edges, which have sharpness 2.3 besides, and a sharp vertex.",
            pages.creased(&spine, 2.3).cornered(1, 1.5),
        ),
        SceneFile::new(
            "nonmanifold_creased_discs",
            "Two sheets touch in a vertex, where a crease of sharpness 2.3 ends.",
            touching.clone().creased(&[center, near, far], 2.3),
        ),
        SceneFile::new(
            "nonmanifold_corner_discs",
            "Two sheets touch in a vertex of sharpness 2.3.",
            touching.cornered(center, 2.3),
        ),
        SceneFile::new(
            "nonmanifold_creased_cubes",
            "Two cubes share a vertex, where creases of sharpness 1.5, 2.3 and 3.7 end.",
            creased_cubes(),
        ),
    ]
}

/// Sheets that share a row of edges, each running away from it.
fn book(page_count: u32) -> Cage {
    let [rows, columns] = BOOK;
    let mut cage = Cage::default();
    let point = |page: u32, row: u32, column: u32| {
        let (across, along) = (f64::from(column), f64::from(row) - f64::from(rows) / 2.0);
        let angle = TAU * (f64::from(page) + 0.1 * across + 0.04 * along) / f64::from(page_count.max(3));
        DVec3::new(across * angle.cos(), across * angle.sin() + 0.2 * (1.3 * along).sin(), along)
    };
    let spine: Vec<u32> = (0..=rows).map(|row| cage.vertex(point(0, row, 0))).collect();
    for page in 0..page_count {
        let mut lines: Vec<Vec<u32>> = spine.iter().map(|&vertex| vec![vertex]).collect();
        for (row, line) in (0..).zip(&mut lines) {
            line.extend((1..=columns).map(|column| cage.vertex(point(page, row, column))));
        }
        for pair in lines.windows(2) {
            for column in 0..columns as usize {
                cage.face(&[pair[0][column], pair[1][column], pair[1][column + 1], pair[0][column + 1]]);
            }
        }
    }
    cage
}

/// The surface of cells of a lattice, a little twisted.
fn cells(size: [i32; 3], solid: &[[i32; 3]]) -> Cage {
    let position = |point: [i32; 3]| {
        let p = DVec3::from(point.map(f64::from)) - DVec3::from(size.map(f64::from)) * 0.5;
        let (sin, cos) = (0.3 * p.y).sin_cos();
        DVec3::new(p.x * cos + p.z * sin, 1.1 * p.y + 0.1 * p.x, p.z * cos - p.x * sin)
    };
    lattice::surface(size, |cell| solid.contains(&cell), position)
}

fn creased_cubes() -> Cage {
    let cage = cells([2, 2, 2], &[[0, 0, 0], [1, 1, 1]]);
    let edges = cage.edges();
    let in_middle = |edge: &&[u32; 2]| edge.iter().any(|&vertex| cage.positions[vertex as usize].length() < 1e-9);
    let edges: Vec<[u32; 2]> = edges.iter().filter(in_middle).copied().take(4).collect();
    cage.creased_edges(&edges, &[1.5, 2.3, 3.7])
}

/// Half discs of so many faces around one vertex, turned out of each other's way.
fn fans(face_counts: &[u32]) -> Cage {
    let parts = face_counts.iter().map(|&face_count| sectors::fan(face_count));
    touching(parts, |part| DVec3::new(0.3 * part, -1.0, 0.4))
}

/// Two discs that touch in their middles.
fn discs() -> Cage {
    touching([sectors::disc(4), sectors::disc(5)].into_iter(), |_| DVec3::new(1.0, 0.2, 0.5))
}

fn disc_and_fan() -> Cage {
    touching([sectors::disc(4), sectors::fan(1)].into_iter(), |_| DVec3::new(1.0, 0.2, -0.5))
}

/// Meshes that share their vertices 0, at the origin; the k-th is turned by k times 100 degrees about an axis.
fn touching(parts: impl Iterator<Item = Cage>, axis: impl Fn(f64) -> DVec3) -> Cage {
    let mut cage = Cage::default();
    for (place, part) in (0..).map(f64::from).zip(parts) {
        let center = part.positions[0];
        let part = part.moved(-center);
        cage.append(&if place == 0.0 { part } else { part.turned(axis(place), 100.0 * place) });
    }
    cage.welded(WELD_DISTANCE)
}

/// A strip around a circle that makes half a turn on its way.
fn moebius() -> Cage {
    const LENGTH: u32 = 12;
    const WIDTH: u32 = 3;
    let point = |i: u32, j: u32| {
        let around = TAU * f64::from(i) / f64::from(LENGTH);
        let across = f64::from(j) / f64::from(WIDTH) - 0.5;
        let (sin, cos) = (around / 2.0).sin_cos();
        let radius = 1.2 + across * cos;
        DVec3::new(radius * around.cos(), across * sin, radius * around.sin())
    };
    crate::sheets::grid(LENGTH, WIDTH, point).welded(WELD_DISTANCE)
}
