//! The stages before subdivision: what may be seen (`glsl/objects.comp`), how dense it is (`density.comp`,
//! `density_rings.comp`), which irregular faces are refined (`select.comp`, level by level), what their leaves need
//! (`leaves.comp`) and what the corners of patches are (`corners.comp`), and lists of the rows that are in use (`compact.comp`). CPU twins: [`crate::density::density`] and
//! [`planish_subdiv::selection`].

use planish_gpu::{ComputePipeline, Device, Encoder, Transfer};
use planish_shaders as shaders;

use crate::error::Error;
use crate::lists::{CHUNK, LIST_ACTIVE, LIST_BASE, LIST_LEAVES, LIST_MIDDLES, LIST_PATCHES, LIST_ROOTS, LIST_VERTICES};
use crate::options::FrameNeeds;
use crate::program::{compute_pipeline, displaced_compute_pipeline};
use crate::surface::Surface;
use crate::upload::address;

/// The stages' programs.
pub(crate) struct Select {
    objects: ComputePipeline,
    density: ComputePipeline,
    middles: ComputePipeline,
    rings: ComputePipeline,
    around: ComputePipeline,
    select: ComputePipeline,
    leaves: ComputePipeline,
    corners: Option<ComputePipeline>,
    compact: ComputePipeline,
}

/// Offset of a list's head: its first words are the groups that go over it.
pub(crate) fn head_offset(list: usize) -> u64 {
    (list * size_of::<shaders::ListHead>()) as u64
}

impl Select {
    pub fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        let pipeline = |module| compute_pipeline(device, module);
        let marking = |module| displaced_compute_pipeline(device, module, needs);
        Ok(Self {
            objects: pipeline(&shaders::objects_comp::PROGRAM)?,
            density: pipeline(&shaders::density_comp::PROGRAM)?,
            middles: pipeline(&shaders::density_rings_middles_comp::PROGRAM)?,
            rings: pipeline(&shaders::density_rings_vertices_comp::PROGRAM)?,
            around: pipeline(&shaders::density_rings_around_comp::PROGRAM)?,
            select: pipeline(&shaders::select_comp::PROGRAM)?,
            leaves: marking(&shaders::leaves_comp::PROGRAM)?,
            corners: needs.watertight.then(|| marking(&shaders::corners_comp::PROGRAM)).transpose()?,
            compact: pipeline(&shaders::compact_comp::PROGRAM)?,
        })
    }

    /// Records what is copied and cleared at the beginning of a frame.
    pub fn record_start(encoder: &mut Encoder, surface: &Surface) {
        let (frame, lists) = (&surface.frame, &surface.lists);
        let copy = |from, to| Transfer::Copy { from, from_offset: 0, to, to_offset: 0, size: from.size() };
        let clear = |buffer| Transfer::Fill { buffer, offset: 0, size: buffer.size(), value: 0 };
        encoder.transfer(&[
            copy(&frame.cage, &frame.points),
            copy(&lists.empty_heads, &lists.heads),
            copy(&lists.empty_draw_heads, &lists.draw_heads),
            clear(&frame.split_edges),
            clear(&frame.star_marks),
            clear(&frame.marks),
            clear(&frame.counts),
        ]);
        if let Some(next) = &surface.motion {
            encoder.transfer(&[copy(&next.cage, &next.points)]);
        }
    }

    /// Records the stages before anything is selected: three, or five where there are n-gons. Takes the time `density`.
    pub fn record_densities(&self, encoder: &mut Encoder, surface: &Surface) {
        let scene = address(&surface.frame.scene);
        let heads = &surface.lists.heads;
        let object_threads = surface.objects.len() as u32 * CHUNK;
        encoder.compute(&self.objects, &shaders::objects_comp::Push { scene }, object_threads);
        let push = shaders::density_comp::Push { scene };
        encoder.compute_indirect(&self.density, &push, heads, head_offset(LIST_VERTICES));
        let push = shaders::RingsPush { scene };
        let has_middles = surface.tables.slots.ngon_count > 0;
        if has_middles {
            encoder.compute_indirect(&self.middles, &push, heads, head_offset(LIST_MIDDLES));
        }
        encoder.compute_indirect(&self.rings, &push, heads, head_offset(LIST_VERTICES));
        if has_middles {
            encoder.compute_indirect(&self.around, &push, heads, head_offset(LIST_MIDDLES));
        }
        encoder.timestamp("density");
    }

    /// Records the stages: a dispatch a level, level 0 too, and seven; two more where there are n-gons, two fewer where
    /// seams need not have the same bits. Takes the times `density` and `select`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        self.record_densities(encoder, surface);
        let scene = address(&surface.frame.scene);
        let heads = &surface.lists.heads;
        for level in 0..=surface.tables.last_level {
            let list = if level == 0 { LIST_ROOTS } else { LIST_ACTIVE + level as usize };
            let push = shaders::select_comp::Push { scene, level, ..shaders::select_comp::Push::default() };
            encoder.compute_indirect(&self.select, &push, heads, head_offset(list));
        }
        let push = shaders::leaves_comp::Push { scene };
        encoder.compute_indirect(&self.leaves, &push, heads, head_offset(LIST_LEAVES));
        if let Some(corners) = &self.corners {
            for list in [LIST_BASE, LIST_PATCHES] {
                let push = shaders::CornersPush { scene, list: list as u32, ..shaders::CornersPush::default() };
                encoder.compute_indirect_more(corners, &push, heads, head_offset(list));
            }
        }
        let word_count = surface.frame.marks.size() as u32 / 4;
        encoder.compute(&self.compact, &shaders::compact_comp::Push { scene }, word_count);
        encoder.timestamp("select");
    }
}
