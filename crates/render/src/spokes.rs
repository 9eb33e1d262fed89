//! The spoke stage: what limit points give to the Gregory patches around them. Shader: `glsl/spokes.comp`.

use planish_gpu::{ComputePipeline, Device, Encoder};
use planish_shaders::spokes_comp::{PROGRAM, Push};
use planish_shaders::{LimitPoint, LimitTangents, SpokePoint};
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::NONE;

use crate::error::Error;
use crate::limit::LimitsInUse;
use crate::program::compute_pipeline;
use crate::rival_spokes;
use crate::select::head_offset;
use crate::surface::Surface;
use crate::upload::address;

/// Bytes of a Gregory face on a device,
pub const FACE_BYTES: usize = size_of::<planish_shaders::GregoryFace>();
/// of a spoke,
pub const SPOKE_BYTES: usize = size_of::<planish_shaders::Spoke>();
/// of one of another scheme,
pub const RIVAL_SPOKE_BYTES: usize = size_of::<planish_shaders::RivalSpoke>();
/// and of a face's stencil.
pub const STENCIL_BYTES: usize = size_of::<planish_shaders::GregoryStencil>();

/// The stage's program.
pub(crate) struct SpokeStage {
    pipeline: ComputePipeline,
    /// The patches are those of another scheme.
    is_of_rival: bool,
}

impl SpokeStage {
    pub fn new(device: &Device, is_of_rival: bool) -> Result<Self, Error> {
        let program = if is_of_rival { &planish_shaders::rival_spokes_comp::PROGRAM } else { &PROGRAM };
        Ok(Self { pipeline: compute_pipeline(device, program)?, is_of_rival })
    }

    /// Records one dispatch over all limit points in use; none if all patches have stencils.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let limits = LimitsInUse::of(surface).filter(|_| surface.tables.gregory.needs_spokes());
        let Some(limits) = limits else { return };
        let LimitsInUse { in_use, head, list } = limits;
        if self.is_of_rival {
            let push = rival_spokes::push(surface, &limits);
            return encoder.compute_indirect(&self.pipeline, &push, &surface.lists.heads, head_offset(list));
        }
        let (tables, frame) = (&surface.buffers, &surface.frame);
        let push = Push {
            points: address(&frame.points),
            limits: address(&frame.limits),
            tangents: address(&frame.limit_tangents),
            ranges: address(&tables.spoke_ranges),
            spokes: address(&tables.spokes),
            indices: address(&tables.spoke_indices),
            weights: address(&tables.spoke_weights),
            made: address(&frame.spoke_points),
            in_use,
            head,
        };
        encoder.compute_indirect(&self.pipeline, &push, &surface.lists.heads, head_offset(list));
    }
}

/// CPU twin: the spokes' points from points, limit points and their tangents, bit for bit as the shader makes them.
pub fn spokes(
    tables: &Tables,
    points: &[[f32; 3]],
    limits: &[LimitPoint],
    tangents: &[LimitTangents],
) -> Vec<SpokePoint> {
    let table = &tables.gregory;
    let mut made = vec![SpokePoint::default(); table.spokes.len()];
    let edge_point = |spoke: u32, limit: usize| -> [f32; 3] {
        let (spoke, LimitPoint { position, normal }) = (&table.spokes[spoke as usize], &limits[limit]);
        let LimitTangents { a, b } = &tangents[limit];
        let to_end: [f32; 3] = std::array::from_fn(|c| points[spoke.end as usize][c] - position[c]);
        let dot = (normal[0] * to_end[0] + normal[1] * to_end[1]) + normal[2] * to_end[2];
        let out_of_plane = if spoke.is_projected { dot } else { 0.0 };
        std::array::from_fn(|c| {
            let along = spoke.along[0] * a[c] + spoke.along[1] * b[c];
            position[c] + (along + spoke.direct * (to_end[c] - normal[c] * out_of_plane))
        })
    };
    for (limit, &[first, count]) in table.of_limit.iter().enumerate() {
        for i in first..first + count {
            let spoke = &table.spokes[i as usize];
            let [before, after] = spoke.neighbours;
            let point = &mut made[i as usize];
            point.edge = edge_point(i, limit);
            if before != NONE && after != NONE {
                let (before, after) = (edge_point(before, limit), edge_point(after, limit));
                point.across = std::array::from_fn(|c| 1.5 * (after[c] - before[c]));
            }
            let indices = &table.indices[spoke.row.first_index as usize..][..spoke.row.count as usize];
            let weights = &table.weights[spoke.row.first_weight as usize..][..spoke.row.count as usize];
            let origin = points[indices[0] as usize];
            for (&index, weight) in indices.iter().zip(weights).skip(1) {
                for c in 0..3 {
                    point.beside[c] += weight * (points[index as usize][c] - origin[c]);
                }
            }
        }
    }
    made
}
