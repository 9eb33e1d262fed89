//! Where memory comes from: a small trait, and gpu-allocator behind it.

use crate::{Error, Result};
use ash::vk;
use gpu_allocator::vulkan as gpu;
use gpu_allocator::{AllocationSizes, MemoryLocation};
use std::any::Any;
use std::ptr::NonNull;

/// Bytes of the first block of a memory type; later ones double, up to [`MAX_BLOCK`].
/// 16 MiB hold every table of a small scene, and an idle device costs no more than that.
const FIRST_BLOCK: u64 = 16 << 20;
/// Larger objects than this get memory of their own.
const MAX_BLOCK: u64 = 128 << 20;

/// Who reads and writes a piece of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Location {
    /// Only the GPU.
    Device,
    /// The CPU writes, the GPU reads.
    Upload,
    /// The GPU writes, the CPU reads.
    Readback,
}

/// What an object needs.
pub(crate) struct MemoryRequest<'a> {
    pub(crate) name: &'a str,
    pub(crate) requirements: vk::MemoryRequirements,
    pub(crate) location: Location,
    /// A buffer, not an image.
    pub(crate) is_linear: bool,
}

/// A piece of memory.
pub(crate) struct MemoryBlock {
    pub(crate) memory: vk::DeviceMemory,
    pub(crate) offset: u64,
    /// The first byte of the piece, if the CPU can see it without flushes.
    pub(crate) mapped: Option<NonNull<u8>>,
    /// What the giver needs to take it back.
    pub(crate) token: Box<dyn Any + Send + Sync>,
}

// SAFETY: the pointer is into memory that stays mapped as long as the block lives; whoever follows it takes the
// device's queue lock first.
unsafe impl Send for MemoryBlock {}
// SAFETY: as above.
unsafe impl Sync for MemoryBlock {}

/// Gives memory to buffers and images.
///
/// # Safety
/// A block is as large and aligned as was asked, of a memory type that was allowed, with device addresses enabled,
/// overlaps no other block, and stays valid until it is given back; `mapped`, if any, points to its first
/// byte, the memory is host-coherent, and all of the block is mapped until it is given back.
pub(crate) unsafe trait Memory: Send {
    /// A block for one object.
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<MemoryBlock, String>;
    /// Takes a block back. Nothing uses it any more.
    fn free(&mut self, block: MemoryBlock);
}

/// Memory by gpu-allocator.
pub(crate) struct PooledMemory(gpu::Allocator);

impl PooledMemory {
    pub(crate) fn new(instance: &ash::Instance, device: &ash::Device, physical: vk::PhysicalDevice) -> Result<Self> {
        let allocator = gpu::Allocator::new(&gpu::AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: true,
            allocation_sizes: AllocationSizes::new(FIRST_BLOCK, FIRST_BLOCK)
                .with_max_device_memblock_size(MAX_BLOCK)
                .with_max_host_memblock_size(MAX_BLOCK),
        });
        let no_memory = |reason: String| Error::NoMemory { name: "the allocator".to_owned(), asked: 0, reason };
        Ok(Self(allocator.map_err(|error| no_memory(error.to_string()))?))
    }
}

// SAFETY: gpu-allocator keeps these promises; its host-visible memory is always coherent and mapped, which is checked.
unsafe impl Memory for PooledMemory {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<MemoryBlock, String> {
        let allocation = self
            .0
            .allocate(&gpu::AllocationCreateDesc {
                name: request.name,
                requirements: request.requirements,
                location: match request.location {
                    Location::Device => MemoryLocation::GpuOnly,
                    Location::Upload => MemoryLocation::CpuToGpu,
                    Location::Readback => MemoryLocation::GpuToCpu,
                },
                linear: request.is_linear,
                allocation_scheme: gpu::AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|error| error.to_string())?;
        let is_coherent = allocation.memory_properties().contains(vk::MemoryPropertyFlags::HOST_COHERENT);
        Ok(MemoryBlock {
            // SAFETY: the block holds the allocation, so nobody frees the memory object before the block goes.
            memory: unsafe { allocation.memory() },
            offset: allocation.offset(),
            mapped: allocation.mapped_ptr().filter(|_| is_coherent).map(NonNull::cast),
            token: Box::new(allocation),
        })
    }

    fn free(&mut self, block: MemoryBlock) {
        if let Ok(allocation) = block.token.downcast::<gpu::Allocation>() {
            // It fails only for an allocation of another allocator, which nobody can hand in.
            let _ = self.0.free(*allocation);
        }
    }
}

/// The limit that this crate keeps on its own, since drivers promise more than there is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Budget {
    pub(crate) limit: u64,
    pub(crate) used: u64,
}

impl Budget {
    /// Three quarters of the largest heap: the rest is for the driver, the display and other programs.
    pub(crate) fn of_heap(largest_heap: u64) -> Self {
        Self { limit: largest_heap / 4 * 3, used: 0 }
    }

    /// Counts `bytes` in, or says that they are too many.
    pub(crate) fn take(&mut self, name: &str, bytes: u64) -> Result<()> {
        match self.used.checked_add(bytes) {
            Some(used) if used <= self.limit => {
                self.used = used;
                Ok(())
            }
            _ => Err(Error::OutOfBudget { name: name.to_owned(), asked: bytes, used: self.used, budget: self.limit }),
        }
    }

    pub(crate) fn give_back(&mut self, bytes: u64) {
        self.used -= bytes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_budget_is_three_quarters_of_the_largest_heap() {
        assert_eq!(Budget::of_heap(2 << 30).limit, 3 << 29);
    }

    #[test]
    fn a_budget_can_be_filled_but_not_exceeded_and_refills() {
        let mut budget = Budget { limit: 100, used: 0 };
        budget.take("a", 60).unwrap();
        let error = budget.take("b", 41).unwrap_err();
        assert!(matches!(error, Error::OutOfBudget { asked: 41, used: 60, budget: 100, .. }), "{error}");
        budget.take("b", 40).unwrap();
        budget.give_back(60);
        budget.take("c", 60).unwrap();
        assert_eq!(budget.used, 100);
    }

    #[test]
    fn a_sum_that_overflows_is_over_budget() {
        let mut budget = Budget { limit: u64::MAX, used: 1 };
        assert!(budget.take("huge", u64::MAX).is_err());
    }
}
