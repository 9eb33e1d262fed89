//! Vertices that were split for their normals or texture coordinates become one again.
use std::collections::HashMap;

use super::primitive::{InfluenceSet, Primitive};

/// What became of vertices. Those of a mesh's primitives are counted one after another: *file vertices*.
#[derive(Debug, PartialEq)]
pub struct Welded {
    /// The cage's vertex of every file vertex.
    pub vertex_of: Vec<u32>,
    /// The first file vertex of every vertex of the cage: what it has, the vertex has. They ascend.
    pub first_of: Vec<u32>,
}

/// Unites vertices of the same position to the bit (0 and -0 are the same) that move alike: of the same offsets in every morph
/// target, and the same joints and weights. Vertices are in the order in which the file first has them, whether a face uses them
/// or not.
pub fn weld(primitives: &[Primitive]) -> Welded {
    let set_count = primitives.iter().map(|primitive| primitive.influences.len()).max().unwrap_or_default();
    let mut vertices: HashMap<Box<[u32]>, u32> = HashMap::new();
    let mut welded = Welded { vertex_of: Vec::new(), first_of: Vec::new() };
    let mut key = Vec::new();
    for primitive in primitives {
        for vertex in 0..primitive.positions.len() {
            key.clear();
            write_key(primitive, vertex, set_count, &mut key);
            let file_vertex = welded.vertex_of.len() as u32;
            let known = vertices.get(key.as_slice()).copied().unwrap_or_else(|| {
                let added = welded.first_of.len() as u32;
                vertices.insert(key.as_slice().into(), added);
                welded.first_of.push(file_vertex);
                added
            });
            welded.vertex_of.push(known);
        }
    }
    welded
}

/// Leaves vertices as the file has them; primitives that share their accessors share their vertices.
pub fn keep(primitives: &[Primitive]) -> Welded {
    let mut blocks: HashMap<&[usize], u32> = HashMap::new();
    let mut welded = Welded { vertex_of: Vec::new(), first_of: Vec::new() };
    for primitive in primitives {
        let count = primitive.positions.len() as u32;
        let (next, file_vertex) = (welded.first_of.len() as u32, welded.vertex_of.len() as u32);
        let first = *blocks.entry(&primitive.accessors).or_insert_with(|| {
            welded.first_of.extend(file_vertex..file_vertex + count);
            next
        });
        welded.vertex_of.extend(first..first + count);
    }
    welded
}

/// All that tells a vertex from another, as words.
fn write_key(primitive: &Primitive, vertex: usize, set_count: usize, key: &mut Vec<u32>) {
    let words = |vector: [f32; 3]| vector.map(|value| (value + 0.0).to_bits());
    key.extend(words(primitive.positions[vertex]));
    for target in &primitive.targets {
        key.extend(words(target.get(vertex).copied().unwrap_or_default()));
    }
    let start = key.len();
    let mut influences = influences(primitive, vertex);
    influences.sort_unstable_by_key(|&(joint, weight)| (joint, weight.to_bits()));
    key.extend(influences.iter().flat_map(|&(joint, weight)| [joint, weight.to_bits()]));
    key.resize(start + 8 * set_count, u32::MAX);
}

/// Joints and weights of a vertex; those of weight 0 have no say.
pub fn influences(primitive: &Primitive, vertex: usize) -> Vec<(u32, f32)> {
    let set = |set: &InfluenceSet| set.joints[vertex].into_iter().zip(set.weights[vertex]);
    let sets = primitive.influences.iter().flat_map(set);
    sets.filter(|&(_, weight)| weight != 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(xs: &[f32]) -> Primitive {
        Primitive { positions: xs.iter().map(|&x| [x, 0.0, 0.0]).collect(), ..Primitive::default() }
    }

    #[test]
    fn vertices_are_united_by_their_bits_in_the_order_of_the_file() {
        let welded = weld(&[at(&[5.0, 0.0, 5.0]), at(&[-0.0, 5.0000005, 7.0])]);
        assert_eq!(welded.vertex_of, [0, 1, 0, 1, 2, 3]);
        assert_eq!(welded.first_of, [0, 1, 4, 5]);
    }

    #[test]
    fn vertices_that_move_apart_stay_apart() {
        let morphed = Primitive { targets: vec![vec![[0.0; 3], [-0.0; 3], [1.0; 3]]], ..at(&[1.0, 1.0, 1.0]) };
        assert_eq!(weld(&[morphed]).vertex_of, [0, 0, 1]);
        let joints = vec![[1, 2, 0, 0], [2, 1, 9, 0], [1, 2, 0, 0], [1, 3, 0, 0]];
        let weights =
            vec![[0.25, 0.75, 0.0, 0.0], [0.75, 0.25, 0.0, 0.0], [0.75, 0.25, 0.0, 0.0], [0.25, 0.75, 0.0, 0.0]];
        let skinned = Primitive { influences: vec![InfluenceSet { joints, weights }], ..at(&[1.0; 4]) };
        assert_eq!(weld(&[skinned]).vertex_of, [0, 0, 1, 2]);
    }

    #[test]
    fn vertices_that_are_kept_are_shared_by_primitives_that_share_accessors() {
        let of = |accessor| Primitive { accessors: vec![accessor], ..at(&[1.0, 1.0]) };
        let kept = keep(&[of(3), of(4), of(3)]);
        assert_eq!(kept, Welded { vertex_of: vec![0, 1, 2, 3, 0, 1], first_of: vec![0, 1, 2, 3] });
    }
}
