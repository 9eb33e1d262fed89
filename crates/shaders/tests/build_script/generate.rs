use std::path::Path;
use std::{env, fs};

use crate::build::generate::generate;
use crate::{Module, compute, fixtures, modules, one_module};

/// Set to rewrite `fixtures/generated.rs`, which `tests/generated_code.rs` compiles.
const UPDATE: &str = "PLANISH_UPDATE_GENERATED";

fn rust(module: Module) -> String {
    generate(&[module]).unwrap_or_else(|errors| panic!("{}", errors.join("\n")))
}

fn errors(files: &[(&str, String)]) -> Vec<String> {
    generate(&modules(files).unwrap_or_else(|errors| panic!("{}", errors.join("\n")))).unwrap_err()
}

#[test]
fn the_fixtures_generate_the_code_on_file() {
    let mut modules = fixtures();
    for module in &mut modules {
        // The words are glslang's business, and many; the first of them stand for all.
        module.words.truncate(2);
    }
    let text = generate(&modules).unwrap();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/generated.rs");
    if env::var_os(UPDATE).is_some() {
        fs::write(&file, &text).unwrap();
    }
    let on_file = fs::read_to_string(&file).unwrap();
    let differing = text.lines().zip(on_file.lines()).find(|(now, then)| now != then);
    assert!(text == on_file, "{differing:?}; if this is intended, run again with {UPDATE}=1");
}

#[test]
fn gaps_and_the_end_of_a_struct_are_padded() {
    let declarations = "layout(buffer_reference, scalar) buffer Gap { uint a; uint64_t b; uint8_t _padding0; };";
    let text = rust(one_module(declarations, "Gap gap;"));
    assert!(text.contains("/// Padding at byte 4.\n    pub _padding1: [u8; 4],"), "{text}");
    assert!(text.contains("/// Padding at byte 17.\n    pub _padding2: [u8; 7],"), "{text}");
    assert!(text.contains("assert!(core::mem::offset_of!(Gap, b) == 8);"), "{text}");
    assert!(text.contains("assert!(size_of::<Gap>() == 24);"), "{text}");
}

#[test]
fn a_block_of_only_a_runtime_array_is_an_alias() {
    let text = rust(one_module("layout(buffer_reference, scalar) buffer Pairs { uvec2 v[]; };", "Pairs p;"));
    assert!(text.contains("/// An element of `Pairs` (`uvec2 v[]`) of `glsl/one.comp`.\npub type Pairs = [u32; 2];"));
    assert!(text.contains("pub p: super::DeviceAddress<super::Pairs>,"), "{text}");
}

#[test]
fn a_struct_with_two_layouts_names_both_modules_and_the_first_differing_member() {
    let with = |members: &str| {
        compute(&format!("layout(buffer_reference, scalar) buffer Item {{ {members} }};"), "Item item;")
    };
    let found = errors(&[("a.comp", with("uint a; vec3 b;")), ("b.comp", with("uint a; vec4 b;"))]);
    let place = "in the first and `vec4 b` at byte 4 in the second";
    assert_eq!(
        found,
        [format!(
            "glsl/b.comp: struct `Item` differs between a_comp and b_comp: member 1 is `vec3 b` at byte 4 {place}"
        )]
    );
    let found = errors(&[("a.comp", with("uint a; uint b;")), ("b.comp", with("uint a;"))]);
    assert!(found[0].ends_with("member 1 is `uint b` at byte 4 in the first and missing in the second"), "{found:?}");
}

#[test]
fn push_blocks_with_other_names_must_agree_too() {
    let with = |members: &str| compute("", members).replace("uniform Push", "uniform FramePush");
    let found = errors(&[("a.comp", with("uint a;")), ("b.comp", with("uint b;"))]);
    assert!(found[0].contains("struct `FramePush` differs between a_comp and b_comp"), "{found:?}");
    let made = modules(&[("a.comp", with("uint a;")), ("b.comp", with("uint a;"))]).unwrap();
    let text = generate(&made).unwrap();
    assert_eq!(text.matches("pub struct FramePush").count(), 1);
    assert_eq!(text.matches("pub use super::FramePush as Push;").count(), 2);
}

#[test]
fn blocks_called_push_may_differ() {
    let made = modules(&[("a.comp", compute("", "uint a;")), ("b.comp", compute("", "uint b;"))]).unwrap();
    assert_eq!(generate(&made).unwrap().matches("pub struct Push").count(), 2);
}

#[test]
fn push_constants_beyond_128_bytes_are_an_error() {
    assert!(generate(&[one_module("", "mat4 a; mat4 b;")]).is_ok());
    let found = errors(&[("a.comp", compute("", "mat4 a; mat4 b; uint c;"))]);
    assert_eq!(found, ["glsl/a.comp: push constants `Push` have 132 bytes, more than 128 [a_comp]"]);
}

#[test]
fn what_rust_cannot_represent_is_an_error() {
    for (declarations, push, message) in [
        // Scalar layout puts `b` into the tail padding of `Inner`.
        ("struct Inner { uint64_t a; uint b; };", "Inner inner; uint b;", "`Push.b` is at byte 12"),
        ("", "layout(row_major) mat4 m;", "row_major"),
        ("", "float16_t h;", "Rust has no type for float16_t"),
        ("", "uint worldToClip;", "`worldToClip` must be snake_case"),
        ("", "uint self;", "no keyword"),
        ("layout(buffer_reference) buffer item { uint a; };", "item i;", "UpperCamelCase"),
        ("layout(buffer_reference) buffer Binding { uint a; };", "Binding b;", "`Binding` is taken"),
    ] {
        let found = errors(&[("a.comp", compute(declarations, push))]);
        assert!(found[0].starts_with("glsl/a.comp: ") && found[0].contains(message), "{found:?}");
    }
}

#[test]
fn a_push_struct_that_is_no_push_block_is_an_error() {
    let text = compute("layout(buffer_reference) buffer Push { uint a; };", "Push p;");
    let found = errors(&[("a.comp", text.replace("uniform Push", "uniform Other"))]);
    assert_eq!(found, ["glsl/a.comp: the name `Push` is kept for push constants [a_comp]"]);
}

#[test]
fn a_struct_is_documented_with_the_file_that_declares_it() {
    let text = generate(&fixtures()).unwrap();
    assert!(text.contains("/// `Crease` of `glsl/shared/mesh.glsl`."));
    assert!(text.contains("/// `DrawPush` of `glsl/shared/draw.glsl`."));
    assert!(text.contains("/// `glsl/refine.comp`, with `COUNT_POINTS`, `COUNT_FACES` defined."));
}

#[test]
fn no_shaders_generate_an_empty_list() {
    assert!(generate(&[]).unwrap().contains("pub const MODULES: &[ShaderModule] = &[\n];"));
}
