//! Edge rotations in meshes of quads: each takes an edge from two vertices and gives it to two others, which makes
//! vertices of valence 3 and 5 out of regular ones, and higher valences where rotations meet.
use std::collections::HashMap;

use glam::DVec3;

use crate::cage::Cage;
use crate::random::Random;

/// Valences that rotations may lead to.
const VALENCES: std::ops::RangeInclusive<u32> = 3..=9;

/// Rotates `count` random edges of a closed mesh of quads, as far as there are edges that can be.
pub fn rotate_random_edges(cage: &mut Cage, count: usize, random: &mut Random) {
    let mut edges = Edges::of(cage);
    let mut left = count;
    for _ in 0..count * 10 {
        if left == 0 {
            break;
        }
        let face = random.below(cage.faces.len());
        left -= usize::from(edges.rotate(&mut cage.faces, face, random.below(4)));
    }
}

/// What is kept about a mesh while edges rotate.
struct Edges {
    /// The face left of each directed edge.
    face_of: HashMap<[u32; 2], usize>,
    valences: Vec<u32>,
}

impl Edges {
    fn of(cage: &Cage) -> Self {
        let mut edges = Self { face_of: HashMap::new(), valences: vec![0; cage.positions.len()] };
        for (index, face) in cage.faces.iter().enumerate() {
            edges.enter(face, index);
            face.iter().for_each(|&vertex| edges.valences[vertex as usize] += 1);
        }
        edges
    }

    fn enter(&mut self, face: &[u32], index: usize) {
        for (i, &from) in face.iter().enumerate() {
            self.face_of.insert([from, face[(i + 1) % face.len()]], index);
        }
    }

    /// Rotates edge `side` of a face; false when valences or an edge in the way forbid it.
    fn rotate(&mut self, faces: &mut [Vec<u32>], face: usize, side: usize) -> bool {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| faces[face][(side + i) % 4]);
        let Some(&other) = self.face_of.get(&[b, a]) else {
            return false;
        };
        let Some(start) = faces[other].iter().position(|&vertex| vertex == b) else {
            return false;
        };
        // The two quads are the hexagon b c d a e f; the edge a-b becomes c-e.
        let [e, f] = [2, 3].map(|i| faces[other][(start + i) % 4]);
        let valence = |vertex: u32| self.valences[vertex as usize];
        let fits = VALENCES.contains(&(valence(a) - 1))
            && VALENCES.contains(&(valence(b) - 1))
            && VALENCES.contains(&(valence(c) + 1))
            && VALENCES.contains(&(valence(e) + 1));
        let in_the_way = self.face_of.contains_key(&[c, e]) || self.face_of.contains_key(&[e, c]);
        if !fits || in_the_way || c == e {
            return false;
        }
        self.face_of.remove(&[a, b]);
        self.face_of.remove(&[b, a]);
        [a, b].iter().for_each(|&vertex| self.valences[vertex as usize] -= 1);
        [c, e].iter().for_each(|&vertex| self.valences[vertex as usize] += 1);
        faces[face] = vec![c, d, a, e];
        faces[other] = vec![e, f, b, c];
        self.enter(&faces[face], face);
        self.enter(&faces[other], other);
        true
    }
}

/// Moves every vertex to the mean of its neighbours, then maps it by `project`; `rounds` times.
pub fn relax(cage: &mut Cage, rounds: u32, project: impl Fn(DVec3) -> DVec3) {
    for _ in 0..rounds {
        let mut sums = vec![(DVec3::ZERO, 0.0); cage.positions.len()];
        for face in &cage.faces {
            for (i, &from) in face.iter().enumerate() {
                let (sum, count) = &mut sums[from as usize];
                *sum += cage.positions[face[(i + 1) % face.len()] as usize];
                *count += 1.0;
            }
        }
        for (position, (sum, count)) in cage.positions.iter_mut().zip(sums) {
            *position = project(sum / count);
        }
    }
}
