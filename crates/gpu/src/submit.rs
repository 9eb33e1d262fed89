//! Runs what was recorded.

use crate::device::Health;
use crate::encoder::Commands;
use crate::{Buffer, BufferDesc, BufferKind, Device, Encoder, Error, FeedbackCount, PipelineStatistics, Recorded};
use crate::{Result, Transfer};
use ash::vk;
use bytemuck::Pod;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a submission may take: a frame of a software driver can take minutes.
const TIMEOUT: Duration = Duration::from_secs(600);

/// Bytes that are staged at once by [`Device::upload`].
const UPLOAD_CHUNK: u64 = 16 << 20;

/// What one submission measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SubmitReport {
    /// From the submission until the CPU knew of its end.
    pub wall: Duration,
    /// Milliseconds of GPU time since the first timestamp, in order of recording.
    pub timestamps: Vec<(String, f64)>,
    /// Counts of shader work, in order of recording.
    pub statistics: Vec<(String, PipelineStatistics)>,
    /// Counts of captured primitives, in order of recording.
    pub feedback: Vec<(String, FeedbackCount)>,
}

impl Device {
    /// Runs what was recorded and waits for its end. Can be called again with the same recording.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::Timeout`] after ten minutes and other failures of the driver.
    ///
    /// # Panics
    /// If the recording is of another device.
    pub fn submit_and_wait(&self, recorded: &Recorded) -> Result<SubmitReport> {
        let Commands { raw, device, name, .. } = &recorded.commands;
        assert!(Arc::ptr_eq(device, &self.inner), "{name}: recorded for another device");
        let mut queue = device.idle_queue();
        if queue.health != Health::Good {
            return Err(Error::DeviceLost);
        }
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(*raw)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        let fences = [recorded.fence];
        let start = Instant::now();
        // SAFETY: the queue's lock is held; the command buffer was recorded and is not running, nor is its fence
        // awaited, as every submission is waited for under that lock.
        let waited = unsafe {
            let vulkan = &device.raw;
            vulkan
                .reset_fences(&fences)
                .map_err(Error::vulkan("vkResetFences", name))
                .and_then(|()| {
                    vulkan
                        .queue_submit2(queue.raw, &submit, recorded.fence)
                        .map_err(Error::vulkan("vkQueueSubmit2", name))
                })
                .and_then(|()| {
                    vulkan.wait_for_fences(&fences, true, TIMEOUT.as_nanos() as u64).map_err(|result| match result {
                        vk::Result::TIMEOUT => Error::Timeout { seconds: TIMEOUT.as_secs() },
                        result => Error::vulkan("vkWaitForFences", name)(result),
                    })
                })
        };
        let wall = start.elapsed();
        if let Err(error) = waited {
            match error {
                Error::DeviceLost => queue.health = Health::Lost,
                Error::Timeout { .. } => queue.health = Health::Hung,
                _ => {}
            }
            return Err(error);
        }
        let queries = &recorded.queries;
        Ok(SubmitReport {
            wall,
            timestamps: queries.read_timestamps()?,
            statistics: queries.read_statistics()?,
            feedback: queries.read_feedback()?,
        })
    }

    /// Makes a [`BufferKind::Device`] buffer that holds these values.
    ///
    /// # Errors
    /// As [`Buffer::new`] and [`Device::submit_and_wait`].
    pub fn upload<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let size = bytes.len() as u64;
        let buffer = Buffer::new(self, &BufferDesc { name, kind: BufferKind::Device, size })?;
        let staging_size = size.min(UPLOAD_CHUNK);
        let staging = Buffer::new(self, &BufferDesc { name, kind: BufferKind::Upload, size: staging_size })?;
        let mut to_offset = 0;
        for chunk in bytes.chunks(UPLOAD_CHUNK as usize) {
            staging.write(0, chunk)?;
            let size = chunk.len() as u64;
            let mut encoder = Encoder::new(self, name)?;
            encoder.transfer(&[Transfer::Copy { from: &staging, from_offset: 0, to: &buffer, to_offset, size }]);
            self.submit_and_wait(&encoder.finish()?)?;
            to_offset += size;
        }
        Ok(buffer)
    }

    /// Copies `count` values from byte `offset` of any buffer to the CPU: for tests and dumps, as it waits.
    ///
    /// # Errors
    /// As [`Buffer::new`] and [`Device::submit_and_wait`].
    ///
    /// # Panics
    /// If they are not in the buffer.
    pub fn download<T: Pod>(&self, buffer: &Buffer, offset: u64, count: usize) -> Result<Vec<T>> {
        let size = (count * size_of::<T>()) as u64;
        let staging = Buffer::new(self, &BufferDesc { name: buffer.name(), kind: BufferKind::Readback, size })?;
        let mut encoder = Encoder::new(self, buffer.name())?;
        encoder.transfer(&[Transfer::Copy { from: buffer, from_offset: offset, to: &staging, to_offset: 0, size }]);
        self.submit_and_wait(&encoder.finish()?)?;
        staging.read(0, count)
    }
}
