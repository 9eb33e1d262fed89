//! Drawing into images.

use crate::barrier::PassKind;
use crate::graphics_pipeline::TargetFormats;
use crate::{Buffer, Encoder, Feature, GraphicsPipeline, Image};
use ash::vk;
use bytemuck::{Pod, Zeroable};

/// What an indirect draw reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DrawArguments {
    /// Vertices an instance.
    pub vertex_count: u32,
    /// Instances.
    pub instance_count: u32,
    /// Added to `gl_VertexIndex`.
    pub first_vertex: u32,
    /// Added to `gl_InstanceIndex`. Other than 0 needs [`Feature::DrawIndirectFirstInstance`].
    pub first_instance: u32,
}

/// How much to draw.
#[derive(Clone, Copy)]
pub enum Draw<'a> {
    /// Numbers known now.
    Direct {
        /// Vertices an instance.
        vertex_count: u32,
        /// Instances.
        instance_count: u32,
    },
    /// [`DrawArguments`] that are read when the draw is reached.
    Indirect {
        /// Where they are.
        arguments: &'a Buffer,
        /// First byte of the first.
        offset: u64,
        /// How many.
        draw_count: u32,
        /// Bytes from one to the next.
        stride: u32,
    },
    /// As `Indirect`, with a count that is read too. Needs [`Feature::DrawIndirectCount`].
    IndirectCount {
        /// Where the arguments are.
        arguments: &'a Buffer,
        /// First byte of the first.
        offset: u64,
        /// Where the count is, a `u32`.
        count: &'a Buffer,
        /// First byte of the count.
        count_offset: u64,
        /// The count is taken as at most this.
        max_draw_count: u32,
        /// Bytes from one to the next.
        stride: u32,
    },
}

/// What a colour target holds when drawing begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Clear {
    /// What was drawn before.
    Keep,
    /// This colour: for unsigned-normalised and float formats.
    Float([f32; 4]),
    /// This value: for integer formats.
    Uint([u32; 4]),
}

/// A colour target.
#[derive(Clone, Copy)]
pub struct ColorTarget<'a> {
    /// Drawn into.
    pub image: &'a Image,
    /// What it holds at first.
    pub clear: Clear,
}

/// The depth target.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// Drawn into and tested against.
    pub image: &'a Image,
    /// The depth it holds at first; without it, what was drawn before.
    pub clear: Option<f32>,
}

/// What is drawn into: images of at least the extent.
#[derive(Clone, Copy)]
pub struct RenderTargets<'a> {
    /// By fragment output location.
    pub colors: &'a [ColorTarget<'a>],
    /// Depth, if any.
    pub depth: Option<DepthTarget<'a>>,
    /// Width and height in pixels.
    pub extent: [u32; 2],
}

impl Encoder {
    /// Begins a pass that draws into images. Clip space is y up, z from 0 to 1: row 0 of an image is y = 1.
    ///
    /// # Panics
    /// While rendering, or if a target is smaller than the extent.
    pub fn begin_rendering(&mut self, targets: &RenderTargets<'_>) {
        self.open(PassKind::Draw);
        self.record_begin_rendering(targets);
    }

    pub(crate) fn record_begin_rendering(&mut self, targets: &RenderTargets<'_>) {
        let images = || targets.colors.iter().map(|target| target.image).chain(targets.depth.map(|depth| depth.image));
        for image in images() {
            let [width, height] = image.extent();
            let fits = targets.extent[0] <= width && targets.extent[1] <= height;
            assert!(fits, "{}: the target is smaller than {:?}", image.name(), targets.extent);
            self.keep_object(image.inner.clone());
        }
        self.rendering = Some(TargetFormats {
            colors: targets.colors.iter().map(|target| target.image.format()).collect(),
            depth: targets.depth.map(|depth| depth.image.format()),
        });
        let [width, height] = targets.extent;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let colors: Vec<_> = targets.colors.iter().map(color_attachment).collect();
        let depth = targets.depth.as_ref().map(depth_attachment);
        let mut info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colors);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // A negative height turns y up.
        let viewport = vk::Viewport {
            x: 0.0,
            y: height as f32,
            width: width as f32,
            height: -(height as f32),
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let (vulkan, commands) = (&self.commands.device.raw, self.commands.raw);
        // SAFETY: the command buffer is being recorded, outside of rendering; `info` and what it points to outlive
        // the call; the images are kept alive above and are in the layout `GENERAL`.
        unsafe {
            vulkan.cmd_begin_rendering(commands, &info);
            vulkan.cmd_set_viewport(commands, 0, &[viewport]);
            vulkan.cmd_set_scissor(commands, 0, &[area]);
        }
    }

    /// Leaves pixels outside of a rectangle as they are: left, top, width and height. Until rendering ends.
    ///
    /// # Panics
    /// Outside of rendering.
    pub fn set_scissor(&mut self, [x, y, width, height]: [u32; 4]) {
        assert!(self.rendering.is_some(), "{}: a scissor outside of rendering", self.commands.name);
        let area = vk::Rect2D {
            offset: vk::Offset2D { x: x.cast_signed(), y: y.cast_signed() },
            extent: vk::Extent2D { width, height },
        };
        // SAFETY: the command buffer is being recorded, with a pipeline whose scissor is dynamic.
        unsafe { self.commands.device.raw.cmd_set_scissor(self.commands.raw, 0, &[area]) };
    }

    /// Draws. The order of two draws is the order of their recording.
    ///
    /// # Panics
    /// Outside of rendering, if the pipeline's formats are not those of the targets, or for a
    /// [`Draw::IndirectCount`] without [`Feature::DrawIndirectCount`].
    pub fn draw(&mut self, pipeline: &GraphicsPipeline, push: &impl Pod, draw: Draw<'_>) {
        self.begin_label(pipeline.name());
        self.bind_graphics(pipeline, bytemuck::bytes_of(push));
        self.record_draw(draw);
        self.end_label();
    }

    /// Ends the pass.
    ///
    /// # Panics
    /// Outside of rendering.
    pub fn end_rendering(&mut self) {
        assert!(self.rendering.take().is_some(), "{}: rendering ends before it begins", self.commands.name);
        // SAFETY: the command buffer is being recorded, inside of rendering.
        unsafe { self.commands.device.raw.cmd_end_rendering(self.commands.raw) };
    }

    pub(crate) fn bind_graphics(&mut self, pipeline: &GraphicsPipeline, push: &[u8]) {
        let expected = self.rendering.as_ref();
        assert_eq!(expected, Some(&*pipeline.formats), "{}: formats of the targets", pipeline.name());
        self.bind(vk::PipelineBindPoint::GRAPHICS, &pipeline.program, push);
    }

    pub(crate) fn record_draw(&mut self, draw: Draw<'_>) {
        self.calls.draws += 1;
        let commands = self.commands.raw;
        let vulkan = &self.commands.device.raw;
        match draw {
            Draw::Direct { vertex_count, instance_count } => {
                // SAFETY: the command buffer is being recorded, inside of rendering; a pipeline is bound.
                unsafe { vulkan.cmd_draw(commands, vertex_count, instance_count, 0, 0) };
            }
            Draw::Indirect { arguments, offset, draw_count, stride } => {
                assert_arguments(arguments, offset, draw_count, stride);
                let raw = arguments.inner.raw;
                let at_once = self.commands.device.facts.features.contains(&Feature::MultiDrawIndirect);
                let (calls, each) = if at_once { (1, draw_count) } else { (draw_count, 1) };
                for call in 0..u64::from(calls) {
                    // SAFETY: as above, and the arguments lie in the buffer, which is kept alive below.
                    unsafe {
                        vulkan.cmd_draw_indirect(commands, raw, offset + call * u64::from(stride), each, stride);
                    }
                }
                self.keep(arguments);
            }
            Draw::IndirectCount { arguments, offset, count, count_offset, max_draw_count, stride } => {
                let has_count = self.commands.device.facts.features.contains(&Feature::DrawIndirectCount);
                assert!(has_count, "{}: this device has no drawIndirectCount", arguments.name());
                assert_arguments(arguments, offset, max_draw_count, stride);
                count.assert_range(count_offset, size_of::<u32>() as u64);
                let (arguments_raw, count_raw) = (arguments.inner.raw, count.inner.raw);
                // SAFETY: as above, and the count lies in its buffer, which is kept alive below.
                unsafe {
                    vulkan.cmd_draw_indirect_count(
                        commands,
                        arguments_raw,
                        offset,
                        count_raw,
                        count_offset,
                        max_draw_count,
                        stride,
                    );
                }
                self.keep(arguments);
                self.keep(count);
            }
        }
    }
}

fn assert_arguments(arguments: &Buffer, offset: u64, draw_count: u32, stride: u32) {
    let size = size_of::<DrawArguments>() as u64;
    if draw_count > 0 {
        arguments.assert_range(offset, u64::from(draw_count - 1) * u64::from(stride) + size);
    }
    assert!(draw_count <= 1 || u64::from(stride) >= size, "{}: arguments overlap", arguments.name());
}

fn color_attachment<'a>(target: &ColorTarget<'a>) -> vk::RenderingAttachmentInfo<'a> {
    let color = match target.clear {
        Clear::Keep => return attachment(target.image, None),
        Clear::Float(float32) => vk::ClearColorValue { float32 },
        Clear::Uint(uint32) => vk::ClearColorValue { uint32 },
    };
    attachment(target.image, Some(vk::ClearValue { color }))
}

fn depth_attachment<'a>(target: &DepthTarget<'a>) -> vk::RenderingAttachmentInfo<'a> {
    let value = |depth| vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } };
    attachment(target.image, target.clear.map(value))
}

fn attachment(image: &Image, clear: Option<vk::ClearValue>) -> vk::RenderingAttachmentInfo<'_> {
    vk::RenderingAttachmentInfo::default()
        .image_view(image.inner.view)
        .image_layout(vk::ImageLayout::GENERAL)
        .load_op(if clear.is_some() { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD })
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(clear.unwrap_or_default())
}
