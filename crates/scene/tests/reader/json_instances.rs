//! Instances of scene files: what their transforms become, arrays, and what is refused.
use glam::{Affine3A, Vec3};
use planish_scene::{Bounds, Instance, MAX_INSTANCES, Scene};

use crate::common::{CUBE, assert_scene_refused, read, scene, scene_of};

fn instances(elements: &str) -> Vec<Instance> {
    scene(&scene_of(elements)).unwrap().instances
}

/// The transform of the one instance that has these further fields.
fn transform(fields: &str) -> Affine3A {
    instances(&element(fields))[0].transform
}

fn element(fields: &str) -> String {
    format!(r#"{{ "mesh": "cube", {fields} }}"#)
}

fn assert_element_refused(fields: &str, message: &str) {
    let text = scene_of(&format!(r#"{{ "mesh": "cube" }}, {}"#, element(fields)));
    assert_scene_refused(&text, &format!("instances[1]{message}"));
}

#[test]
fn an_obj_file_is_one_instance_as_it_stands_with_the_bounds_of_its_points() {
    let scene = read(CUBE).unwrap();
    let identity = Instance::placed("name", 0, Affine3A::IDENTITY);
    assert_eq!(scene.instances, [identity]);
    assert_eq!(scene.bounds(), Bounds::of(scene.meshes[0].control_mesh.positions.iter().copied()));
}

#[test]
fn an_instance_without_fields_stands_as_it_is() {
    assert_eq!(instances(r#"{ "mesh": "cube" }"#)[0].transform, Affine3A::IDENTITY);
    assert_eq!(
        transform(r#""translate": [0, 0, 0], "scale": 1, "rotate": { "axis": [0, 2, 0], "degrees": 0 }"#),
        Affine3A::IDENTITY
    );
}

#[test]
fn scale_comes_first_then_the_turn_then_the_move() {
    let fields = r#""translate": [10, 20, 30], "rotate": { "axis": [0, 0, 5], "degrees": 90 }, "scale": [2, 3, -4]"#;
    let point = transform(fields).transform_point3(Vec3::new(1.0, 1.0, 1.0));
    assert!((point - Vec3::new(10.0 - 3.0, 20.0 + 2.0, 30.0 - 4.0)).length() < 1e-5, "{point}");
    assert!(instances(&element(fields))[0].is_mirrored());
}

#[test]
fn one_scale_is_for_all_axes() {
    assert_eq!(transform(r#""scale": -2.5"#), Affine3A::from_scale(Vec3::splat(-2.5)));
}

#[test]
fn a_matrix_is_three_rows_of_four() {
    let point =
        transform(r#""matrix": [0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30]"#).transform_point3(Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(point, Vec3::new(6.0, 21.0, 33.0));
}

#[test]
fn an_array_counts_its_first_axis_fastest_and_steps_in_the_world() {
    let array = r#""rotate": { "axis": [1, 1, 1], "degrees": 40 }, "translate": [1, 0, 0], "name": "n",
        "array": { "count": [2, 1, 3], "step": [10, 20, -30] }"#;
    let members = instances(&element(array));
    let single = transform(r#""rotate": { "axis": [1, 1, 1], "degrees": 40 }, "translate": [1, 0, 0]"#);
    let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
    assert_eq!(names, ["n[0,0,0]", "n[1,0,0]", "n[0,0,1]", "n[1,0,1]", "n[0,0,2]", "n[1,0,2]"]);
    for (index, member) in members.iter().enumerate() {
        let (i, k) = (index % 2, index / 2);
        assert_eq!(member.transform.matrix3, single.matrix3);
        assert_eq!(Vec3::from(member.transform.translation), Vec3::new(1.0 + 10.0 * i as f32, 0.0, -30.0 * k as f32));
    }
}

#[test]
fn bounds_are_of_all_instances_in_the_world() {
    // The cube is from -1 to 1.
    let elements = r#"{ "mesh": "cube", "translate": [5, 0, 0] }, { "mesh": "cube", "scale": [1, -3, 1], "translate": [0, 1, 0] },
        { "mesh": "cube", "array": { "count": [1, 1, 3], "step": [0, 0, -4] } }"#;
    let bounds = scene(&scene_of(elements)).unwrap().bounds().unwrap();
    assert_eq!((bounds.min.to_array(), bounds.max.to_array()), ([-1.0, -2.0, -9.0], [6.0, 4.0, 1.0]));
    assert_eq!(Scene::default().bounds(), None);
}

#[test]
fn a_mesh_that_stands_nowhere_has_no_bounds() {
    let mut scene = read(CUBE).unwrap();
    scene.instances.clear();
    assert_eq!(scene.bounds(), None);
}

#[test]
fn unknown_meshes_are_refused() {
    let text = scene_of(r#"{ "mesh": "cube" }, { "mesh": "cub" }"#);
    assert_scene_refused(&text, "instances[1].mesh: found `cub`, expected one of \"cube\"");
}

#[test]
fn scales_that_flatten_or_leave_the_range_are_refused() {
    let expected = "expected magnitudes from 1e-9 to 1e9; negative ones mirror";
    assert_element_refused(r#""scale": 0"#, &format!(".scale: found [0.0, 0.0, 0.0], {expected}"));
    assert_element_refused(r#""scale": [1, 0, 1]"#, &format!(".scale: found [1.0, 0.0, 1.0], {expected}"));
    assert_element_refused(
        r#""scale": 2e9"#,
        &format!(".scale: found [2000000000.0, 2000000000.0, 2000000000.0], {expected}"),
    );
    assert!(!transform(r#""scale": -1e-9"#).matrix3.determinant().is_subnormal());
    assert!(transform(r#""scale": 1e9"#).matrix3.determinant().is_finite());
}

#[test]
fn an_axis_is_a_direction_whatever_its_length() {
    assert_element_refused(
        r#""rotate": { "axis": [0, 0, 0], "degrees": 1 }"#,
        ".rotate.axis: found [0.0, 0.0, 0.0], expected a direction",
    );
    let plain = transform(r#""rotate": { "axis": [1, 1, 0], "degrees": 33 }"#);
    for axis in ["[1e308, 1e308, 0]", "[1e-308, 1e-308, 0]"] {
        let other = transform(&format!(r#""rotate": {{ "axis": {axis}, "degrees": 33 }}"#));
        assert!(other.abs_diff_eq(plain, 1e-6), "{axis}");
    }
}

#[test]
fn matrices_that_flatten_are_refused() {
    let one_plane = ".matrix: found columns in one plane, expected columns that span space";
    assert_element_refused(r#""matrix": [1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0]"#, one_plane);
    assert_element_refused(r#""matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0]"#, one_plane);
    // As near to that as a matrix may come.
    let thin = transform(r#""matrix": [1e-9, 1e-9, 0, 0, 0, 1.1e-15, 0, 0, 0, 0, 1e-9, 0]"#);
    assert!(thin.matrix3.determinant().is_normal());
    let lengths = ".matrix: found columns of lengths [1.0, 0.0, 1.0], expected lengths from 1e-9 to 1e9";
    assert_element_refused(r#""matrix": [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0]"#, lengths);
}

#[test]
fn a_matrix_stands_alone() {
    let matrix = r#""matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]"#;
    for (field, value) in
        [("translate", "[0, 0, 0]"), ("scale", "1"), ("rotate", r#"{ "axis": [1, 0, 0], "degrees": 0 }"#)]
    {
        let message = format!(".{field}: found a {field} beside a matrix, expected one or the other");
        assert_element_refused(&format!(r#"{matrix}, "{field}": {value}"#), &message);
    }
    let array = format!(r#"{matrix}, "array": {{ "count": [2, 1, 1], "step": [1, 0, 0] }}"#);
    assert_eq!(instances(&element(&array)).len(), 2);
}

#[test]
fn arrays_of_no_or_too_many_members_are_refused_before_they_are_made() {
    let array = |count: &str| format!(r#""array": {{ "count": {count}, "step": [1, 1, 1] }}"#);
    assert_element_refused(&array("[1, 0, 1]"), ".array.count: found [1, 0, 1], expected 1 or more along each axis");
    let expected = format!("expected at most {MAX_INSTANCES} in all");
    // One instance stands before the array.
    assert_element_refused(
        &array("[100, 100, 100]"),
        &format!(".array.count: found 1000001 instances so far, {expected}"),
    );
    let most = u32::MAX;
    let message = format!(".array.count: found {} instances so far, {expected}", u64::MAX);
    assert_element_refused(&array(&format!("[{most}, {most}, {most}]")), &message);
    assert_eq!(instances(&element(&array("[100, 100, 100]"))).len(), MAX_INSTANCES as usize);
    let one_more = scene_of(&format!(r#"{}, {{ "mesh": "cube" }}"#, element(&array("[100, 100, 100]"))));
    assert_scene_refused(&one_more, &format!("instances[1]: found 1000001 instances so far, {expected}"));
}

#[test]
fn places_beyond_the_range_of_coordinates_are_refused() {
    let far = ": found a place at [0.0, 1e300, 0.0], expected points within 1e36";
    assert_element_refused(r#""translate": [0, 1e300, 0]"#, far);
    assert_element_refused(
        r#""translate": [0, 2e36, 0]"#,
        ": found a point 2.00e36 from the origin, expected points within 1e36",
    );
    let array = r#""array": { "count": [2, 1, 1], "step": [1e37, 0, 0] }"#;
    assert_element_refused(array, ": found a point 1.00e37 from the origin, expected points within 1e36");
}
