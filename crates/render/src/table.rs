//! Basis function tables on the GPU (Hollaender and Boubekeur 2010): faces of the cage subdivided once, and which of them are drawn
//! how finely. Shaders: `glsl/emit_table.comp`, `glsl/table_patch.tesc`, `glsl/table_patch.tese`.

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder, SpecConstant};
use planish_shaders as shaders;
use planish_shaders::{DrawEntry, EmitPush, EmitView, Object, TableNormalsPush};
use planish_subdiv::selection::density_at;
use planish_subdiv::tables::{BasisEdge, BasisPatch, BasisTable, MeshRanges, TABLE_TRIANGLE, Tables};

use crate::error::Error;
use crate::limit::unit_vector;
use crate::lists::{CHUNK, LIST_BASE};
use crate::objects::to_world;
use crate::options::{FrameNeeds, TableNormals, TableWeights};
use crate::program::{compute_pipeline, specialized_compute_pipeline};
use crate::select::head_offset;
use crate::surface::Surface;
use crate::upload::{address, array, table};
use crate::visibility::{add, cross, point_outside_planes, sub, times};

/// The tables.
pub(crate) struct BasisBuffers {
    pub patches: Buffer,
    pub edges: Buffer,
    pub controls: Buffer,
    pub weights: Buffer,
    pub tangents: Buffer,
    /// What 1 stands for in weights of 16 bits.
    pub short_scale: f32,
    pub rings: Buffer,
    pub ring_indices: Buffer,
    /// Of the points of all levels, which frames make.
    pub normals: Buffer,
}

impl BasisBuffers {
    pub fn new(device: &Device, tables: &Tables, stored: TableWeights) -> Result<Self, Error> {
        let basis = &tables.basis;
        let short_scale = basis.weights.iter().fold(1.0, |most: f32, weight| most.max(weight.abs()));
        let (rings, ring_indices) = rings(basis);
        let normal_count = if basis.rings.is_empty() { 0 } else { tables.point_count() };
        Ok(Self {
            rings: table(device, "rings of vertices", &rings)?,
            ring_indices: table(device, "indices of rings", &ring_indices)?,
            normals: array::<shaders::Points>(device, "normals of points", normal_count)?,
            patches: table(device, "table patches", &basis.patches.iter().map(patch).collect::<Vec<_>>())?,
            edges: table(device, "table edges", &basis.edges.iter().map(edge).collect::<Vec<_>>())?,
            controls: table(device, "table controls", &basis.controls)?,
            weights: match stored {
                TableWeights::Float => table(device, "basis functions", &basis.weights)?,
                TableWeights::Short => table(device, "basis functions", &short_weights(&basis.weights, short_scale))?,
            },
            tangents: match stored {
                TableWeights::Float => table(device, "tangents of basis functions", &basis.tangents)?,
                TableWeights::Short => table(device, "tangents of basis functions", &short_tangents(&basis.tangents))?,
            },
            short_scale,
        })
    }

    pub fn all(&self) -> [&Buffer; 8] {
        [
            &self.patches,
            &self.edges,
            &self.controls,
            &self.weights,
            &self.tangents,
            &self.rings,
            &self.ring_indices,
            &self.normals,
        ]
    }
}

/// A number from -1 to 1 as `unpackSnorm2x16` reads it: rounded away from 0 on both sides of it.
fn short(number: f32) -> u32 {
    const MOST: f32 = 32767.0;
    u32::from((number.clamp(-1.0, 1.0) * MOST).round() as i16 as u16)
}

/// Two weights a word.
fn short_weights(weights: &[f32], scale: f32) -> Vec<u32> {
    let word = |pair: &[f32]| pair.iter().rev().fold(0, |word, weight| word << 16 | short(weight / scale));
    weights.chunks(2).map(word).collect()
}

fn short_tangents(tangents: &[[f32; 2]]) -> Vec<u32> {
    tangents.iter().map(|[a, b]| short(*a) | short(*b) << 16).collect()
}

/// OPEN_RING of `glsl/table_normals.comp`.
const OPEN_RING: u32 = 1 << 31;

fn rings(basis: &BasisTable) -> (Vec<shaders::StencilRow>, Vec<u32>) {
    let mut indices = Vec::new();
    let row = |(ring, is_closed): &(Vec<u32>, bool)| {
        let first_index = indices.len() as u32;
        indices.extend(ring);
        let count = ring.len() as u32 | if *is_closed || ring.is_empty() { 0 } else { OPEN_RING };
        shaders::StencilRow { first_index, first_weight: 0, count }
    };
    let rows = basis.rings.iter().map(row).collect();
    (rows, indices)
}

fn patch(patch: &BasisPatch) -> shaders::TablePatch {
    shaders::TablePatch {
        corners: patch.corners,
        edges: patch.edges,
        first_control: patch.first_control,
        control_count: patch.control_count,
        first_weight: patch.first_weight,
        ptex_face: patch.ptex_face,
        corner_uvs: patch.corner_uvs,
        flags: patch.flags,
    }
}

fn edge(edge: &BasisEdge) -> shaders::TableEdge {
    shaders::TableEdge {
        first_control: edge.first_control,
        control_count: edge.control_count,
        first_weight: edge.first_weight,
    }
}

/// The emit stage of this method.
pub(crate) struct EmitTable {
    patches: ComputePipeline,
    finish: ComputePipeline,
}

impl EmitTable {
    pub fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        let spec = [
            SpecConstant {
                id: shaders::emit_table_comp::SPEC_BATCH_VERTICES,
                bits: crate::emit::batch_vertices(device),
            },
            SpecConstant { id: shaders::emit_table_comp::SPEC_PLACED, bits: u32::from(needs.placed) },
            SpecConstant { id: shaders::emit_table_comp::SPEC_CULL, bits: u32::from(needs.culls) },
        ];
        Ok(Self {
            patches: specialized_compute_pipeline(device, &shaders::emit_table_comp::PROGRAM, CHUNK, &spec)?,
            finish: compute_pipeline(device, &shaders::finish_lists_comp::PROGRAM)?,
        })
    }

    /// Records the stage: two dispatches. Takes the time `emit`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let push = EmitPush { scene: address(&surface.frame.scene), list: LIST_BASE as u32, ..EmitPush::default() };
        encoder.compute_indirect(&self.patches, &push, &surface.lists.heads, head_offset(LIST_BASE));
        let push = shaders::finish_lists_comp::Push { heads: address(&surface.lists.draw_heads) };
        encoder.compute(&self.finish, &push, CHUNK);
        encoder.timestamp("emit");
    }
}

/// The stage that makes normals of vertices (`glsl/table_normals.comp`).
pub(crate) struct VertexNormals {
    rings: ComputePipeline,
    stencils: ComputePipeline,
    limits: ComputePipeline,
}

impl VertexNormals {
    pub fn new(device: &Device) -> Result<Self, Error> {
        Ok(Self {
            rings: compute_pipeline(device, &shaders::table_normals_rings_comp::PROGRAM)?,
            stencils: compute_pipeline(device, &shaders::table_normals_stencils_comp::PROGRAM)?,
            limits: compute_pipeline(device, &shaders::table_normals_limits_comp::PROGRAM)?,
        })
    }

    /// Records the stage after limit points are made: a dispatch over the rings of a level, one for each level after it, and one over limit
    /// points.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let (tables, buffers, frame) = (&surface.tables, &surface.buffers, &surface.frame);
        let basis = &buffers.basis;
        let push = TableNormalsPush {
            points: address(&frame.points),
            normals: address(&basis.normals),
            limits: address(&frame.limits),
            rows: address(&basis.rings),
            indices: address(&basis.ring_indices),
            weights: address(&buffers.weights),
            limit_weights: address(&buffers.limit_weights),
            first_point: tables.levels[tables.basis.ring_level as usize].points.start,
            count: tables.basis.rings.len() as u32,
            ..TableNormalsPush::default()
        };
        encoder.compute(&self.rings, &push, push.count);
        let is_first_alone = u32::from(surface.desc.table_normals == TableNormals::Geometric);
        for level in &tables.levels[tables.basis.ring_level as usize + 1..] {
            let rows = level.points.start - tables.cage_point_count;
            let push = TableNormalsPush {
                rows: address(&buffers.rows),
                indices: address(&buffers.indices),
                first_row: rows,
                count: level.points.len() as u32,
                first_point: tables.cage_point_count,
                ..push
            };
            encoder.compute(&self.stencils, &push, push.count);
        }
        let count = tables.limit_point_count();
        if count > 0 {
            let push = TableNormalsPush {
                rows: address(&buffers.limit_rows),
                indices: address(&buffers.limit_indices),
                count,
                is_first_alone,
                ..push
            };
            encoder.compute(&self.limits, &push, count);
        }
    }
}

/// What the twin of the emit stage needs to know of an object.
pub struct EmitTableInput<'a> {
    /// Tables of all meshes.
    pub tables: &'a Tables,
    /// The object's mesh.
    pub mesh: &'a MeshRanges,
    /// The object, and its number.
    pub object: (&'a Object, u32),
    /// Densities of its slots.
    pub densities: &'a [f32],
    /// Points of all levels.
    pub points: &'a [[f32; 3]],
    /// The view.
    pub view: &'a EmitView,
}

/// CPU twin of `glsl/emit_table.comp`, bit for bit where f32 arithmetic is not fused: entries in ascending order.
pub fn emit_table(input: &EmitTableInput<'_>) -> Vec<DrawEntry> {
    /// OBJECT_IN_HULL of the shaders.
    const IN_HULL: u32 = 1;
    let basis = &input.tables.basis;
    let (object, number) = input.object;
    let is_tested = input.view.cull != 0 && object.flags & IN_HULL != 0;
    let entry = |place: u32| {
        let patch = &basis.patches[place as usize];
        let controls = &basis.controls[patch.first_control as usize..][..patch.control_count as usize];
        let outside = |&control: &u32| {
            point_outside_planes(to_world(object, input.points[control as usize]), input.view, object.displacement)
        };
        if is_tested && controls.iter().fold(31, |planes, control| planes & outside(control)) != 0 {
            return None;
        }
        let low = edge_factors(input, patch);
        let segments = low.iter().fold(1.0, |most: f32, &factor| most.max(factor)).ceil() as u32;
        let flags = segments.next_power_of_two();
        Some(DrawEntry { place, object: number, flags, triangles: 2 * flags * flags, low, ..DrawEntry::default() })
    };
    input.mesh.patches[0].clone().filter_map(entry).collect()
}

/// `table_factors` of `glsl/shared/table_factors.glsl`.
fn edge_factors(input: &EmitTableInput<'_>, patch: &BasisPatch) -> [f32; 4] {
    let basis = &input.tables.basis;
    let scale = (-(basis.steps as f32)).exp2();
    let slots = input.tables.ptex_faces[(input.mesh.ptex_faces.start + patch.ptex_face) as usize];
    let is_triangle = patch.flags & TABLE_TRIANGLE != 0;
    let sides = if is_triangle { 3 } else { 4 };
    let density = |corner: usize| {
        let [u, v] = [0, 3].map(|shift| scale * (patch.corner_uvs >> (6 * corner + shift) & 7) as f32);
        if is_triangle {
            let at = slots.map(|slot| input.densities[slot as usize]);
            return ((1.0 - u - v) * at[0] + u * at[1]) + v * at[2];
        }
        density_at(input.densities, slots, u, v)
    };
    let mut factors = [1.0; 4];
    for (edge, factor) in factors.iter_mut().enumerate().take(sides) {
        let asked = (0.5 * (density(edge) + density((edge + 1) % sides))) * scale;
        *factor = asked.clamp(1.0, (1 << basis.level) as f32);
    }
    factors
}

/// CPU twin of `glsl/table_normals.comp`, bit for bit where f32 arithmetic is not fused: normals of the points of all levels, and of limit
/// points. Those of levels before the one that has rings are 0.
pub fn vertex_normals(tables: &Tables, normals: TableNormals, points: &[[f32; 3]]) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut made = vec![[0.0; 3]; points.len()];
    let basis = &tables.basis;
    let first = tables.levels[basis.ring_level as usize].points.start as usize;
    for (i, (ring, is_closed)) in basis.rings.iter().enumerate() {
        let offset = |k: usize| sub(points[ring[k % ring.len()] as usize], points[first + i]);
        let count = if *is_closed || ring.is_empty() { ring.len() } else { ring.len() - 1 };
        let sum = (0..count).fold([0.0; 3], |sum, k| add(sum, cross(offset(k), offset(k + 1))));
        made[first + i] = unit_vector(sum);
    }
    let weighed = |made: &[[f32; 3]], indices: &[u32], weight: &dyn Fn(usize) -> f32| {
        let terms = indices.iter().enumerate().map(|(k, &index)| times(made[index as usize], weight(k)));
        unit_vector(terms.fold([0.0; 3], add))
    };
    for level in &tables.levels[basis.ring_level as usize + 1..] {
        for point in level.points.clone() {
            let row = tables.stencils.rows[(point - tables.cage_point_count) as usize];
            let indices = &tables.stencils.indices[row.first_index as usize..][..row.count as usize];
            let weights = &tables.stencils.weights[row.first_weight as usize..];
            made[point as usize] = weighed(&made, indices, &|k| weights[k]);
        }
    }
    let is_first_alone = normals == TableNormals::Geometric;
    let limit = |row: &planish_subdiv::stencil::StencilRow| {
        let count = if is_first_alone { 1 } else { row.count as usize };
        let indices = &tables.limits.indices[row.first_index as usize..][..count];
        let weights = &tables.limits.weights[row.first_weight as usize..];
        weighed(&made, indices, &|k| if is_first_alone { 1.0 } else { weights[k][0] })
    };
    let limits = tables.limits.rows.iter().map(limit).collect();
    (made, limits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_weights_are_symmetric_and_nearest() {
        for i in 0..=1000 {
            let weight = i as f32 * 1e-3;
            let read = |word: u32| f32::from(word as u16 as i16) / 32767.0;
            assert_eq!(read(short(weight)), -read(short(-weight)));
            assert!((read(short(weight)) - weight).abs() <= 0.5001 / 32767.0);
        }
        assert_eq!(short_weights(&[1.0, -1.0, 0.5], 1.0), [0x8001_7FFF, 0x4000]);
        assert_eq!(short_weights(&[1.25], 1.25), [0x7FFF]);
    }
}
