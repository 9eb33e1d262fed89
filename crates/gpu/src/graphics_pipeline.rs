use crate::program::{Module, Program, Specialization};
use crate::{Device, Feature, Format, Result, SpecConstant};
use ash::vk;
use std::sync::Arc;

/// A stage of a graphics pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// `.vert`
    Vertex,
    /// `.tesc`
    TessellationControl,
    /// `.tese`
    TessellationEvaluation,
    /// `.frag`
    Fragment,
}

impl Stage {
    fn flag(self) -> vk::ShaderStageFlags {
        match self {
            Self::Vertex => vk::ShaderStageFlags::VERTEX,
            Self::TessellationControl => vk::ShaderStageFlags::TESSELLATION_CONTROL,
            Self::TessellationEvaluation => vk::ShaderStageFlags::TESSELLATION_EVALUATION,
            Self::Fragment => vk::ShaderStageFlags::FRAGMENT,
        }
    }
}

/// One shader of a graphics pipeline.
#[derive(Debug, Clone, Copy)]
pub struct StageDesc<'a> {
    /// Which stage it is.
    pub stage: Stage,
    /// The shader, with an entry point `main`, no vertex inputs and no descriptors.
    pub spirv: &'a [u32],
    /// Specialization constants.
    pub spec: &'a [SpecConstant],
}

/// What the vertex shader's outputs make up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Three vertices a triangle.
    Triangles,
    /// Patches for the tessellation stages.
    Patches {
        /// Vertices a patch.
        control_points: u32,
    },
}

/// Whether polygons are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PolygonMode {
    /// Filled.
    Fill,
    /// Edges only, one pixel wide. Needs [`Feature::FillModeNonSolid`].
    Line,
}

/// Which fragments pass, comparing their depth with the image's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DepthTest {
    /// All.
    Off,
    /// The nearer, where depth grows with distance.
    Less,
    /// The nearer and the equal, where depth grows with distance.
    LessOrEqual,
    /// Only the equal.
    Equal,
    /// The nearer, where depth falls with distance ("reverse z").
    Greater,
    /// The nearer and the equal, where depth falls with distance.
    GreaterOrEqual,
}

impl DepthTest {
    fn compare(self) -> vk::CompareOp {
        match self {
            Self::Off => vk::CompareOp::ALWAYS,
            Self::Less => vk::CompareOp::LESS,
            Self::LessOrEqual => vk::CompareOp::LESS_OR_EQUAL,
            Self::Equal => vk::CompareOp::EQUAL,
            Self::Greater => vk::CompareOp::GREATER,
            Self::GreaterOrEqual => vk::CompareOp::GREATER_OR_EQUAL,
        }
    }
}

/// An offset that is added to every fragment's depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthBias {
    /// In units of the smallest depth step.
    pub constant: f32,
    /// Times the polygon's slope in depth per pixel.
    pub slope: f32,
}

/// What to make. The default has no stages and no targets, and draws filled triangles of both sides.
#[derive(Debug, Clone, Copy)]
pub struct GraphicsPipelineDesc<'a> {
    /// For debuggers and messages.
    pub name: &'a str,
    /// Its shaders.
    pub stages: &'a [StageDesc<'a>],
    /// Bytes of the push constants, which all stages see.
    pub push_size: u32,
    /// What is drawn.
    pub topology: Topology,
    /// The formats of the colour targets, by fragment output location.
    pub color_formats: &'a [Format],
    /// The format of the depth target, if any.
    pub depth_format: Option<Format>,
    /// Which fragments pass.
    pub depth_test: DepthTest,
    /// Whether those that pass store their depth. Ignored if the test is [`DepthTest::Off`].
    pub depth_write: bool,
    /// An offset of depth.
    pub depth_bias: Option<DepthBias>,
    /// Filled or not.
    pub polygon_mode: PolygonMode,
    /// Whether polygons that show their back are left out. The front is where the vertices run counter-clockwise in
    /// the picture; a `ccw` tessellation shows its front where S_u x S_v points to the viewer.
    pub cull_back: bool,
    /// Whether nothing is rasterized: for transform feedback.
    pub rasterizer_discard: bool,
}

impl Default for GraphicsPipelineDesc<'_> {
    fn default() -> Self {
        Self {
            name: "",
            stages: &[],
            push_size: 0,
            topology: Topology::Triangles,
            color_formats: &[],
            depth_format: None,
            depth_test: DepthTest::Off,
            depth_write: false,
            depth_bias: None,
            polygon_mode: PolygonMode::Fill,
            cull_back: false,
            rasterizer_discard: false,
        }
    }
}

/// The formats a pipeline draws into, which must be those of the targets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TargetFormats {
    pub(crate) colors: Vec<Format>,
    pub(crate) depth: Option<Format>,
}

/// A graphics program. Cheap to clone; freed with the last clone, once the GPU is idle.
#[derive(Clone)]
pub struct GraphicsPipeline {
    pub(crate) program: Arc<Program>,
    pub(crate) formats: Arc<TargetFormats>,
}

impl GraphicsPipeline {
    /// Compiles shaders for the device. The SPIR-V must be valid: nothing checks it but the validation layer.
    ///
    /// # Errors
    /// Push constants beyond the device's limit, a missing feature, and failures of the driver.
    pub fn new(device: &Device, desc: &GraphicsPipelineDesc<'_>) -> Result<Self> {
        let inner = &device.inner;
        if desc.polygon_mode == PolygonMode::Line {
            inner.need(Feature::FillModeNonSolid, desc.name)?;
        }
        let flags = desc.stages.iter().fold(vk::ShaderStageFlags::empty(), |flags, stage| flags | stage.stage.flag());
        let mut program = Program::new(inner, desc.name, flags, desc.push_size)?;
        let modules: Vec<_> =
            desc.stages.iter().map(|stage| Module::new(inner, desc.name, stage.spirv)).collect::<Result<_>>()?;
        let constants: Vec<_> = desc.stages.iter().map(|stage| Specialization::new(stage.spec)).collect();
        let constants: Vec<_> = constants.iter().map(Specialization::info).collect();
        let stages: Vec<_> = desc
            .stages
            .iter()
            .zip(modules.iter().zip(&constants))
            .map(|(stage, (module, constants))| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage.stage.flag())
                    .module(module.raw)
                    .name(c"main")
                    .specialization_info(constants)
            })
            .collect();
        let made = create(inner, desc, program.layout, &stages);
        program.take_pipeline("vkCreateGraphicsPipelines", made)?;
        let formats = TargetFormats { colors: desc.color_formats.to_vec(), depth: desc.depth_format };
        Ok(Self { program: Arc::new(program), formats: Arc::new(formats) })
    }

    /// The name it was made with.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.program.name
    }
}

/// Spells out the fixed-function state.
fn create(
    device: &crate::device::DeviceInner,
    desc: &GraphicsPipelineDesc<'_>,
    layout: vk::PipelineLayout,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
) -> Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)> {
    let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
    let (topology, control_points) = match desc.topology {
        Topology::Triangles => (vk::PrimitiveTopology::TRIANGLE_LIST, None),
        Topology::Patches { control_points } => (vk::PrimitiveTopology::PATCH_LIST, Some(control_points)),
    };
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(topology);
    // With the origin below, v points up as u points right: `ccw` means counter-clockwise in (u, v).
    let mut origin = vk::PipelineTessellationDomainOriginStateCreateInfo::default()
        .domain_origin(vk::TessellationDomainOrigin::LOWER_LEFT);
    let tessellation = vk::PipelineTessellationStateCreateInfo::default()
        .patch_control_points(control_points.unwrap_or(1))
        .push_next(&mut origin);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let bias = desc.depth_bias.unwrap_or(DepthBias { constant: 0.0, slope: 0.0 });
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .rasterizer_discard_enable(desc.rasterizer_discard)
        .polygon_mode(match desc.polygon_mode {
            PolygonMode::Fill => vk::PolygonMode::FILL,
            PolygonMode::Line => vk::PolygonMode::LINE,
        })
        .cull_mode(if desc.cull_back { vk::CullModeFlags::BACK } else { vk::CullModeFlags::NONE })
        .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
        .depth_bias_enable(desc.depth_bias.is_some())
        .depth_bias_constant_factor(bias.constant)
        .depth_bias_slope_factor(bias.slope)
        .line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(desc.depth_test != DepthTest::Off)
        .depth_write_enable(desc.depth_write)
        .depth_compare_op(desc.depth_test.compare());
    let written = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    let written = vec![written; desc.color_formats.len()];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&written);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let color_formats: Vec<_> = desc.color_formats.iter().map(|format| format.vulkan()).collect();
    let mut targets = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&color_formats)
        .depth_attachment_format(desc.depth_format.map_or(vk::Format::UNDEFINED, Format::vulkan));
    let mut info = vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut targets);
    if control_points.is_some() {
        info = info.tessellation_state(&tessellation);
    }
    // SAFETY: `info` and what it points to outlive the call; all handles are of this device.
    unsafe { device.raw.create_graphics_pipelines(device.pipeline_cache, &[info], None) }
}
