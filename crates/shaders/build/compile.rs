//! GLSL to SPIR-V: finds the stage files, reads their variants and compiles each with glslang.

use std::fs;
use std::path::{Path, PathBuf};

use glslang::error::GlslangError;
use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage, SpirvVersion,
    Target, VulkanVersion,
};

/// A line with this prefix, among the first [`VARIANT_LINES`] of a stage file, lists the variants of the file.
const VARIANT_PREFIX: &str = "// variants:";
/// How far down the line may stand; further down it would be overlooked by readers too.
const VARIANT_LINES: usize = 10;

/// One way to compile a stage file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Module name: `<stem>_<ext>`, or `<stem>_<variant>_<ext>`.
    pub module: String,
    /// Preprocessor names that are defined as 1.
    pub defines: Vec<String>,
}

/// A file as it was read, for finding where a struct is declared.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path relative to the repository, with forward slashes: `glsl/shared/mesh.glsl`.
    pub path: String,
    pub text: String,
}

/// A stage file, read, with its variants.
#[derive(Clone, Debug)]
pub struct StageFile {
    pub source: SourceFile,
    pub stage: Stage,
    pub variants: Vec<Variant>,
}

/// The stages the renderer uses; named after the variants of the crate's own `ShaderStage`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Compute,
    Vertex,
    TessellationControl,
    TessellationEvaluation,
    Fragment,
}

impl Stage {
    /// The stage that a file's extension stands for; `None` for files that are no stage.
    pub fn of_extension(extension: &str) -> Option<Stage> {
        Some(match extension {
            "comp" => Stage::Compute,
            "vert" => Stage::Vertex,
            "tesc" => Stage::TessellationControl,
            "tese" => Stage::TessellationEvaluation,
            "frag" => Stage::Fragment,
            _ => return None,
        })
    }

    fn glslang(self) -> ShaderStage {
        match self {
            Stage::Compute => ShaderStage::Compute,
            Stage::Vertex => ShaderStage::Vertex,
            Stage::TessellationControl => ShaderStage::TesselationControl,
            Stage::TessellationEvaluation => ShaderStage::TesselationEvaluation,
            Stage::Fragment => ShaderStage::Fragment,
        }
    }
}

/// A compiled module and every file that went into it, the stage file first.
#[derive(Clone, Debug)]
pub struct Compiled {
    pub words: Vec<u32>,
    pub sources: Vec<SourceFile>,
}

/// The stage files directly in `glsl`, sorted by name. A missing folder holds none.
pub fn stage_files(glsl: &Path) -> Result<Vec<StageFile>, Vec<String>> {
    if !glsl.exists() {
        return Ok(Vec::new());
    }
    let listed = fs::read_dir(glsl).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let listed = listed.map_err(|error| vec![format!("{}: {error}", glsl.display())])?;
    let mut paths: Vec<PathBuf> = listed.iter().map(fs::DirEntry::path).filter(|path| path.is_file()).collect();
    paths.sort();
    let (mut files, mut errors) = (Vec::new(), Vec::new());
    for path in paths {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let Some(stage) = Stage::of_extension(extension) else { continue };
        match stage_file(glsl, &path, extension, stage) {
            Ok(file) => files.push(file),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(files) } else { Err(errors) }
}

fn stage_file(glsl: &Path, path: &Path, extension: &str, stage: Stage) -> Result<StageFile, String> {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let shown = format!("{}/{stem}.{extension}", folder_name(glsl));
    if !is_snake_case(stem) {
        return Err(format!("{shown}: a stage file's name must be snake_case, it becomes a Rust module"));
    }
    let text = read_glsl(path).map_err(|error| format!("{shown}: {error}"))?;
    let variants = variants(&text, stem, extension).map_err(|(line, error)| format!("{shown}:{line}: {error}"))?;
    Ok(StageFile { source: SourceFile { path: shown, text }, stage, variants })
}

/// Reads the variants line of a stage file. An error comes with its line number, from 1.
pub fn variants(text: &str, stem: &str, extension: &str) -> Result<Vec<Variant>, (usize, String)> {
    let mut lines = text.lines().take(VARIANT_LINES).enumerate();
    let found = lines.find_map(|(index, line)| Some((index + 1, line.trim().strip_prefix(VARIANT_PREFIX)?)));
    let Some((line, list)) = found else {
        return Ok(vec![Variant { module: format!("{stem}_{extension}"), defines: Vec::new() }]);
    };
    let mut variants: Vec<Variant> = Vec::new();
    for item in list.split_whitespace() {
        let (name, defines) = item.split_once('=').unwrap_or((item, ""));
        if !is_snake_case(name) {
            return Err((
                line,
                format!("variant `{name}` must be snake_case, it becomes part of a Rust module's name"),
            ));
        }
        let defines: Vec<String> = defines.split(',').filter(|define| !define.is_empty()).map(str::to_owned).collect();
        if let Some(define) = defines.iter().find(|define| !is_identifier(define)) {
            return Err((line, format!("`{define}` of variant `{name}` is not an identifier")));
        }
        let module = format!("{stem}_{name}_{extension}");
        if variants.iter().any(|variant| variant.module == module) {
            return Err((line, format!("variant `{name}` is listed twice")));
        }
        variants.push(Variant { module, defines });
    }
    if variants.is_empty() { Err((line, "the list of variants is empty".into())) } else { Ok(variants) }
}

/// Compiles one variant of a stage file to SPIR-V 1.6 for Vulkan 1.3. Each error reads `path:line: message [module]`.
pub fn compile(glsl: &Path, file: &StageFile, variant: &Variant) -> Result<Compiled, Vec<String>> {
    let mut includes = Includes { glsl, main: &file.source.path, read: Vec::new() };
    let words = run_glslang(file, variant, &mut includes);
    let words = words.map_err(|log| error_lines(&log, &file.source.path, &variant.module))?;
    let mut sources = vec![file.source.clone()];
    sources.append(&mut includes.read);
    Ok(Compiled { words, sources })
}

fn run_glslang(file: &StageFile, variant: &Variant, includes: &mut Includes<'_>) -> Result<Vec<u32>, String> {
    let compiler = Compiler::acquire().ok_or("glslang could not be initialised")?;
    let source = ShaderSource::from(file.source.text.clone());
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        version_profile: None,
        // Without it only the first error of a shader would be told.
        messages: ShaderMessage::CASCADING_ERRORS,
    };
    let defines: Vec<(&str, Option<&str>)> = variant.defines.iter().map(|name| (name.as_str(), Some("1"))).collect();
    let compiled = ShaderInput::new(&source, file.stage.glslang(), &options, Some(&defines[..]), Some(includes))
        .and_then(|input| compiler.create_shader(input))
        .and_then(|shader| shader.compile());
    compiled.map_err(|error| match error {
        GlslangError::PreprocessError(log)
        | GlslangError::ParseError(log)
        | GlslangError::MapIoError(log)
        | GlslangError::LinkError(log) => log.log,
        other => other.to_string(),
    })
}

/// Turns glslang's log into one `path:line: message [module]` a line.
fn error_lines(log: &str, main: &str, module: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for line in log.lines().map(str::trim) {
        let summary = ["compilation errors.  No code generated", "compilation terminated"];
        if line.is_empty() || summary.iter().any(|text| line.contains(text)) {
            continue;
        }
        let text = line.strip_prefix("ERROR: ").unwrap_or(line);
        // glslang calls the stage file, which has no name for it, string 0.
        let text = match text.strip_prefix("0:") {
            Some(rest) => format!("{main}:{rest}"),
            None if has_location(text) => text.to_owned(),
            None => format!("{main}: {text}"),
        };
        lines.push(format!("{text} [{module}]"));
    }
    if lines.is_empty() {
        lines.push(format!("{main}: glslang failed without a message [{module}]"));
    }
    lines
}

/// Whether a log line starts with `path:line:`.
fn has_location(text: &str) -> bool {
    let mut parts = text.split(':');
    let path = parts.next().unwrap_or_default();
    let line = parts.next().unwrap_or_default();
    path.contains('/') && !line.is_empty() && line.bytes().all(|byte| byte.is_ascii_digit())
}

/// Resolves `#include`s, relative to the including file first and to `glsl/` second, and keeps what was read.
struct Includes<'a> {
    glsl: &'a Path,
    main: &'a str,
    read: Vec<SourceFile>,
}

impl IncludeHandler for Includes<'_> {
    fn include(&mut self, _kind: IncludeType, header: &str, includer: &str, _depth: usize) -> Option<IncludeResult> {
        // glslang passes "" for the stage file, which has no name for it.
        let includer = if includer.is_empty() { self.main } else { includer };
        let inside = includer.strip_prefix(&format!("{}/", folder_name(self.glsl)))?;
        let beside = Path::new(inside).parent()?.join(header);
        let (path, text) = [beside, PathBuf::from(header)].into_iter().find_map(|path| {
            let text = read_glsl(&self.glsl.join(&path)).ok()?;
            Some((path, text))
        })?;
        let name = format!("{}/{}", folder_name(self.glsl), path.to_str()?.replace('\\', "/"));
        if self.read.iter().all(|file| file.path != name) {
            self.read.push(SourceFile { path: name.clone(), text: text.clone() });
        }
        Some(IncludeResult { name, data: text })
    }
}

/// Reads a source file; glslang takes C strings, which cannot hold a NUL.
fn read_glsl(path: &Path) -> Result<String, String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    if text.contains('\0') { Err("the file holds a NUL character".into()) } else { Ok(text) }
}

/// The name under which files of the folder appear in messages: `glsl`.
fn folder_name(glsl: &Path) -> &str {
    glsl.file_name().and_then(|name| name.to_str()).unwrap_or("glsl")
}

/// A name that rustc's `non_snake_case` lint accepts, and that does not start with a digit.
pub fn is_snake_case(name: &str) -> bool {
    is_identifier(name) && !name.contains("__") && !name.bytes().any(|byte| byte.is_ascii_uppercase())
}

fn is_identifier(name: &str) -> bool {
    let starts_well = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    starts_well && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}
