//! Colours of vertices, by both interpolations.
use glam::DVec3;

use super::SceneFile;
use crate::solids;
use crate::tags::INFINITE;

/// Steps around the circle of hues for a unit along the axis: colours of neighbours differ.
const HUES: [f64; 3] = [0.31, 0.47, 0.19];

pub fn files() -> Vec<SceneFile> {
    let ring: Vec<u32> = (0..=7).map(|i| 14 + i % 7).collect();
    let mesh = || solids::rocket().creased(&ring, INFINITE).colored(hue);
    let mut varying = mesh();
    varying.tag("colorinterpolation", &[1], &[], &[]);
    vec![
        SceneFile::new("color_vertex", "Colours that are subdivided, across triangles, quads and a crease.", mesh()),
        SceneFile::new("color_varying", "Colours that are bilinear in each Ptex face of triangles and quads.", varying),
    ]
}

/// A colour of full strength for a position.
fn hue(position: DVec3) -> DVec3 {
    let turns = DVec3::from(HUES).dot(position);
    DVec3::new(0.0, 1.0, 2.0).map(|part| 0.5 + 0.5 * ((turns + part / 3.0) * std::f64::consts::TAU).cos())
}
