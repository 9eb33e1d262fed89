//! A small Vulkan 1.3 backend on ash. It knows nothing of surfaces.
//!
//! It stays small by refusing: one queue; dynamic rendering; synchronization2; no descriptors, vertex inputs or
//! render passes; buffers are reached through their addresses, which travel in push constants; images are in the
//! layout `GENERAL` all their life.
//!
//! # Life of objects
//! [`Buffer`], [`Image`] and pipelines are handles to shared objects. An object is destroyed with its last handle,
//! after waiting for the GPU, and every object keeps its device alive: there is nothing to free by hand and no order
//! to keep. A recording keeps what its commands name. What shaders reach only through an address is the caller's to
//! keep ([`Encoder::keep`]).
//!
//! # Order of work
//! [`Device::submit_and_wait`] holds the queue's lock until the GPU is done, and so do mapped reads and writes and
//! the destruction of objects: the CPU never sees, and never pulls away, what the GPU is using.
//! Within a recording, every pass opens with one barrier against the passes that it has not waited for yet.
//!
//! # What is not checked
//! Nothing here is `unsafe` to call, yet shaders are as powerful as machine code: SPIR-V must be valid, and the
//! addresses given to it must be right. A wild address is a lost device on hardware and a segmentation fault of this
//! process on a software driver. The synchronization checks of the validation layer see copies, attachments and
//! indirect arguments, but no access through an address and no transform feedback: the table in `barrier` answers
//! for those.

#![expect(unsafe_code, reason = "this crate is where Vulkan is called")]

mod barrier;
mod buffer;
mod compute;
mod compute_pipeline;
mod device;
mod draw;
mod encoder;
mod error;
mod facts;
mod features;
mod feedback;
mod format;
mod graphics_pipeline;
mod image;
mod instance;
mod memory;
mod messages;
mod probe;
mod program;
mod queries;
mod submit;
mod transfer;

pub use buffer::{Buffer, BufferDesc, BufferKind};
pub use compute::{DispatchArguments, MAX_GROUPS, groups_for};
pub use compute_pipeline::{ComputePipeline, ComputePipelineDesc};
pub use device::{Device, DeviceOptions};
pub use draw::{Clear, ColorTarget, DepthTarget, Draw, DrawArguments, RenderTargets};
pub use encoder::{Calls, Encoder, Recorded};
pub use error::{Error, Result};
pub use facts::{ApiVersion, DeviceFacts, DeviceKind, DeviceReport, NEEDED_VERSION, select_device};
pub use features::Feature;
pub use feedback::{Feedback, FeedbackList, MAX_FEEDBACK_BUFFERS};
pub use format::Format;
pub use graphics_pipeline::{
    DepthBias, DepthTest, GraphicsPipeline, GraphicsPipelineDesc, PolygonMode, Stage, StageDesc, Topology,
};
pub use image::{Image, ImageDesc};
pub use instance::Instance;
pub use probe::{HIDE_FEATURE_VARIABLE, Limits};
pub use program::SpecConstant;
pub use queries::{FeedbackCount, MAX_STATISTICS, MAX_TIMESTAMPS, PipelineStatistics};
pub use submit::SubmitReport;
pub use transfer::Transfer;
