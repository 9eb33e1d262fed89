//! Transform feedback: what the tessellation stages make, written to buffers.

use crate::barrier::PassKind;
use crate::encoder::Commands;
use crate::{Buffer, Draw, Encoder, GraphicsPipeline, RenderTargets};
use ash::vk;

/// Buffers that one transform feedback can write at once.
pub const MAX_FEEDBACK_BUFFERS: usize = 2;

/// Where captured vertices go.
#[derive(Clone, Copy)]
pub struct Feedback<'a> {
    /// Names the count in the report.
    pub name: &'a str,
    /// Whole buffers by `xfb_buffer`, at most [`MAX_FEEDBACK_BUFFERS`].
    pub targets: &'a [&'a Buffer],
    /// Afterwards holds a `u32` for each target: the bytes written to it.
    pub counters: &'a Buffer,
}

/// One list of things to draw with one pipeline, which discards rasterization and has no targets.
#[derive(Clone, Copy)]
pub struct FeedbackList<'a> {
    /// Its last stage before rasterization says what is captured.
    pub pipeline: &'a GraphicsPipeline,
    /// Push constants, as bytes (`bytemuck::bytes_of`).
    pub push: &'a [u8],
    /// How much to draw.
    pub draw: Draw<'a>,
}

impl Encoder {
    /// Draws lists, one after the other, and appends all captured primitives in order to the same buffers.
    /// What does not fit is dropped, and told by [`crate::FeedbackCount`] in the report.
    ///
    /// # Panics
    /// On a device without [`crate::Feature::TransformFeedback`], with no target or more than the device takes
    /// ([`crate::Limits::max_feedback_buffers`]), with an empty target, or with too few counters.
    pub fn transform_feedback(&mut self, feedback: &Feedback<'_>, lists: &[FeedbackList<'_>]) {
        let targets = feedback.targets;
        let device = &self.commands.device;
        assert!(device.feedback.is_some(), "{}: this device has no transformFeedback", feedback.name);
        let most = MAX_FEEDBACK_BUFFERS.min(device.limits.max_feedback_buffers as usize);
        assert!((1..=most).contains(&targets.len()), "{}: 1 to {most} targets", feedback.name);
        assert!(targets.iter().all(|target| target.size() > 0), "{}: a target is empty", feedback.name);
        feedback.counters.assert_range(0, (targets.len() * size_of::<u32>()) as u64);
        // A list resumes at the counters, so the first starts at zeros. They also stay if there are no lists.
        self.fill_buffer(feedback.counters, 0, (targets.len() * size_of::<u32>()) as u64, 0);
        self.begin_label(feedback.name);
        self.open(PassKind::TransformFeedback);
        self.toggle_feedback_query(Some(feedback.name));
        for (index, list) in lists.iter().enumerate() {
            if index > 0 {
                self.open(PassKind::TransformFeedback);
            }
            self.record_begin_rendering(&RenderTargets { colors: &[], depth: None, extent: [1, 1] });
            self.bind_graphics(list.pipeline, list.push);
            self.begin_capture(feedback);
            self.record_draw(list.draw);
            self.end_capture(feedback);
            self.end_rendering();
        }
        self.toggle_feedback_query(None);
        self.end_label();
        for buffer in targets {
            self.keep(buffer);
        }
    }

    fn begin_capture(&mut self, feedback: &Feedback<'_>) {
        let count = feedback.targets.len() as u32;
        let buffers: Vec<_> = feedback.targets.iter().map(|buffer| buffer.inner.raw).collect();
        let sizes: Vec<_> = feedback.targets.iter().map(|buffer| buffer.size()).collect();
        let (counters, offsets) = counters(feedback);
        let starts = [0; MAX_FEEDBACK_BUFFERS];
        let Commands { raw, device, .. } = &self.commands;
        let Some(extension) = &device.feedback else { return };
        let calls = extension.fp();
        // SAFETY: the command buffer is being recorded, inside of rendering, with a pipeline bound and no capture
        // open; every array has at least `count` elements; the buffers are kept alive by the caller.
        unsafe {
            (calls.cmd_bind_transform_feedback_buffers_ext)(
                *raw,
                0,
                count,
                buffers.as_ptr(),
                starts.as_ptr(),
                sizes.as_ptr(),
            );
            (calls.cmd_begin_transform_feedback_ext)(*raw, 0, count, counters.as_ptr(), offsets.as_ptr());
        }
    }

    fn end_capture(&mut self, feedback: &Feedback<'_>) {
        let (counters, offsets) = counters(feedback);
        let count = counters.len() as u32;
        let Commands { raw, device, .. } = &self.commands;
        if let Some(extension) = &device.feedback {
            // SAFETY: `begin_capture` came before, in the same rendering, with the same counters.
            unsafe {
                (extension.fp().cmd_end_transform_feedback_ext)(*raw, 0, count, counters.as_ptr(), offsets.as_ptr());
            }
        }
    }

    /// Begins to count with a name, ends without.
    fn toggle_feedback_query(&mut self, begin: Option<&str>) {
        let Some(pool) = &mut self.queries.feedback else { return };
        let Commands { raw, device, .. } = &self.commands;
        match begin {
            Some(name) => {
                let query = pool.next(name);
                // SAFETY: the command buffer is being recorded; the query was reset and is used once.
                unsafe { device.raw.cmd_begin_query(*raw, pool.raw, query, vk::QueryControlFlags::empty()) };
            }
            None => {
                let query = pool.last();
                // SAFETY: the query was begun in this command buffer.
                unsafe { device.raw.cmd_end_query(*raw, pool.raw, query) };
            }
        }
    }
}

/// A counter for each target, and where in its buffer it is.
fn counters(feedback: &Feedback<'_>) -> (Vec<vk::Buffer>, Vec<u64>) {
    let count = feedback.targets.len();
    let offsets = (0..count).map(|index| (index * size_of::<u32>()) as u64);
    (vec![feedback.counters.inner.raw; count], offsets.collect())
}
