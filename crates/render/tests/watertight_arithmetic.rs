//! The arithmetic that decides where surface points lie must not be fused or reordered by any driver's compiler.
//! A software driver never fuses, so this reads the SPIR-V: NoContraction on every operation (FAS section 5).

use planish_shaders::precise::no_contraction_report;
use planish_shaders::{self as shaders, ShaderModule};

/// Functions whose arithmetic decides shared positions and normals.
const EVALUATION: [&str; 14] = [
    "cubic_basis",
    "crease_basis",
    "weigh",
    "weigh_patch_and_tangents",
    "over_36",
    "curve_position",
    "without_sign_of_zero",
    "border_point",
    "reflected",
    "to_world",
    "normal_to_world",
    "precise_cross",
    "scaled",
    "unit_vector",
];
/// And where they are displaced to.
const DISPLACEMENT: [&str; 12] = [
    "weigh_patch",
    "place",
    "between_corners",
    "ptex_place",
    "mix_texels",
    "from_end",
    "centered",
    "tile_at",
    "sample_level",
    "displacement_vector",
    "displaced",
    "linear",
];
/// Of the patches that are no bicubic ones.
const EDGES: [&str; 8] = [
    "weigh_ends",
    "edge_normal",
    "bernstein",
    "without_sign_of_zero",
    "border_point",
    "reflected",
    "over_36",
    "curve_position",
];
/// Of faces that are evaluated by table.
const TABLES: [&str; 9] = [
    "table_row",
    "table_middle",
    "table_between",
    "table_morph",
    "precise_cross",
    "unit_vector",
    "to_world",
    "normal_to_world",
    "without_sign_of_zero",
];
const WATERTIGHT: [(&ShaderModule, &[&str]); 21] = [
    (&shaders::table_patch_lean_tese::PROGRAM, &TABLES),
    (&shaders::table_patch_layers_tese::PROGRAM, &TABLES),
    (&shaders::table_patch_dump_tese::PROGRAM, &TABLES),
    (&shaders::bspline_patch_lean_tese::PROGRAM, &EVALUATION),
    (&shaders::bspline_patch_layers_tese::PROGRAM, &EVALUATION),
    (&shaders::bspline_patch_dump_tese::PROGRAM, &EVALUATION),
    (&shaders::bspline_patch_lean_maps_tese::PROGRAM, &EVALUATION),
    (&shaders::bspline_patch_lean_maps_tese::PROGRAM, &DISPLACEMENT),
    (&shaders::bspline_patch_layers_maps_tese::PROGRAM, &DISPLACEMENT),
    (&shaders::bspline_patch_dump_maps_tese::PROGRAM, &DISPLACEMENT),
    (&shaders::bspline_patch_tesc::PROGRAM, &["reflected_point", "to_world"]),
    (
        &shaders::filling_quad_tesc::PROGRAM,
        &["to_world", "normal_to_world", "unit_vector", "mix_texels", "displacement_vector", "displaced", "linear"],
    ),
    (&shaders::gregory_patch_lean_tese::PROGRAM, &EDGES),
    (&shaders::gregory_patch_lean_maps_tese::PROGRAM, &EDGES),
    (&shaders::acc_patch_lean_tese::PROGRAM, &EDGES),
    (&shaders::pm_patch_lean_tese::PROGRAM, &EDGES),
    (&shaders::gregory_patch_dump_tese::PROGRAM, &EDGES),
    (&shaders::acc_patch_dump_tese::PROGRAM, &EDGES),
    (&shaders::pm_patch_dump_tese::PROGRAM, &EDGES),
    (&shaders::acc_patch_tesc::PROGRAM, &["tangent", "scaled_by", "to_world", "to_world_vector"]),
    (&shaders::pm_patch_tesc::PROGRAM, &["scaled_by", "sine_of", "sum_of_sines", "to_world", "to_world_vector"]),
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
fn frames_are_selected_and_culled_by_arithmetic_without_contraction() {
    // Sums of whole numbers, products with powers of two and single quotients: fused or not, the bits are the same.
    const EXACT: [(&str, u32); 9] = [
        ("table_corner_uv", 1),
        ("ptex_uv", 2),
        ("density_at", 2),
        ("segment_count", 6),
        ("patch_factors", 5),
        ("cut_count", 1),
        ("segment_bounds", 3),
        ("edge_point", 1),
        ("piece_bounds", 2),
    ];
    let modules = [
        &shaders::objects_comp::PROGRAM,
        &shaders::density_comp::PROGRAM,
        &shaders::density_rings_middles_comp::PROGRAM,
        &shaders::density_rings_vertices_comp::PROGRAM,
        &shaders::select_comp::PROGRAM,
        &shaders::emit_patches_comp::PROGRAM,
        &shaders::emit_leaves_comp::PROGRAM,
        &shaders::emit_cut_comp::PROGRAM,
        &shaders::emit_gregory_comp::PROGRAM,
        &shaders::emit_gregory_cut_comp::PROGRAM,
        &shaders::emit_table_comp::PROGRAM,
    ];
    for module in modules {
        let report = no_contraction_report(module.spirv).expect("valid SPIR-V");
        assert!(report.iter().map(|function| function.no_contraction).sum::<u32>() > 0, "{}", module.name);
        for function in report {
            let exact = EXACT.iter().find(|(name, _)| *name == function.base_name()).map_or(0, |(_, count)| *count);
            let found = (function.contractible <= exact, function.fma, function.undecorable);
            assert_eq!(found, (true, 0, 0), "{}: {function:?}", module.name);
        }
    }
}

#[test]
fn point_kernels_are_computed_without_contraction() {
    for module in
        [&shaders::subdivide_comp::PROGRAM, &shaders::limit_comp::PROGRAM, &shaders::rival_spokes_comp::PROGRAM]
    {
        let report = no_contraction_report(module.spirv).expect("valid SPIR-V");
        let main = report.iter().find(|f| f.base_name() == "main").expect("an entry point");
        assert!(main.no_contraction > 0);
        assert_eq!((main.contractible, main.fma), (0, 0), "{}", module.name);
    }
}
