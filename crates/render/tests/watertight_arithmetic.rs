//! The arithmetic that decides where surface points lie must not be fused or reordered by any driver's compiler.
//! A software driver never fuses, so this reads the SPIR-V: NoContraction on every operation (FAS section 5).

use planish_shaders::precise::no_contraction_report;
use planish_shaders::{self as shaders, ShaderModule};

/// Functions whose arithmetic decides shared positions and normals, by module.
const WATERTIGHT: [(&ShaderModule, &[&str]); 4] = [
    (
        &shaders::bspline_patch_lean_tese::PROGRAM,
        &["cubic_basis", "weigh", "precise_cross", "scaled", "unit_normal", "place"],
    ),
    (
        &shaders::bspline_patch_layers_tese::PROGRAM,
        &["cubic_basis", "weigh", "precise_cross", "scaled", "unit_normal", "place"],
    ),
    (
        &shaders::bspline_patch_dump_tese::PROGRAM,
        &["cubic_basis", "weigh", "precise_cross", "scaled", "unit_normal", "place"],
    ),
    (&shaders::bspline_patch_tesc::PROGRAM, &["reflected_point"]),
];

#[test]
fn shared_points_are_computed_without_contraction() {
    for (module, functions) in WATERTIGHT {
        let report = no_contraction_report(module.spirv).expect("valid SPIR-V");
        for name in functions {
            let function = report.iter().find(|f| f.base_name() == *name);
            let function = function.unwrap_or_else(|| panic!("{}: no function {name}", module.name));
            assert!(function.no_contraction > 0, "{}: {name} has no arithmetic", module.name);
            assert_eq!((function.contractible, function.fma), (0, 0), "{}: {name}", module.name);
        }
    }
}

#[test]
fn patches_are_left_out_by_arithmetic_without_contraction() {
    let modules = [
        &shaders::emit_bspline_comp::PROGRAM,
        &shaders::emit_corners_comp::PROGRAM,
        &shaders::emit_midpoints_comp::PROGRAM,
    ];
    for module in modules {
        let report = no_contraction_report(module.spirv).expect("valid SPIR-V");
        assert!(report.iter().map(|function| function.no_contraction).sum::<u32>() > 20, "{}", module.name);
        for function in report {
            assert_eq!((function.contractible, function.fma, function.undecorable), (0, 0, 0), "{function:?}");
        }
    }
}

#[test]
fn point_kernels_are_computed_without_contraction() {
    for module in [&shaders::subdivide_comp::PROGRAM, &shaders::limit_comp::PROGRAM] {
        let report = no_contraction_report(module.spirv).expect("valid SPIR-V");
        let main = report.iter().find(|f| f.base_name() == "main").expect("an entry point");
        assert!(main.no_contraction > 0);
        assert_eq!((main.contractible, main.fma), (0, 0), "{}", module.name);
    }
}
