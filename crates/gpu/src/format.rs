use ash::vk;

/// The texel formats of images.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Four bytes, linear, 0 to 1.
    Rgba8Unorm,
    /// Four 16-bit floats.
    Rgba16Float,
    /// One 32-bit float.
    R32Float,
    /// Two 32-bit floats.
    Rg32Float,
    /// Four 32-bit floats.
    Rgba32Float,
    /// One 32-bit unsigned integer.
    R32Uint,
    /// Two 32-bit unsigned integers.
    Rg32Uint,
    /// Four 32-bit unsigned integers.
    Rgba32Uint,
    /// Depth as a 32-bit float.
    Depth32Float,
}

impl Format {
    /// Bytes of one texel in an image and in the buffer it is copied to.
    #[must_use]
    pub fn bytes(self) -> u64 {
        match self {
            Self::Rgba8Unorm | Self::R32Float | Self::R32Uint | Self::Depth32Float => 4,
            Self::Rgba16Float | Self::Rg32Float | Self::Rg32Uint => 8,
            Self::Rgba32Float | Self::Rgba32Uint => 16,
        }
    }

    /// Whether it is a format of depth rather than colour.
    #[must_use]
    pub fn is_depth(self) -> bool {
        self == Self::Depth32Float
    }

    pub(crate) fn vulkan(self) -> vk::Format {
        match self {
            Self::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
            Self::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Self::R32Float => vk::Format::R32_SFLOAT,
            Self::Rg32Float => vk::Format::R32G32_SFLOAT,
            Self::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Self::R32Uint => vk::Format::R32_UINT,
            Self::Rg32Uint => vk::Format::R32G32_UINT,
            Self::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
            Self::Depth32Float => vk::Format::D32_SFLOAT,
        }
    }

    pub(crate) fn aspect(self) -> vk::ImageAspectFlags {
        if self.is_depth() { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
    }
}
