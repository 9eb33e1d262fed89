//! The albedo of GGX: how much a rough mirror reflects of light from all around, by the cosine of the view and roughness.
//!
//! With Schlick's Fresnel it is F0 * scale + F90 * bias (Karis 2013, Real Shading in Unreal Engine 4, "split sum"), integrated here by
//! sampling the normals that are seen (Heitz 2018, Sampling the GGX Distribution of Visible Normals).

use glam::{Vec2, Vec3};

/// Entries a side, as `glsl/shared/brdf.glsl` has it: cosines 0 to 1 by columns, roughness 0 to 1 by rows.
pub(crate) const ALBEDO_SIZE: usize = 32;
/// Samples of an entry.
const SAMPLES: u32 = 256;

/// The i-th of `count` points that fill the unit square evenly (Hammersley).
pub(crate) fn hammersley(i: u32, count: u32) -> Vec2 {
    Vec2::new((i as f32 + 0.5) / count as f32, i.reverse_bits() as f32 * 2.0_f32.powi(-32))
}

/// A normal of those that `view`, above the plane z = 0, sees.
fn visible_normal(view: Vec3, alpha: f32, u: Vec2) -> Vec3 {
    let stretched = Vec3::new(alpha * view.x, alpha * view.y, view.z).normalize();
    let x = Vec3::new(-stretched.y, stretched.x, 0.0).normalize_or(Vec3::X);
    let y = stretched.cross(x);
    let (sine, cosine) = (std::f32::consts::TAU * u.y).sin_cos();
    let r = u.x.sqrt();
    let a = r * cosine;
    let share = 0.5 * (1.0 + stretched.z);
    let b = (1.0 - share) * (1.0 - a * a).sqrt() + share * r * sine;
    let n = a * x + b * y + (1.0 - a * a - b * b).max(0.0).sqrt() * stretched;
    Vec3::new(alpha * n.x, alpha * n.y, n.z.max(1e-6)).normalize()
}

/// Smith's lambda.
fn lambda(cosine: f32, alpha: f32) -> f32 {
    let tangent = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tangent).sqrt() - 1.0)
}

/// Scale and bias of the reflectance at normal incidence.
pub(crate) fn ggx_albedo(cosine: f32, roughness: f32) -> [f32; 2] {
    let cosine = cosine.max(1e-3);
    // A mirror at least.
    let alpha = (roughness * roughness).max(1e-4);
    let view = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let mut sums = [0.0; 2];
    for i in 0..SAMPLES {
        let middle = visible_normal(view, alpha, hammersley(i, SAMPLES));
        let light = 2.0 * view.dot(middle) * middle - view;
        if light.z <= 0.0 {
            continue;
        }
        // What is left of the estimate: the height-correlated share of light that also gets out, G2 over G1.
        let (seen, lit) = (lambda(cosine, alpha), lambda(light.z, alpha));
        let weight = (1.0 + seen) / (1.0 + seen + lit);
        let schlick = (1.0 - view.dot(middle)).max(0.0).powi(5);
        sums[0] += weight * (1.0 - schlick);
        sums[1] += weight * schlick;
    }
    sums.map(|sum| sum / SAMPLES as f32)
}

/// All entries, row by row.
pub(crate) fn albedo_table() -> Vec<f32> {
    let at = |i: usize| i as f32 / (ALBEDO_SIZE - 1) as f32;
    let entries = (0..ALBEDO_SIZE).flat_map(|row| (0..ALBEDO_SIZE).map(move |column| (column, row)));
    entries.flat_map(|(column, row)| ggx_albedo(at(column), at(row))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_reflects_all_and_rough_metal_loses_much() {
        for cosine in [0.1, 0.5, 1.0] {
            let [scale, bias] = ggx_albedo(cosine, 0.0);
            assert!((scale + bias - 1.0).abs() < 1e-3, "{cosine}: {}", scale + bias);
        }
        // At alpha 1 D is 1/pi and V is 1 / (2 + 2 n.l), seen along the normal: the integral is 1 - ln 2.
        let [scale, bias] = ggx_albedo(1.0, 1.0);
        assert!((scale + bias - (1.0 - 2.0_f32.ln())).abs() < 1e-3, "{}", scale + bias);
    }

    /// The same integral by plain quadrature over directions of light, from the formulas that the shader evaluates.
    fn by_quadrature(cosine: f32, roughness: f32) -> f64 {
        let alpha = f64::from(roughness * roughness);
        let square = alpha * alpha;
        let n_v = f64::from(cosine);
        let view = glam::DVec3::new((1.0 - n_v * n_v).sqrt(), 0.0, n_v);
        let (rings, spokes) = (400, 400);
        let mut sum = 0.0;
        for ring in 0..rings {
            let n_l = (f64::from(ring) + 0.5) / f64::from(rings);
            let radius = (1.0 - n_l * n_l).sqrt();
            for spoke in 0..spokes {
                let (y, x) = (std::f64::consts::TAU * (f64::from(spoke) + 0.5) / f64::from(spokes)).sin_cos();
                let middle = (view + glam::DVec3::new(radius * x, radius * y, n_l)).normalize();
                let d = (middle.z * square - middle.z) * middle.z + 1.0;
                let v = n_l * ((n_v - square * n_v) * n_v + square).sqrt()
                    + n_v * ((n_l - square * n_l) * n_l + square).sqrt();
                sum += square / (std::f64::consts::PI * d * d) * (0.5 / v) * n_l;
            }
        }
        sum * std::f64::consts::TAU / f64::from(rings * spokes)
    }

    #[test]
    fn the_table_is_the_integral_of_the_lobe() {
        for (cosine, roughness) in [(0.9, 0.5), (0.5, 0.6), (0.3, 0.8), (1.0, 1.0), (0.2, 1.0)] {
            let [scale, bias] = ggx_albedo(cosine, roughness);
            let expected = by_quadrature(cosine, roughness);
            assert!((f64::from(scale + bias) - expected).abs() < 0.006, "{cosine} {roughness}: {expected}");
        }
    }
}
