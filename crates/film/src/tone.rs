//! Scene-linear light to what a display shows.

use std::str::FromStr;

type Color = [f32; 3];

/// How scene-linear light becomes display-linear light, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// What is beyond 0 to 1 is cut off, channel by channel.
    #[default]
    Clip,
    /// Khronos PBR Neutral: colours up to 0.8 minus a little stay what they are, brighter ones are compressed and lose
    /// saturation. For materials whose colour is to be seen. After "Khronos PBR Neutral Tone Mapper Specification",
    /// 2024.
    Neutral,
    /// Stephen Hill's fit of ACES (RRT and sRGB's ODT, version 1.0): a filmic curve with toe and shoulder in ACES's
    /// working space. For scenes with light.
    Aces,
}

impl ToneMap {
    /// The names that [`ToneMap::from_str`] knows.
    pub const NAMES: &str = "clip, neutral or aces";

    /// Not clamped: what follows does it.
    pub(crate) fn map(self, color: Color) -> Color {
        match self {
            ToneMap::Clip => color,
            ToneMap::Neutral => neutral(finite(color)),
            ToneMap::Aces => aces(finite(color)),
        }
    }
}

impl FromStr for ToneMap {
    type Err = String;

    /// In any case.
    fn from_str(text: &str) -> Result<Self, String> {
        match text.to_lowercase().as_str() {
            "clip" => Ok(ToneMap::Clip),
            "neutral" => Ok(ToneMap::Neutral),
            "aces" => Ok(ToneMap::Aces),
            _ => Err(format!("found {text}, expected {}", Self::NAMES)),
        }
    }
}

/// What curves can be computed of: without light that is not there, infinite or not a number.
fn finite(color: Color) -> Color {
    /// Far beyond the shoulder of any curve, with room for its square.
    const BRIGHTEST: f32 = 1e9;
    color.map(|value| if value > 0.0 { value.min(BRIGHTEST) } else { 0.0 })
}

/// The specification's function, with its names.
fn neutral(color: Color) -> Color {
    /// Reflectance of a dielectric at normal incidence, which every colour loses, so that a base colour in white light
    /// comes out as it is.
    const FRESNEL: f32 = 0.04;
    const START_COMPRESSION: f32 = 0.8 - FRESNEL;
    const DESATURATION: f32 = 0.15;
    let least = color[0].min(color[1]).min(color[2]);
    let offset = if least < 2.0 * FRESNEL { least - least * least / (4.0 * FRESNEL) } else { FRESNEL };
    let color = color.map(|value| value - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < START_COMPRESSION {
        return color;
    }
    let range = 1.0 - START_COMPRESSION;
    let new_peak = 1.0 - range * range / (peak + range - START_COMPRESSION);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    color.map(|value| value * new_peak / peak * (1.0 - white) + new_peak * white)
}

/// sRGB to XYZ, D65 to D60, to AP1, and saturation of the RRT.
const ACES_INPUT: [Color; 3] = [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];

/// Saturation of the ODT, to XYZ, D60 to D65, to sRGB.
const ACES_OUTPUT: [Color; 3] =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

fn aces(color: Color) -> Color {
    let curve = |v: f32| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
    apply(&ACES_OUTPUT, apply(&ACES_INPUT, color).map(curve))
}

fn apply(matrix: &[Color; 3], color: Color) -> Color {
    matrix.map(|row| row[0] * color[0] + row[1] * color[1] + row[2] * color[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [ToneMap; 2] = [ToneMap::Neutral, ToneMap::Aces];

    #[test]
    fn grey_rises_from_black_to_white_and_stays_grey() {
        for curve in CURVES {
            let mut last = -0.01;
            for step in 0..4000 {
                let [r, g, b] = curve.map([step as f32 / 100.0; 3]);
                assert!((r - g).abs() < 1e-4 && (g - b).abs() < 1e-4, "{curve:?} {step}: {r} {g} {b}");
                assert!(r >= last - 1e-6 && r < 1.02, "{curve:?} {step}: {r} after {last}");
                last = r;
            }
            assert!(last > 0.97, "{curve:?}: {last}");
        }
    }

    #[test]
    fn neutral_keeps_base_colours_in_white_light() {
        // A material reflects its base colour and 4 % at its surface.
        for base in [[0.5, 0.2, 0.1], [0.75, 0.75, 0.04], [0.1, 0.1, 0.1]] {
            let mapped = ToneMap::Neutral.map(base.map(|value| value + 0.04));
            for (found, expected) in mapped.into_iter().zip(base) {
                assert!((found - expected).abs() < 1e-6, "{mapped:?} for {base:?}");
            }
        }
    }

    #[test]
    fn neutral_compresses_by_the_specification_s_formula() {
        // Peak 2 - 0.04: 1 - 0.24^2 / (1.96 - 0.76 + 0.24) = 0.96, and grey has no saturation to lose.
        let [r, _, _] = ToneMap::Neutral.map([2.0; 3]);
        assert!((r - 0.96).abs() < 1e-6, "{r}");
    }

    #[test]
    fn neutral_takes_saturation_from_bright_colours() {
        // Step by step: 0.04 less, peak 3.96 to 1 - 0.24^2 / 3.44 = 0.983256, then 1 - 1 / 1.446512 = 0.308682 of it.
        let mapped = ToneMap::Neutral.map([4.0, 1.0, 0.1]);
        for (found, expected) in mapped.into_iter().zip([0.983_256, 0.468_299, 0.313_812]) {
            assert!((found - expected).abs() < 1e-5, "{mapped:?}");
        }
    }

    #[test]
    fn aces_maps_middle_grey_and_white_as_its_fit_does() {
        // Rows of both matrices sum to 1, so that grey takes the curve alone.
        let curve = |v: f64| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
        for grey in [0.18, 1.0, 16.0] {
            let [_, g, _] = ToneMap::Aces.map([grey as f32; 3]);
            assert!((f64::from(g) - curve(grey)).abs() < 1e-4, "{grey}: {g} for {}", curve(grey));
        }
    }

    /// Rec. 709 to AP1 and back, with Bradford's adaptation between D65 and D60.
    const TO_AP1: [[f64; 3]; 3] =
        [[0.613097, 0.339523, 0.047379], [0.070194, 0.916354, 0.013452], [0.020616, 0.109570, 0.869815]];
    const FROM_AP1: [[f64; 3]; 3] =
        [[1.704859, -0.621715, -0.083299], [-0.130078, 1.140734, -0.010560], [-0.023964, -0.128975, 1.153013]];

    /// Saturation as RRT (0.96) and ODT (0.93) of ACES 1.0 change it: towards AP1's luminance.
    fn saturation(factor: f64) -> [[f64; 3]; 3] {
        let luminance = [0.272229, 0.674082, 0.053689];
        [0, 1, 2].map(|row| [0, 1, 2].map(|k| (1.0 - factor) * luminance[k] + if row == k { factor } else { 0.0 }))
    }

    #[test]
    fn aces_matrices_are_the_products_that_they_stand_for() {
        let product = |a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]| {
            [0, 1, 2].map(|row| [0, 1, 2].map(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum::<f64>()))
        };
        let input = product(&saturation(0.96), &TO_AP1);
        let output = product(&FROM_AP1, &saturation(0.93));
        for (found, expected) in [(ACES_INPUT, input), (ACES_OUTPUT, output)] {
            for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                assert!((f64::from(*found) - expected).abs() < 5e-4, "{found} for {expected}");
            }
        }
    }

    #[test]
    fn what_is_no_light_becomes_a_number() {
        for curve in CURVES {
            for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e38] {
                let mapped = curve.map([value, 0.5, 0.0]);
                assert!(mapped.iter().all(|value| value.is_finite()), "{curve:?} {value}: {mapped:?}");
            }
        }
    }

    #[test]
    fn names_are_read_in_any_case_and_others_refused() {
        assert_eq!("ACES".parse(), Ok(ToneMap::Aces));
        assert_eq!("neutral".parse(), Ok(ToneMap::Neutral));
        assert_eq!("clip".parse(), Ok(ToneMap::Clip));
        assert_eq!("agx".parse::<ToneMap>(), Err("found agx, expected clip, neutral or aces".to_owned()));
    }
}
