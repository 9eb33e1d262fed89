//! Random cages are what their recipes say, and show all that they may.
use planish_generate::cage::Cage;
use planish_generate::random_cage::manifold::{has_no_valence_2, has_slit_fan, is_manifold};
use planish_generate::random_cage::{Features, MAX_FACES, Recipe};

/// Seeds that are tried.
const SEEDS: u64 = 1000;

fn recipe(seed: u64, features: Features) -> Recipe {
    Recipe { seed, features, operation_count: (seed % 30) as u32 }
}

fn cages(features: Features) -> impl Iterator<Item = (u64, Cage)> {
    (0..SEEDS).map(move |seed| (seed, recipe(seed, features).cage()))
}

/// The words of the tags of a kind.
fn tags<'a>(cage: &'a Cage, name: &'a str) -> impl Iterator<Item = Vec<&'a str>> {
    let words = cage.tags.iter().map(|tag| tag.split_whitespace().collect::<Vec<_>>());
    words.filter(move |words| words[1] == name)
}

#[test]
fn faces_have_three_different_vertices_and_there_are_not_too_many() {
    let mut largest = 0;
    for (seed, cage) in cages(Features::ALL) {
        largest = largest.max(cage.faces.len());
        assert!((1..=MAX_FACES).contains(&cage.faces.len()), "seed {seed}");
        for face in &cage.faces {
            let mut sorted = face.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert!(sorted.len() == face.len() && face.len() >= 3, "seed {seed}: {face:?}");
            assert!(face.iter().all(|&vertex| (vertex as usize) < cage.positions.len()), "seed {seed}: {face:?}");
        }
    }
    assert!(largest > MAX_FACES / 2, "{largest}");
}

#[test]
fn every_cage_is_read_without_a_warning() {
    for (seed, cage) in cages(Features::ALL) {
        let options = planish_scene::LoadOptions::default();
        let scene = planish_scene::read_obj("random.obj", cage.to_obj("Random.").as_bytes(), &options).unwrap();
        assert_eq!(scene.warnings, [], "seed {seed}");
        scene.meshes[0].control_mesh.validate().unwrap();
    }
}

#[test]
fn what_is_not_allowed_is_not_there() {
    for (seed, cage) in cages(Features::PLAIN) {
        assert!(is_manifold(&cage.faces) && has_no_valence_2(&cage.faces), "seed {seed}");
        assert!(cage.faces.iter().all(|face| face.len() == 4) && cage.tags.is_empty(), "seed {seed}");
    }
    for (seed, cage) in cages(Features::ALL.without(Features::NONMANIFOLD)) {
        assert!(is_manifold(&cage.faces), "seed {seed}");
    }
}

#[test]
fn what_is_allowed_is_often_there() {
    let all: Vec<Cage> = cages(Features::ALL).map(|(_, cage)| cage).collect();
    let often = |what: &str, is_there: &dyn Fn(&Cage) -> bool| {
        let count = all.iter().filter(|cage| is_there(cage)).count() as u64;
        assert!(count > SEEDS / 20, "{what}: {count}");
    };
    often("non-manifold", &|cage| !is_manifold(&cage.faces));
    often("manifold", &|cage| is_manifold(&cage.faces));
    let slits = all.iter().filter(|cage| has_slit_fan(&cage.faces)).count();
    assert!(slits > 10, "{slits}");
    often("n-gons", &|cage| cage.faces.iter().any(|face| face.len() > 4));
    often("valence 2", &|cage| !has_no_valence_2(&cage.faces));
    for name in ["crease", "corner", "hole", "interpolateboundary", "creasemethod", "smoothtriangles"] {
        often(name, &|cage| tags(cage, name).next().is_some());
    }
    for sharpness in ["0.3", "2", "2.3", "9.9", "10"] {
        often(sharpness, &|cage| tags(cage, "crease").any(|words| words.last() == Some(&sharpness)));
    }
}

#[test]
fn tags_leave_the_faces_as_they_are() {
    let with = Features::ALL;
    let without = Features::N_GONS.with(Features::NONMANIFOLD).with(Features::VALENCE_2).with(Features::SLIT_FANS);
    for ((_, tagged), (seed, plain)) in cages(with).zip(cages(without)) {
        assert_eq!((tagged.faces, tagged.positions), (plain.faces, plain.positions), "seed {seed}");
        assert_eq!(plain.tags, Vec::<String>::new(), "seed {seed}");
    }
}
