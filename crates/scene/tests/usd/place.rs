//! Prims become nodes: ops, visibility, purpose, time and the world's axes.
use glam::{DVec3, Vec3};
use planish_scene::Scene;

use crate::common::{FACES, read};

fn stage(head: &str, world: &str, mesh: &str) -> Scene {
    let text = format!("({head})\ndef Xform \"World\" {{\n{world}\ndef Mesh \"Mesh\" {{\n{FACES}{mesh}\n}}\n}}\n");
    read(&text).unwrap()
}

fn at(scene: &Scene, time: f64, point: Vec3) -> Vec3 {
    scene.pose(time).instances[0].transform.transform_point3(point)
}

fn assert_near(found: Vec3, expected: [f32; 3]) {
    assert!((found - Vec3::from(expected)).length() < 1e-5, "{found}, expected {expected:?}");
}

#[test]
fn ops_apply_last_first() {
    let scene = stage(
        "",
        r#"double3 xformOp:translate = (1, 2, 3)
        uniform token[] xformOpOrder = ["xformOp:translate"]"#,
        r#"float3 xformOp:rotateXYZ = (90, 0, 90)
        half3 xformOp:scale = (2, 2, 2)
        float3 xformOp:translate:pivot = (1, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate:pivot", "xformOp:rotateXYZ", "xformOp:scale", "!invert!xformOp:translate:pivot"]"#,
    );
    // (1, 1, 0) less the pivot is (0, 1, 0), scaled (0, 2, 0), about x (0, 0, 2), about z the same.
    assert_near(at(&scene, 0.0, Vec3::new(1.0, 1.0, 0.0)), [2.0, 2.0, 5.0]);
    assert_eq!(scene.nodes[1].name, "/World/Mesh");
}

#[test]
fn matrices_and_quaternions_are_read_as_rows_and_real_part_first() {
    let scene = stage(
        "",
        r#"matrix4d xformOp:transform = ((0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), (5, 6, 7, 1))
        uniform token[] xformOpOrder = ["xformOp:transform"]"#,
        r#"quatf xformOp:orient = (0.70710678, 0.70710678, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:orient"]"#,
    );
    // About x by 90 degrees (0, 1, 0) becomes (0, 0, 1); the matrix turns about z.
    assert_near(at(&scene, 0.0, Vec3::Y), [5.0, 6.0, 8.0]);
    assert_near(at(&scene, 0.0, Vec3::X), [5.0, 7.0, 7.0]);
}

#[test]
fn a_reset_stack_stands_in_the_world_but_stays_hidden_with_its_parents() {
    let scene = stage(
        "",
        r#"double3 xformOp:translate = (1, 2, 3)
        token visibility.timeSamples = { 0: "inherited", 24: "invisible" }
        uniform token[] xformOpOrder = ["xformOp:translate"]"#,
        r#"double xformOp:rotateZ = 90
        uniform token[] xformOpOrder = ["!resetXformStack!", "xformOp:rotateZ"]"#,
    );
    assert_near(at(&scene, 0.0, Vec3::X), [0.0, 1.0, 0.0]);
    let seen = |time: f64| scene.pose(time).instances[0].is_visible;
    assert_eq!((seen(0.5), seen(1.0)), (true, false));
}

#[test]
fn time_codes_are_seconds_by_their_rate() {
    let world = r#"double3 xformOp:translate.timeSamples = { 10: (0, 0, 0), 20: (10, 0, 0) }
        uniform token[] xformOpOrder = ["xformOp:translate"]"#;
    let scene = stage("timeCodesPerSecond = 10\nframesPerSecond = 5", world, "");
    assert_eq!((scene.time_range, scene.frames_per_second), (Some([1.0, 2.0]), Some(5.0)));
    assert_near(at(&scene, 1.25, Vec3::ZERO), [2.5, 0.0, 0.0]);
    let range = stage("startTimeCode = 12\nendTimeCode = 36", world, "").time_range;
    assert_eq!(range, Some([0.5, 1.5]));
    assert_eq!(stage("", "", "").time_range, None);
}

#[test]
fn z_upwards_becomes_y_upwards() {
    let scene = stage("upAxis = \"Z\"", "", "");
    assert_eq!(at(&scene, 0.0, Vec3::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 3.0, -2.0));
    assert_eq!(scene.instances[0].transform, scene.pose(0.0).instances[0].transform);
    assert_eq!(scene.nodes[0].local(0.0).matrix3.determinant(), 1.0);
    assert_eq!(scene.nodes[0].local(0.0).translation, DVec3::ZERO);
}

#[test]
fn guides_proxies_and_what_is_inactive_are_left_out() {
    let mesh = |name: &str, lines: &str, meta: &str| format!("def Mesh \"{name}\" {meta} {{\n{FACES}{lines}\n}}\n");
    let text = [
        mesh("a", "uniform token purpose = \"guide\"", ""),
        mesh("b", "uniform token purpose = \"proxy\"", ""),
        mesh("c", "uniform token purpose = \"render\"", ""),
        mesh("d", "", "(active = false)"),
        mesh("e", "", ""),
        format!("class \"f\" {{\n{}}}", mesh("g", "", "")),
    ];
    let scene = read(&text.concat()).unwrap();
    let names: Vec<&str> = scene.instances.iter().map(|instance| instance.name.as_str()).collect();
    assert_eq!(names, ["/c", "/e"]);
}

#[test]
fn moving_points_are_a_deformation() {
    let points = "point3f[] points.timeSamples = { 0: [(0,0,0),(1,0,0),(1,1,0)], 24: [(0,0,2),(1,0,0),(1,1,0)] }";
    let text =
        format!("def Mesh \"m\" {{\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n{points}\n}}");
    let scene = read(&text).unwrap();
    assert_eq!(scene.posed_positions(0, &scene.pose(0.5))[0], [0.0, 0.0, 1.0]);
    assert_eq!(scene.meshes[0].control_mesh.positions[0], [0.0; 3]);
}
