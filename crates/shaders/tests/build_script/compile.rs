use crate::build::compile::{Variant, variants};
use crate::{HEADER, folder, modules};

fn variant(module: &str, defines: &[&str]) -> Variant {
    Variant { module: module.into(), defines: defines.iter().map(|&define| define.into()).collect() }
}

#[test]
fn an_error_names_the_stage_file_and_its_line() {
    let errors = modules(&[("bad.comp", format!("{HEADER}void main() {{\n    x = 1;\n}}\n"))]).unwrap_err();
    let line = HEADER.lines().count() + 2;
    assert!(errors[0].starts_with(&format!("glsl/bad.comp:{line}: 'x' : undeclared identifier")), "{errors:?}");
    assert!(errors[0].ends_with("[bad_comp]"), "{errors:?}");
}

#[test]
fn an_error_in_an_include_names_the_include_and_its_line() {
    let main = format!("{HEADER}#include \"shared/outer.glsl\"\nvoid main() {{ missing(); }}\n");
    let errors = modules(&[
        ("bad.comp", main),
        ("shared/outer.glsl", "\n#include \"inner.glsl\"\nfloat after = y;\n".into()),
        ("shared/inner.glsl", "\n\nfloat f() { return z; }\n".into()),
    ]);
    let errors = errors.unwrap_err();
    assert!(errors[0].starts_with("glsl/shared/inner.glsl:3: 'z' : undeclared"), "{errors:?}");
    let after = errors.iter().any(|error| error.starts_with("glsl/shared/outer.glsl:3: 'y'"));
    let line = HEADER.lines().count() + 2;
    let main = errors.iter().any(|error| error.starts_with(&format!("glsl/bad.comp:{line}: 'missing'")));
    assert!(after && main, "{errors:?}");
}

#[test]
fn a_missing_include_is_an_error_at_its_line() {
    let errors = modules(&[("bad.comp", format!("{HEADER}#include \"shared/none.glsl\"\nvoid main() {{}}\n"))]);
    let errors = errors.unwrap_err();
    let line = HEADER.lines().count() + 1;
    assert!(errors[0].starts_with(&format!("glsl/bad.comp:{line}: ")), "{errors:?}");
    assert!(errors[0].contains("shared/none.glsl"), "{errors:?}");
}

#[test]
fn errors_of_all_shaders_are_reported_together() {
    let bad = format!("{HEADER}void main() {{ x = 1; }}\n");
    let errors = modules(&[("a.comp", bad.clone()), ("b.vert", bad)]).unwrap_err();
    for path in ["glsl/a.comp:", "glsl/b.vert:"] {
        assert!(errors.iter().any(|error| error.starts_with(path)), "{errors:?}");
    }
}

#[test]
fn a_shader_without_main_is_an_error_with_its_path() {
    let errors = modules(&[("a.comp", format!("{HEADER}void other() {{}}\n"))]).unwrap_err();
    assert!(errors[0].starts_with("glsl/a.comp: "), "{errors:?}");
}

#[test]
fn a_folder_without_shaders_makes_no_modules() {
    let (parent, glsl) = folder(&[("shared/x.glsl", "error".into()), ("notes.txt", "text".into())]);
    assert!(crate::build::modules(&glsl).unwrap().is_empty());
    assert!(crate::build::modules(&parent.path().join("none")).unwrap().is_empty());
}

#[test]
fn a_file_without_variants_is_one_module() {
    assert_eq!(variants("#version 460\n", "refine", "comp").unwrap(), [variant("refine_comp", &[])]);
}

#[test]
fn a_variant_is_a_module_with_its_defines() {
    let text = "#version 460\n// variants: plain loop=LOOP,THREE two=TWO\n";
    let expected = [
        variant("refine_plain_comp", &[]),
        variant("refine_loop_comp", &["LOOP", "THREE"]),
        variant("refine_two_comp", &["TWO"]),
    ];
    assert_eq!(variants(text, "refine", "comp").unwrap(), expected);
}

#[test]
fn a_variants_line_further_down_is_not_read() {
    let text = format!("{}// variants: a=A\n", "\n".repeat(10));
    assert_eq!(variants(&text, "refine", "comp").unwrap(), [variant("refine_comp", &[])]);
}

#[test]
fn malformed_variants_are_errors_with_a_line() {
    for (list, message) in [
        ("", "empty"),
        ("Loop=LOOP", "snake_case"),
        ("a=A a=B", "twice"),
        ("a=1A", "not an identifier"),
        ("a=A=1", "not an identifier"),
    ] {
        let (line, error) = variants(&format!("\n// variants: {list}\n"), "refine", "comp").unwrap_err();
        assert!(line == 2 && error.contains(message), "{list}: {error}");
    }
}

#[test]
fn a_define_of_a_variant_is_one_in_the_preprocessor() {
    let text = "#version 460\n// variants: on=ON off\n#if ON\nlayout(local_size_x = 2) in;\n#endif\nvoid main() {}\n";
    let made = modules(&[("a.comp", text.into())]).unwrap();
    let sizes: Vec<_> = made.iter().map(|module| (module.name.as_str(), module.reflection.local_size)).collect();
    assert_eq!(sizes, [("a_on_comp", Some([2, 1, 1])), ("a_off_comp", Some([1, 1, 1]))]);
}

#[test]
fn an_error_in_a_variant_keeps_its_line_and_names_the_variant() {
    let text = "#version 460\n// variants: on=ON off\nvoid main() {\n#ifdef ON\n    x = 1;\n#endif\n}\n";
    let errors = modules(&[("a.comp", text.into())]).unwrap_err();
    assert!(errors[0].starts_with("glsl/a.comp:5: ") && errors[0].ends_with("[a_on_comp]"), "{errors:?}");
    assert!(!errors.iter().any(|error| error.contains("a_off_comp")), "{errors:?}");
}

#[test]
fn two_files_cannot_make_one_module() {
    let plain = "#version 460\nvoid main() {}\n";
    let errors = modules(&[("a.comp", format!("// variants: b=B\n{plain}")), ("a_b.comp", plain.into())]).unwrap_err();
    assert_eq!(errors, ["glsl/a_b.comp: module `a_b_comp` is made from glsl/a.comp too"]);
}

#[test]
fn a_stage_file_that_is_no_rust_name_is_an_error() {
    let errors = modules(&[("a-b.comp", "#version 460\nvoid main() {}\n".into())]).unwrap_err();
    assert!(errors[0].starts_with("glsl/a-b.comp: ") && errors[0].contains("snake_case"), "{errors:?}");
}
