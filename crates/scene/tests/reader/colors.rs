//! Colours of vertices: three numbers after a position, and the tag that says what lies between.
use crate::common::{CUBE, assert_refused, read};
use planish_subdiv::mesh::{VertexColors, VertexInterpolation};

const COLORED: &str = "v 0 0 0 1 0.5 0.25\nv 1 0 0 -2 3e1 0\nv 0 1 0 0 0 0 # black\nf 1 2 3\n";

/// The colours of a file, and what it is warned of.
fn colors(text: &str) -> (Option<VertexColors>, Vec<String>) {
    let mut scene = read(text).unwrap();
    let mesh = scene.meshes.remove(0).control_mesh;
    mesh.validate().unwrap();
    (mesh.colors, scene.warnings.iter().map(ToString::to_string).collect())
}

#[test]
fn three_numbers_after_a_position_are_a_colour_of_any_size() {
    let (found, warnings) = colors(COLORED);
    let values = vec![[1.0, 0.5, 0.25], [-2.0, 30.0, 0.0], [0.0; 3]];
    assert_eq!(found, Some(VertexColors { values, interpolation: VertexInterpolation::Vertex }));
    assert!(warnings.is_empty());
}

#[test]
fn meshes_without_a_colour_have_none() {
    assert_eq!(colors(CUBE), (None, vec![]));
}

#[test]
fn vertices_without_a_colour_among_others_are_white_with_one_warning() {
    let white = [1.0; 3];
    let (found, warnings) = colors("v 0 0 0\nv 1 0 0 1\nv 0 1 0 0 0.5 0\nv 1 1 0\nf 1 2 4 3\n");
    assert_eq!(found.unwrap().values, [white, white, [0.0, 0.5, 0.0], white]);
    assert_eq!(warnings, ["3 of 4 vertices have no colour: white"]);
}

#[test]
fn colorinterpolation_chooses_what_lies_between() {
    use VertexInterpolation::{Varying, Vertex};
    for (tags, expected) in [("0", Vertex), ("1", Varying), ("1\nt colorinterpolation 1/0/0 0", Vertex)] {
        let (found, warnings) = colors(&format!("t colorinterpolation 1/0/0 {tags}\n{COLORED}"));
        assert_eq!((found.unwrap().interpolation, warnings), (expected, vec![]));
    }
}

#[test]
fn colorinterpolation_of_nothing_is_ignored_with_a_warning() {
    let (found, warnings) = colors(&format!("{CUBE}t colorinterpolation 1/0/0 1\n"));
    assert_eq!(found, None);
    assert_eq!(warnings, ["line 15: colour interpolation, but no vertex has a colour: ignored"]);
}

#[test]
fn colours_that_are_no_finite_numbers_are_refused() {
    assert_refused("v 0 0 0 1 red 0\n", "line 1: found `red`, expected a number");
    for value in ["nan", "-inf", "1e400", "4e38"] {
        let message = format!("line 1: found `{value}`, expected a finite colour within 32-bit floating point");
        assert_refused(format!("v 0 0 0 0 0 {value}\n"), &message);
    }
}

#[test]
fn colorinterpolation_with_unfitting_values_is_refused() {
    let refused = |tag: &str, message: &str| assert_refused(format!("{COLORED}{tag}\n"), &format!("line 5: {message}"));
    refused("t colorinterpolation 1/0/0 2", "found colour interpolation 2, expected 0 or 1");
    refused("t colorinterpolation 1/0/0 -1", "found colour interpolation -1, expected 0 or 1");
    refused("t colorinterpolation 2/0/0 0 1", "found a tag with 2/0/0 values, expected 1/0/0");
    refused("t colorinterpolation 0/0/1 varying", "found a tag with 0/0/1 values, expected 1/0/0");
}
