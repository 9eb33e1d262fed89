//! What compute and graphics pipelines share: shader modules, specialization, the push-constant range.

use crate::device::DeviceInner;
use crate::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// The value of one specialization constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpecConstant {
    /// Its `constant_id`.
    pub id: u32,
    /// Its value: an integer, a bool (0 or 1) or the bits of a float.
    pub bits: u32,
}

/// The first word of every SPIR-V module.
const SPIRV_MAGIC: u32 = 0x0723_0203;

/// A shader module, needed only while its pipeline is made.
pub(crate) struct Module<'a> {
    device: &'a DeviceInner,
    pub(crate) raw: vk::ShaderModule,
}

impl<'a> Module<'a> {
    pub(crate) fn new(device: &'a DeviceInner, name: &str, spirv: &[u32]) -> Result<Self> {
        if spirv.first() != Some(&SPIRV_MAGIC) {
            return Err(Error::NotSpirv { name: name.to_owned() });
        }
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the device lives. That the module is valid for it is up to the caller, as for all shaders.
        let raw = unsafe { device.raw.create_shader_module(&info, None) }
            .map_err(Error::vulkan("vkCreateShaderModule", name))?;
        device.name_object(raw, name);
        Ok(Self { device, raw })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: modules are not used after their pipeline was made, and never by the GPU.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}

/// Specialization constants as Vulkan wants them: a table of places and the bytes.
pub(crate) struct Specialization {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u32>,
}

impl Specialization {
    pub(crate) fn new(constants: &[SpecConstant]) -> Self {
        let entry = |(index, constant): (usize, &SpecConstant)| {
            let offset = (index * size_of::<u32>()) as u32;
            vk::SpecializationMapEntry { constant_id: constant.id, offset, size: size_of::<u32>() }
        };
        Self {
            entries: constants.iter().enumerate().map(entry).collect(),
            data: constants.iter().map(|constant| constant.bits).collect(),
        }
    }

    pub(crate) fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(bytemuck::cast_slice(&self.data))
    }
}

/// A pipeline with its layout: one range of push constants for all its stages.
pub(crate) struct Program {
    pub(crate) pipeline: vk::Pipeline,
    pub(crate) layout: vk::PipelineLayout,
    pub(crate) push_stages: vk::ShaderStageFlags,
    pub(crate) push_size: u32,
    pub(crate) name: String,
    device: Arc<DeviceInner>,
}

impl Program {
    /// The layout; the pipeline is still to be made.
    pub(crate) fn new(
        device: &Arc<DeviceInner>,
        name: &str,
        push_stages: vk::ShaderStageFlags,
        push_size: u32,
    ) -> Result<Self> {
        check_limit(name, "maxPushConstantsSize", push_size, device.limits.max_push_size)?;
        let ranges = [vk::PushConstantRange::default().stage_flags(push_stages).size(push_size)];
        let ranges = if push_size == 0 { &[] } else { &ranges[..] };
        let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(ranges);
        // SAFETY: the device lives and `info` is within its limits.
        let layout = unsafe { device.raw.create_pipeline_layout(&info, None) }
            .map_err(Error::vulkan("vkCreatePipelineLayout", name))?;
        device.name_object(layout, name);
        let device = Arc::clone(device);
        Ok(Self { pipeline: vk::Pipeline::null(), layout, push_stages, push_size, name: name.to_owned(), device })
    }

    /// Takes what a call that makes pipelines returned.
    pub(crate) fn take_pipeline(
        &mut self,
        call: &'static str,
        made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    ) -> Result<()> {
        let made = made.map_err(|(_, result)| Error::vulkan(call, &self.name)(result))?;
        self.pipeline = made[0];
        self.device.name_object(self.pipeline, &self.name);
        Ok(())
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let (pipeline, layout) = (self.pipeline, self.layout);
        self.device.destroy(|vulkan| {
            // SAFETY: the GPU is idle and nobody else has the handles.
            unsafe {
                vulkan.destroy_pipeline(pipeline, None);
                vulkan.destroy_pipeline_layout(layout, None);
            }
        });
    }
}

pub(crate) fn check_limit(name: &str, what: &'static str, asked: u32, most: u32) -> Result<()> {
    if asked > most {
        return Err(Error::OverLimit { name: name.to_owned(), what, asked: asked.into(), most: most.into() });
    }
    Ok(())
}
