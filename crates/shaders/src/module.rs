//! What a GPU backend needs to know of a shader, without knowing the generated code.

use std::ffi::CStr;

/// The pipeline stage a module is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShaderStage {
    /// `*.comp`
    Compute,
    /// `*.vert`
    Vertex,
    /// `*.tesc`
    TessellationControl,
    /// `*.tese`
    TessellationEvaluation,
    /// `*.frag`
    Fragment,
}

/// The type of a resource with a descriptor; the names are Vulkan's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BindingKind {
    /// `uniform` block.
    UniformBuffer,
    /// `buffer` block.
    StorageBuffer,
    /// `sampler`
    Sampler,
    /// `texture2D` and the like.
    SampledImage,
    /// `sampler2D` and the like.
    CombinedImageSampler,
    /// `image2D` and the like.
    StorageImage,
    /// `samplerBuffer`, `textureBuffer`
    UniformTexelBuffer,
    /// `imageBuffer`
    StorageTexelBuffer,
    /// `subpassInput`
    InputAttachment,
    /// `accelerationStructureEXT`
    AccelerationStructure,
}

/// A resource with a descriptor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Index of the descriptor set.
    pub set: u32,
    /// Index in the set.
    pub binding: u32,
    /// Name of the variable, or of the block where the variable has none.
    pub name: &'static str,
    /// Descriptor type.
    pub kind: BindingKind,
    /// Length of the array; 1 for a single resource, 0 for an array without a size.
    pub count: u32,
}

/// A specialisation constant of 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    /// `constant_id`
    pub id: u32,
    /// Name in GLSL; `LOCAL_SIZE_X` (`_Y`, `_Z`) for the constant of `local_size_x_id`.
    pub name: &'static str,
    /// Bits of the default value; a bool is 0 or 1.
    pub default: u32,
}

/// A SPIR-V module with what is needed to make a pipeline of it.
#[derive(Clone, Copy, Debug)]
pub struct ShaderModule {
    /// `<stem>_<ext>` of the GLSL file, or `<stem>_<variant>_<ext>`.
    pub name: &'static str,
    /// The one stage the module has an entry point for.
    pub stage: ShaderStage,
    /// SPIR-V 1.6 words.
    pub spirv: &'static [u32],
    /// Name of the entry point.
    pub entry: &'static CStr,
    /// Bytes of push constants, from 0 on; 0 without a block. At most 128, a multiple of 4.
    pub push_size: u32,
    /// Threads of a work group, by default where a specialisation constant sets them; `None` outside compute.
    pub local_size: Option<[u32; 3]>,
    /// Sorted by set and binding.
    pub bindings: &'static [Binding],
    /// Sorted by id.
    pub spec_constants: &'static [SpecConstant],
}
