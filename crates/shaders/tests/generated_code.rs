//! Compiles and uses the code that the build script generates for the fixtures: its own assertions on layouts hold.

use bytemuck::Zeroable;
use generated::{
    Crease, DrawPush, Frame, MODULES, Mesh, Points, refine_plain_comp, refine_stats_comp, surface_frag, surface_tese,
};
use planish_shaders::DeviceAddress;

/// Kept up to date by the test `the_fixtures_generate_the_code_on_file`.
mod generated {
    use planish_shaders::{Binding, BindingKind, DeviceAddress, ShaderModule, ShaderStage, SpecConstant};

    include!("fixtures/generated.rs");
}

#[test]
fn generated_structs_have_the_layout_of_glsl() {
    assert_eq!(size_of::<Points>(), 12);
    assert_eq!(size_of::<Frame>(), 184);
    assert_eq!((size_of::<Mesh>(), Mesh::FACES_OFFSET), (32, 28));
    assert_eq!((size_of::<DrawPush>(), surface_tese::PROGRAM.push_size), (24, 24));
    let points: DeviceAddress<Points> = DeviceAddress::new(0x1000);
    let push = refine_plain_comp::Push { points, count: 3, ..Default::default() };
    assert_eq!(bytemuck::bytes_of(&push)[..8], 0x1000_u64.to_le_bytes());
    assert_eq!(bytemuck::bytes_of(&push)[16..20], 3_u32.to_le_bytes());
    let mesh = Mesh { crease: Crease { edge_index: 1, sharpness: 2.0 }, r#type: 3, ..Mesh::zeroed() };
    assert!(mesh.next.is_null() && mesh.points == DeviceAddress::null());
}

#[test]
fn a_generated_program_tells_all_that_a_backend_needs() {
    let program = refine_plain_comp::PROGRAM;
    assert_eq!((program.name, program.entry), ("refine_plain_comp", c"main"));
    assert_eq!((program.push_size, program.local_size), (24, Some(refine_plain_comp::LOCAL_SIZE)));
    assert_eq!(program.spirv[0], 0x0723_0203);
    assert_eq!((refine_plain_comp::SPEC_MAX_LEVEL, refine_plain_comp::SPEC_LOCAL_SIZE_X), (0, 7));
    assert_eq!(program.spec_constants[0].default, 5);
    assert_eq!(refine_stats_comp::PROGRAM.bindings[0].name, "stats");
    assert_eq!((surface_frag::PROGRAM.local_size, surface_frag::PROGRAM.bindings.len()), (None, 3));
    assert_eq!(MODULES.len(), 6);
}

#[test]
fn an_address_counts_in_elements() {
    let address: DeviceAddress<[f32; 3]> = DeviceAddress::new(64);
    assert_eq!(address.offset(2).raw(), 88);
    assert_eq!(format!("{address:?}"), "0x40");
    assert_eq!((size_of_val(&address), align_of_val(&address)), (8, 8));
}
