//! Pot, leaves, eyes and ground.
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::body::rings;
use super::{EARTH, Materials};
use crate::cage::Cage;
use crate::gltf_text::GltfText;
use crate::hero::profile;
use crate::solids;

/// Half the side of the ground.
const GROUND: f64 = 6.0;
/// Vertices around the pot.
const SIDES: u32 = 12;
/// Radius and height of the pot's rings, from its foot over its rim down to the earth, and how sharp each is.
const POT: [(f64, f64, f64); 9] = [
    (0.36, 0.0, 10.0),
    (0.4, 0.12, 0.0),
    (0.47, 0.36, 0.0),
    (0.51, 0.52, 3.0),
    (0.59, 0.53, 3.0),
    (0.61, 0.7, 3.0),
    (0.54, 0.7, 3.0),
    (0.52, 0.64, 0.0),
    (0.5, EARTH - 0.02, 2.0),
];
/// Length of a leaf, and how many quads it has along it.
const LEAF: (f64, u32) = (0.62, 6);
/// Radius of an eye.
const EYE: f64 = 0.075;

/// Adds a square of quads with texture coordinates.
pub fn ground(text: &mut GltfText, materials: &Materials) -> usize {
    let cage = sheet(2, 2, |s, t| DVec3::new((2.0 * s - 1.0) * GROUND, 0.0, (2.0 * t - 1.0) * GROUND));
    let (primitive, _) = text.primitive(&cage, materials.ground);
    text.add("meshes", json!({ "name": "ground", "primitives": [primitive] }))
}

/// Adds the pot and, as a primitive of its own, the earth in it; its edges are creased.
pub fn pot(text: &mut GltfText, materials: &Materials) -> usize {
    let mut cage = rings(SIDES, &POT.map(|(radius, height, _)| (radius, height)));
    // Open above, closed below.
    cage.faces.pop();
    cage.face(&(0..SIDES).rev().collect::<Vec<_>>());
    wrap(&mut cage);
    let (pot, vertices) = text.primitive(&cage, materials.pot);
    let (radius, height, _) = POT[POT.len() - 1];
    let earth = rings(SIDES, &[(radius, height), (0.26, EARTH + 0.02)]);
    let (earth, _) = text.primitive(&earth, materials.earth);
    let file_vertex = |ring: usize, side: u32| {
        let vertex = ring as u32 * SIDES + side % SIDES;
        vertices.partition_point(|&other| other < vertex)
    };
    let sharp = POT.iter().enumerate().filter(|(_, ring)| ring.2 > 0.0);
    let crease = |ring: usize, sharpness: f64| {
        (0..SIDES).map(move |side| json!([file_vertex(ring, side), file_vertex(ring, side + 1), sharpness]))
    };
    let creases: Vec<Value> =
        sharp.flat_map(|(ring, &(_, _, sharpness))| crease(ring, sharpness).collect::<Vec<_>>()).collect();
    let extras = json!({ "planish": { "creases": creases } });
    text.add("meshes", json!({ "name": "pot", "primitives": [pot, earth], "extras": extras }))
}

/// Texture coordinates around a pot: s once around, t down from the rim. The foot has one for all its corners.
fn wrap(cage: &mut Cage) {
    let ring_count = POT.len() as u32;
    let t = |ring: u32| (1.0 - POT[ring as usize].1 / POT[5].1).max(0.0);
    for ring in 0..ring_count {
        cage.uvs.extend((0..=SIDES).map(|side| DVec2::new(f64::from(side) / f64::from(SIDES), t(ring))));
    }
    cage.uvs.push(DVec2::new(0.5, 1.0));
    let uv = |ring: u32, side: u32| ring * (SIDES + 1) + side;
    let mut face_uvs: Vec<Vec<u32>> = Vec::new();
    for ring in 0..ring_count - 1 {
        face_uvs.extend(
            (0..SIDES).map(|side| vec![uv(ring, side), uv(ring, side + 1), uv(ring + 1, side + 1), uv(ring + 1, side)]),
        );
    }
    face_uvs.push(vec![cage.uvs.len() as u32 - 1; SIDES as usize]);
    cage.face_uvs = face_uvs;
}

/// Adds a leaf: it grows along x, its middle is a fold.
pub fn leaf(text: &mut GltfText, materials: &Materials) -> usize {
    let (length, count) = LEAF;
    let width = [(0.0, 0.02), (0.2, 0.1), (0.5, 0.19), (0.75, 0.15), (1.0, 0.02)];
    let cage = sheet(2, count, |s, t| {
        let along = 1.0 - t;
        let side = 2.0 * s - 1.0;
        let half_width = profile(&width, along);
        let height = 0.22 * along - 0.3 * along * along + 0.35 * side.abs() * half_width;
        DVec3::new(along * length, height, side * half_width)
    });
    let (primitive, vertices) = text.primitive(&cage, materials.leaf);
    let middle = |row: u32| vertices.partition_point(|&vertex| vertex < 3 * row + 1);
    let creases: Vec<Value> = (0..count).map(|row| json!([middle(row), middle(row + 1), 1.5])).collect();
    text.add(
        "meshes",
        json!({ "name": "leaf", "primitives": [primitive], "extras": { "planish": { "creases": creases } } }),
    )
}

/// Adds an eye.
pub fn eye(text: &mut GltfText, materials: &Materials) -> usize {
    let cage = solids::cube_sphere(2).map(|p| p.normalize() * EYE);
    let (primitive, _) = text.primitive(&cage, materials.eye);
    text.add("meshes", json!({ "name": "eye", "primitives": [primitive] }))
}

/// Quads over (s, t) from 0 to 1, s to the right and t towards the viewer as seen from above.
fn sheet(columns: u32, rows: u32, position: impl Fn(f64, f64) -> DVec3) -> Cage {
    let mut cage = Cage::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (s, t) = (f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            cage.vertex(position(s, t));
            cage.uvs.push(DVec2::new(s, t));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [row, row + 1].map(|row| row * (columns + 1) + column);
            cage.face(&[b, b + 1, a + 1, a]);
        }
    }
    cage.face_uvs = cage.faces.clone();
    cage
}
