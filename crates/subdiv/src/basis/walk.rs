//! Pieces of a mesh by how they hang together: walked from a half-edge on, two pieces with the same word are the same.

use std::collections::HashMap;

use crate::basis::poly::{BORDER, CUT, Poly};
use crate::mesh::{Creasing, INFINITE_SHARPNESS};

/// A piece: its vertices in the order of the walk, and the word that says all about how they are connected.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Walk {
    /// Vertices of the mesh that was walked.
    pub vertices: Vec<u32>,
    /// The word: for each face its sides, its vertices by their place in the walk, their sharpness, and what lies across each edge.
    pub word: Vec<u32>,
}

/// What a word says of an edge besides its sharpness.
const ACROSS: u32 = 0;

/// Walks the given faces, in ascending order, from a half-edge of one of them on. Edges in `closed` have nothing across.
pub(crate) fn walk(poly: &Poly, start: u32, faces: &[u32], closed: &[u32]) -> Walk {
    let mut walk = Walk::default();
    let mut place: HashMap<u32, u32> = HashMap::new();
    let mut is_walked = vec![false; faces.len()];
    let at = |h: u32| faces.binary_search(&poly.face[h as usize]).ok();
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(entry) = queue.pop_front() {
        let Some(face) = at(entry).filter(|&face| !is_walked[face]) else { continue };
        is_walked[face] = true;
        walk.word.push(poly.sides(faces[face]));
        let mut h = entry;
        loop {
            let vertex = poly.origin(h);
            let next = place.len() as u32;
            let number = *place.entry(vertex).or_insert(next);
            walk.word.push(number);
            if number == next {
                walk.vertices.push(vertex);
                walk.word.push(poly.vertex_sharpness[vertex as usize].to_bits());
            }
            let is_closed = closed.contains(&poly.edge[h as usize]);
            let twin = poly.twin(h);
            walk.word.push(if is_closed { INFINITE_SHARPNESS.to_bits() } else { poly.sharpness(h).to_bits() });
            walk.word.push(if is_closed || twin == BORDER {
                BORDER
            } else if twin == CUT || at(twin).is_none() {
                CUT
            } else {
                queue.push_back(twin);
                ACROSS
            });
            h = poly.next(h);
            if h == entry {
                break;
            }
        }
    }
    walk
}

impl Walk {
    /// The piece as a mesh of its own: vertex i is the i-th of the walk, half-edge 0 the one that it began with.
    pub fn poly(&self, creasing: Creasing) -> Poly {
        let (mut first, mut origin, mut sharpness, mut across) = (vec![], vec![], vec![], vec![]);
        let mut vertex_sharpness = Vec::new();
        let mut word = self.word.iter().copied();
        while let Some(sides) = word.next() {
            first.push(origin.len() as u32);
            for _ in 0..sides {
                let mut read = || word.next().expect("a whole word");
                let vertex = read();
                if vertex as usize == vertex_sharpness.len() {
                    vertex_sharpness.push(f32::from_bits(read()));
                }
                origin.push(vertex);
                sharpness.push(f32::from_bits(read()));
                across.push(read());
            }
        }
        first.push(origin.len() as u32);
        let mut half_of: HashMap<[u32; 2], u32> = HashMap::new();
        let mut heads = vec![0; origin.len()];
        for ends in first.windows(2) {
            for h in ends[0]..ends[1] {
                let next = if h + 1 == ends[1] { ends[0] } else { h + 1 };
                heads[h as usize] = origin[next as usize];
                half_of.insert([origin[h as usize], origin[next as usize]], h);
            }
        }
        let twin = (0..origin.len())
            .map(|h| if across[h] == ACROSS { half_of[&[heads[h], origin[h]]] } else { across[h] })
            .collect();
        Poly::new(first, origin, twin, &sharpness, vertex_sharpness, creasing)
    }
}
