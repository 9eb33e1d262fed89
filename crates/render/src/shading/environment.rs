//! Light from all around, made ready: what rough surfaces reflect of it, and its mean over the cosine.
//!
//! Reflections are means over the lobe that a surface has seen from along its normal (Karis 2013), by samples of it that look into
//! mipmaps as wide as they are far apart (Krivanek and Colbert 2008, Real-time Shading with Filtered Importance Sampling). The mean over
//! the cosine is a plain sum over a small level of the image.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use half::f16;

use super::albedo_table::hammersley;
use super::desc::EnvironmentDesc;
use super::filter::trilinear;
use super::texture::LinearImage;

/// Rows of what surfaces of roughness 1/6, 2/6, .. reflect, and the samples of each.
const ROUGH_LEVELS: [(u32, u32); 6] = [(128, 32), (128, 64), (64, 96), (32, 128), (32, 192), (32, 256)];
/// Rows of the image that reflections are made of, at most.
const SOURCE_ROWS: u32 = 512;
/// Rows of the level that the mean over the cosine is made of, at most, and of that mean.
const IRRADIANCE_SOURCE_ROWS: u32 = 32;
const IRRADIANCE_ROWS: u32 = 16;

/// An environment's images, linear, in latitude and longitude.
pub(crate) struct PreparedEnvironment {
    /// The image itself.
    pub mirror: ([u32; 2], Vec<[f16; 4]>),
    /// What surfaces of roughness 1/n, 2/n, .. reflect.
    pub rough: Vec<LinearImage>,
    /// Irradiance over pi.
    pub irradiance: LinearImage,
}

/// The direction of a place in the image.
fn direction([s, t]: [f32; 2]) -> Vec3 {
    let (turn, fall) = (TAU * (s - 0.5), PI * t);
    Vec3::new(fall.sin() * turn.sin(), fall.cos(), -fall.sin() * turn.cos())
}

/// The place of a direction.
fn place(d: Vec3) -> [f32; 2] {
    [d.x.atan2(-d.z) / TAU + 0.5, d.y.clamp(-1.0, 1.0).acos() / PI]
}

/// Two vectors across a unit vector.
fn across(n: Vec3) -> [Vec3; 2] {
    let x = n.any_orthonormal_vector();
    [x, n.cross(x)]
}

/// An image of `rows` rows, each texel by its direction, on all threads.
fn rendered(rows: u32, radiance: impl Fn(Vec3) -> [f32; 3] + Sync) -> LinearImage {
    let size = [2 * rows, rows];
    let mut texels = vec![[0.0; 4]; (size[0] * size[1]) as usize];
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get).min(rows as usize);
    let per_thread = (rows as usize).div_ceil(threads);
    std::thread::scope(|scope| {
        for (part, texels) in texels.chunks_mut(per_thread * size[0] as usize).enumerate() {
            let radiance = &radiance;
            scope.spawn(move || {
                for (i, texel) in texels.iter_mut().enumerate() {
                    let (x, y) = (i % size[0] as usize, part * per_thread + i / size[0] as usize);
                    let st = [(x as f32 + 0.5) / size[0] as f32, (y as f32 + 0.5) / size[1] as f32];
                    let [r, g, b] = radiance(direction(st));
                    *texel = [r, g, b, 1.0];
                }
            });
        }
    });
    LinearImage { size, texels }
}

/// A sample of a lobe around +z: where light comes from, its cosine, and the level of detail that it looks at.
struct LobeSample {
    light: Vec3,
    lod: f32,
}

/// Samples of what a surface of a roughness reflects, seen along its normal.
fn lobe(roughness: f32, count: u32, source_rows: u32) -> Vec<LobeSample> {
    let square = roughness.powi(4);
    // Solid angle of a texel at the horizon, where they are widest.
    let texel = (PI / source_rows as f32).powi(2);
    let samples = (0..count).filter_map(|i| {
        let u = hammersley(i, count);
        let cosine = ((1.0 - u.x) / (1.0 + (square - 1.0) * u.x)).sqrt();
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let middle = Vec3::new(sine * (TAU * u.y).cos(), sine * (TAU * u.y).sin(), cosine);
        let light = 2.0 * cosine * middle - Vec3::Z;
        let d = (cosine * square - cosine) * cosine + 1.0;
        // Density of lights: D cos / (4 v.h), where v = n.
        let density = square / (PI * d * d) / 4.0;
        let lod = 0.5 * (1.0 / (count as f32 * density) / texel).log2() + 1.0;
        (light.z > 0.0).then_some(LobeSample { light, lod })
    });
    samples.collect()
}

/// What a surface reflects in the direction of its normal.
fn reflected(levels: &[LinearImage], lobe: &[LobeSample], normal: Vec3) -> [f32; 3] {
    let [x, y] = across(normal);
    let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
    for LobeSample { light, lod } in lobe {
        let toward = light.x * x + light.y * y + light.z * normal;
        sum += light.z * Vec3::from(trilinear(levels, place(toward), *lod));
        weights += light.z;
    }
    (sum / weights).to_array()
}

/// The mean of an image over the cosine to a normal: irradiance over pi.
fn cosine_mean(lights: &[(Vec3, Vec3)], normal: Vec3) -> [f32; 3] {
    let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
    for (toward, weighted) in lights {
        let cosine = toward.dot(normal).max(0.0);
        sum += cosine * *weighted;
        // The weight is the length of the direction's share.
        weights += cosine * toward.length();
    }
    (sum / weights.max(1e-20)).to_array()
}

/// Directions, as long as the solid angle of their texel, and its light.
fn directions(image: &LinearImage) -> Vec<(Vec3, Vec3)> {
    let [width, height] = image.size;
    let at = |i: usize| [(i % width as usize) as f32, (i / width as usize) as f32];
    let light = |(i, texel): (usize, &[f32; 4])| {
        let [x, y] = at(i);
        let st = [(x + 0.5) / width as f32, (y + 0.5) / height as f32];
        let share = (PI * st[1]).sin();
        (direction(st) * share.sqrt(), Vec3::new(texel[0], texel[1], texel[2]) * share.sqrt())
    };
    image.texels.iter().enumerate().map(light).collect()
}

/// Makes an environment ready.
pub(crate) fn prepare(desc: &EnvironmentDesc<'_>) -> PreparedEnvironment {
    let white = [[f16::ONE; 4]];
    let (size, texels) = desc.image.unwrap_or(([1, 1], &white));
    let mirror = (size, texels.to_vec());
    let finite = |texel: &[f16; 4]| texel.map(|value| if value.is_finite() { value.to_f32().max(0.0) } else { 0.0 });
    let mut levels = vec![LinearImage { size, texels: texels.iter().map(finite).collect() }];
    while levels[levels.len() - 1].size != [1, 1] {
        levels.push(levels[levels.len() - 1].halved());
    }
    let from = levels.iter().position(|level| level.size[1] <= SOURCE_ROWS).unwrap_or(0);
    let source = &levels[from..];
    let mut rough = Vec::new();
    for (i, (rows, count)) in (1_u8..).zip(ROUGH_LEVELS) {
        let lobe = lobe(f32::from(i) / ROUGH_LEVELS.len() as f32, count, source[0].size[1]);
        rough.push(rendered(rows, |normal| reflected(source, &lobe, normal)));
    }
    let small =
        levels.iter().find(|level| level.size[1] <= IRRADIANCE_SOURCE_ROWS).unwrap_or(&levels[levels.len() - 1]);
    // A texel of a tiny image covers much of the sky.
    let resampled = rendered(IRRADIANCE_SOURCE_ROWS, |d| trilinear(std::slice::from_ref(small), place(d), 0.0));
    let lights = directions(&resampled);
    let irradiance = rendered(IRRADIANCE_ROWS, |normal| cosine_mean(&lights, normal));
    PreparedEnvironment { mirror, rough, irradiance }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment(size: [u32; 2], radiance: impl Fn(Vec3) -> [f32; 3]) -> Vec<[f16; 4]> {
        let texel = |i: u32| {
            let st = [((i % size[0]) as f32 + 0.5) / size[0] as f32, ((i / size[0]) as f32 + 0.5) / size[1] as f32];
            let [r, g, b] = radiance(direction(st));
            [r, g, b, 1.0].map(f16::from_f32)
        };
        (0..size[0] * size[1]).map(texel).collect()
    }

    fn prepared(size: [u32; 2], texels: &[[f16; 4]]) -> PreparedEnvironment {
        let image = Some((size, texels));
        prepare(&EnvironmentDesc { image, color: [1.0; 3], to_world: glam::Mat3::IDENTITY, is_visible: false })
    }

    #[test]
    fn places_and_directions_are_inverse_and_the_middle_looks_along_minus_z() {
        assert!((direction([0.5, 0.5]) + Vec3::Z).length() < 1e-6);
        assert!((direction([0.25, 0.5]) + Vec3::X).length() < 1e-6);
        assert!((direction([0.3, 0.0]) - Vec3::Y).length() < 1e-6);
        for st in [[0.1, 0.3], [0.7, 0.9], [0.5, 0.5]] {
            let found = place(direction(st));
            assert!((found[0] - st[0]).abs() + (found[1] - st[1]).abs() < 1e-5);
        }
    }

    #[test]
    fn even_light_stays_even() {
        let made = prepared([1, 1], &[[f16::ONE; 4]]);
        for image in made.rough.iter().chain([&made.irradiance]) {
            assert!(image.texels.iter().flatten().all(|value| (value - 1.0).abs() < 1e-4));
        }
    }

    #[test]
    fn irradiance_of_a_linear_sky_is_two_thirds_of_its_slope() {
        // Radiance 1 + d.y: the mean over the cosine is 1 + 2/3 n.y (Ramamoorthi and Hanrahan 2001).
        let size = [128, 64];
        let made = prepared(size, &environment(size, |d| [1.0 + d.y; 3]));
        let [width, height] = made.irradiance.size;
        for (i, texel) in made.irradiance.texels.iter().enumerate() {
            let t = ((i / width as usize) as f32 + 0.5) / height as f32;
            let expected = 1.0 + 2.0 / 3.0 * (PI * t).cos();
            assert!((texel[0] - expected).abs() < 0.01, "{t}: {} {expected}", texel[0]);
        }
    }

    #[test]
    fn rough_reflections_are_as_wide_as_their_lobe() {
        // A linear function becomes its mean over the lobe: the slope times the mean cosine, weighted by the cosine.
        let size = [256, 128];
        let made = prepared(size, &environment(size, |d| [1.0 + d.y; 3]));
        for (i, image) in made.rough.iter().enumerate() {
            let lobe = lobe((i + 1) as f32 / 6.0, 4096, 128);
            let weights: f32 = lobe.iter().map(|sample| sample.light.z).sum();
            let slope = lobe.iter().map(|sample| sample.light.z * sample.light.z).sum::<f32>() / weights;
            let top = image.texels[0][0];
            assert!((top - 1.0 - slope).abs() < 0.03, "level {i}: {top} {slope}");
        }
    }
}
