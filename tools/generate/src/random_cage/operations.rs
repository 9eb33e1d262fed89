//! What happens to the faces of a random cage: each operation leaves a cage that may be subdivided, or none at all.
use glam::DVec3;

use super::manifold::{has_no_valence_2, has_slit_fan, is_manifold};
use super::{Features, MAX_FACES};
use crate::cage::Cage;
use crate::random::Random;

/// No fewer faces are left.
const MIN_FACES: usize = 4;
/// A face made by merging has no more sides.
const MAX_SIDES: usize = 10;

type Operation = fn(&mut Cage, &mut Random) -> Option<()>;

/// Those that keep quads, a manifold and its orientation, or are undone.
const PLAIN: [Operation; 5] = [extrude, delete_face, rotate_edge, inset, add_fin];
/// Those that make faces of other sizes.
const WITH_N_GONS: [Operation; 4] = [split_face, poke, split_edge, merge_faces];
/// Those whose result is seldom a manifold.
const NONMANIFOLD: [Operation; 4] = [weld_vertices, glue_edges, flip_face, double_face];

/// Tries one operation. What it draws does not depend on what is allowed, unless its result does.
pub fn operate(cage: &mut Cage, random: &mut Random, features: Features) {
    let all = PLAIN.len() + WITH_N_GONS.len() + NONMANIFOLD.len();
    let choice = random.below(all);
    let operation = if choice < PLAIN.len() {
        PLAIN[choice]
    } else if choice < PLAIN.len() + WITH_N_GONS.len() {
        if !features.has(Features::N_GONS) {
            return;
        }
        WITH_N_GONS[choice - PLAIN.len()]
    } else {
        if !features.has(Features::NONMANIFOLD) {
            return;
        }
        NONMANIFOLD[choice - PLAIN.len() - WITH_N_GONS.len()]
    };
    let mut changed = cage.clone();
    if operation(&mut changed, random).is_some() && is_allowed(&changed, features) {
        *cage = changed;
    }
}

fn is_allowed(cage: &Cage, features: Features) -> bool {
    (MIN_FACES..=MAX_FACES).contains(&cage.faces.len())
        && cage.faces.iter().all(|face| is_face(face))
        && (features.has(Features::NONMANIFOLD) || is_manifold(&cage.faces))
        && (features.has(Features::SLIT_FANS) || !has_slit_fan(&cage.faces))
        && (features.has(Features::VALENCE_2) || has_no_valence_2(&cage.faces))
        && (features.has(Features::N_GONS) || cage.faces.iter().all(|face| face.len() == 4))
}

/// Three different vertices or more.
fn is_face(face: &[u32]) -> bool {
    face.len() >= 3 && (1..face.len()).all(|i| !face[..i].contains(&face[i]))
}

fn random_face(cage: &Cage, random: &mut Random) -> usize {
    random.below(cage.faces.len())
}

/// A face, and the place of a side of it.
fn random_side(cage: &Cage, random: &mut Random) -> (usize, usize) {
    let face = random_face(cage, random);
    (face, random.below(cage.faces[face].len()))
}

fn ends(cage: &Cage, (face, side): (usize, usize)) -> [u32; 2] {
    let face = &cage.faces[face];
    [face[side], face[(side + 1) % face.len()]]
}

fn position(cage: &Cage, vertex: u32) -> DVec3 {
    cage.positions[vertex as usize]
}

fn center(cage: &Cage, face: usize) -> DVec3 {
    let face = &cage.faces[face];
    face.iter().map(|&vertex| position(cage, vertex)).sum::<DVec3>() / face.len() as f64
}

/// The unit normal of a face, or up where it has none.
fn normal(cage: &Cage, face: usize) -> DVec3 {
    let points: Vec<DVec3> = cage.faces[face].iter().map(|&vertex| position(cage, vertex)).collect();
    let area: DVec3 = (0..points.len()).map(|i| points[i].cross(points[(i + 1) % points.len()])).sum();
    area.try_normalize().unwrap_or(DVec3::Y)
}

/// Raises a face, with quads around it.
fn extrude(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    ring(cage, face, 0.7, 0.8)
}

/// A smaller face within a face.
fn inset(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    ring(cage, face, 0.5, 0.1)
}

/// Replaces a face by a smaller one above it and a ring of quads.
fn ring(cage: &mut Cage, face: usize, scale: f64, height: f64) -> Option<()> {
    let (middle, up) = (center(cage, face), height * normal(cage, face));
    let outer = cage.faces[face].clone();
    let inner: Vec<u32> = outer
        .iter()
        .map(|&vertex| {
            let above = middle.lerp(position(cage, vertex), scale) + up;
            cage.vertex(above)
        })
        .collect();
    for i in 0..outer.len() {
        let next = (i + 1) % outer.len();
        cage.face(&[outer[i], outer[next], inner[next], inner[i]]);
    }
    cage.faces[face] = inner;
    Some(())
}

fn delete_face(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    cage.faces.remove(face);
    Some(())
}

/// Lets the edge between two quads run between the next vertices of both.
fn rotate_edge(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let side = random_side(cage, random);
    let (other, start) = across(cage, side)?;
    let [a, b, c, d] = from(&cage.faces[side.0], side.1)?;
    let [_, _, e, f] = from(&cage.faces[other], start)?;
    // The two quads are the hexagon b c d a e f; the edge a-b becomes c-e.
    cage.faces[side.0] = vec![c, d, a, e];
    cage.faces[other] = vec![e, f, b, c];
    Some(())
}

/// The vertices of a quad from one on.
fn from(face: &[u32], start: usize) -> Option<[u32; 4]> {
    (face.len() == 4).then(|| [0, 1, 2, 3].map(|i| face[(start + i) % 4]))
}

/// The only other face that runs along a side the other way, and the place of that side.
fn across(cage: &Cage, side: (usize, usize)) -> Option<(usize, usize)> {
    let [a, b] = ends(cage, side);
    let place = |face: usize| (0..cage.faces[face].len()).find(|&other| ends(cage, (face, other)) == [b, a]);
    let mut found = (0..cage.faces.len()).filter_map(|face| Some((face, place(face)?)));
    found.next().filter(|_| found.next().is_none())
}

/// A new quad at an edge.
fn add_fin(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let side = random_side(cage, random);
    let [a, b] = ends(cage, side);
    let middle = center(cage, side.0);
    let out = normal(cage, side.0) * 0.3;
    let [c, d] = [a, b].map(|vertex| {
        let beyond = 2.0 * position(cage, vertex) - middle.lerp(position(cage, vertex), 0.2);
        cage.vertex(beyond + out)
    });
    cage.face(&[b, a, c, d]);
    Some(())
}

/// Splits a face along a diagonal.
fn split_face(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let (face, start) = random_side(cage, random);
    let size = cage.faces[face].len();
    if size < 4 {
        return None;
    }
    let length = 2 + random.below(size - 3);
    let rotated: Vec<u32> = (0..size).map(|i| cage.faces[face][(start + i) % size]).collect();
    cage.faces[face] = rotated[..=length].to_vec();
    cage.faces.push([&rotated[length..], &rotated[..1]].concat());
    Some(())
}

/// Splits a face into triangles around a new vertex.
fn poke(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    let above = center(cage, face) + 0.2 * normal(cage, face);
    let middle = cage.vertex(above);
    let corners = cage.faces[face].clone();
    for i in 1..corners.len() {
        cage.face(&[corners[i], corners[(i + 1) % corners.len()], middle]);
    }
    cage.faces[face] = vec![corners[0], corners[1], middle];
    Some(())
}

/// A new vertex in an edge.
fn split_edge(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let side = random_side(cage, random);
    let [a, b] = ends(cage, side);
    let middle = cage.vertex(position(cage, a).lerp(position(cage, b), 0.5));
    for face in &mut cage.faces {
        let mut places = (0..face.len()).filter(|&i| {
            let (from, to) = (face[i], face[(i + 1) % face.len()]);
            (from, to) == (a, b) || (from, to) == (b, a)
        });
        if let Some(place) = places.next_back() {
            face.insert(place + 1, middle);
        }
    }
    Some(())
}

/// Makes one face of two that share an edge.
fn merge_faces(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let side = random_side(cage, random);
    let (other, start) = across(cage, side)?;
    let (size, other_size) = (cage.faces[side.0].len(), cage.faces[other].len());
    if size + other_size - 2 > MAX_SIDES {
        return None;
    }
    // From the end of the shared edge around the first face, then around the other.
    let mut merged: Vec<u32> = (1..size).map(|i| cage.faces[side.0][(side.1 + i) % size]).collect();
    merged.extend((1..other_size).map(|i| cage.faces[other][(start + i) % other_size]));
    cage.faces[side.0] = merged;
    cage.faces.remove(other);
    Some(())
}

/// Makes one vertex of two.
fn weld_vertices(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let [(face, i), (other, j)] = [random_side(cage, random), random_side(cage, random)];
    replace(cage, cage.faces[other][j], cage.faces[face][i])
}

/// Makes one edge of two.
fn glue_edges(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let [side, other] = [random_side(cage, random), random_side(cage, random)];
    let ([a, b], [c, d]) = (ends(cage, side), ends(cage, other));
    if [a, b].iter().any(|vertex| [c, d].contains(vertex)) {
        return None;
    }
    let [c, d] = if random.percent(50) { [c, d] } else { [d, c] };
    replace(cage, c, a)?;
    replace(cage, d, b)
}

/// Puts a vertex in another's place, which lies between both from then on.
fn replace(cage: &mut Cage, old: u32, new: u32) -> Option<()> {
    if old == new {
        return None;
    }
    cage.positions[new as usize] = position(cage, old).lerp(position(cage, new), 0.5);
    cage.faces.iter_mut().flatten().filter(|vertex| **vertex == old).for_each(|vertex| *vertex = new);
    Some(())
}

/// Turns a face over.
fn flip_face(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    cage.faces[face].reverse();
    Some(())
}

/// Puts a second face on a face's vertices, turned over or not.
fn double_face(cage: &mut Cage, random: &mut Random) -> Option<()> {
    let face = random_face(cage, random);
    let mut double = cage.faces[face].clone();
    if random.percent(50) {
        double.reverse();
    }
    cage.faces.push(double);
    Some(())
}
