//! How many triangles a patch becomes: the CPU's side of `glsl/bspline_patch.tesc`.

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

#[cfg(test)]
mod tests {
    use super::*;

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
