//! A mesh file's faces: Ptex numbering and boundary, independently of the renderer's own reader.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::Path;

/// One side of a Ptex face's parameter domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Side {
    /// Ptex face.
    pub face: u32,
    /// Which side: 0 is v = 0, 1 is u = 1, 2 is v = 1, 3 is u = 0.
    pub index: u8,
}

/// A control mesh.
#[derive(Clone, Debug, Default)]
pub struct Cage {
    /// Vertices, as the file has them.
    pub positions: Vec<[f64; 3]>,
    /// Vertices of each face, from 0.
    pub faces: Vec<Vec<usize>>,
    /// Whether faces with a vertex on the boundary have no limit surface (`interpolateboundary` 0).
    pub without_boundary: bool,
}

impl Cage {
    /// Reads an OBJ file whose every face is of plain positive indices.
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut cage = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.as_slice() {
                ["v", x, y, z, ..] => {
                    cage.positions.push([x, y, z].map(|word| word.parse().expect("a coordinate is a number")));
                }
                ["f", corners @ ..] => {
                    let vertex = |corner: &&str| corner.split('/').next().and_then(|index| index.parse::<usize>().ok());
                    let vertices = corners.iter().map(|corner| vertex(corner).expect("an index is a number") - 1);
                    cage.faces.push(vertices.collect());
                }
                ["t", "interpolateboundary", "1/0/0", mode] => cage.without_boundary = *mode == "0",
                _ => {}
            }
        }
        cage
    }

    /// Number of Ptex faces: a quad is one, any other face one a side.
    pub fn ptex_face_count(&self) -> usize {
        self.faces.iter().map(|face| ptex_faces_of(face)).sum()
    }

    /// Length of the bounding box' diagonal.
    pub fn diagonal(&self) -> f64 {
        let extent = |axis: usize| {
            let along = || self.positions.iter().map(|position| position[axis]);
            along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
        };
        (0..3).map(|axis| extent(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// The sides of Ptex faces at which the limit surface ends, and the number of loops that they make.
    pub fn boundary(&self) -> (HashSet<Side>, usize) {
        let mut is_kept = vec![true; self.faces.len()];
        if self.without_boundary {
            let ends: HashSet<usize> =
                self.boundary_edges(&is_kept).into_iter().flat_map(|(_, _, edge)| edge).collect();
            is_kept = self.faces.iter().map(|face| face.iter().all(|vertex| !ends.contains(vertex))).collect();
        }
        let firsts: Vec<usize> = self
            .faces
            .iter()
            .scan(0, |first, face| {
                let this = *first;
                *first += ptex_faces_of(face);
                Some(this)
            })
            .collect();
        let mut sides = HashSet::new();
        let mut successor = HashMap::new();
        for (face, corner, [from, to]) in self.boundary_edges(&is_kept) {
            let size = self.faces[face].len();
            let mut add = |ptex: usize, index: usize| {
                sides.insert(Side { face: ptex as u32, index: index as u8 });
            };
            if size == 4 {
                add(firsts[face], corner);
            } else {
                add(firsts[face] + corner, 0);
                add(firsts[face] + (corner + 1) % size, 3);
            }
            successor.insert(from, to);
        }
        let mut loop_count = 0;
        while let Some(&start) = successor.keys().min() {
            let mut vertex = start;
            while let Some(next) = successor.remove(&vertex) {
                vertex = next;
            }
            assert_eq!(vertex, start, "the boundary is not manifold");
            loop_count += 1;
        }
        (sides, loop_count)
    }

    /// Face, corner and ends of the edges that only one of the kept faces has.
    fn boundary_edges(&self, is_kept: &[bool]) -> Vec<(usize, usize, [usize; 2])> {
        let corners = |face: usize| (0..self.faces[face].len()).map(move |corner| (face, corner));
        let kept = || (0..self.faces.len()).filter(|&face| is_kept[face]).flat_map(corners);
        let ends = |(face, corner): (usize, usize)| {
            let face = &self.faces[face];
            [face[corner], face[(corner + 1) % face.len()]]
        };
        let directed: HashSet<[usize; 2]> = kept().map(ends).collect();
        kept()
            .map(|place| (place.0, place.1, ends(place)))
            .filter(|&(_, _, [from, to])| !directed.contains(&[to, from]))
            .collect()
    }
}

fn ptex_faces_of(face: &[usize]) -> usize {
    if face.len() == 4 { 1 } else { face.len() }
}
