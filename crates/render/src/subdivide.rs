//! The subdivide stage: points of each level from those before (FAS section 3.2). Shader: `glsl/subdivide.comp`.

use planish_gpu::{ComputePipeline, Device, Encoder};
use planish_shaders::subdivide_comp::{PROGRAM, Push};
use planish_subdiv::tables::Tables;

use crate::error::Error;
use crate::program::compute_pipeline;
use crate::surface::Surface;
use crate::upload::address;

/// The stage's program.
pub(crate) struct Subdivide(ComputePipeline);

impl Subdivide {
    pub(crate) fn new(device: &Device) -> Result<Self, Error> {
        compute_pipeline(device, &PROGRAM).map(Self)
    }

    /// Records one dispatch a level (two where n-gons of many sides have their face points made first).
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let buffers = &surface.buffers;
        for rows in surface.tables.levels.iter().flat_map(|level| &level.dispatches).filter(|rows| !rows.is_empty()) {
            let push = Push {
                points: address(&buffers.points),
                rows: address(&buffers.rows),
                indices: address(&buffers.indices),
                weights: address(&buffers.weights),
                first_row: rows.start,
                row_count: rows.len() as u32,
                first_point: surface.tables.cage_point_count,
                ..Push::default()
            };
            encoder.compute(&self.0, &push, push.row_count);
        }
    }
}

/// CPU twin: the points of all levels, bit for bit as the shader makes them where f32 arithmetic is not fused.
pub fn subdivide(tables: &Tables, cage: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut points = cage.to_vec();
    points.resize(tables.point_count() as usize, [0.0; 3]);
    let stencils = &tables.stencils;
    for row_index in tables.levels.iter().flat_map(|level| &level.dispatches).flat_map(Clone::clone) {
        let row = stencils.rows[row_index as usize];
        let indices = &stencils.indices[row.first_index as usize..][..row.count as usize];
        let weights = &stencils.weights[row.first_weight as usize..][..row.count as usize];
        let origin = points[indices[0] as usize];
        let mut sum = [0.0_f32; 3];
        for (&index, &weight) in indices.iter().zip(weights).skip(1) {
            let point = points[index as usize];
            for c in 0..3 {
                sum[c] += weight * (point[c] - origin[c]);
            }
        }
        points[(tables.cage_point_count + row_index) as usize] = std::array::from_fn(|c| origin[c] + sum[c]);
    }
    points
}
