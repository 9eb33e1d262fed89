//! Asks Vulkan for the facts and limits of a device.

use crate::features::{has_extension, supported_features};
use crate::{ApiVersion, DeviceFacts, DeviceKind, Error, Result};
use ash::{ext, vk};
use std::ffi::CStr;

/// The environment variable that makes the device check treat features as missing, so that refusals can be tested
/// on a machine whose device has everything: `PLANISH_HIDE_FEATURE=tessellationShader,transformFeedback`.
pub const HIDE_FEATURE_VARIABLE: &str = "PLANISH_HIDE_FEATURE";

/// The limits of a device that matter here.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// The highest tessellation factor.
    pub max_tessellation_level: u32,
    /// Nanoseconds of one timestamp tick.
    pub timestamp_period: f32,
    /// Bits of a timestamp that count; 0 when the queue has no timestamps.
    pub timestamp_bits: u32,
    /// Bytes of push constants.
    pub max_push_size: u32,
    /// Threads in one compute group.
    pub max_local_size: u32,
    /// Colour targets that one pass can draw into.
    pub max_color_attachments: u32,
    /// Pixels of a side of an image.
    pub max_image_extent: u32,
    /// Bytes of one buffer.
    pub max_buffer_size: u64,
    /// Bytes of the largest memory heap.
    pub largest_heap: u64,
    /// Buffers that one transform feedback can write at once; 0 without the feature.
    pub max_feedback_buffers: u32,
    /// Bits behind the point of a vertex' place in pixels, to which the rasterizer rounds it.
    pub sub_pixel_bits: u32,
}

/// One physical device and all that is known of it before it is opened.
pub(crate) struct Candidate {
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) facts: DeviceFacts,
    pub(crate) limits: Limits,
    /// The queue family for everything; meaningless if the facts say that there is none.
    pub(crate) queue_family: u32,
}

impl Candidate {
    pub(crate) fn new(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<Self> {
        // SAFETY: `physical` comes from `instance`.
        let (core, families, memory) = unsafe {
            (
                instance.get_physical_device_properties(physical),
                instance.get_physical_device_queue_family_properties(physical),
                instance.get_physical_device_memory_properties(physical),
            )
        };
        // SAFETY: as above.
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }
            .map_err(Error::vulkan("vkEnumerateDeviceExtensionProperties", "a device"))?;
        let newer = NewerProperties::new(instance, physical, core.api_version, &extensions);

        let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = families.iter().position(|family| family.queue_flags.contains(both));
        let mut facts = DeviceFacts {
            name: string(core.device_name_as_c_str()),
            driver: newer.driver.unwrap_or_else(|| format!("driver {:#x}", core.driver_version)),
            kind: kind(core.device_type),
            api_version: version_of(core.api_version),
            features: supported_features(instance, physical, core.api_version, &extensions),
            has_graphics_compute_queue: family.is_some(),
        };
        if let Ok(names) = std::env::var(HIDE_FEATURE_VARIABLE) {
            facts.hide(&names)?;
        }
        let family = family.unwrap_or(0);
        let limits = Limits {
            max_tessellation_level: core.limits.max_tessellation_generation_level,
            timestamp_period: core.limits.timestamp_period,
            timestamp_bits: families.get(family).map_or(0, |family| family.timestamp_valid_bits),
            max_push_size: core.limits.max_push_constants_size,
            max_local_size: core.limits.max_compute_work_group_size[0]
                .min(core.limits.max_compute_work_group_invocations),
            max_color_attachments: core.limits.max_color_attachments,
            max_image_extent: core.limits.max_image_dimension2_d.min(core.limits.max_framebuffer_width),
            max_buffer_size: newer.max_buffer_size,
            largest_heap: memory.memory_heaps_as_slice().iter().map(|heap| heap.size).max().unwrap_or(0),
            max_feedback_buffers: newer.max_feedback_buffers,
            sub_pixel_bits: core.limits.sub_pixel_precision_bits,
        };
        Ok(Self { physical, facts, limits, queue_family: family as u32 })
    }
}

/// Properties that came after Vulkan 1.0; of an older device nothing is asked, as it is refused anyway.
#[derive(Default)]
struct NewerProperties {
    driver: Option<String>,
    max_buffer_size: u64,
    max_feedback_buffers: u32,
}

impl NewerProperties {
    fn new(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        api_version: u32,
        extensions: &[vk::ExtensionProperties],
    ) -> Self {
        if api_version < vk::API_VERSION_1_3 {
            return Self::default();
        }
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut maintenance4 = vk::PhysicalDeviceMaintenance4Properties::default();
        let mut feedback = vk::PhysicalDeviceTransformFeedbackPropertiesEXT::default();
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut maintenance4);
        if has_extension(extensions, ext::transform_feedback::NAME) {
            chain = chain.push_next(&mut feedback);
        }
        // SAFETY: `physical` comes from `instance` and is of Vulkan 1.3; the chain's structures outlive the call.
        unsafe { instance.get_physical_device_properties2(physical, &mut chain) };
        let (name, info) = (string(driver.driver_name_as_c_str()), string(driver.driver_info_as_c_str()));
        Self {
            driver: Some(format!("{name} {info}").trim().to_owned()),
            max_buffer_size: maintenance4.max_buffer_size,
            max_feedback_buffers: feedback.max_transform_feedback_buffers,
        }
    }
}

fn kind(kind: vk::PhysicalDeviceType) -> DeviceKind {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
        vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
        vk::PhysicalDeviceType::CPU => DeviceKind::Software,
        _ => DeviceKind::Other,
    }
}

fn string<E>(text: Result<&CStr, E>) -> String {
    text.map(|text| text.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Unpacks Vulkan's version word.
pub(crate) fn version_of(packed: u32) -> ApiVersion {
    ApiVersion {
        major: vk::api_version_major(packed),
        minor: vk::api_version_minor(packed),
        patch: vk::api_version_patch(packed),
    }
}
