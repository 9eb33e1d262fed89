//! Images to draw into and copy from.

use crate::device::DeviceInner;
use crate::memory::{Location, MemoryBlock, MemoryRequest};
use crate::{Device, Encoder, Error, Format, Result};
use ash::vk;
use std::sync::Arc;

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct ImageDesc<'a> {
    /// For debuggers and messages.
    pub name: &'a str,
    /// Colour or depth.
    pub format: Format,
    /// Width and height in pixels.
    pub extent: [u32; 2],
}

/// A 2D image of one sample and one level, which can be drawn into and copied to a buffer.
/// It is in the layout `GENERAL` all its life. Cheap to clone; freed with the last clone, once the GPU is idle.
#[derive(Clone)]
pub struct Image {
    pub(crate) inner: Arc<ImageInner>,
}

pub(crate) struct ImageInner {
    pub(crate) raw: vk::Image,
    pub(crate) view: vk::ImageView,
    name: String,
    format: Format,
    extent: [u32; 2],
    /// Bytes that count against the budget.
    required: u64,
    block: Option<MemoryBlock>,
    device: Arc<DeviceInner>,
}

impl Image {
    /// Makes an image. Its contents are undefined.
    ///
    /// # Errors
    /// [`Error::OutOfBudget`], [`Error::UnsupportedImage`] and failures of the driver.
    pub fn new(device: &Device, desc: &ImageDesc<'_>) -> Result<Self> {
        let vulkan = &device.inner.raw;
        let info = image_info(device, desc)?;
        // SAFETY: the device lives and supports such an image.
        let raw = unsafe { vulkan.create_image(&info, None) }.map_err(Error::vulkan("vkCreateImage", desc.name))?;
        // From here on, `Drop` takes care of the image whatever fails.
        let mut image = ImageInner {
            raw,
            view: vk::ImageView::null(),
            name: desc.name.to_owned(),
            format: desc.format,
            extent: desc.extent,
            required: 0,
            block: None,
            device: Arc::clone(&device.inner),
        };
        // SAFETY: the image is of this device.
        let requirements = unsafe { vulkan.get_image_memory_requirements(raw) };
        let block = device.inner.allocate(&MemoryRequest {
            name: desc.name,
            requirements,
            location: Location::Device,
            is_linear: false,
        })?;
        let (memory, offset) = (block.memory, block.offset);
        image.required = requirements.size;
        image.block = Some(block);
        // SAFETY: the block fits the requirements and belongs to nothing else; the image has no memory yet.
        unsafe { vulkan.bind_image_memory(raw, memory, offset) }
            .map_err(Error::vulkan("vkBindImageMemory", desc.name))?;
        let view = vk::ImageViewCreateInfo::default()
            .image(raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(info.format)
            .subresource_range(whole(desc.format));
        // SAFETY: the image is of this device, has memory and is of that format.
        image.view =
            unsafe { vulkan.create_image_view(&view, None) }.map_err(Error::vulkan("vkCreateImageView", desc.name))?;
        device.inner.name_object(raw, desc.name);
        device.inner.name_object(image.view, desc.name);

        let image = Self { inner: Arc::new(image) };
        let mut encoder = Encoder::new(device, desc.name)?;
        encoder.prepare_image(&image);
        device.submit_and_wait(&encoder.finish()?)?;
        Ok(image)
    }

    /// The name it was made with.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.inner.name
    }

    /// Its texels' format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.inner.format
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn extent(&self) -> [u32; 2] {
        self.inner.extent
    }

    /// Bytes that a copy to a buffer writes: rows from the top, without padding.
    #[must_use]
    pub fn copy_size(&self) -> u64 {
        u64::from(self.inner.extent[0]) * u64::from(self.inner.extent[1]) * self.inner.format.bytes()
    }
}

/// All of an image.
pub(crate) fn whole(format: Format) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default().aspect_mask(format.aspect()).level_count(1).layer_count(1)
}

/// What to ask of Vulkan, after a look whether the device can do it.
fn image_info(device: &Device, desc: &ImageDesc<'_>) -> Result<vk::ImageCreateInfo<'static>> {
    use vk::ImageUsageFlags as Usage;
    let [width, height] = desc.extent;
    let attachment = if desc.format.is_depth() { Usage::DEPTH_STENCIL_ATTACHMENT } else { Usage::COLOR_ATTACHMENT };
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(desc.format.vulkan())
        .extent(vk::Extent3D { width, height, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .tiling(vk::ImageTiling::OPTIMAL)
        .usage(attachment | Usage::TRANSFER_SRC)
        .initial_layout(vk::ImageLayout::UNDEFINED);
    // SAFETY: the physical device comes from this instance.
    let properties = unsafe {
        device.inner.instance.raw.get_physical_device_image_format_properties(
            device.inner.physical,
            info.format,
            info.image_type,
            info.tiling,
            info.usage,
            info.flags,
        )
    };
    let most = device.limits().max_image_extent;
    let fits = |largest: vk::Extent3D| {
        (1..=largest.width.min(most)).contains(&width) && (1..=largest.height.min(most)).contains(&height)
    };
    match properties {
        Ok(properties) if fits(properties.max_extent) => Ok(info),
        _ => Err(Error::UnsupportedImage {
            name: desc.name.to_owned(),
            format: format!("{:?}", desc.format),
            width,
            height,
        }),
    }
}

impl Drop for ImageInner {
    fn drop(&mut self) {
        let (raw, view, required) = (self.raw, self.view, self.required);
        let block = &mut self.block;
        let device = &self.device;
        device.destroy(|vulkan| {
            // SAFETY: the GPU is idle and nobody else has the handles.
            unsafe {
                vulkan.destroy_image_view(view, None);
                vulkan.destroy_image(raw, None);
            }
            if let Some(block) = block.take() {
                device.free(block, required);
            }
        });
    }
}
