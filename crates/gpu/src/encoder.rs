//! Records passes into a command buffer.

use crate::barrier::{PassKind, PassOrder};
use crate::device::DeviceInner;
use crate::graphics_pipeline::TargetFormats;
use crate::image::whole;
use crate::program::Program;
use crate::queries::Queries;
use crate::{Buffer, Device, Error, Image, Result};
use ash::vk;
use std::any::Any;
use std::sync::Arc;

/// Records passes, in order, and puts the barriers between them.
///
/// Every pass may depend on every pass before it; the exceptions say so. A recording starts after all
/// submissions before it have completed.
///
/// Methods panic if they are called out of order (a copy between [`Encoder::begin_rendering`] and
/// [`Encoder::end_rendering`], say), with push constants of another size than the program's, or with a range past
/// the end of a buffer: those are mistakes in the calling program and would crash the driver. Objects of another
/// device than the encoder's are such a mistake too, and are not noticed.
pub struct Encoder {
    pub(crate) commands: Commands,
    pub(crate) order: PassOrder,
    /// The formats of the targets, while rendering.
    pub(crate) rendering: Option<TargetFormats>,
    pub(crate) queries: Queries,
    pub(crate) statistics_open: Option<u32>,
    pub(crate) calls: Calls,
    kept: Vec<Kept>,
}

/// How many commands of each kind a recording has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Calls {
    /// Dispatches, direct and indirect.
    pub dispatches: u32,
    /// Draws, direct and indirect: an indirect one counts once, however many it draws.
    pub draws: u32,
}

type Kept = Arc<dyn Any + Send + Sync>;

/// Recorded passes, ready for [`Device::submit_and_wait`], any number of times.
pub struct Recorded {
    pub(crate) commands: Commands,
    pub(crate) queries: Queries,
    pub(crate) fence: vk::Fence,
    calls: Calls,
    /// What the commands use.
    _kept: Vec<Kept>,
}

/// A command buffer with a pool of its own.
pub(crate) struct Commands {
    pub(crate) raw: vk::CommandBuffer,
    pool: vk::CommandPool,
    pub(crate) name: String,
    pub(crate) device: Arc<DeviceInner>,
}

impl Commands {
    fn new(device: &Arc<DeviceInner>, name: &str) -> Result<Self> {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(device.queue_family);
        // SAFETY: the device lives and has a queue of this family.
        let pool = unsafe { device.raw.create_command_pool(&info, None) }
            .map_err(Error::vulkan("vkCreateCommandPool", name))?;
        // From here on, `Drop` takes care of the pool whatever fails.
        let mut commands =
            Self { raw: vk::CommandBuffer::null(), pool, name: name.to_owned(), device: Arc::clone(device) };
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        // SAFETY: the pool is of this device and used by nobody else.
        let buffers = unsafe { device.raw.allocate_command_buffers(&info) }
            .map_err(Error::vulkan("vkAllocateCommandBuffers", name))?;
        commands.raw = buffers[0];
        device.name_object(commands.raw, name);
        Ok(commands)
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        let pool = self.pool;
        // SAFETY: the GPU is idle and nobody else has the pool.
        self.device.destroy(|vulkan| unsafe { vulkan.destroy_command_pool(pool, None) });
    }
}

impl Recorded {
    /// How many commands were recorded.
    #[must_use]
    pub fn calls(&self) -> Calls {
        self.calls
    }
}

impl Drop for Recorded {
    fn drop(&mut self) {
        let fence = self.fence;
        // SAFETY: the GPU is idle and nobody else has the fence.
        self.commands.device.destroy(|vulkan| unsafe { vulkan.destroy_fence(fence, None) });
    }
}

impl Encoder {
    /// Starts recording.
    ///
    /// # Errors
    /// Failures of the driver.
    pub fn new(device: &Device, name: &str) -> Result<Self> {
        let commands = Commands::new(&device.inner, name)?;
        let queries = Queries::new(&device.inner)?;
        let vulkan = &device.inner.raw;
        // SAFETY: the command buffer is fresh.
        unsafe { vulkan.begin_command_buffer(commands.raw, &vk::CommandBufferBeginInfo::default()) }
            .map_err(Error::vulkan("vkBeginCommandBuffer", name))?;
        for pool in queries.pools() {
            // SAFETY: the command buffer is being recorded; the pool is of this device.
            unsafe { vulkan.cmd_reset_query_pool(commands.raw, pool.raw, 0, pool.capacity) };
        }
        Ok(Self {
            commands,
            order: PassOrder::default(),
            rendering: None,
            queries,
            statistics_open: None,
            calls: Calls::default(),
            kept: Vec::new(),
        })
    }

    /// Ends the recording; everything the GPU wrote can be read by the CPU after a submission.
    ///
    /// # Errors
    /// Failures of the driver.
    ///
    /// # Panics
    /// While rendering or while statistics are open.
    pub fn finish(mut self) -> Result<Recorded> {
        assert!(self.statistics_open.is_none(), "{}: statistics were not ended", self.commands.name);
        self.open(PassKind::Host);
        let device = &self.commands.device;
        // SAFETY: the command buffer is being recorded.
        unsafe { device.raw.end_command_buffer(self.commands.raw) }
            .map_err(Error::vulkan("vkEndCommandBuffer", &self.commands.name))?;
        // SAFETY: the device lives.
        let fence = unsafe { device.raw.create_fence(&vk::FenceCreateInfo::default(), None) }
            .map_err(Error::vulkan("vkCreateFence", &self.commands.name))?;
        let Self { commands, queries, calls, kept, .. } = self;
        Ok(Recorded { commands, queries, fence, calls, _kept: kept })
    }

    /// Keeps a buffer alive as long as the recording. Buffers given to a command are kept anyway; those that shaders
    /// reach only through an address are not, and must be kept by this or by their owner.
    pub fn keep(&mut self, buffer: &Buffer) {
        self.kept.push(buffer.inner.clone());
    }

    /// Opens a named group of passes, for debuggers.
    pub fn begin_label(&mut self, name: &str) {
        self.commands.device.begin_label(self.commands.raw, name);
    }

    /// Ends the group opened last.
    pub fn end_label(&mut self) {
        self.commands.device.end_label(self.commands.raw);
    }

    /// Takes the time when everything before has completed. On a device without timestamps, does nothing.
    pub fn timestamp(&mut self, name: &str) {
        if let Some(pool) = &mut self.queries.timestamps {
            let query = pool.next(name);
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            let Commands { raw, device, .. } = &self.commands;
            // SAFETY: the command buffer is being recorded; the query was reset and is used once.
            unsafe { device.raw.cmd_write_timestamp2(*raw, stage, pool.raw, query) };
        }
    }

    /// Starts counting what shaders do, until [`Encoder::end_statistics`]. Both stand inside the same rendering, or
    /// both outside. On a device without [`crate::Feature::PipelineStatisticsQuery`], does nothing.
    ///
    /// # Panics
    /// If statistics are open already.
    pub fn begin_statistics(&mut self, name: &str) {
        assert!(self.statistics_open.is_none(), "{name}: statistics are open already");
        if let Some(pool) = &mut self.queries.statistics {
            let query = pool.next(name);
            self.statistics_open = Some(query);
            let Commands { raw, device, .. } = &self.commands;
            // SAFETY: the command buffer is being recorded; the query was reset and is used once.
            unsafe { device.raw.cmd_begin_query(*raw, pool.raw, query, vk::QueryControlFlags::empty()) };
        }
    }

    /// Ends what [`Encoder::begin_statistics`] started.
    pub fn end_statistics(&mut self) {
        if let (Some(pool), Some(query)) = (&self.queries.statistics, self.statistics_open.take()) {
            let Commands { raw, device, .. } = &self.commands;
            // SAFETY: the query was begun in this command buffer.
            unsafe { device.raw.cmd_end_query(*raw, pool.raw, query) };
        }
    }

    /// Opens a pass that may depend on everything before it.
    pub(crate) fn open(&mut self, kind: PassKind) {
        let barrier = self.order.open(kind);
        self.record_barrier(barrier);
    }

    /// Opens a pass that does not depend on the one before if that is of the same kind.
    pub(crate) fn join(&mut self, kind: PassKind) {
        let barrier = self.order.join(kind);
        self.record_barrier(barrier);
    }

    fn record_barrier(&mut self, barrier: Option<crate::barrier::Barrier>) {
        assert!(self.rendering.is_none(), "{}: a pass was recorded while rendering", self.commands.name);
        let Some(barrier) = barrier else { return };
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(barrier.from_stages)
            .src_access_mask(barrier.from_access)
            .dst_stage_mask(barrier.to_stages)
            .dst_access_mask(barrier.to_access)];
        let Commands { raw, device, .. } = &self.commands;
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: the command buffer is being recorded, outside of rendering; the masks name no stage of a feature
        // that is not enabled, as passes of that kind cannot be recorded without it.
        unsafe { device.raw.cmd_pipeline_barrier2(*raw, &info) };
    }

    /// Brings a fresh image into the layout that it keeps.
    pub(crate) fn prepare_image(&mut self, image: &Image) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(vk::ImageLayout::UNDEFINED)
            .new_layout(vk::ImageLayout::GENERAL)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image.inner.raw)
            .subresource_range(whole(image.format()))];
        self.keep_object(image.inner.clone());
        let Commands { raw, device, .. } = &self.commands;
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: the command buffer is being recorded, outside of rendering; the image is of this device.
        unsafe { device.raw.cmd_pipeline_barrier2(*raw, &info) };
    }

    pub(crate) fn keep_object(&mut self, object: Kept) {
        self.kept.push(object);
    }

    /// Binds a pipeline and its push constants.
    pub(crate) fn bind(&mut self, point: vk::PipelineBindPoint, program: &Arc<Program>, push: &[u8]) {
        assert_eq!(push.len(), program.push_size as usize, "{}: bytes of push constants", program.name);
        let Commands { raw, device, .. } = &self.commands;
        // SAFETY: the command buffer is being recorded; the pipeline is of this kind and kept alive below; the push
        // constants are those of its layout.
        unsafe {
            device.raw.cmd_bind_pipeline(*raw, point, program.pipeline);
            if !push.is_empty() {
                device.raw.cmd_push_constants(*raw, program.layout, program.push_stages, 0, push);
            }
        }
        self.kept.push(program.clone());
    }
}
