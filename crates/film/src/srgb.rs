//! Linear light to sRGB codes (IEC 61966-2-1).

/// Codes of 8 bits.
const CODE_COUNT: usize = 256;

/// The 8-bit sRGB code nearest to a linear value.
///
/// Holds the linear values at which the rounded code steps up: code c starts where the transfer function reaches c -
/// 1/2. A search in them rounds exactly and asks no power function a pixel.
pub(crate) struct Encoder {
    thresholds: [f32; CODE_COUNT - 1],
}

impl Encoder {
    pub(crate) fn new() -> Self {
        Self {
            thresholds: std::array::from_fn(|below| to_linear((below as f64 + 0.5) / (CODE_COUNT - 1) as f64) as f32),
        }
    }

    /// Values are clamped to 0 .. 1; not a number is 0.
    pub(crate) fn encode(&self, linear: f32) -> u8 {
        // 255 thresholds: the count of those reached fits a byte.
        self.thresholds.partition_point(|&threshold| threshold <= linear) as u8
    }
}

/// The inverse of the sRGB transfer function: encoded value, 0 to 1, to linear light.
fn to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The transfer function as the standard writes it.
    fn transfer(linear: f64) -> f64 {
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
    }

    #[test]
    fn codes_are_the_rounded_transfer_function() {
        let encoder = Encoder::new();
        for step in 0..=1_000_000 {
            let linear = step as f32 / 1_000_000.0;
            let exact = transfer(f64::from(linear)) * 255.0;
            let code = f64::from(encoder.encode(linear));
            assert!((code - exact).abs() <= 0.5 + 1e-4, "{linear}: {code} for {exact}");
        }
    }

    #[test]
    fn values_beyond_the_range_are_clamped() {
        let encoder = Encoder::new();
        for (linear, code) in
            [(-1.0, 0), (0.0, 0), (1.0, 255), (7.0, 255), (f32::INFINITY, 255), (f32::NEG_INFINITY, 0), (f32::NAN, 0)]
        {
            assert_eq!(encoder.encode(linear), code, "{linear}");
        }
    }
}
