//! The glTF scene has all that it is said to show, and moves as a plant does.
use planish_generate::scenes::gltf;
use planish_scene::{LightKind, LoadOptions, Scene, read_gltf};

fn scenes() -> [Scene; 2] {
    let (_, text) = gltf().remove(0);
    let read = |name: &str, bytes: &[u8]| read_gltf(name, bytes, &LoadOptions::default()).unwrap();
    [read("sprout.gltf", text.to_gltf().as_bytes()), read("sprout.glb", &text.to_glb())]
}

#[test]
fn both_forms_are_one_scene_without_a_warning() {
    let [json, binary] = scenes();
    assert_eq!(json.warnings, []);
    assert!(json == binary);
}

#[test]
fn it_shows_every_feature() {
    let [scene, _] = scenes();
    let mesh = |name: &str| scene.meshes.iter().find(|mesh| mesh.name == name).unwrap();
    let deformation = mesh("sprout").deformation.as_ref().unwrap();
    assert_eq!(deformation.morphs.iter().map(|morph| morph.name.as_str()).collect::<Vec<_>>(), ["puff", "stretch"]);
    assert_eq!(deformation.skin.as_ref().unwrap().joints.len(), 5);
    assert_eq!(scene.instances.iter().filter(|instance| scene.meshes[instance.mesh].name == "leaf").count(), 2);
    assert_eq!(
        (mesh("pot").slots.as_slice(), scene.textures.len()),
        (["pot".to_owned(), "earth".to_owned()].as_slice(), 3)
    );
    // Twelve quads between every two of nine rings and two of the earth, and two polygons; all of one piece.
    let pot = &mesh("pot").control_mesh;
    assert_eq!((pot.face_sizes.len(), pot.positions.len()), (9 * 12 + 2, 10 * 12));
    assert_eq!(pot.face_sizes.iter().filter(|&&size| size == 12).count(), 2);
    assert_eq!((pot.creases.len(), mesh("leaf").control_mesh.creases.len()), (6 * 12, 6));
    assert!(matches!(scene.lights[..], [ref sun, ref lamp] if sun.kind == LightKind::Distant { angle: 0.0 }
        && matches!(lamp.kind, LightKind::Spot { .. })));
    assert_eq!((scene.clips.as_slice(), scene.time_range), (["sway".to_owned()].as_slice(), Some([0.0, 2.0])));
    assert_eq!(scene.camera(Some("front")).unwrap().name, "front");
}

#[test]
fn it_stays_in_its_pot_and_returns_to_where_it_began() {
    let [scene, _] = scenes();
    let sprout = scene.meshes.iter().position(|mesh| mesh.name == "sprout").unwrap();
    let at = |time: f64| scene.posed_positions(sprout, &scene.pose(time));
    let rest = &scene.meshes[sprout].control_mesh.positions;
    let (mut farthest, first) = (0.0f32, at(0.0));
    for frame in 0..=48 {
        for (position, rest) in at(f64::from(frame) / 24.0).into_iter().zip(rest) {
            let moved = (0..3).map(|c| (position[c] - rest[c]).powi(2)).sum::<f32>().sqrt();
            farthest = farthest.max(moved);
            assert!(rest[1] > 0.62 || moved < 1e-5, "the foot moves by {moved}");
        }
    }
    assert!((0.2..0.9).contains(&farthest), "{farthest}");
    let gap = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
    assert!(first.iter().zip(&at(2.0)).all(|(a, b)| gap(a, b) < 1e-4));
}
