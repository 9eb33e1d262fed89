//! A small random number generator and smooth noise: the same numbers on every machine and for ever.
use glam::DVec3;

/// SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
pub struct Random {
    state: u64,
}

impl Random {
    /// A generator that always gives the same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.state ^ (self.state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// A number from 0 to 1, without 1.
    pub fn unit(&mut self) -> f64 {
        const BITS: u32 = 53;
        (self.bits() >> (64 - BITS)) as f64 / (1_u64 << BITS) as f64
    }

    /// True in so many of 100 cases.
    pub fn percent(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// One of some values, of which there must be one.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len())]
    }

    /// A number below `limit`, which must not be 0.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.bits() % limit as u64) as usize
    }
}

/// Smooth noise in about -1 to 1: octaves of products of sines, each twice as fine and half as strong as the last.
pub fn noise(point: DVec3, octaves: u32) -> f64 {
    // Shears the octaves against each other, so that their zeros do not line up.
    const SHEAR: DVec3 = DVec3::new(0.71, 1.13, 0.43);
    let mut point = point;
    let mut strength = 0.5;
    let mut sum = 0.0;
    for _ in 0..octaves {
        sum +=
            strength * ((point.x + 0.3).sin() * (point.y + 1.1).cos() + (point.z + 0.7).sin() * (point.x - 0.4).cos());
        point = DVec3::new(point.y + SHEAR.y * point.x, point.z - SHEAR.z * point.y, point.x + SHEAR.x * point.z) * 1.6;
        strength *= 0.5;
    }
    sum
}
