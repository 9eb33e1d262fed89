//! What connectivity alone makes: extraordinary vertices, n-gons, boundaries, closed bodies, and the hero.
use glam::DVec3;

use super::SceneFile;
use crate::cage::Cage;
use crate::{hero, large, lattice, sectors, sheets, solids};

/// Shapes without tags but the boundary's rule, and the hero.
pub fn files() -> Vec<SceneFile> {
    let mut files = interior();
    files.extend(boundaries());
    files.extend(bodies());
    files.push(SceneFile::new(
        "hero",
        "A planishing hammer on an anvil, and the jug and the bowl that they made.",
        hero::scene(),
    ));
    files
}

/// Extraordinary vertices and n-gons among regular faces.
fn interior() -> Vec<SceneFile> {
    let valence = |valence: u32| {
        let comment = format!("An interior vertex of valence {valence}; all others are regular.");
        SceneFile::new(format!("valence_{valence}"), comment, sectors::disc(valence))
    };
    let ngon = |sides: u32| {
        let comment = format!("A face of {sides} sides among quads; every vertex is regular.");
        SceneFile::new(format!("ngon_{sides}"), comment, sectors::ngon(sides))
    };
    let mut files: Vec<SceneFile> = [2, 3, 5, 6, 7, 40, 360].map(valence).into();
    files.extend([3, 5, 6, 40].map(ngon));
    let closed = SceneFile::new(
        "valence_2_closed",
        "A cube with a vertex of valence 2 in its upper side.",
        solids::cube_with_valence_2(),
    );
    files.push(closed);
    files
}

/// Open sheets.
fn boundaries() -> Vec<SceneFile> {
    let sheet = |name: &str, value: u32, rule: &str| {
        let cage = sheets::l_sheet(&format!("t interpolateboundary 1/0/0 {value}"));
        SceneFile::new(format!("boundary_{name}"), format!("A sheet with boundary rule {rule}."), cage)
    };
    let quad = [[-1.0, 0.3, -1.0], [-1.2, -0.2, 1.0], [1.0, 0.4, 1.2], [1.1, -0.3, -0.9]];
    let triangle = [[-1.0, 0.0, 0.6], [1.1, 0.2, 0.5], [0.1, -0.1, -1.2]];
    vec![
        SceneFile::new("boundary_valences", "Boundary vertices with 1 to 20 faces.", fans()),
        SceneFile::new("boundary_valence_20", "A boundary vertex of valence 20, in 19 faces.", sectors::fan(19)),
        sheet("none", 0, "none"),
        sheet("edge_and_corner", 1, "edge and corner"),
        sheet("edge_only", 2, "edge only"),
        SceneFile::new("strip_1x5", "A strip one face wide: two opposite edges on the boundary.", sheets::strip(5)),
        SceneFile::new("single_quad", "One quad that is not flat.", Cage::new(&quad, &[[0, 1, 2, 3]])),
        SceneFile::new("single_triangle", "One triangle.", Cage::new(&triangle, &[[0, 1, 2]])),
        SceneFile::new("grid_8x8", "A waved grid: a regular sheet with corners.", sheets::waved_grid(8, 8)),
        SceneFile::new("open_cylinder", "A tube open at both ends.", solids::open_cylinder(10, 5)),
    ]
}

/// Closed bodies.
fn bodies() -> Vec<SceneFile> {
    let mut two = solids::cube();
    two.append(&solids::torus(8, 4).turned(DVec3::X, 60.0).moved(DVec3::new(3.0, 0.2, 0.5)));
    let far = large::blob(96, 0.3).map(|p| p * 0.5 + DVec3::new(1000.0, -1000.0, 1000.0));
    vec![
        SceneFile::new("cube", "A cube: every vertex has valence 3.", solids::cube()),
        SceneFile::new("tetrahedron", "A tetrahedron: triangles alone.", solids::tetrahedron()),
        SceneFile::new("torus_32", "A torus of 8 x 4 quads: every face is regular.", solids::torus(8, 4)),
        SceneFile::new("genus_2", "A slab with two holes.", lattice::slab_with_two_holes()),
        SceneFile::new("two_components", "A cube and a torus in one mesh.", two),
        SceneFile::new(
            "adjacent_extraordinary",
            "A sphere with extraordinary vertices of many valences side by side.",
            large::crowded_sphere(),
        ),
        SceneFile::new("mixed_triangles_quads", "A rocket of triangles and quads.", solids::rocket()),
        SceneFile::new("far_from_origin", "A small blob 1700 units from the origin.", far),
    ]
}

/// Boundary vertices with 1 to 20 faces, each in a component of its own.
fn fans() -> Cage {
    let mut cage = Cage::default();
    for face_count in 1..=20 {
        let place = face_count - 1;
        let (column, row) = (f64::from(place % 5), f64::from(place / 5));
        cage.append(&sectors::fan(face_count).moved(DVec3::new(5.0 * column, 0.0, 3.0 * row)));
    }
    cage
}
