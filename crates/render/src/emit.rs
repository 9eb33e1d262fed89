//! The emit stage: which patches may be seen, batch by batch. Shader: `glsl/emit.comp`.
//!
//! The lists and draws of the surface are its source. One group of threads takes one batch, and writes the patches of it
//! that [`crate::visibility`] does not leave out, in order, to the same places of a second list, and their number to a second
//! draw. So the result depends on no order of groups, and a batch never grows.

use planish_gpu::{ComputePipeline, Device, DrawArguments, Encoder, SpecConstant};
use planish_shaders::emit_bspline_comp::{LOCAL_SIZE, Push, SPEC_LOCAL_SIZE_X, SPEC_MAX_BATCH};
use planish_shaders::{
    EmitCounts, EmitLevel, EmitView, Indices, LimitPoint, emit_bspline_comp, emit_corners_comp, emit_midpoints_comp,
};
use planish_subdiv::patch::RegularPatch;
use planish_subdiv::tables::{PatchCounts, Tables};

use crate::camera::FrameCamera;
use crate::density::FACTOR_COUNT;
use crate::draw::DrawOptions;
use crate::error::Error;
use crate::lists::{Batches, Lists, MAX_BATCH, PatchKind};
use crate::options::Spacing;
use crate::program::specialized_compute_pipeline;
use crate::surface::{Surface, SurfaceDesc};
use crate::tessellation::emit_level;
use crate::upload::address;
use crate::visibility::{are_quads_unseen, is_patch_unseen};

/// Levels that a patch can have; `LEVEL_COUNT` of the shaders, from their array of that length.
const LEVEL_COUNT: usize = size_of::<EmitCounts>() / size_of::<u32>();
const _: () = assert!(LEVEL_COUNT + 1 == FACTOR_COUNT);

/// Threads of a group on a software driver: as many as one of its vectors has lanes. Batches there are small, and idle
/// threads are not free.
const SOFTWARE_LOCAL_SIZE: u32 = 8;

/// The stage's programs.
pub(crate) struct Emit {
    bspline: ComputePipeline,
    filling: ComputePipeline,
    local_size: u32,
    cull_back: bool,
    sub_pixel_bits: u32,
}

impl Emit {
    pub(crate) fn new(device: &Device, surface: &SurfaceDesc, options: &DrawOptions) -> Result<Self, Error> {
        let local_size = if device.is_software() { SOFTWARE_LOCAL_SIZE } else { LOCAL_SIZE[0] };
        let spec = [
            SpecConstant { id: SPEC_MAX_BATCH, bits: MAX_BATCH },
            SpecConstant { id: SPEC_LOCAL_SIZE_X, bits: local_size },
        ];
        let filling = match surface.spacing {
            Spacing::FractionalEven => &emit_midpoints_comp::PROGRAM,
            Spacing::Equal | Spacing::FractionalOdd => &emit_corners_comp::PROGRAM,
        };
        Ok(Self {
            bspline: specialized_compute_pipeline(device, &emit_bspline_comp::PROGRAM, local_size, &spec)?,
            filling: specialized_compute_pipeline(device, filling, local_size, &spec)?,
            local_size,
            cull_back: options.cull_back,
            sub_pixel_bits: device.limits().sub_pixel_bits,
        })
    }

    /// Records one dispatch a kind, side by side. Takes the time `emit`.
    pub(crate) fn record(&self, encoder: &mut Encoder, surface: &Surface, camera: &FrameCamera) {
        let view = emit_view(camera, self.cull_back, self.sub_pixel_bits);
        let mut is_first = true;
        for kind in PatchKind::ALL {
            let push = push(surface, kind, view);
            if push.batch_count == 0 {
                continue;
            }
            let pipeline = if kind == PatchKind::Filling { &self.filling } else { &self.bspline };
            let threads = push.batch_count * self.local_size;
            if std::mem::take(&mut is_first) {
                encoder.compute(pipeline, &push, threads);
            } else {
                encoder.compute_more(pipeline, &push, threads);
            }
        }
        encoder.timestamp("emit");
    }
}

fn push(surface: &Surface, kind: PatchKind, view: EmitView) -> Push {
    let buffers = &surface.buffers;
    let (first_entry, draws) = (surface.lists.ranges[kind as usize].start, &surface.batches.ranges[kind as usize]);
    let is_filling = kind == PatchKind::Filling;
    Push {
        list: address::<Indices>(&buffers.list).offset(first_entry.into()),
        visible: address::<planish_shaders::VisibleList>(&buffers.visible_list).offset(first_entry.into()),
        points: address(if is_filling { &buffers.limits } else { &buffers.points }),
        patches: address(if is_filling { &buffers.quads } else { &buffers.patches }),
        draws: address::<planish_shaders::SourceDraws>(&buffers.draws).offset(draws.start.into()),
        visible_draws: address::<planish_shaders::VisibleDraws>(&buffers.visible_draws).offset(draws.start.into()),
        levels: address(&buffers.emit_levels),
        counts: address::<planish_shaders::EmitCountsOfKind>(&buffers.visible_counts).offset(kind as u64),
        view,
        batch_count: draws.len() as u32,
    }
}

/// What a camera sees. Triangles that show their back are not seen if they are culled; the rasterizer rounds to
/// `sub_pixel_bits` bits behind the point of a pixel.
pub fn emit_view(camera: &FrameCamera, cull_back: bool, sub_pixel_bits: u32) -> EmitView {
    let clip = camera.view_projection();
    let [dx, dy] = camera.pixel_steps();
    // To the nearest point of the grid: both coordinates move by half a step at most.
    let snap_pixels = std::f32::consts::FRAC_1_SQRT_2 * (-(sub_pixel_bits as f32)).exp2();
    EmitView {
        eye: camera.eye().to_array(),
        clip_x: clip.row(0).truncate().to_array(),
        clip_y: clip.row(1).truncate().to_array(),
        clip_w: clip.row(3).truncate().to_array(),
        near: camera.near(),
        snap: snap_pixels * dx.length().max(dy.length()),
        cull_back: u32::from(cull_back),
    }
}

/// How the patches of each level are tessellated.
pub(crate) fn emit_levels(tables: &Tables, factors: &[f32; FACTOR_COUNT], spacing: Spacing) -> Vec<EmitLevel> {
    (0..LEVEL_COUNT).map(|level| emit_level(level, tables.last_level as usize, factors, spacing)).collect()
}

/// Counts by kind to counts by level.
pub(crate) fn patch_counts(by_kind: &[EmitCounts], level_count: usize) -> Vec<PatchCounts> {
    let of_kind = |kind: PatchKind, level: usize| by_kind[kind as usize].levels[level];
    let of_level = |level| PatchCounts {
        regular: of_kind(PatchKind::Regular, level),
        transition: of_kind(PatchKind::Transition, level),
        filling: of_kind(PatchKind::Filling, level),
    };
    (0..level_count).map(of_level).collect()
}

/// What the stage makes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Emitted {
    /// The lists of all kinds, as long as their source. What lies behind the end of a batch means nothing.
    pub entries: Vec<u32>,
    /// The draws of all kinds.
    pub draws: Vec<DrawArguments>,
    /// Patches that may be seen, by level.
    pub counts: Vec<PatchCounts>,
}

/// CPU twin: bit for bit as the shader makes it where f32 arithmetic is not fused.
pub fn emit(
    tables: &Tables,
    lists: &Lists,
    batches: &Batches,
    levels: &[EmitLevel],
    points: &[[f32; 3]],
    limits: &[LimitPoint],
    view: &EmitView,
) -> Emitted {
    let mut emitted = Emitted {
        entries: vec![u32::MAX; lists.entries.len()],
        draws: Vec::new(),
        counts: vec![PatchCounts::default(); tables.counts.len()],
    };
    let mut counts = [EmitCounts::default(); PatchKind::ALL.len()];
    for kind in PatchKind::ALL {
        let first_entry = lists.ranges[kind as usize].start as usize;
        for batch in batches.of_kind(kind) {
            let first = first_entry + batch.first_vertex as usize;
            let mut end = first;
            for &entry in &lists.entries[first..][..batch.vertex_count as usize] {
                let (is_unseen, level) = match kind {
                    PatchKind::Filling => is_filling_unseen(tables, entry as usize, limits, view),
                    _ => is_regular_unseen(&tables.patches[entry as usize], levels, points, view),
                };
                if !is_unseen {
                    emitted.entries[end] = entry;
                    counts[kind as usize].levels[usize::from(level)] += 1;
                    end += 1;
                }
            }
            emitted.draws.push(DrawArguments { vertex_count: (end - first) as u32, ..*batch });
        }
    }
    emitted.counts = patch_counts(&counts, tables.counts.len());
    emitted
}

/// Whether nothing can be seen of a patch, and its level.
fn is_regular_unseen(patch: &RegularPatch, levels: &[EmitLevel], points: &[[f32; 3]], view: &EmitView) -> (bool, u8) {
    let info = &patch.info;
    let mut control = patch.points.map(|point| points[point as usize]);
    reflect_points(&mut control, info.boundary);
    let is_uneven = info.transition | info.leaf != 0;
    // The tangents of a patch with a semi-sharp crease are not those of its control points: it is always drawn.
    let is_unseen =
        patch.sharpness == 0.0 && is_patch_unseen(&control, view, &levels[usize::from(info.level)], is_uneven);
    (is_unseen, info.level)
}

/// `reflect_points` of `glsl/shared/control_points.glsl`.
fn reflect_points(p: &mut [[f32; 3]; 16], boundary: u8) {
    let mut set = |is_boundary: bool, at: usize, near: usize, far: usize| {
        if is_boundary {
            p[at] = std::array::from_fn(|c| 2.0 * p[near][c] - p[far][c]);
        }
    };
    for row in [0, 4, 8, 12] {
        set(boundary & 8 != 0, row, row + 1, row + 2);
        set(boundary & 2 != 0, row + 3, row + 2, row + 1);
    }
    for column in 0..4 {
        set(boundary & 1 != 0, column, 4 + column, 8 + column);
        set(boundary & 4 != 0, 12 + column, 8 + column, 4 + column);
    }
}

/// Whether nothing can be seen of a filling quad, and its level.
fn is_filling_unseen(tables: &Tables, entry: usize, limits: &[LimitPoint], view: &EmitView) -> (bool, u8) {
    let quad = &tables.filling[entry];
    let midpoints = tables.filling_midpoints.get(entry);
    let places = quad.corners.iter().chain(midpoints.into_iter().flatten());
    let points: Vec<_> = places.map(|&place| limits[place as usize].position).collect();
    let quads: &[[usize; 4]] = match midpoints {
        Some(_) => &[[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
        None => &[[0, 1, 2, 3]],
    };
    (are_quads_unseen(&points, quads, view), quad.info.level)
}
