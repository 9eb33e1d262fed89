//! Merged tables: each mesh in them is what it is alone.

use planish_generate::random::Random;
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::{EditOperation, HierarchicalEdit};
use planish_subdiv::selection::{Selection, density_rings, select};
use planish_subdiv::tables::{MeshRanges, Tables};
use planish_subdiv::topology::NONE;

use crate::cages::{cube, pole, prism, random, sheet};
use crate::selection::{densities, tables};
use crate::surface::{limit, points};

/// Meshes with and without large n-gons, with edits of other depths, and without any irregular face.
fn meshes() -> Vec<ControlMesh> {
    let moves =
        |edit: &HierarchicalEdit| matches!(edit.operation, EditOperation::AddPosition(_)) && edit.path.len() > 4;
    let edited = (0..).map(random).filter(|mesh| mesh.edits.iter().any(moves));
    [pole(7, 2), prism(40), sheet(3, 2)].into_iter().chain(edited.take(4)).chain([cube(), prism(9), prism(5)]).collect()
}

/// The first index of a mesh' points of each level and dispatch in merged tables, and alone.
fn moved(merged: &Tables, mesh: &MeshRanges, part: &Tables, point: u32) -> u32 {
    let Some(row) = point.checked_sub(part.cage_point_count) else { return mesh.cage_points.start + point };
    for (level, rows) in part.levels.iter().zip(&mesh.rows) {
        let missing = rows.len() - level.dispatches.len();
        for (from, to) in level.dispatches.iter().zip(&rows[missing..]) {
            assert_eq!(from.len(), to.len());
            if from.contains(&row) {
                return merged.cage_point_count + to.start + row - from.start;
            }
        }
    }
    panic!("no dispatch makes point {point}");
}

#[test]
fn one_part_stays_as_it_is() {
    let part = tables(&prism(40), 3);
    let (merged, ranges) = Tables::merge(vec![part.clone()]).expect("small tables");
    assert_eq!(ranges, [part.ranges()]);
    assert_eq!(format!("{:?}", merged.stencils.rows), format!("{:?}", part.stencils.rows));
}

#[test]
fn each_mesh_has_the_points_limits_and_faces_that_it_has_alone() {
    let meshes = meshes();
    let parts: Vec<Tables> = meshes.iter().map(|mesh| tables(mesh, 3)).collect();
    let (merged, ranges) = Tables::merge(parts.clone()).expect("small tables");
    assert_eq!(merged.last_level, parts.iter().map(|part| part.last_level).max().unwrap());
    let positions: Vec<[f32; 3]> = meshes.iter().flat_map(|mesh| mesh.positions.iter().copied()).collect();
    let all = points(&positions, &merged);
    for ((mesh, part), ranges) in meshes.iter().zip(&parts).zip(&ranges) {
        let own = points(&mesh.positions, part);
        let new = |point: u32| moved(&merged, ranges, part, point);
        for (point, position) in (0..).zip(&own) {
            assert_eq!(all[new(point) as usize], *position);
        }
        for index in 0..part.limit_point_count() {
            assert_eq!(limit(&merged, &all, ranges.limits.start + index), limit(part, &own, index));
        }
        for star in 0..part.stars.count() {
            let star_points: Vec<u32> = part.stars.of(star).iter().map(|&point| new(point)).collect();
            assert_eq!(merged.stars.of(ranges.stars.start + star), star_points);
        }
        for (k, range) in part.patch_ranges.iter().enumerate() {
            let merged_patches = &merged.patches[ranges.patches[k].start as usize..ranges.patches[k].end as usize];
            let own_patches = &part.patches[range.start as usize..range.end as usize];
            assert_eq!(merged_patches.len(), own_patches.len());
            for (a, b) in merged_patches.iter().zip(own_patches) {
                assert_eq!(a.info, b.info);
                assert_eq!(a.points, b.points.map(new));
                assert_eq!(a.edges, b.edges.map(|edge| if edge == NONE { NONE } else { edge + ranges.edges.start }));
            }
        }
        for slot in 0..part.slots.rings.count() {
            assert_eq!(merged.slots.rings.of(ranges.slots.start + slot), part.slots.rings.of(slot));
            assert_eq!(merged.slots.neighbours.of(ranges.slots.start + slot), part.slots.neighbours.of(slot));
        }
    }
}

#[test]
fn dispatches_of_all_meshes_lie_side_by_side() {
    let parts: Vec<Tables> = meshes().iter().map(|mesh| tables(mesh, 3)).collect();
    let (merged, ranges) = Tables::merge(parts).expect("small tables");
    let mut row_count = 0;
    for (k, level) in merged.levels.iter().enumerate() {
        for (phase, dispatch) in level.dispatches.iter().enumerate() {
            let mut row = dispatch.start;
            for mesh in &ranges {
                assert_eq!(mesh.rows[k][phase].start, row);
                row = mesh.rows[k][phase].end;
            }
            assert_eq!(row, dispatch.end);
            row_count += dispatch.len();
        }
    }
    assert_eq!((merged.levels[1].dispatches.len(), merged.levels[2].dispatches.len()), (2, 1));
    assert_eq!(row_count, merged.stencils.rows.len());
}

#[test]
fn each_mesh_has_the_cut_that_it_has_alone() {
    let meshes = meshes();
    let parts: Vec<Tables> = meshes.iter().map(|mesh| tables(mesh, 3)).collect();
    let (merged, ranges) = Tables::merge(parts.clone()).expect("small tables");
    let mut generator = Random::new(7);
    for ((mesh, part), ranges) in meshes.iter().zip(&parts).zip(&ranges) {
        for kind in 0..5 {
            let density = densities(kind, mesh.positions.len(), &mut generator);
            let outside: Vec<u32> = mesh.positions.iter().map(|p| u32::from(p[0] > 0.3)).collect();
            let cut_of = |tables: &Tables, ranges: &MeshRanges| {
                let slots = density_rings(tables, ranges, &density, &outside);
                (select(tables, ranges, &slots, Selection::Dynamic), slots)
            };
            let ((a, a_slots), (b, b_slots)) = (cut_of(&merged, ranges), cut_of(part, &part.ranges()));
            assert_eq!(a_slots, b_slots);
            assert_eq!(a.truncated, b.truncated);
            let count = b.counts.len();
            assert_eq!(a.counts[..count], b.counts);
            assert!(a.counts[count..].iter().all(|counts| *counts == Default::default()));
            let stars: Vec<u32> = b.stars.iter().map(|star| star + ranges.stars.start).collect();
            let edges: Vec<u32> = b.split_edges.iter().map(|edge| edge + ranges.edges.start).collect();
            let limits: Vec<u32> = b.limits.iter().map(|limit| limit + ranges.limits.start).collect();
            assert_eq!((a.stars, a.split_edges, a.limits), (stars, edges, limits));
            let infos = |tables: &Tables, faces: &[u32]| -> Vec<_> {
                faces.iter().map(|&face| tables.irregular[face as usize].info).collect()
            };
            assert_eq!(infos(&merged, &a.refined), infos(part, &b.refined));
            let point = |row: u32| moved(&merged, ranges, part, row + part.cage_point_count) - merged.cage_point_count;
            let rows = |rows: &[Vec<Vec<u32>>]| rows.iter().flatten().flatten().copied().collect::<Vec<_>>();
            let mut moved_rows: Vec<u32> = rows(&b.rows).into_iter().map(point).collect();
            let mut own_rows = rows(&a.rows);
            moved_rows.sort_unstable();
            own_rows.sort_unstable();
            assert_eq!(own_rows, moved_rows);
        }
    }
}

#[test]
fn edits_of_merged_meshes_are_counted_one_mesh_after_another() {
    let meshes = meshes();
    let (merged, ranges) = Tables::merge(meshes.iter().map(|mesh| tables(mesh, 3)).collect()).expect("small tables");
    let mut edits: Vec<_> = meshes.iter().flat_map(|mesh| mesh.edits.iter().cloned()).collect();
    assert_eq!(merged.point_edits(&edits), merged.edits);
    for (place, edit) in edits.iter_mut().enumerate() {
        if let EditOperation::AddPosition(_) = edit.operation {
            edit.operation = EditOperation::SetPosition([place as f32, 0.0, 0.0]);
        }
    }
    let changed = merged.point_edits(&edits);
    let mut first = 0.0;
    for (mesh, ranges) in meshes.iter().zip(&ranges) {
        let next = first + mesh.edits.len() as f32;
        for place in ranges.edits.iter().cloned().flatten() {
            assert!((first..next).contains(&changed[place as usize].offset[0]));
        }
        first = next;
    }
    assert!(merged.edits.len() > 2);
}
