//! The samples of a pixel: where in the filter, when in the shutter's time, and where on the lens.
//!
//! All samples of a frame have equal weight, and every sample is a whole frame: its pixel's offset is drawn from the filter's own
//! distribution (filter importance sampling: Ernst, Stamminger and Greiner 2006), so their mean is the filtered image.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use glam::{DVec2, Vec2};

/// The golden ratio's fractional part: its multiples, modulo 1, are as far apart as any.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// The root of x^4 = x + 1: powers of its inverse spread points evenly in three dimensions (Roberts 2018, the sequence R3).
const ROOT_3: f64 = 1.220_744_084_605_759_5;
/// Entries of a filter's table.
const TABLE_SIZE: usize = 2048;

/// What a pixel is the mean of: filters without negative weights, the same along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFilter {
    /// The same weight everywhere.
    Box,
    /// Falls to 0 linearly.
    Triangle,
    /// Standard deviation of a sixth of the width, cut off at both ends.
    Gaussian,
    /// The four-term window of Harris 1978, with side lobes below -92 dB.
    BlackmanHarris,
}

impl PixelFilter {
    /// Width, in pixels, where none is asked for.
    pub fn default_width(self) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Triangle | Self::BlackmanHarris => 2.0,
            Self::Gaussian => 2.5,
        }
    }

    /// Weight at a place from -1, one end, to 1.
    fn weight(self, x: f64) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Triangle => 1.0 - x.abs(),
            Self::Gaussian => (-4.5 * x * x).exp(),
            Self::BlackmanHarris => {
                let angle = std::f64::consts::PI * (x + 1.0);
                0.358_75 - 0.488_29 * angle.cos() + 0.141_28 * (2.0 * angle).cos() - 0.011_68 * (3.0 * angle).cos()
            }
        }
    }
}

/// Turns even numbers into places in a filter.
struct FilterTable {
    /// The share of the filter's weight below place i of [`TABLE_SIZE`].
    sums: Vec<f64>,
    half_width: f64,
}

impl FilterTable {
    fn new(filter: PixelFilter, width: f64) -> Self {
        let middle = |i: usize| 2.0 * (i as f64 + 0.5) / TABLE_SIZE as f64 - 1.0;
        let mut sums = vec![0.0];
        for i in 0..TABLE_SIZE {
            sums.push(sums[i] + filter.weight(middle(i)));
        }
        let all = sums[TABLE_SIZE];
        sums.iter_mut().for_each(|sum| *sum /= all);
        Self { sums, half_width: 0.5 * width }
    }

    /// The place, in pixels from the middle, below which there is a share of the weight.
    fn place(&self, share: f64) -> f64 {
        let after = self.sums.partition_point(|&sum| sum <= share).clamp(1, TABLE_SIZE);
        let (low, high) = (self.sums[after - 1], self.sums[after]);
        let within = if high > low { (share - low) / (high - low) } else { 0.5 };
        self.half_width * (2.0 * ((after - 1) as f64 + within) / TABLE_SIZE as f64 - 1.0)
    }
}

/// One sample of all pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// From the pixel's centre, in pixels.
    pub pixel: Vec2,
    /// From 0, when the shutter opens, to 1.
    pub time: f64,
    /// On the unit disc.
    pub lens: Vec2,
}

/// The samples of a frame. A single one is at the centre of pixel and lens as the shutter opens.
///
/// In the pixel, sample i has the i-th of `count` columns of equal weight and, as row, the rank of the i-th multiple of the golden
/// ratio: each column and each row holds one sample. Times and places on the lens are a sequence in three dimensions of
/// its own, so that neither goes with the place in the pixel.
pub fn samples(count: u32, filter: PixelFilter, width: f64) -> Vec<Sample> {
    if count == 1 {
        return vec![Sample { pixel: Vec2::ZERO, time: 0.0, lens: Vec2::ZERO }];
    }
    let table = FilterTable::new(filter, width);
    let height = |i: u32| (f64::from(i) * GOLDEN).fract();
    let mut columns: Vec<u32> = (0..count).collect();
    columns.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
    let middle = |i: u32| table.place((f64::from(i) + 0.5) / f64::from(count)) as f32;
    let spread = |i: u32, power: i32| (0.5 + f64::from(i) * ROOT_3.powi(-power)).fract();
    let sample = |column: u32| Sample {
        pixel: Vec2::new(middle(column), 0.0),
        time: spread(column, 1),
        lens: on_disc(spread(column, 2), spread(column, 3)),
    };
    let mut samples: Vec<Sample> = (0..count).map(sample).collect();
    for (row, &column) in (0..).zip(&columns) {
        samples[column as usize].pixel.y = middle(row);
    }
    // As times ascend the scene moves on little between samples; the mean is the same in any order but for rounding.
    samples
}

/// The unit square onto the unit disc, equal areas onto equal areas (Shirley and Chiu 1997).
fn on_disc(x: f64, y: f64) -> Vec2 {
    let p = DVec2::new(2.0 * x - 1.0, 2.0 * y - 1.0);
    if p == DVec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if p.x.abs() > p.y.abs() { (p.x, FRAC_PI_4 * p.y / p.x) } else { (p.y, FRAC_PI_2 - FRAC_PI_4 * p.x / p.y) };
    (radius * DVec2::from_angle(angle % TAU)).as_vec2()
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILTERS: [PixelFilter; 4] =
        [PixelFilter::Box, PixelFilter::Triangle, PixelFilter::Gaussian, PixelFilter::BlackmanHarris];

    fn offsets(count: u32, filter: PixelFilter) -> Vec<Vec2> {
        samples(count, filter, filter.default_width()).iter().map(|sample| sample.pixel).collect()
    }

    #[test]
    fn one_sample_is_the_centre_as_the_shutter_opens() {
        let [sample] = samples(1, PixelFilter::Gaussian, 3.0)[..] else { panic!("one sample") };
        assert_eq!(sample, Sample { pixel: Vec2::ZERO, time: 0.0, lens: Vec2::ZERO });
    }

    #[test]
    fn samples_lie_in_the_filter_and_their_mean_is_the_pixel_s_centre() {
        for filter in FILTERS {
            for count in [2, 3, 4, 16, 64, 255, 1024] {
                let offsets = offsets(count, filter);
                assert_eq!(offsets.len(), count as usize);
                let half_width = 0.5 * filter.default_width() as f32;
                assert!(offsets.iter().all(|offset| offset.abs().max_element() < half_width));
                let mean = offsets.iter().sum::<Vec2>() / count as f32;
                assert!(mean.length() < 1e-5, "{filter:?} {count}: {mean}");
            }
        }
    }

    #[test]
    fn every_quarter_of_the_pixel_has_its_share() {
        for count in [4, 16, 64, 256] {
            let offsets = offsets(count, PixelFilter::BlackmanHarris);
            for quarter in 0..4 {
                let inside = |o: &&Vec2| (o.x > 0.0) == (quarter & 1 != 0) && (o.y > 0.0) == (quarter & 2 != 0);
                let found = offsets.iter().filter(inside).count() as i64;
                assert!((found - i64::from(count) / 4).abs() <= 1, "{count}: quarter {quarter} has {found}");
            }
        }
    }

    #[test]
    fn samples_are_as_dense_as_the_filter_is_high() {
        for filter in FILTERS {
            let offsets = offsets(4096, filter);
            let half_width = 0.5 * filter.default_width();
            let all: f64 = (0..1000).map(|i| filter.weight(f64::from(i) * 0.002 - 0.999)).sum();
            for bin in 0..10 {
                let inside = |x: f64| (((x / half_width + 1.0) * 5.0) as i32).min(9) == bin;
                let found = offsets.iter().filter(|offset| inside(f64::from(offset.x))).count() as f64 / 4096.0;
                let low = 100 * bin;
                let share: f64 =
                    (low..low + 100).map(|i| filter.weight(f64::from(i) * 0.002 - 0.999)).sum::<f64>() / all;
                assert!((found - share).abs() < 2e-3, "{filter:?} {bin}: {found} {share}");
            }
        }
    }

    #[test]
    fn filters_have_the_spread_of_their_formulas() {
        use std::f64::consts::PI;
        // A Gaussian of deviation 1/3 loses what lies beyond three deviations: 2 * 3 * 0.004432 of 0.9973 of its variance.
        let gaussian = (1.0 - 6.0 * 0.004_432 / 0.997_3) / 9.0;
        // The integral of x^2 cos(k pi x) from -1 to 1 is 4 (-1)^k / (k pi)^2.
        let window = 1.0 / 3.0 + 2.0 / (0.358_75 * PI * PI) * (-0.488_29 + 0.141_28 / 4.0 - 0.011_68 / 9.0);
        for (filter, variance, width) in [
            (PixelFilter::Box, 1.0 / 3.0, 1.0),
            (PixelFilter::Triangle, 1.0 / 6.0, 2.0),
            (PixelFilter::Gaussian, gaussian, 2.5),
            (PixelFilter::BlackmanHarris, window, 2.0),
        ] {
            assert_eq!(filter.default_width(), width, "{filter:?}");
            for width in [1.0, 3.0] {
                let samples = samples(4096, filter, width);
                let places = samples.iter().flat_map(|sample| sample.pixel.to_array()).map(f64::from);
                let found = places.map(|place| place * place).sum::<f64>() / 8192.0;
                let expected = variance * (0.5 * width) * (0.5 * width);
                assert!((found / expected - 1.0).abs() < 1e-3, "{filter:?} {width}: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn the_lens_is_seen_from_all_of_its_sides() {
        let samples = samples(256, PixelFilter::Box, 1.0);
        let mut found = [0; 8];
        for sample in &samples {
            let turn = sample.lens.y.atan2(sample.lens.x).rem_euclid(std::f32::consts::TAU);
            found[(turn / std::f32::consts::FRAC_PI_4) as usize % 8] += 1;
        }
        assert!(found.iter().all(|count| (26..=38).contains(count)), "{found:?}");
    }

    #[test]
    fn no_number_of_a_sample_goes_with_another() {
        let samples = samples(256, PixelFilter::Box, 1.0);
        let numbers = |sample: &Sample| {
            let Sample { pixel, time, lens } = *sample;
            [pixel.x, pixel.y, time as f32 - 0.5, lens.x, lens.y]
        };
        let product =
            |a: usize, b: usize| samples.iter().map(|sample| numbers(sample)[a] * numbers(sample)[b]).sum::<f32>();
        for a in 0..5 {
            for b in 0..a {
                let correlation = product(a, b) / (product(a, a) * product(b, b)).sqrt();
                assert!(correlation.abs() < 0.12, "{a} and {b}: {correlation}");
            }
        }
    }

    #[test]
    fn times_and_places_on_the_lens_are_spread_evenly() {
        let samples = samples(256, PixelFilter::Box, 1.0);
        for eighth in 0..8 {
            let found = samples.iter().filter(|sample| (sample.time * 8.0) as i32 == eighth).count();
            assert!((28..=36).contains(&found), "{eighth}: {found}");
        }
        assert!(samples.iter().all(|sample| sample.lens.length() <= 1.0 && (0.0..1.0).contains(&sample.time)));
        let inner = samples.iter().filter(|sample| sample.lens.length_squared() < 0.5).count();
        assert!((112..=144).contains(&inner), "{inner}");
        let mean = samples.iter().map(|sample| sample.lens).sum::<Vec2>() / 256.0;
        assert!(mean.length() < 0.03, "{mean}");
        // Nor do they go with the place in the pixel.
        let product = samples.iter().map(|sample| sample.pixel.x * (sample.time as f32 - 0.5)).sum::<f32>() / 256.0;
        assert!(product.abs() < 0.01, "{product}");
    }
}
