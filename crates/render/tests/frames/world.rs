//! Scenes on a device, and cameras that look at them.

use std::path::Path;

use glam::{Affine3A, Mat4, Quat, Vec3};
use planish_gpu::Device;
use planish_render::{DisplacementDesc, FrameCamera, MapLayout, ObjectDesc, Surface, SurfaceDesc, preprocess};
use planish_scene::displacement::{DisplacementMap, TileLayout};
use planish_scene::{Camera, LoadOptions};
use planish_subdiv::ControlMesh;

/// Meshes and objects, and the surface of them.
pub struct World {
    pub name: String,
    pub meshes: Vec<ControlMesh>,
    pub objects: Vec<ObjectDesc>,
    pub surface: Surface,
    original: Vec<Vec<[f32; 3]>>,
}

impl World {
    pub fn new(device: &Device, name: &str, meshes: Vec<ControlMesh>, objects: Vec<ObjectDesc>, level: u32) -> Self {
        Self::with_capacity(device, name, meshes, objects, level, None)
    }

    pub fn with_capacity(
        device: &Device,
        name: &str,
        meshes: Vec<ControlMesh>,
        objects: Vec<ObjectDesc>,
        level: u32,
        capacity: Option<u32>,
    ) -> Self {
        Self::with_desc(device, name, meshes, objects, SurfaceDesc { level, ..SurfaceDesc::default() }, capacity)
    }

    pub fn with_desc(
        device: &Device,
        name: &str,
        meshes: Vec<ControlMesh>,
        objects: Vec<ObjectDesc>,
        desc: SurfaceDesc,
        capacity: Option<u32>,
    ) -> Self {
        let all: Vec<&ControlMesh> = meshes.iter().collect();
        let made = preprocess(&all, &desc).expect("tables");
        let surface = Surface::with_capacity(device, &all, &objects, desc, made, capacity).expect("upload");
        let original = meshes.iter().map(|mesh| mesh.positions.clone()).collect();
        Self { name: name.to_owned(), meshes, objects, surface, original }
    }

    /// A scene of the repository; all objects are taken to be closed or all not.
    pub fn of_scene(device: &Device, name: &str, level: u32, hides_backs: bool) -> Self {
        let (meshes, objects) = scene(name, hides_backs);
        Self::new(device, name, meshes, objects, level)
    }

    /// Six objects of three meshes: turned, scaled, mirrored; the last two far away, on both sides.
    pub fn of_objects(device: &Device, level: u32, capacity: Option<u32>) -> Self {
        let (meshes, objects) = objects();
        Self::with_capacity(device, "objects", meshes, objects, level, capacity)
    }

    /// The same objects of surfaces that are made so.
    pub fn with_objects(device: &Device, desc: SurfaceDesc) -> Self {
        let (meshes, objects) = objects();
        Self::with_desc(device, "objects", meshes, objects, desc, None)
    }

    /// Gives a mesh a displacement map; the surface was made to be displaced.
    pub fn displace(&mut self, device: &Device, mesh: usize, map: &DisplacementMap) {
        let levels: Vec<[u32; 3]> = map.levels.iter().map(|l| [l.first_texel, l.width, l.height]).collect();
        let tiles: Vec<[u32; 2]> = map.tiles.iter().map(|tile| [tile.first_level, tile.level_count]).collect();
        let desc = DisplacementDesc {
            channels: map.channels,
            layout: match map.layout {
                TileLayout::Repeat => MapLayout::Repeat,
                TileLayout::Udim => MapLayout::Udim,
                TileLayout::Faces => MapLayout::Faces,
            },
            texels: &map.texels,
            levels: &levels,
            tiles: &tiles,
            tile_of: &map.tile_of,
            tile_columns: map.tile_columns,
            parts: &map.parts,
            bound: map.bound,
        };
        self.surface.displace(device, mesh, &self.meshes[mesh], &desc).expect("a map");
    }

    /// Positions of all cages, one after the other.
    pub fn cage(&self) -> Vec<[f32; 3]> {
        self.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied()).collect()
    }

    /// Moves all cages a little, within their boxes: what a frame leaves behind is wrong for the next.
    pub fn move_cages(&mut self, frame: usize) {
        let factor = 1.0 - 0.003 * (frame % 8) as f32;
        for (index, mesh) in self.meshes.iter_mut().enumerate() {
            let original = &self.original[index];
            // Towards one of its points.
            let fixed = Vec3::from(original[0]);
            mesh.positions = original.iter().map(|&p| (fixed + factor * (Vec3::from(p) - fixed)).to_array()).collect();
            self.surface.set_cage(index, &mesh.positions).expect("cage");
        }
    }

    /// Lower and upper corner of the box around all objects.
    pub fn bounds(&self) -> [Vec3; 2] {
        let points = self.objects.iter().flat_map(|object| {
            self.meshes[object.mesh].positions.iter().map(|&p| object.to_world.transform_point3(Vec3::from(p)))
        });
        points.fold([Vec3::MAX, Vec3::MIN], |[low, high], p| [low.min(p), high.max(p)])
    }

    /// What is seen from a direction, at a distance in diagonals of the bounding box.
    pub fn camera_from(&self, (direction, distance): ([f32; 3], f32), size: [u32; 2]) -> FrameCamera {
        let [low, high] = self.bounds();
        let middle = 0.5 * (low + high);
        let eye = middle + distance * (high - low).length() * Vec3::from(direction).normalize();
        self.camera(eye, middle, size)
    }

    pub fn camera(&self, eye: Vec3, target: Vec3, size: [u32; 2]) -> FrameCamera {
        self.camera_of_angle(eye, target, 45.0, size)
    }

    /// A camera that sees so many degrees from the lower to the upper edge of the image.
    pub fn camera_of_angle(&self, eye: Vec3, target: Vec3, degrees: f32, size: [u32; 2]) -> FrameCamera {
        let [low, high] = self.bounds();
        let diagonal = f64::from((high - low).length());
        let camera = Camera::upright("test", eye, target, degrees, diagonal).expect("a camera");
        FrameCamera {
            world_to_camera: camera.view_matrix(),
            projection: Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
                * camera.projection_matrix(size[0] as f32 / size[1] as f32),
            size,
        }
    }

    /// From outside, grazing the top, from inside, with a vertex right behind the eye, and with most out of view.
    pub fn cameras(&self, size: [u32; 2]) -> [FrameCamera; 5] {
        let [low, high] = self.bounds();
        let (middle, diagonal) = (0.5 * (low + high), (high - low).length());
        let top = Vec3::new(low.x, high.y, middle.z);
        let object = &self.objects[0];
        let vertex = object.to_world.transform_point3(Vec3::from(self.meshes[object.mesh].positions[0]));
        let beyond = vertex + 0.02 * (middle - vertex) + 1e-3 * diagonal * Vec3::new(0.3, 0.5, -0.2);
        let corner = high - 0.2 * (high - low);
        [
            self.camera_from(([1.0, 0.6, 1.2], 1.1), size),
            self.camera(top - 0.1 * diagonal * Vec3::X, top + diagonal * Vec3::X, size),
            self.camera(middle, middle + diagonal * Vec3::new(1.0, 0.2, 0.1), size),
            self.camera(beyond, beyond + (beyond - vertex) + 1e-4 * diagonal * Vec3::Z, size),
            self.camera(corner + 0.4 * diagonal * Vec3::ONE, corner, size),
        ]
    }

    /// Whether an eye is outside of the bounding box: backs of closed meshes are hidden from there.
    pub fn is_outside(&self, eye: Vec3) -> bool {
        let [low, high] = self.bounds();
        eye.cmplt(low).any() || eye.cmpgt(high).any()
    }
}

/// The meshes and objects of a scene of the repository.
pub fn scene(name: &str, hides_backs: bool) -> (Vec<ControlMesh>, Vec<ObjectDesc>) {
    let file = if name.contains('.') { name.to_owned() } else { format!("{name}.obj") };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(file);
    let scene = planish_scene::load(path, &LoadOptions::default()).expect("a scene");
    let object = |instance: &planish_scene::Instance| ObjectDesc {
        mesh: instance.mesh,
        to_world: instance.transform,
        hides_backs,
        is_hidden: false,
    };
    let objects = scene.instances.iter().map(object).collect();
    (scene.meshes.into_iter().map(|mesh| mesh.control_mesh).collect(), objects)
}

/// The models beside the repository, by their names; none, with a word about it, where there are none.
pub fn models() -> Vec<(String, ControlMesh)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let load = |name: &str| {
        let path = folder.join(name);
        if !path.is_file() {
            println!("skipped: there is no model {}", path.display());
            return None;
        }
        let mut scene = planish_scene::load(&path, &LoadOptions::default()).expect("a scene");
        assert_eq!(scene.meshes.len(), 1, "{name}");
        Some((name.to_owned(), scene.meshes.remove(0).control_mesh))
    };
    ["bigguy.obj", "monsterfrog.obj"].into_iter().filter_map(load).collect()
}

fn objects() -> (Vec<ControlMesh>, Vec<ObjectDesc>) {
    let meshes = ["ngon_5", "tetrahedron", "crease_2_3"].map(|name| scene(name, false).0.remove(0)).to_vec();
    let object = |mesh: usize, scale: [f32; 3], axis: [f32; 3], angle: f32, at: [f32; 3]| ObjectDesc {
        mesh,
        to_world: Affine3A::from_scale_rotation_translation(
            Vec3::from(scale),
            Quat::from_axis_angle(Vec3::from(axis).normalize(), angle),
            Vec3::from(at),
        ),
        hides_backs: mesh == 1,
        is_hidden: false,
    };
    let objects = vec![
        object(0, [1.0; 3], [0.0, 1.0, 0.0], 0.0, [0.0; 3]),
        object(1, [1.5, 1.0, 0.7], [1.0, 0.3, 0.0], 0.9, [4.0, 0.5, 1.0]),
        object(2, [-0.8, 0.8, 0.8], [0.2, 1.0, 0.3], 2.1, [-4.0, 0.3, -1.0]),
        object(1, [-1.0, 1.0, 1.0], [0.0, 0.0, 1.0], 0.4, [0.5, 3.0, 3.0]),
        object(0, [0.5, 0.5, 0.5], [1.0, 1.0, 0.0], 1.3, [60.0, 0.0, 5.0]),
        object(2, [1.0, 2.0, 1.0], [0.0, 1.0, 1.0], 0.7, [-50.0, 4.0, -40.0]),
    ];
    (meshes, objects)
}
