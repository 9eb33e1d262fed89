//! GLSL to SPIR-V while the tests run.

use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage, SpirvVersion,
    Target, VulkanVersion,
};

/// What every shader here starts with.
const HEADER: &str = "#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
";

/// The SPIR-V of a shader whose version and extensions are [`HEADER`]'s.
pub fn compile(stage: ShaderStage, body: &str) -> Vec<u32> {
    let source = ShaderSource::from(format!("{HEADER}{body}"));
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let compiler = Compiler::acquire().expect("glslang starts once a process");
    let input = ShaderInput::new(&source, stage, &options, None::<&[(&str, Option<&str>)]>, None).expect("parses");
    compiler.create_shader(input).expect("compiles").compile().expect("links")
}
