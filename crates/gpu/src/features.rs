//! Vulkan features by name: which are needed, which are used where there are, and how to ask and enable them.

use ash::{ext, vk};
use std::collections::BTreeSet;
use std::ffi::CStr;

/// A device feature, named as Vulkan names it. The required ones come first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Feature {
    /// Tessellation-control and -evaluation shaders. Required.
    TessellationShader,
    /// Buffers are read and written through addresses. Required.
    BufferDeviceAddress,
    /// Structures have the layout that Rust's `repr(C)` gives them. Required.
    ScalarBlockLayout,
    /// Rendering without render-pass objects. Required.
    DynamicRendering,
    /// Barriers of the second kind. Required.
    Synchronization2,
    /// Local sizes by specialization constants. Required.
    Maintenance4,
    /// Fragments that are discarded go on for the differences to their neighbours. Required, as of every device of Vulkan 1.3.
    ShaderDemoteToHelperInvocation,
    /// Capture of primitives before rasterization.
    TransformFeedback,
    /// Several draws by one indirect command; without it they are recorded one by one.
    MultiDrawIndirect,
    /// The number of indirect draws is read from a buffer.
    DrawIndirectCount,
    /// Indirect draws may start at another instance than 0.
    DrawIndirectFirstInstance,
    /// Polygons drawn as lines.
    FillModeNonSolid,
    /// Counts of shader invocations and clipped primitives.
    PipelineStatisticsQuery,
    /// 64-bit integers in shaders.
    ShaderInt64,
    /// 64-bit floats in shaders.
    ShaderFloat64,
    /// Geometry shaders; also what lets a fragment shader read `gl_PrimitiveID`.
    GeometryShader,
    /// Vertex and tessellation shaders may write to memory.
    VertexPipelineStoresAndAtomics,
    /// Fragment shaders may write to memory.
    FragmentStoresAndAtomics,
}

impl Feature {
    /// Every feature this crate knows.
    pub const ALL: [Self; 18] = [
        Self::TessellationShader,
        Self::BufferDeviceAddress,
        Self::ScalarBlockLayout,
        Self::DynamicRendering,
        Self::Synchronization2,
        Self::Maintenance4,
        Self::ShaderDemoteToHelperInvocation,
        Self::TransformFeedback,
        Self::MultiDrawIndirect,
        Self::DrawIndirectCount,
        Self::DrawIndirectFirstInstance,
        Self::FillModeNonSolid,
        Self::PipelineStatisticsQuery,
        Self::ShaderInt64,
        Self::ShaderFloat64,
        Self::GeometryShader,
        Self::VertexPipelineStoresAndAtomics,
        Self::FragmentStoresAndAtomics,
    ];

    /// Vulkan's name, as in `VkPhysicalDeviceFeatures` and its successors.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::TessellationShader => "tessellationShader",
            Self::BufferDeviceAddress => "bufferDeviceAddress",
            Self::ScalarBlockLayout => "scalarBlockLayout",
            Self::DynamicRendering => "dynamicRendering",
            Self::Synchronization2 => "synchronization2",
            Self::Maintenance4 => "maintenance4",
            Self::ShaderDemoteToHelperInvocation => "shaderDemoteToHelperInvocation",
            Self::TransformFeedback => "transformFeedback",
            Self::MultiDrawIndirect => "multiDrawIndirect",
            Self::DrawIndirectCount => "drawIndirectCount",
            Self::DrawIndirectFirstInstance => "drawIndirectFirstInstance",
            Self::FillModeNonSolid => "fillModeNonSolid",
            Self::PipelineStatisticsQuery => "pipelineStatisticsQuery",
            Self::ShaderInt64 => "shaderInt64",
            Self::ShaderFloat64 => "shaderFloat64",
            Self::GeometryShader => "geometryShader",
            Self::VertexPipelineStoresAndAtomics => "vertexPipelineStoresAndAtomics",
            Self::FragmentStoresAndAtomics => "fragmentStoresAndAtomics",
        }
    }

    /// Whether a device without it is refused.
    #[must_use]
    pub fn is_required(self) -> bool {
        self <= Self::ShaderDemoteToHelperInvocation
    }

    /// Whether it can be asked of a device of any version: the others came with Vulkan 1.2 and 1.3 or an extension.
    pub(crate) fn is_vulkan_1_0(self) -> bool {
        self == Self::TessellationShader || self == Self::MultiDrawIndirect || self >= Self::DrawIndirectFirstInstance
    }

    /// The feature of that Vulkan name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|feature| feature.name() == name)
    }
}

/// Vulkan's feature structures, side by side.
#[derive(Default)]
pub(crate) struct FeatureStructs {
    pub(crate) core: vk::PhysicalDeviceFeatures,
    pub(crate) vulkan12: vk::PhysicalDeviceVulkan12Features<'static>,
    pub(crate) vulkan13: vk::PhysicalDeviceVulkan13Features<'static>,
    pub(crate) feedback: vk::PhysicalDeviceTransformFeedbackFeaturesEXT<'static>,
}

impl FeatureStructs {
    /// The structures that enable exactly these features.
    pub(crate) fn enabling(features: &BTreeSet<Feature>) -> Self {
        let mut structs = Self::default();
        for &feature in features {
            *structs.flag(feature) = vk::TRUE;
        }
        structs
    }

    fn flag(&mut self, feature: Feature) -> &mut vk::Bool32 {
        match feature {
            Feature::TessellationShader => &mut self.core.tessellation_shader,
            Feature::BufferDeviceAddress => &mut self.vulkan12.buffer_device_address,
            Feature::ScalarBlockLayout => &mut self.vulkan12.scalar_block_layout,
            Feature::DynamicRendering => &mut self.vulkan13.dynamic_rendering,
            Feature::Synchronization2 => &mut self.vulkan13.synchronization2,
            Feature::Maintenance4 => &mut self.vulkan13.maintenance4,
            Feature::ShaderDemoteToHelperInvocation => &mut self.vulkan13.shader_demote_to_helper_invocation,
            Feature::TransformFeedback => &mut self.feedback.transform_feedback,
            Feature::MultiDrawIndirect => &mut self.core.multi_draw_indirect,
            Feature::DrawIndirectCount => &mut self.vulkan12.draw_indirect_count,
            Feature::DrawIndirectFirstInstance => &mut self.core.draw_indirect_first_instance,
            Feature::FillModeNonSolid => &mut self.core.fill_mode_non_solid,
            Feature::PipelineStatisticsQuery => &mut self.core.pipeline_statistics_query,
            Feature::ShaderInt64 => &mut self.core.shader_int64,
            Feature::ShaderFloat64 => &mut self.core.shader_float64,
            Feature::GeometryShader => &mut self.core.geometry_shader,
            Feature::VertexPipelineStoresAndAtomics => &mut self.core.vertex_pipeline_stores_and_atomics,
            Feature::FragmentStoresAndAtomics => &mut self.core.fragment_stores_and_atomics,
        }
    }
}

/// The features of a device of Vulkan 1.3; of an older one, those of Vulkan 1.0.
pub(crate) fn supported_features(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    api_version: u32,
    extensions: &[vk::ExtensionProperties],
) -> BTreeSet<Feature> {
    let mut structs = FeatureStructs::default();
    if api_version >= vk::API_VERSION_1_3 {
        let mut chain =
            vk::PhysicalDeviceFeatures2::default().push_next(&mut structs.vulkan12).push_next(&mut structs.vulkan13);
        if has_extension(extensions, ext::transform_feedback::NAME) {
            chain = chain.push_next(&mut structs.feedback);
        }
        // SAFETY: `physical` comes from `instance`, the device is of Vulkan 1.1 or later, and the chain's structures
        // outlive the call.
        unsafe { instance.get_physical_device_features2(physical, &mut chain) };
        structs.core = chain.features;
    } else {
        // SAFETY: `physical` comes from `instance`.
        structs.core = unsafe { instance.get_physical_device_features(physical) };
    }
    Feature::ALL.into_iter().filter(|&feature| *structs.flag(feature) == vk::TRUE).collect()
}

/// Whether a list of extensions has one of this name.
pub(crate) fn has_extension(extensions: &[vk::ExtensionProperties], name: &CStr) -> bool {
    extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name))
}
