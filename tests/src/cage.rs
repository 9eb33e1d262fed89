//! A mesh file's faces: Ptex numbering and boundary, independently of the renderer's own reader.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::Path;

/// Sharpness from which on an edge is infinitely sharp.
const INFINITE_SHARPNESS: f64 = 10.0;

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
    /// Faces that are not drawn.
    pub holes: HashSet<usize>,
    /// Ends, the lower first, of edges that are infinitely sharp by a tag.
    pub infinite_edges: HashSet<[usize; 2]>,
    /// Whether hierarchical edits may sharpen edges.
    pub sharpens_edges: bool,
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
                ["t", "hole", counts, faces @ ..] => {
                    cage.holes.extend(numbers(&faces[..count_of(counts)]).into_iter().map(|face| face as usize));
                }
                ["t", "crease", counts, values @ ..] => {
                    let (vertices, sharpness) = values.split_at(count_of(counts));
                    cage.add_crease(&numbers(vertices), &numbers(sharpness));
                }
                ["t", "edgeedit", ..] => cage.sharpens_edges = true,
                _ => {}
            }
        }
        cage
    }

    /// Notes the edges of a crease that are infinitely sharp; a later crease overrides an earlier one.
    fn add_crease(&mut self, vertices: &[f64], sharpness: &[f64]) {
        for (index, pair) in vertices.windows(2).enumerate() {
            let edge = sorted([pair[0] as usize, pair[1] as usize]);
            if sharpness[index.min(sharpness.len() - 1)] >= INFINITE_SHARPNESS {
                self.infinite_edges.insert(edge);
            } else {
                self.infinite_edges.remove(&edge);
            }
        }
    }

    /// For each face whether it has a limit surface that is drawn.
    pub fn drawn_faces(&self) -> Vec<bool> {
        let mut is_drawn: Vec<bool> = (0..self.faces.len()).map(|face| !self.holes.contains(&face)).collect();
        if self.without_boundary {
            let counts = self.edge_counts(&vec![true; self.faces.len()]);
            let is_open = |edge: &[usize; 2]| counts[edge] == 1 && !self.infinite_edges.contains(edge);
            let ends: HashSet<usize> = counts.keys().filter(|edge| is_open(edge)).flatten().copied().collect();
            for (is_drawn, face) in is_drawn.iter_mut().zip(&self.faces) {
                *is_drawn &= face.iter().all(|vertex| !ends.contains(vertex));
            }
        }
        is_drawn
    }

    /// Whether the surface has one normal everywhere: no infinitely sharp edge, and none that is not manifold.
    pub fn is_smooth(&self) -> bool {
        self.infinite_edges.is_empty() && !self.sharpens_edges && self.is_manifold()
    }

    /// For each Ptex face whether it is drawn.
    pub fn drawn_ptex_faces(&self) -> Vec<bool> {
        let faces = self.faces.iter().zip(self.drawn_faces());
        faces.flat_map(|(face, is_drawn)| vec![is_drawn; ptex_faces_of(face)]).collect()
    }

    /// How many of these faces each edge has; edges by their ends, the lower first.
    fn edge_counts(&self, is_kept: &[bool]) -> HashMap<[usize; 2], usize> {
        let mut counts = HashMap::new();
        for (face, _) in self.faces.iter().zip(is_kept).filter(|(_, is_kept)| **is_kept) {
            for (corner, &from) in face.iter().enumerate() {
                *counts.entry(sorted([from, face[(corner + 1) % face.len()]])).or_default() += 1;
            }
        }
        counts
    }

    /// Of how many drawn faces the edge along each side of a drawn Ptex face is, where those are not two.
    pub fn side_counts(&self) -> HashMap<Side, usize> {
        let is_drawn = self.drawn_faces();
        let counts = self.edge_counts(&is_drawn);
        let firsts = self.first_ptex_faces();
        let mut sides = HashMap::new();
        for (index, face) in self.faces.iter().enumerate().filter(|&(index, _)| is_drawn[index]) {
            for (corner, &from) in face.iter().enumerate() {
                let count = counts[&sorted([from, face[(corner + 1) % face.len()]])];
                if count != 2 {
                    sides.extend(sides_of_edge(firsts[index], face.len(), corner).map(|side| (side, count)));
                }
            }
        }
        sides
    }

    /// Whether every edge has one face, or two that run opposite ways along it, and the boundary passes each vertex once.
    pub fn is_manifold(&self) -> bool {
        let is_drawn = self.drawn_faces();
        let mut directed = HashSet::new();
        let kept = || self.faces.iter().zip(&is_drawn).filter(|(_, is_drawn)| **is_drawn).map(|(face, _)| face);
        let once = kept()
            .all(|face| (0..face.len()).all(|corner| directed.insert([face[corner], face[(corner + 1) % face.len()]])));
        let mut starts = HashSet::new();
        once && self.boundary_edges(&is_drawn).into_iter().all(|(_, _, [from, _])| starts.insert(from))
    }

    /// Number of Ptex faces: a quad is one, any other face one a side.
    pub fn ptex_face_count(&self) -> usize {
        self.faces.iter().map(|face| ptex_faces_of(face)).sum()
    }

    /// Length of the bounding box' diagonal.
    pub fn diagonal(&self) -> f64 {
        let (low, high) = self.bounding_box();
        (0..3).map(|axis| (high[axis] - low[axis]).powi(2)).sum::<f64>().sqrt()
    }

    /// The lowest and the highest coordinates.
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        let along = |axis: usize| self.positions.iter().map(move |position| position[axis]);
        let low = [0, 1, 2].map(|axis| along(axis).fold(f64::MAX, f64::min));
        (low, [0, 1, 2].map(|axis| along(axis).fold(f64::MIN, f64::max)))
    }

    /// The sides of Ptex faces at which the limit surface ends, and the number of loops that they make.
    pub fn boundary(&self) -> (HashSet<Side>, usize) {
        let is_kept = self.drawn_faces();
        let firsts = self.first_ptex_faces();
        let mut sides = HashSet::new();
        let mut successor = HashMap::new();
        for (face, corner, [from, to]) in self.boundary_edges(&is_kept) {
            sides.extend(sides_of_edge(firsts[face], self.faces[face].len(), corner));
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

    /// The first Ptex face of each face.
    fn first_ptex_faces(&self) -> Vec<usize> {
        let next = |first: &mut usize, face: &Vec<usize>| Some(std::mem::replace(first, *first + ptex_faces_of(face)));
        self.faces.iter().scan(0, next).collect()
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

/// The sides of Ptex faces along edge `corner` of a face of `size` sides.
fn sides_of_edge(first: usize, size: usize, corner: usize) -> impl Iterator<Item = Side> {
    let quad = [Some((first, corner)), None];
    let halves = [Some((first + corner, 0)), Some((first + (corner + 1) % size, 3))];
    let sides = if size == 4 { quad } else { halves };
    sides.into_iter().flatten().map(|(face, index)| Side { face: face as u32, index: index as u8 })
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The number of ints of a tag by its counts.
fn count_of(counts: &str) -> usize {
    counts.split('/').next().and_then(|count| count.parse().ok()).expect("a tag has counts")
}

fn numbers(words: &[&str]) -> Vec<f64> {
    words.iter().map(|word| word.parse().expect("a tag's values are numbers")).collect()
}

fn ptex_faces_of(face: &[usize]) -> usize {
    if face.len() == 4 { 1 } else { face.len() }
}
