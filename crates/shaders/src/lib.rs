//! The GLSL of glsl/ as SPIR-V, with generated Rust structs.
