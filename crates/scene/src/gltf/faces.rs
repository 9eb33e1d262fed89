//! Triangles to faces: polygons that their order encodes, and what is checked of them.
use planish_subdiv::mesh::MAX_FACE_SIDES;

use super::fault::Fault;
use super::weld::Welded;
use crate::obj::Warnings;

/// The faces of a cage, one after another.
#[derive(Debug, Default, PartialEq)]
pub struct Faces {
    pub sizes: Vec<u32>,
    /// The file vertex of every corner.
    pub corners: Vec<u32>,
    /// The slot of every face.
    pub slots: Vec<u32>,
    /// Whether the file leaves open if a triangle is half a quad.
    pub is_pairable: Vec<bool>,
}

impl Faces {
    /// Adds a face.
    pub fn push(&mut self, corners: &[u32], slot: u32, is_pairable: bool) {
        self.sizes.push(corners.len() as u32);
        self.corners.extend_from_slice(corners);
        self.slots.push(slot);
        self.is_pairable.push(is_pairable);
    }

    /// Adds triangles, whose vertices are counted from `first`. With `keeps_ngons`, triangles in a row that share their first
    /// vertex are a fan of one polygon (FB_ngon_encoding).
    pub fn add(&mut self, triangles: &[[u32; 3]], first: u32, slot: u32, keeps_ngons: bool) {
        let mut polygon: Vec<u32> = Vec::new();
        for triangle in triangles {
            let [anchor, from, to] = triangle.map(|vertex| first + vertex);
            if keeps_ngons && polygon.first() == Some(&anchor) && polygon.last() == Some(&from) {
                polygon.push(to);
                continue;
            }
            if !polygon.is_empty() {
                self.push(&polygon, slot, !keeps_ngons);
            }
            polygon.clear();
            polygon.extend([anchor, from, to]);
        }
        if !polygon.is_empty() {
            self.push(&polygon, slot, !keeps_ngons);
        }
    }

    /// The file vertices of every face.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut rest = self.corners.as_slice();
        self.sizes.iter().map(move |&size| {
            let (face, after) = rest.split_at(size as usize);
            rest = after;
            face
        })
    }

    /// Refuses faces that name a vertex twice once welded, or drops them with `repair`. Returns what became of each face.
    pub fn check(
        &mut self,
        welded: &Welded,
        repair: bool,
        place: &str,
        warnings: &mut Warnings,
    ) -> Result<Vec<Option<u32>>, Fault> {
        // The last face that named each vertex, from 1.
        let mut named_by = vec![0u32; welded.first_of.len()];
        let mut kept = Self::default();
        let mut map = Vec::with_capacity(self.sizes.len());
        for (face, corners) in self.iter().enumerate() {
            let number = face as u32 + 1;
            let mut vertices = corners.iter().map(|&corner| welded.vertex_of[corner as usize]);
            let repeated = vertices.find(|&v| std::mem::replace(&mut named_by[v as usize], number) == number);
            let (found, expected) = match repeated {
                Some(vertex) => {
                    (format!("a face with vertex {vertex} of the cage twice"), "different vertices".to_owned())
                }
                None if corners.len() > MAX_FACE_SIDES as usize => {
                    (format!("a face of {} sides", corners.len()), format!("at most {MAX_FACE_SIDES}"))
                }
                None => {
                    map.push(Some(kept.sizes.len() as u32));
                    kept.push(corners, self.slots[face], self.is_pairable[face]);
                    continue;
                }
            };
            if !repair {
                return Err(Fault::new(format!("{place}: face {face}"), found, expected));
            }
            warnings.push(None, format!("{place}: face {face}: {found}: dropped"));
            map.push(None);
        }
        *self = kept;
        Ok(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes_and_corners(triangles: &[[u32; 3]], keeps_ngons: bool) -> (Vec<u32>, Vec<u32>) {
        let mut faces = Faces::default();
        faces.add(triangles, 10, 0, keeps_ngons);
        (faces.sizes, faces.corners)
    }

    #[test]
    fn triangles_in_a_row_around_one_vertex_are_a_polygon() {
        let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [0, 7, 8], [0, 8, 9], [0, 9, 1]];
        let expected = (vec![4, 3, 5], vec![10, 11, 12, 13, 14, 15, 16, 10, 17, 18, 19, 11]);
        assert_eq!(sizes_and_corners(&triangles, true), expected);
        assert_eq!(sizes_and_corners(&triangles, false).0, [3; 6]);
    }

    #[test]
    fn a_fan_that_is_broken_off_is_another_polygon() {
        assert_eq!(sizes_and_corners(&[[0, 1, 2], [0, 3, 4]], true).0, [3, 3]);
    }
}
