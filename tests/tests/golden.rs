//! Images look as they did: the hero, and small meshes in every view.
//!
//! `PLANISH_UPDATE_GOLDEN=1 cargo test --release -p planish-tests --test golden` replaces the committed images. Look at
//! them before they are committed.

use std::fs;
use std::path::Path;

use planish_tests::folder::temporary;
use planish_tests::golden::{MEAN_TOLERANCE, check, mean_error, path, read};
use planish_tests::program::Planish;
use planish_tests::repository::scene;

/// Every view that a beauty image can show.
const VIEWS: [&str; 8] = ["shaded", "normal", "patch", "level", "tess", "uv", "color", "wire"];
/// How the hero is to be seen; `tools/run` has the same camera.
const HERO_FLAGS: &str = "--size 320x180 --samples 16 --eye 4.3,3.7,5.4 --target 0.25,1.1,0.35 --fov 32";
/// Triangles, quads, a boundary, extraordinary vertices inside and on the boundary.
const SMALL_MESH: &str = "mixed_triangles_quads";
/// As small, and with colours.
const COLORED_MESH: &str = "color_vertex";
/// Of the images of the small mesh.
const SMALL_FLAGS: &str = "--size 112x192 --samples 16";

/// Tess factor of a view's image: one at which levels and factors vary, and one at which there are pixels between lines.
fn tess(view: &str) -> &'static str {
    if view == "wire" { "--tess 2.5" } else { "--tess 6" }
}

fn image_of(mesh: &Path, flags: &str, folder: &Path) -> std::path::PathBuf {
    let image = folder.join("image.png");
    Planish::render(mesh, &image).flags(flags).run().silent_success().unwrap();
    image
}

#[test]
fn the_hero_looks_as_it_did() {
    let folder = temporary();
    check("hero", &image_of(&scene("hero"), HERO_FLAGS, folder.path())).unwrap();
}

#[test]
fn every_view_looks_as_it_did() {
    let folder = temporary();
    for view in VIEWS {
        let image = image_of(
            &scene(if view == "color" { COLORED_MESH } else { SMALL_MESH }),
            &format!("{SMALL_FLAGS} --fov 40 {} --view {view}", tess(view)),
            folder.path(),
        );
        check(&format!("view_{view}"), &image).unwrap();
    }
}

#[test]
fn gregory_patches_look_as_they_did() {
    let folder = temporary();
    let flags = format!("{SMALL_FLAGS} --fov 40 --method gregory --view patch");
    check("gregory_patch", &image_of(&scene(SMALL_MESH), &flags, folder.path())).unwrap();
}

#[test]
fn images_that_look_different_are_told_apart() {
    for (index, one) in VIEWS.iter().enumerate() {
        for other in &VIEWS[..index] {
            let [one, other] = [one, other].map(|view| read(&path(&format!("view_{view}"))).unwrap());
            assert!(mean_error(&one, &other).unwrap() > MEAN_TOLERANCE);
        }
    }
    let folder = temporary();
    let turned = image_of(&scene(SMALL_MESH), &format!("{SMALL_FLAGS} {} --fov 38", tess("shaded")), folder.path());
    assert!(mean_error(&read(&path("view_shaded")).unwrap(), &read(&turned).unwrap()).unwrap() > MEAN_TOLERANCE);
}

#[test]
fn golden_images_are_few_and_small() {
    /// Bytes of one.
    const MAX_BYTES: u64 = 100_000;
    let images: Vec<_> = fs::read_dir(path("hero").parent().unwrap()).unwrap().map(|entry| entry.unwrap()).collect();
    assert_eq!(images.len(), VIEWS.len() + 2, "an image that no test compares");
    for image in images {
        assert!(image.metadata().unwrap().len() <= MAX_BYTES, "{}", image.path().display());
    }
}
