use planish_shaders::precise::{FunctionReport, no_contraction_report};

use crate::{fixture, fixtures};

fn report(function: &str) -> FunctionReport {
    let reports = no_contraction_report(&fixture("surface_tese").words).unwrap();
    reports.into_iter().find(|report| report.base_name() == function).expect("the function")
}

#[test]
fn a_precise_function_has_only_decorated_arithmetic() {
    let blend = report("blend");
    assert_eq!(blend.name, "blend(vf3;vf3;f1;");
    assert!(blend.no_contraction > 0);
    assert_eq!((blend.contractible, blend.fma, blend.undecorable), (0, 0, 0));
}

#[test]
fn other_functions_are_counted_by_kind() {
    // 1 - t, a * that, the sum; fma; mix.
    let loose = report("loose_blend");
    assert_eq!((loose.no_contraction, loose.contractible, loose.fma, loose.undecorable), (0, 3, 1, 1));
    // The matrix times the position.
    assert_eq!(report("main").contractible, 1);
}

#[test]
fn malformed_modules_are_errors() {
    assert!(no_contraction_report(&[]).is_err());
    let words = fixture("surface_tese").words;
    assert!(no_contraction_report(&words[..words.len() - 1]).is_ok(), "the last instruction has one word");
    assert!(no_contraction_report(&[&words[..], &[5 << 16]].concat()).is_err());
}

#[test]
fn no_damage_to_a_module_makes_the_reader_panic() {
    for module in fixtures() {
        for at in 0..module.words.len() {
            let mut words = module.words.clone();
            for value in [0, 1, u32::MAX, words[at] ^ 1] {
                words[at] = value;
                let _ = no_contraction_report(&words);
            }
        }
    }
}
