use crate::program::{Module, Program, Specialization, check_limit};
use crate::{Device, Result, SpecConstant};
use ash::vk;
use std::sync::Arc;

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct ComputePipelineDesc<'a> {
    /// For debuggers and messages.
    pub name: &'a str,
    /// The shader, with an entry point `main` and no descriptors.
    pub spirv: &'a [u32],
    /// Bytes of its push constants.
    pub push_size: u32,
    /// Threads of one group: its `local_size_x`. `local_size_y` and `local_size_z` are 1.
    pub local_size: u32,
    /// Specialization constants.
    pub spec: &'a [SpecConstant],
}

/// A compute program. Cheap to clone; freed with the last clone, once the GPU is idle.
#[derive(Clone)]
pub struct ComputePipeline {
    pub(crate) program: Arc<Program>,
    pub(crate) local_size: u32,
}

impl ComputePipeline {
    /// Compiles a shader for the device. The SPIR-V must be valid: nothing checks it but the validation layer.
    ///
    /// # Errors
    /// Push constants or a local size beyond the device's limits, and failures of the driver.
    ///
    /// # Panics
    /// If the local size is 0.
    pub fn new(device: &Device, desc: &ComputePipelineDesc<'_>) -> Result<Self> {
        assert!(desc.local_size > 0, "{}: a group has at least one thread", desc.name);
        let inner = &device.inner;
        check_limit(desc.name, "maxComputeWorkGroupSize", desc.local_size, inner.limits.max_local_size)?;
        let module = Module::new(inner, desc.name, desc.spirv)?;
        let mut program = Program::new(inner, desc.name, vk::ShaderStageFlags::COMPUTE, desc.push_size)?;
        let specialization = Specialization::new(desc.spec);
        let specialization = specialization.info();
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.raw)
            .name(c"main")
            .specialization_info(&specialization);
        let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(program.layout)];
        // SAFETY: `info` and what it points to outlive the call; all handles are of this device.
        let made = unsafe { inner.raw.create_compute_pipelines(inner.pipeline_cache, &info, None) };
        program.take_pipeline("vkCreateComputePipelines", made)?;
        Ok(Self { program: Arc::new(program), local_size: desc.local_size })
    }

    /// The name it was made with.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.program.name
    }
}
