use crate::build::reflect::{BindingKind, Layout, Reflection, SpecConstant, Type, reflect};
use crate::{compute, fixture, modules, one_module};

const UINT: Type = Type::Int { signed: false, bits: 32 };
const FLOAT: Type = Type::Float { bits: 32 };

/// Name, offset and GLSL type of every member.
fn members(layout: &Layout) -> Vec<(&str, u32, String)> {
    layout.members.iter().map(|member| (member.name.as_str(), member.offset, member.ty.to_string())).collect()
}

fn of(reflection: &Reflection, name: &str) -> Vec<(String, u32, String)> {
    let members = members(&reflection.structs[name]);
    members.into_iter().map(|(name, offset, ty)| (name.to_owned(), offset, ty)).collect()
}

fn member(name: &str, offset: u32, ty: &str) -> (String, u32, String) {
    (name.into(), offset, ty.into())
}

#[test]
fn push_constants_hold_pointers_and_scalars() {
    let reflection = fixture("refine_plain_comp").reflection;
    assert_eq!(reflection.push.as_deref(), Some("Push"));
    let push = &reflection.structs["Push"];
    assert_eq!(
        members(push),
        [("points", 0, "Points".into()), ("refined", 8, "Output".into()), ("count", 16, "uint".into())]
    );
    assert_eq!(push.members[0].ty, Type::Pointer("Points".into()));
}

#[test]
fn push_constants_with_an_instance_name_are_found_by_the_name_of_their_block() {
    let reflection = fixture("surface_tese").reflection;
    assert_eq!(reflection.push.as_deref(), Some("DrawPush"));
    assert_eq!(
        of(&reflection, "DrawPush"),
        [member("frame", 0, "Frame"), member("mesh", 8, "Mesh"), member("jitter", 16, "vec2")]
    );
}

#[test]
fn what_a_pointer_points_to_is_laid_out_through_any_number_of_pointers() {
    let reflection = fixture("surface_vert").reflection;
    assert_eq!(
        of(&reflection, "Mesh"),
        [
            member("points", 0, "Points"),
            member("next", 8, "Mesh"),
            member("crease", 16, "Crease"),
            member("type", 24, "uint"),
            member("faces", 28, "uint[]")
        ]
    );
    assert_eq!(of(&reflection, "Points"), [member("v", 0, "vec3[]")]);
    let element = Box::new(Type::Vector { element: Box::new(FLOAT), count: 3 });
    assert_eq!(reflection.structs["Points"].members[0].ty, Type::RuntimeArray { element, stride: 12 });
}

#[test]
fn nested_structs_matrices_and_arrays_keep_their_scalar_layout() {
    let reflection = fixture("surface_vert").reflection;
    assert_eq!(
        of(&reflection, "Frame"),
        [
            member("level_count", 0, "uint"),
            member("viewport", 4, "uvec2"),
            member("world_to_clip", 12, "mat4x4"),
            member("world_to_uv", 76, "mat3x2[2]"),
            member("frame_number", 128, "int64_t"),
            member("levels", 136, "Points[3]"),
            member("creases", 160, "Crease[2]"),
            member("time", 176, "float"),
        ]
    );
    let matrix = Type::Matrix { bits: 32, columns: 3, rows: 2, stride: 8, row_major: false };
    assert_eq!(
        reflection.structs["Frame"].members[3].ty,
        Type::Array { element: Box::new(matrix), count: 2, stride: 24 }
    );
    assert_eq!(of(&reflection, "Crease"), [member("edge_index", 0, "uint"), member("sharpness", 4, "float")]);
}

#[test]
fn a_struct_that_is_a_local_variable_too_is_no_second_layout() {
    let declarations = "struct Pair { uint a; vec3 b; };\n\
        layout(buffer_reference, scalar) buffer Pairs { Pair v[]; };\n\
        Pair swap(Pair p) { Pair q = p; q.a = 1; return q; }";
    let text = compute(declarations, "Pairs pairs;").replace("main() {}", "main() { pairs.v[0] = swap(pairs.v[1]); }");
    let made = modules(&[("a.comp", text)]).unwrap();
    assert_eq!(of(&made[0].reflection, "Pair"), [member("a", 0, "uint"), member("b", 4, "vec3")]);
}

#[test]
fn specialisation_constants_have_ids_names_and_defaults() {
    let constants = fixture("refine_plain_comp").reflection.spec_constants;
    let constant = |name: &str, default| SpecConstant { name: name.into(), default };
    let expected = [
        (0, constant("MAX_LEVEL", 5)),
        (1, constant("adaptive", 1)),
        (2, constant("tolerance", 1.0_f32.to_bits())),
        (7, constant("LOCAL_SIZE_X", 1)),
    ];
    assert_eq!(constants.into_iter().collect::<Vec<_>>(), expected);
}

#[test]
fn the_local_size_is_read_from_literals_and_from_ids() {
    assert_eq!(one_module("", "uint a;").reflection.local_size, Some([64, 1, 1]));
    assert_eq!(fixture("refine_plain_comp").reflection.local_size, Some([1, 2, 1]));
    assert_eq!(fixture("surface_frag").reflection.local_size, None);
}

#[test]
fn a_constant_that_shares_the_id_of_the_local_size_keeps_its_name() {
    let text = "#version 460\nlayout(local_size_x_id = 3, local_size_y_id = 4) in;\n\
        layout(constant_id = 3) const uint WIDTH = 32;\nvoid main() {}\n";
    let constants = modules(&[("a.comp", text.into())]).unwrap().remove(0).reflection.spec_constants;
    let names: Vec<_> = constants.iter().map(|(id, constant)| (*id, constant.name.as_str())).collect();
    assert_eq!(names, [(3, "WIDTH"), (4, "LOCAL_SIZE_Y")]);
}

#[test]
fn bindings_have_a_kind_and_a_count_and_are_sorted() {
    let bindings = fixture("surface_frag").reflection.bindings;
    let found: Vec<_> = bindings.iter().map(|b| (b.set, b.binding, b.name.as_str(), b.kind, b.count)).collect();
    assert_eq!(
        found,
        [
            (0, 0, "environment", BindingKind::CombinedImageSampler, 1),
            (0, 1, "layers", BindingKind::StorageImage, 3),
            (1, 0, "Lights", BindingKind::UniformBuffer, 1),
        ]
    );
    let bindings = fixture("refine_stats_comp").reflection.bindings;
    assert_eq!(bindings.len(), 1);
    assert_eq!((bindings[0].kind, bindings[0].name.as_str()), (BindingKind::StorageBuffer, "stats"));
}

#[test]
fn every_kind_of_resource_is_told_apart() {
    let declarations = "layout(binding = 0) uniform texture2D image;\nlayout(binding = 1) uniform sampler nearest;\n\
        layout(binding = 2) uniform samplerBuffer texels;\nlayout(binding = 3, r32f) uniform imageBuffer stored;\n\
        layout(binding = 4, scalar) buffer Block { uint v[]; } blocks[2];";
    let bindings = one_module(declarations, "uint a;").reflection.bindings;
    let kinds: Vec<_> = bindings.iter().map(|b| (b.kind, b.count)).collect();
    assert_eq!(
        kinds,
        [
            (BindingKind::SampledImage, 1),
            (BindingKind::Sampler, 1),
            (BindingKind::UniformTexelBuffer, 1),
            (BindingKind::StorageTexelBuffer, 1),
            (BindingKind::StorageBuffer, 2),
        ]
    );
}

#[test]
fn an_array_with_a_specialised_length_is_an_error() {
    let declarations = "layout(constant_id = 0) const uint N = 4;\n\
        layout(buffer_reference, scalar) buffer Sized { uint v[N]; uint last; };";
    let errors = modules(&[("a.comp", compute(declarations, "Sized s;"))]).unwrap_err();
    assert!(errors[0].starts_with("glsl/a.comp: `Sized.v`: the length of an array"), "{errors:?}");
}

#[test]
fn malformed_modules_are_errors() {
    assert!(reflect(&[]).is_err());
    assert!(reflect(&[1, 2, 3, 4, 5]).unwrap_err().contains("magic"));
    let header = [0x0723_0203, 0x1_0600, 0, 10, 0];
    let with = |words: &[u32]| reflect(&[&header[..], words].concat());
    assert_eq!(with(&[]).unwrap(), Reflection::default());
    assert!(with(&[0]).unwrap_err().contains("claims 0 words"));
    assert!(with(&[9 << 16 | 5]).unwrap_err().contains("claims 9 words, 1 are left"));
    assert!(with(&[3 << 16 | 5, 1, 0x4141_4141]).unwrap_err().contains("string without end"));
    // A struct (id 1, named `A`) whose only member, at offset 0, is itself; and a push-constant variable of it.
    let name = [3 << 16 | 5, 1, 0x41, 4 << 16 | 6, 1, 0, 0x61];
    let types = [5 << 16 | 72, 1, 0, 35, 0, 3 << 16 | 30, 1, 1, 4 << 16 | 32, 2, 9, 1, 4 << 16 | 59, 2, 3, 9];
    assert!(with(&[&name[..], &types].concat()).unwrap_err().contains("contains itself"));
}

#[test]
fn no_damage_to_a_module_makes_the_reader_panic() {
    // One module with nested structs, and one with a local size from a constant; the rest repeats them.
    for module in [fixture("refine_stats_comp"), fixture("surface_frag")] {
        for end in 0..module.words.len().min(1500) {
            let _ = reflect(&module.words[..end]);
        }
        for at in 0..module.words.len().min(1500) {
            for value in [0, 1, 7, 0xffff_ffff, module.words[at] ^ 1, module.words[at] + 0x1_0000] {
                let mut words = module.words.clone();
                words[at] = value;
                if let Ok(reflection) = reflect(&words) {
                    let _ = crate::build::generate::generate(&[crate::Module { reflection, words, ..module.clone() }]);
                }
            }
        }
    }
}

#[test]
fn types_are_shown_as_in_glsl() {
    assert_eq!(Type::Vector { element: Box::new(UINT), count: 2 }.to_string(), "uvec2");
    assert_eq!(Type::Vector { element: Box::new(Type::Float { bits: 64 }), count: 3 }.to_string(), "dvec3");
    assert_eq!(Type::Int { signed: true, bits: 64 }.to_string(), "int64_t");
}
