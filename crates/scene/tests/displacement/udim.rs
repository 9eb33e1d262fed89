//! UDIM tiles: their names, their borders, and those that are missing.
use crate::common::{QUAD, TempDir, mesh, refusal, tempdir, without_warning, write_scalar};
use planish_scene::Mesh;
use planish_scene::displacement::{DisplacementRequest, NO_TILE, TileLayout, load_displacement, used_tiles};

/// A quad over the unit squares from (0, 0) to (u, v).
fn quad_to(u: f32, v: f32) -> Mesh {
    mesh(
        &QUAD
            .replace("vt 1 0", &format!("vt {u} 0"))
            .replace("vt 1 1", &format!("vt {u} {v}"))
            .replace("vt 0 1", &format!("vt 0 {v}")),
    )
}

/// Tiles 1001 and 1012 of different sizes, and files that are none.
fn tiles() -> TempDir {
    let folder = tempdir().unwrap();
    write_scalar(&folder.path().join("a.1001.exr"), (2, 1), vec![1.0, 2.0]);
    write_scalar(&folder.path().join("a.1012.exr"), (1, 1), vec![5.0]);
    std::fs::write(folder.path().join("a.101.exr"), "no tile").unwrap();
    std::fs::write(folder.path().join("b.1002.exr"), "another map").unwrap();
    folder
}

#[test]
fn every_tile_that_exists_is_loaded_and_found_by_its_column_and_row() {
    let folder = tiles();
    let request = DisplacementRequest::new(folder.path().join("a.<UDIM>.exr"));
    let map = without_warning(load_displacement(&request, &quad_to(1.0, 1.0)).unwrap());
    assert_eq!((map.layout, map.tile_columns, map.tiles.len()), (TileLayout::Udim, 10, 2));
    let mut expected = vec![NO_TILE; 20];
    (expected[0], expected[11]) = (0, 1);
    assert_eq!(map.tile_of, expected);
    let at = |u, v| map.sample([u, v], 0.0)[0];
    assert_eq!([at(0.25, 0.5), at(0.5, 0.5), at(0.75, 0.5)], [1.0, 1.5, 2.0]);
    assert_eq!([at(0.0, 0.5), at(1.0, 0.5)], [1.0, 2.0], "tiles do not repeat");
    assert_eq!([at(1.5, 1.5), at(1.0, 1.5), at(1.0, 1.0)], [5.0; 3], "a border is the latter tile's");
    assert_eq!([at(1.5, 0.5), at(-0.5, 0.5), at(0.5, 2.5), at(11.5, 0.5)], [0.0; 4], "no tile, no displacement");
}

#[test]
fn uvtile_names_are_tiles_too() {
    let folder = tempdir().unwrap();
    write_scalar(&folder.path().join("a_u2_v1.exr"), (1, 1), vec![3.0]);
    write_scalar(&folder.path().join("a_u1_v1.exr"), (1, 1), vec![2.0]);
    let request = DisplacementRequest::new(folder.path().join("a_<UVTILE>.exr"));
    let map = without_warning(load_displacement(&request, &quad_to(2.0, 1.0)).unwrap());
    assert_eq!([map.sample([0.5, 0.5], 0.0)[0], map.sample([1.5, 0.5], 0.0)[0]], [2.0, 3.0]);
}

#[test]
fn tiles_that_uvs_use_but_have_no_file_are_refused_by_name() {
    let folder = tiles();
    let request = DisplacementRequest::new(folder.path().join("a.<UDIM>.exr"));
    let told = refusal(&request, &quad_to(1.5, 0.5));
    assert_eq!(told, "no file for tile 1002, which UV (1.5, 0.5) uses, expected a.1002.exr");
    let told = refusal(&request, &quad_to(-0.5, 0.5));
    assert_eq!(told, "UV (-0.5, 0.5), which is in no tile, expected u from 0 to 10 and v from 0 to 900");
    let none = DisplacementRequest::new(folder.path().join("c.<UDIM>.exr"));
    assert!(refusal(&none, &quad_to(1.0, 1.0)).starts_with("no file of any tile, expected files such as "));
    let nowhere = DisplacementRequest::new(folder.path().join("none/c.<UDIM>.exr"));
    assert!(refusal(&nowhere, &quad_to(1.0, 1.0)).starts_with("no folder that can be read "));
}

#[test]
fn a_tile_that_cannot_be_read_is_named() {
    let folder = tiles();
    let request = DisplacementRequest::new(folder.path().join("b.<UDIM>.exr"));
    let message = load_displacement(&request, &quad_to(1.0, 1.0)).unwrap_err().to_string();
    // The UVs are refused first: tile 1001 has no file.
    assert!(message.contains("no file for tile 1001"), "{message}");
    std::fs::write(folder.path().join("a.1003.exr"), "text").unwrap();
    let request = DisplacementRequest::new(folder.path().join("a.<UDIM>.exr"));
    let message = load_displacement(&request, &quad_to(1.0, 1.0)).unwrap_err().to_string();
    assert!(message.contains("a.1003.exr: found no OpenEXR image that can be decoded"), "{message}");
}

#[test]
fn used_tiles_are_few_whatever_the_number_of_uvs() {
    let values = (0..100_000).map(|i| [(i % 1000) as f32 / 500.0, 0.25]);
    assert_eq!(used_tiles(values).len(), 4);
}
