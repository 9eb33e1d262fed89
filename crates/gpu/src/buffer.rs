//! Buffers: read and written by the GPU through addresses.

use crate::device::DeviceInner;
use crate::memory::{Location, MemoryBlock, MemoryRequest};
use crate::{Device, Error, Feature, Result};
use ash::vk;
use bytemuck::Pod;
use std::ptr::NonNull;
use std::sync::Arc;

/// Who accesses a buffer besides the GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BufferKind {
    /// Nobody: the fastest memory for the GPU.
    Device,
    /// The CPU writes it, with [`Buffer::write`].
    Upload,
    /// The CPU reads it, with [`Buffer::read`].
    Readback,
}

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct BufferDesc<'a> {
    /// For debuggers and messages.
    pub name: &'a str,
    /// Who accesses it besides the GPU.
    pub kind: BufferKind,
    /// Bytes. A buffer of 0 bytes has an address too.
    pub size: u64,
}

/// A buffer. Every buffer can be used for everything: storage by address, copies, indirect arguments and, where the
/// device has it, transform feedback. Cheap to clone; freed with the last clone, once the GPU is idle.
#[derive(Clone)]
pub struct Buffer {
    pub(crate) inner: Arc<BufferInner>,
}

pub(crate) struct BufferInner {
    pub(crate) raw: vk::Buffer,
    name: String,
    kind: BufferKind,
    size: u64,
    address: u64,
    /// Bytes that count against the budget.
    required: u64,
    block: Option<MemoryBlock>,
    device: Arc<DeviceInner>,
}

/// Buffers hold at least this many bytes, as Vulkan has none of size 0.
const LEAST_SIZE: u64 = 16;
/// Addresses are multiples of this many bytes, so that shaders may read a `vec4` at once.
const ALIGNMENT: u64 = 16;

impl Buffer {
    /// Makes a buffer. Its contents are undefined.
    ///
    /// # Errors
    /// [`Error::OutOfBudget`], [`Error::OverLimit`] and failures of the driver.
    pub fn new(device: &Device, desc: &BufferDesc<'_>) -> Result<Self> {
        use vk::BufferUsageFlags as Usage;
        let most = device.limits().max_buffer_size;
        if desc.size > most {
            return Err(Error::OverLimit { name: desc.name.to_owned(), what: "maxBufferSize", asked: desc.size, most });
        }
        let mut usage = Usage::STORAGE_BUFFER
            | Usage::SHADER_DEVICE_ADDRESS
            | Usage::INDIRECT_BUFFER
            | Usage::TRANSFER_SRC
            | Usage::TRANSFER_DST;
        if device.has(Feature::TransformFeedback) {
            usage |= Usage::TRANSFORM_FEEDBACK_BUFFER_EXT | Usage::TRANSFORM_FEEDBACK_COUNTER_BUFFER_EXT;
        }
        let vulkan = &device.inner.raw;
        let info = vk::BufferCreateInfo::default().size(desc.size.max(LEAST_SIZE)).usage(usage);
        // SAFETY: the device lives and `info` is valid.
        let raw = unsafe { vulkan.create_buffer(&info, None) }.map_err(Error::vulkan("vkCreateBuffer", desc.name))?;
        // From here on, `Drop` takes care of the buffer whatever fails.
        let mut buffer = BufferInner {
            raw,
            name: desc.name.to_owned(),
            kind: desc.kind,
            size: desc.size,
            address: 0,
            required: 0,
            block: None,
            device: Arc::clone(&device.inner),
        };
        // SAFETY: the buffer is of this device.
        let mut requirements = unsafe { vulkan.get_buffer_memory_requirements(raw) };
        requirements.alignment = requirements.alignment.max(ALIGNMENT);
        let block = device.inner.allocate(&MemoryRequest {
            name: desc.name,
            requirements,
            location: match desc.kind {
                BufferKind::Device => Location::Device,
                BufferKind::Upload => Location::Upload,
                BufferKind::Readback => Location::Readback,
            },
            is_linear: true,
        })?;
        let (memory, offset) = (block.memory, block.offset);
        buffer.required = requirements.size;
        buffer.block = Some(block);
        // SAFETY: the block fits the requirements and belongs to nothing else; the buffer has no memory yet.
        unsafe { vulkan.bind_buffer_memory(raw, memory, offset) }
            .map_err(Error::vulkan("vkBindBufferMemory", desc.name))?;
        // SAFETY: the buffer was made for addresses and has memory that was made for them.
        buffer.address =
            unsafe { vulkan.get_buffer_device_address(&vk::BufferDeviceAddressInfo::default().buffer(raw)) };
        device.inner.name_object(raw, desc.name);
        Ok(Self { inner: Arc::new(buffer) })
    }

    /// The name it was made with.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.inner.name
    }

    /// Bytes, as asked for.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.inner.size
    }

    /// Where shaders find byte 0. A multiple of 16.
    #[must_use]
    pub fn address(&self) -> u64 {
        self.inner.address
    }

    /// Writes values at byte `offset` of an [`BufferKind::Upload`] buffer, once the GPU is idle.
    ///
    /// # Errors
    /// [`Error::NotMapped`] for another kind, [`Error::OutOfRange`] past the end.
    pub fn write<T: Pod>(&self, offset: u64, values: &[T]) -> Result<()> {
        if self.inner.kind != BufferKind::Upload {
            return Err(self.not_mapped("upload", "written"));
        }
        let bytes: &[u8] = bytemuck::cast_slice(values);
        self.inner.check(offset, bytes.len() as u64)?;
        let Some(mapped) = self.inner.mapped() else { return Err(self.not_mapped("upload", "written")) };
        let _idle = self.inner.device.idle_queue();
        // SAFETY: the range lies in the buffer, whose block is mapped, coherent and at least as large; the lock keeps
        // the GPU and other threads from touching it, and a caller's slice is never inside it.
        unsafe {
            let target = mapped.as_ptr().add(offset as usize);
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, bytes.len());
        }
        Ok(())
    }

    /// Reads `count` values from byte `offset` of a [`BufferKind::Readback`] buffer, once the GPU is idle.
    ///
    /// # Errors
    /// [`Error::NotMapped`] for another kind, [`Error::OutOfRange`] past the end.
    pub fn read<T: Pod>(&self, offset: u64, count: usize) -> Result<Vec<T>> {
        if self.inner.kind != BufferKind::Readback {
            return Err(self.not_mapped("read-back", "read"));
        }
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        self.inner.check(offset, bytes)?;
        let Some(mapped) = self.inner.mapped() else { return Err(self.not_mapped("read-back", "read")) };
        let mut values = vec![T::zeroed(); count];
        let target: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        let _idle = self.inner.device.idle_queue();
        // SAFETY: the range lies in the buffer, whose block is mapped, coherent and at least as large; the lock keeps
        // the GPU and other threads from writing to it, and `target` is fresh memory of as many bytes.
        unsafe {
            let source = mapped.as_ptr().add(offset as usize);
            std::ptr::copy_nonoverlapping(source, target.as_mut_ptr(), target.len());
        }
        Ok(values)
    }

    fn not_mapped(&self, expected: &'static str, accessed: &'static str) -> Error {
        Error::NotMapped { name: self.inner.name.clone(), expected, accessed }
    }

    /// Panics unless these bytes lie in the buffer: a recorded command would reach past its end.
    pub(crate) fn assert_range(&self, offset: u64, bytes: u64) {
        if let Err(error) = self.inner.check(offset, bytes) {
            panic!("{error}");
        }
    }
}

impl BufferInner {
    fn mapped(&self) -> Option<NonNull<u8>> {
        self.block.as_ref().and_then(|block| block.mapped)
    }

    fn check(&self, offset: u64, bytes: u64) -> Result<()> {
        let end = offset.saturating_add(bytes);
        if end > self.size {
            return Err(Error::OutOfRange { name: self.name.clone(), offset, end, size: self.size });
        }
        Ok(())
    }
}

impl Drop for BufferInner {
    fn drop(&mut self) {
        let (raw, required) = (self.raw, self.required);
        let block = &mut self.block;
        let device = &self.device;
        device.destroy(|vulkan| {
            // SAFETY: the GPU is idle and nobody else has the handle.
            unsafe { vulkan.destroy_buffer(raw, None) };
            if let Some(block) = block.take() {
                device.free(block, required);
            }
        });
    }
}
