//! Scene files that the generator makes: they can be read, and show what they are said to show.
use std::path::Path;

use glam::{DVec3, Vec3};
use planish_generate::scene_text::SceneText;
use planish_generate::{cage::Cage, crowd, distances, flight, terrain};
use planish_scene::{Bounds, Camera, LoadOptions, Mesh, Scene, load};
use planish_subdiv::ControlMesh;
use planish_subdiv::topology::Level;

/// The aspect of the frames that cameras are made for.
const ASPECT: f32 = 16.0 / 9.0;

/// Reads a scene whose one mesh file is `m.obj`.
fn read(text: &SceneText, cage: &Cage) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), cage.to_obj("A mesh.")).unwrap();
    let path = folder.path().join("scene.json");
    std::fs::write(&path, text.to_json()).unwrap();
    let scene = load(&path, &LoadOptions::default()).unwrap();
    assert_eq!(scene.warnings, []);
    scene
}

fn several() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/several.json");
    load(path, &LoadOptions::default()).unwrap()
}

/// Faces that are drawn and are no bicubic patch.
fn irregular_count(mesh: &ControlMesh) -> usize {
    let level = Level::from_mesh(mesh).unwrap();
    (0..level.face_count()).filter(|&face| level.is_drawn(face) && !level.is_regular(face)).count()
}

/// Where the corners of a box lie in the image: x and y in units of half its width and height, and distance along the line
/// of sight.
fn image_of(bounds: &Bounds, camera: &Camera) -> Vec<Vec3> {
    let matrix = camera.projection_matrix(ASPECT) * camera.view_matrix();
    let corner = |index: usize| {
        let side = |axis: usize| [bounds.min, bounds.max][index >> axis & 1][axis] as f32;
        let clip = matrix * Vec3::new(side(0), side(1), side(2)).extend(1.0);
        Vec3::new(clip.x / clip.w.abs(), clip.y / clip.w.abs(), clip.w)
    };
    (0..8).map(corner).collect()
}

/// How many instances a camera sees whole, and how many it sees nothing of.
fn seen_and_unseen(scene: &Scene, camera: &Camera) -> (usize, usize) {
    let meshes: Vec<Bounds> = scene.meshes.iter().map(|mesh| mesh.bounds().unwrap()).collect();
    let images = scene.instances.iter().map(|instance| image_of(&instance.bounds(&meshes[instance.mesh]), camera));
    let images: Vec<Vec<Vec3>> = images.collect();
    let count = |is: &dyn Fn(&[Vec3]) -> bool| images.iter().filter(|image| is(image)).count();
    let inside = |p: &Vec3| p.x.abs() <= 1.0 && p.y.abs() <= 1.0 && p.z > 0.0;
    let outside: [fn(&Vec3) -> bool; 5] = [|p| p.z < 0.0, |p| p.x < -1.0, |p| p.x > 1.0, |p| p.y < -1.0, |p| p.y > 1.0];
    let unseen = |image: &[Vec3]| outside.iter().any(|outside| image.iter().all(outside));
    (count(&|image| image.iter().all(inside)), count(&unseen))
}

fn uses(scene: &Scene, is_meant: impl Fn(&Mesh) -> bool) -> bool {
    scene.instances.iter().any(|instance| is_meant(&scene.meshes[instance.mesh]))
}

#[test]
fn several_has_ngons_creases_and_a_boundary() {
    let scene = several();
    assert_eq!(scene.warnings, []);
    assert!(scene.meshes.len() >= 3);
    assert!(uses(&scene, |mesh| mesh.control_mesh.face_sizes.iter().any(|&size| size > 4)));
    assert!(uses(&scene, |mesh| !mesh.control_mesh.creases.is_empty()));
    let has_boundary = |mesh: &Mesh| {
        let level = Level::from_mesh(&mesh.control_mesh).unwrap();
        (0..level.origins.len() as u32).any(|half_edge| level.is_boundary(half_edge))
    };
    assert!(uses(&scene, has_boundary));
}

#[test]
fn several_is_turned_scaled_unevenly_and_mirrored() {
    let scene = several();
    let is = |is_meant: &dyn Fn([Vec3; 3]) -> bool| {
        scene.instances.iter().any(|instance| {
            let matrix = instance.transform.matrix3;
            is_meant([matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec3::from))
        })
    };
    assert!(is(&|[x, ..]| x.y.abs() > 0.1));
    assert!(is(&|[x, y, _]| x.length() > 1.2 * y.length()));
    assert!(scene.instances.iter().any(planish_scene::Instance::is_mirrored));
    let mirrored = scene.instances.iter().find(|instance| instance.is_mirrored()).unwrap();
    assert!(scene.instances.iter().any(|other| other.mesh == mirrored.mesh && !other.is_mirrored()));
}

#[test]
fn several_is_seen_whole_by_its_camera_and_nothing_in_it_overlaps() {
    let scene = several();
    assert_eq!(seen_and_unseen(&scene, &scene.cameras[0]), (scene.instances.len(), 0));
    let boxes: Vec<Bounds> = scene
        .instances
        .iter()
        .map(|instance| instance.bounds(&scene.meshes[instance.mesh].bounds().unwrap()))
        .collect();
    for (index, a) in boxes.iter().enumerate() {
        for b in &boxes[index + 1..] {
            let apart = a.max.cmplt(b.min) | b.max.cmplt(a.min);
            assert!(apart.any(), "{a:?} {b:?}");
        }
    }
}

#[test]
fn figure_is_small_closed_and_has_extraordinary_vertices_and_creases() {
    let scene = read(&crowd::scene(1, "m.obj"), &crowd::figure());
    let mesh = &scene.meshes[0].control_mesh;
    assert_eq!((mesh.face_count(), mesh.creases.len()), (42, 8));
    let level = Level::from_mesh(mesh).unwrap();
    assert!((0..level.origins.len() as u32).all(|half_edge| !level.is_boundary(half_edge)));
    assert!(level.tags.iter().filter(|tag| tag.is_extraordinary()).count() > 20);
    assert_eq!(level.non_manifold_edge_count(), 0);
    assert!(level.tags.iter().all(|tag| !tag.is_non_manifold()));
}

#[test]
fn cameras_of_the_crowd_see_all_some_and_none() {
    for count in [1, 7, 1000] {
        let scene = read(&crowd::scene(count, "m.obj"), &crowd::figure());
        let count = count as usize;
        assert_eq!((scene.instances.len(), scene.meshes.len()), (count, 1));
        let by = |name: &str| seen_and_unseen(&scene, &scene.camera(Some(name)).unwrap());
        assert_eq!((by("all"), by("none")), ((count, 0), (0, count)));
        if count == 1000 {
            let (seen, unseen) = by("some");
            assert!(seen > count / 20 && unseen > count / 2, "{seen} {unseen}");
        }
        let turn = scene.path("turn").unwrap();
        assert_eq!(seen_and_unseen(&scene, &turn.camera(0)), (0, count));
        assert_eq!(seen_and_unseen(&scene, &turn.camera(turn.frame_count() - 1)), (count, 0));
    }
}

#[test]
fn figures_of_the_crowd_stand_apart_and_differ() {
    let scene = read(&crowd::scene(1000, "m.obj"), &crowd::figure());
    let place = |index: usize| scene.instances[index].transform.translation;
    for a in 0..1000 {
        assert!((a + 1..1000).all(|b| (place(a) - place(b)).length() > 3.9), "{a}");
    }
    let mut turns: Vec<u32> = scene.instances.iter().map(|i| i.transform.matrix3.x_axis.x.to_bits()).collect();
    turns.sort_unstable();
    turns.dedup();
    assert!(turns.len() > 900, "{}", turns.len());
}

#[test]
fn terrain_has_the_faces_and_the_irregular_faces_of_the_papers() {
    let cage = terrain::terrain(17_136, 0.1312);
    let scene = read(&flight::scene(17_136, "m.obj"), &cage);
    let irregular = irregular_count(&scene.meshes[0].control_mesh);
    assert_eq!((cage.faces.len(), terrain::irregular_face_count(&cage)), (17_136, irregular));
    assert!(irregular.abs_diff(2248) <= 12, "{irregular}");
}

#[test]
fn flight_stays_above_the_ground_below_the_hills_and_looks_ahead() {
    const FACES: u32 = 17_136;
    // The surface near a point is within the hull of the control points of the faces around: less than three away from it.
    const AROUND: f32 = 0.2;
    let cage = terrain::terrain(FACES, 0.1312);
    let scene = read(&flight::scene(FACES, "m.obj"), &cage);
    let path = scene.path("flight").unwrap();
    assert_eq!(path.frame_count(), 120);
    let points: Vec<Vec3> = cage.positions.iter().map(|p| p.as_vec3()).collect();
    let flat = |p: Vec3| glam::Vec2::new(p.x, p.z);
    let highest = |at: Vec3, radius: f32| {
        let near = points.iter().filter(|&&point| flat(point).distance(flat(at)) < radius);
        near.map(|point| point.y).fold(f32::MIN, f32::max)
    };
    let (mut below_hills, mut low) = (0, 0);
    for frame in 0..path.frame_count() {
        let Camera { eye, target, .. } = path.camera(frame);
        let clearance = eye.y - highest(eye, AROUND);
        assert!(clearance > 0.03, "frame {frame}: {clearance} above {eye}");
        low += u32::from(eye.y - terrain::height(f64::from(eye.x), f64::from(eye.z)) as f32 <= 0.5);
        below_hills += u32::from(highest(eye, 1.5) > eye.y);
        assert!(target.x > eye.x + 0.5, "frame {frame}: {eye} to {target}");
        let before = path.camera(frame.saturating_sub(1)).eye;
        assert!(frame == 0 || eye.x > before.x, "frame {frame} goes back");
    }
    let (first, last) = (path.camera(0).eye, path.camera(119).eye);
    assert!(last.x - first.x > 8.0, "{first} to {last}");
    assert!(low > 100 && below_hills > 110, "{low} low, {below_hills} below hills");
}

#[test]
fn distances_begin_with_the_model_filling_the_frame_and_end_20_diagonals_away() {
    let cage = crowd::figure().map(|p| 1e-3 * p + DVec3::new(0.5, -0.2, 0.1));
    let model = planish_scene::read_obj("m.obj", cage.to_obj("A mesh.").as_bytes(), &LoadOptions::default()).unwrap();
    let scene = read(&distances::scene(&model, "m.obj", 150).unwrap(), &cage);
    let bounds = scene.bounds().unwrap();
    let path = scene.path("distances").unwrap();
    assert_eq!(path.frame_count(), 150);
    let first = path.camera(0);
    let matrix = first.projection_matrix(ASPECT) * first.view_matrix();
    let borders = scene.meshes[0].control_mesh.positions.iter().map(|&point| {
        let clip = matrix * Vec3::from(point).extend(1.0);
        clip.x.abs().max(clip.y.abs()) / clip.w
    });
    let border = borders.fold(0.0, f32::max);
    assert!((border - 1.0).abs() < 0.01, "{border}");
    let distance = |frame: u32| {
        let camera = path.camera(frame);
        assert!((camera.target.as_dvec3() - bounds.center()).length() < 1e-6);
        (camera.eye.as_dvec3() - bounds.center()).length()
    };
    let ratio = distance(149) / bounds.diagonal();
    assert!((ratio - distances::FARTHEST).abs() < 1e-3 * ratio, "{ratio}");
    let step = (distance(149) / distance(0)).powf(1.0 / 149.0);
    for frame in 1..150 {
        let found = distance(frame) / distance(frame - 1);
        assert!(found > 1.0 && found < 1.5 * (step - 1.0) + 1.0, "frame {frame}: {found}, mean {step}");
    }
}

#[test]
fn a_model_of_one_point_has_no_distances() {
    let mut model =
        planish_scene::read_obj("m.obj", crowd::figure().to_obj("A mesh.").as_bytes(), &LoadOptions::default())
            .unwrap();
    model.meshes[0].control_mesh.positions.fill([1.0; 3]);
    let error = distances::scene(&model, "m.obj", 2).unwrap_err().to_string();
    assert_eq!(error, "the model has no size");
}
