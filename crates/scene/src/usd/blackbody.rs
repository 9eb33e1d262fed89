//! The colour of a black body.
use glam::{DMat3, DVec3};

/// Kelvins of the approximation.
const RANGE: [f64; 2] = [1667.0, 25000.0];
/// XYZ to linear Rec. 709, columns of X, Y and Z (IEC 61966-2-1).
const FROM_XYZ: DMat3 = DMat3::from_cols(
    DVec3::new(3.2406, -0.9689, 0.0557),
    DVec3::new(-1.5372, 1.8758, -0.2040),
    DVec3::new(-0.4986, 0.0415, 1.0570),
);
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Linear Rec. 709 of luminance 1 at a temperature in kelvins, nearest to those that the approximation of the Planckian locus
/// holds for (Kim et al., "Design of Advanced Color Temperature Control System for HDTV Applications", 2002).
pub fn color(kelvins: f64) -> DVec3 {
    let kelvins = kelvins.clamp(RANGE[0], RANGE[1]);
    let t = 1000.0 / kelvins;
    let x = match kelvins <= 4000.0 {
        true => ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910,
        false => ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390,
    };
    let y = match kelvins {
        k if k <= 2222.0 => ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683,
        k if k <= 4000.0 => ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867,
        _ => ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483,
    };
    let color = (FROM_XYZ * DVec3::new(x / y, 1.0, (1.0 - x - y) / y)).max(DVec3::ZERO);
    color / color.dot(LUMINANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn daylight_is_nearly_white_and_candles_are_orange() {
        assert!((color(6500.0) - DVec3::ONE).abs().max_element() < 0.06, "{}", color(6500.0));
        let candle = color(1900.0);
        assert!(candle.x > 2.0 * candle.y && candle.y > 3.0 * candle.z, "{candle}");
        assert!((candle.dot(LUMINANCE) - 1.0).abs() < 1e-12);
    }
}
