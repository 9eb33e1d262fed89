//! Tables from a cache are the built ones, bit for bit, whatever the cache holds.

use std::cell::RefCell;
use std::collections::HashMap;

use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::{BoundaryInterpolation, Creasing, TriangleSubdivision};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisCache, BasisCounts, BasisOptions, Tables};

use super::options;
use crate::cages::{mesh, pole, sharpened, sheet};

/// What becomes of a content.
type Spoil = dyn Fn(&mut Vec<u8>);

/// Contents in memory, which may be spoilt on their way out.
#[derive(Default)]
struct Shelf {
    contents: RefCell<HashMap<Vec<u8>, Vec<u8>>>,
    spoil: Option<Box<Spoil>>,
}

impl BasisCache for Shelf {
    fn load(&self, key: &[u8]) -> Option<Vec<u8>> {
        let mut content = self.contents.borrow().get(key)?.clone();
        if let Some(spoil) = &self.spoil {
            spoil(&mut content);
        }
        Some(content)
    }

    fn store(&self, key: &[u8], content: &[u8]) {
        self.contents.borrow_mut().insert(key.to_vec(), content.to_vec());
    }
}

/// Closed cages and open ones.
fn cages(scheme: Scheme) -> Vec<ControlMesh> {
    let octahedron = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let open = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 5, 2], [2, 5, 3]];
    // Tables know nothing of positions.
    let of = |faces: &[[u32; 3]]| mesh(vec![[0.0; 3]; 6], &faces.iter().map(|face| face.to_vec()).collect::<Vec<_>>());
    let mut cages = vec![of(&octahedron), of(&open)];
    if scheme == Scheme::CatmullClark {
        cages.extend([sheet(3, 2), pole(5, 2)]);
    }
    cages
}

/// A cage by all that its tables depend on.
fn variants(cage: &ControlMesh) -> Vec<ControlMesh> {
    let with = |change: &dyn Fn(&mut ControlMesh)| {
        let mut other = cage.clone();
        change(&mut other);
        other
    };
    let creased = sharpened(cage.clone(), Creasing::Uniform);
    let mut softer = creased.clone();
    softer.creases.iter_mut().for_each(|crease| crease.sharpness *= 0.75);
    let mut all = vec![
        cage.clone(),
        with(&|other| other.options.triangles = TriangleSubdivision::Smooth),
        with(&|other| other.options.boundary = BoundaryInterpolation::EdgeOnly),
        with(&|other| other.options.creasing = Creasing::Chaikin),
        sharpened(cage.clone(), Creasing::Chaikin),
        creased,
        softer,
    ];
    // By the last bit.
    let mut sharper = all[5].clone();
    sharper.creases.iter_mut().for_each(|crease| crease.sharpness = crease.sharpness.next_up());
    all.push(sharper);
    all
}

fn settings() -> Vec<BasisOptions> {
    let levels = |scheme| [0, 1, 2].map(|level| options(scheme, level)).to_vec();
    let mut settings: Vec<BasisOptions> = Scheme::ALL.into_iter().flat_map(levels).collect();
    settings.push(BasisOptions { steps: 2, level: 1, ..options(Scheme::CatmullClark, 1) });
    settings.push(BasisOptions { steps: 2, level: 1, ..options(Scheme::Loop, 1) });
    settings
}

fn bits(tables: &Tables) -> Vec<u32> {
    let basis = &tables.basis;
    let weights = basis.weights.iter().chain(basis.tangents.as_flattened()).chain(tables.limits.weights.as_flattened());
    weights.map(|weight| weight.to_bits()).collect()
}

fn assert_equal(found: &Tables, expected: &Tables) {
    assert_eq!(found.basis, expected.basis);
    assert_eq!((&found.limits.rows, &found.limits.indices), (&expected.limits.rows, &expected.limits.indices));
    assert_eq!(bits(found), bits(expected));
}

#[test]
fn one_cache_for_all_schemes_levels_rules_and_sharpness_gives_the_built_bits() {
    let shelf = Shelf::default();
    let (mut read, mut built) = (0, 0);
    for options in settings() {
        for cage in cages(options.scheme).iter().flat_map(variants) {
            let expected = Tables::of_basis(&cage, &options).expect("tables");
            let (first, counts) = Tables::of_basis_cached(&cage, &options, &shelf).expect("tables");
            assert_equal(&first, &expected);
            (read, built) = (read + counts.read, built + counts.built);
            let (again, counts_again) = Tables::of_basis_cached(&cage, &options, &shelf).expect("tables");
            assert_equal(&again, &expected);
            assert_eq!(counts_again, BasisCounts { read: counts.read + counts.built, built: 0 });
        }
    }
    assert_eq!(built, shelf.contents.borrow().len() as u64);
    assert!(built > 500 && read > 500, "{built} built, {read} read");
}

#[test]
fn a_content_cut_off_or_too_long_is_built_again() {
    let cage = &cages(Scheme::Loop)[1];
    let options = options(Scheme::Loop, 1);
    let (expected, made) = Tables::of_basis_cached(cage, &options, &Shelf::default()).expect("tables");
    let mut shelf = Shelf::default();
    Tables::of_basis_cached(cage, &options, &shelf).expect("tables");
    let lengths: Vec<usize> = shelf.contents.borrow().values().map(Vec::len).collect();
    let longest = lengths.iter().copied().max().unwrap();
    for length in (0..longest).chain([longest + 1, longest + 4]) {
        shelf.spoil = Some(Box::new(move |content| {
            let is_longer = length > longest;
            if is_longer || length < content.len() {
                content.resize(if is_longer { content.len() + length - longest } else { length }, 0);
            }
        }));
        let (found, counts) = Tables::of_basis_cached(cage, &options, &shelf).expect("tables");
        assert_equal(&found, &expected);
        assert_eq!(counts.read + counts.built, made.built);
        let spoilt = lengths.iter().filter(|&&whole| length > longest || length < whole).count();
        assert_eq!(counts.built, spoilt as u64, "{length} bytes");
    }
}

#[test]
fn controls_that_are_not_the_walk_s_are_built_again() {
    let cage = &cages(Scheme::Loop)[0];
    let options = options(Scheme::Loop, 0);
    let mut shelf = Shelf::default();
    let expected = Tables::of_basis_cached(cage, &options, &shelf).expect("tables").0;
    // The count and the first controls: what indices into points are made of.
    for at in 0..32 {
        for bit in 0..8 {
            shelf.spoil = Some(Box::new(move |content| content[at] ^= 1 << bit));
            let found = Tables::of_basis_cached(cage, &options, &shelf).expect("tables").0;
            let points = found.point_count();
            assert!(found.basis.controls.iter().all(|&control| control < points));
            assert_eq!(found.basis.weights.len(), found.basis.tangents.len());
            assert_eq!(found.basis.patches.len(), expected.basis.patches.len());
        }
    }
}
