//! Hierarchical edits: what the tags become and what is refused.
use crate::common::{CUBE, assert_refused, tagged};
use planish_subdiv::mesh::{EditOperation as Edit, HierarchicalEdit};

fn edit(path: &[u32], operation: Edit) -> HierarchicalEdit {
    HierarchicalEdit { path: path.to_vec(), operation }
}

/// Asserts that the cube with one tag, in line 15, is refused.
fn assert_tag_refused(tag: &str, message: &str) {
    assert_refused(format!("{CUBE}{tag}\n"), &format!("line 15: {message}"));
}

#[test]
fn vertex_edits_have_a_path_and_three_floats_each() {
    let edits = tagged("t vertexedit 8/6/3 3 4 1 0 3 4 1 2 0 0 1 0 0 2 add P value").edits;
    let expected =
        [edit(&[4, 1, 0], Edit::AddPosition([0.0, 0.0, 1.0])), edit(&[4, 1, 2], Edit::AddPosition([0.0, 0.0, 2.0]))];
    assert_eq!(edits, expected);
}

#[test]
fn paths_may_have_any_length_from_two() {
    let edits = tagged("t vertexedit 9/6/3 2 5 3 5 0 1 2 3 0 1 2 3 4 5 6 set P value").edits;
    assert_eq!(edits[0], edit(&[5, 3], Edit::SetPosition([1.0, 2.0, 3.0])));
    assert_eq!(edits[1], edit(&[0, 1, 2, 3, 0], Edit::SetPosition([4.0, 5.0, 6.0])));
}

#[test]
fn subtracting_adds_the_opposite() {
    let value = tagged("t vertexedit 3/3/3 2 0 0 1 2 3 subtract P value").edits;
    assert_eq!(value, [edit(&[0, 0], Edit::AddPosition([-1.0, -2.0, -3.0]))]);
    let sharpness = tagged("t edgeedit 3/1/3 2 0 0 1.5 subtract P sharpness").edits;
    assert_eq!(sharpness, [edit(&[0, 0], Edit::AddEdgeSharpness(-1.5))]);
}

#[test]
fn sharpness_edits_have_one_float_and_may_add_less_than_nothing() {
    let sharpness = |tag: &str| tagged(tag).edits[0].operation;
    assert_eq!(sharpness("t vertexedit 3/1/3 2 0 0 10 set P sharpness"), Edit::SetVertexSharpness(10.0));
    assert_eq!(sharpness("t vertexedit 3/1/3 2 0 0 -1 add P sharpness"), Edit::AddVertexSharpness(-1.0));
    assert_eq!(sharpness("t edgeedit 3/1/3 2 0 0 10 set P sharpness"), Edit::SetEdgeSharpness(10.0));
    assert_eq!(sharpness("t edgeedit 3/1/3 2 0 0 1 add P sharpness"), Edit::AddEdgeSharpness(1.0));
}

#[test]
fn several_operations_share_the_floats_of_each_edit() {
    let edits = tagged("t vertexedit 6/8/6 2 0 0 2 1 1 1 2 3 7 4 5 6 8 set P value set P sharpness").edits;
    let expected = [
        edit(&[0, 0], Edit::SetPosition([1.0, 2.0, 3.0])),
        edit(&[1, 1], Edit::SetPosition([4.0, 5.0, 6.0])),
        edit(&[0, 0], Edit::SetVertexSharpness(7.0)),
        edit(&[1, 1], Edit::SetVertexSharpness(8.0)),
    ];
    assert_eq!(edits, expected);
}

#[test]
fn surplus_floats_are_ignored() {
    assert_eq!(tagged("t vertexedit 3/9/3 2 0 0 1 2 3 4 5 6 7 8 9 add P value").edits.len(), 1);
}

#[test]
fn face_edits_make_holes_of_children_and_of_faces() {
    let mesh = tagged("t faceedit 6/0/1 3 4 1 2 1 5 hole");
    assert_eq!(mesh.edits, [edit(&[4, 1, 2], Edit::Hole)]);
    assert_eq!(mesh.holes, [5]);
}

#[test]
fn edits_with_too_few_floats_are_refused() {
    assert_tag_refused("t vertexedit 3/2/3 2 0 0 1 2 add P value", "found 2 floats, expected 3 for each of 1 edits");
    assert_tag_refused(
        "t edgeedit 6/1/3 2 0 0 2 0 1 1 set P sharpness",
        "found 1 floats, expected 1 for each of 2 edits",
    );
}

#[test]
fn edits_with_wrong_paths_are_refused() {
    let vertex = |path: &str| format!("t vertexedit {}/3/3 {path} 1 2 3 add P value", path.split(' ').count());
    let too_long = "found a path of length 4, expected at least 2 and no more than the 3 ints that follow";
    assert_tag_refused(&vertex("4 0 0 0"), too_long);
    assert_tag_refused(
        &vertex("1 0"),
        "found a path of length 1, expected at least 2 and no more than the 1 ints that follow",
    );
    assert_tag_refused(
        &vertex("-1 0"),
        "found a path of length -1, expected at least 2 and no more than the 1 ints that follow",
    );
    assert_tag_refused(&vertex("2 6 0"), "found face 6 in a tag, expected 0 to 5");
    assert_tag_refused(&vertex("3 0 4 0"), "found child 4 in a tag, expected 0 to 3");
    assert_tag_refused(&vertex("3 0 0 4"), "found vertex 4 in a tag, expected 0 to 3");
    assert_tag_refused("t edgeedit 3/1/3 2 0 4 1 set P sharpness", "found edge 4 in a tag, expected 0 to 3");
    assert_tag_refused(
        "t vertexedit 0/0/3 add P value",
        "found an edit without a path, expected a path length and that many ints",
    );
}

#[test]
fn first_child_of_an_ngon_may_be_any_of_its_corners() {
    let pentagon = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1.5 0\nv 0 1 0\nf 1 2 3 4 5\n";
    let mesh = crate::common::mesh(format!("{pentagon}t faceedit 7/0/1 2 0 4 3 0 4 3 hole\n")).control_mesh;
    assert_eq!(mesh.edits.len(), 2);
    let message = "line 7: found child 5 in a tag, expected 0 to 4";
    assert_refused(format!("{pentagon}t faceedit 3/0/1 2 0 5 hole\n"), message);
}

#[test]
fn edits_with_wrong_operations_are_refused() {
    for strings in ["scale P value", "add N value", "add P colour", "value P add"] {
        let quoted: Vec<String> = strings.split(' ').map(|word| format!("{word:?}")).collect();
        let found = format!("found [{}] in an edit", quoted.join(", "));
        assert_tag_refused(
            &format!("t vertexedit 3/3/3 2 0 0 1 2 3 {strings}"),
            &format!("{found}, expected set, add or subtract, then P, then value or sharpness"),
        );
    }
    let sharpness_only = "expected set, add or subtract, then P, then sharpness";
    assert_tag_refused(
        "t edgeedit 3/3/3 2 0 0 1 2 3 add P value",
        &format!("found [\"add\", \"P\", \"value\"] in an edit, {sharpness_only}"),
    );
    assert_tag_refused("t edgeedit 3/1/0 2 0 0 1", &format!("found [] in an edit, {sharpness_only}"));
    assert_tag_refused(
        "t faceedit 3/0/2 2 0 1 set hole",
        "found [\"set\", \"hole\"] in a faceedit, expected `hole` alone",
    );
}

#[test]
fn edit_values_are_checked() {
    assert_tag_refused("t edgeedit 3/1/3 2 0 0 -1 set P sharpness", "found sharpness -1, expected 0 or more");
    assert_tag_refused(
        "t vertexedit 3/3/3 2 0 0 1 2 1e39 add P value",
        "found [1.0, 2.0, 1e39] in an edit, expected finite coordinates",
    );
}
