//! How many triangles a patch becomes, and of which shapes: the CPU's side of `glsl/bspline_patch.tesc`.

use planish_shaders::EmitLevel;
use planish_subdiv::patch::PatchInfo;
use planish_subdiv::tables::Tables;

use crate::density::FACTOR_COUNT;
use crate::options::{Spacing, SurfaceMethod};

/// Number of segments of an edge with this tess factor.
pub fn segment_count(factor: f32, spacing: Spacing) -> u32 {
    match spacing {
        Spacing::Equal => factor.ceil() as u32,
        Spacing::FractionalOdd => 2 * ((factor - 1.0) * 0.5).ceil() as u32 + 1,
        Spacing::FractionalEven => 2 * (factor.max(2.0) * 0.5).ceil() as u32,
    }
}

/// Number of triangles of a regular or transition patch.
pub fn patch_triangle_count(info: &PatchInfo, factors: &[f32; FACTOR_COUNT], spacing: Spacing) -> u64 {
    let level = usize::from(info.level);
    let full = segment_count(factors[level], spacing);
    let edges: [u32; 4] = std::array::from_fn(|edge| {
        if info.transition >> edge & 1 != 0 {
            2 * segment_count(factors[level + 1], spacing)
        } else if info.leaf >> edge & 1 != 0 {
            segment_count(1.0, spacing)
        } else {
            full
        }
    });
    if full == 1 && edges == [1; 4] {
        return 2;
    }
    // The inner grid, and a ring between it and each edge.
    let inner = u64::from(full.max(2) - 2);
    2 * inner * inner + edges.iter().map(|&edge| u64::from(edge) + inner).sum::<u64>()
}

/// Number of segments of a patch-filling quad's edges: two where limit points at their middles come along.
pub fn filling_segment_count(method: SurfaceMethod, spacing: Spacing) -> u32 {
    if method == SurfaceMethod::Fas { segment_count(1.0, spacing) } else { 1 }
}

/// Number of triangles of a patch-filling quad.
pub fn filling_triangle_count(method: SurfaceMethod, spacing: Spacing) -> u64 {
    2 * u64::from(filling_segment_count(method, spacing)).pow(2)
}

/// Number of triangles of a whole surface.
pub fn triangle_count(tables: &Tables, factors: &[f32; FACTOR_COUNT], method: SurfaceMethod, spacing: Spacing) -> u64 {
    let patches: u64 = tables.patches.iter().map(|p| patch_triangle_count(&p.info, factors, spacing)).sum();
    patches + tables.filling.len() as u64 * filling_triangle_count(method, spacing)
}

/// A triangle between two rows of points along an edge reaches over at most this many of the longest segments: 1.7 were
/// found of the tessellator that Direct3D 11 specifies, for all spacings and factors.
const RING_REACH: f64 = 2.0;
/// Distances of such a triangle's tip from both ends of its base, measured along the edge: their product is at most this
/// times the square of the longest segment (1.2 were found), and a quarter of the edge's square, taken twice for safety.
const RING_PRODUCT: f64 = 1.5;
const MAX_RING_PRODUCT: f64 = 0.5;

/// How patches of a level are tessellated, as the emit stage needs to know. `factors` are those of the levels;
/// irregularities end at `last_level`.
pub fn emit_level(level: usize, last_level: usize, factors: &[f32; FACTOR_COUNT], spacing: Spacing) -> EmitLevel {
    let own = edge_points(factors[level], spacing);
    let uneven = if level == last_level {
        edge_points(1.0, spacing)
    } else {
        let half = edge_points(factors[level + 1], spacing);
        half.iter().map(|t| 0.5 * t).chain(half[1..].iter().map(|t| 0.5 + 0.5 * t)).collect()
    };
    // As the shader sets it.
    let inner = if own.len() == 2 && uneven.len() > 2 { edge_points(2.0, spacing) } else { own.clone() };
    let (own_ring, uneven_ring) = (Ring::new(&inner, &own), Ring::new(&inner, &uneven));
    EmitLevel {
        grain: Ring::new(&own, &own).grain as f32,
        uneven_grain: own_ring.grain.max(uneven_ring.grain) as f32,
        skew: own_ring.skew.max(uneven_ring.skew) as f32,
    }
}

/// Where the points of an edge lie: `place` of `glsl/shared/spacing.glsl`.
fn edge_points(factor: f32, spacing: Spacing) -> Vec<f64> {
    let n = segment_count(factor, spacing);
    let count = f64::from(n);
    let factor = match spacing {
        Spacing::Equal => count,
        Spacing::FractionalOdd => f64::from(factor.max(1.0)),
        Spacing::FractionalEven => f64::from(factor.max(2.0)),
    };
    let inside = (1..n).map(|i| (f64::from(i) - 0.5 * (count - factor)) / factor);
    std::iter::once(0.0).chain(inside).chain([1.0]).collect()
}

/// The triangles between an edge of a patch and the row of points beside it.
struct Ring {
    /// See [`EmitLevel`].
    grain: f64,
    /// See [`EmitLevel`].
    skew: f64,
}

impl Ring {
    /// Of the points of the inner rows, and of the edge's.
    fn new(inner: &[f64], edge: &[f64]) -> Self {
        let gaps = || inner.windows(2).chain(edge.windows(2)).map(|pair| pair[1] - pair[0]);
        let (longest, shortest) = (gaps().fold(0.0, f64::max), gaps().fold(1.0, f64::min));
        let is_even = inner.len() == edge.len() && inner.iter().zip(edge).all(|(a, b)| (a - b).abs() < 1e-9);
        if is_even {
            return Self { grain: 1.0 / shortest, skew: 0.0 };
        }
        let depth = inner[1];
        let reach = (RING_REACH * longest).min(1.0).max(depth);
        let product = (RING_PRODUCT * longest * longest).min(MAX_RING_PRODUCT);
        Self { grain: reach / (shortest * depth), skew: product / (2.0 * depth) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_skewed_only_where_an_edge_has_other_points() {
        let mut factors = [1.0; FACTOR_COUNT];
        factors[..3].copy_from_slice(&[4.0, 2.0, 1.0]);
        for level in 0..3 {
            let even = emit_level(level, 2, &factors, Spacing::Equal);
            assert_eq!((even.grain, even.skew), (factors[level], 0.0));
            assert_eq!(even.uneven_grain, even.grain);
        }
        factors[..3].copy_from_slice(&[4.2, 2.1, 1.05]);
        let odd = emit_level(0, 2, &factors, Spacing::FractionalOdd);
        // Five segments: three of 1 / 4.2, two of 0.6 / 4.2.
        let depth = 0.6_f32 / 4.2;
        assert!((odd.grain * depth - 1.0).abs() < 1e-5);
        assert!((odd.skew - 1.5 / (4.2 * 4.2) / (2.0 * depth)).abs() < 1e-5, "{odd:?}");
        assert!(odd.uneven_grain > odd.grain);
    }

    #[test]
    fn segments_are_the_next_whole_odd_or_even_number() {
        for (factor, equal, odd, even) in
            [(1.0, 1, 1, 2), (1.1, 2, 3, 2), (2.0, 2, 3, 2), (3.0, 3, 3, 4), (3.2, 4, 5, 4), (63.0, 63, 63, 64)]
        {
            assert_eq!(segment_count(factor, Spacing::Equal), equal);
            assert_eq!(segment_count(factor, Spacing::FractionalOdd), odd);
            assert_eq!(segment_count(factor, Spacing::FractionalEven), even);
        }
    }

    #[test]
    fn a_patch_of_n_by_n_segments_has_two_n_squared_triangles() {
        for n in 1..=64_u8 {
            let factors = [f32::from(n); FACTOR_COUNT];
            let count = patch_triangle_count(&PatchInfo::default(), &factors, Spacing::Equal);
            assert_eq!(count, 2 * u64::from(n) * u64::from(n));
        }
    }
}
