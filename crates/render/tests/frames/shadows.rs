//! Shadows: where light is kept away, and where it is not.

use std::f32::consts::PI;

use glam::{Affine3A, Quat, Vec3};
use planish_render::shading::{LightDesc, LightKind, MaterialDesc, ObjectMaterials, ShadedFrame, ShadingDesc, Shadows};
use planish_render::{FrameCamera, ObjectDesc, SurfaceDesc, SurfaceMethod};

use super::darkroom::{Darkroom, Subject, camera, on_wall, sun, wall};
use super::world;

const SIZE: [u32; 2] = [96, 96];
/// Half the side of the plate that casts the shadow, and how far it is above the floor.
const PLATE: f32 = 0.5;
const HEIGHT: f32 = 1.0;

/// The floor is the plane z = 0, as wide as the frame shows, and +z is up.
fn plate_over_floor(room: &Darkroom) -> (Subject, FrameCamera) {
    let white = [MaterialDesc { base_color: [1.0; 3], ior: 1.0, ..MaterialDesc::default() }];
    let object = |id| ObjectMaterials { materials: vec![Some(0)], mesh: 0, id };
    let desc = ShadingDesc { materials: &white, objects: &[object(1), object(2)], ..ShadingDesc::default() };
    let scaled = |scale: f32, up: f32| ObjectDesc {
        to_world: Affine3A::from_scale_rotation_translation(Vec3::splat(scale), Quat::IDENTITY, Vec3::Z * up),
        ..ObjectDesc::identity(0)
    };
    let subject = room.subject(&[wall(4, 1.0)], &[scaled(3.0, 0.0), scaled(PLATE, HEIGHT)], &desc);
    (subject, camera([0.0, -2.0, 6.0], [0.0, 0.2, 0.0], 40.0, SIZE))
}

/// How much of a light a pixel of the floor has, by what it has without shadows; none where it shows no floor.
fn share(lit: &ShadedFrame, bare: &ShadedFrame, pixel: usize) -> Option<f32> {
    let is_floor = bare.objects[pixel].len() == 1 && bare.objects[pixel][0].id == 1;
    (is_floor && bare.color[pixel][0] > 1e-3).then(|| lit.color[pixel][0] / bare.color[pixel][0])
}

/// How far inside the plate's square, if above 0, the way from a place on the floor to the light passes it.
fn inside_plate(place: Vec3, to_light: Vec3) -> f32 {
    let at = place + to_light * (HEIGHT / to_light.z);
    PLATE - at.x.abs().max(at.y.abs())
}

#[test]
fn a_plate_keeps_light_from_the_floor_beneath_it_and_from_nowhere_else() {
    let room = Darkroom::new(false);
    let (mut subject, camera) = plate_over_floor(&room);
    let place = Vec3::new(0.4, -0.3, 2.6);
    let lamp = |kind, angle: f32| LightDesc {
        kind,
        to_world: Affine3A::from_rotation_translation(Quat::from_rotation_y(angle), place),
        intensity: [9.0; 3],
        casts_shadows: true,
    };
    let spot = LightKind::Spot { radius: 0.0, range: f32::INFINITY, inner: 0.5, outer: 0.8 };
    let wide = LightKind::Spot { radius: 0.0, range: f32::INFINITY, inner: 0.9, outer: 1.5 };
    let point = LightKind::Point { radius: 0.0, range: f32::INFINITY };
    let lights = [
        ("sun", sun([0.5, 0.3, 1.0], 2.0, 0.0)),
        ("point", lamp(point, 0.3)),
        ("spot", lamp(spot, 0.1)),
        ("wide spot", lamp(wide, -0.2)),
    ];
    for (name, light) in lights {
        let lit = room.shoot(&mut subject, &camera, &[light], 1);
        let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 1);
        let (mut dark, mut bright) = (0, 0);
        for pixel in 0..lit.color.len() {
            let Some(share) = share(&lit, &bare, pixel) else { continue };
            let floor = on_wall(&camera, pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
            let to_light = if name == "sun" { Vec3::new(0.5, 0.3, 1.0) } else { place - floor };
            let inside = inside_plate(floor, to_light);
            // Texels of the coarsest map are 3 % wide.
            if inside > 0.05 {
                assert_eq!(share, 0.0, "{name}: {floor} lies in the dark");
                dark += 1;
            } else if inside < -0.05 {
                assert!(share > 0.999, "{name}: {floor} is lit, not {share}");
                bright += 1;
            }
        }
        assert!(dark > 50 && bright > 2000, "{name}: {dark} {bright}");
    }
    room.assert_silent();
}

#[test]
fn grazing_light_makes_no_shadow_on_a_plane() {
    let room = Darkroom::new(false);
    let white = [MaterialDesc { base_color: [1.0; 3], ior: 1.0, ..MaterialDesc::default() }];
    let objects = [ObjectMaterials { materials: vec![Some(0)], mesh: 0, id: 1 }];
    let desc = ShadingDesc { materials: &white, objects: &objects, ..ShadingDesc::default() };
    let mut subject = room.subject(&[wall(3, 1.0)], &[ObjectDesc::identity(0)], &desc);
    let camera = camera([0.0, -1.0, 2.5], [0.0; 3], 40.0, SIZE);
    for degrees in [90.0_f32, 45.0, 20.0, 8.0, 3.0] {
        let (z, x) = degrees.to_radians().sin_cos();
        let light = sun([x, 0.3 * x, z], 1.0, 0.0);
        let lit = room.shoot(&mut subject, &camera, &[light], 1);
        let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 1);
        for pixel in 0..lit.color.len() {
            if let Some(share) = share(&lit, &bare, pixel) {
                assert!(share > 0.999, "{degrees} degrees: {share}");
            }
        }
    }
    room.assert_silent();
}

#[test]
fn a_ball_casts_no_spots_on_its_lit_side() {
    let room = Darkroom::new(false);
    let (mut meshes, _) = world::scene("cube", false);
    let white = [MaterialDesc { base_color: [1.0; 3], ior: 1.0, ..MaterialDesc::default() }];
    let objects = [ObjectMaterials { materials: vec![Some(0)], mesh: 0, id: 1 }];
    let desc = ShadingDesc { materials: &white, objects: &objects, ..ShadingDesc::default() };
    let mut subject = room.subject(&[meshes.remove(0)], &[ObjectDesc::identity(0)], &desc);
    let camera = camera([0.0, 0.0, 4.0], [0.0; 3], 35.0, SIZE);
    let light = sun([1.0, 0.6, 0.7], PI, 0.0);
    let lit = room.shoot(&mut subject, &camera, &[light], 1);
    let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 1);
    let mut seen = 0;
    for pixel in 0..lit.color.len() {
        // The cosine of the light, as intensity and albedo are.
        if bare.color[pixel][0] > 0.08 {
            let share = share(&lit, &bare, pixel).expect("a ball");
            assert!(share > 0.98, "{share} where the cosine is {}", bare.color[pixel][0]);
            seen += 1;
        }
    }
    assert!(seen > 1000);
    room.assert_silent();
}

#[test]
fn a_shadow_begins_where_a_wall_stands_on_the_floor() {
    let room = Darkroom::new(false);
    let white = [MaterialDesc { base_color: [1.0; 3], ior: 1.0, ..MaterialDesc::default() }];
    let object = |id| ObjectMaterials { materials: vec![Some(0)], mesh: 0, id };
    let desc = ShadingDesc { materials: &white, objects: &[object(1), object(2)], ..ShadingDesc::default() };
    // A wall across the floor at x = 0, from 0 to 1.
    let upright = Affine3A::from_scale_rotation_translation(
        Vec3::new(0.5, 0.9, 1.0),
        Quat::from_rotation_y(0.5 * PI),
        Vec3::new(0.0, 0.0, 0.5),
    );
    let objects = [ObjectDesc::identity(0), ObjectDesc { to_world: upright, ..ObjectDesc::identity(0) }];
    let mut subject = room.subject(&[wall(4, 1.0)], &objects, &desc);
    let camera = camera([0.0, 0.0, 6.0], [0.0; 3], 18.0, [192, 192]);
    let light = sun([1.0, 0.0, 0.5], 2.0, 0.0);
    let lit = room.shoot(&mut subject, &camera, &[light], 1);
    let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 1);
    // Behind the wall, four texels of the map away from it.
    let texel = 2.0 * 1.5 / 512.0;
    for (distance, expected) in [(-4.0 * texel, 0.0), (-0.1, 0.0), (-0.8, 0.0), (4.0 * texel, 1.0), (0.5, 1.0)] {
        let x = (96.0 + 96.0 * distance / (6.0 * 9.0_f32.to_radians().tan())) as u32;
        let floor = on_wall(&camera, x, 96);
        assert!((floor.x - distance).abs() < 0.02, "{floor}");
        let found = share(&lit, &bare, (96 * 192 + x) as usize).expect("floor");
        assert!((found - expected).abs() < 0.01, "{distance}: {found}");
    }
    room.assert_silent();
}

#[test]
fn a_wide_sun_has_a_penumbra_as_wide_as_it_should_be() {
    let room = Darkroom::new(false);
    let (mut subject, camera) = plate_over_floor(&room);
    let angle = 12.0_f32;
    let light = sun([0.8, 0.0, 1.0], 2.0, angle);
    let lit = room.shoot(&mut subject, &camera, &[light], 48);
    let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 48);
    let to_light = Vec3::new(0.8, 0.0, 1.0);
    // Along x the disk of the sun is seen from the side: its image on the floor is longer by the squared secant.
    let reach = (0.5 * angle).to_radians().tan() * HEIGHT * (1.0 + 0.8 * 0.8);
    let mut checked = [0; 3];
    for pixel in 0..lit.color.len() {
        let Some(share) = share(&lit, &bare, pixel) else { continue };
        let floor = on_wall(&camera, pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
        let at = floor + to_light * HEIGHT;
        if at.y.abs() > 0.3 {
            continue;
        }
        let inside = (PLATE - at.x.abs()) / reach;
        let (case, expected) = match inside {
            i if i > 1.25 => (0, 0.0..=0.0),
            i if i < -1.25 => (1, 0.999..=1.001),
            // A chord of the disk; 48 samples of it.
            i if i.abs() < 0.08 => (2, 0.3..=0.7),
            _ => continue,
        };
        assert!(expected.contains(&share), "{inside}: {share}");
        checked[case] += 1;
    }
    assert!(checked.iter().all(|&count| count > 4), "{checked:?}");
    room.assert_silent();
}

#[test]
fn a_round_lamp_has_a_penumbra_as_wide_as_it_should_be() {
    let room = Darkroom::new(false);
    let (mut subject, camera) = plate_over_floor(&room);
    let (radius, up) = (0.3, 2.6);
    let lamp = |kind| LightDesc {
        kind,
        to_world: Affine3A::from_translation(Vec3::Z * up),
        intensity: [9.0; 3],
        casts_shadows: true,
    };
    let range = f32::INFINITY;
    for kind in [LightKind::Point { radius, range }, LightKind::Spot { radius, range, inner: 0.9, outer: 1.5 }] {
        let light = lamp(kind);
        assert!(Shadows::varies(&[light]));
        let lit = room.shoot(&mut subject, &camera, &[light], 16);
        let bare = room.shoot(&mut subject, &camera, &[LightDesc { casts_shadows: false, ..light }], 16);
        // From the lamp's middle the plate's edge falls here, and its rim is seen over that edge from so far to each side.
        let edge = PLATE * up / (up - HEIGHT);
        let reach = radius * HEIGHT / (up - HEIGHT);
        let mut checked = [0; 3];
        for pixel in 0..lit.color.len() {
            let Some(share) = share(&lit, &bare, pixel) else { continue };
            let floor = on_wall(&camera, pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
            if floor.y.abs() > 0.4 {
                continue;
            }
            let (case, expected) = match (edge - floor.x.abs()) / reach {
                i if i > 1.35 => (0, 0.0..=0.0),
                i if i < -1.35 => (1, 0.99..=1.01),
                i if i.abs() < 0.1 => (2, 0.25..=0.75),
                _ => continue,
            };
            assert!(expected.contains(&share), "{floor}: {share}");
            checked[case] += 1;
        }
        assert!(checked.iter().all(|&count| count > 4), "{checked:?}");
    }
    assert!(!Shadows::varies(&[lamp(LightKind::Point { radius: 0.0, range })]));
    room.assert_silent();
}

#[test]
fn every_method_shades_the_same_ball() {
    let mut means = Vec::new();
    for method in
        [SurfaceMethod::Dfas, SurfaceMethod::Gregory, SurfaceMethod::Acc, SurfaceMethod::Pm, SurfaceMethod::Uniform]
    {
        let level = if method.is_one_patch_a_face() { 0 } else { 4 };
        let room = Darkroom::with_desc(false, SurfaceDesc { method, level, ..SurfaceDesc::default() });
        let (mut meshes, _) = world::scene("cube", false);
        let materials = [MaterialDesc { base_color: [0.8, 0.4, 0.2], roughness: 0.3, ..MaterialDesc::default() }];
        let objects = [ObjectMaterials { materials: vec![Some(0)], mesh: 0, id: 1 }];
        let desc = ShadingDesc { materials: &materials, objects: &objects, ..ShadingDesc::default() };
        let mut subject = room.subject(&[meshes.remove(0)], &[ObjectDesc::identity(0)], &desc);
        let camera = camera([1.0, 1.5, 4.0], [0.0; 3], 35.0, SIZE);
        let frame = room.shoot(&mut subject, &camera, &[sun([1.0, 1.0, 0.7], PI, 0.0)], 1);
        let mean =
            |channel: usize| frame.color.iter().map(|color| color[channel]).sum::<f32>() / frame.color.len() as f32;
        means.push([mean(0), mean(1), mean(3)]);
        room.assert_silent();
    }
    for mean in &means {
        for (found, expected) in mean.iter().zip(&means[0]) {
            // The others approximate the limit surface.
            assert!((found / expected - 1.0).abs() < 0.05, "{means:?}");
        }
    }
}
