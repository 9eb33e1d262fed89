//! Tests of the build script's modules, which a build script cannot have itself, and of the SPIR-V they make.

#[path = "../../build/mod.rs"]
mod build;

mod compile;
mod generate;
mod precise;
mod reflect;
mod validate;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use build::generate::Module;
use tempfile::TempDir;

/// What a stage file needs before it may use pointers and includes.
const HEADER: &str = "#version 460\n\
    #extension GL_GOOGLE_include_directive : require\n\
    #extension GL_EXT_buffer_reference : require\n\
    #extension GL_EXT_scalar_block_layout : require\n\
    #extension GL_EXT_shader_explicit_arithmetic_types : require\n";

/// The shaders of this test, which use everything that the real ones do; compiled once.
fn fixtures() -> Vec<Module> {
    static FIXTURES: LazyLock<Vec<Module>> = LazyLock::new(|| {
        let glsl = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/glsl");
        build::modules(&glsl).unwrap_or_else(|errors| panic!("{}", errors.join("\n")))
    });
    FIXTURES.clone()
}

fn fixture(name: &str) -> Module {
    fixtures().into_iter().find(|module| module.name == name).expect("a fixture")
}

/// A folder `glsl` with the given files, below a folder that is deleted with the result.
fn folder(files: &[(&str, String)]) -> (TempDir, PathBuf) {
    let parent = TempDir::new().expect("a temporary folder");
    let glsl = parent.path().join("glsl");
    fs::create_dir_all(glsl.join("shared")).expect("a folder");
    for (name, text) in files {
        fs::write(glsl.join(name), text).expect("a file");
    }
    (parent, glsl)
}

/// Compiles a folder with the given files.
fn modules(files: &[(&str, String)]) -> Result<Vec<Module>, Vec<String>> {
    let (_parent, glsl) = folder(files);
    build::modules(&glsl)
}

/// A compute shader that declares `declarations`, and whose push constants are `push`.
fn compute(declarations: &str, push: &str) -> String {
    format!(
        "{HEADER}layout(local_size_x = 64) in;\n{declarations}\n\
         layout(push_constant, scalar) uniform Push {{ {push} }};\nvoid main() {{}}\n"
    )
}

/// The only module of a compute shader made by [`compute`].
fn one_module(declarations: &str, push: &str) -> Module {
    let made = modules(&[("one.comp", compute(declarations, push))]);
    made.unwrap_or_else(|errors| panic!("{}", errors.join("\n"))).remove(0)
}
