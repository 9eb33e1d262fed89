//! The draw stage: the passes of a frame into images, after the stages of [`crate::FrameStages`].

use planish_gpu::{DepthTarget, Device, Draw, DrawArguments, Encoder, Feature, GraphicsPipeline, Image, RenderTargets};
use planish_shaders::DrawHead;

use crate::camera::FrameCamera;
use crate::error::Error;
use crate::frame::draw_push;
use crate::lists::{PatchKind, draw_arguments};
use crate::options::{FrameNeeds, GregoryPoints, SurfaceMethod, View};
use crate::pipelines::{Output, PipelineOptions, pipelines};
use crate::surface::{Surface, SurfaceDesc};
use crate::targets::{Layers, Targets};

/// What an image is to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawOptions {
    /// What the beauty image shows.
    pub view: View,
    /// Which layers are drawn besides it, at least.
    pub layers: Layers,
    /// Leave out triangles that show their back: where all objects hide theirs.
    pub cull_back: bool,
}

impl DrawOptions {
    /// The layers that the targets must have.
    pub fn needed_layers(&self) -> Layers {
        self.layers.max(self.view.layers())
    }
}

/// Refuses a device that has too few colour targets.
fn check_targets(device: &Device, layers: Layers) -> Result<(), Error> {
    let (found, expected) = (device.limits().max_color_attachments, layers.target_count() as u32);
    if found >= expected {
        return Ok(());
    }
    Err(Error::TooFewTargets { device: device.name().to_owned(), found, expected })
}

/// The pipelines that draw depth alone.
pub(crate) fn depth_options(surface: &SurfaceDesc, needs: &FrameNeeds) -> PipelineOptions {
    PipelineOptions {
        method: surface.method,
        end_cap: surface.end_cap,
        spacing: needs.spacing,
        output: Output::Depth,
        view: View::Shaded,
        cull_back: false,
        wire: false,
        creases: surface.has_creased_patches(),
        placed: needs.placed,
        cuts: needs.cuts,
        watertight: needs.watertight,
        displaced: needs.displaced,
        tex_coords: false,
        stencils: needs.gregory_points == GregoryPoints::Stencil,
        exact_normals: needs.exact_normals,
        colors: false,
        moves: false,
        cutouts: needs.cutouts,
        table_normals: surface.table_normals,
        table_weights: surface.table_weights,
    }
}

/// The passes that draw a surface into images.
pub struct DrawPasses {
    fill: Vec<(PatchKind, GraphicsPipeline)>,
    wire: Vec<(PatchKind, GraphicsPipeline)>,
    is_software: bool,
}

impl DrawPasses {
    /// Makes the pipelines for surfaces that are made so.
    pub fn new(
        device: &Device,
        surface: &SurfaceDesc,
        needs: &FrameNeeds,
        options: &DrawOptions,
    ) -> Result<Self, Error> {
        let is_wire = options.view == View::Wire;
        if is_wire && !device.has(Feature::FillModeNonSolid) {
            return Err(Error::NoLines { device: device.name().to_owned() });
        }
        let layers = options.needed_layers();
        check_targets(device, layers)?;
        let fill = PipelineOptions {
            output: Output::Image(layers),
            view: options.view,
            cull_back: options.cull_back,
            tex_coords: (layers == Layers::Shading || layers == Layers::GeometryAndColors) && needs.tex_coords,
            colors: layers == Layers::GeometryAndColors || layers == Layers::Shading && needs.colors,
            moves: layers == Layers::GeometryAndColors && needs.moves,
            ..depth_options(surface, needs)
        };
        let wire = PipelineOptions { wire: true, ..fill };
        Ok(Self {
            fill: pipelines(device, &fill)?,
            wire: if is_wire { pipelines(device, &wire)? } else { Vec::new() },
            is_software: device.is_software() && device.has(Feature::DrawIndirectCount),
        })
    }

    /// The passes that draw depth alone, as lights see it.
    pub fn of_depth(device: &Device, surface: &SurfaceDesc, needs: &FrameNeeds) -> Result<Self, Error> {
        let options =
            PipelineOptions { tex_coords: needs.cutouts && needs.tex_coords, ..depth_options(surface, needs) };
        Ok(Self {
            fill: pipelines(device, &options)?,
            wire: Vec::new(),
            is_software: device.is_software() && device.has(Feature::DrawIndirectCount),
        })
    }

    /// Records the passes, drawn indirectly from the lists that the stages before made: one draw a kind of patch. Takes the time
    /// `draw` and the statistics `draw`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface, camera: &FrameCamera, targets: &Targets) {
        targets.render(|targets| encoder.begin_rendering(targets));
        if let Some(crop) = surface.crop {
            encoder.set_scissor(crop);
        }
        encoder.begin_statistics("draw");
        self.record_lists(encoder, &self.fill, surface, camera);
        encoder.end_statistics();
        self.record_lists(encoder, &self.wire, surface, camera);
        encoder.end_rendering();
        encoder.timestamp("draw");
    }

    /// Records the passes of [`Self::of_depth`].
    pub fn record_depth(&self, encoder: &mut Encoder, surface: &Surface, camera: &FrameCamera, depth: &Image) {
        let depth = Some(DepthTarget { image: depth, clear: Some(0.0) });
        encoder.begin_rendering(&RenderTargets { colors: &[], depth, extent: camera.size });
        self.record_lists(encoder, &self.fill, surface, camera);
        encoder.end_rendering();
    }

    fn record_lists(
        &self,
        encoder: &mut Encoder,
        pipelines: &[(PatchKind, GraphicsPipeline)],
        surface: &Surface,
        camera: &FrameCamera,
    ) {
        let lists = &surface.lists;
        let heads = surface.capacities().draw_heads();
        let stride = size_of::<DrawArguments>() as u32;
        for (kind, pipeline) in pipelines {
            let head = &heads[*kind as usize];
            let push = draw_push(surface, *kind, head.first, camera);
            if surface.desc.method == SurfaceMethod::Uniform {
                let quads = draw_arguments(0, surface.tables.filling.len() as u32, surface.desc.method, false);
                let (vertex_count, instance_count) = (quads.vertex_count, quads.instance_count);
                encoder.draw(pipeline, &push, Draw::Direct { vertex_count, instance_count });
                continue;
            }
            let head_offset = (*kind as usize * size_of::<DrawHead>()) as u64;
            let draw = if self.is_software {
                Draw::IndirectCount {
                    arguments: &lists.draws,
                    offset: u64::from(head.first_draw) * u64::from(stride),
                    count: &lists.draw_heads,
                    count_offset: head_offset + std::mem::offset_of!(DrawHead, draw_count) as u64,
                    max_draw_count: head.draw_capacity,
                    stride,
                }
            } else {
                Draw::Indirect { arguments: &lists.draw_heads, offset: head_offset, draw_count: 1, stride }
            };
            encoder.draw(pipeline, &push, draw);
        }
    }
}
