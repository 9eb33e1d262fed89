//! The subdivide stage: points of each level from those before (FAS section 3.2). Shader: `glsl/subdivide.comp`.

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder};
use planish_shaders::subdivide_comp::{PROGRAM, Push};
use planish_subdiv::tables::{LevelPoints, Tables};

use crate::edit_points::{EditPoints, edit_points};
use crate::error::Error;
use crate::lists::LIST_PHASES;
use crate::program::compute_pipeline;
use crate::select::head_offset;
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

    /// Records one dispatch a level (two where n-gons of many sides have their face points made first) over its rows in use,
    /// and one for the hierarchical edits of a level that has any. `points`: of all levels, the cages' being there.
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface, points: &Buffer) {
        let first_items = surface.phases.first_items();
        for (level, phases) in surface.tables.levels.iter().zip(&surface.phases.of_level) {
            for phase in phases.clone().filter(|&phase| surface.phases.rows[phase][1] > 0) {
                self.record_phase(encoder, surface, points, phase, first_items[phase]);
            }
            if !level.edits.is_empty() {
                self.edits.record(encoder, surface, points, level.edits.clone());
            }
        }
    }

    fn record_phase(&self, encoder: &mut Encoder, surface: &Surface, points: &Buffer, phase: usize, first_item: u32) {
        let (tables, heads) = (&surface.buffers, &surface.lists.heads);
        let list = LIST_PHASES + phase;
        let push = Push {
            points: address(points),
            rows: address(&tables.rows),
            indices: address(&tables.indices),
            weights: address(&tables.weights),
            in_use: address::<planish_shaders::Indices>(&surface.frame.in_use).offset(first_item.into()),
            head: address::<planish_shaders::ListHeads>(heads).offset(list as u64),
            first_point: surface.tables.cage_point_count,
            ..Push::default()
        };
        encoder.compute_indirect(&self.points, &push, heads, head_offset(list));
    }
}

/// CPU twin: the points of all levels, bit for bit as the shaders make them where f32 arithmetic is not fused.
pub fn subdivide(tables: &Tables, cage: &[[f32; 3]]) -> Vec<[f32; 3]> {
    subdivide_with(tables, cage, |level, points| {
        edit_points(&tables.edits[level.edits.start as usize..level.edits.end as usize], points);
    })
}

/// The same of other values than positions: hierarchical edits do not move them.
pub(crate) fn subdivide_values(tables: &Tables, cage: &[[f32; 3]]) -> Vec<[f32; 3]> {
    subdivide_with(tables, cage, |_, _| {})
}

/// Makes the points of all levels; `edit` changes those of a level before the next one is made of them.
fn subdivide_with(tables: &Tables, cage: &[[f32; 3]], edit: impl Fn(&LevelPoints, &mut [[f32; 3]])) -> Vec<[f32; 3]> {
    let mut points = cage.to_vec();
    points.resize(tables.point_count() as usize, [0.0; 3]);
    for level in &tables.levels {
        level.dispatches.iter().flat_map(Clone::clone).for_each(|row| make_point(tables, row, &mut points));
        edit(level, &mut points);
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
