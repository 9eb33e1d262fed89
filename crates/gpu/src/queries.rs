//! Timestamps, pipeline statistics and transform feedback counts, named and in order.

use crate::device::DeviceInner;
use crate::{Error, Feature, Result};
use ash::vk;
use std::sync::Arc;

/// Timestamps that one encoder can take.
pub const MAX_TIMESTAMPS: u32 = 256;
/// Statistics, and as many transform feedback counts, that one encoder can take.
pub const MAX_STATISTICS: u32 = 64;

/// What the GPU counted between [`crate::Encoder::begin_statistics`] and its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PipelineStatistics {
    /// Vertex shader runs.
    pub vertex_invocations: u64,
    /// Triangles that reached clipping: what the tessellator and the rest made.
    pub clipping_invocations: u64,
    /// Triangles that left clipping.
    pub clipping_primitives: u64,
    /// Fragment shader runs.
    pub fragment_invocations: u64,
    /// Patches that the tessellation-control shader worked on.
    pub tessellation_control_patches: u64,
    /// Tessellation-evaluation shader runs.
    pub tessellation_evaluation_invocations: u64,
    /// Compute shader runs.
    pub compute_invocations: u64,
}

/// How many primitives one transform feedback wrote, and how many it would have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FeedbackCount {
    /// Primitives that fitted.
    pub written: u64,
    /// Primitives there were. More than were written: the buffers are too small.
    pub needed: u64,
}

/// The counters of [`PipelineStatistics`]; the GPU writes them in the order of their bits.
fn statistics_flags() -> vk::QueryPipelineStatisticFlags {
    use vk::QueryPipelineStatisticFlags as Flags;
    Flags::VERTEX_SHADER_INVOCATIONS
        | Flags::CLIPPING_INVOCATIONS
        | Flags::CLIPPING_PRIMITIVES
        | Flags::FRAGMENT_SHADER_INVOCATIONS
        | Flags::TESSELLATION_CONTROL_SHADER_PATCHES
        | Flags::TESSELLATION_EVALUATION_SHADER_INVOCATIONS
        | Flags::COMPUTE_SHADER_INVOCATIONS
}

/// The query pools of one command buffer; a pool is missing where the device cannot count so.
pub(crate) struct Queries {
    pub(crate) timestamps: Option<QueryPool>,
    pub(crate) statistics: Option<QueryPool>,
    pub(crate) feedback: Option<QueryPool>,
}

impl Queries {
    pub(crate) fn new(device: &Arc<DeviceInner>) -> Result<Self> {
        let pool = |wanted: bool, kind, capacity, statistics| {
            wanted.then(|| QueryPool::new(device, kind, capacity, statistics)).transpose()
        };
        let none = vk::QueryPipelineStatisticFlags::empty();
        let has = |feature| device.facts.features.contains(&feature);
        Ok(Self {
            timestamps: pool(device.limits.timestamp_bits > 0, vk::QueryType::TIMESTAMP, MAX_TIMESTAMPS, none)?,
            statistics: pool(
                has(Feature::PipelineStatisticsQuery),
                vk::QueryType::PIPELINE_STATISTICS,
                MAX_STATISTICS,
                statistics_flags(),
            )?,
            feedback: pool(
                has(Feature::TransformFeedback),
                vk::QueryType::TRANSFORM_FEEDBACK_STREAM_EXT,
                MAX_STATISTICS,
                none,
            )?,
        })
    }

    pub(crate) fn pools(&self) -> impl Iterator<Item = &QueryPool> {
        [&self.timestamps, &self.statistics, &self.feedback].into_iter().flatten()
    }

    /// Milliseconds since the first timestamp.
    pub(crate) fn read_timestamps(&self) -> Result<Vec<(String, f64)>> {
        let Some(pool) = &self.timestamps else { return Ok(Vec::new()) };
        let limits = &pool.device.limits;
        let ticks = pool.read::<1>()?;
        let first = ticks.first().map_or(0, |(_, [ticks])| *ticks);
        let named = ticks.into_iter().map(|(name, [ticks])| {
            let elapsed = elapsed_ticks(first, ticks, limits.timestamp_bits);
            (name, elapsed as f64 * f64::from(limits.timestamp_period) * 1e-6)
        });
        Ok(named.collect())
    }

    pub(crate) fn read_statistics(&self) -> Result<Vec<(String, PipelineStatistics)>> {
        let Some(pool) = &self.statistics else { return Ok(Vec::new()) };
        let named = pool.read::<7>()?.into_iter().map(|(name, counts)| {
            let [vertex, clip_in, clip_out, fragment, patches, evaluation, compute] = counts;
            let statistics = PipelineStatistics {
                vertex_invocations: vertex,
                clipping_invocations: clip_in,
                clipping_primitives: clip_out,
                fragment_invocations: fragment,
                tessellation_control_patches: patches,
                tessellation_evaluation_invocations: evaluation,
                compute_invocations: compute,
            };
            (name, statistics)
        });
        Ok(named.collect())
    }

    pub(crate) fn read_feedback(&self) -> Result<Vec<(String, FeedbackCount)>> {
        let Some(pool) = &self.feedback else { return Ok(Vec::new()) };
        let counts = pool.read::<2>()?;
        Ok(counts.into_iter().map(|(name, [written, needed])| (name, FeedbackCount { written, needed })).collect())
    }
}

/// Ticks from `first` to `later` of a counter that has `bits` bits and may have run over once.
fn elapsed_ticks(first: u64, later: u64, bits: u32) -> u64 {
    let mask = u64::MAX >> (64 - bits.clamp(1, 64));
    later.wrapping_sub(first) & mask
}

/// Queries of one type, handed out in order.
pub(crate) struct QueryPool {
    pub(crate) raw: vk::QueryPool,
    pub(crate) capacity: u32,
    names: Vec<String>,
    device: Arc<DeviceInner>,
}

impl QueryPool {
    fn new(
        device: &Arc<DeviceInner>,
        kind: vk::QueryType,
        capacity: u32,
        statistics: vk::QueryPipelineStatisticFlags,
    ) -> Result<Self> {
        let info =
            vk::QueryPoolCreateInfo::default().query_type(kind).query_count(capacity).pipeline_statistics(statistics);
        // SAFETY: the device lives and has the feature for this type.
        let raw = unsafe { device.raw.create_query_pool(&info, None) }
            .map_err(Error::vulkan("vkCreateQueryPool", "an encoder"))?;
        Ok(Self { raw, capacity, names: Vec::new(), device: Arc::clone(device) })
    }

    /// The next query's number.
    pub(crate) fn next(&mut self, name: &str) -> u32 {
        let index = self.names.len() as u32;
        assert!(index < self.capacity, "{name}: one encoder takes at most {} such queries", self.capacity);
        self.names.push(name.to_owned());
        index
    }

    /// The number handed out last.
    pub(crate) fn last(&self) -> u32 {
        self.names.len() as u32 - 1
    }

    /// The values of all queries handed out, after the GPU has written them.
    fn read<const VALUES: usize>(&self) -> Result<Vec<(String, [u64; VALUES])>> {
        let mut values = vec![[0; VALUES]; self.names.len()];
        if !values.is_empty() {
            let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            // SAFETY: these queries were reset, begun and ended by a submission that has completed, and each has
            // `VALUES` values of 64 bits.
            unsafe { self.device.raw.get_query_pool_results(self.raw, 0, &mut values, flags) }
                .map_err(Error::vulkan("vkGetQueryPoolResults", "an encoder"))?;
        }
        Ok(self.names.iter().cloned().zip(values).collect())
    }
}

impl Drop for QueryPool {
    fn drop(&mut self) {
        let raw = self.raw;
        // SAFETY: the GPU is idle and nobody else has the handle.
        self.device.destroy(|vulkan| unsafe { vulkan.destroy_query_pool(raw, None) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timestamp_counter_may_run_over_once() {
        assert_eq!(elapsed_ticks(10, 25, 64), 15);
        assert_eq!(elapsed_ticks(u64::MAX, 1, 64), 2);
        assert_eq!(elapsed_ticks((1 << 36) - 1, 1, 36), 2);
    }

    #[test]
    fn seven_statistics_are_asked_for() {
        assert_eq!(statistics_flags().as_raw().count_ones(), 7);
    }
}
