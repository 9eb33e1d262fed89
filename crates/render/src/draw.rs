//! The draw stage: the passes of a frame into images, after the emit stage if there is one.

use planish_gpu::{Device, Draw, DrawArguments, Encoder, Feature, GraphicsPipeline};

use crate::camera::FrameCamera;
use crate::emit::Emit;
use crate::error::Error;
use crate::frame::FrameConstants;
use crate::lists::PatchKind;
use crate::options::{SurfaceMethod, View};
use crate::pipelines::{Output, PipelineOptions, pipelines};
use crate::surface::{Surface, SurfaceDesc};
use crate::targets::Targets;

/// What an image is to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawOptions {
    /// What the beauty image shows.
    pub view: View,
    /// Draw all layers, not only the colour.
    pub layers: bool,
    /// Leave out triangles that show their back: for closed, opaque meshes.
    pub cull_back: bool,
    /// Leave out patches that cannot be seen before they are tessellated: the emit stage, which the uniform method lacks.
    pub emit: bool,
}

impl DrawOptions {
    /// Whether the targets must have layers.
    pub fn needs_layers(&self) -> bool {
        self.layers || self.view.needs_layers()
    }
}

/// The passes that draw a surface into images.
pub struct DrawPasses {
    emit: Option<Emit>,
    fill: Vec<(PatchKind, GraphicsPipeline)>,
    wire: Vec<(PatchKind, GraphicsPipeline)>,
}

impl DrawPasses {
    /// Makes the pipelines for surfaces that are made so.
    pub fn new(device: &Device, surface: &SurfaceDesc, options: &DrawOptions) -> Result<Self, Error> {
        let is_wire = options.view == View::Wire;
        if is_wire && !device.has(Feature::FillModeNonSolid) {
            return Err(Error::NoLines { device: device.name().to_owned() });
        }
        let fill = PipelineOptions {
            method: surface.method,
            spacing: surface.spacing,
            output: if options.needs_layers() { Output::Layers } else { Output::Lean },
            view: options.view,
            cull_back: options.cull_back,
            wire: false,
            creases: surface.has_creased_patches(),
        };
        let wire = PipelineOptions { wire: true, ..fill };
        let has_emit = options.emit && surface.method == SurfaceMethod::Fas;
        Ok(Self {
            emit: has_emit.then(|| Emit::new(device, surface, options)).transpose()?,
            fill: pipelines(device, &fill)?,
            wire: if is_wire { pipelines(device, &wire)? } else { Vec::new() },
        })
    }

    /// Whether there is an emit stage.
    pub fn has_emit(&self) -> bool {
        self.emit.is_some()
    }

    /// Records the passes, drawn indirectly from the surface's lists, or from what the emit stage makes of them; the points
    /// must have been made. Takes the times `emit`, with such a stage, and `draw`, and the statistics `draw`. The camera is
    /// recorded with the draws.
    pub fn record(
        &self,
        encoder: &mut Encoder,
        surface: &Surface,
        frame: &FrameConstants,
        camera: &FrameCamera,
        targets: &Targets,
    ) {
        encoder.keep(frame.buffer());
        if let Some(emit) = &self.emit {
            emit.record(encoder, surface, camera);
        }
        targets.render(|targets| encoder.begin_rendering(targets));
        encoder.begin_statistics("draw");
        self.record_lists(encoder, &self.fill, surface, frame, camera);
        encoder.end_statistics();
        self.record_lists(encoder, &self.wire, surface, frame, camera);
        encoder.end_rendering();
        encoder.timestamp("draw");
    }

    fn record_lists(
        &self,
        encoder: &mut Encoder,
        pipelines: &[(PatchKind, GraphicsPipeline)],
        surface: &Surface,
        frame: &FrameConstants,
        camera: &FrameCamera,
    ) {
        let buffers = &surface.buffers;
        let (list, arguments) = match self.emit {
            Some(_) => (&buffers.visible_list, &buffers.visible_draws),
            None => (&buffers.list, &buffers.draws),
        };
        for (kind, pipeline) in pipelines {
            let push = frame.push(surface, *kind, list, surface.lists.ranges[*kind as usize].start, camera);
            let stride = size_of::<DrawArguments>() as u32;
            let draws = surface.batches.ranges[*kind as usize].clone();
            let offset = u64::from(draws.start) * u64::from(stride);
            let draw_count = draws.len() as u32;
            encoder.draw(pipeline, &push, Draw::Indirect { arguments, offset, draw_count, stride });
        }
    }
}
