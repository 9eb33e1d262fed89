//! Instances, point instancers and skeletons.
use glam::Vec3;

use crate::common::{FACES, assert_refused, mesh_with, read};

#[test]
fn instances_share_a_mesh() {
    let text = format!(
        r#"class "Proto" {{ def Mesh "Mesh" {{
{FACES}
}} }}
def Xform "a" (instanceable = true prepend inherits = </Proto>) {{ }}
def Xform "b" (instanceable = true
    prepend inherits = </Proto>) {{
    double3 xformOp:translate = (1, 2, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
"#
    )
    .replace("instanceable = true prepend", "instanceable = true\n    prepend");
    let scene = read(&text).unwrap();
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    let translations: Vec<Vec3> = scene.instances.iter().map(|i| i.transform.translation.into()).collect();
    assert_eq!(translations, [Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)]);
}

#[test]
fn point_instancers_place_their_prototypes() {
    let text = format!(
        r#"def PointInstancer "points" {{
    rel prototypes = [</points/A>]
    int[] protoIndices = [0, 0, 0]
    point3f[] positions = [(0, 0, 0), (5, 0, 0), (0, 0, 7)]
    float3[] scales = [(1, 1, 1), (2, 2, 2), (1, 1, 1)]
    int64[] invisibleIds = [2]
    def Xform "A" {{
        double3 xformOp:translate = (0, 1, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Mesh "Mesh" {{
{FACES}
        }}
    }}
}}
"#
    );
    let scene = read(&text).unwrap();
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    assert_eq!(scene.instances[1].name, "/points[1]/A/Mesh");
    assert_eq!(scene.instances[1].transform.transform_point3(Vec3::X), Vec3::new(7.0, 2.0, 0.0));
    assert_refused(&text.replace("[0, 0, 0]", "[0, 1, 0]"), "/points.protoIndices: found prototype 1, expected 0 to 0");
}

/// A mesh of five vertices on two joints of which the second turns about z by 90 degrees in a second.
const SKELETON: &str = r#"def SkelRoot "root" {
    double3 xformOp:translate = (10, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    rel skel:skeleton = </root/skeleton>
    def Skeleton "skeleton" {
        uniform token[] joints = ["a", "a/b"]
        uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(1,0,0,1))]
        uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(1,0,0,1))]
        rel skel:animationSource = </root/skeleton/animation>
        def SkelAnimation "animation" {
            uniform token[] joints = ["a/b"]
            float3[] translations = [(1, 0, 0)]
            half3[] scales = [(1, 1, 1)]
            quatf[] rotations.timeSamples = { 0: [(1, 0, 0, 0)], 24: [(0.70710678, 0, 0, 0.70710678)] }
            uniform token[] blendShapes = ["other", "up"]
            float[] blendShapeWeights.timeSamples = { 0: [1, 0], 24: [1, 1] }
        }
    }
    def Mesh "Mesh" {
        FACES
        int[] primvars:skel:jointIndices = [0, 0, 1, 0, 0, 1, 0, 0, 1, 0] (elementSize = 2
            interpolation = "vertex")
        float[] primvars:skel:jointWeights = [1, 0, 2, 0, 0.5, 0.5, 1, 0, 1, 0] (elementSize = 2
            interpolation = "vertex")
        uniform token[] skel:blendShapes = ["up"]
        rel skel:blendShapeTargets = </root/Mesh/up>
        def BlendShape "up" {
            uniform vector3f[] offsets = [(0, 0, 4)]
            uniform int[] pointIndices = [3]
        }
    }
}
"#;

#[test]
fn joints_move_what_hangs_on_them() {
    let scene = read(&SKELETON.replace("FACES", FACES)).unwrap();
    assert_eq!(scene.warnings, []);
    let world = |time: f64, vertex: usize| {
        let pose = scene.pose(time);
        let position = scene.posed_positions(0, &pose)[vertex];
        pose.instances[0].transform.transform_point3(Vec3::from(position))
    };
    let near = |a: Vec3, b: [f32; 3]| assert!((a - Vec3::from(b)).length() < 1e-5, "{a}, expected {b:?}");
    near(world(0.0, 4), [12.0, 0.1, 0.0]);
    // (2, 0.1) is (1, 0.1) from the joint at (1, 0).
    near(world(1.0, 4), [10.9, 1.0, 0.0]);
    // (1, 1) hangs on both by halves: (1, 1) and (0, 0).
    near(world(1.0, 2), [10.5, 0.5, 0.0]);
    near(world(1.0, 3), [10.0, 1.0, 4.0]);
    near(world(0.5, 3), [10.0, 1.0, 2.0]);
}

#[test]
fn influences_of_joints_that_do_not_exist_are_refused() {
    let text =
        SKELETON.replace("FACES", FACES).replace("[0, 0, 1, 0, 0, 1, 0, 0, 1, 0]", "[0, 0, 2, 0, 0, 1, 0, 0, 1, 0]");
    assert_refused(&text, "/root/Mesh.primvars:skel:jointIndices: found joint 2, expected 0 to 1");
}

/// Asserts that a stage is refused for a layer, with the path where it was looked for.
fn assert_missing(text: &str, place: &str) {
    let error = read(text).expect_err("the stage should be refused").to_string();
    let expected = format!("missing.usda@, named by {place} of name.usda: found nothing, expected a layer");
    assert!(error.contains("name.usda: @") && error.ends_with(&expected), "{error}");
}

#[test]
fn layers_and_cycles_are_composed_or_named() {
    let with = |lines: &str| format!("{}{lines}\n", mesh_with(""));
    let missing = with("def \"x\" (prepend references = @missing.usda@) {}");
    assert_missing(&missing, "/x");
    let missing = with("def \"x\" (payload = @missing.usda@</a>) {}");
    assert_missing(&missing, "/x");
    let missing = format!("(subLayers = [@missing.usda@])\n{}", mesh_with(""));
    assert_missing(&missing, "subLayers");
    for cycle in [
        with("def \"a\" (prepend references = </a/b>) { def \"b\" (prepend references = </a>) {} }"),
        with("def \"a\" (prepend references = @name.usda@</a>) {}"),
        format!("(subLayers = [@name.usda@])\n{}", mesh_with("")),
    ] {
        let warnings = read(&cycle).unwrap().warnings;
        assert!(warnings.iter().any(|warning| warning.text.contains("cycle")), "{warnings:?}");
    }
}
