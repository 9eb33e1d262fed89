//! A dump as it is compared: triangles with a place on the base mesh.

use std::path::Path;

use anyhow::{Result, bail};
use glam::{DVec2, DVec3, Vec2, Vec3};
use planish_film::read_ply_stream;
use planish_scene::Bounds;

/// A vertex of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub position: Vec3,
    /// Of unit length, or 0 where the surface has none.
    pub normal: Vec3,
    pub uv: Vec2,
}

/// A triangle of one Ptex face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    pub face: i32,
    pub corners: [Corner; 3],
}

/// A point on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    pub position: DVec3,
    /// Interpolated, so shorter than 1; 0 where there is none.
    pub normal: DVec3,
    pub uv: DVec2,
}

impl Triangle {
    pub fn positions(&self) -> [DVec3; 3] {
        self.corners.map(|corner| corner.position.as_dvec3())
    }

    pub fn uvs(&self) -> [DVec2; 3] {
        self.corners.map(|corner| corner.uv.as_dvec2())
    }

    pub fn area(&self) -> f64 {
        let [a, b, c] = self.positions();
        0.5 * (b - a).cross(c - a).length()
    }

    /// The point with these weights, whose sum is 1.
    pub fn at(&self, weights: [f64; 3]) -> SurfacePoint {
        let sum = |of: fn(&Corner) -> DVec3| {
            self.corners.iter().zip(weights).map(|(corner, weight)| weight * of(corner)).sum::<DVec3>()
        };
        SurfacePoint {
            position: sum(|corner| corner.position.as_dvec3()),
            normal: sum(|corner| corner.normal.as_dvec3()),
            uv: sum(|corner| corner.uv.as_dvec2().extend(0.0)).truncate(),
        }
    }
}

/// All triangles of a dump, those of a Ptex face one after the other.
#[derive(Debug, Default)]
pub struct Soup {
    pub triangles: Vec<Triangle>,
}

impl Soup {
    /// Reads a dump; refuses one without triangles, and one with places that are none.
    pub fn read(path: &Path) -> Result<Self> {
        let (mut triangles, mut corners) = (Vec::new(), Vec::with_capacity(3));
        let (mut index, mut fault) = (0_u64, None);
        read_ply_stream(path, |vertex| {
            let corner =
                Corner { position: vertex.position.into(), normal: vertex.normal.into(), uv: vertex.uv.into() };
            let is_finite = corner.position.is_finite() && corner.normal.is_finite();
            if !is_finite {
                fault.get_or_insert((index, "numbers that are not finite", "finite ones"));
            }
            if !(corner.uv.cmpge(Vec2::ZERO) & corner.uv.cmple(Vec2::ONE)).all() {
                fault.get_or_insert((index, "u and v outside of the face", "0 to 1"));
            }
            corners.push((vertex.face, corner));
            if let [(face, a), (second, b), (third, c)] = corners[..] {
                if face != second || face != third {
                    fault.get_or_insert((index, "a triangle of several faces", "one face a triangle"));
                }
                triangles.push(Triangle { face, corners: [a, b, c] });
                corners.clear();
            }
            index += 1;
        })?;
        if let Some((vertex, found, expected)) = fault {
            bail!("cannot compare {}: vertex {vertex}: found {found}, expected {expected}", path.display());
        }
        if triangles.is_empty() {
            bail!("cannot compare {}: found no triangles, expected a surface", path.display());
        }
        Ok(Self::new(triangles))
    }

    /// In an order that does not depend on the one in which a dump was captured.
    pub fn new(mut triangles: Vec<Triangle>) -> Self {
        let key = |triangle: &Triangle| (triangle.face, triangle.uvs().map(|uv| uv.to_array().map(f64::to_bits)));
        triangles.sort_unstable_by_key(key);
        Self { triangles }
    }

    /// The triangles of each Ptex face, faces in order.
    pub fn faces(&self) -> impl Iterator<Item = &[Triangle]> {
        self.triangles.chunk_by(|a, b| a.face == b.face)
    }

    pub fn area(&self) -> f64 {
        self.triangles.iter().map(Triangle::area).sum()
    }

    /// The box around it; none where there are no triangles.
    pub fn bounds(&self) -> Option<Bounds> {
        let corners = self.triangles.iter().flat_map(|triangle| triangle.corners);
        Bounds::of(corners.map(|corner| corner.position.to_array()))
    }
}
