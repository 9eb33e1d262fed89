//! Cryptomattes of a frame, from the coverage of its samples.

use std::collections::BTreeMap;

use planish_film::Cryptomatte;
use planish_render::shading::IdCoverage;
use planish_scene::Scene;

use crate::image::Crop;

/// What surfaces without a material are of.
const NO_MATERIAL: &str = "none";

/// The names of a Cryptomatte, and which of them each id has: names are shared.
struct Names {
    names: Vec<String>,
    of_id: Vec<u32>,
}

impl Names {
    fn new<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let mut places = BTreeMap::new();
        let mut distinct = Vec::new();
        let place = |name: &'a str| {
            *places.entry(name).or_insert_with(|| {
                distinct.push(name.to_owned());
                distinct.len() as u32 - 1
            })
        };
        let of_id = names.into_iter().map(place).collect();
        Self { names: distinct, of_id }
    }
}

/// A Cryptomatte of a part of the image; `coverage` is of the whole one.
fn matte(name: &str, names: Names, coverage: &[Vec<IdCoverage>], crop: &Crop) -> Cryptomatte {
    let places: Vec<u32> = (0..coverage.len() as u32).collect();
    let places = crop.pixels(&places);
    let mut matte = Cryptomatte::new(name, names.names, places.len());
    for (pixel, place) in places.into_iter().enumerate() {
        for &IdCoverage { id, weight } in &coverage[place as usize] {
            matte.add(pixel, names.of_id[id as usize], weight);
        }
    }
    matte
}

/// Of instances.
pub fn object_matte(scene: &Scene, coverage: &[Vec<IdCoverage>], crop: &Crop) -> Cryptomatte {
    let names = scene.instances.iter().map(|instance| instance.name.as_str());
    matte("CryptoObject", Names::new(names), coverage, crop)
}

/// Of materials, whose ids count from 1; 0 is that of surfaces without one.
pub fn material_matte(scene: &Scene, coverage: &[Vec<IdCoverage>], crop: &Crop) -> Cryptomatte {
    let names = scene.materials.iter().map(|material| material.name.as_str());
    matte("CryptoMaterial", Names::new(std::iter::once(NO_MATERIAL).chain(names)), coverage, crop)
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;
    use planish_scene::Instance;

    use super::*;

    #[test]
    fn instances_of_one_name_are_one_matte_and_the_crop_s_pixels_are_kept() {
        let instance = |name: &str| Instance::placed(name, 0, Affine3A::IDENTITY);
        let scene = Scene { instances: vec![instance("a"), instance("b"), instance("a")], ..Scene::default() };
        let covered = |id, weight| IdCoverage { id, weight };
        let coverage = [vec![], vec![covered(0, 0.25), covered(2, 0.5), covered(1, 0.25)], vec![covered(1, 1.0)]];
        let crop = Crop::new(Some([1, 0, 1, 1]), [3, 1]).unwrap();
        let matte = object_matte(&scene, &coverage, &crop);
        assert_eq!(matte.names, ["a", "b"]);
        assert_eq!(matte.ranks[..2], [(0, 0.75), (1, 0.25)]);
        assert_eq!(matte.ranks.len(), matte.rank_count);
    }

    #[test]
    fn what_has_no_material_is_of_the_matte_none() {
        let coverage = [vec![IdCoverage { id: 0, weight: 1.0 }]];
        let matte = material_matte(&Scene::default(), &coverage, &Crop::new(None, [1, 1]).unwrap());
        assert_eq!((matte.names[0].as_str(), matte.ranks[0]), ("none", (0, 1.0)));
    }
}
