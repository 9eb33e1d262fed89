//! Subdivision tags: what they become, what is refused and what is warned of.
use crate::common::{CUBE, assert_refused, cube_with, read, repair, tagged};
use planish_subdiv::mesh::{
    BoundaryInterpolation as Boundary, Corner, Crease, Creasing, FaceVaryingInterpolation as FaceVarying,
    TriangleSubdivision,
};

fn crease(a: u32, b: u32, sharpness: f32) -> Crease {
    Crease { vertices: [a, b], sharpness }
}

/// Asserts that the cube with one tag, in line 15, is refused.
fn assert_tag_refused(tag: &str, message: &str) {
    assert_refused(format!("{CUBE}{tag}\n"), &format!("line 15: {message}"));
}

/// The warnings of the cube with further lines.
fn warnings(lines: &str) -> Vec<String> {
    cube_with(lines).unwrap().warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn crease_of_two_vertices_is_an_edge() {
    assert_eq!(tagged("t crease 2/1/0 0 1 2.5").creases, [crease(0, 1, 2.5)]);
}

#[test]
fn crease_of_more_vertices_is_a_polyline_with_one_sharpness_or_one_an_edge() {
    let same = [crease(0, 1, 3.0), crease(1, 3, 3.0), crease(3, 2, 3.0)];
    assert_eq!(tagged("t crease 4/1/0 0 1 3 2 3").creases, same);
    let each = [crease(0, 1, 1.0), crease(1, 3, 2.0), crease(3, 2, 3e9)];
    assert_eq!(tagged("t crease 4/3/0 0 1 3 2 1 2 3e9").creases, each);
}

#[test]
fn infinite_sharpness_becomes_the_number_that_means_it() {
    assert_eq!(tagged("t crease 2/1/0 0 1 inf").creases, [crease(0, 1, 10.0)]);
    assert_eq!(tagged("t crease 2/1/0 0 1 1e300").creases, [crease(0, 1, 10.0)]);
}

#[test]
fn corner_tags_are_vertices_with_one_sharpness_or_one_each() {
    let corner = |vertex, sharpness| Corner { vertex, sharpness };
    assert_eq!(tagged("t corner 2/1/0 3 4 1.5").corners, [corner(3, 1.5), corner(4, 1.5)]);
    assert_eq!(tagged("t corner 2/2/0 3 4 1.5 0").corners, [corner(3, 1.5), corner(4, 0.0)]);
}

#[test]
fn hole_tags_are_faces() {
    assert_eq!(tagged("t hole 2/0/0 5 0").holes, [5, 0]);
}

#[test]
fn density_tags_are_vertices_with_one_factor_or_one_each_and_others_have_one() {
    assert!(tagged("").density.is_empty());
    let mut expected = [1.0; 8];
    (expected[3], expected[7]) = (0.5, 0.0);
    assert_eq!(tagged("t density 2/2/0 3 7 0.5 0").density, expected);
    (expected[3], expected[7]) = (2.5, 2.5);
    assert_eq!(tagged("t density 2/1/0 7 3 2.5").density, expected);
    assert_eq!(tagged("t density 1/1/0 3 9\nt density 2/2/0 3 7 2.5 2.5").density, expected);
}

#[test]
fn interpolateboundary_chooses_the_boundary_rule() {
    assert_eq!(tagged("").options.boundary, Boundary::EdgeAndCorner);
    let rules = [Boundary::None, Boundary::EdgeAndCorner, Boundary::EdgeOnly];
    for (value, rule) in rules.into_iter().enumerate() {
        assert_eq!(tagged(&format!("t interpolateboundary 1/0/0 {value}")).options.boundary, rule);
    }
}

#[test]
fn facevaryinginterpolateboundary_chooses_the_face_varying_rule() {
    use FaceVarying::{All, Boundaries, CornersOnly, CornersPlus1, CornersPlus2, None};
    for (value, rule) in [None, CornersOnly, CornersPlus1, CornersPlus2, Boundaries, All].into_iter().enumerate() {
        assert_eq!(tagged(&format!("t facevaryinginterpolateboundary 1/0/0 {value}")).options.face_varying, rule);
    }
}

#[test]
fn creasemethod_and_smoothtriangles_choose_their_rules() {
    assert_eq!(tagged("t creasemethod 0/0/1 normal").options.creasing, Creasing::Uniform);
    assert_eq!(tagged("t creasemethod 0/0/1 chaikin").options.creasing, Creasing::Chaikin);
    assert_eq!(tagged("t smoothtriangles 0/0/1 catmark").options.triangles, TriangleSubdivision::CatmullClark);
    assert_eq!(tagged("t smoothtriangles 0/0/1 smooth").options.triangles, TriangleSubdivision::Smooth);
}

#[test]
fn later_options_override_earlier_ones() {
    let mesh = tagged("t interpolateboundary 1/0/0 0\nt interpolateboundary 1/0/0 2");
    assert_eq!(mesh.options.boundary, Boundary::EdgeOnly);
}

#[test]
fn tags_may_come_before_what_they_name() {
    let text = format!("t hole 1/0/0 5\nt crease 2/1/0 0 1 2\nt corner 1/1/0 7 1\n{CUBE}");
    let mesh = crate::common::mesh(text).control_mesh;
    assert_eq!((mesh.holes.len(), mesh.creases.len(), mesh.corners.len()), (1, 1, 1));
}

#[test]
fn unknown_tags_are_ignored_with_a_warning() {
    assert_eq!(warnings("t warp 9/9 x\n"), ["line 15: unknown tag `warp`: ignored"]);
    assert_eq!(
        warnings("\nt facevaryingpropagatecorners 1/0/0 1\n"),
        ["line 16: tag `facevaryingpropagatecorners` has no effect: ignored"]
    );
}

#[test]
fn creases_without_an_edge_are_ignored_with_a_warning() {
    let scene = cube_with("t crease 2/1/0 0 1 2\nt crease 3/1/0 0 3 1 2\nt crease 2/1/0 4 4 1\n").unwrap();
    assert_eq!(scene.meshes[0].control_mesh.creases, [crease(0, 1, 2.0), crease(3, 1, 2.0)]);
    let texts: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    let ignored = |line, a, b| format!("line {line}: a crease from vertex {a} to {b}, which no edge joins: ignored");
    assert_eq!(texts, [ignored(16, 0, 3), ignored(17, 4, 4)]);
}

#[test]
fn repair_renumbers_the_faces_that_tags_name() {
    let vertices: String = CUBE.lines().take(8).map(|line| format!("{line}\n")).collect();
    let tags = "t hole 3/0/0 0 1 2\nt faceedit 3/0/1 2 2 1 hole\nt vertexedit 6/2/3 2 1 0 2 2 0 1 1 set P sharpness\n";
    let scene = repair(&format!("{vertices}f 1 2 4 3\nf 1 1 2\nf 3 4 6 5\n{tags}"));
    let mesh = &scene.meshes[0].control_mesh;
    assert_eq!(mesh.holes, [0, 1]);
    assert_eq!(mesh.edits.iter().map(|edit| edit.path.as_slice()).collect::<Vec<_>>(), [[1, 1], [1, 0]]);
    let texts: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        texts,
        [
            "line 10: a face with vertex 1 twice: dropped",
            "line 12: a hole in face 1, which was dropped: ignored",
            "line 14: an edit of face 1, which was dropped: ignored"
        ]
    );
}

#[test]
fn tags_with_wrong_counts_are_refused() {
    assert_tag_refused("t", "found no tag name, expected t NAME ints/floats/strings ..");
    assert_tag_refused("t crease", "found `` as a tag's counts, expected counts like 2/1/0");
    for counts in ["2/1", "2/1/0/0", "2/-1/0", "x/1/0", "2//0"] {
        let message = format!("found `{counts}` as a tag's counts, expected counts like 2/1/0");
        assert_tag_refused(&format!("t crease {counts} 0 1 2"), &message);
    }
    assert_tag_refused("t crease 2/1/0 0 1", "found a tag with 2 values, expected as many as `2/1/0` says");
    assert_tag_refused("t crease 2/1/0 0 1 2 3", "found a tag with 4 values, expected as many as `2/1/0` says");
    let claim = "9223372036854775807/1/0";
    assert_tag_refused(
        &format!("t crease {claim} 0 1"),
        &format!("found a tag with 2 values, expected as many as `{claim}` says"),
    );
}

#[test]
fn tags_with_unfitting_values_are_refused() {
    assert_tag_refused("t crease 1/1/0 0 1", "found a crease of 1 vertices, expected 2 or more");
    assert_tag_refused("t crease 2/0/0 0 1", "found 0 sharpness values for 1, expected one, or one for each edge");
    assert_tag_refused(
        "t crease 4/2/0 0 1 3 2 1 1",
        "found 2 sharpness values for 3, expected one, or one for each edge",
    );
    assert_tag_refused("t crease 2/1/1 0 1 2 x", "found a tag with 1 strings, expected none");
    assert_tag_refused("t corner 0/1/0 1", "found a corner of 0 vertices, expected 1 or more");
    assert_tag_refused(
        "t corner 2/3/0 0 1 1 2 3",
        "found 3 sharpness values for 2, expected one, or one for each vertex",
    );
    assert_tag_refused("t corner 1/1/1 0 1 x", "found a tag with 1 strings, expected none");
    assert_tag_refused("t hole 0/0/0", "found a hole of 0 faces and 0 floats, expected 1 or more faces and no floats");
    assert_tag_refused("t hole 1/0/1 0 x", "found a tag with 1 strings, expected none");
    assert_tag_refused("t density 0/1/0 1", "found a density of 0 vertices, expected 1 or more");
    let expected = "expected one, or one for each vertex";
    assert_tag_refused("t density 3/2/0 0 1 2 1 2", &format!("found 2 density values for 3, {expected}"));
    assert_tag_refused("t density 1/0/0 0", &format!("found 0 density values for 1, {expected}"));
    assert_tag_refused("t density 1/1/1 0 1 x", "found a tag with 1 strings, expected none");
    assert_tag_refused("t interpolateboundary 2/0/0 1 1", "found a tag with 2/0/0 values, expected 1/0/0");
    assert_tag_refused("t creasemethod 1/0/0 1", "found a tag with 1/0/0 values, expected 0/0/1");
}

#[test]
fn tag_values_of_the_wrong_type_are_refused() {
    assert_tag_refused("t crease 2/1/0 0 1.0 2", "found `1.0`, expected an integer");
    assert_tag_refused("t crease 2/1/0 0 1 x", "found `x`, expected a number");
}

#[test]
fn negative_and_nan_sharpness_is_refused() {
    assert_tag_refused("t crease 2/1/0 0 1 -0.5", "found sharpness -0.5, expected 0 or more");
    assert_tag_refused("t corner 1/1/0 0 -1", "found sharpness -1, expected 0 or more");
    assert_tag_refused("t corner 1/1/0 0 NaN", "found `NaN`, expected a number");
}

#[test]
fn densities_that_are_negative_or_not_finite_are_refused() {
    for value in ["-0.5", "inf", "-inf", "1e39"] {
        let shown: f64 = value.parse().unwrap();
        let message = format!("found density {shown}, expected 0 or more, finite in 32-bit floating point");
        assert_tag_refused(&format!("t density 2/2/0 0 1 1 {value}"), &message);
    }
    assert_tag_refused("t density 1/1/0 0 NaN", "found `NaN`, expected a number");
}

#[test]
fn tag_indices_out_of_range_are_refused() {
    assert_tag_refused("t crease 2/1/0 0 8 2", "found vertex 8 in a tag, expected 0 to 7");
    assert_tag_refused("t corner 1/1/0 -1 2", "found vertex -1 in a tag, expected 0 to 7");
    assert_tag_refused("t density 1/1/0 8 2", "found vertex 8 in a tag, expected 0 to 7");
    assert_tag_refused("t hole 1/0/0 6", "found face 6 in a tag, expected 0 to 5");
}

#[test]
fn option_values_out_of_range_are_refused() {
    assert_tag_refused("t interpolateboundary 1/0/0 3", "found boundary interpolation 3, expected 0, 1 or 2");
    assert_tag_refused(
        "t facevaryinginterpolateboundary 1/0/0 6",
        "found face-varying interpolation 6, expected 0 to 5",
    );
    assert_tag_refused("t creasemethod 0/0/1 x", "found `x`, expected `normal` or `chaikin`");
    assert_tag_refused("t smoothtriangles 0/0/1 x", "found `x`, expected `catmark` or `smooth`");
}

#[test]
fn options_are_checked_even_when_overridden() {
    assert!(read(format!("{CUBE}t interpolateboundary 1/0/0 7\nt interpolateboundary 1/0/0 1\n")).is_err());
}
