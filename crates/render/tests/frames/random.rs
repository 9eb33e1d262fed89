//! Numbers that are the same in every run.

use glam::Vec3;

/// A linear congruential generator.
pub struct Random(pub u64);

impl Random {
    /// The same for the same name, whatever comes before.
    pub fn named(name: &str) -> Self {
        Self(name.bytes().fold(0, |seed: u64, byte| seed.wrapping_mul(257).wrapping_add(byte.into())))
    }

    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    pub fn part(&mut self) -> f32 {
        self.bits() as f32 / (1_u32 << 31) as f32
    }

    /// Any number, some of them none.
    pub fn odd(&mut self) -> f32 {
        const ODD: [f32; 9] = [0.0, -1.0, 1e-30, -1e30, f32::MAX, f32::MIN_POSITIVE, f32::INFINITY, f32::NAN, 1e6];
        match self.bits() % 4 {
            0 => ODD[self.bits() as usize % ODD.len()],
            _ => 4.0 * self.part() - 2.0,
        }
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.part()
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.bits() as usize % all.len()]
    }

    /// Evenly among all.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let vector = Vec3::from(std::array::from_fn(|_| self.between(-1.0, 1.0)));
            if (0.01..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }
}
