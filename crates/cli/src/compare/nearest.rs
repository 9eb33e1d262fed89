//! Deviations from the nearest points, as Metro samples them (Cignoni, Rocchini and Scopigno 1998).

use std::collections::HashSet;

use super::deviation::{Deviation, Place, Summary, Tally};
use super::soup::{Soup, SurfacePoint, Triangle};
use super::threads::map_on_all_cores;
use super::tree::Tree;

/// Deviation of a point from the nearest one of a surface that is not empty.
fn deviation(point: &SurfacePoint, tree: &Tree<'_>) -> Option<Deviation> {
    let nearest = tree.nearest(point.position)?;
    let angle = Deviation::between(point, &nearest.triangle.at(nearest.weights)).angle;
    Some(Deviation { distance: nearest.distance_squared.sqrt(), angle })
}

/// Samples one surface by area and looks for the nearest points of the other. Vertices count for the maximum of distances alone: of a spike an equal
/// share of the area may have no sample.
pub fn compare(from: &Soup, to: &Tree<'_>, sample_count: u32) -> Summary {
    let mut tally = Tally::default();
    for (weight, samples) in [(1.0, samples(from, sample_count)), (0.0, vertices(from))] {
        let deviations = map_on_all_cores(&samples, |&(triangle, weights)| deviation(&triangle.at(weights), to));
        for (&(triangle, weights), deviation) in samples.iter().zip(deviations) {
            if let Some(mut deviation) = deviation {
                if weight == 0.0 {
                    // Where triangles meet at an edge any of their normals may be the one that is found.
                    deviation.angle = None;
                }
                tally.add(weight, deviation, Place::new(triangle.face, triangle.at(weights).uv));
            }
        }
    }
    tally.summary()
}

/// Every vertex once, as a corner of a triangle.
fn vertices(soup: &Soup) -> Vec<(&Triangle, [f64; 3])> {
    const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut known = HashSet::new();
    let corners = soup.triangles.iter().flat_map(|triangle| CORNERS.map(|weights| (triangle, weights)));
    corners
        .filter(|(triangle, weights)| known.insert(triangle.at(*weights).position.to_array().map(f64::to_bits)))
        .collect()
}

/// Of every corner, for a picture.
pub fn corner_deviations(from: &Soup, to: &Tree<'_>) -> Vec<Option<[Deviation; 3]>> {
    map_on_all_cores(&from.triangles, |triangle| {
        let corner = |weights| deviation(&triangle.at(weights), to);
        Some([corner([1.0, 0.0, 0.0])?, corner([0.0, 1.0, 0.0])?, corner([0.0, 0.0, 1.0])?])
    })
}

/// One point in each of so many equal shares of the area of a soup that is not empty: no part of it goes without.
pub(super) fn samples(soup: &Soup, count: u32) -> Vec<(&Triangle, [f64; 3])> {
    // Area up to the end of each triangle.
    let ends: Vec<f64> = soup
        .triangles
        .iter()
        .scan(0.0, |sum, triangle| {
            *sum += triangle.area();
            Some(*sum)
        })
        .collect();
    let share = ends.last().copied().unwrap_or_default() / f64::from(count);
    let mut random = Random(0);
    let sample = |index| {
        let area = (f64::from(index) + random.next()) * share;
        // Roundings may leave the last sample beyond the last triangle.
        let triangle = ends.partition_point(|&end| end <= area).min(ends.len() - 1);
        let (root, along) = (random.next().sqrt(), random.next());
        (&soup.triangles[triangle], [1.0 - root, root * (1.0 - along), root * along])
    };
    (0..count).map(sample).collect()
}

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers everywhere.
struct Random(u64);

impl Random {
    /// At least 0 and less than 1, in steps of 2^-53.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
