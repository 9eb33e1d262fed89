//! Shader modules to pipelines.

use planish_gpu::{ComputePipeline, ComputePipelineDesc, Device, SpecConstant, Stage, StageDesc};
use planish_shaders::{ShaderModule, ShaderStage};

use crate::error::Error;
use crate::options::FrameNeeds;

/// A compute pipeline without specialization constants.
pub(crate) fn compute_pipeline(device: &Device, module: &ShaderModule) -> Result<ComputePipeline, Error> {
    specialized_compute_pipeline(device, module, module.local_size.map_or(1, |size| size[0]), &[])
}

/// A compute pipeline that knows whether objects are displaced, and whether faces are Gregory patches.
pub(crate) fn displaced_compute_pipeline(
    device: &Device,
    module: &ShaderModule,
    needs: &FrameNeeds,
) -> Result<ComputePipeline, Error> {
    let displaced = SpecConstant { id: planish_shaders::limit_comp::SPEC_DISPLACED, bits: u32::from(needs.displaced) };
    let gregory = SpecConstant { id: planish_shaders::limit_comp::SPEC_GREGORY, bits: u32::from(needs.gregory) };
    let knows = |constant: &SpecConstant| module.spec_constants.iter().any(|known| known.id == constant.id);
    let spec: Vec<SpecConstant> = [displaced, gregory].into_iter().filter(knows).collect();
    specialized_compute_pipeline(device, module, module.local_size.map_or(1, |size| size[0]), &spec)
}

/// A compute pipeline whose groups have this many threads by these specialization constants.
pub(crate) fn specialized_compute_pipeline(
    device: &Device,
    module: &ShaderModule,
    local_size: u32,
    spec: &[SpecConstant],
) -> Result<ComputePipeline, Error> {
    Ok(ComputePipeline::new(
        device,
        &ComputePipelineDesc { name: module.name, spirv: module.spirv, push_size: module.push_size, local_size, spec },
    )?)
}

/// A stage of a graphics pipeline.
pub(crate) fn stage<'a>(module: &ShaderModule, spec: &'a [SpecConstant]) -> StageDesc<'a> {
    let stage = match module.stage {
        ShaderStage::Vertex => Stage::Vertex,
        ShaderStage::TessellationControl => Stage::TessellationControl,
        ShaderStage::TessellationEvaluation => Stage::TessellationEvaluation,
        ShaderStage::Fragment => Stage::Fragment,
        ShaderStage::Compute => unreachable!("{}: a compute shader is no stage of a draw", module.name),
    };
    StageDesc { stage, spirv: module.spirv, spec }
}
