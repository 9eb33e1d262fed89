//! One value for all tiles that meet at a texel, level by level.
//!
//! The texels of edges are kept once, whatever number of tiles has them on a side: they are averaged over the tiles, filtered
//! along the edge, and then written to the tiles. So tiles that meet have the same bits at every level by construction.
use super::meeting::{Edge, Meetings, Side, Span};

/// Texels of all Ptex faces at one level: squares of `segments + 1` texels a side, one after another.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceTexels {
    /// Texels of a side, less one: a power of two; at least 2 where there are n-gons.
    pub segments: usize,
    /// Numbers in a texel.
    pub channels: usize,
    /// Interleaved channels.
    pub values: Vec<f32>,
}

impl FaceTexels {
    /// Where the first number of a texel is.
    fn at(&self, tile: usize, i: usize, j: usize) -> usize {
        let side = self.segments + 1;
        ((tile * side + j) * side + i) * self.channels
    }

    /// Where the first number of texel `k` of side v = 0, u = 1, v = 1 or u = 0 is.
    fn at_side(&self, tile: usize, side: usize, k: usize) -> usize {
        let end = self.segments;
        let (i, j) = [(k, 0), (end, k), (k, end), (0, k)][side];
        self.at(tile, i, j)
    }
}

/// Texels of all edges: `segments + 1` each, both ends included.
pub struct EdgeTexels {
    segments: usize,
    channels: usize,
    values: Vec<f32>,
}

impl EdgeTexels {
    /// The means over all tiles that meet; sums are taken in double, in the order of the Ptex faces.
    pub fn averaged(meetings: &Meetings, texels: &FaceTexels) -> Self {
        let (segments, channels) = (texels.segments, texels.channels);
        let mut points = Means::new(meetings.point_count as usize, channels);
        let mut nodes = Means::new(meetings.edges.len() * (segments + 1), channels);
        for (tile, sides) in meetings.tiles.iter().enumerate().filter(|(_, sides)| !sides.is_hole) {
            let corners = [(0, 0), (segments, 0), (segments, segments), (0, segments)];
            for (point, (i, j)) in sides.corners.iter().zip(corners) {
                if let &Some(point) = point {
                    points.add(point as usize, &texels.values[texels.at(tile, i, j)..][..channels]);
                }
            }
            for (index, side) in sides.sides.iter().enumerate() {
                for k in 1..=segments {
                    let node = node_of(side.span, k, segments).filter(|&node| node > 0 && node < segments);
                    if let Some(node) = node {
                        let from = texels.at_side(tile, index, k);
                        nodes.add(side.edge as usize * (segments + 1) + node, &texels.values[from..][..channels]);
                    }
                }
            }
        }
        let (points, values) = (points.into_values(), nodes.into_values());
        let mut edges = Self { segments, channels, values };
        for (index, edge) in meetings.edges.iter().enumerate() {
            // The middle of a spoke's base edge is there already: spokes come after, and begin with a copy of it.
            let ends = match *edge {
                Edge::Base([first, last]) => [Some(first), Some(last)],
                Edge::Spoke { center, .. } => [None, Some(center)],
            };
            for (node, point) in [0, segments].into_iter().zip(ends) {
                if let Some(point) = point {
                    let value = &points[point as usize * channels..][..channels];
                    edges.node_mut(index, node).copy_from_slice(value);
                }
            }
        }
        edges.begin_spokes(meetings);
        edges
    }

    /// Half as many segments: ends stay, and between them 1/4 1/2 1/4 along the edge.
    pub fn halved(&self, meetings: &Meetings) -> Self {
        let (segments, channels) = (self.segments / 2, self.channels);
        let values = vec![0.0; meetings.edges.len() * (segments + 1) * channels];
        let mut coarse = Self { segments, channels, values };
        for edge in 0..meetings.edges.len() {
            for node in 0..=segments {
                for channel in 0..channels {
                    let fine = |node: usize| f64::from(self.node(edge, node)[channel]);
                    let value = if node == 0 || node == segments {
                        fine(2 * node)
                    } else {
                        0.25 * (fine(2 * node - 1) + fine(2 * node + 1)) + 0.5 * fine(2 * node)
                    };
                    coarse.node_mut(edge, node)[channel] = value as f32 + 0.0;
                }
            }
        }
        coarse.begin_spokes(meetings);
        coarse
    }

    /// Writes the edges' texels to the sides of all tiles. Between every two texels that a part of an n-gon has from the
    /// whole edge it gets their mean.
    pub fn write_to(&self, meetings: &Meetings, texels: &mut FaceTexels) {
        for (tile, sides) in meetings.tiles.iter().enumerate().filter(|(_, sides)| !sides.is_hole) {
            for (index, &Side { edge, span }) in sides.sides.iter().enumerate() {
                for k in 0..=self.segments {
                    let to = texels.at_side(tile, index, k);
                    for channel in 0..self.channels {
                        let node =
                            |k| node_of(span, k, self.segments).map(|node| self.node(edge as usize, node)[channel]);
                        let between = || Some(0.5 * (node(k - 1)? + node(k + 1)?) + 0.0);
                        texels.values[to + channel] =
                            node(k).or_else(between).expect("odd texels of a half edge lie between two of its nodes");
                    }
                }
            }
        }
    }

    /// Spokes begin where the middle of their base edge is.
    fn begin_spokes(&mut self, meetings: &Meetings) {
        for (index, edge) in meetings.edges.iter().enumerate() {
            if let &Edge::Spoke { base_edge, .. } = edge {
                let middle = self.node(base_edge as usize, self.segments / 2).to_vec();
                self.node_mut(index, 0).copy_from_slice(&middle);
            }
        }
    }

    fn node(&self, edge: usize, node: usize) -> &[f32] {
        &self.values[(edge * (self.segments + 1) + node) * self.channels..][..self.channels]
    }

    fn node_mut(&mut self, edge: usize, node: usize) -> &mut [f32] {
        &mut self.values[(edge * (self.segments + 1) + node) * self.channels..][..self.channels]
    }
}

/// The texel of an edge that texel `k` of a side is; none for those of a half edge that are between two.
fn node_of(span: Span, k: usize, segments: usize) -> Option<usize> {
    let of_half = k.is_multiple_of(2).then_some(k / 2);
    match span {
        Span::Whole => Some(k),
        Span::Reversed => Some(segments - k),
        Span::FirstHalf => of_half,
        Span::LastHalf => of_half.map(|node| segments - node),
    }
}

/// Half as many segments, the edges' texels not yet written: every second texel, with weights 1 2 1 both ways.
pub fn halved_inside(fine: &FaceTexels, tile_count: usize) -> FaceTexels {
    let (segments, channels) = (fine.segments / 2, fine.channels);
    let side = segments + 1;
    let mut coarse = FaceTexels { segments, channels, values: vec![0.0; tile_count * side * side * channels] };
    for tile in 0..tile_count {
        for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
            let is_border = i == 0 || j == 0 || i == segments || j == segments;
            for channel in 0..channels {
                let texel = |i, j| f64::from(fine.values[fine.at(tile, i, j) + channel]);
                let row = |j| 0.25 * (texel(2 * i - 1, j) + texel(2 * i + 1, j)) + 0.5 * texel(2 * i, j);
                // Borders are those of holes, which have no edges, until edges are written.
                let value = if is_border {
                    texel(2 * i, 2 * j)
                } else {
                    0.25 * (row(2 * j - 1) + row(2 * j + 1)) + 0.5 * row(2 * j)
                };
                let to = coarse.at(tile, i, j) + channel;
                coarse.values[to] = value as f32 + 0.0;
            }
        }
    }
    coarse
}

/// Means in the making.
struct Means {
    channels: usize,
    sums: Vec<f64>,
    counts: Vec<u32>,
}

impl Means {
    fn new(count: usize, channels: usize) -> Self {
        Self { channels, sums: vec![0.0; count * channels], counts: vec![0; count] }
    }

    fn add(&mut self, index: usize, values: &[f32]) {
        let sums = &mut self.sums[index * self.channels..][..self.channels];
        sums.iter_mut().zip(values).for_each(|(sum, &value)| *sum += f64::from(value));
        self.counts[index] += 1;
    }

    fn into_values(self) -> Vec<f32> {
        let mean = |(index, sum): (usize, f64)| (sum / f64::from(self.counts[index / self.channels].max(1))) as f32;
        self.sums.into_iter().enumerate().map(mean).map(|value| value + 0.0).collect()
    }
}
