//! Holes: masks, veils and backs that are not there.

use glam::{Affine3A, Vec3};
use planish_render::ObjectDesc;
use planish_render::shading::{
    Alpha, MaterialDesc, ObjectMaterials, ShadingDesc, Texels, TextureDesc, TextureUseDesc, TextureWrap,
};

use super::darkroom::{Darkroom, camera, glowing, halves, on_wall, wall};

const SIZE: [u32; 2] = [32, 32];

fn object(material: usize) -> ObjectMaterials {
    ObjectMaterials { materials: vec![Some(material)], mesh: 0, id: 0 }
}

#[test]
fn a_mask_cuts_where_opacity_times_its_channel_is_below_the_threshold() {
    let room = Darkroom::new(true);
    let opacities = [0.1, 0.4, 0.55, 0.9];
    let texels = opacities.map(|alpha| halves([0.95, 0.05, 0.5, alpha]));
    let wrap = [TextureWrap::Clamp; 2];
    let textures = [TextureDesc { size: [4, 1], texels: Texels::Halves(&texels), wrap, is_nearest: true }];
    let used = TextureUseDesc { channel: 3, ..TextureUseDesc::plain(0) };
    let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 35.0, SIZE);
    for (threshold, opacity) in [(0.5, 1.0), (0.25, 1.0), (0.25, 0.5), (0.7, 1.0)] {
        let textures_of = std::array::from_fn(|i| (i == 1).then_some(used));
        let material =
            MaterialDesc { alpha: Alpha::Mask(threshold), opacity, textures: textures_of, ..glowing([1.0; 3]) };
        let desc = ShadingDesc {
            textures: &textures,
            materials: &[material],
            objects: &[object(0)],
            ..ShadingDesc::default()
        };
        let mut subject = room.subject(&[wall(1, 1.0)], &[ObjectDesc::identity(0)], &desc);
        let frame = room.shoot(&mut subject, &camera, &[], 1);
        let mut compared = 0;
        for x in 0..SIZE[0] {
            let at = (on_wall(&camera, x, 16).x + 1.0) * 2.0;
            if (0.05..3.95).contains(&at) && (at - at.round()).abs() > 0.05 {
                let is_there = opacity * opacities[at as usize] >= threshold;
                let found = frame.color[(16 * SIZE[0] + x) as usize][3];
                assert_eq!(found, f32::from(u8::from(is_there)), "{threshold} {opacity} at {at}");
                compared += 1;
            }
        }
        assert!(compared > 24);
    }
    room.assert_silent();
}

#[test]
fn veils_before_each_other_let_the_product_of_what_each_lets_through_pass() {
    let room = Darkroom::new(true);
    let veil = MaterialDesc { alpha: Alpha::Blend, opacity: 0.5, ..glowing([1.0; 3]) };
    let desc =
        ShadingDesc { materials: &[veil], objects: &[object(0), object(0), object(0)], ..ShadingDesc::default() };
    let at = |z: f32| ObjectDesc { to_world: Affine3A::from_translation(Vec3::Z * z), ..ObjectDesc::identity(0) };
    let mut subject = room.subject(&[wall(1, 1.0)], &[at(0.0), at(-0.2), at(-0.4)], &desc);
    let samples = 16;
    let frame = room.shoot(&mut subject, &camera([0.0, 0.0, 3.0], [0.0; 3], 30.0, SIZE), &[], samples);
    let coverage: Vec<f32> = frame.color.iter().map(|color| color[3]).collect();
    let mean = coverage.iter().sum::<f32>() / coverage.len() as f32;
    let deviation = (0.875 * 0.125 / samples as f32).sqrt();
    assert!((mean - 0.875).abs() < 4.0 * deviation / (coverage.len() as f32).sqrt(), "{mean}");
    // Every sample of a pixel is another draw: pixels differ by no more than that.
    let variance = coverage.iter().map(|value| (value - 0.875).powi(2)).sum::<f32>() / coverage.len() as f32;
    assert!(variance.sqrt() < 1.2 * deviation, "{} of {deviation}", variance.sqrt());
    room.assert_silent();
}

#[test]
fn the_back_of_a_single_sided_material_is_not_there() {
    let room = Darkroom::new(true);
    let materials = [MaterialDesc { double_sided: false, ..glowing([1.0; 3]) }, glowing([1.0; 3])];
    assert!(materials[0].has_holes() && !materials[1].has_holes());
    let mirrored = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    for to_world in [Affine3A::IDENTITY, mirrored] {
        for (material, seen_from_behind) in [(0, 0.0), (1, 1.0)] {
            let desc = ShadingDesc { materials: &materials, objects: &[object(material)], ..ShadingDesc::default() };
            let placed = ObjectDesc { to_world, ..ObjectDesc::identity(0) };
            let mut subject = room.subject(&[wall(1, 1.0)], &[placed], &desc);
            for (z, expected) in [(3.0, 1.0), (-3.0, seen_from_behind)] {
                let frame = room.shoot(&mut subject, &camera([0.0, 0.0, z], [0.0; 3], 30.0, SIZE), &[], 1);
                assert_eq!(frame.color[16 * 32 + 16][3], expected, "material {material} from {z}");
            }
        }
    }
    room.assert_silent();
}
