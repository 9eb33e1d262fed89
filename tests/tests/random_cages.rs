//! Random cages: what `planish dump` writes of them is OpenSubdiv's limit surface.
//!
//! A cage that fails is written by `planish-generate random --seed SEED --features BITS --operations COUNT -o FILE`.

use std::fs;

use planish_generate::random_cage::{Features, Recipe};
use planish_tests::cage::Cage;
use planish_tests::oracle::Report;
use planish_tests::parallel::check_all;
use planish_tests::ply::Dump;
use planish_tests::program::Planish;

/// What the cages may have.
const FEATURES: Features = Features::ALL;
/// Seeds of cages that may have any of them.
const SEEDS: std::ops::Range<u64> = 1000..1040;
/// Seeds of manifold cages, whose tags reach farther.
const MANIFOLD_SEEDS: std::ops::Range<u64> = 2000..2040;
/// Flags by turns.
const FLAGS: [&str; 8] = [
    "--tess 4",
    "--edge-pixels 4 --size 96x54 --fov 20",
    "--edge-pixels 2 --size 96x54 --spacing fractional-even --crease-patches single",
    "--edge-pixels 9 --size 160x90 --spacing equal --eye 0.1,0.2,0.3 --target 1,1,0",
    "--tess 7.3 --crease-patches single",
    "--tess 2.5 --spacing fractional-even",
    "--tess 5 --spacing equal --crease-patches none",
    "--tess 1",
];

fn recipe(seed: u64, features: Features) -> Recipe {
    Recipe { seed, features, operation_count: (seed % 30) as u32 }
}

fn check(recipe: Recipe) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let [mesh, dump] = ["random.obj", "dump.ply"].map(|name| folder.path().join(name));
    fs::write(&mesh, recipe.cage().to_obj("A random cage.")).expect("a temporary file can be written");
    let flags = FLAGS[(recipe.seed % FLAGS.len() as u64) as usize];
    let outcome = Planish::dump(&mesh, &dump).flags(flags).run().silent_success()?;
    let told = |fault: &str| Err(outcome.told(&format!("{recipe:?}: {fault}")));
    if !Cage::read(&mesh).drawn_faces().contains(&true) {
        let count = Dump::read(&dump)?.vertices().len();
        return if count == 0 { Ok(()) } else { told(&format!("{count} vertices where nothing is drawn")) };
    }
    // Faces may lie upon each other or be slivers.
    let faults = Report::of(&mesh, &dump)?.faults_but_degenerate_normals(0);
    if faults.is_empty() { Ok(()) } else { told(&faults.join("\n  ")) }
}

#[test]
fn dumps_of_random_cages_are_the_limit_surface() {
    let any = SEEDS.map(|seed| recipe(seed, FEATURES));
    let manifold = MANIFOLD_SEEDS.map(|seed| recipe(seed, FEATURES.without(Features::NONMANIFOLD)));
    check_all(&any.chain(manifold).collect::<Vec<_>>(), |&recipe| check(recipe));
}
