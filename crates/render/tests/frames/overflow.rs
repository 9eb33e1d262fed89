//! Lists that are too short: what does not fit is counted, not written, and fits after growing.

use std::collections::HashSet;

use planish_render::emit::Emitted;
use planish_render::lists::{LIST_ACTIVE, LIST_CUT, LIST_LEAVES, LIST_PATCHES};
use planish_render::{Culling, Density, FrameOptions, Selection, Spacing, Status};

use crate::lab::{Easel, Lab};
use crate::world::World;

const SIZE: [u32; 2] = [96, 64];

/// Whether everything but the draw lists had room.
fn selection_fits(status: &Status) -> bool {
    let lists = (LIST_ACTIVE..LIST_ACTIVE + 16).chain([LIST_PATCHES, LIST_LEAVES, LIST_CUT]);
    lists.into_iter().all(|list| status.heads[list].count <= status.heads[list].capacity)
}

#[test]
fn frames_of_short_lists_draw_a_part_tell_what_they_need_and_are_right_after_growing() {
    let lab = Lab::new();
    let spacing = Spacing::FractionalOdd;
    let easel = Easel::new(&lab, spacing, false, SIZE);
    let mut room = World::of_objects(&lab.device, 4, None);
    let camera = room.cameras(SIZE)[0];
    let all = |entries: &Emitted| -> HashSet<(u32, u32)> {
        entries.iter().flatten().map(|entry| (entry.object, entry.place)).collect()
    };
    for (density, culling) in [(Density::EdgePixels(0.5), Culling::Off), (Density::Tess(90.0), Culling::Unseen)] {
        for (selection, capacity) in [(Selection::Dynamic, 1), (Selection::Static, 50)] {
            let options = FrameOptions { density, selection, culling, object_lod: false };
            let image = lab.draw(&mut room.surface, &easel, &camera, &options);
            let expected = room.surface.status().expect("status");
            let entries = lab.entries(&room.surface);
            let mut short = World::of_objects(&lab.device, 4, Some(capacity));
            let mut frames = 1;
            loop {
                lab.draw_once(&short.surface, &easel, &camera, &options);
                let status = short.surface.status().expect("status");
                let drawn = lab.unsorted_entries(&short.surface);
                assert!(all(&drawn).is_subset(&all(&entries)), "frame {frames} lists what is not there");
                if selection_fits(&status) {
                    // How entries fall into draws depends on their order.
                    let needs = |status: &Status| status.draw_heads.map(|head| head.count);
                    assert_eq!(needs(&status), needs(&expected), "frame {frames}");
                }
                if frames == 1 {
                    assert!(all(&drawn).len() < all(&entries).len());
                }
                if !short.surface.grow(&lab.device).expect("room") {
                    break;
                }
                frames += 1;
            }
            println!("{density:?} {selection:?}, at first {capacity}: {frames} frames");
            // One that is too short; one with room for all faces; where patches are cut one each for them and their pieces.
            assert!((2..=4).contains(&frames), "{frames} frames");
            assert_eq!(lab.entries(&short.surface), entries);
            assert_eq!(short.surface.status().expect("status").counts, expected.counts);
            assert!(easel.words(&lab.device) == image, "{density:?} {selection:?} {capacity}");
        }
    }
    lab.assert_silent();
}
