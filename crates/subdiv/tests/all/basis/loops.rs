//! Loop's scheme against the same written down once more, by edges in a map, and the limit masks of his thesis.

use std::collections::HashMap;

use planish_subdiv::scheme::Scheme;

use super::{LEVEL, cross, grid, lattice, on_triangle, size, tables, triangle_meshes, unit};
use crate::surface::distance;

/// Rows have 32-bit weights.
const TOLERANCE: f64 = 2e-6;
/// Side of the cells that points are sought in.
const CELL: f64 = 1e-3;

/// A mesh of triangles.
struct Triangles {
    points: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
}

/// What a vertex has around it.
#[derive(Clone, Default)]
struct Around {
    /// Ends of its edges.
    ring: Vec<u32>,
    /// Those of edges of one face.
    rim: Vec<u32>,
}

impl Triangles {
    fn opposites(&self) -> HashMap<[u32; 2], Vec<u32>> {
        let mut opposites: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
        for face in &self.faces {
            for i in 0..3 {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                opposites.entry([a.min(b), a.max(b)]).or_default().push(face[(i + 2) % 3]);
            }
        }
        opposites
    }

    fn around(&self, opposites: &HashMap<[u32; 2], Vec<u32>>) -> Vec<Around> {
        let mut around = vec![Around::default(); self.points.len()];
        for (&[a, b], opposite) in opposites {
            for (from, to) in [(a, b), (b, a)] {
                around[from as usize].ring.push(to);
                if opposite.len() == 1 {
                    around[from as usize].rim.push(to);
                }
            }
        }
        around
    }

    fn sum(&self, terms: impl IntoIterator<Item = (f64, u32)>) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (weight, point) in terms {
            (0..3).for_each(|c| sum[c] += weight * self.points[point as usize][c]);
        }
        sum
    }

    /// A vertex with weight `weights[0]`, inside or on the rim, and with what is left of 1 for its neighbours; a corner as it is.
    fn weighed(&self, vertex: u32, around: &Around, inside: impl Fn(f64) -> f64, on_rim: f64) -> [f64; 3] {
        let (own, ends) = match around.rim[..] {
            [] => (inside(around.ring.len() as f64), &around.ring),
            // With one face it is a corner.
            _ if around.ring.len() == 2 => (1.0, &around.rim),
            _ => (on_rim, &around.rim),
        };
        let share = (1.0 - own) / ends.len() as f64;
        self.sum([(own, vertex)].into_iter().chain(ends.iter().map(|&end| (share, end))))
    }

    fn split(&self) -> Self {
        let opposites = self.opposites();
        let around = self.around(&opposites);
        let own = |n: f64| 1.0 - n * beta(n);
        let mut points: Vec<[f64; 3]> =
            (0..).zip(&around).map(|(vertex, around)| self.weighed(vertex, around, own, 0.75)).collect();
        let mut middle = HashMap::new();
        for (&[a, b], opposite) in &opposites {
            middle.insert([a, b], points.len() as u32);
            points.push(match opposite[..] {
                [c, d] => self.sum([(0.375, a), (0.375, b), (0.125, c), (0.125, d)]),
                _ => self.sum([(0.5, a), (0.5, b)]),
            });
        }
        let of = |a: u32, b: u32| middle[&[a.min(b), a.max(b)]];
        let children = |&[a, b, c]: &[u32; 3]| {
            let (ab, bc, ca) = (of(a, b), of(b, c), of(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        Self { points, faces: self.faces.iter().flat_map(children).collect() }
    }

    /// Limit positions, and of vertices inside unit normals.
    ///
    /// With v' = (1 - n b) v + n b q for the mean q of the neighbours, and q' = 3/8 v + 5/8 q, what stays is v + 8/3 n b q, and of the
    /// rim, where v' = 3/4 v + 1/4 q and q' = (v + q) / 2, v + q / 2. Tangents weigh the neighbours with cosines and sines.
    fn limits(&self) -> Vec<([f64; 3], Option<[f64; 3]>)> {
        let around = self.around(&self.opposites());
        let mut next: Vec<HashMap<u32, u32>> = vec![HashMap::new(); self.points.len()];
        for face in &self.faces {
            for i in 0..3 {
                next[face[i] as usize].insert(face[(i + 1) % 3], face[(i + 2) % 3]);
            }
        }
        let own = |n: f64| 1.0 / (1.0 + 8.0 / 3.0 * n * beta(n));
        let normal = |vertex: usize| {
            let n = around[vertex].ring.len();
            let ends =
                std::iter::successors(Some(around[vertex].ring[0]), |end| next[vertex].get(end).copied()).take(n);
            let ends: Vec<u32> = ends.collect();
            let along = |shift: f64| {
                let weight = |i: usize| (std::f64::consts::TAU * (i as f64 / n as f64 - shift)).cos();
                self.sum(ends.iter().enumerate().map(|(i, &end)| (weight(i), end)))
            };
            unit(cross(along(0.0), along(0.25)))
        };
        let limit = |vertex: usize| {
            let is_inside = around[vertex].rim.is_empty();
            let position = self.weighed(vertex as u32, &around[vertex], own, 2.0 / 3.0);
            (position, is_inside.then(|| normal(vertex)))
        };
        (0..self.points.len()).map(limit).collect()
    }
}

fn beta(n: f64) -> f64 {
    (0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / n).cos()).powi(2)) / n
}

#[test]
fn loop_rows_are_the_limit_points_of_the_level_they_sample() {
    for (number, mesh) in triangle_meshes().iter().enumerate() {
        let (tables, table_points) = tables(mesh, Scheme::Loop);
        let mut fine = Triangles {
            points: mesh.positions.iter().map(|p| p.map(f64::from)).collect(),
            faces: mesh.face_vertices.as_chunks::<3>().0.to_vec(),
        };
        (0..=LEVEL).for_each(|_| fine = fine.split());
        let limits = fine.limits();
        let cell = |p: [f64; 3]| p.map(|c| (c / CELL).round() as i64);
        let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        (0..).zip(&limits).for_each(|(i, (position, _))| cells.entry(cell(*position)).or_default().push(i));
        let mut is_met = vec![false; limits.len()];
        for point in grid(&tables, &table_points).into_iter().flatten() {
            let [x, y, z] = cell(point.position);
            let near = (0..27).filter_map(|k| cells.get(&[x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1])).flatten();
            let apart = |i: usize| distance(limits[i].0, point.position);
            let nearest = near.copied().min_by(|&a, &b| apart(a).total_cmp(&apart(b)));
            let place = format!("mesh {number}, face {} at {:?}", point.ptex_face, point.uv);
            let nearest = nearest.unwrap_or_else(|| panic!("{place}: nothing near"));
            assert!(apart(nearest) < TOLERANCE * size(mesh), "{place}: {:e}", apart(nearest));
            if let Some(normal) = limits[nearest].1 {
                let apart = distance(normal, point.normal);
                assert!(apart < 2e-4, "{place}: normals {apart:e} apart");
            }
            is_met[nearest] = true;
        }
        assert!(is_met.iter().all(|&is_met| is_met), "mesh {number}: {:?}", is_met.iter().position(|&is_met| !is_met));
    }
}

#[test]
fn loop_points_lie_at_their_parameters_inside_a_flat_lattice() {
    // Where all is linear the scheme moves nothing: parameters and corners of patches are told right.
    let n = 5;
    let mesh = lattice(n, |x, y| 0.2 * x - 0.7 * y);
    let (tables, points) = tables(&mesh, Scheme::Loop);
    let mut checked = 0;
    for point in grid(&tables, &points).into_iter().flatten() {
        let expected = on_triangle(&mesh, point.ptex_face, point.uv);
        let is_inside = |vertex: &u32| [vertex % (n + 1), vertex / (n + 1)].iter().all(|&at| at > 0 && at < n);
        if mesh.face_vertices[3 * point.ptex_face as usize..][..3].iter().all(is_inside) {
            let error = distance(point.position, expected);
            assert!(error < TOLERANCE * size(&mesh), "face {} at {:?}: {error:e}", point.ptex_face, point.uv);
            checked += 1;
        }
    }
    assert!(checked > 1000, "{checked}");
}
