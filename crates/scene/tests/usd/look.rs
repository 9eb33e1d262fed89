//! Cameras, lights and materials.
use planish_scene::{AlphaMode, LightKind, Wrap};

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
