//! The subdivide stage: points of each level from those before (FAS section 3.2). Shader: `glsl/subdivide.comp`.

use planish_gpu::{ComputePipeline, Device, Encoder};
use planish_shaders::subdivide_comp::{PROGRAM, Push};
use planish_subdiv::tables::{LevelPoints, Tables};

use crate::edit_points::{EditPoints, edit_points};
use crate::error::Error;
use crate::program::compute_pipeline;
use crate::surface::Surface;
use crate::upload::address;

/// The stage's programs.
pub(crate) struct Subdivide {
    points: ComputePipeline,
    edits: EditPoints,
}

impl Subdivide {
    pub(crate) fn new(device: &Device) -> Result<Self, Error> {
        Ok(Self { points: compute_pipeline(device, &PROGRAM)?, edits: EditPoints::new(device)? })
    }

    /// Records one dispatch a level (two where n-gons of many sides have their face points made first), and one for
    /// the hierarchical edits of a level that has any.
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        for level in &surface.tables.levels {
            self.record_level(encoder, surface, level);
            if !level.edits.is_empty() {
                self.edits.record(encoder, surface, level.edits.clone());
            }
        }
    }

    fn record_level(&self, encoder: &mut Encoder, surface: &Surface, level: &LevelPoints) {
        let buffers = &surface.buffers;
        for rows in level.dispatches.iter().filter(|rows| !rows.is_empty()) {
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
            encoder.compute(&self.points, &push, push.row_count);
        }
    }
}

/// CPU twin: the points of all levels, bit for bit as the shaders make them where f32 arithmetic is not fused.
pub fn subdivide(tables: &Tables, cage: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut points = cage.to_vec();
    points.resize(tables.point_count() as usize, [0.0; 3]);
    for level in &tables.levels {
        level.dispatches.iter().flat_map(Clone::clone).for_each(|row| make_point(tables, row, &mut points));
        edit_points(&tables.edits[level.edits.start as usize..level.edits.end as usize], &mut points);
    }
    points
}

fn make_point(tables: &Tables, row_index: u32, points: &mut [[f32; 3]]) {
    let stencils = &tables.stencils;
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
