//! Faces that are not drawn.
use super::SceneFile;
use super::parts::{creased_rim, disc_center, discs, sheet};
use crate::sectors;
use crate::tags::INFINITE;

pub fn files() -> Vec<SceneFile> {
    let at = |points: &[[f64; 2]]| {
        let cage = sheet();
        let faces: Vec<u32> = points.iter().map(|&[x, z]| cage.face_above(x, z)).collect();
        cage.with_holes(&faces)
    };
    let extraordinary = discs(&[3, 5]);
    let beside = [0, 1].map(|place| extraordinary.face_above(disc_center(place) + 0.4, 0.4));
    let ngon = sectors::ngon(5);
    let pieces = sectors::ngon(6);
    vec![
        SceneFile::new(
            "hole_interior",
            "Holes inside a sheet: a single one, two side by side, two corner to corner.",
            at(&[[-1.5, -1.5], [1.5, -1.5], [1.5, -0.5], [-0.5, 0.5], [0.5, 1.5]]),
        ),
        SceneFile::new(
            "hole_boundary",
            "Holes at a sheet's boundary and in its corner.",
            at(&[[-2.5, 0.5], [2.5, 2.5], [0.5, -2.5], [1.5, -2.5]]),
        ),
        SceneFile::new("hole_ngon", "A face of five sides is a hole.", ngon.with_holes(&[0])),
        SceneFile::new("hole_beside_ngon", "Holes beside a face of six sides.", pieces.with_holes(&[1, 4, 5])),
        SceneFile::new(
            "hole_extraordinary",
            "Holes at vertices of valence 3 and 5.",
            extraordinary.with_holes(&beside),
        ),
        SceneFile::new(
            "hole_creased",
            "Holes beside creases of sharpness 2.3 and infinite, and one with a sharp vertex.",
            at(&[[-1.5, 0.5], [-0.5, -0.5], [1.5, -1.5], [1.5, 1.5]])
                .creased_above(&[[-2.0, 0.0], [-1.0, 0.0], [0.0, 0.0]], 2.3)
                .creased_above(&[[1.0, -3.0], [1.0, -2.0], [1.0, -1.0], [1.0, 0.0]], INFINITE)
                .cornered_above(2.0, 2.0, 1.5),
        ),
        SceneFile::new(
            "hole_closed",
            "A block with a creased rim, two faces of which are holes.",
            creased_rim(&[1.5]).with_holes(&[0, 17]),
        ),
    ]
}
