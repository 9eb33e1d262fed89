//! Control meshes, subdivision rules, refinement, tables and the CPU evaluator.
//!
//! Layers, each using only those before it: [`rules`] (masks, no topology), [`mesh`] (the cage), [`topology`] (one level
//! as half-edges), [`refine`] (feature-adaptive levels), then [`tables`] (what the GPU reads) and [`eval`] (f64 evaluator).

pub mod error;
pub mod eval;
pub mod limit;
pub mod mesh;
pub mod patch;
pub mod refine;
pub mod rules;
pub mod stencil;
pub mod tables;
pub mod topology;

pub use error::Error;
pub use mesh::ControlMesh;
