//! A mesh under construction, and its OBJ text.
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

use glam::{DMat3, DVec2, DVec3};

/// Decimals of the coordinates in a file: finer than a hundred-thousandth of a unit is nothing to see.
const DECIMALS: usize = 5;

/// Positions, faces and further lines of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cage {
    /// One position a vertex.
    pub positions: Vec<DVec3>,
    /// One colour a vertex, from 0 to 1 each; none if no vertex has one.
    pub colors: Vec<DVec3>,
    /// Vertex indices from 0 of each face, counter-clockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Texture coordinates; none if no corner has one.
    pub uvs: Vec<DVec2>,
    /// Texture coordinates' indices from 0, as `faces`; empty if no corner has one.
    pub face_uvs: Vec<Vec<u32>>,
    /// Subdivision tags, each a line of an OBJ file.
    pub tags: Vec<String>,
}

impl Cage {
    /// A mesh of the given vertices and faces.
    pub fn new<const N: usize>(positions: &[[f64; 3]], faces: &[[u32; N]]) -> Self {
        let positions = positions.iter().copied().map(DVec3::from).collect();
        Self { positions, faces: faces.iter().map(|face| face.to_vec()).collect(), ..Self::default() }
    }

    /// Adds a vertex and returns its index.
    pub fn vertex(&mut self, position: DVec3) -> u32 {
        self.positions.push(position);
        self.positions.len() as u32 - 1
    }

    /// Adds a face.
    pub fn face(&mut self, vertices: &[u32]) {
        self.faces.push(vertices.to_vec());
    }

    /// Adds another mesh as a component of its own, without its tags.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.faces.extend(other.faces.iter().map(|face| face.iter().map(|vertex| vertex + first).collect()));
    }

    /// Splits every quad in two triangles along its shorter diagonal. Texture coordinates are dropped.
    pub fn split_quads(&mut self) {
        let at = |vertex: u32| self.positions[vertex as usize];
        let halves = |face: &Vec<u32>| match face[..] {
            [a, b, c, d] if at(a).distance(at(c)) <= at(b).distance(at(d)) => vec![vec![a, b, c], vec![a, c, d]],
            [a, b, c, d] => vec![vec![a, b, d], vec![b, c, d]],
            _ => vec![face.clone()],
        };
        self.faces = self.faces.iter().flat_map(halves).collect();
        self.face_uvs.clear();
        self.uvs.clear();
    }

    /// The mesh with every position mapped; the map must not turn it inside out.
    pub fn map(mut self, position: impl Fn(DVec3) -> DVec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = position(*p));
        self
    }

    /// The mesh moved.
    pub fn moved(self, by: DVec3) -> Self {
        self.map(|p| p + by)
    }

    /// The mesh turned about an axis through the origin, counter-clockwise seen against the axis.
    pub fn turned(self, axis: DVec3, degrees: f64) -> Self {
        let turn = DMat3::from_axis_angle(axis.normalize(), degrees.to_radians());
        self.map(|p| turn * p)
    }

    /// The mesh with vertices closer together than `distance` made one. Vertices that no face uses go away.
    pub fn welded(self, distance: f64) -> Self {
        let key = |p: DVec3| (p / distance).round().to_array().map(|coordinate| coordinate as i64);
        let mut index_of = HashMap::new();
        let mut welded = Self { tags: self.tags, ..Self::default() };
        for face in &self.faces {
            let vertices = face.iter().map(|&vertex| {
                let position = self.positions[vertex as usize];
                *index_of.entry(key(position)).or_insert_with(|| welded.vertex(position))
            });
            let vertices: Vec<u32> = vertices.collect();
            welded.faces.push(vertices);
        }
        welded
    }

    /// The mesh with a colour at each vertex by its position.
    pub fn colored(mut self, color: impl Fn(DVec3) -> DVec3) -> Self {
        self.colors = self.positions.iter().map(|&position| color(position)).collect();
        self
    }

    /// The text of an OBJ file: a comment, then vertices, faces and tags.
    pub fn to_obj(&self, comment: &str) -> String {
        let mut text = format!("# {comment} Made by planish-generate.\n");
        for (vertex, position) in self.positions.iter().enumerate() {
            let values =
                position.to_array().into_iter().chain(self.colors.get(vertex).into_iter().flat_map(DVec3::to_array));
            let values: Vec<String> = values.map(decimal).collect();
            writeln!(text, "v {}", values.join(" ")).expect("writing to a string cannot fail");
        }
        for uv in &self.uvs {
            let [u, v] = uv.to_array().map(decimal);
            writeln!(text, "vt {u} {v}").expect("writing to a string cannot fail");
        }
        for (index, face) in self.faces.iter().enumerate() {
            text.push('f');
            for (corner, vertex) in face.iter().enumerate() {
                write!(text, " {}", vertex + 1).expect("writing to a string cannot fail");
                if let Some(uvs) = self.face_uvs.get(index) {
                    write!(text, "/{}", uvs[corner] + 1).expect("writing to a string cannot fail");
                }
            }
            text.push('\n');
        }
        for tag in &self.tags {
            writeln!(text, "{tag}").expect("writing to a string cannot fail");
        }
        // Readers differ in their default.
        if self.has_boundary() && !self.tags.iter().any(|tag| tag.contains("interpolateboundary")) {
            text.push_str("t interpolateboundary 1/0/0 1\n");
        }
        text
    }

    /// Whether an edge has one face only.
    fn has_boundary(&self) -> bool {
        let mut open = HashSet::new();
        for face in &self.faces {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                if !open.remove(&(b, a)) {
                    open.insert((a, b));
                }
            }
        }
        !open.is_empty()
    }
}

/// A coordinate as short as it can be written with [`DECIMALS`] decimals.
fn decimal(value: f64) -> String {
    let text = format!("{value:.DECIMALS$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_written_as_short_as_they_can_be() {
        let texts = [1.0, -0.000_001, 0.5, -12.345_678_9, 100.0].map(decimal);
        assert_eq!(texts, ["1", "0", "0.5", "-12.34568", "100"]);
    }

    #[test]
    fn welding_joins_close_vertices_and_drops_unused_ones() {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [9.0; 3], [1.0, 1e-9, 0.0]];
        let cage = Cage::new(&positions, &[[0, 1, 2], [0, 4, 2]]).welded(1e-6);
        assert_eq!((cage.positions.len(), cage.faces[0] == cage.faces[1]), (3, true));
    }
}
