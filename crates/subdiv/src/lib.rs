//! Control meshes, subdivision rules, refinement, tables and the CPU evaluator.
//!
//! Layers, each using only those before it: [`mesh`] (the cage), [`rules`] (masks, no topology), [`topology`] (one level
//! as half-edges), `face_varying` (channels of values at face
//! corners), [`refine`] (feature-adaptive levels), then [`tables`] (what the GPU reads), [`selection`] (what a frame
//! makes of them) and [`eval`] (f64 evaluator).

mod base_level;
mod basis;
pub mod edits;
pub mod error;
pub mod eval;
mod face_varying;
pub mod gregory;
pub mod limit;
pub mod mesh;
pub mod patch;
pub mod refine;
mod ring;
pub mod rules;
pub mod scheme;
pub mod selection;
mod sharpness;
pub mod stencil;
pub mod tables;
pub mod topology;
pub mod vertex_tag;

pub use error::Error;
pub use mesh::ControlMesh;
