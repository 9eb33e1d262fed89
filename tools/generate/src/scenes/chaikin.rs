//! Creases by Chaikin's rule.
use super::SceneFile;
use super::parts::{creased_rim, sheet, stars};
use crate::cage::Cage;
use crate::tags::INFINITE;

pub fn files() -> Vec<SceneFile> {
    let file = |name: &str, what: &str, cage: Cage| {
        SceneFile::new(format!("chaikin_{name}"), format!("Chaikin's rule: {what}."), cage.with_chaikin())
    };
    let along = |sharpness: &[f64]| {
        let polyline: Vec<[f64; 2]> = (0..).zip(0..=sharpness.len()).map(|(i, _)| [f64::from(i) - 3.0, 0.0]).collect();
        polyline.windows(2).zip(sharpness).fold(sheet(), |cage, (edge, &sharpness)| cage.creased_above(edge, sharpness))
    };
    vec![
        file("2_3", "a block whose upper rim has sharpness 2.3", creased_rim(&[2.3])),
        file(
            "uneven",
            "a block with another sharpness for every edge of its upper rim",
            creased_rim(&[0.3, 2.3, 5.0, 1.5, 9.9, 0.7, 3.4, 1.0, 7.8, 2.0, 0.1, 4.2]),
        ),
        file(
            "mixed_infinite",
            "a block whose upper rim is semi-sharp and infinitely sharp in turn",
            creased_rim(&[2.3, INFINITE, 1.5, 3.7, INFINITE]),
        ),
        file("crossing", "four semi-sharp creases meet at valence 4 and 5", stars(&[4, 5], &[0.3, 1.5, 3.7, 2.3])),
        file("crossing_3", "three semi-sharp creases meet at valence 3, 4 and 5", stars(&[3, 4, 5], &[1.5, 2.3, 0.3])),
        file(
            "crossing_infinite",
            "semi-sharp creases meet an infinitely sharp one",
            stars(&[4, 3, 5], &[INFINITE, 2.3, 1.5]),
        ),
        file("dart", "a crease that fades out inside a sheet", along(&[9.9, 6.0, 3.7, 1.5, 0.3])),
        file("boundary", "an uneven crease from boundary to boundary", along(&[1.5, 2.3, 0.3, INFINITE, 3.7, 1.0])),
    ]
}
