//! How finely to tessellate, and so how deep to refine.

use glam::DVec3;
use planish_subdiv::ControlMesh;
use planish_subdiv::tables::Tables;

use crate::camera::FrameCamera;
use crate::error::Error;
use crate::options::{Density, Spacing};

/// Levels that a patch can have, and one more for the finer side of an edge; `FACTOR_COUNT` in glsl/shared/frame.glsl.
pub const FACTOR_COUNT: usize = 17;

/// In fractional-odd spacing the two halves of an edge beside a split face take 2 x 33 > 64 segments for factors above
/// 31: one level down they are held there.
const MAX_ODD_HALF_FACTOR: f32 = 31.0;

/// The tess factor of every base edge.
///
/// With [`Density::EdgePixels`] it is the projected diameter of the largest base edge's bounding sphere over the
/// pixels asked for, one factor for the whole mesh.
pub fn tess_factor(mesh: &ControlMesh, camera: &FrameCamera, density: Density) -> Result<f32, Error> {
    let factor = match density {
        Density::Tess(factor) if factor >= 1.0 && factor.is_finite() => return Ok(factor),
        Density::Tess(factor) => return Err(Error::TessFactor { factor }),
        Density::EdgePixels(pixels) if pixels > 0.0 && pixels.is_finite() => {
            (largest_projected_edge(mesh, camera) / f64::from(pixels)) as f32
        }
        Density::EdgePixels(pixels) => return Err(Error::EdgePixels { pixels }),
    };
    if factor.is_finite() { Ok(factor.max(1.0)) } else { Err(Error::CameraInMesh) }
}

fn largest_projected_edge(mesh: &ControlMesh, camera: &FrameCamera) -> f64 {
    let at = |vertex: u32| DVec3::from(mesh.positions[vertex as usize].map(f64::from));
    let mut first = 0;
    let mut largest = 0.0_f64;
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        first += sides as usize;
        for (i, &a) in face.iter().enumerate() {
            let (a, b) = (at(a), at(face[(i + 1) % face.len()]));
            largest = largest.max(camera.projected_diameter((0.5 * (a + b)).as_vec3(), 0.5 * a.distance(b)));
        }
    }
    largest
}

/// The level that irregularities are isolated to: the factor halves with each, and is 1 at the last (FAS section 4.1).
pub fn isolation_level(tess_factor: f32, max_level: u32) -> u32 {
    let level = (0..=max_level).find(|&k| tess_factor <= (k as f32).exp2());
    level.unwrap_or(max_level)
}

/// The factor of each level, max(1, t / 2^k); refused where a patch would be asked for more than the spacing allows.
pub fn level_factors(tess_factor: f32, spacing: Spacing, tables: &Tables) -> Result<[f32; FACTOR_COUNT], Error> {
    let mut factors: [f32; FACTOR_COUNT] = std::array::from_fn(|k| (tess_factor / (k as f32).exp2()).max(1.0));
    let coarsest = tables.counts.iter().position(|counts| counts.regular + counts.transition > 0);
    if let Some(level) = coarsest {
        if factors[level] > spacing.max_factor() {
            return Err(Error::FactorTooLarge { factor: factors[level], max: spacing.max_factor() });
        }
        if spacing == Spacing::FractionalOdd {
            factors[level + 1..].iter_mut().for_each(|f| *f = f.min(MAX_ODD_HALF_FACTOR));
        }
    }
    Ok(factors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_level_has_factor_one() {
        for (factor, level) in [(1.0, 0), (1.01, 1), (2.0, 1), (13.7, 4), (16.0, 4), (16.1, 5), (64.0, 6)] {
            assert_eq!(isolation_level(factor, 10), level);
            assert!(factor / (level as f32).exp2() <= 1.0);
        }
        assert_eq!(isolation_level(64.0, 3), 3);
    }
}
