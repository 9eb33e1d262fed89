//! Subdivision surfaces on the GPU: upload, subdivide, limit, draw.
//!
//! The embeddable part of planish: it records into an encoder and submits nothing, apart from uploads and dumps.
//! A frame is [`FrameStages::record`] (densities, which irregular faces are refined, points and limit points in use, draw lists)
//! and then [`DrawPasses::record`] (the regular, transition and patch-filling passes, drawn indirectly). Stages share a stem
//! with their shader; their CPU twins stand beside them, or in [`planish_subdiv::selection`].

mod accumulate;
mod buffers;
pub mod camera;
mod colors;
mod deform;
pub mod density;
mod displacement;
mod draw;
mod dump;
pub mod edit_points;
pub mod emit;
mod emit_gregory;
mod error;
pub mod factors;
mod frame;
mod gregory_points;
pub mod gregory_visibility;
pub mod limit;
pub mod lists;
mod marks;
mod motion;
mod moving;
pub mod objects;
pub mod options;
mod pipelines;
mod program;
pub mod rival_spokes;
mod select;
pub mod shading;
pub mod spokes;
pub mod subdivide;
mod surface;
pub mod table;
mod targets;
mod upload;
pub mod visibility;

pub use accumulate::Accumulation;
pub use camera::FrameCamera;
pub use deform::{DeformationDesc, PoseDesc};
pub use displacement::{DisplacementDesc, MapLayout};
pub use draw::{DrawOptions, DrawPasses};
pub use dump::{CapturedVertex, DumpPasses, listed_triangle_count};
pub use error::Error;
pub use frame::FrameStages;
pub use lists::{PatchKind, Status};
pub use objects::ObjectDesc;
pub use options::{
    Culling, Density, EndCap, FrameNeeds, FrameOptions, GregoryPoints, Selection, Spacing, SurfaceMethod, TableNormals,
    TableWeights, View,
};
pub use surface::{MemoryBytes, PreprocessTimes, Preprocessed, Surface, SurfaceDesc, preprocess, preprocess_cached};
pub use targets::{Layers, NO_SURFACE, Targets};
