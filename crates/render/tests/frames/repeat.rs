//! The same frame twice.

use planish_render::{Culling, Density, FrameOptions, Selection};

use crate::lab::{Easel, Lab, SPACINGS};
use crate::world::World;

const SIZE: [u32; 2] = [96, 64];
/// Many patches, surfaces that lie in one another, and several objects.
const SCENES: [&str; 7] = [
    "hero",
    "duplicate_quad",
    "double_sided_quad",
    "nonmanifold_book_5",
    "valence_2_closed",
    "ngon_40",
    "several.json",
];

#[test]
fn the_same_frame_twice_has_the_same_lists_and_the_same_bits() {
    let lab = Lab::new();
    let easels = SPACINGS.map(|spacing| Easel::new(&lab, spacing, false, SIZE));
    for (turn, name) in SCENES.into_iter().enumerate() {
        let mut world = World::of_scene(&lab.device, name, 4, false);
        let [outside, _, inside, _, part] = world.cameras(SIZE);
        for (i, (density, culling)) in
            [(Density::EdgePixels(1.5), Culling::Off), (Density::EdgePixels(6.0), Culling::Unseen)]
                .into_iter()
                .enumerate()
        {
            let selection = if (turn + i) % 2 == 0 { Selection::Dynamic } else { Selection::Static };
            let options = FrameOptions { density, selection, culling, object_lod: false };
            let easel = &easels[(turn + i) % 3];
            for camera in [&outside, &part] {
                let image = lab.draw(&mut world.surface, easel, camera, &options);
                let entries = lab.entries(&world.surface);
                let counts = world.surface.status().expect("status").counts;
                // Another frame, which leaves other things behind.
                lab.draw(&mut world.surface, easel, &inside, &options);
                let again = lab.draw(&mut world.surface, easel, camera, &options);
                assert_eq!(lab.entries(&world.surface), entries, "{name} {options:?}");
                assert_eq!(world.surface.status().expect("status").counts, counts, "{name} {options:?}");
                assert!(again == image, "{name} {options:?} from {}", camera.eye());
                assert!(image[3].iter().any(|&word| word != planish_render::NO_SURFACE), "{name} is not seen");
            }
        }
    }
    lab.assert_silent();
}
