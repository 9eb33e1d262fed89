//! Compute passes.

use crate::barrier::PassKind;
use crate::{Buffer, ComputePipeline, Encoder};
use ash::vk;
use bytemuck::{Pod, Zeroable};

/// What an indirect dispatch reads: groups, not threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DispatchArguments {
    /// Groups in x.
    pub x: u32,
    /// Groups in y.
    pub y: u32,
    /// Groups in z.
    pub z: u32,
}

/// The most groups in one direction that every device takes.
pub const MAX_GROUPS: u32 = 65_535;

/// The groups for a number of threads. Up to [`MAX_GROUPS`] they are in a row; more are in rows of [`MAX_GROUPS`].
/// A shader therefore finds its thread as
/// `(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * local_size + gl_LocalInvocationID.x`
/// and leaves if that is not below the number of threads.
///
/// # Panics
/// If the local size is 0, or the groups are more than [`MAX_GROUPS`] rows.
#[must_use]
pub fn groups_for(threads: u32, local_size: u32) -> DispatchArguments {
    let groups = threads.div_ceil(local_size);
    let (x, y) = if groups <= MAX_GROUPS { (groups, 1) } else { (MAX_GROUPS, groups.div_ceil(MAX_GROUPS)) };
    assert!(y <= MAX_GROUPS, "{threads} threads are too many for groups of {local_size}");
    DispatchArguments { x, y, z: 1 }
}

enum Dispatch<'a> {
    Threads(u32),
    Indirect(&'a Buffer, u64),
}

impl Encoder {
    /// Runs at least `threads` threads; see [`groups_for`] for how a shader finds its number.
    pub fn compute(&mut self, pipeline: &ComputePipeline, push: &impl Pod, threads: u32) {
        self.open(PassKind::Compute);
        self.dispatch(pipeline, bytemuck::bytes_of(push), &Dispatch::Threads(threads));
    }

    /// As [`Encoder::compute`], for a dispatch that is independent of the compute passes right before it:
    /// it runs beside them, without a barrier.
    pub fn compute_more(&mut self, pipeline: &ComputePipeline, push: &impl Pod, threads: u32) {
        self.join(PassKind::Compute);
        self.dispatch(pipeline, bytemuck::bytes_of(push), &Dispatch::Threads(threads));
    }

    /// Runs as many groups as the [`DispatchArguments`] at byte `offset` of a buffer say when it is reached.
    pub fn compute_indirect(&mut self, pipeline: &ComputePipeline, push: &impl Pod, arguments: &Buffer, offset: u64) {
        self.open(PassKind::Compute);
        self.dispatch(pipeline, bytemuck::bytes_of(push), &Dispatch::Indirect(arguments, offset));
    }

    /// As [`Encoder::compute_indirect`], independent of the compute passes right before it.
    pub fn compute_indirect_more(
        &mut self,
        pipeline: &ComputePipeline,
        push: &impl Pod,
        arguments: &Buffer,
        offset: u64,
    ) {
        self.join(PassKind::Compute);
        self.dispatch(pipeline, bytemuck::bytes_of(push), &Dispatch::Indirect(arguments, offset));
    }

    fn dispatch(&mut self, pipeline: &ComputePipeline, push: &[u8], dispatch: &Dispatch<'_>) {
        self.begin_label(pipeline.name());
        self.bind(vk::PipelineBindPoint::COMPUTE, &pipeline.program, push);
        self.calls.dispatches += 1;
        let vulkan = &self.commands.device.raw;
        match *dispatch {
            Dispatch::Threads(threads) => {
                let groups = groups_for(threads, pipeline.local_size);
                // SAFETY: the command buffer is being recorded, outside of rendering; a pipeline is bound.
                unsafe { vulkan.cmd_dispatch(self.commands.raw, groups.x, groups.y, groups.z) };
            }
            Dispatch::Indirect(buffer, offset) => {
                buffer.assert_range(offset, size_of::<DispatchArguments>() as u64);
                // SAFETY: as above, and the arguments lie in the buffer, which is kept alive below.
                unsafe { vulkan.cmd_dispatch_indirect(self.commands.raw, buffer.inner.raw, offset) };
                self.keep(buffer);
            }
        }
        self.end_label();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_rounded_up_to_groups() {
        assert_eq!(groups_for(0, 64), DispatchArguments { x: 0, y: 1, z: 1 });
        assert_eq!(groups_for(64, 64), DispatchArguments { x: 1, y: 1, z: 1 });
        assert_eq!(groups_for(65, 64), DispatchArguments { x: 2, y: 1, z: 1 });
    }

    #[test]
    fn more_groups_than_a_row_holds_go_into_rows() {
        assert_eq!(groups_for(65_535 * 64, 64), DispatchArguments { x: 65_535, y: 1, z: 1 });
        assert_eq!(groups_for(65_535 * 64 + 1, 64), DispatchArguments { x: 65_535, y: 2, z: 1 });
        let most = groups_for(u32::MAX, 2);
        assert!(u64::from(most.x) * u64::from(most.y) * 2 >= u64::from(u32::MAX));
    }
}
