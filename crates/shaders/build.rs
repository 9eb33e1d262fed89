//! Compiles `glsl/` and writes `shaders.rs`, the Rust that `lib.rs` includes.

#[path = "build/mod.rs"]
mod build;

use std::path::{Path, PathBuf};
use std::{env, fs, process};

fn main() {
    // Cargo watches a folder with all that is in it.
    println!("cargo::rerun-if-changed=../../glsl");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    if let Err(errors) = write(&manifest.join("../../glsl"), &out.join("shaders.rs")) {
        for error in errors {
            println!("cargo::error={error}");
        }
        process::exit(1);
    }
}

fn write(glsl: &Path, file: &Path) -> Result<(), Vec<String>> {
    let modules = build::modules(glsl)?;
    let rust = build::generate::generate(&modules)?;
    fs::write(file, rust).map_err(|error| vec![format!("{}: {error}", file.display())])
}
