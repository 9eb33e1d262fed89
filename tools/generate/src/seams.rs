//! Texture coordinates with seams: charts are cut along edges of a mesh.
use std::collections::HashMap;

use glam::{DVec2, DVec3};

use crate::cage::Cage;
use crate::random::Random;

/// How far the coordinates at one vertex are from each other at most on the sides of a seam, along each axis.
const SHIFT: f64 = 0.35;

impl Cage {
    /// The mesh with texture coordinates that are cut along the edges that `is_seam` says. A seam may end inside.
    ///
    /// `project` maps positions; on each side of a seam the result is moved a little, by numbers that follow from `seed`.
    pub fn with_seams(self, seed: u64, is_seam: impl Fn([u32; 2]) -> bool, project: impl Fn(DVec3) -> DVec2) -> Self {
        let classes = corner_classes(&self.faces, is_seam);
        self.with_corner_classes(&classes, seed, project)
    }

    /// The same, cut between faces of different charts.
    pub fn with_charts(self, seed: u64, chart: impl Fn(usize) -> u32, project: impl Fn(DVec3) -> DVec2) -> Self {
        let mut charts: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
        for (index, face) in self.faces.iter().enumerate() {
            sides(face).for_each(|side| charts.entry(sorted(side)).or_default().push(chart(index)));
        }
        self.with_seams(seed, |edge| charts[&sorted(edge)].windows(2).any(|pair| pair[0] != pair[1]), project)
    }

    /// The mesh with one texture coordinate for each class of its faces' corners, counted over all faces.
    pub fn with_corner_classes(mut self, classes: &[u32], seed: u64, project: impl Fn(DVec3) -> DVec2) -> Self {
        let mut random = Random::new(seed);
        let mut number_of: HashMap<u32, u32> = HashMap::new();
        let mut classes = classes.iter();
        (self.uvs, self.face_uvs) = (Vec::new(), Vec::new());
        for face in &self.faces {
            let mut uvs = Vec::with_capacity(face.len());
            for (&vertex, class) in face.iter().zip(&mut classes) {
                uvs.push(*number_of.entry(*class).or_insert_with(|| {
                    let shift = DVec2::new(random.unit(), random.unit()) * SHIFT;
                    self.uvs.push(project(self.positions[vertex as usize]) + shift);
                    self.uvs.len() as u32 - 1
                }));
            }
            self.face_uvs.push(uvs);
        }
        self
    }
}

/// A number for each corner of each face: equal for corners of a vertex that hang together without crossing a seam.
pub fn corner_classes(faces: &[Vec<u32>], is_seam: impl Fn([u32; 2]) -> bool) -> Vec<u32> {
    let corner_count: usize = faces.iter().map(Vec::len).sum();
    let mut parents: Vec<u32> = (0..corner_count as u32).collect();
    let mut at_edge: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    let mut first = 0;
    for face in faces {
        for (i, [a, b]) in (0..).zip(sides(face)) {
            let [at_a, at_b] = [first + i, first + (i + 1) % face.len() as u32];
            let own = if a < b { [at_a, at_b] } else { [at_b, at_a] };
            let edge = sorted([a, b]);
            match at_edge.get(&edge) {
                Some(other) if !is_seam(edge) => {
                    own.into_iter().zip(*other).for_each(|(a, b)| unite(&mut parents, a, b));
                }
                _ => {
                    at_edge.insert(edge, own);
                }
            }
        }
        first += face.len() as u32;
    }
    (0..corner_count as u32).map(|corner| root(&mut parents, corner)).collect()
}

/// Makes two classes one.
pub fn unite(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

fn root(parents: &mut [u32], mut corner: u32) -> u32 {
    while parents[corner as usize] != corner {
        parents[corner as usize] = parents[parents[corner as usize] as usize];
        corner = parents[corner as usize];
    }
    corner
}

fn sides(face: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    (0..face.len()).map(|i| [face[i], face[(i + 1) % face.len()]])
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheets;

    #[test]
    fn a_seam_cuts_between_its_ends_and_not_at_them() {
        let sheet = sheets::grid(4, 2, |i, j| DVec3::new(f64::from(i), 0.0, f64::from(j)));
        let [a, b, c] = [1.0, 2.0, 3.0].map(|x| sheet.above(x, 1.0));
        let cut = sheet.clone().with_seams(
            1,
            |edge| [[a, b], [b, c]].contains(&edge) || [[b, a], [c, b]].contains(&edge),
            |p| DVec2::new(p.x, p.z),
        );
        // One more coordinate than vertices: only the middle of the seam has two.
        assert_eq!(cut.uvs.len(), sheet.positions.len() + 1);
    }
}
