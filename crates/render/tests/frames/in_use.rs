//! How much is computed, against the least that what is drawn needs.

use planish_render::emit::Emitted;
use planish_render::{Culling, Density, FrameOptions, PatchKind, Selection, Spacing};
use planish_subdiv::tables::Tables;
use planish_subdiv::topology::NONE;

use crate::lab::Lab;
use crate::world::World;

const SIZE: [u32; 2] = [640, 480];
/// Points and limit points that are computed, over those that must be.
const MOST: f64 = 1.25;
const SCENES: [(&str, u32); 12] = [
    ("hero", 5),
    ("adjacent_extraordinary", 7),
    ("boundary_valences", 6),
    ("valence_40", 6),
    ("ngon_40", 6),
    ("nonmanifold_book_5", 7),
    ("edit_footprints", 7),
    ("hole_ngon", 7),
    ("crease_mixed_3", 7),
    ("mixed_triangles_quads", 7),
    ("genus_2", 7),
    ("several.json", 6),
];

/// Control points of a patch that are not reflections.
fn control_points(points: &[u32; 16], boundary: u8) -> impl Iterator<Item = u32> {
    let is_own = move |i: usize| {
        let (row, column) = (i / 4, i % 4);
        let is_reflected = boundary & 1 != 0 && row == 0
            || boundary & 2 != 0 && column == 3
            || boundary & 4 != 0 && row == 3
            || boundary & 8 != 0 && column == 0;
        !is_reflected
    };
    (0..16).filter(move |&i| is_own(i)).map(|i| points[i])
}

/// The least number of points and limit points from which patches can be drawn.
fn least(tables: &Tables, entries: &Emitted) -> u64 {
    let mut points = vec![false; tables.point_count() as usize];
    let mut limits = vec![false; tables.limit_point_count() as usize];
    for kind in [PatchKind::Regular, PatchKind::Transition, PatchKind::Cut] {
        for entry in &entries[kind as usize] {
            let patch = &tables.patches[entry.place as usize];
            control_points(&patch.points, patch.info.boundary).for_each(|point| points[point as usize] = true);
            let seams = tables.seams.get(patch.seams as usize);
            let corners = seams.into_iter().flat_map(|seams| seams.limits).filter(|&limit| limit != NONE);
            corners.for_each(|limit| limits[limit as usize] = true);
        }
    }
    for entry in &entries[PatchKind::Filling as usize] {
        let face = &tables.irregular[entry.place as usize];
        face.limits.iter().for_each(|&limit| limits[limit as usize] = true);
        let split = (0..4).filter(|i| entry.flags >> i & 1 != 0);
        split.for_each(|i| limits[face.midpoints[i] as usize] = true);
    }
    for (row, _) in tables.limits.rows.iter().zip(&limits).filter(|(_, is_used)| **is_used) {
        let own = &tables.limits.indices[row.first_index as usize..][..row.count as usize];
        own.iter().for_each(|&point| points[point as usize] = true);
    }
    // Rows are made of points of levels before, in the order of the dispatches.
    let order: Vec<u32> =
        tables.levels.iter().flat_map(|level| level.dispatches.iter().flat_map(Clone::clone)).collect();
    for row_index in order.into_iter().rev() {
        if points[(tables.cage_point_count + row_index) as usize] {
            let row = tables.stencils.rows[row_index as usize];
            let own = &tables.stencils.indices[row.first_index as usize..][..row.count as usize];
            own.iter().for_each(|&point| points[point as usize] = true);
        }
    }
    let made = points[tables.cage_point_count as usize..].iter().chain(&limits).filter(|&&is_used| is_used);
    made.count() as u64
}

/// Points that a frame computes, and the least that it could.
fn points(lab: &Lab, world: &mut World, from: usize, density: Density, culling: Culling) -> [u64; 2] {
    let options = FrameOptions { density, selection: Selection::Dynamic, culling, object_lod: false };
    let camera = world.cameras(SIZE)[from];
    let status = lab.run(&mut world.surface, Spacing::FractionalOdd, &camera, &options);
    let entries = lab.entries(&world.surface);
    let computed = status.computed_points(world.surface.phases().rows.len());
    [computed, least(world.surface.tables(), &entries)]
}

fn ratio([computed, least]: [u64; 2]) -> f64 {
    if computed == least { 1.0 } else { computed as f64 / least as f64 }
}

#[test]
fn hardly_more_points_are_computed_than_what_is_drawn_needs() {
    let lab = Lab::new();
    let (mut worst, mut worst_in_view, mut sum) = (0.0_f64, 0.0_f64, 0);
    for (name, level) in SCENES {
        let mut world = World::of_scene(&lab.device, name, level, false);
        for density in [Density::EdgePixels(16.0), Density::EdgePixels(4.0), Density::EdgePixels(1.5)] {
            for from in [0, 2] {
                let all = points(&lab, &mut world, from, density, Culling::Off);
                let seen = points(&lab, &mut world, from, density, Culling::Unseen);
                println!("{name} {density:?}: {all:?} {:.3}, in view {seen:?} {:.3}", ratio(all), ratio(seen));
                assert!(all[0] >= all[1] && seen[0] >= seen[1]);
                worst = worst.max(ratio(all));
                worst_in_view = worst_in_view.max(ratio(seen));
                sum += all[0];
            }
        }
    }
    println!("at most {worst}, of frames that leave out what is not in view {worst_in_view}");
    assert!(sum > 100_000 && worst <= MOST, "{worst}");
    lab.assert_silent();
}
