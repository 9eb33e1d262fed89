//! Scene files of JSON: what they may look like, and what is refused in which words.
use crate::common::{CUBE, assert_scene_refused, scene, scene_folder, scene_in, scene_of};
use planish_scene::{LoadOptions, load, read_json};

#[test]
fn meshes_are_read_from_the_scene_files_folder_and_named_by_it() {
    let scene = scene(
        r#"{ "meshes": [{ "name": "a", "file": "cube.obj" }, { "name": "b", "file": "sub/strip.OBJ" }],
        "instances": [{ "mesh": "b" }, { "mesh": "a", "name": "first" }, { "mesh": "b" }] }"#,
    )
    .unwrap();
    assert_eq!((scene.name.as_str(), scene.meshes.len()), ("scene", 2));
    assert_eq!(scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    assert_eq!(scene.meshes[0].control_mesh.face_sizes.len(), 6);
    let instances: Vec<_> = scene.instances.iter().map(|instance| (instance.name.as_str(), instance.mesh)).collect();
    assert_eq!(instances, [("b", 1), ("first", 0), ("b", 1)]);
    assert_eq!((scene.cameras.len(), scene.paths.len(), scene.warnings), (0, 0, vec![]));
}

#[test]
fn a_file_with_two_names_is_read_once() {
    let scene = scene(
        r#"{ "meshes": [{ "name": "a", "file": "cube.obj" }, { "name": "b", "file": "./sub/../cube.obj" },
        { "name": "c", "file": "sub/strip.OBJ" }], "instances": [{ "mesh": "c" }, { "mesh": "b" }, { "mesh": "a" }] }"#,
    )
    .unwrap();
    assert_eq!(scene.meshes.len(), 2);
    assert_eq!(scene.instances.iter().map(|instance| instance.mesh).collect::<Vec<_>>(), [1, 0, 0]);
    assert_eq!((scene.instances[1].name.as_str(), scene.meshes[0].name.as_str()), ("b", "a"));
}

#[test]
fn scene_files_are_loaded_whatever_the_case_of_their_extension() {
    let folder = scene_folder();
    for name in ["s.json", "s.JSON"] {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("\u{feff}{}", scene_of(r#"{ "mesh": "cube" }"#))).unwrap();
        let scene = load(&path, &LoadOptions::default()).unwrap();
        assert_eq!((scene.name.as_str(), scene.instances.len()), ("s", 1));
    }
}

#[test]
fn repair_applies_to_the_meshes_and_their_warnings_name_the_file() {
    let folder = scene_folder();
    std::fs::write(folder.path().join("cube.obj"), format!("{CUBE}f 1 1 2\n")).unwrap();
    let text = scene_of(r#"{ "mesh": "cube" }"#);
    let strict = scene_in(&folder, &text).unwrap_err().to_string();
    let fault = "cube.obj: line 15: found a face with vertex 1 twice, expected different vertices";
    assert!(strict.contains("scene.json: meshes[0].file: ") && strict.ends_with(fault), "{strict}");
    let path = folder.path().join("scene.json");
    let scene = read_json(path, text.as_bytes(), &LoadOptions { repair: true, ..LoadOptions::default() }).unwrap();
    assert_eq!(scene.meshes[0].control_mesh.face_sizes.len(), 6);
    let warning = scene.warnings[0].to_string();
    assert!(warning.ends_with("cube.obj: line 15: a face with vertex 1 twice: dropped"), "{warning}");
}

#[test]
fn a_mesh_without_an_instance_is_warned_of() {
    let scene = scene(
        r#"{ "comment": "x", "meshes": [{ "name": "a", "file": "cube.obj" }, { "name": "b", "file": "sub/strip.OBJ" }],
        "instances": [{ "mesh": "b" }] }"#,
    )
    .unwrap();
    assert_eq!(scene.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(), ["mesh `a` has no instance"]);
}

#[test]
fn text_that_is_not_json_is_refused_with_its_place() {
    let not = |message: &str| format!("found {message}, expected a scene file of JSON");
    assert_scene_refused("", &format!("line 1, column 0: {}", not("EOF while parsing a value")));
    assert_scene_refused("{\n  \"meshes\": [,", &format!("line 2, column 14: {}", not("expected value")));
    assert_scene_refused("v 0 0 0", &format!("line 1, column 1: {}", not("expected value")));
    assert_scene_refused(
        &format!("{}x", scene_of(r#"{ "mesh": "cube" }"#)),
        &format!("line 1, column 90: {}", not("trailing characters")),
    );
    assert_scene_refused(
        &scene_of(r#"{ "mesh": "cube", "scale": 1e999 }"#),
        &format!("line 1, column 100: {}", not("number out of range")),
    );
    assert!(scene(&"[".repeat(100_000)).is_err());
    assert!(scene(&format!("{{\"comment\": {}", "[".repeat(100_000))).is_err());
}

#[test]
fn fields_that_are_unknown_missing_or_doubled_are_refused() {
    assert_scene_refused(
        "{\n \"mesh\": []}",
        "line 2, column 7: found unknown field `mesh`, expected one of `comment`, `meshes`, `instances`, `cameras`, `paths`",
    );
    assert_scene_refused(r#"{ "meshes": [] }"#, "line 1, column 16: found no field `instances`, expected one");
    assert_scene_refused(
        r#"{ "meshes": [], "meshes": [] }"#,
        "line 1, column 24: found field `meshes` twice, expected it once",
    );
    for (element, field) in [
        (r#"{ "mesh": "cube", "turn": 1 }"#, "turn"),
        (r#"{ "mesh": "cube", "rotate": { "angle": 1 } }"#, "angle"),
        (r#"{ "mesh": "cube", "array": { "number": 1 } }"#, "number"),
    ] {
        let message = scene(&scene_of(element)).unwrap_err().to_string();
        assert!(message.contains(&format!("found unknown field `{field}`, expected ")), "{message}");
    }
    for list in
        [r#""cameras": [{ "fow": 1 }]"#, r#""paths": [{ "fow": 1 }]"#, r#""paths": [{ "keys": [{ "fow": 1 }] }]"#]
    {
        let message = scene(&format!("{{ {list}, \"meshes\": [], \"instances\": [] }}")).unwrap_err().to_string();
        assert!(message.contains("found unknown field `fow`, expected "), "{message}");
    }
}

#[test]
fn values_of_another_form_are_refused() {
    for (element, message) in [
        (r#"{ "mesh": 3 }"#, "found integer `3`, expected a string"),
        (r#"{ "mesh": "cube", "translate": [1, 2] }"#, "found length 2, expected an array of length 3"),
        (r#"{ "mesh": "cube", "scale": [1, 2] }"#, "found a scale of another form, expected a number or [x, y, z]"),
        (r#"{ "mesh": "cube", "scale": "big" }"#, "found a scale of another form, expected a number or [x, y, z]"),
        (
            r#"{ "mesh": "cube", "array": { "count": [1, -1, 1], "step": [0, 0, 0] } }"#,
            "found integer `-1`, expected u32",
        ),
        (
            r#"{ "mesh": "cube", "array": { "count": [1, 4294967296, 1], "step": [0, 0, 0] } }"#,
            "found integer `4294967296`, expected u32",
        ),
        (
            r#"{ "mesh": "cube", "array": { "count": [1.5, 1, 1], "step": [0, 0, 0] } }"#,
            "found floating point `1.5`, expected u32",
        ),
    ] {
        let found = scene(&scene_of(element)).unwrap_err().to_string();
        assert!(found.contains("line 1, column ") && found.ends_with(message), "{found}");
    }
}

#[test]
fn messages_are_one_line_of_bounded_length_whatever_the_file_quotes() {
    let long = "x".repeat(10_000);
    for text in [
        "{ \"a\\nb\\u001b\": 1 }".to_owned(),
        format!("{{ \"{long}\": 1 }}"),
        scene_of(r#"{ "mesh": "a\nb" }"#),
        scene_of(&format!(r#"{{ "mesh": "{long}" }}"#)),
        r#"{ "meshes": [{ "name": "a", "file": "a\nb.obj" }], "instances": [] }"#.to_owned(),
        format!(r#"{{ "meshes": "{long}", "instances": [] }}"#),
    ] {
        let message = scene(&text).unwrap_err().to_string();
        assert!(!message.contains(char::is_control) && message.len() < 600, "{message}");
    }
    assert_scene_refused(
        "{ \"a\\nb\": 1 }",
        "line 1, column 8: found unknown field `a\\nb`, expected one of `comment`, `meshes`, `instances`, `cameras`, `paths`",
    );
}

#[test]
fn meshes_that_cannot_be_read_are_refused_with_their_element() {
    let refused = |file: &str| {
        let folder = scene_folder();
        let text = format!(
            r#"{{ "meshes": [{{ "name": "cube", "file": "cube.obj" }}, {{ "name": "b", "file": "{file}" }}], "instances": [] }}"#
        );
        let message = scene_in(&folder, &text).unwrap_err().to_string();
        message.replace(&format!("{}/", folder.path().display()), "")
    };
    for file in ["scene.json", "", "cube", "a\\u0000.obj"] {
        let message = refused(file);
        assert!(message.starts_with("scene.json: meshes[1].file: found `"), "{message}");
        assert!(message.ends_with("`, expected the path of an .obj file"), "{message}");
    }
    assert!(
        refused("no.obj").starts_with("scene.json: meshes[1].file: no.obj: cannot be read: "),
        "{}",
        refused("no.obj")
    );
    assert!(refused("folder.obj").starts_with("scene.json: meshes[1].file: folder.obj: found a directory, "));
}

#[test]
fn a_name_twice_is_refused() {
    let mesh = r#"{ "name": "a", "file": "cube.obj" }"#;
    let text = format!(r#"{{ "meshes": [{mesh}, {mesh}], "instances": [] }}"#);
    assert_scene_refused(&text, "meshes[1].name: found `a` again, expected different names");
}

#[test]
fn scenes_of_nothing_are_refused() {
    assert_scene_refused(&scene_of(""), "instances: found none, expected 1 or more");
}
