//! Which faces form a manifold, consistently oriented.
use std::collections::{HashMap, HashSet};

/// Whether every edge has one face, or two that run along it in opposite ways, and the faces at every vertex are one fan.
pub fn is_manifold(faces: &[Vec<u32>]) -> bool {
    let mut face_counts: HashMap<u32, usize> = HashMap::new();
    // At each vertex, from the corner that a face enters by to the corner that it leaves by.
    let mut leaves: HashMap<(u32, u32), u32> = HashMap::new();
    for face in faces {
        for (i, &vertex) in face.iter().enumerate() {
            let before = face[(i + face.len() - 1) % face.len()];
            let after = face[(i + 1) % face.len()];
            *face_counts.entry(vertex).or_default() += 1;
            if leaves.insert((vertex, after), before).is_some() {
                return false;
            }
        }
    }
    let entered: HashSet<(u32, u32)> = leaves.iter().map(|(&(vertex, _), &before)| (vertex, before)).collect();
    // An edge that two faces enter a vertex by would be missing here.
    if entered.len() != leaves.len() {
        return false;
    }
    let mut starts: HashMap<u32, u32> = HashMap::new();
    for &(vertex, after) in leaves.keys() {
        let is_boundary = !entered.contains(&(vertex, after));
        let start = starts.entry(vertex).or_insert(after);
        if is_boundary {
            *start = after;
        }
    }
    starts.iter().all(|(&vertex, &start)| {
        let (mut edge, mut met) = (start, 0);
        while let Some(&next) = leaves.get(&(vertex, edge)) {
            met += 1;
            edge = next;
            if edge == start {
                break;
            }
        }
        met == face_counts[&vertex]
    })
}

/// Whether no vertex inside a manifold has two faces only.
pub fn has_no_valence_2(faces: &[Vec<u32>]) -> bool {
    let mut neighbors: HashMap<u32, HashSet<u32>> = HashMap::new();
    let mut face_counts: HashMap<u32, usize> = HashMap::new();
    for face in faces {
        for (i, &vertex) in face.iter().enumerate() {
            let after = face[(i + 1) % face.len()];
            neighbors.entry(vertex).or_default().insert(after);
            neighbors.entry(after).or_default().insert(vertex);
            *face_counts.entry(vertex).or_default() += 1;
        }
    }
    face_counts.iter().all(|(vertex, &count)| count != 2 || neighbors[vertex].len() != 2)
}

/// Whether a fan at a vertex begins and ends at one edge of many faces, while the crease through the vertex goes on
/// along another such edge, which the fan does not have.
pub fn has_slit_fan(faces: &[Vec<u32>]) -> bool {
    let mut runs: HashMap<[u32; 2], Vec<(usize, bool)>> = HashMap::new();
    for (index, face) in faces.iter().enumerate() {
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            runs.entry([a.min(b), a.max(b)]).or_default().push((index, a < b));
        }
    }
    let is_joint = |edge: &[u32; 2]| matches!(runs[edge][..], [(_, forward), (_, other)] if forward != other);
    let mut edges_of: HashMap<u32, Vec<[u32; 2]>> = HashMap::new();
    runs.keys().for_each(|edge| edge.iter().for_each(|&vertex| edges_of.entry(vertex).or_default().push(*edge)));
    edges_of.values().any(|edges| {
        let (joints, ends): (Vec<[u32; 2]>, Vec<_>) = edges.iter().partition(|edge| is_joint(edge));
        let is_crease = ends.len() == 2 && ends.iter().all(|end| runs[end].len() > 1);
        is_crease && ends.iter().any(|end| has_slit_at(*end, &joints, |edge| runs[edge].iter().map(|&(face, _)| face)))
    })
}

/// Whether two faces of an edge are joined by the other edges at a vertex.
fn has_slit_at<Faces: Iterator<Item = usize>>(
    end: [u32; 2],
    joints: &[[u32; 2]],
    faces_of: impl Fn(&[u32; 2]) -> Faces,
) -> bool {
    let at_end: Vec<usize> = faces_of(&end).collect();
    at_end.iter().any(|&start| {
        let mut fan = HashSet::from([start]);
        let mut size = 0;
        while fan.len() > size {
            size = fan.len();
            for joint in joints {
                if faces_of(joint).any(|face| fan.contains(&face)) {
                    fan.extend(faces_of(joint));
                }
            }
        }
        at_end.iter().filter(|face| fan.contains(face)).count() > 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manifolds_are_told_from_others() {
        let quad = vec![0, 1, 2, 3];
        assert!(is_manifold(&[quad.clone(), vec![1, 0, 4, 5]]));
        assert!(!is_manifold(&[quad.clone(), vec![0, 1, 4, 5]]), "opposite orientation");
        assert!(!is_manifold(&[quad.clone(), vec![1, 0, 4, 5], vec![1, 0, 6, 7]]), "three faces at an edge");
        assert!(!is_manifold(&[quad.clone(), vec![2, 4, 5, 6]]), "two fans on the boundary");
        let tetrahedron = |a, b, c, d| [vec![a, b, c], vec![a, d, b], vec![a, c, d], vec![b, d, c]];
        assert!(is_manifold(&tetrahedron(0, 1, 2, 3)));
        assert!(!is_manifold(&[tetrahedron(0, 1, 2, 3), tetrahedron(0, 4, 5, 6)].concat()), "two fans inside");
        assert!(is_manifold(&[quad, vec![3, 2, 1, 0]]));
    }

    #[test]
    fn slit_fans_are_told_from_sheets_that_share_edges() {
        // Around vertex 0: a fan from edge 0-1 all around to edge 0-1, and three fins between it and edge 0-7.
        let around = [vec![0, 1, 2, 3], vec![0, 3, 4, 5], vec![0, 5, 6, 1]];
        let fins = [vec![0, 1, 8, 7], vec![0, 1, 9, 7], vec![0, 1, 10, 7]];
        assert!(has_slit_fan(&[around.to_vec(), fins.to_vec()].concat()));
        let page = |a, b| [vec![1, 0, a, a + 1], vec![0, 7, b, a]];
        assert!(!has_slit_fan(&[page(20, 30), page(40, 50), page(60, 70)].concat()));
    }

    #[test]
    fn vertices_with_two_faces_inside_are_found() {
        assert!(has_no_valence_2(&[vec![0, 1, 2, 3], vec![1, 0, 4, 5]]));
        assert!(!has_no_valence_2(&[vec![0, 1, 2, 3], vec![0, 3, 2, 4]]));
    }
}
