//! Subdivision surfaces on the GPU: upload, subdivide, limit, draw.
//!
//! The embeddable part of planish: it records into an encoder and submits nothing, apart from uploads and dumps.
//! A frame is [`PointStages::record`] (cage to points of all levels, limit points) and then [`DrawPasses::record`] (the
//! patches that may be seen, and the regular, transition and patch-filling passes, drawn indirectly from lists). Stages
//! share a stem with their shader: `subdivide` (with `edit_points`), `limit`, `emit`; their CPU twins stand beside them.

pub mod camera;
pub mod density;
mod draw;
mod dump;
pub mod edit_points;
pub mod emit;
mod error;
mod frame;
pub mod limit;
mod lists;
pub mod options;
mod pipelines;
mod program;
pub mod subdivide;
mod surface;
mod targets;
pub mod tessellation;
mod upload;
pub mod visibility;

pub use camera::FrameCamera;
pub use draw::{DrawOptions, DrawPasses};
pub use dump::{CapturedVertex, DumpPasses};
pub use error::Error;
pub use frame::FrameConstants;
pub use lists::{Batches, DrawShape, Lists, MAX_BATCH, PatchKind, draw_arguments};
pub use options::{Density, Spacing, SurfaceMethod, View};
pub use surface::{MemoryBytes, PointStages, PreprocessTimes, Preprocessed, Surface, SurfaceDesc, preprocess};
pub use targets::{NO_SURFACE, Targets};
