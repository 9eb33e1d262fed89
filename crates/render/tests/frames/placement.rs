//! Images on surfaces: turned, stretched and mirrored ones, of sides that differ, with normals that turn with them.

use std::f32::consts::PI;

use glam::Vec3;
use planish_render::ObjectDesc;
use planish_render::shading::{
    MaterialDesc, ObjectMaterials, ShadingDesc, Texels, TextureDesc, TextureUseDesc, TextureWrap,
};

use super::darkroom::{Darkroom, camera, glowing, halves, on_wall, sun, wall};

fn object() -> ObjectMaterials {
    ObjectMaterials { materials: vec![Some(0)], mesh: 0, id: 0 }
}

/// What a wrapped image of a side of texels shows at a place, or none.
fn texel(wrap: TextureWrap, at: f32, size: i32) -> Option<i32> {
    let texel = (at * size as f32).floor() as i32;
    match wrap {
        TextureWrap::Repeat => Some(texel.rem_euclid(size)),
        TextureWrap::Mirror => Some(texel.rem_euclid(2 * size)).map(|i| if i < size { i } else { 2 * size - 1 - i }),
        TextureWrap::Clamp => Some(texel.clamp(0, size - 1)),
        TextureWrap::Black => (0..size).contains(&texel).then_some(texel),
    }
}

#[test]
fn an_image_lies_where_its_transform_says_and_wraps_along_each_axis_by_itself() {
    let room = Darkroom::new(false);
    let size = [4, 2];
    let texels: Vec<_> = (0..8).map(|i| halves([i as f32 / 8.0 + 0.1, (i * i % 8) as f32 / 8.0, 0.25, 1.0])).collect();
    // Neither a rotation nor symmetric: each of the six numbers tells.
    let transform = [[1.9, -1.1, 0.4], [0.7, 1.6, -0.9]];
    let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 36.0, [48, 48]);
    let textures_of = TextureUseDesc { transform, ..TextureUseDesc::plain(0) };
    let material =
        MaterialDesc { textures: std::array::from_fn(|i| (i == 6).then_some(textures_of)), ..glowing([1.0; 3]) };
    for wrap in [
        [TextureWrap::Repeat, TextureWrap::Clamp],
        [TextureWrap::Black, TextureWrap::Mirror],
        [TextureWrap::Mirror, TextureWrap::Repeat],
    ] {
        let textures = [TextureDesc { size, texels: Texels::Halves(&texels), wrap, is_nearest: true }];
        let desc =
            ShadingDesc { textures: &textures, materials: &[material], objects: &[object()], ..ShadingDesc::default() };
        let mut subject = room.subject(&[wall(1, 1.0)], &[ObjectDesc::identity(0)], &desc);
        let frame = room.shoot(&mut subject, &camera, &[], 1);
        let mut compared = 0;
        for (x, y) in (1..47).step_by(3).flat_map(|y| (1..47).map(move |x| (x, y))) {
            let p = on_wall(&camera, x, y);
            let (s, t) = (0.5 * (p.x + 1.0), 0.5 * (1.0 - p.y));
            let at = transform.map(|[a, b, c]| a * s + b * t + c);
            let edge = |at: f32, size: f32| (at * size - (at * size).round()).abs();
            if p.abs().max_element() > 0.99 || edge(at[0], 4.0) < 0.05 || edge(at[1], 2.0) < 0.05 {
                continue;
            }
            let place = texel(wrap[0], at[0], 4).zip(texel(wrap[1], at[1], 2));
            let expected = place.map_or(0.0, |(column, row)| texels[(4 * row + column) as usize][0].to_f32());
            let found = frame.color[(y * 48 + x) as usize][0];
            assert!((found - expected).abs() < 1e-3, "{wrap:?} at {at:?}: {found}, expected {expected}");
            compared += 1;
        }
        assert!(compared > 300, "{compared}");
    }
    room.assert_silent();
}

#[test]
fn normals_turn_with_the_image_that_they_are_of() {
    let room = Darkroom::new(false);
    // Tilted by 30 degrees to the right, and up.
    let texels = [[halves([0.75, 0.5, 0.933, 1.0])], [halves([0.5, 0.75, 0.933, 1.0])]];
    let textures = texels.each_ref().map(|texels| TextureDesc {
        size: [1, 1],
        texels: Texels::Halves(texels),
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    });
    let size = [16, 16];
    let light = Vec3::new(0.5, 0.3, 1.0).normalize();
    let (x, y) = (Vec3::X, Vec3::Y);
    // Transforms of the image, and where its right and its upper side lie then. The wall's s grows along x, its t along -y.
    let cases = [
        ("turned", [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]], -y, x),
        ("mirrored", [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], -y, -x),
        ("upside down", [[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]], x, -y),
        ("stretched", [[3.0, 0.0, 0.0], [0.0, 0.5, 0.0]], x, y),
    ];
    for (name, transform, right, up) in cases {
        for (texture, axis) in [(0, right), (1, up)] {
            let used = TextureUseDesc { transform, scale: [2.0; 4], bias: [-1.0; 4], ..TextureUseDesc::plain(texture) };
            let material = MaterialDesc {
                base_color: [1.0; 3],
                ior: 1.0,
                textures: std::array::from_fn(|i| (i == 4).then_some(used)),
                ..MaterialDesc::default()
            };
            let desc = ShadingDesc {
                textures: &textures,
                materials: &[material],
                objects: &[object()],
                ..ShadingDesc::default()
            };
            let mut subject = room.subject(&[wall(1, 1.0)], &[ObjectDesc::identity(0)], &desc);
            let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 20.0, size);
            let frame = room.shoot(&mut subject, &camera, &[sun(light.into(), PI, 0.0)], 1);
            let expected = (0.5 * axis + 0.866 * Vec3::Z).normalize().dot(light);
            let found = frame.color[8 * 16 + 8][0];
            assert!((found - expected).abs() < 4e-3, "{name} {texture}: {found}, expected {expected}");
        }
    }
    room.assert_silent();
}
