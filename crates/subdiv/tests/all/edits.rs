//! Hierarchical edits: where a path leads, and what refinement makes of it.

use planish_subdiv::ControlMesh;
use planish_subdiv::Error;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{EditOperation, HierarchicalEdit};
use planish_subdiv::refine::{RefineOptions, Refinement};
use planish_subdiv::selection::deepest_cut;
use planish_subdiv::tables::Tables;

/// A flat sheet of n x n unit squares.
fn sheet(n: u32) -> ControlMesh {
    let mut mesh = ControlMesh::default();
    mesh.positions.extend((0..=n).flat_map(|j| (0..=n).map(move |i| [i as f32, j as f32, 0.0])));
    for a in (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i)) {
        mesh.face_sizes.push(4);
        mesh.face_vertices.extend([a, a + 1, a + n + 2, a + n + 1]);
    }
    mesh
}

/// A flat hexagon within a ring of quads.
fn hexagon() -> ControlMesh {
    let mut mesh = ControlMesh { face_sizes: vec![6], face_vertices: (0..6).collect(), ..ControlMesh::default() };
    for radius in [1.0, 2.0] {
        for i in 0..6 {
            let angle = i as f32 * std::f32::consts::TAU / 6.0;
            mesh.positions.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
        }
    }
    for i in 0..6 {
        mesh.face_sizes.push(4);
        mesh.face_vertices.extend([i, 6 + i, 6 + (i + 1) % 6, (i + 1) % 6]);
    }
    mesh
}

fn edit(path: &[u32], operation: EditOperation) -> HierarchicalEdit {
    HierarchicalEdit { path: path.to_vec(), operation }
}

const LIFT: EditOperation = EditOperation::AddPosition([0.0, 0.0, 1.0]);

/// Height of the limit surface.
fn height(mesh: &ControlMesh, face: u32, u: f64, v: f64) -> f64 {
    let mut evaluator = Evaluator::new(mesh).expect("a legal cage");
    evaluator.evaluate(face, u, v).expect("a limit").position[2]
}

#[test]
fn a_path_leads_to_the_corner_that_its_children_say() {
    // Corners go around the face from (0, 0): child 1 holds (1, 0), and its own corner 2 is the middle of the edge u = 1.
    for (path, u, v) in [
        (vec![12, 0], 0.0, 0.0),
        (vec![12, 2], 1.0, 1.0),
        (vec![12, 1, 2], 1.0, 0.5),
        (vec![12, 3, 1], 0.5, 0.5),
        (vec![12, 2, 0, 0], 0.5, 0.5),
        (vec![12, 2, 3, 1], 0.75, 0.75),
        (vec![12, 0, 1, 3, 2], 0.375, 0.25),
    ] {
        let mut mesh = sheet(5);
        mesh.edits = vec![edit(&path, LIFT)];
        // A lifted regular vertex has the weight 4/9 at its own limit, 1/9 at its neighbours', and no reach beyond two faces.
        let side = (-((path.len() - 2) as f64)).exp2();
        let at = |du: f64, dv: f64| height(&mesh, 12, u + du * side, v + dv * side);
        assert!((at(0.0, 0.0) - 4.0 / 9.0).abs() < 1e-12, "{path:?}");
        let inward = if u > 0.5 { -1.0 } else { 1.0 };
        assert!((at(inward, 0.0) - 1.0 / 9.0).abs() < 1e-12, "{path:?}");
        if path.len() > 3 {
            assert!(at(2.0 * inward, 0.0).abs() < 1e-12, "{path:?}");
        }
    }
}

#[test]
fn the_children_of_an_n_gon_are_its_corners() {
    for corner in 0..6 {
        let mut mesh = hexagon();
        // Vertex 2 of each child is the centre; Ptex face `corner` ends there.
        mesh.edits = vec![edit(&[0, corner, 2], LIFT)];
        assert!((height(&mesh, corner, 1.0, 1.0) - 6.0 / 11.0).abs() < 1e-12);
        // Vertex 0 is the corner.
        mesh.edits = vec![edit(&[0, corner, 0], LIFT)];
        assert!(height(&mesh, corner, 0.0, 0.0) > 0.3 && height(&mesh, (corner + 3) % 6, 0.0, 0.0) < 1e-6);
    }
}

#[test]
fn a_position_that_was_set_forgets_what_came_before() {
    let mut mesh = sheet(5);
    let at = |z: f32| EditOperation::SetPosition([2.5, 2.5, z]);
    mesh.edits = vec![edit(&[12, 0, 2], LIFT), edit(&[12, 2, 0], at(3.0)), edit(&[12, 1, 3], LIFT)];
    // Three paths to the same point: lifted, set to 3, lifted again.
    let lifted = height(&mesh, 12, 0.5, 0.5);
    assert!((lifted - 4.0 * 4.0 / 9.0).abs() < 1e-12, "{lifted}");
}

#[test]
fn sharpness_and_holes_reach_their_own_face_alone() {
    let mut mesh = sheet(5);
    mesh.positions.iter_mut().for_each(|p| p[2] = p[0] * p[0]);
    let (smooth, far) = (height(&mesh, 12, 0.5, 0.5), height(&mesh, 0, 0.5, 0.5));
    mesh.edits = vec![edit(&[12, 0, 1], EditOperation::SetEdgeSharpness(4.0))];
    let creased = height(&mesh, 12, 0.5, 0.5);
    assert!((creased - smooth).abs() > 1e-3, "{creased} {smooth}");
    assert!((height(&mesh, 0, 0.5, 0.5) - far).abs() < 1e-12);

    mesh.edits = vec![edit(&[12, 2, 1], EditOperation::Hole)];
    let mut evaluator = Evaluator::new(&mesh).expect("a legal cage");
    assert!(evaluator.evaluate(12, 0.9, 0.6).is_none() && evaluator.evaluate(12, 0.9, 0.9).is_some());
}

#[test]
fn refinement_reaches_no_further_than_the_edit() {
    let mut mesh = sheet(40);
    let options = RefineOptions { max_level: 0, ..RefineOptions::default() };
    mesh.edits = vec![edit(&[820, 0, 2, 1, 3], LIFT)];
    let tables = Tables::new(&Refinement::new(&mesh, options).expect("a legal cage"));
    assert_eq!(tables.last_level, 3);
    // At each level the nine faces around the path are split, and only they.
    let deepest = deepest_cut(&tables, &tables.ranges()).counts;
    let counts: Vec<u32> = deepest.iter().map(|count| count.regular + count.transition).collect();
    assert_eq!(counts, [1600 - 9, 36 - 9, 36 - 9, 36]);
    assert_eq!(deepest[3].filling, 0);
    assert_eq!(tables.edits.len(), 1);

    // The last split of a hole needs no more than the face on its path.
    mesh.edits = vec![edit(&[820, 0, 2], EditOperation::Hole)];
    let tables = Tables::new(&Refinement::new(&mesh, options).expect("a legal cage"));
    let deepest = deepest_cut(&tables, &tables.ranges()).counts;
    let counts: Vec<u32> = deepest.iter().map(|count| count.regular + count.transition).collect();
    assert_eq!(counts, [1600 - 9, 36 - 1, 4 - 1]);
}

#[test]
fn edits_of_what_does_not_exist_are_refused() {
    let refused = |path: &[u32], operation| {
        let mut mesh = sheet(2);
        mesh.edits = vec![edit(path, operation)];
        mesh.validate().expect_err("a bad edit")
    };
    let out_of_range = |what, index, count| Error::OutOfRange { what, index, count };
    assert_eq!(refused(&[4, 0], LIFT), out_of_range("face of an edit", 4, 4));
    assert_eq!(refused(&[0, 4, 0], LIFT), out_of_range("child of an edit", 4, 4));
    assert_eq!(refused(&[0, 3, 4], LIFT), out_of_range("vertex or edge of an edit", 4, 4));
    assert_eq!(refused(&[0, 4], EditOperation::Hole), out_of_range("child of an edit", 4, 4));
    assert_eq!(refused(&[0], LIFT), Error::EditPath { edit: 0 });
    assert_eq!(refused(&[0, 0], EditOperation::AddPosition([f32::NAN, 0.0, 0.0])), Error::EditValue { edit: 0 });
    assert_eq!(refused(&[0, 0], EditOperation::SetEdgeSharpness(f32::NAN)), Error::EditValue { edit: 0 });
    assert_eq!(refused(&[0; 20], LIFT), Error::MaxLevel { asked: 18, max: 15 });
}

#[test]
fn an_edit_that_changes_nothing_leaves_a_flipped_seam_as_it_was() {
    let mut mesh = sheet(2);
    mesh.face_vertices[..4].reverse();
    let leaves = |mesh: &ControlMesh| {
        let options = RefineOptions { max_level: 3, ..RefineOptions::default() };
        let tables = Tables::new(&Refinement::new(mesh, options).expect("a legal cage"));
        deepest_cut(&tables, &tables.ranges()).counts[3].filling
    };
    let before = leaves(&mesh);
    // Some of these are the middles of edges whose two faces run the same way: creases, though not by their faces' number.
    for (child, vertex) in (0..4).flat_map(|child| (0..4).map(move |vertex| (child, vertex))) {
        mesh.edits = vec![edit(&[0, child, vertex], EditOperation::SetVertexSharpness(0.0))];
        assert_eq!(leaves(&mesh), before, "child {child}, vertex {vertex}");
    }
}
