//! Colours of vertices on the GPU. They do not change from frame to frame, so the CPU refines them once, by the twins of the
//! stages that refine positions. Shader: `glsl/shared/colors.glsl`.

use planish_gpu::{Buffer, Device};
use planish_subdiv::ControlMesh;
use planish_subdiv::gregory::GregorySurface;
use planish_subdiv::mesh::VertexInterpolation;
use planish_subdiv::tables::{MeshRanges, Tables};

use crate::error::Error;
use crate::limit::limit;
use crate::subdivide::subdivide_values;
use crate::upload::table;

/// What a mesh without colours has.
const WHITE: [f32; 3] = [1.0; 3];

/// Colours as the shaders look them up.
#[derive(Clone, Debug, Default, PartialEq)]
struct ColorTables {
    /// Of the points of all levels; empty where no mesh has colours that are subdivided.
    points: Vec<[f32; 3]>,
    /// Of the limit points; empty likewise.
    limits: Vec<[f32; 3]>,
    /// Of the control points of Gregory patches, [`GREGORY_POINTS`] a face; empty likewise, and where there are none.
    gregory: Vec<[f32; 3]>,
    /// Of all meshes' density slots, which are vertices and n-gons; empty where no mesh has colours that are bilinear.
    slots: Vec<[f32; 3]>,
}

impl ColorTables {
    fn new(meshes: &[&ControlMesh], ranges: &[MeshRanges], tables: &Tables) -> Self {
        let mut result = Self::default();
        let cage_colors = cage_values(meshes, ranges, tables);
        if has(meshes, VertexInterpolation::Vertex) {
            result.points = subdivide_values(tables, &cage_colors);
            result.limits = limit(tables, &result.points).iter().map(|limit| limit.position).collect();
            result.gregory = gregory_values(tables, &cage_colors);
        }
        if has(meshes, VertexInterpolation::Varying) {
            result.slots = slot_values(ranges, tables, &cage_colors);
        }
        result
    }
}

/// Control points of a Gregory patch in the table; triangles have fewer.
const GREGORY_POINTS: usize = 20;

/// The colours of the control points of all Gregory patches, made as the points themselves are.
fn gregory_values(tables: &Tables, cage_values: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut values = vec![WHITE; GREGORY_POINTS * tables.gregory.faces.len()];
    if tables.gregory.rival.is_some() {
        return values;
    }
    let surface = GregorySurface::of_values(tables, cage_values);
    for (face, values) in (0..).zip(values.chunks_exact_mut(GREGORY_POINTS)) {
        let points = surface.patch(face).map_or_else(Vec::new, |patch| patch.points);
        values.iter_mut().zip(points).for_each(|(value, point)| *value = point.map(|c| c as f32));
    }
    values
}

/// Whether any mesh has such colours.
fn has(meshes: &[&ControlMesh], interpolation: VertexInterpolation) -> bool {
    meshes.iter().filter_map(|mesh| mesh.colors.as_ref()).any(|colors| colors.interpolation == interpolation)
}

/// The colours of all cage points.
fn cage_values(meshes: &[&ControlMesh], ranges: &[MeshRanges], tables: &Tables) -> Vec<[f32; 3]> {
    let mut values = vec![WHITE; tables.cage_point_count as usize];
    for (mesh, range) in meshes.iter().zip(ranges) {
        if let Some(colors) = &mesh.colors {
            values[range.cage_points.start as usize..][..colors.values.len()].copy_from_slice(&colors.values);
        }
    }
    values
}

/// The colours of all meshes' slots: those of vertices, and the means of the vertices of n-gons.
fn slot_values(ranges: &[MeshRanges], tables: &Tables, cage_values: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut values = Vec::with_capacity(tables.slots.rings.count() as usize);
    for range in ranges {
        let of_mesh = &cage_values[range.cage_points.start as usize..range.cage_points.end as usize];
        values.extend(of_mesh);
        let ngons = range.slots.start + of_mesh.len() as u32..range.slots.end;
        values.extend(ngons.map(|slot| mean(tables.slots.rings.of(slot), of_mesh)));
    }
    values
}

/// The mean of the values of some vertices.
fn mean(vertices: &[u32], values: &[[f32; 3]]) -> [f32; 3] {
    std::array::from_fn(|c| {
        let sum: f64 = vertices.iter().map(|&vertex| f64::from(values[vertex as usize][c])).sum();
        (sum / vertices.len() as f64) as f32
    })
}

/// The tables on the GPU.
pub(crate) struct ColorBuffers {
    pub points: Buffer,
    pub limits: Buffer,
    pub gregory: Buffer,
    pub slots: Buffer,
}

impl ColorBuffers {
    /// Where no colour is asked for.
    pub fn none(device: &Device) -> Result<Self, Error> {
        Self::of(device, &ColorTables::default())
    }

    /// The colours of meshes with these tables.
    pub fn new(
        device: &Device,
        meshes: &[&ControlMesh],
        ranges: &[MeshRanges],
        tables: &Tables,
    ) -> Result<Self, Error> {
        Self::of(device, &ColorTables::new(meshes, ranges, tables))
    }

    fn of(device: &Device, tables: &ColorTables) -> Result<Self, Error> {
        Ok(Self {
            points: table(device, "colours of points", &tables.points)?,
            limits: table(device, "colours of limit points", &tables.limits)?,
            gregory: table(device, "colours of Gregory patches", &tables.gregory)?,
            slots: table(device, "colours of slots", &tables.slots)?,
        })
    }

    pub fn all(&self) -> [&Buffer; 4] {
        [&self.points, &self.limits, &self.gregory, &self.slots]
    }
}

#[cfg(test)]
mod tests {
    use planish_subdiv::mesh::VertexColors;

    use super::*;
    use crate::{SurfaceDesc, preprocess};

    /// A pentagon beside a quad; vertex i has the colour (i, 0, -i).
    fn pair(interpolation: VertexInterpolation) -> ControlMesh {
        let values = (0..7_u8).map(|i| [f32::from(i), 0.0, -f32::from(i)]).collect();
        ControlMesh {
            positions: [[0, 0], [2, 0], [3, 2], [1, 3], [-1, 2], [4, 0], [5, 2]]
                .map(|[x, y]: [i8; 2]| [f32::from(x), f32::from(y), 0.0])
                .to_vec(),
            face_sizes: vec![5, 4],
            face_vertices: vec![0, 1, 2, 3, 4, 1, 5, 6, 2],
            colors: Some(VertexColors { values, interpolation }),
            ..ControlMesh::default()
        }
    }

    fn tables(meshes: &[&ControlMesh]) -> (ColorTables, Tables) {
        let made = preprocess(meshes, &SurfaceDesc { level: 2, ..SurfaceDesc::default() }).expect("legal meshes");
        (ColorTables::new(meshes, &made.meshes, &made.tables), made.tables)
    }

    #[test]
    fn there_are_tables_for_nothing_but_what_meshes_have() {
        let plain = ControlMesh { colors: None, ..pair(VertexInterpolation::Vertex) };
        assert_eq!(tables(&[&plain]).0, ColorTables::default());
        let (vertex, made) = tables(&[&pair(VertexInterpolation::Vertex)]);
        assert_eq!((vertex.points.len(), vertex.limits.len()), (made.point_count() as usize, made.limits.rows.len()));
        assert!(vertex.slots.is_empty());
        let (varying, _) = tables(&[&pair(VertexInterpolation::Varying)]);
        assert!(varying.points.is_empty() && varying.limits.is_empty() && !varying.slots.is_empty());
    }

    #[test]
    fn slots_are_vertices_and_means_of_n_gons_mesh_by_mesh_and_others_are_white() {
        let plain = ControlMesh { colors: None, ..pair(VertexInterpolation::Vertex) };
        let (colors, _) = tables(&[&plain, &pair(VertexInterpolation::Varying)]);
        let (first, second) = colors.slots.split_at(8);
        assert_eq!(first, [WHITE; 8]);
        assert_eq!(second, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 2.0].map(|c| [c, 0.0, -c]));
    }

    #[test]
    fn points_of_meshes_without_colours_are_white_beside_others() {
        let plain = ControlMesh { colors: None, ..pair(VertexInterpolation::Vertex) };
        let (colors, made) = tables(&[&pair(VertexInterpolation::Vertex), &plain]);
        let points = colors.points.iter().filter(|&&color| color == WHITE).count();
        assert_eq!(points, made.point_count() as usize / 2);
        assert_eq!(colors.points[6], [6.0, 0.0, -6.0]);
    }
}
