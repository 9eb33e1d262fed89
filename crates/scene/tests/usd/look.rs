//! Cameras, lights and materials.
use glam::DVec3;
use planish_scene::{AlphaMode, LightKind, Scene, TextureRef, Wrap};

use crate::common::{FACES, mesh_with, read};

const PI: f64 = std::f64::consts::PI;

#[test]
fn cameras_have_a_field_of_view_a_lens_and_a_shutter() {
    let camera = r#"def Camera "c" {
        float focalLength = 35
        float verticalAperture = 24
        float verticalApertureOffset = 6
        float focusDistance = 5
        float fStop = 2
        double shutter:open = -0.25
        double shutter:close = 0.25
        double3 xformOp:translate = (0, 0, 9)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
    def Camera "o" { token projection = "orthographic" }
    "#;
    let scene = read(&format!("{}{camera}", mesh_with(""))).unwrap();
    assert_eq!(scene.cameras.len(), 1);
    let camera = &scene.cameras[0];
    assert!((f64::from(camera.fov_y_degrees) - 2.0 * (12.0f64 / 35.0).atan().to_degrees()).abs() < 1e-5);
    assert_eq!((camera.name.as_str(), camera.eye.z, camera.shift), ("/c", 9.0, [0.0, 0.5]));
    let lens = camera.lens.unwrap();
    assert_eq!((lens.radius, lens.focus_distance), (0.875, 5.0));
    assert_eq!(camera.rig.as_ref().unwrap().shutter, Some([-0.25 / 24.0, 0.25 / 24.0]));
    assert_eq!(scene.warnings[0].to_string(), "/o: orthographic: left out");
}

#[test]
fn lights_are_in_units_of_what_is_received() {
    let lights = r#"
    def SphereLight "sphere" { float inputs:radius = 0.1
        float inputs:intensity = 3
        float inputs:exposure = 1
        color3f inputs:color = (1, 0.5, 0) }
    def SphereLight "normalized" { float inputs:radius = 0.1
        bool inputs:normalize = true
        float inputs:intensity = 8 }
    def SphereLight "spot" (prepend apiSchemas = ["ShapingAPI"]) { float inputs:shaping:cone:angle = 30
        float inputs:shaping:cone:softness = 0.5
        bool inputs:shadow:enable = false }
    def DistantLight "sun" { float inputs:intensity = 2
        bool inputs:normalize = true
        float inputs:angle = 1 }
    def DistantLight "disc" { float inputs:intensity = 2
        float inputs:angle = 60 }
    def DomeLight "dome" { float inputs:intensity = 0.5
        asset inputs:texture:file = @sky.exr@ }
    "#;
    let scene = read(&format!("{}{lights}", mesh_with(""))).unwrap();
    let intensity = |light: usize| scene.lights[light].intensity.at(0.0);
    assert!((intensity(0) - 6.0 * PI * 0.01).abs() < 1e-6, "{}", intensity(0));
    assert_eq!(scene.lights[0].color, [1.0, 0.5, 0.0]);
    assert!((intensity(1) - 2.0).abs() < 1e-6);
    let LightKind::Spot { inner, outer, radius, .. } = scene.lights[2].kind else { panic!("a spot") };
    assert!((inner - 15f32.to_radians()).abs() < 1e-6 && (outer - 30f32.to_radians()).abs() < 1e-6);
    assert_eq!((radius, scene.lights[2].casts_shadows), (0.5, false));
    assert_eq!((intensity(3), scene.lights[3].kind), (2.0, LightKind::Distant { angle: 1.0 }));
    assert!((intensity(4) - 2.0 * PI * 0.25).abs() < 1e-6);
    let dome = scene.environment.as_ref().unwrap();
    assert_eq!((dome.color, dome.image), ([0.5; 3], Some(0)));
    // The middle of USD's image lies along +z.
    assert!((dome.to_world.matrix3.z_axis.z + 1.0).abs() < 1e-12);
}

#[test]
fn materials_are_bound_to_meshes_and_subsets() {
    let text = format!(
        r#"def Scope "Looks" {{
    def Material "Red" {{
        token outputs:surface.connect = </Looks/Red/S.outputs:surface>
        color3f inputs:tint = (0.8, 0.1, 0.1)
        def Shader "S" {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </Looks/Red.inputs:tint>
            float inputs:roughness = 0.25
            float inputs:opacityThreshold = 0.5
            token outputs:surface
        }}
    }}
    def Material "Wood" {{
        token outputs:surface.connect = </Looks/Wood/S.outputs:surface>
        def Shader "S" {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </Looks/Wood/T.outputs:rgb>
            token outputs:surface
        }}
        def Shader "T" {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @wood.png@
            token inputs:wrapS = "repeat"
            float2 inputs:st.connect = </Looks/Wood/X.outputs:result>
            float3 outputs:rgb
        }}
        def Shader "X" {{
            uniform token info:id = "UsdTransform2d"
            float2 inputs:scale = (2, 3)
            float2 inputs:translation = (0.25, 0.5)
            float2 inputs:in.connect = </Looks/Wood/R.outputs:result>
            float2 outputs:result
        }}
        def Shader "R" {{
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "uv"
            float2 outputs:result
        }}
    }}
}}
def Xform "World" {{
    rel material:binding = </Looks/Red>
    def Mesh "Mesh" {{
{FACES}
        texCoord2f[] primvars:uv = [(0,0),(1,0),(2,0),(3,0),(4,0)] (interpolation = "vertex")
        def GeomSubset "top" {{
            uniform token elementType = "face"
            uniform token familyName = "materialBind"
            int[] indices = [1]
            rel material:binding = </Looks/Wood>
        }}
    }}
}}
def Mesh "Plain" {{
{FACES}
    color3f[] primvars:displayColor = [(0.5, 0.25, 0)]
}}
"#
    );
    let scene = read(&text).unwrap();
    assert_eq!(scene.warnings, []);
    let mesh = &scene.meshes[0];
    assert_eq!(
        (mesh.slots.as_slice(), &mesh.face_slots),
        (["Mesh".to_owned(), "top".to_owned()].as_slice(), &vec![0, 1])
    );
    assert_eq!(mesh.control_mesh.face_varying[0].values[4], [4.0, 0.0]);
    let of = |instance: usize, slot: usize| &scene.materials[scene.instances[instance].materials[slot].unwrap()];
    let red = of(0, 0);
    assert_eq!((red.name.as_str(), red.base_color, red.roughness), ("Red", [0.8, 0.1, 0.1], 0.25));
    assert_eq!(red.alpha, AlphaMode::Mask(0.5));
    let texture = of(0, 1).base_color_texture.as_ref().unwrap();
    assert_eq!(texture.transform, [[2.0, 0.0, 0.25], [0.0, -3.0, 0.5]]);
    assert!(texture.is_srgb);
    assert_eq!(scene.textures[texture.texture].wrap, [Wrap::Repeat, Wrap::Black]);
    assert_eq!(scene.images[0].name, "wood.png");
    assert_eq!(of(1, 0).base_color, [0.5, 0.25, 0.0]);
}

/// The first material of a quad that is bound to one with these inputs, these texture inputs and these of its coordinates.
fn surface(inputs: &str, texture: &str, coordinates: &str) -> Scene {
    let text = format!(
        r#"def Material "M" {{
    token outputs:surface.connect = </M/S.outputs:surface>
    def Shader "S" {{
        uniform token info:id = "UsdPreviewSurface"
        token outputs:surface
        {inputs}
    }}
    def Shader "T" {{
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @wood.png@
        float2 inputs:st.connect = </M/X.outputs:result>
        float outputs:r
        float outputs:g
        float outputs:b
        float outputs:a
        float3 outputs:rgb
        {texture}
    }}
    def Shader "X" {{
        uniform token info:id = "UsdTransform2d"
        float2 inputs:in.connect = </M/R.outputs:result>
        float2 outputs:result
        {coordinates}
    }}
    def Shader "R" {{
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }}
}}
{}"#,
        mesh_with("        rel material:binding = </M>")
    );
    let scene = read(&text).unwrap();
    assert_eq!(scene.warnings, []);
    scene
}

#[test]
fn textures_are_scaled_then_turned_then_moved_and_turned_over() {
    let scene = surface(
        "color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>",
        "",
        "float inputs:rotation = 90\n float2 inputs:scale = (2, 3)\n float2 inputs:translation = (0.25, 0.125)",
    );
    let [s, t] = scene.materials[0].base_color_texture.as_ref().unwrap().transform;
    let at = |u: f32, v: f32| [s, t].map(|[a, b, c]| a * u + b * v + c);
    // (2u, 3v) turned counter-clockwise is (-3v, 2u); images run down from t = 1.
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.25, 0.5)] {
        let expected = [0.25 - 3.0 * v, 1.0 - (0.125 + 2.0 * u)];
        assert!(
            at(u, v).iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6),
            "{:?}",
            at(u, v)
        );
    }
}

#[test]
fn channels_factors_and_colour_spaces_of_textures_are_kept() {
    let inputs = "color3f inputs:emissiveColor.connect = </M/T.outputs:rgb>
        float inputs:metallic.connect = </M/T.outputs:g>
        float inputs:roughness.connect = </M/T.outputs:b>
        float inputs:opacity.connect = </M/T.outputs:a>
        float inputs:occlusion.connect = </M/T.outputs:r>
        normal3f inputs:normal.connect = </M/T.outputs:rgb>";
    let factors = "float4 inputs:scale = (2, 3, 4, 5)\n float4 inputs:bias = (-1, -2, -3, -4)";
    for (space, [color, data]) in [("auto", [true, false]), ("raw", [false, false]), ("sRGB", [true, true])] {
        let scene = surface(inputs, &format!("{factors}\n token inputs:sourceColorSpace = \"{space}\""), "");
        let material = &scene.materials[0];
        let told = |texture: &Option<TextureRef>| {
            let texture = texture.as_ref().unwrap();
            assert_eq!((texture.scale, texture.bias), ([2.0, 3.0, 4.0, 5.0], [-1.0, -2.0, -3.0, -4.0]));
            (texture.channel, texture.is_srgb)
        };
        assert_eq!(told(&material.emissive_texture), (0, color), "{space}");
        assert_eq!(told(&material.metallic_texture), (1, data), "{space}");
        assert_eq!(told(&material.roughness_texture), (2, data), "{space}");
        assert_eq!(told(&material.opacity_texture), (3, data), "{space}");
        assert_eq!(told(&material.occlusion_texture), (0, data), "{space}");
        assert_eq!(told(&material.normal_texture), (0, data), "{space}");
        // A texture stands instead of its factor.
        assert_eq!(
            (material.emissive, material.metallic, material.roughness, material.opacity),
            ([1.0; 3], 1.0, 1.0, 1.0)
        );
        assert_eq!(material.alpha, AlphaMode::Blend);
    }
}

#[test]
fn inputs_of_a_surface_are_its_material_s_factors() {
    let of = |inputs: &str| surface(inputs, "", "").materials.remove(0);
    let plain = of("color3f inputs:emissiveColor = (1, 2, 3)
        float inputs:metallic = 0.25
        float inputs:roughness = 0.75
        float inputs:ior = 1.25
        float inputs:clearcoat = 0.5
        float inputs:clearcoatRoughness = 0.375
        float inputs:opacity = 0.625");
    assert_eq!((plain.emissive, plain.metallic, plain.roughness), ([1.0, 2.0, 3.0], 0.25, 0.75));
    assert_eq!((plain.ior, plain.clearcoat, plain.clearcoat_roughness), (1.25, 0.5, 0.375));
    assert_eq!((plain.opacity, plain.alpha, plain.specular), (0.625, AlphaMode::Blend, None));
    let specular = of("int inputs:useSpecularWorkflow = 1
        color3f inputs:specularColor = (0.5, 0.25, 0.125)
        float inputs:metallic = 1");
    assert_eq!((specular.specular, specular.metallic), (Some([0.5, 0.25, 0.125]), 0.0));
    assert_eq!((specular.alpha, of("").alpha), (AlphaMode::Opaque, AlphaMode::Opaque));
}

#[test]
fn a_dome_turns_with_what_it_stands_on() {
    let dome = r#"def DomeLight "dome" {
        double xformOp:rotateY = 90
        uniform token[] xformOpOrder = ["xformOp:rotateY"] }"#;
    let scene = read(&format!("{}{dome}", mesh_with(""))).unwrap();
    // The middle of the image, ours along -z, lay along +z: it is turned to +x.
    let middle = scene.environment.unwrap().to_world.transform_vector3(DVec3::NEG_Z);
    assert!((middle - DVec3::X).length() < 1e-12, "{middle}");
}
