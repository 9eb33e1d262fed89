//! Tables to buffers.

use bytemuck::Pod;
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device};
use planish_shaders::DeviceAddress;

use crate::error::Error;

/// Uploads a table. An empty one becomes one element of zeros that nothing reads: Vulkan has no empty buffers.
pub(crate) fn table<T: Pod>(device: &Device, name: &str, values: &[T]) -> Result<Buffer, Error> {
    let buffer = if values.is_empty() { device.upload(name, &[T::zeroed()]) } else { device.upload(name, values) };
    Ok(buffer?)
}

/// A buffer for `count` elements that the GPU writes.
pub(crate) fn array<T>(device: &Device, name: &str, count: u32) -> Result<Buffer, Error> {
    let size = u64::from(count.max(1)) * size_of::<T>() as u64;
    Ok(Buffer::new(device, &BufferDesc { name, kind: BufferKind::Device, size })?)
}

/// A buffer for `count` elements that the CPU writes.
pub(crate) fn mapped<T>(device: &Device, name: &str, count: u32) -> Result<Buffer, Error> {
    let size = u64::from(count.max(1)) * size_of::<T>() as u64;
    Ok(Buffer::new(device, &BufferDesc { name, kind: BufferKind::Upload, size })?)
}

/// A buffer's address as the shaders' type.
pub(crate) fn address<T>(buffer: &Buffer) -> DeviceAddress<T> {
    DeviceAddress::new(buffer.address())
}
