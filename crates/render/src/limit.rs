//! The limit stage: positions and normals on the limit surface at the corners of irregular leaves (FAS section 4.1).
//! Shader: `glsl/limit.comp`.

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder};
use planish_shaders::limit_comp::{PROGRAM, Push};
use planish_shaders::{DeviceAddress, Indices, LimitPoint, LimitTangents, ListHeads};
use planish_subdiv::tables::Tables;

use crate::error::Error;
use crate::lists::LIST_PHASES;
use crate::options::FrameNeeds;
use crate::program::displaced_compute_pipeline as compute_pipeline;
use crate::select::head_offset;
use crate::surface::Surface;
use crate::upload::address;

/// The stage's program.
pub(crate) struct Limit(ComputePipeline);

impl Limit {
    pub(crate) fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        compute_pipeline(device, &PROGRAM, needs).map(Self)
    }

    /// Records one dispatch over all limit points in use.
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface, points: &Buffer, limits: &Buffer) {
        let Some(LimitsInUse { in_use, head, list }) = LimitsInUse::of(surface) else { return };
        let (tables, frame) = (&surface.buffers, &surface.frame);
        let push = Push {
            points: address(points),
            limits: address(limits),
            rows: address(&tables.limit_rows),
            indices: address(&tables.limit_indices),
            weights: address(&tables.limit_weights),
            in_use,
            head,
            tangents: address(&frame.limit_tangents),
        };
        encoder.compute_indirect(&self.0, &push, &surface.lists.heads, head_offset(list));
    }
}

/// The list of limit points in use: which they are, and how many.
pub(crate) struct LimitsInUse {
    pub in_use: DeviceAddress<Indices>,
    pub head: DeviceAddress<ListHeads>,
    /// Its number.
    pub list: usize,
}

impl LimitsInUse {
    /// None for surfaces without limit points.
    pub fn of(surface: &Surface) -> Option<Self> {
        let phase = surface.phases.limits();
        let list = LIST_PHASES + phase;
        (surface.phases.rows[phase][1] > 0).then(|| Self {
            in_use: address::<Indices>(&surface.frame.in_use).offset(surface.phases.first_items()[phase].into()),
            head: address::<ListHeads>(&surface.lists.heads).offset(list as u64),
            list,
        })
    }
}

/// CPU twin: the limit points from the points of all levels, bit for bit as the shader makes them.
pub fn limit(tables: &Tables, points: &[[f32; 3]]) -> Vec<LimitPoint> {
    limit_with_tangents(tables, points).0
}

/// The same, and their tangents.
pub fn limit_with_tangents(tables: &Tables, points: &[[f32; 3]]) -> (Vec<LimitPoint>, Vec<LimitTangents>) {
    let made = tables.limits.rows.iter().map(|row| {
        let indices = &tables.limits.indices[row.first_index as usize..][..row.count as usize];
        let weights = &tables.limits.weights[row.first_weight as usize..][..row.count as usize];
        let origin = points[indices[0] as usize];
        let mut sums = [[0.0_f32; 3]; 3];
        for (&index, weight) in indices.iter().zip(weights).skip(1) {
            let point = points[index as usize];
            for (sum, w) in sums.iter_mut().zip(weight) {
                for c in 0..3 {
                    sum[c] += w * (point[c] - origin[c]);
                }
            }
        }
        let [position, a, b] = sums;
        let position = std::array::from_fn(|c| origin[c] + position[c]);
        (LimitPoint { position, normal: unit_normal(a, b) }, LimitTangents { a, b })
    });
    made.unzip()
}

/// `scaled` of `glsl/shared/bspline.glsl`.
fn scaled(a: [f32; 3]) -> [f32; 3] {
    let largest = a.iter().fold(f32::MIN_POSITIVE, |m, c| m.max(c.abs()));
    a.map(|c| c / largest)
}

/// `unit_normal` of `glsl/shared/bspline.glsl`.
fn unit_normal(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let (a, b) = (scaled(a), scaled(b));
    unit_vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

/// `unit_vector` of `glsl/shared/bspline.glsl`.
pub(crate) fn unit_vector(a: [f32; 3]) -> [f32; 3] {
    let n = scaled(a);
    let size = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).max(f32::MIN_POSITIVE).sqrt();
    n.map(|c| c / size)
}
