//! The build script's work: every stage file of a folder becomes SPIR-V and Rust.
//!
//! `compile` (GLSL to SPIR-V) -> `reflect` (SPIR-V to layouts) -> `generate` (layouts to Rust).
//! Nothing here reads the environment, so that tests can run it on folders of their own.

pub mod compile;
pub mod generate;
pub mod reflect;
pub mod spirv;

use std::collections::HashMap;
use std::path::Path;

use compile::{StageFile, Variant};
use generate::Module;

/// Compiles and reflects every variant of every stage file directly in `glsl`; returns all errors of all of them.
pub fn modules(glsl: &Path) -> Result<Vec<Module>, Vec<String>> {
    let (mut modules, mut errors) = (Vec::new(), Vec::new());
    let mut made_by: HashMap<String, String> = HashMap::new();
    for file in compile::stage_files(glsl)? {
        for variant in &file.variants {
            let path = &file.source.path;
            if let Some(other) = made_by.insert(variant.module.clone(), path.clone()) {
                errors.push(format!("{path}: module `{}` is made from {other} too", variant.module));
                continue;
            }
            match module(glsl, &file, variant) {
                Ok(module) => modules.push(module),
                Err(more) => errors.extend(more),
            }
        }
    }
    if errors.is_empty() { Ok(modules) } else { Err(errors) }
}

fn module(glsl: &Path, file: &StageFile, variant: &Variant) -> Result<Module, Vec<String>> {
    let compiled = compile::compile(glsl, file, variant)?;
    let reflection = reflect::reflect(&compiled.words);
    let reflection = reflection.map_err(|error| vec![format!("{}: {error} [{}]", file.source.path, variant.module)])?;
    Ok(Module {
        name: variant.module.clone(),
        stage: file.stage,
        defines: variant.defines.clone(),
        words: compiled.words,
        sources: compiled.sources,
        reflection,
    })
}
