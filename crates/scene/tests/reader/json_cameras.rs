//! Cameras and camera paths of scene files.
use glam::Vec3;
use planish_scene::{Lens, Scene};

use crate::common::{assert_scene_refused, scene};

/// A cube with further lists.
fn text(lists: &str) -> String {
    format!(
        r#"{{ "meshes": [{{ "name": "cube", "file": "cube.obj" }}], "instances": [{{ "mesh": "cube" }}], {lists} }}"#
    )
}

fn scene_with(lists: &str) -> Scene {
    scene(&text(lists)).unwrap()
}

#[test]
fn cameras_are_those_of_the_file_with_the_scenes_near_plane() {
    let scene = scene_with(
        r#""cameras": [{ "name": "front", "eye": [0, 0, 9], "target": [0, 0, 0], "fov": 30 },
        { "name": "tilted", "eye": [9, 0, 0], "target": [0, 0, 0], "up": [0, 1, 1], "fov": 60.5 },
        { "name": "above", "eye": [0, 9, 0], "target": [0, 0, 0], "fov": 30 }]"#,
    );
    assert_eq!(scene.camera(None).unwrap().name, "front");
    let tilted = scene.camera(Some("tilted")).unwrap();
    assert_eq!((tilted.eye, tilted.target, tilted.up), (Vec3::X * 9.0, Vec3::ZERO, Vec3::new(0.0, 1.0, 1.0)));
    assert_eq!(tilted.fov_y_degrees, 60.5);
    // The cube's diagonal is 2 sqrt 3.
    assert!((tilted.near - 2e-4 * 3f32.sqrt()).abs() < 1e-9);
    assert_eq!(scene.camera(Some("above")).unwrap().up, Vec3::NEG_Z);
}

#[test]
fn a_camera_has_the_lens_of_the_file() {
    let camera = |lens: &str| {
        format!(r#""cameras": [{{ "name": "a", "eye": [0, 0, 9], "target": [0, 0, 0], "fov": 30{lens} }}]"#)
    };
    let lens = |text: &str| scene_with(&camera(text)).cameras[0].lens;
    assert_eq!(lens(r#", "lens": { "radius": 0.5, "focus": 8 }"#), Some(Lens { radius: 0.5, focus_distance: 8.0 }));
    assert_eq!(lens(""), None);
    let bad = text(&camera(r#", "lens": { "radius": -1, "focus": 8 }"#));
    let expected =
        "cameras[0]: found a lens of radius -1 focused at 8, expected a radius of 0 or more and a distance above 0";
    assert_scene_refused(&bad, expected);
}

#[test]
fn paths_are_those_of_the_file() {
    let scene = scene_with(
        r#""paths": [{ "name": "p", "frames": 5, "keys": [{ "eye": [0, 0, 4], "target": [0, 0, 0] },
        { "eye": [0, 0, 8], "target": [0, 2, 0] }] }, { "name": "q", "fov": 20, "frames": 1,
        "keys": [{ "eye": [0, 0, 4], "target": [0, 0, 0] }, { "eye": [0, 0, 8], "target": [0, 2, 0] }] }]"#,
    );
    let path = scene.path("p").unwrap();
    assert_eq!((path.frame_count(), path.keys().len()), (5, 2));
    let middle = path.camera(2);
    assert_eq!((middle.eye, middle.target, middle.fov_y_degrees), (Vec3::Z * 6.0, Vec3::Y, 45.0));
    assert_eq!(scene.path("q").unwrap().camera(0).fov_y_degrees, 20.0);
    let unknown = scene.path("r").unwrap_err().to_string();
    assert_eq!(unknown, "camera path: found the name \"r\", expected one of \"p\", \"q\"");
    let none = scene_with(r#""paths": []"#).path("r").unwrap_err().to_string();
    assert_eq!(none, "camera path: found the name \"r\", expected no name: the scene has no camera paths");
}

#[test]
fn cameras_that_see_nothing_are_refused_with_their_element() {
    let camera = |fields: &str| text(&format!(r#""cameras": [{{ "name": "a", {fields} }}]"#));
    let at_target = camera(r#""eye": [1, 1, 1], "target": [1, 1, 1], "fov": 30"#);
    let expected = "cameras[0]: found eye and target both [1, 1, 1], expected two different points";
    assert_scene_refused(&at_target, expected);
    let wide = camera(r#""eye": [1, 1, 1], "target": [1, 1, 0], "fov": 180"#);
    let expected = "cameras[0]: found a field of view of 180 degrees, expected more than 0 and less than 180";
    assert_scene_refused(&wide, expected);
    let far = scene(&camera(r#""eye": [1e39, 1, 1], "target": [1, 1, 0], "fov": 30"#)).unwrap_err().to_string();
    assert!(far.contains("cameras[0]: found eye [inf, 1, 1]") && far.ends_with("expected finite coordinates"), "{far}");
    let up = camera(r#""eye": [1, 1, 1], "target": [1, 1, 0], "up": [0, 0, 2], "fov": 30"#);
    let expected = "cameras[0]: found up [0, 0, 2] along the line of sight, expected an up direction across it";
    assert_scene_refused(&up, expected);
}

#[test]
fn paths_that_are_none_are_refused_with_their_element() {
    let key = r#"{ "eye": [0, 0, 4], "target": [0, 0, 0] }"#;
    let path = |frames: &str, keys: &str| {
        text(&format!(r#""paths": [{{ "name": "a", "frames": {frames}, "keys": [{keys}] }}]"#))
    };
    assert_scene_refused(&path("3", key), "paths[0]: found 1 keys, expected 2 or more");
    let two = format!("{key}, {key}");
    assert_scene_refused(&path("0", &two), "paths[0]: found 0 frames, expected 1 to 1,000,000");
    assert_scene_refused(&path("4000000000", &two), "paths[0]: found 4000000000 frames, expected 1 to 1,000,000");
    let through = format!(r#"{key}, {{ "eye": [0, 0, -4], "target": [0, 0, 0] }}"#);
    let expected = "paths[0]: found eye and target both [0, 0, 0] in frame 1, expected two different points";
    assert_scene_refused(&path("3", &through), expected);
}

#[test]
fn names_of_cameras_and_of_paths_differ_among_themselves() {
    let camera = r#"{ "name": "a", "eye": [0, 0, 9], "target": [0, 0, 0], "fov": 30 }"#;
    let key = r#"{ "eye": [0, 0, 4], "target": [0, 0, 0] }"#;
    let path = format!(r#"{{ "name": "a", "frames": 2, "keys": [{key}, {key}] }}"#);
    scene_with(&format!(r#""cameras": [{camera}], "paths": [{path}]"#));
    let cameras = text(&format!(r#""cameras": [{camera}, {camera}]"#));
    assert_scene_refused(&cameras, "cameras[1].name: found `a` again, expected different names");
    let paths = text(&format!(r#""paths": [{path}, {path}]"#));
    assert_scene_refused(&paths, "paths[1].name: found `a` again, expected different names");
}
