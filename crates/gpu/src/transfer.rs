//! Copies and fills.

use crate::barrier::PassKind;
use crate::{Buffer, Encoder, Image};
use ash::vk;

/// One copy or fill.
#[derive(Clone, Copy)]
pub enum Transfer<'a> {
    /// Sets words of a buffer.
    Fill {
        /// The buffer.
        buffer: &'a Buffer,
        /// First byte, a multiple of 4.
        offset: u64,
        /// Bytes, a multiple of 4.
        size: u64,
        /// What every word becomes.
        value: u32,
    },
    /// Copies bytes from one buffer to another.
    Copy {
        /// Where from.
        from: &'a Buffer,
        /// First byte there.
        from_offset: u64,
        /// Where to.
        to: &'a Buffer,
        /// First byte there.
        to_offset: u64,
        /// Bytes.
        size: u64,
    },
    /// Copies all of an image to a buffer: rows from the top, without padding.
    Image {
        /// Where from.
        from: &'a Image,
        /// Where to.
        to: &'a Buffer,
        /// First byte there, a multiple of the texel's size.
        to_offset: u64,
    },
}

impl Encoder {
    /// One pass of transfers that are independent of each other: no two touch the same bytes, unless both read.
    pub fn transfer(&mut self, transfers: &[Transfer<'_>]) {
        self.open(PassKind::Transfer);
        for &transfer in transfers {
            match transfer {
                Transfer::Fill { buffer, offset, size, value } => self.record_fill(buffer, offset, size, value),
                Transfer::Copy { from, from_offset, to, to_offset, size } => {
                    let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size };
                    self.record_copy(from, to, region);
                }
                Transfer::Image { from, to, to_offset } => self.record_image_copy(from, to, to_offset),
            }
        }
    }

    /// Sets `size` bytes from byte `offset`, both multiples of 4, to words of `value`.
    pub fn fill_buffer(&mut self, buffer: &Buffer, offset: u64, size: u64, value: u32) {
        self.transfer(&[Transfer::Fill { buffer, offset, size, value }]);
    }

    /// Copies the whole of a buffer to the start of another.
    pub fn copy_buffer(&mut self, from: &Buffer, to: &Buffer) {
        self.transfer(&[Transfer::Copy { from, from_offset: 0, to, to_offset: 0, size: from.size() }]);
    }

    /// Copies the whole of an image to a buffer from byte `offset`: rows from the top, without padding.
    pub fn copy_image_to_buffer(&mut self, from: &Image, to: &Buffer, offset: u64) {
        self.transfer(&[Transfer::Image { from, to, to_offset: offset }]);
    }

    fn record_fill(&mut self, buffer: &Buffer, offset: u64, size: u64, value: u32) {
        buffer.assert_range(offset, size);
        assert!(offset.is_multiple_of(4) && size.is_multiple_of(4), "{}: a fill is of whole words", buffer.name());
        if size > 0 {
            let vulkan = &self.commands.device.raw;
            // SAFETY: the command buffer is being recorded, outside of rendering; the words lie in the buffer, which
            // is kept alive below.
            unsafe { vulkan.cmd_fill_buffer(self.commands.raw, buffer.inner.raw, offset, size, value) };
            self.keep(buffer);
        }
    }

    fn record_copy(&mut self, from: &Buffer, to: &Buffer, region: vk::BufferCopy) {
        from.assert_range(region.src_offset, region.size);
        to.assert_range(region.dst_offset, region.size);
        if region.size > 0 {
            let vulkan = &self.commands.device.raw;
            // SAFETY: the command buffer is being recorded, outside of rendering; both ranges lie in their buffers,
            // which are kept alive below.
            unsafe { vulkan.cmd_copy_buffer(self.commands.raw, from.inner.raw, to.inner.raw, &[region]) };
            self.keep(from);
            self.keep(to);
        }
    }

    fn record_image_copy(&mut self, from: &Image, to: &Buffer, offset: u64) {
        to.assert_range(offset, from.copy_size());
        assert!(offset.is_multiple_of(from.format().bytes()), "{}: an image is copied to whole texels", to.name());
        let [width, height] = from.extent();
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(from.format().aspect()).layer_count(1);
        let region = vk::BufferImageCopy::default()
            .buffer_offset(offset)
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let layout = vk::ImageLayout::GENERAL;
        let vulkan = &self.commands.device.raw;
        // SAFETY: the command buffer is being recorded, outside of rendering; the texels lie in the buffer; the image
        // is in that layout all its life; both are kept alive below.
        unsafe {
            vulkan.cmd_copy_image_to_buffer(self.commands.raw, from.inner.raw, layout, to.inner.raw, &[region]);
        }
        self.keep_object(from.inner.clone());
        self.keep(to);
    }
}
