//! Tess factors of regular patches, and how many triangles they make: CPU twin of `glsl/shared/factors.glsl` and
//! `glsl/shared/spacing.glsl`, the same f32 operations in the same order.

use planish_subdiv::patch::PatchInfo;

use crate::options::Spacing;

/// The most segments that the tessellator makes of an edge.
pub const MAX_SEGMENTS: f32 = 64.0;

impl Spacing {
    /// The factor that the spacing makes of a tess factor of at least 1.
    pub fn spaced(self, factor: f32) -> f32 {
        match self {
            Self::Equal => factor.ceil(),
            Self::FractionalOdd => factor,
            Self::FractionalEven if factor > 1.0 => factor.max(2.0),
            Self::FractionalEven => factor,
        }
    }

    /// Number of segments that a spaced factor makes.
    pub fn segment_count(self, spaced: f32) -> f32 {
        match self {
            Self::Equal => spaced,
            Self::FractionalEven if spaced > 1.0 => 2.0 * (spaced * 0.5).ceil(),
            Self::FractionalOdd | Self::FractionalEven => 2.0 * ((spaced - 1.0) * 0.5).ceil() + 1.0,
        }
    }

    /// Place of point `i` of `n` on an edge of a spaced factor.
    pub fn place(self, i: f32, n: f32, spaced: f32) -> f32 {
        if self == Self::Equal {
            return i / n;
        }
        if i <= 0.0 {
            return 0.0;
        }
        if i >= n { 1.0 } else { (i - 0.5 * (n - spaced)) / spaced }
    }

    /// Longest and shortest of the segments that a spaced factor makes; -n stands for n of one length.
    fn segment_bounds(self, spaced: f32) -> [f32; 2] {
        if spaced < 0.0 {
            return [-1.0 / spaced; 2];
        }
        let n = self.segment_count(spaced);
        if self == Self::Equal || n == 1.0 {
            return [1.0 / n; 2];
        }
        let end = 0.5 * (1.0 - (n - 2.0) / spaced);
        [(1.0 / spaced).max(end), end]
    }
}

/// Factors of a patch's edges and of its rows inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFactors {
    /// Spaced factor of each edge, or of its half with the lower u or v.
    pub low: [f32; 4],
    /// Of the other half where the edge is split, else 0.
    pub high: [f32; 4],
    /// Segments of each edge.
    pub counts: [f32; 4],
    /// Spaced factors of the rows inside, along u and v; -n for n segments of one length.
    pub inner: [f32; 2],
    /// Segments of the rows inside.
    pub inner_counts: [f32; 2],
    spacing: Spacing,
}

/// Corners at the ends of edge i with the lower and the higher u or v.
const ENDS: [[usize; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];
/// (u, v) of corner i.
const CORNERS: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// A point of a patch's own domain in its Ptex face's.
fn ptex_uv(info: &PatchInfo, [u, v]: [f32; 2]) -> [f32; 2] {
    let scale = halvings(info.location.depth);
    [(f32::from(info.location.u) + u) * scale, (f32::from(info.location.v) + v) * scale]
}

/// 2^-k.
fn halvings(k: u8) -> f32 {
    f32::from_bits((127 - u32::from(k)) << 23)
}

impl PatchFactors {
    /// Of a patch whose edges of the mask are split; `face` is the density in its Ptex face
    /// ([`planish_subdiv::selection::density_at`]).
    pub fn new(face: impl Fn(f32, f32) -> f32, info: &PatchInfo, split_edges: u32, spacing: Spacing) -> Self {
        let density = |uv| {
            let [u, v] = ptex_uv(info, uv);
            face(u, v)
        };
        let d = CORNERS.map(density);
        let scale = halvings(info.level);
        let factor = |a: f32, b: f32, scale: f32| spacing.spaced(((0.5 * (a + b)) * scale).max(1.0));
        let (mut low, mut high, mut counts, mut whole) = ([0.0; 4], [0.0; 4], [0.0; 4], [0.0; 4]);
        for (edge, [from, to]) in ENDS.into_iter().enumerate() {
            let is_leaf = info.leaf >> edge & 1 != 0;
            whole[edge] = if is_leaf { spacing.spaced(1.0) } else { factor(d[from], d[to], scale) };
            low[edge] = whole[edge];
            counts[edge] = spacing.segment_count(whole[edge]);
            if split_edges >> edge & 1 != 0 {
                let middle = density(std::array::from_fn(|c| 0.5 * (CORNERS[from][c] + CORNERS[to][c])));
                low[edge] = factor(d[from], middle, 0.5 * scale);
                high[edge] = factor(middle, d[to], 0.5 * scale);
                counts[edge] = spacing.segment_count(low[edge]) + spacing.segment_count(high[edge]);
            }
        }
        let mut inner = [whole[0].max(whole[2]), whole[1].max(whole[3])];
        let mut inner_counts = inner.map(|factor| spacing.segment_count(factor));
        if counts.iter().chain(&inner_counts).any(|&count| count > 1.0) {
            for (factor, count) in inner.iter_mut().zip(&mut inner_counts).filter(|(_, count)| **count == 1.0) {
                (*factor, *count) = (-2.0, 2.0);
            }
        }
        Self { low, high, counts, inner, inner_counts, spacing }
    }

    /// In how many pieces a side the patch must be cut.
    pub fn cut_count(&self) -> u32 {
        let most = self.counts.iter().chain(&self.inner_counts).fold(0.0, |most: f32, &count| most.max(count));
        (most * (1.0 / MAX_SEGMENTS)).ceil() as u32
    }

    /// Triangles that the tessellator makes of the patch, if it is not cut.
    pub fn triangle_count(&self) -> u32 {
        triangle_count(self.counts.map(|count| count as u32), self.inner_counts.map(|count| count as u32))
    }

    /// About how many vertices it makes.
    pub fn vertex_count(&self) -> u32 {
        (self.inner_counts[0] as u32 + 1) * (self.inner_counts[1] as u32 + 1)
    }

    /// Where point `i` of an edge lies.
    fn edge_point(&self, edge: usize, i: f32) -> f32 {
        let (low, high) = (self.low[edge], self.high[edge]);
        let low_count = self.spacing.segment_count(low);
        if high == 0.0 {
            return self.spacing.place(i, low_count, low);
        }
        if i <= low_count {
            return 0.5 * self.spacing.place(i, low_count, low);
        }
        0.5 + 0.5 * self.spacing.place(i - low_count, self.spacing.segment_count(high), high)
    }

    /// One of `pieces` x `pieces`.
    pub fn piece(&self, pieces: u32, piece: [u32; 2]) -> PieceFactors {
        let inner = self.inner_counts.map(|count| (count as u32).div_ceil(pieces).max(2));
        let is_on_edge = [piece[1] == 0, piece[0] + 1 == pieces, piece[1] + 1 == pieces, piece[0] == 0];
        let mut own = PieceFactors {
            inner,
            counts: std::array::from_fn(|edge| inner[edge % 2]),
            low: piece.map(|place| place as f32 / pieces as f32),
            high: piece.map(|place| (place + 1) as f32 / pieces as f32),
        };
        for edge in (0..4).filter(|&edge| is_on_edge[edge]) {
            let axis = edge % 2;
            let count = self.counts[edge] as u32;
            let (first, last) = (piece[axis] * count / pieces, (piece[axis] + 1) * count / pieces);
            own.counts[edge] = (last - first).max(1);
            own.low[axis] = own.low[axis].min(self.edge_point(edge, first as f32));
            own.high[axis] = own.high[axis].max(self.edge_point(edge, last as f32));
        }
        own
    }

    /// The shapes of the patch's triangles, as culling needs to know them.
    pub fn grain(&self) -> Grain {
        let inner = self.inner.map(|factor| self.spacing.segment_bounds(factor));
        let (mut longest, mut shortest) = (inner[0][0].max(inner[1][0]), inner[0][1].min(inner[1][1]));
        let depth = shortest;
        let is_uneven = self.high != [0.0; 4] || (0..4).any(|edge| self.low[edge] != self.inner[edge % 2]);
        if !is_uneven {
            return Grain { grain: 1.0 / shortest, reach: 0.0, skew: 0.0, is_uneven };
        }
        for edge in 0..4 {
            let mut bounds = self.spacing.segment_bounds(self.low[edge]);
            if self.high[edge] != 0.0 {
                let high = self.spacing.segment_bounds(self.high[edge]);
                bounds = [0.5 * bounds[0].max(high[0]), 0.5 * bounds[1].min(high[1])];
            }
            longest = longest.max(bounds[0]);
            shortest = shortest.min(bounds[1]);
        }
        let reach = (RING_REACH * longest).min(1.0).max(depth);
        let product = ((RING_PRODUCT * longest) * longest).min(MAX_RING_PRODUCT);
        Grain { grain: reach / (shortest * depth), reach: product.sqrt(), skew: product / (2.0 * depth), is_uneven }
    }
}

/// A piece of a cut patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceFactors {
    /// Segments of its rows inside, along u and v.
    pub inner: [u32; 2],
    /// Segments of its edges, at least 1.
    pub counts: [u32; 4],
    /// The least parameters of its points.
    pub low: [f32; 2],
    /// The largest.
    pub high: [f32; 2],
}

/// Triangles that the tessellator makes: the inner grid, and a ring between it and each edge.
pub fn triangle_count(edges: [u32; 4], inner: [u32; 2]) -> u32 {
    if edges == [1; 4] && inner == [1; 2] {
        return 2;
    }
    let rest = inner.map(|count| count.max(2) - 2);
    2 * rest[0] * rest[1] + (0..4).map(|edge| edges[edge] + rest[edge % 2]).sum::<u32>()
}

/// A triangle between two rows of points along an edge reaches over at most this many of the longest segments: 1.7 were
/// found of the tessellator that Direct3D 11 specifies, for all spacings and factors.
const RING_REACH: f32 = 2.0;
/// Distances of such a triangle's tip from both ends of its base, measured along the edge: their product is at most this
/// times the square of the longest segment (1.2 were found), and a quarter of the edge's square, taken twice for safety.
const RING_PRODUCT: f32 = 1.5;
const MAX_RING_PRODUCT: f32 = 0.5;

/// How a patch is tessellated, in its own parameters: `Grain` of `glsl/shared/visibility.glsl`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// 1 over the shortest side of a triangle; of an uneven patch at least 1 over a triangle's area times the longest side.
    pub grain: f32,
    /// Of an uneven patch: how far the tip of a triangle of such an edge may be from the nearer end of its base, along the edge.
    pub reach: f32,
    /// How much more a triangle of an uneven edge turns along with the row: x in the text of [`crate::visibility`].
    pub skew: f32,
    /// Whether an edge has other points than the row beside it.
    pub is_uneven: bool,
}

#[cfg(test)]
mod tests {
    use planish_subdiv::selection::density_at;
    use planish_subdiv::topology::Location;

    use super::*;

    fn info(level: u8) -> PatchInfo {
        PatchInfo { level, location: Location { depth: level, ..Location::default() }, ..PatchInfo::default() }
    }

    fn face(at: [f32; 4]) -> impl Fn(f32, f32) -> f32 {
        move |u, v| density_at(&at, [0, 1, 2, 3], u, v)
    }

    #[test]
    fn segments_are_the_next_whole_odd_or_even_number() {
        for (factor, equal, odd, even) in
            [(1.0, 1, 1, 1), (1.1, 2, 3, 2), (2.0, 2, 3, 2), (3.0, 3, 3, 4), (3.2, 4, 5, 4), (63.0, 63, 63, 64)]
        {
            let count = |spacing: Spacing| spacing.segment_count(spacing.spaced(factor)) as u32;
            assert_eq!(count(Spacing::Equal), equal);
            assert_eq!(count(Spacing::FractionalOdd), odd);
            assert_eq!(count(Spacing::FractionalEven), even);
        }
    }

    #[test]
    fn a_patch_of_n_by_n_segments_has_two_n_squared_triangles() {
        for n in 1..=64_u8 {
            let factors = PatchFactors::new(face([f32::from(n); 4]), &info(0), 0, Spacing::Equal);
            assert_eq!(factors.triangle_count(), 2 * u32::from(n) * u32::from(n));
            assert_eq!(factors.cut_count(), 1);
        }
    }

    #[test]
    fn the_pieces_of_a_cut_patch_share_out_its_segments() {
        for (spacing, split) in [(Spacing::Equal, 0), (Spacing::FractionalOdd, 0b0101), (Spacing::FractionalEven, 8)] {
            let factors = PatchFactors::new(face([100.0, 1.0, 700.5, 330.0]), &info(0), split, spacing);
            let pieces = factors.cut_count();
            assert!(pieces > 8);
            let mut on_edges = [0; 4];
            for j in 0..pieces {
                for i in 0..pieces {
                    let piece = factors.piece(pieces, [i, j]);
                    assert!(piece.counts.iter().chain(&piece.inner).all(|count| (1..=64).contains(count)));
                    let is_on = [j == 0, i + 1 == pieces, j + 1 == pieces, i == 0];
                    for edge in (0..4).filter(|&edge| is_on[edge]) {
                        on_edges[edge] += piece.counts[edge];
                    }
                }
            }
            for (found, count) in on_edges.into_iter().zip(factors.counts) {
                // Pieces with a single point of an edge count a segment of no length.
                assert!(found >= count as u32, "{factors:?}");
                if count >= pieces as f32 {
                    assert_eq!(found, count as u32);
                }
            }
        }
    }

    #[test]
    fn halves_of_a_split_edge_are_the_edges_one_level_down() {
        let density = face([3.3, 9.1, 20.7, 5.9]);
        let coarse = PatchFactors::new(&density, &info(1), 1, Spacing::FractionalOdd);
        for (u, of_coarse) in [(0, coarse.low[0]), (1, coarse.high[0])] {
            let location = Location { depth: 2, u, ..Location::default() };
            let fine = PatchInfo { level: 2, location, ..PatchInfo::default() };
            let fine = PatchFactors::new(&density, &fine, 0, Spacing::FractionalOdd);
            assert_eq!(fine.low[0], of_coarse);
        }
    }

    #[test]
    fn rings_are_skewed_only_where_an_edge_has_other_points() {
        let even = PatchFactors::new(face([4.0; 4]), &info(0), 0, Spacing::Equal).grain();
        assert_eq!(even, Grain { grain: 4.0, reach: 0.0, skew: 0.0, is_uneven: false });
        let odd = PatchFactors::new(face([4.2; 4]), &info(0), 1, Spacing::FractionalOdd).grain();
        // Five segments: three of 1 / 4.2, two of 0.6 / 4.2.
        let depth = 0.6_f32 / 4.2;
        assert!((odd.skew - 1.5 / (4.2 * 4.2) / (2.0 * depth)).abs() < 1e-5, "{odd:?}");
        assert!(odd.is_uneven && odd.grain * depth > 1.0);
    }
}
