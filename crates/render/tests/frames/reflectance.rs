//! Reflectance: every term of the surfaces' reflection against its formula, in double precision and written another way.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Mat3, Vec3};
use half::f16;
use planish_render::shading::{
    EnvironmentDesc, MaterialDesc, ObjectMaterials, ShadedFrame, ShadingDesc, Texels, TextureDesc, TextureUseDesc,
    TextureWrap, ptex_slots,
};
use planish_render::{FrameCamera, ObjectDesc};

use super::darkroom::{Darkroom, camera, even, halves, on_wall, sun, wall};

const SIZE: [u32; 2] = [48, 48];
/// Columns of faces of the wall, each of a material of its own.
const COLUMNS: usize = 8;

fn object(count: usize) -> ObjectMaterials {
    ObjectMaterials { materials: (0..count).map(Some).collect(), mesh: 0, id: 1 }
}

/// A wall of eight columns, one a material, in this light.
fn shoot(room: &Darkroom, desc: &ShadingDesc<'_>, camera: &FrameCamera, suns: &[Vec3]) -> Vec<ShadedFrame> {
    let mesh = wall(COLUMNS as u32, 1.0);
    let slots: Vec<u32> = (0..COLUMNS * COLUMNS).map(|face| (face % COLUMNS) as u32).collect();
    let face_slots = [ptex_slots(&mesh, &slots)];
    let objects = [object(COLUMNS)];
    let desc = ShadingDesc { face_slots: &face_slots, objects: &objects, ..*desc };
    let mut subject = room.subject(&[mesh], &[ObjectDesc::identity(0)], &desc);
    if suns.is_empty() {
        return vec![room.shoot(&mut subject, camera, &[], 1)];
    }
    let lights = suns.iter().map(|&from| sun(from.into(), 1.0, 0.0));
    lights.map(|light| room.shoot(&mut subject, camera, &[light], 1)).collect()
}

/// Pixels well inside of the columns: the column, the colour, and the unit vector from the place to the eye.
fn seen<'a>(frame: &'a ShadedFrame, camera: &'a FrameCamera) -> impl Iterator<Item = (usize, [f32; 4], DVec3)> + 'a {
    let places = (0..SIZE[1]).step_by(7).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    places.filter_map(move |(x, y)| {
        let place = on_wall(camera, x, y);
        let column = (place.x + 1.0) * 0.5 * COLUMNS as f32;
        let is_inside = place.abs().max_element() < 0.97 && (column.fract() - 0.5).abs() < 0.2;
        let color = frame.color[(y * SIZE[0] + x) as usize];
        is_inside.then(|| (column as usize, color, (camera.eye() - place).as_dvec3().normalize()))
    })
}

/// GGX of a roughness: distribution times masking, over four cosines (Walter et al. 2007, Heitz 2014).
fn ggx(roughness: f64, to_eye: DVec3, to_light: DVec3) -> f64 {
    let square = roughness.powi(4);
    let tangent = |v: DVec3| (1.0 - v.z * v.z) / (v.z * v.z);
    let lambda = |v: DVec3| 0.5 * ((1.0 + square * tangent(v)).sqrt() - 1.0);
    let middle = (to_eye + to_light).normalize();
    let cosine = middle.z * middle.z;
    let distribution = square / (PI * (cosine * (square - 1.0) + 1.0).powi(2));
    distribution / (1.0 + lambda(to_eye) + lambda(to_light)) / (4.0 * to_eye.z * to_light.z)
}

fn schlick(to_eye: DVec3, to_light: DVec3) -> f64 {
    (1.0 - to_eye.dot((to_eye + to_light).normalize())).powi(5)
}

/// What is reflected of light from everywhere: the parts that F0 and F90 weigh. By quadrature over directions of light.
fn albedo(roughness: f64, to_eye: DVec3) -> [f64; 2] {
    let (rings, spokes) = (160, 160);
    let mut sums = [0.0; 2];
    for ring in 0..rings {
        let z = (f64::from(ring) + 0.5) / f64::from(rings);
        for spoke in 0..spokes {
            let (y, x) = (TAU * (f64::from(spoke) + 0.5) / f64::from(spokes)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let to_light = DVec3::new(radius * x, radius * y, z);
            let reflected = ggx(roughness, to_eye, to_light) * z;
            let grazing = schlick(to_eye, to_light);
            sums[0] += reflected * (1.0 - grazing);
            sums[1] += reflected * grazing;
        }
    }
    sums.map(|sum| sum * TAU / f64::from(rings * spokes))
}

/// Radiance to the eye for an irradiance of 1 across the light's direction, of a surface that faces +z.
fn expected(material: &MaterialDesc, to_eye: DVec3, to_light: DVec3) -> [f64; 3] {
    let metallic = f64::from(material.metallic);
    let dielectric = ((f64::from(material.ior) - 1.0) / (f64::from(material.ior) + 1.0)).powi(2);
    let color = material.base_color.map(f64::from);
    let f0 = match material.specular {
        Some(specular) => specular.map(f64::from),
        None => color.map(|color| dielectric + metallic * (color - dielectric)),
    };
    let f90 = f0.iter().fold(0.0, |most: f64, &f0| most.max(50.0 * f0)).min(1.0);
    let diffuse = if material.specular.is_some() { color } else { color.map(|color| color * (1.0 - metallic)) };
    let [scale, bias] = albedo(material.roughness.into(), to_eye);
    let grazing = schlick(to_eye, to_light);
    let lobe = to_light.z * ggx(material.roughness.into(), to_eye, to_light);
    let coat = f64::from(material.clearcoat);
    let [coat_scale, coat_bias] =
        if coat > 0.0 { albedo(material.clearcoat_roughness.into(), to_eye) } else { [0.0; 2] };
    let coat_albedo = coat * (0.04 * coat_scale + coat_bias);
    let coat_lobe = if coat > 0.0 { ggx(material.clearcoat_roughness.into(), to_eye, to_light) } else { 0.0 };
    std::array::from_fn(|c| {
        let scattered_again = 1.0 + f0[c] * (1.0 / (scale + bias) - 1.0);
        let specular = lobe * (f0[c] + (f90 - f0[c]) * grazing) * scattered_again;
        let share = 1.0 - (f0[c] * scale + f90 * bias) * scattered_again;
        let base = share * diffuse[c] / PI * to_light.z + specular + f64::from(material.emissive[c]);
        base * (1.0 - coat_albedo) + coat * coat_lobe * to_light.z * (0.04 + 0.96 * grazing)
    })
}

#[test]
fn light_from_one_direction_is_reflected_by_the_formulas() {
    let room = Darkroom::new(false);
    let plain = MaterialDesc { base_color: [0.8, 0.5, 0.1], ..MaterialDesc::default() };
    let materials = [
        MaterialDesc { roughness: 0.6, ..plain },
        MaterialDesc { metallic: 1.0, roughness: 0.5, ..plain },
        MaterialDesc { metallic: 0.5, roughness: 0.7, ior: 1.8, ..plain },
        MaterialDesc { metallic: 1.0, roughness: 1.0, ..plain },
        // It reflects less than 2 % at normal incidence.
        MaterialDesc { ior: 1.1, roughness: 0.5, ..plain },
        MaterialDesc { specular: Some([0.3, 0.02, 0.6]), metallic: 1.0, roughness: 0.6, ..plain },
        MaterialDesc { clearcoat: 0.7, clearcoat_roughness: 0.5, emissive: [0.3, 0.0, 0.1], ior: 1.0, ..plain },
        MaterialDesc { clearcoat: 1.0, clearcoat_roughness: 0.6, metallic: 1.0, roughness: 0.8, ..plain },
    ];
    let desc = ShadingDesc { materials: &materials, ..ShadingDesc::default() };
    let camera = camera([0.3, -2.4, 1.6], [0.0; 3], 50.0, SIZE);
    // Into the eye by a mirror, from the eye, aslant and at a grazing angle.
    let suns = [[-0.1, 0.8, 0.55], [0.1, -0.8, 0.55], [0.9, 0.3, 0.5], [-0.5, 0.9, 0.15]].map(Vec3::from);
    for (frame, from) in shoot(&room, &desc, &camera, &suns).iter().zip(suns) {
        let to_light = from.as_dvec3().normalize();
        let mut compared = [0; COLUMNS];
        for (column, color, to_eye) in seen(frame, &camera) {
            // Quadrature takes its time: a few pixels of each are enough.
            if compared[column] >= 4 {
                continue;
            }
            compared[column] += 1;
            for (found, expected) in color.into_iter().zip(expected(&materials[column], to_eye, to_light)) {
                let difference = (f64::from(found) - expected).abs();
                assert!(difference < 0.002 + 0.02 * expected, "{column} from {from}: {found}, expected {expected}");
            }
        }
        assert_eq!(compared, [4; COLUMNS]);
    }
    room.assert_silent();
}

/// Light of a linear sky from a direction, in its own space.
fn sky(d: DVec3) -> f64 {
    1.0 + 0.8 * d.dot(AXIS.normalize())
}

/// Where that sky is brightest: along no axis.
const AXIS: DVec3 = DVec3::new(0.7, 0.5, -0.3);

fn sky_image(size: [u32; 2]) -> Vec<[f16; 4]> {
    let texel = |i: u32| {
        let turn = TAU * ((f64::from(i % size[0]) + 0.5) / f64::from(size[0]) - 0.5);
        let fall = PI * (f64::from(i / size[0]) + 0.5) / f64::from(size[1]);
        let light = sky(DVec3::new(fall.sin() * turn.sin(), fall.cos(), -fall.sin() * turn.cos())) as f32;
        halves([light, light, light, 1.0])
    };
    (0..size[0] * size[1]).map(texel).collect()
}

/// What is left of a linear sky's slope in the lobe of a roughness, seen along the normal: the mean of the cosine, weighted by it.
fn slope(roughness: f64) -> f64 {
    let square = roughness.powi(4);
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..20_000 {
        // Normals as the distribution has them, by its inverse.
        let u = (f64::from(i) + 0.5) / 20_000.0;
        let cosine_square = (1.0 - u) / (1.0 + (square - 1.0) * u);
        let light = 2.0 * cosine_square - 1.0;
        if light > 0.0 {
            sum += light * light;
            weights += light;
        }
    }
    sum / weights
}

#[test]
fn the_sky_is_reflected_from_where_it_is() {
    let room = Darkroom::new(false);
    let black = MaterialDesc { base_color: [0.0; 3], ior: 1.0, ..MaterialDesc::default() };
    let metal = MaterialDesc { base_color: [1.0; 3], metallic: 1.0, ..MaterialDesc::default() };
    // Tilted by 30 degrees to the right.
    let texels = [halves([0.75, 0.5, 0.933, 1.0])];
    let textures = [TextureDesc {
        size: [1, 1],
        texels: Texels::Halves(&texels),
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    }];
    let bumps = TextureUseDesc { scale: [2.0; 4], bias: [-1.0; 4], ..TextureUseDesc::plain(0) };
    let bumpy = std::array::from_fn(|i| (i == 4).then_some(bumps));
    let coated = MaterialDesc { clearcoat: 0.8, clearcoat_roughness: 0.0, ..black };
    let materials = [
        MaterialDesc { roughness: 0.0, ..metal },
        MaterialDesc { roughness: 0.72, ..metal },
        MaterialDesc { roughness: 1.0, ..metal },
        MaterialDesc { base_color: [0.6; 3], ior: 1.0, ..black },
        coated,
        // The coat lies smoothly over what is bumpy.
        MaterialDesc { textures: bumpy, ..coated },
        MaterialDesc { roughness: 0.0, textures: bumpy, ..metal },
        MaterialDesc { base_color: [0.6; 3], textures: bumpy, ..black },
    ];
    let to_world = Mat3::from_rotation_y(0.7) * Mat3::from_rotation_x(-0.4);
    let size = [256, 128];
    let image = sky_image(size);
    let color = [2.0, 1.0, 0.5];
    let environment = EnvironmentDesc { image: Some((size, &image)), color, to_world, is_visible: false };
    let desc = ShadingDesc {
        materials: &materials,
        textures: &textures,
        environment: Some(environment),
        ..ShadingDesc::default()
    };
    let camera = camera([0.8, -1.6, 2.2], [0.0; 3], 45.0, SIZE);
    let frame = &shoot(&room, &desc, &camera, &[])[0];
    let from = |d: DVec3, slope: f64| 1.0 + slope * (sky(to_world.transpose().as_dmat3() * d) - 1.0);
    let mirrored = |to_eye: DVec3, normal: DVec3| 2.0 * normal.dot(to_eye) * normal - to_eye;
    let tilted = DVec3::new(0.5, 0.0, 0.866).normalize();
    // Between the fourth and the fifth of six levels.
    let rough = slope(4.0 / 6.0) + 0.32 * (slope(5.0 / 6.0) - slope(4.0 / 6.0));
    let mut compared = [0; COLUMNS];
    for (column, found, to_eye) in seen(frame, &camera) {
        let coat = |normal: DVec3| {
            let grazing = (1.0 - to_eye.z).powi(5);
            0.8 * (0.04 + 0.96 * grazing) * from(mirrored(to_eye, normal), 1.0)
        };
        let expected = match column {
            0 => from(mirrored(to_eye, DVec3::Z), 1.0),
            1 => from(mirrored(to_eye, DVec3::Z), rough),
            2 => from(mirrored(to_eye, DVec3::Z), slope(1.0)),
            3 => 0.6 * from(DVec3::Z, 2.0 / 3.0),
            4 | 5 => coat(DVec3::Z),
            6 => from(mirrored(to_eye, tilted), 1.0),
            _ => 0.6 * from(tilted, 2.0 / 3.0),
        };
        compared[column] += 1;
        for c in 0..3 {
            let expected = expected * f64::from(color[c]);
            let difference = (f64::from(found[c]) - expected).abs();
            // Wide lobes are sampled in mipmaps that blur them a little more.
            let bound = match column {
                1 => 0.02 * f64::from(color[c]),
                2 => 0.035 * f64::from(color[c]),
                _ => 0.02 * expected + 0.002,
            };
            assert!(difference < bound, "{column}: {}, expected {expected}", found[c]);
        }
    }
    assert!(compared.iter().all(|&count| count > 4), "{compared:?}");
    room.assert_silent();
}

#[test]
fn every_texture_multiplies_its_own_factor_by_its_own_channels() {
    let room = Darkroom::new(false);
    let value = [0.2, 0.6, 0.9, 0.3];
    let texels = [halves(value)];
    let textures = [TextureDesc {
        size: [1, 1],
        texels: Texels::Halves(&texels),
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    }];
    let of = |place: usize, channel: u32| {
        let mut uses = [None; 7];
        uses[place] = Some(TextureUseDesc { channel, ..TextureUseDesc::plain(0) });
        uses
    };
    let plain = MaterialDesc { base_color: [0.9, 0.7, 0.5], metallic: 0.8, roughness: 0.9, ..MaterialDesc::default() };
    // Pairs: with a texture, and with the factor that it makes.
    let pairs = [
        (
            MaterialDesc { textures: of(0, 0), ..plain },
            MaterialDesc { base_color: [0.9 * 0.2, 0.7 * 0.6, 0.5 * 0.9], ..plain },
        ),
        (MaterialDesc { textures: of(2, 2), ..plain }, MaterialDesc { metallic: 0.8 * 0.9, ..plain }),
        (MaterialDesc { textures: of(3, 1), ..plain }, MaterialDesc { roughness: 0.9 * 0.6, ..plain }),
        (
            MaterialDesc { textures: of(6, 0), emissive: [3.0, 2.0, 1.0], ..plain },
            MaterialDesc { emissive: [3.0 * 0.2, 2.0 * 0.6, 0.9], ..plain },
        ),
    ];
    let materials: Vec<MaterialDesc> =
        pairs.into_iter().flat_map(|(textured, factored)| [textured, factored]).collect();
    let desc = ShadingDesc { materials: &materials, textures: &textures, ..ShadingDesc::default() };
    let camera = camera([0.0, -1.2, 2.4], [0.0; 3], 45.0, SIZE);
    for environment in [None, Some(even(1.0))] {
        let suns = if environment.is_some() { vec![] } else { vec![Vec3::new(0.0, 0.4, 1.0)] };
        // Each of a pair stands where the other did: what is seen there is the same.
        let frame = &shoot(&room, &ShadingDesc { environment, ..desc }, &camera, &suns)[0];
        let mut exchanged = materials.clone();
        exchanged.chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
        let other = &shoot(&room, &ShadingDesc { environment, materials: &exchanged, ..desc }, &camera, &suns)[0];
        assert!(frame.color.iter().filter(|color| color[0] > 0.01).count() > 1000);
        for (pixel, (one, other)) in frame.color.iter().zip(&other.color).enumerate() {
            assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 2e-3), "pixel {pixel}: {one:?} {other:?}");
        }
    }
    room.assert_silent();
}

#[test]
fn occlusion_keeps_the_sky_away_by_its_strength_and_nothing_else() {
    let room = Darkroom::new(false);
    let texels = [halves([0.2, 0.6, 0.9, 1.0])];
    let textures = [TextureDesc {
        size: [1, 1],
        texels: Texels::Halves(&texels),
        wrap: [TextureWrap::Repeat; 2],
        is_nearest: false,
    }];
    let of = |channel: u32, occlusion_strength: f32| {
        let used = TextureUseDesc { channel, ..TextureUseDesc::plain(0) };
        let textures = std::array::from_fn(|i| (i == 5).then_some(used));
        MaterialDesc { base_color: [1.0; 3], ior: 1.0, occlusion_strength, textures, ..MaterialDesc::default() }
    };
    let cases = [(0, 1.0, 0.2), (0, 0.5, 0.6), (1, 1.0, 0.6), (2, 0.25, 0.975), (0, 0.0, 1.0)];
    let mut materials: Vec<MaterialDesc> = cases.iter().map(|&(channel, strength, _)| of(channel, strength)).collect();
    materials.resize(COLUMNS, of(0, 0.0));
    let camera = camera([0.0, 0.0, 3.0], [0.0; 3], 45.0, SIZE);
    let desc = ShadingDesc { materials: &materials, textures: &textures, ..ShadingDesc::default() };
    let lit = |environment, suns: &[Vec3]| shoot(&room, &ShadingDesc { environment, ..desc }, &camera, suns).remove(0);
    let expected = |column: usize| cases.get(column).map_or(1.0, |case| case.2);
    for (column, found, _) in seen(&lit(Some(even(1.0)), &[]), &camera) {
        assert!((found[0] - expected(column)).abs() < 2e-3, "{column}: {}", found[0]);
    }
    let mut count = 0;
    for (column, found, _) in seen(&lit(None, &[Vec3::Z]), &camera) {
        assert!((f64::from(found[0]) - 1.0 / PI).abs() < 2e-3, "{column} in the sun: {}", found[0]);
        count += 1;
    }
    assert!(count > 30);
    room.assert_silent();
}
