//! The lists of Gregory patches against their CPU twin, bit for bit.

use planish_render::lists::LEVEL_COUNT;
use planish_render::{Culling, Density, FrameOptions, PatchKind, Selection};
use planish_subdiv::tables::GregoryKind;

use crate::gregory::{DESC, SCENES};
use crate::lab::{Lab, SPACINGS};
use crate::twin::Twin;
use crate::world::{World, scene};

const SIZE: [u32; 2] = [96, 64];
/// The last has more segments than the tessellator makes.
const DENSITIES: [Density; 3] = [Density::EdgePixels(12.0), Density::Tess(3.4), Density::Tess(150.0)];
const CULLINGS: [Culling; 3] = [Culling::Off, Culling::Unseen, Culling::UnseenAndBacks];

/// The patches that the lists say are drawn, by level: quads, and triangles by their first thirds.
fn drawn(world: &World, entries: &planish_render::emit::Emitted) -> [[u32; LEVEL_COUNT]; 2] {
    let tables = world.surface.tables();
    let mut counts = [[0; LEVEL_COUNT]; 2];
    for (kind, count) in [(PatchKind::Gregory, 0), (PatchKind::Triangle, 1)] {
        for entry in &entries[kind as usize] {
            let face = &tables.gregory.faces[entry.place as usize];
            let level = usize::from(tables.irregular[entry.place as usize].info.level);
            match face.kind {
                GregoryKind::PartOfTriangle(0) => counts[count][level - 1] += 1,
                GregoryKind::PartOfTriangle(_) => {}
                _ => counts[count][level] += 1,
            }
        }
    }
    counts
}

#[test]
fn lists_of_gregory_patches_are_those_of_their_twin() {
    let lab = Lab::gregory();
    let mut found = [0; PatchKind::ALL.len()];
    let objects = World::with_objects(&lab.device, DESC);
    let worlds = SCENES.into_iter().chain(["cube", "genus_2", "tetrahedron"]).enumerate().map(|(turn, name)| {
        let (meshes, objects) = scene(name, turn % 3 != 0);
        World::with_desc(&lab.device, name, meshes, objects, DESC, None)
    });
    for (turn, mut world) in worlds.chain([objects]).enumerate() {
        for (c, camera) in world.cameras(SIZE).into_iter().enumerate() {
            for (d, &density) in DENSITIES.iter().enumerate() {
                let (spacing, culling) = (SPACINGS[(c + d + turn) % 3], CULLINGS[(c + 2 * d + turn) % 3]);
                let options = FrameOptions { density, selection: Selection::Dynamic, culling, object_lod: false };
                world.move_cages(c + d);
                let status = lab.run(&mut world.surface, spacing, &camera, &options);
                let twin = Twin::new(&lab, &world, spacing, &camera, &options);
                let named = format!("{} from {} {spacing:?} {options:?}", world.name, camera.eye());
                let entries = lab.entries(&world.surface);
                for kind in PatchKind::ALL {
                    let (made, expected) = (&entries[kind as usize], &twin.entries[kind as usize]);
                    assert_eq!(made, expected, "{kind:?} patches: {named}");
                    found[kind as usize] += made.len();
                }
                if entries.iter().zip(PatchKind::ALL).all(|(entries, kind)| entries.is_empty() || !kind.is_cut()) {
                    let counts = [&status.counts.gregory, &status.counts.triangle];
                    let told = drawn(&world, &entries);
                    assert_eq!(counts.map(|counts| counts.to_vec()), told.map(|told| told.to_vec()), "{named}");
                }
            }
        }
    }
    println!("{found:?}");
    for kind in PatchKind::of_method(DESC.method, DESC.end_cap) {
        assert!(found[*kind as usize] > 400, "{kind:?}: {found:?}");
    }
    lab.assert_silent();
}
