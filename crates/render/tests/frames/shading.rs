//! Shading: what surfaces of known materials show under known light.

use std::f32::consts::PI;

use glam::{Affine3A, Mat3, Quat, Vec3};
use half::f16;
use planish_render::shading::{
    Alpha, EnvironmentDesc, LightDesc, LightKind, MaterialDesc, ObjectMaterials, ShadedFrame, ShadingDesc, Texels,
    TextureDesc, TextureUseDesc, TextureWrap, ptex_slots,
};
use planish_render::{DisplacementDesc, ObjectDesc, SurfaceDesc, SurfaceMethod};

use planish_subdiv::mesh::{VertexColors, VertexInterpolation};

use super::darkroom::{Darkroom, camera, even, glowing, halves, on_wall, sun, wall};
use super::world;

fn object(materials: &[usize]) -> ObjectMaterials {
    ObjectMaterials { materials: materials.iter().copied().map(Some).collect(), mesh: 0, id: 7 }
}

fn at(frame: &ShadedFrame, size: [u32; 2], x: u32, y: u32) -> [f32; 4] {
    frame.color[(y * size[0] + x) as usize]
}

fn near(found: f32, expected: f32, bound: f32, what: &str) {
    assert!((found - expected).abs() <= bound, "{what}: found {found}, expected {expected}");
}

#[test]
fn white_surfaces_in_even_light_are_as_bright_as_it() {
    let room = Darkroom::new(false);
    let roughness = [0.0, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0];
    let of = |metallic: f32, roughness: f32, coat: f32| MaterialDesc {
        base_color: [1.0; 3],
        metallic,
        roughness,
        clearcoat: coat,
        clearcoat_roughness: 0.3,
        ..MaterialDesc::default()
    };
    // A row of metals, of dielectrics, of coated metals, and metals again.
    let rows = [(1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (1.0, 0.0)];
    let materials: Vec<MaterialDesc> =
        rows.iter().flat_map(|&(metallic, coat)| roughness.map(|roughness| of(metallic, roughness, coat))).collect();
    let mesh = wall(8, 1.0);
    let slots: Vec<u32> = (0..64).map(|face| face / 16 * 8 + face % 8).collect();
    let face_slots = [ptex_slots(&mesh, &slots)];
    let all: Vec<usize> = (0..32).collect();
    let desc = ShadingDesc {
        materials: &materials,
        face_slots: &face_slots,
        objects: &[object(&all)],
        environment: Some(even(1.0)),
        ..ShadingDesc::default()
    };
    let mut subject = room.subject(&[mesh], &[ObjectDesc::identity(0)], &desc);
    let size = [64, 64];
    for (name, eye) in [("facing", [0.0, 0.0, 3.0]), ("aslant", [0.0, -2.6, 1.5]), ("grazing", [-2.9, 0.0, 0.8])] {
        let frame = room.shoot(&mut subject, &camera(eye, [0.0; 3], 40.0, size), &[], 1);
        let covered = frame.color.iter().filter(|color| color[3] > 0.0);
        assert!(covered.clone().count() > 500);
        for color in covered {
            near(color[0], 1.0, 0.02, name);
        }
    }
    room.assert_silent();
}

#[test]
fn a_lambert_wall_reflects_albedo_over_pi_of_what_it_receives() {
    let room = Darkroom::new(false);
    let materials = [MaterialDesc { base_color: [0.5; 3], ior: 1.0, ..MaterialDesc::default() }];
    let desc = ShadingDesc { materials: &materials, objects: &[object(&[0])], ..ShadingDesc::default() };
    let mut subject = room.subject(&[wall(2, 1.0)], &[ObjectDesc::identity(0)], &desc);
    let size = [32, 32];
    let camera = camera([0.3, 0.2, 3.0], [0.0; 3], 35.0, size);
    // The sun at 60 degrees gives half.
    let frame = room.shoot(&mut subject, &camera, &[sun([0.0, 3.0_f32.sqrt(), 1.0], 2.0, 0.0)], 1);
    near(at(&frame, size, 16, 16)[0], 0.5 / PI, 1e-3, "sun");

    let place = Vec3::new(0.2, -0.3, 1.1);
    let (range, inner, outer) = (2.2, 0.3_f32, 0.7_f32);
    let lamp = |kind| LightDesc {
        kind,
        to_world: Affine3A::from_translation(place),
        intensity: [4.0; 3],
        casts_shadows: true,
    };
    let point = room.shoot(&mut subject, &camera, &[lamp(LightKind::Point { radius: 0.0, range })], 1);
    let spot_kind = LightKind::Spot { radius: 0.0, range: f32::INFINITY, inner, outer };
    let spot = room.shoot(&mut subject, &camera, &[lamp(spot_kind)], 1);
    for (x, y) in [(16, 16), (4, 5), (20, 12), (9, 27), (19, 18), (25, 20)] {
        let way = place - on_wall(&camera, x, y);
        let (distance, cosine) = (way.length(), way.normalize().z);
        let window = (1.0 - (distance / range).powi(4)).clamp(0.0, 1.0);
        let lambert = 0.5 / PI * 4.0 * cosine / (distance * distance);
        near(at(&point, size, x, y)[0], lambert * window, 2e-3, "point");
        let cone = ((cosine - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0);
        near(at(&spot, size, x, y)[0], lambert * cone * cone, 2e-3, "spot");
    }
    room.assert_silent();
}

const PALETTE: [[f32; 4]; 4] = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0]];

/// What a 2 x 2 texture has at a texel, beyond its edges too.
fn palette_texel(wrap: TextureWrap, x: i32, y: i32) -> [f32; 4] {
    let one = |i: i32| match wrap {
        TextureWrap::Repeat => Some(i.rem_euclid(2)),
        TextureWrap::Mirror => Some(if i.rem_euclid(4) < 2 { i.rem_euclid(4) } else { 3 - i.rem_euclid(4) }),
        TextureWrap::Clamp => Some(i.clamp(0, 1)),
        TextureWrap::Black => (0..2).contains(&i).then_some(i),
    };
    one(x).zip(one(y)).map_or([0.0; 4], |(x, y)| PALETTE[(2 * y + x) as usize])
}

#[test]
fn textures_are_filtered_and_wrapped_as_on_paper() {
    let room = Darkroom::new(false);
    let wraps = [TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp, TextureWrap::Black];
    let texels = PALETTE.map(halves);
    let textures: Vec<TextureDesc> = [false, true]
        .into_iter()
        .flat_map(|is_nearest| {
            wraps.map(|wrap| TextureDesc { size: [2, 2], texels: Texels::Halves(&texels), wrap: [wrap; 2], is_nearest })
        })
        .collect();
    // The wall shows the image from -1 to 2, upside down.
    let glow = |texture| MaterialDesc {
        textures: std::array::from_fn(|i| {
            let transform = [[3.0, 0.0, -1.0], [0.0, -3.0, 2.0]];
            (i == 6).then_some(TextureUseDesc { transform, ..TextureUseDesc::plain(texture) })
        }),
        ..glowing([1.0; 3])
    };
    let materials: Vec<MaterialDesc> = (0..8).map(glow).collect();
    let size = [48, 48];
    let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 36.0, size);
    for (texture, desc) in textures.iter().enumerate() {
        let objects = [object(&[texture])];
        let shading =
            ShadingDesc { textures: &textures, materials: &materials, objects: &objects, ..ShadingDesc::default() };
        let mut subject = room.subject(&[wall(1, 1.0)], &[ObjectDesc::identity(0)], &shading);
        let frame = room.shoot(&mut subject, &camera, &[], 1);
        for y in (0..48).step_by(5) {
            for x in (0..48).step_by(7) {
                let p = on_wall(&camera, x, y);
                if p.x.abs().max(p.y.abs()) > 0.99 {
                    continue;
                }
                let (s, t) = (1.5 * (p.x + 1.0) - 1.0, 2.0 - 1.5 * (1.0 - p.y));
                let (column, row) = (2.0 * s - 0.5, 2.0 * t - 0.5);
                let (share, fall) = (column - column.floor(), row - row.floor());
                // Nearest texels change at half, where a hair decides.
                if desc.is_nearest && ((share - 0.5).abs() < 0.05 || (fall - 0.5).abs() < 0.05) {
                    continue;
                }
                let [a, b] = if desc.is_nearest { [share.round(), fall.round()] } else { [share, fall] };
                let texel = |i, j| palette_texel(desc.wrap[0], column.floor() as i32 + i, row.floor() as i32 + j);
                for channel in 0..3 {
                    let upper = (1.0 - a) * texel(0, 0)[channel] + a * texel(1, 0)[channel];
                    let lower = (1.0 - a) * texel(0, 1)[channel] + a * texel(1, 1)[channel];
                    let expected = (1.0 - b) * upper + b * lower;
                    let found = at(&frame, size, x, y)[channel];
                    near(found, expected, 0.01, &format!("{:?} {} at {s} {t}", desc.wrap, desc.is_nearest));
                }
            }
        }
    }
    room.assert_silent();
}

#[test]
fn a_fine_pattern_far_away_is_its_mean_and_srgb_is_decoded_first() {
    let room = Darkroom::new(false);
    let texels: Vec<[u8; 4]> =
        (0..64 * 64).map(|i| if (i % 64 + i / 64) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }).collect();
    let texture = |is_srgb| TextureDesc {
        size: [64, 64],
        texels: Texels::Bytes { texels: &texels, is_srgb },
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    };
    let textures = [texture(true), texture(false)];
    let materials = [0, 1].map(|place| MaterialDesc {
        textures: std::array::from_fn(|i| (i == 6).then_some(TextureUseDesc::plain(place))),
        ..glowing([1.0; 3])
    });
    let objects = [object(&[0]), object(&[1])];
    let desc = ShadingDesc { textures: &textures, materials: &materials, objects: &objects, ..ShadingDesc::default() };
    let aside = |x: f32| ObjectDesc { to_world: Affine3A::from_translation(Vec3::X * x), ..ObjectDesc::identity(0) };
    let mut subject = room.subject(&[wall(1, 8.0)], &[aside(-1.0), aside(1.0)], &desc);
    let size = [64, 32];
    // From the front and at grazing angles, where a footprint is long.
    for eye in [[0.0, 0.0, 4.0], [0.0, -4.0, 0.6]] {
        let frame = room.shoot(&mut subject, &camera(eye, [0.0; 3], 20.0, size), &[], 1);
        for x in [24, 40] {
            near(at(&frame, size, x, 16)[0], 0.5, 0.02, "a mean of light");
        }
    }
    room.assert_silent();
}

#[test]
fn normal_maps_turn_the_normal_to_the_right_and_up_in_the_image() {
    let room = Darkroom::new(false);
    // Tilted by 30 degrees to the right, and up.
    let texels = [[halves([0.75, 0.5, 0.933, 1.0])], [halves([0.5, 0.75, 0.933, 1.0])]];
    let textures = texels.each_ref().map(|texels| TextureDesc {
        size: [1, 1],
        texels: Texels::Halves(texels),
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    });
    let mapped = |texture| MaterialDesc {
        base_color: [1.0; 3],
        ior: 1.0,
        textures: std::array::from_fn(|i| {
            let desc = TextureUseDesc { scale: [2.0; 4], bias: [-1.0; 4], ..TextureUseDesc::plain(texture) };
            (i == 4).then_some(desc)
        }),
        ..MaterialDesc::default()
    };
    let materials = [mapped(0), mapped(1)];
    let turned = Affine3A::from_quat(Quat::from_rotation_z(1.1));
    let mirrored = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let size = [16, 16];
    let light = Vec3::new(0.5, 0.4, 1.0).normalize();
    for (name, to_world, right, up) in [
        ("plain", Affine3A::IDENTITY, Vec3::X, Vec3::Y),
        ("turned", turned, turned.transform_vector3(Vec3::X), turned.transform_vector3(Vec3::Y)),
        ("mirrored", mirrored, -Vec3::X, Vec3::Y),
    ] {
        for (material, axis) in [(0, right), (1, up)] {
            let objects = [object(&[material])];
            let desc =
                ShadingDesc { textures: &textures, materials: &materials, objects: &objects, ..ShadingDesc::default() };
            let mut subject =
                room.subject(&[wall(1, 1.0)], &[ObjectDesc { to_world, ..ObjectDesc::identity(0) }], &desc);
            let normal = (0.5 * axis + 0.866 * Vec3::Z).normalize();
            let front = room.shoot(
                &mut subject,
                &camera([0.0, 0.0, 3.0], [0.0; 3], 20.0, size),
                &[sun(light.into(), PI, 0.0)],
                1,
            );
            near(at(&front, size, 8, 8)[0], normal.dot(light), 4e-3, name);
            // From behind a bump is a dent: the same surface, turned over.
            let behind = light * Vec3::new(1.0, 1.0, -1.0);
            let back = room.shoot(
                &mut subject,
                &camera([0.0, 0.0, -3.0], [0.0; 3], 20.0, size),
                &[sun(behind.into(), PI, 0.0)],
                1,
            );
            near(at(&back, size, 8, 8)[0], (-normal).dot(behind), 4e-3, &format!("{name}, from behind"));
        }
    }
    room.assert_silent();
}

#[test]
fn masks_cut_and_blends_cover_their_share_of_samples() {
    let room = Darkroom::new(true);
    // Opaque on the left half, empty on the right.
    let texels = [halves([1.0; 4]), halves([0.0; 4])];
    let textures = [TextureDesc {
        size: [2, 1],
        texels: Texels::Halves(&texels),
        wrap: [TextureWrap::Clamp; 2],
        is_nearest: true,
    }];
    let masked = MaterialDesc {
        alpha: Alpha::Mask(0.5),
        id: 11,
        textures: std::array::from_fn(|i| (i == 1).then_some(TextureUseDesc::plain(0))),
        ..glowing([1.0; 3])
    };
    let blended = MaterialDesc { alpha: Alpha::Blend, opacity: 0.3, id: 12, ..glowing([2.0; 3]) };
    let behind = MaterialDesc { id: 13, ..glowing([0.0, 4.0, 0.0]) };
    let materials = [masked, blended, behind];
    let far = ObjectDesc { to_world: Affine3A::from_translation(Vec3::new(0.0, 0.0, -0.5)), ..ObjectDesc::identity(0) };
    let size = [32, 32];
    let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 30.0, size);

    let desc =
        ShadingDesc { textures: &textures, materials: &materials, objects: &[object(&[0])], ..ShadingDesc::default() };
    let mut subject = room.subject(&[wall(2, 1.0)], &[ObjectDesc::identity(0)], &desc);
    let frame = room.shoot(&mut subject, &camera, &[], 1);
    assert_eq!((at(&frame, size, 8, 16)[3], at(&frame, size, 24, 16)[3]), (1.0, 0.0));

    let pair = [object(&[1]), ObjectMaterials { id: 8, ..object(&[2]) }];
    let desc = ShadingDesc { textures: &textures, materials: &materials, objects: &pair, ..ShadingDesc::default() };
    let mut subject = room.subject(&[wall(2, 1.0)], &[ObjectDesc::identity(0), far], &desc);
    let samples = 64;
    let frame = room.shoot(&mut subject, &camera, &[], samples);
    let count = (size[0] * size[1]) as f32;
    let mean = frame.color.iter().map(|color| color[0]).sum::<f32>() / count / 2.0;
    let sigma = (0.3 * 0.7 / (count * samples as f32)).sqrt();
    near(mean, 0.3, 3.0 * sigma, "a blend's mean coverage");
    for (pixel, color) in frame.color.iter().enumerate() {
        let weight = |ids: &[planish_render::shading::IdCoverage], id: u32| {
            ids.iter().find(|coverage| coverage.id == id).map_or(0.0, |coverage| coverage.weight)
        };
        near(color[0] / 2.0, weight(&frame.materials[pixel], 12), 1e-5, "the blend's own weight");
        near(
            color[1] / 4.0,
            weight(&frame.objects[pixel], 8) + 0.5 * weight(&frame.objects[pixel], 7),
            1e-5,
            "what is behind it",
        );
        for ids in [&frame.objects[pixel], &frame.materials[pixel]] {
            near(ids.iter().map(|coverage| coverage.weight).sum(), color[3], 1e-5, "weights of a pixel");
        }
    }
    room.assert_silent();
}

#[test]
fn instances_of_a_mesh_have_materials_of_their_own() {
    let room = Darkroom::new(false);
    let materials = [glowing([1.0, 0.0, 0.0]), glowing([0.0, 1.0, 0.0]), glowing([0.0, 0.0, 1.0])];
    let mesh = wall(2, 1.0);
    let face_slots = [ptex_slots(&mesh, &[0, 1, 0, 1])];
    let objects = [object(&[0, 1]), object(&[2, 1])];
    let desc =
        ShadingDesc { materials: &materials, face_slots: &face_slots, objects: &objects, ..ShadingDesc::default() };
    let aside = |x: f32| ObjectDesc { to_world: Affine3A::from_translation(Vec3::X * x), ..ObjectDesc::identity(0) };
    let mut subject = room.subject(&[mesh], &[aside(-1.0), aside(1.0)], &desc);
    let size = [64, 16];
    let frame = room.shoot(&mut subject, &camera([0.0, 0.0, 5.0], [0.0; 3], 12.0, size), &[], 1);
    let colors = [12, 28, 36, 52].map(|x| at(&frame, size, x, 8));
    let expected = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
    assert_eq!(colors, expected);
    room.assert_silent();
}

#[test]
fn the_sky_is_seen_where_it_is_and_covers() {
    let room = Darkroom::new(false);
    let size = [64, 32];
    // Red ahead along -z, green to the right, blue above.
    let sky: Vec<[f16; 4]> = (0..size[0] * size[1])
        .map(|i| {
            let (s, t) = ((i % size[0]) as f32 / 64.0, (i / size[0]) as f32 / 32.0);
            let ahead = (s - 0.5).abs() < 0.1 && (t - 0.5).abs() < 0.2;
            let right = (s - 0.75).abs() < 0.1 && (t - 0.5).abs() < 0.2;
            halves([f32::from(u8::from(ahead)), f32::from(u8::from(right)), f32::from(u8::from(t < 0.2)), 1.0])
        })
        .collect();
    let looks = [([0.0, 0.0, -1.0], 0), ([1.0, 0.0, 0.0], 1), ([0.1, 1.0, 0.0], 2)];
    let quarter = Mat3::from_rotation_y(-0.5 * PI);
    for (to_world, image_size) in [(Mat3::IDENTITY, [16, 16]), (quarter, [16, 16])] {
        let environment = EnvironmentDesc { image: Some((size, &sky)), color: [2.0; 3], to_world, is_visible: true };
        let desc = ShadingDesc { environment: Some(environment), ..ShadingDesc::default() };
        let below = Affine3A::from_translation(Vec3::new(0.0, -50.0, 0.0));
        let mut subject =
            room.subject(&[wall(1, 1.0)], &[ObjectDesc { to_world: below, ..ObjectDesc::identity(0) }], &desc);
        for (toward, channel) in looks {
            let toward = to_world * Vec3::from(toward);
            let frame = room.shoot(&mut subject, &camera([0.0; 3], toward.into(), 20.0, image_size), &[], 1);
            let mut expected = [0.0, 0.0, 0.0, 1.0];
            expected[channel] = 2.0;
            assert_eq!(at(&frame, image_size, 8, 8), expected, "{toward}");
        }
    }
    room.assert_silent();
}

#[test]
fn a_surface_without_a_material_and_light_looks_as_it_does_undeferred() {
    let room = Darkroom::new(false);
    let (mut meshes, _) = world::scene("cube", false);
    let desc = ShadingDesc { has_studio: true, ..ShadingDesc::default() };
    let mut subject = room.subject(&[meshes.remove(0)], &[ObjectDesc::identity(0)], &desc);
    let camera = camera([2.0, 1.5, 3.0], [0.0; 3], 35.0, [64, 64]);
    let plain = room.draw_plainly(&mut subject, &camera);
    let shaded = room.shoot(&mut subject, &camera, &[], 1);
    for (plain, shaded) in plain.iter().zip(&shaded.color) {
        for (plain, shaded) in plain.iter().zip(shaded) {
            near(*shaded, plain.to_f32(), 1.5e-3, "a channel");
        }
    }
    room.assert_silent();
}

#[test]
fn colors_of_vertices_multiply_the_base_color() {
    let room = Darkroom::new(false);
    let materials = [MaterialDesc { base_color: [0.5; 3], ior: 1.0, ..MaterialDesc::default() }];
    let desc = ShadingDesc { materials: &materials, objects: &[object(&[0])], ..ShadingDesc::default() };
    let mut mesh = wall(1, 1.0);
    mesh.colors = Some(VertexColors { values: vec![[1.0, 0.5, 0.25]; 4], interpolation: VertexInterpolation::Varying });
    let mut subject = room.subject(&[mesh], &[ObjectDesc::identity(0)], &desc);
    let size = [16, 16];
    let frame =
        room.shoot(&mut subject, &camera([0.0, 0.0, 3.0], [0.0; 3], 20.0, size), &[sun([0.0, 0.0, 1.0], PI, 0.0)], 1);
    for (found, expected) in at(&frame, size, 8, 8).into_iter().zip([0.5, 0.25, 0.125]) {
        near(found, expected, 1e-3, "a channel");
    }
    room.assert_silent();
}

#[test]
fn displaced_surfaces_are_shaded_where_they_are_displaced_to() {
    for method in [SurfaceMethod::Dfas, SurfaceMethod::Gregory] {
        let level = if method == SurfaceMethod::Gregory { 0 } else { 3 };
        let room = Darkroom::with_desc(false, SurfaceDesc { method, level, displaced: true, ..SurfaceDesc::default() });
        let texels = PALETTE.map(halves);
        let textures = [TextureDesc {
            size: [2, 2],
            texels: Texels::Halves(&texels),
            wrap: [TextureWrap::Clamp; 2],
            is_nearest: true,
        }];
        let material = MaterialDesc {
            textures: std::array::from_fn(|i| (i == 6).then_some(TextureUseDesc::plain(0))),
            ..glowing([1.0; 3])
        };
        let desc = ShadingDesc {
            textures: &textures,
            materials: &[material],
            objects: &[object(&[0])],
            ..ShadingDesc::default()
        };
        let meshes = [wall(4, 1.0)];
        let mut subject = room.subject(&meshes, &[ObjectDesc::identity(0)], &desc);
        let map = DisplacementDesc {
            channels: 1,
            texels: &[1.5],
            levels: &[[0, 1, 1]],
            tiles: &[[0, 1]],
            tile_of: &[0],
            tile_columns: 1,
            bound: 1.5,
            ..DisplacementDesc::default()
        };
        let size = [32, 32];
        let camera = camera([0.0, 0.0, 5.0], [0.0; 3], 50.0, size);
        let width = |frame: &ShadedFrame| (0..32).filter(|&x| at(frame, size, x, 16)[3] > 0.0).count();
        let flat = room.shoot(&mut subject, &camera, &[], 1);
        subject.surface.displace(&room.device, 0, &meshes[0], &map).expect("a map");
        let raised = room.shoot(&mut subject, &camera, &[], 1);
        // Nearer by 1.5 of 5.
        assert!((width(&raised) as f32 / width(&flat) as f32 - 5.0 / 3.5).abs() < 0.15, "{method:?}");
        let quarters = [(10, 10), (22, 10), (10, 22), (22, 22)];
        assert_eq!(quarters.map(|(x, y)| at(&raised, size, x, y)), PALETTE, "{method:?}");
        room.assert_silent();
    }
}
