//! Hierarchical edits: positions, sharpness and holes of finer levels.
use glam::DVec3;

use super::parts::{creased_rim, disc_center, discs, sheet};
use super::{SceneFile, footprints};
use crate::cage::Cage;
use crate::edits::{Path, path_to_face, path_to_vertex};
use crate::sectors;
use crate::tags::INFINITE;

pub fn files() -> Vec<SceneFile> {
    let mut files = positions();
    files.extend(positions_at_irregularities());
    files.extend(sharpness());
    files.extend(holes());
    files.push(SceneFile::new(
        "edit_footprints",
        "A trail of footprints in sand: vertices of levels 3 and 4 moved.",
        footprints::sand(),
    ));
    files
}

/// The path to the vertex of a level at (x, z), whole multiples of 2^-level, of [`sheet`].
fn vertex_at(cage: &Cage, level: u32, x: f64, z: f64) -> Path {
    // A face has u along z and v along x. Vertices on the far sides belong to the last faces.
    let base = |coordinate: f64| coordinate.floor().min(2.0);
    let scale = f64::from(1 << level);
    let fine = |coordinate: f64| ((coordinate - base(coordinate)) * scale) as u32;
    path_to_vertex(cage.face_above(base(x) + 0.5, base(z) + 0.5), level, fine(z), fine(x))
}

/// The path to the face of a level that begins at (x, z) of [`sheet`].
fn face_at(cage: &Cage, level: u32, x: f64, z: f64) -> Path {
    let mut path = vertex_at(cage, level, x, z);
    path.pop();
    path
}

fn up(height: f64) -> DVec3 {
    DVec3::new(0.0, height, 0.0)
}

fn positions() -> Vec<SceneFile> {
    let moved = |level: u32, points: &[[f64; 2]]| {
        let cage = sheet();
        let height = 1.0 / f64::from(1 << level);
        let edits: Vec<(Path, DVec3)> =
            points.iter().map(|&[x, z]| (vertex_at(&cage, level, x, z), DVec3::new(0.1, height, -0.1))).collect();
        cage.with_vertices_moved(&edits)
    };
    let set = |level: u32, points: &[[f64; 2]]| {
        let cage = sheet();
        let edits: Vec<(Path, DVec3)> =
            points.iter().map(|&[x, z]| (vertex_at(&cage, level, x, z), DVec3::new(x, 1.0, z))).collect();
        cage.with_vertices_set(&edits)
    };
    vec![
        SceneFile::new("edit_vertex_add_0", "A cage's vertices moved by edits.", moved(0, &[[0.0, 0.0], [2.0, -1.0]])),
        SceneFile::new(
            "edit_vertex_add_1",
            "Vertices of level 1 moved.",
            moved(1, &[[0.5, 0.5], [-1.5, 0.0], [-1.0, 0.0], [2.0, -1.0]]),
        ),
        SceneFile::new(
            "edit_vertex_add_2",
            "Vertices of level 2 moved.",
            moved(2, &[[0.25, 0.5], [0.5, 0.5], [-1.25, 0.75], [1.0, -2.0]]),
        ),
        SceneFile::new(
            "edit_vertex_add_3",
            "Vertices of level 3 moved.",
            moved(3, &[[0.125, 0.5], [0.25, 0.5], [-1.0, 0.0], [-1.375, -1.25]]),
        ),
        SceneFile::new("edit_vertex_set_1", "Vertices of level 1 put elsewhere.", set(1, &[[0.5, 0.5], [-1.0, -1.5]])),
        SceneFile::new(
            "edit_vertex_set_2",
            "Vertices of level 2 put elsewhere.",
            set(2, &[[0.5, 0.25], [0.75, 0.25], [-2.0, -1.0]]),
        ),
        SceneFile::new(
            "edit_vertex_set_3",
            "Vertices of level 3 put elsewhere.",
            set(3, &[[0.875, 0.25], [-1.5, -1.0]]),
        ),
        SceneFile::new("edit_vertex_boundary", "Vertices of levels 1 and 2 on the boundary and in corners moved.", {
            let cage = sheet();
            let place = |level, x, z| (vertex_at(&cage, level, x, z), DVec3::new(0.1, 0.4, 0.1));
            let edits = [
                place(1, -3.0, 0.5),
                place(1, 3.0, 3.0),
                place(2, 0.25, 3.0),
                place(2, -3.0, -3.0),
                place(2, 1.5, -2.75),
                place(3, 3.0, -1.125),
            ];
            cage.with_vertices_moved(&edits)
        }),
        SceneFile::new("edit_vertex_layers", "The same places moved at levels 1, 2 and 3 in turn.", {
            let cage = sheet();
            let at = |level, x, z, height| (vertex_at(&cage, level, x, z), up(height));
            let fine = [at(2, 0.5, 0.5, -0.3), at(2, 0.75, 0.5, 0.2), at(3, 0.5, 0.5, 0.15), at(3, 0.875, 0.5, -0.1)];
            let coarse = [at(1, 0.5, 0.5, 0.6), at(1, 0.5, 0.5, 0.1)];
            let put = [(vertex_at(&cage, 2, -1.0, 0.0), DVec3::new(-1.0, 0.8, 0.0))];
            let after = [at(2, -1.0, 0.0, 0.2), at(1, -1.0, 0.0, 3.0)];
            cage.with_vertices_moved(&fine)
                .with_vertices_moved(&coarse)
                .with_vertices_set(&put)
                .with_vertices_moved(&after)
        }),
    ]
}

fn positions_at_irregularities() -> Vec<SceneFile> {
    let near_extraordinary = {
        let cage = discs(&[3, 5]);
        let beside = [0, 1].map(|place| cage.face_above(disc_center(place) + 0.4, 0.4));
        let edits = [
            (path_to_vertex(beside[0], 1, 0, 0), up(0.3)),
            (path_to_vertex(beside[0], 2, 3, 2), up(0.2)),
            (path_to_vertex(beside[1], 2, 0, 0), up(0.2)),
            (path_to_vertex(beside[1], 3, 1, 1), up(0.1)),
            (path_to_vertex(beside[1], 3, 4, 7), up(-0.15)),
        ];
        cage.with_vertices_moved(&edits)
    };
    let on_ngon = {
        let cage = sectors::ngon(5);
        // Child 2 of the face of five sides, then its corners: the face's corner 2, the middles of two edges, its centre.
        let edits = [
            (vec![0, 2, 1], up(0.3)),
            (vec![0, 4, 0], up(-0.3)),
            (vec![0, 1, 2, 3], up(0.2)),
            (vec![0, 0, 1, 2], up(0.2)),
            (vec![0, 3, 0, 2, 2], DVec3::new(0.1, 0.1, 0.0)),
            (vec![1, 0, 2], up(0.2)),
        ];
        cage.with_vertices_moved(&edits)
    };
    let ngon_center = sectors::ngon(6).with_vertices_moved(&[(vec![0, 3, 2], up(0.5)), (vec![0, 5, 2, 1], up(0.1))]);
    let on_crease = {
        let cage = creased_rim(&[2.3]);
        let rim = cage.faces.iter().position(|face| face.iter().all(|&v| cage.positions[v as usize].y > 0.9));
        let face = rim.expect("a block has an upper side") as u32;
        let edits = [(path_to_vertex(face, 1, 1, 0), up(0.3)), (path_to_vertex(face, 2, 0, 3), up(0.1))];
        cage.with_vertices_moved(&edits)
    };
    vec![
        SceneFile::new(
            "edit_vertex_extraordinary",
            "Vertices of levels 1 to 3 moved near vertices of valence 3 and 5.",
            near_extraordinary,
        ),
        SceneFile::new("edit_vertex_ngon", "Vertices of levels 1 to 3 moved in a face of five sides.", on_ngon),
        SceneFile::new("edit_vertex_ngon_center", "The centre of a face of six sides moved.", ngon_center),
        SceneFile::new(
            "edit_vertex_crease",
            "Vertices of levels 1 and 2 on and beside a semi-sharp crease moved.",
            on_crease,
        ),
    ]
}

fn sharpness() -> Vec<SceneFile> {
    // Edge 0 of a face of the sheet runs along z, edge 3 along x, both from its first vertex.
    let edge = |cage: &Cage, level: u32, x: f64, z: f64, edge: u32| {
        let mut path = face_at(cage, level, x, z);
        path.push(edge);
        path
    };
    let along = |cage: &Cage, level: u32, z: f64, sharpness: f64| -> Vec<(Path, f64)> {
        let step = 0.5_f64.powi(level as i32);
        let count = 1 << (level + 1);
        (0..count).map(|i| (edge(cage, level, -1.0 + f64::from(i) * step, z, 3), sharpness)).collect()
    };
    let cage = sheet();
    let set = [along(&cage, 1, 0.5, 2.3), along(&cage, 2, -1.25, 1.5), along(&cage, 1, 2.0, INFINITE)].concat();
    let creased = cage.clone().creased_above(&[-2.0, -1.0, 0.0, 1.0, 2.0].map(|x| [x, 0.0]), 2.3);
    let added = [along(&cage, 1, 0.0, 1.2), vec![(edge(&cage, 2, 1.0, 0.0, 0), 3.7)]].concat();
    let removed: Vec<(Path, f64)> = vec![(edge(&cage, 1, -2.0, 0.0, 3), 0.8), (edge(&cage, 2, 1.5, 0.0, 3), 5.0)];
    let vertices = [
        (vertex_at(&cage, 1, 0.5, 0.5), 2.3),
        (vertex_at(&cage, 2, -1.25, 0.0), INFINITE),
        (vertex_at(&cage, 2, 1.0, -2.0), 0.3),
        (vertex_at(&cage, 1, 3.0, 0.0), 1.5),
    ];
    let cornered = cage.clone().cornered_above(-1.0, 0.0, 1.5).cornered_above(1.0, 1.0, INFINITE);
    let raised = [(vertex_at(&cage, 1, -1.0, 0.0), 2.0), (vertex_at(&cage, 1, 0.5, 0.0), 1.5)];
    vec![
        SceneFile::new(
            "edit_edge_sharpness_set",
            "Edges of levels 1 and 2 made creases of sharpness 2.3, 1.5 and infinite.",
            cage.clone().with_edge_sharpness("set", &set),
        ),
        SceneFile::new(
            "edit_edge_sharpness_add",
            "A crease made sharper in its middle and less sharp at its ends at levels 1 and 2.",
            creased.with_edge_sharpness("add", &added).with_edge_sharpness("subtract", &removed),
        ),
        SceneFile::new(
            "edit_vertex_sharpness_set",
            "Vertices of levels 1 and 2 made sharp.",
            cage.with_vertex_sharpness("set", &vertices),
        ),
        SceneFile::new(
            "edit_vertex_sharpness_add",
            "A sharp vertex made sharper and another smooth at level 1.",
            cornered
                .with_vertex_sharpness("add", &raised)
                .with_vertex_sharpness("set", &[(vertex_at(&sheet(), 1, 1.0, 1.0), 0.0)]),
        ),
    ]
}

fn holes() -> Vec<SceneFile> {
    let cage = sheet();
    let at = |level: u32, points: &[[f64; 2]]| -> Vec<Path> {
        points.iter().map(|&[x, z]| face_at(&cage, level, x, z)).collect()
    };
    let level_1 = at(1, &[[0.5, 0.5], [0.5, 1.0], [-1.0, -1.0], [-3.0, 0.0]]);
    let level_2 = at(2, &[[0.25, 0.5], [0.5, 0.5], [-1.0, 0.0], [-1.25, -0.25], [2.75, 2.75]]);
    let star = discs(&[5]);
    let beside = star.face_above(0.4, 0.4);
    let around = [path_to_face(beside, 1, 0, 0), path_to_face(beside, 2, 3, 3)];
    vec![
        SceneFile::new("edit_hole_1", "Faces of level 1 that are holes.", cage.clone().with_fine_holes(&level_1)),
        SceneFile::new("edit_hole_2", "Faces of level 2 that are holes.", cage.clone().with_fine_holes(&level_2)),
        SceneFile::new(
            "edit_hole_extraordinary",
            "Faces of levels 1 and 2 at a vertex of valence 5 that are holes.",
            star.with_fine_holes(&around),
        ),
        SceneFile::new(
            "edit_hole_ngon",
            "Faces of levels 1 and 2 in a face of five sides that are holes.",
            sectors::ngon(5).with_fine_holes(&[vec![0, 1], vec![0, 3, 2]]),
        ),
    ]
}
