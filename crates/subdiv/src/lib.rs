//! Control meshes, subdivision rules, refinement, tables and the CPU evaluator.
pub mod mesh;
