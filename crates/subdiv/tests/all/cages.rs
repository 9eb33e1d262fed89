//! Cages of the tests.

use std::collections::HashMap;

use planish_generate::cage::Cage;
use planish_generate::random::Random;
use planish_generate::random_cage::{Features, Recipe};
use planish_generate::seams::corner_classes;
use planish_subdiv::mesh::{
    BoundaryInterpolation, ControlMesh, Corner, Crease, Creasing, EditOperation, FaceVaryingChannel,
    FaceVaryingInterpolation, HierarchicalEdit, TriangleSubdivision,
};

pub fn mesh(positions: Vec<[f32; 3]>, faces: &[Vec<u32>]) -> ControlMesh {
    ControlMesh {
        positions,
        face_sizes: faces.iter().map(|f| f.len() as u32).collect(),
        face_vertices: faces.concat(),
        ..ControlMesh::default()
    }
}

/// A disc of `rings` rings of quads around a vertex of valence n; with `rings` >= 3 that vertex is isolated.
pub fn pole(n: u32, rings: u32) -> ControlMesh {
    // Sector s holds the grid points (i, j), 1 <= i <= rings, 0 <= j <= rings: i along its own axis, j along the next.
    let at = |s: u32, i: u32, j: u32| -> u32 {
        match (i, j) {
            (0, 0) => 0,
            (0, j) => 1 + (s + 1) % n * rings * (rings + 1) + (j - 1) * (rings + 1),
            (i, j) => 1 + s * rings * (rings + 1) + (i - 1) * (rings + 1) + j,
        }
    };
    let mut positions = vec![[0.0, 0.0, 1.0]; (1 + n * rings * (rings + 1)) as usize];
    let mut faces = Vec::new();
    for s in 0..n {
        for i in 0..=rings {
            for j in 0..=rings {
                let angle = |s: u32| (s % n) as f32 * std::f32::consts::TAU / n as f32;
                let (x0, y0) = (angle(s).cos(), angle(s).sin());
                let (x1, y1) = (angle(s + 1).cos(), angle(s + 1).sin());
                let (i, j) = (i as f32, j as f32);
                let (x, y) = (i * x0 + j * x1, i * y0 + j * y1);
                positions[at(s, i as u32, j as u32) as usize] = [x, y, (-0.3 * (x * x + y * y)).exp()];
            }
        }
        for i in 0..rings {
            for j in 0..rings {
                faces.push(vec![at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)]);
            }
        }
    }
    mesh(positions, &faces)
}

pub fn cube() -> ControlMesh {
    let positions = (0..8_u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    mesh(positions, &faces.map(|f| f.to_vec()))
}

/// A prism over an n-gon: two n-gons and n quads.
pub fn prism(n: u32) -> ControlMesh {
    let ring = |z: f32| {
        (0..n).map(move |i| {
            let angle = i as f32 * std::f32::consts::TAU / n as f32;
            [angle.cos(), angle.sin() * 1.2, z + 0.1 * (2.0 * angle).sin()]
        })
    };
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>(), (n..2 * n).collect()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]));
    mesh(ring(0.0).chain(ring(1.0)).collect(), &faces)
}

/// A sheet of m x n quads.
pub fn sheet(m: u32, n: u32) -> ControlMesh {
    let positions = (0..=n).flat_map(|j| (0..=m).map(move |i| [i as f32, j as f32, ((i * j) as f32).sin()])).collect();
    let faces: Vec<_> = (0..n)
        .flat_map(|j| (0..m).map(move |i| j * (m + 1) + i))
        .map(|a| vec![a, a + 1, a + m + 2, a + m + 1])
        .collect();
    mesh(positions, &faces)
}

/// The mesh with every edge of another sharpness, and some sharp vertices.
pub fn sharpened(mut mesh: ControlMesh, creasing: Creasing) -> ControlMesh {
    const SHARPNESS: [f32; 9] = [0.0, 2.3, 10.0, 0.3, 0.0, 1.0, 1.5, 0.0, 7.8];
    let mut first = 0;
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        for (i, &a) in face.iter().enumerate() {
            let b = face[(i + 1) % face.len()];
            let sharpness = SHARPNESS[(a * b + a + b) as usize % SHARPNESS.len()];
            mesh.creases.push(Crease { vertices: [a, b], sharpness });
        }
        first += sides as usize;
    }
    mesh.corners = vec![Corner { vertex: 1, sharpness: 2.3 }, Corner { vertex: 4, sharpness: 10.0 }];
    mesh.options.creasing = creasing;
    mesh
}

/// Quads that share an edge as the pages of a book share its spine, three quads high.
pub fn book(pages: u32) -> ControlMesh {
    let mut positions: Vec<[f32; 3]> = (0..4).map(|j| [0.0, j as f32, 0.1 * (j * j) as f32]).collect();
    let mut faces = Vec::new();
    for page in 0..pages {
        let angle = page as f32 * std::f32::consts::TAU / pages as f32;
        let first = positions.len() as u32;
        for i in 1..=2 {
            let x = i as f32;
            positions.extend((0..4).map(|j| [x * angle.cos(), j as f32 + 0.2 * x, x * angle.sin()]));
        }
        for j in 0..3 {
            faces.push(vec![j, first + j, first + j + 1, j + 1]);
            faces.push(vec![first + j, first + 4 + j, first + 5 + j, first + j + 1]);
        }
    }
    mesh(positions, &faces)
}

/// Two cubes that share a vertex.
pub fn bow_tie() -> ControlMesh {
    let one = cube();
    let other = |v: u32| if v == 0 { 7 } else { 7 + v };
    let mut positions = one.positions.clone();
    positions.extend(one.positions[1..].iter().map(|p| p.map(|c| c + 1.0)));
    let mut faces: Vec<Vec<u32>> = one.face_vertices.chunks(4).map(<[u32]>::to_vec).collect();
    faces.extend(one.face_vertices.chunks(4).map(|face| face.iter().map(|&v| other(v)).collect::<Vec<_>>()));
    mesh(positions, &faces)
}

/// What planish-generate makes, with the tags that its OBJ text would have.
pub fn of_cage(cage: &Cage) -> ControlMesh {
    let mut mesh = mesh(cage.positions.iter().map(|p| p.as_vec3().to_array()).collect(), &cage.faces);
    for line in &cage.tags {
        let words: Vec<&str> = line.split(' ').collect();
        let counts: Vec<usize> = words[2].split('/').map(|count| count.parse().expect("a count")).collect();
        let ints: Vec<u32> = words[3..][..counts[0]].iter().map(|word| word.parse().expect("an index")).collect();
        let floats: Vec<f32> =
            words[3 + counts[0]..][..counts[1]].iter().map(|word| word.parse().expect("a number")).collect();
        match words[1] {
            "crease" => mesh.creases.extend(
                (0..ints.len() - 1)
                    .map(|i| Crease { vertices: [ints[i], ints[i + 1]], sharpness: floats[i % floats.len()] }),
            ),
            "corner" => mesh.corners.push(Corner { vertex: ints[0], sharpness: floats[0] }),
            "hole" => mesh.holes.extend(ints),
            "interpolateboundary" => {
                mesh.options.boundary = match ints[0] {
                    0 => BoundaryInterpolation::None,
                    1 => BoundaryInterpolation::EdgeAndCorner,
                    _ => BoundaryInterpolation::EdgeOnly,
                }
            }
            "creasemethod" => mesh.options.creasing = Creasing::Chaikin,
            "smoothtriangles" => mesh.options.triangles = TriangleSubdivision::Smooth,
            name => panic!("unknown tag {name}"),
        }
    }
    mesh
}

/// A random cage with a boundary rule, some of them with hierarchical edits.
pub fn random(seed: u64) -> ControlMesh {
    let mut mesh = of_cage(&Recipe { seed, features: Features::ALL, operation_count: (seed % 5) as u32 }.cage());
    let mut random = Random::new(seed ^ 0xED17);
    if random.percent(40) {
        for _ in 0..=random.below(2) {
            let face = random.below(mesh.face_sizes.len());
            let mut path = vec![face as u32, random.below(mesh.face_sizes[face] as usize) as u32];
            (0..random.below(4)).for_each(|_| path.push(random.below(4) as u32));
            let operation = match random.below(4) {
                0 => EditOperation::AddPosition([0.1, 0.05, -0.1]),
                1 => EditOperation::SetVertexSharpness(2.5),
                2 => EditOperation::SetEdgeSharpness(10.0),
                _ => EditOperation::Hole,
            };
            mesh.edits.push(HierarchicalEdit { path, operation });
        }
    }
    mesh
}

/// A mesh with a face-varying channel whose values are its vertices' x and y, moved apart on the sides of random seams.
pub fn seamed(mut mesh: ControlMesh, seed: u64) -> ControlMesh {
    use FaceVaryingInterpolation::{All, Boundaries, CornersOnly, CornersPlus1, CornersPlus2, None};
    let mut random = Random::new(seed ^ 0x5EA);
    let mut faces: Vec<Vec<u32>> = Vec::new();
    let mut rest = mesh.face_vertices.as_slice();
    for &size in &mesh.face_sizes {
        let (face, after) = rest.split_at(size as usize);
        faces.push(face.to_vec());
        rest = after;
    }
    let percent = random.pick(&[5, 20, 50]);
    let seams: HashMap<[u32; 2], bool> = faces
        .iter()
        .flat_map(|face| face.iter().copied().zip(face.iter().copied().cycle().skip(1)))
        .map(|(a, b)| ([a.min(b), a.max(b)], random.percent(percent)))
        .collect();
    let indices = corner_classes(&faces, |[a, b]| seams[&[a.min(b), a.max(b)]]);
    // A class is called after its first corner, so it can name the value.
    let value = |(corner, &vertex): (usize, &u32)| {
        let [x, y, _] = mesh.positions[vertex as usize];
        [x + 0.01 * (corner % 7) as f32, y - 0.02 * (corner % 5) as f32]
    };
    let values = mesh.face_vertices.iter().enumerate().map(value).collect();
    mesh.face_varying = vec![FaceVaryingChannel { name: "st".to_owned(), values, indices }];
    mesh.options.face_varying = random.pick(&[None, CornersOnly, CornersPlus1, CornersPlus2, Boundaries, All]);
    mesh
}

/// A mesh with a face-varying channel without seams, whose values are its vertices' x and y.
pub fn with_continuous_values(mut mesh: ControlMesh) -> ControlMesh {
    let values = mesh.positions.iter().map(|p| [p[0], p[1]]).collect();
    let indices = mesh.face_vertices.clone();
    mesh.face_varying = vec![FaceVaryingChannel { name: "st".to_owned(), values, indices }];
    mesh
}

/// A cone of n triangles on an n-gon.
pub fn cone(n: u32) -> ControlMesh {
    let mut cone = prism(n);
    cone.positions.truncate(n as usize);
    cone.positions.push([0.0, 0.0, 1.0]);
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n]));
    mesh(cone.positions, &faces)
}

/// Two meshes without tags as one.
pub fn merged(a: &ControlMesh, b: &ControlMesh) -> ControlMesh {
    let mut both = a.clone();
    both.positions.extend(&b.positions);
    both.face_sizes.extend(&b.face_sizes);
    both.face_vertices.extend(b.face_vertices.iter().map(|vertex| vertex + a.positions.len() as u32));
    both
}
