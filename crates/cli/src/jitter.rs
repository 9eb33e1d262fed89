//! Where in a pixel its samples lie.

use glam::Vec2;

/// The golden ratio's fractional part: its multiples, modulo 1, are as far apart as any.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Offsets from the pixel's centre, in pixels, of `count` samples that are to be averaged with equal weight.
///
/// Sample i has the i-th of `count` equal columns and, as row, the rank of the i-th multiple of the golden ratio: each
/// column and each row holds one sample, at its middle, so that the mean is the centre; one sample is the centre.
pub fn sample_offsets(count: u32) -> Vec<Vec2> {
    let height = |i: u32| (f64::from(i) * GOLDEN).fract();
    let mut columns: Vec<u32> = (0..count).collect();
    columns.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
    let middle = |i: u32| ((f64::from(i) + 0.5) / f64::from(count) - 0.5) as f32;
    let mut offsets = vec![Vec2::ZERO; count as usize];
    for (row, &column) in (0..).zip(&columns) {
        offsets[column as usize] = Vec2::new(middle(column), middle(row));
    }
    offsets
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_the_centre() {
        assert_eq!(sample_offsets(1), [Vec2::ZERO]);
    }

    #[test]
    fn samples_lie_in_the_pixel_and_their_mean_is_its_centre() {
        for count in [2, 3, 4, 16, 64, 255, 1024] {
            let offsets = sample_offsets(count);
            assert_eq!(offsets.len(), count as usize);
            assert!(offsets.iter().all(|offset| offset.abs().max_element() < 0.5));
            let mean = offsets.iter().sum::<Vec2>() / count as f32;
            assert!(mean.length() < 1e-5, "{count}: {mean}");
        }
    }

    #[test]
    fn every_quarter_of_the_pixel_has_its_share() {
        for count in [4, 16, 64, 256] {
            let offsets = sample_offsets(count);
            for quarter in 0..4 {
                let inside = |o: &&Vec2| (o.x > 0.0) == (quarter & 1 != 0) && (o.y > 0.0) == (quarter & 2 != 0);
                let found = offsets.iter().filter(inside).count() as i64;
                assert!((found - i64::from(count) / 4).abs() <= 1, "{count}: quarter {quarter} has {found}");
            }
        }
    }
}
