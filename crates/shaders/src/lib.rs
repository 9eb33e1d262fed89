//! The GLSL of glsl/ as SPIR-V, with generated Rust structs.
//!
//! Structures are declared once, in GLSL. The build script compiles every stage file of `glsl/`, reads the layouts
//! back from the SPIR-V and writes:
//! - for each stage file (and each of its variants) a module such as `subdivide_comp` with `PROGRAM`, `SPIRV`, `Push`,
//!   `LOCAL_SIZE`, `BINDINGS` and a `SPEC_<NAME>` for each specialisation constant;
//! - at the root of this crate, the structs that shaders reach through pointers and blocks, with their layout asserted;
//! - [`MODULES`], the list of all programs.
//!
//! A block that holds only a runtime array (`buffer Points { vec3 v[]; }`) is a type alias of its element, so that a
//! pointer to it is a `DeviceAddress<Points>` and a buffer for it a `[Points]`.
//! This crate makes no Vulkan calls and has none of Vulkan's types.

mod address;
mod module;
pub mod precise;
#[path = "../build/spirv.rs"]
#[expect(dead_code, reason = "the build script, which shares this file, uses the rest of the numbers")]
mod spirv;

pub use address::DeviceAddress;
pub use module::{Binding, BindingKind, ShaderModule, ShaderStage, SpecConstant};
pub use spirv::SpirvError;

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
