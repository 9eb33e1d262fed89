//! What the checks of edges find: they are made of every dump that is judged, by [`planish_tests::judge`].

use std::path::Path;

use planish_tests::cage::Cage;
use planish_tests::folder::temporary;
use planish_tests::ply::{Dump, Vertex};
use planish_tests::program::Planish;
use planish_tests::repository::scene;
use planish_tests::weld::{Weld, faults, unbalanced_edge_count};

fn dump(mesh: &Path, flags: &str) -> Vec<Vertex> {
    let folder = temporary();
    let path = folder.path().join("dump.ply");
    Planish::dump(mesh, &path).flags(flags).run().silent_success().unwrap();
    Dump::read(&path).unwrap().vertices().collect()
}

fn of_faces(vertices: &[Vertex], is_kept: impl Fn(u32) -> bool) -> Vec<Vertex> {
    vertices.iter().copied().filter(|vertex| is_kept(vertex.face)).collect()
}

#[test]
fn a_missing_face_a_missing_triangle_and_another_factor_are_found() {
    let mesh = scene("adjacent_extraordinary");
    let cage = Cage::read(&mesh);
    let whole = dump(&mesh, "--tess 3");
    let found = faults(&of_faces(&whole, |face| face != 17), &cage, Weld::Position);
    assert!(found.iter().any(|fault| fault.starts_with("an open edge inside")), "{found:?}");
    assert!(found.iter().any(|fault| fault.contains("boundary loops")), "{found:?}");
    assert_eq!(faults(&whole, &cage, Weld::Position), Vec::<String>::new());
    for triangle in [0, 100, whole.len() / 3 - 1] {
        let rest = [&whole[..3 * triangle], &whole[3 * triangle + 3..]].concat();
        assert!(!faults(&rest, &cage, Weld::Position).is_empty(), "without triangle {triangle}");
    }

    // A neighbour at another factor leaves T-junctions.
    let other = dump(&mesh, "--tess 5");
    let soup = [of_faces(&whole, |face| face != 17), of_faces(&other, |face| face == 17)].concat();
    let found = faults(&soup, &cage, Weld::Position);
    assert!(found.iter().any(|fault| fault.starts_with("an open edge inside")), "{found:?}");
}

#[test]
fn a_gap_and_a_doubled_triangle_are_found() {
    let mesh = scene("adjacent_extraordinary");
    let cage = Cage::read(&mesh);
    let whole = dump(&mesh, "--tess 3");
    let mut gap = whole.clone();
    gap.iter_mut().filter(|vertex| vertex.face == 17).for_each(|vertex| vertex.position[1] += 1e-4);
    assert!(faults(&gap, &cage, Weld::Position).iter().any(|fault| fault.starts_with("an open edge inside")));
    let doubled = [&whole[..], &whole[30..33]].concat();
    assert!(
        faults(&doubled, &cage, Weld::Position).iter().any(|fault| fault.starts_with("two triangles on the same side"))
    );
}

#[test]
fn a_vertex_that_is_off_by_one_bit_is_found() {
    let mesh = scene("adjacent_extraordinary");
    let cage = Cage::read(&mesh);
    let whole = dump(&mesh, "--tess 3");
    assert_eq!(faults(&whole, &cage, Weld::PositionAndNormal), Vec::<String>::new());
    let inside = whole.iter().position(|vertex| vertex.face == 17 && vertex.uv[0] == 0.0).expect("a corner on an edge");
    let mut moved = whole.clone();
    moved[inside].position[1] = f32::from_bits(moved[inside].position[1].to_bits() ^ 1);
    assert!(!faults(&moved, &cage, Weld::Position).is_empty());
    let mut turned = whole.clone();
    turned[inside].normal[1] = f32::from_bits(turned[inside].normal[1].to_bits() ^ 1);
    assert_eq!(faults(&turned, &cage, Weld::Position), Vec::<String>::new());
    assert!(!faults(&turned, &cage, Weld::PositionAndNormal).is_empty());
}

#[test]
fn patches_by_themselves_leave_cracks() {
    let mesh = scene("adjacent_extraordinary");
    let found = faults(&dump(&mesh, "--tess 7.3 --no-watertight"), &Cage::read(&mesh), Weld::Position);
    assert!(found.iter().any(|fault| fault.starts_with("an open edge inside")), "{found:?}");
}

#[test]
fn a_crack_far_from_the_origin_leaves_edges_that_are_not_balanced() {
    let mesh = scene("far_from_origin");
    let whole = dump(&mesh, "--tess 3");
    assert_eq!(unbalanced_edge_count(&whole), 0);
    assert!(unbalanced_edge_count(&whole[3..]) > 0, "without a triangle");
    let mut moved = whole.clone();
    moved[100].position[1] = f32::from_bits(moved[100].position[1].to_bits() ^ 1);
    assert!(unbalanced_edge_count(&moved) > 0, "a vertex off by one bit");
}
