//! Whether back faces can be left out.

use planish_subdiv::ControlMesh;

/// Whether the backs of a closed mesh's triangles are never seen from `eye`: all its components face outward, and the
/// eye is outside of the cage's bounding box, which holds the limit surface.
pub fn backs_are_hidden(mesh: &ControlMesh, eye: [f32; 3]) -> bool {
    let Some([low, high]) = mesh.bounding_box() else { return false };
    let inside = (0..3).all(|axis| (low[axis]..=high[axis]).contains(&eye[axis]));
    !inside && component_volumes(mesh).into_iter().all(|volume| volume > 0.0)
}

/// The signed volume of each component of a closed mesh, positive where its faces run counter-clockwise seen from outside.
fn component_volumes(mesh: &ControlMesh) -> Vec<f64> {
    let mut parents: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for_faces(mesh, |face| {
        for &vertex in &face[1..] {
            let (a, b) = (root(&mut parents, face[0]), root(&mut parents, vertex));
            parents[a as usize] = b;
        }
    });
    let mut volumes = vec![None; mesh.positions.len()];
    // Sums of tetrahedra over the first vertex: the terms stay as small as the mesh, wherever it lies.
    let origin = mesh.positions.first().copied().unwrap_or_default();
    let at = |vertex: u32| {
        let p = mesh.positions[vertex as usize];
        [0, 1, 2].map(|c| f64::from(p[c]) - f64::from(origin[c]))
    };
    for_faces(mesh, |face| {
        let a = at(face[0]);
        let sum: f64 = face[1..].windows(2).map(|edge| determinant(a, at(edge[0]), at(edge[1]))).sum();
        *volumes[root(&mut parents, face[0]) as usize].get_or_insert(0.0) += sum / 6.0;
    });
    volumes.into_iter().flatten().collect()
}

fn for_faces(mesh: &ControlMesh, mut f: impl FnMut(&[u32])) {
    let mut first = 0;
    for &sides in &mesh.face_sizes {
        f(&mesh.face_vertices[first..first + sides as usize]);
        first += sides as usize;
    }
}

/// The representative of a vertex' component; paths are halved on the way.
fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
    while parents[vertex as usize] != vertex {
        parents[vertex as usize] = parents[parents[vertex as usize] as usize];
        vertex = parents[vertex as usize];
    }
    vertex
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubes(flip_second: bool) -> ControlMesh {
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mut mesh = ControlMesh::default();
        for (cube, shift) in [(0, 0.0), (1, 5.0)] {
            mesh.positions.extend((0..8_u8).map(|i| {
                let [x, y, z] = [i & 1, i >> 1 & 1, i >> 2].map(f32::from);
                [x + shift, y, z]
            }));
            for mut face in faces {
                if flip_second && cube == 1 {
                    face.reverse();
                }
                mesh.face_sizes.push(4);
                mesh.face_vertices.extend(face.map(|v| v + 8 * cube));
            }
        }
        mesh
    }

    #[test]
    fn an_outward_mesh_hides_its_backs_from_outside_only() {
        let mesh = cubes(false);
        assert_eq!(component_volumes(&mesh), [1.0, 1.0]);
        assert!(backs_are_hidden(&mesh, [0.0, 9.0, 0.0]));
        assert!(!backs_are_hidden(&mesh, [0.5, 0.5, 0.5]));
    }

    #[test]
    fn one_component_turned_inside_out_shows_its_backs() {
        assert!(!backs_are_hidden(&cubes(true), [0.0, 9.0, 0.0]));
    }
}
