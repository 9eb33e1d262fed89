//! Creases of different sharpness that meet.
use super::SceneFile;
use super::parts::{creased_rim, stars};
use crate::tags::INFINITE;

pub fn files() -> Vec<SceneFile> {
    let star = |name: &str, valences: &[u32], arms: &[f64]| {
        let text = |&sharpness: &f64| if sharpness == INFINITE { "infinite".to_owned() } else { sharpness.to_string() };
        let sharpness: Vec<String> = arms.iter().map(text).collect();
        let valences_text: Vec<String> = valences.iter().map(u32::to_string).collect();
        let comment =
            format!("Creases of sharpness {} meet at valence {}.", sharpness.join(", "), valences_text.join(", "));
        SceneFile::new(name, comment, stars(valences, arms))
    };
    vec![
        SceneFile::new(
            "crease_uneven",
            "A block with another sharpness for every edge of its upper rim.",
            creased_rim(&[0.3, 2.3, 5.0, 1.5, 9.9, 0.7, 3.4, 1.0, 7.8, 2.0, 0.1, 4.2]),
        ),
        star("crease_mixed_2", &[4, 3, 5], &[1.5, 2.3]),
        star("crease_mixed_2_far", &[4, 5], &[0.3, 7.8]),
        star("crease_mixed_3", &[4, 3, 5], &[0.3, 1.5, 2.3]),
        star("crease_mixed_4", &[4, 5], &[0.3, 1.5, 3.7, 2.3]),
        star("crease_mixed_infinite", &[4, 3, 5], &[1.5, 2.3, INFINITE]),
        star("crease_infinite_continued", &[4, 3, 5], &[INFINITE, 2.3]),
        star("crease_infinite_joined", &[4, 3, 5], &[INFINITE, 1.5, INFINITE]),
        star("crease_infinite_joined_by_two", &[4, 6], &[INFINITE, 2.3, INFINITE, 1.5]),
        star("crease_infinite_3_joined", &[4, 5], &[INFINITE, INFINITE, 2.3, INFINITE]),
        star("valence_2_creased", &[2], &[1.5, 2.3]),
        star("valence_2_infinite", &[2], &[INFINITE, INFINITE]),
    ]
}
