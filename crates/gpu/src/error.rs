use crate::facts::ApiVersion;
use ash::vk;

/// Everything that can go wrong between this crate and a Vulkan driver. Every message is one line.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No Vulkan loader library could be opened.
    #[error("no Vulkan loader was found ({reason}): install libvulkan1 or the Vulkan runtime of your driver")]
    NoLoader {
        /// What the system's linker said.
        reason: String,
    },
    /// The loader is older than Vulkan 1.3.
    #[error("Vulkan 1.3 expected, the Vulkan loader offers {found}")]
    OldLoader {
        /// The loader's version.
        found: ApiVersion,
    },
    /// The loader works, but there is no driver behind it.
    #[error(
        "no Vulkan driver is installed: install the driver of your GPU, or mesa-vulkan-drivers for a software driver"
    )]
    NoDriver,
    /// Validation was asked for and its layer is not installed.
    #[error(
        "validation was asked for, but VK_LAYER_KHRONOS_validation is not installed: install vulkan-validationlayers (Debian, Ubuntu), vulkan-validation-layers (Fedora, Arch) or the Vulkan SDK"
    )]
    NoValidationLayer,
    /// No device can run this renderer.
    #[error("no device can be used: {devices}")]
    NoSuitableDevice {
        /// Every device with every reason why it is refused.
        devices: String,
    },
    /// The device that was asked for is not there, or is refused.
    #[error("device \"{selector}\" cannot be used: {devices}")]
    NoSuchDevice {
        /// The index or part of a name that was asked for.
        selector: String,
        /// Every device with every reason why it is refused.
        devices: String,
    },
    /// `PLANISH_HIDE_FEATURE` names something that this crate does not know.
    #[error("PLANISH_HIDE_FEATURE: unknown feature \"{name}\", expected some of {known}")]
    UnknownFeature {
        /// The unknown name.
        name: String,
        /// The names that can be hidden.
        known: String,
    },
    /// Something needs an optional feature that this device lacks.
    #[error("{needed_by}: this device has no {feature}")]
    MissingFeature {
        /// What needs it.
        needed_by: String,
        /// Vulkan's name of the feature.
        feature: &'static str,
    },
    /// An allocation would go over the memory budget.
    #[error("{name}: {asked} bytes asked for with {used} in use, the memory budget is {budget} bytes")]
    OutOfBudget {
        /// The buffer or image.
        name: String,
        /// Bytes asked for.
        asked: u64,
        /// Bytes in use before.
        used: u64,
        /// The budget in bytes.
        budget: u64,
    },
    /// The driver or the allocator gave no memory.
    #[error("{name}: no memory of {asked} bytes: {reason}")]
    NoMemory {
        /// The buffer or image.
        name: String,
        /// Bytes asked for.
        asked: u64,
        /// What the allocator said.
        reason: String,
    },
    /// A number is above a limit of the device.
    #[error("{name}: {what} is {asked}, this device's limit is {most}")]
    OverLimit {
        /// The object.
        name: String,
        /// Vulkan's name of the limit.
        what: &'static str,
        /// The number asked for.
        asked: u64,
        /// The device's limit.
        most: u64,
    },
    /// This device cannot make such an image.
    #[error("{name}: images of format {format} and {width} x {height} pixels are not supported by this device")]
    UnsupportedImage {
        /// The image.
        name: String,
        /// Its format.
        format: String,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The words given as a shader are not SPIR-V.
    #[error("{name}: the shader is not SPIR-V")]
    NotSpirv {
        /// The pipeline.
        name: String,
    },
    /// A mapped read or write reaches past the end of its buffer.
    #[error("{name}: bytes {offset} to {end} asked for, the buffer has {size}")]
    OutOfRange {
        /// The buffer.
        name: String,
        /// First byte.
        offset: u64,
        /// One past the last byte.
        end: u64,
        /// Bytes in the buffer.
        size: u64,
    },
    /// The buffer is of a kind that the CPU does not access in this way.
    #[error("{name}: only {expected} buffers can be {accessed} by the CPU")]
    NotMapped {
        /// The buffer.
        name: String,
        /// The kind that could be.
        expected: &'static str,
        /// `read` or `written`.
        accessed: &'static str,
    },
    /// The device was lost: a fault in a shader, a driver reset or an unplugged GPU.
    #[error("the GPU was lost")]
    DeviceLost,
    /// A submission did not end in time. The device cannot be used any more.
    #[error("the GPU did not finish within {seconds} seconds")]
    Timeout {
        /// How long was waited.
        seconds: u64,
    },
    /// A Vulkan call failed in some other way.
    #[error("{call} failed for {name}: {result}")]
    Vulkan {
        /// The Vulkan function.
        call: &'static str,
        /// The object.
        name: String,
        /// Vulkan's result.
        result: vk::Result,
    },
}

/// The result of everything that can fail here.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// For `map_err`: the error of one Vulkan function about one object.
    pub(crate) fn vulkan(call: &'static str, name: &str) -> impl FnOnce(vk::Result) -> Self {
        move |result| match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost,
            _ => Self::Vulkan { call, name: name.to_owned(), result },
        }
    }
}
