//! Hierarchical edits (FAS section 6.3): points of a level are set or moved before the next level is made of them.
//! Shader: `glsl/edit_points.comp`.

use std::ops::Range;

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder};
use planish_shaders::EditTarget;
use planish_shaders::edit_points_comp::{PROGRAM, Push};
use planish_subdiv::edits::PointEdit;

use crate::error::Error;
use crate::program::compute_pipeline;
use crate::surface::Surface;
use crate::upload::address;

/// The stage's program.
pub(crate) struct EditPoints(ComputePipeline);

impl EditPoints {
    pub(crate) fn new(device: &Device) -> Result<Self, Error> {
        compute_pipeline(device, &PROGRAM).map(Self)
    }

    /// Records one dispatch over a level's edits.
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface, points: &Buffer, edits: Range<u32>) {
        let push = Push {
            points: address(points),
            targets: address(&surface.buffers.edit_targets),
            offsets: address(&surface.frame.edit_offsets),
            first_edit: edits.start,
            edit_count: edits.len() as u32,
        };
        encoder.compute(&self.0, &push, push.edit_count);
    }
}

/// What the kernel reads of an edit besides its offset.
pub(crate) fn targets(edits: &[PointEdit]) -> Vec<EditTarget> {
    edits.iter().map(|edit| EditTarget { point: edit.point, keeps: u32::from(edit.keep != 0.0) }).collect()
}

/// CPU twin: applies edits to the points of all levels, bit for bit as the shader does.
pub fn edit_points(edits: &[PointEdit], points: &mut [[f32; 3]]) {
    for edit in edits {
        let point = &mut points[edit.point as usize];
        let kept = if edit.keep != 0.0 { *point } else { [0.0; 3] };
        *point = std::array::from_fn(|c| kept[c] + edit.offset[c]);
    }
}
