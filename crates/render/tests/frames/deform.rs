//! Cages that deform on the device: the kernel against its twin, whole frames against those of cages that were deformed before, and
//! motion against the limit surfaces of both moments.

use glam::{Affine3A, DAffine3, DQuat, DVec3, Quat, Vec3};
use planish_render::{
    CapturedVertex, Culling, DeformationDesc, Density, FrameCamera, FrameNeeds, FrameOptions, Layers, ObjectDesc,
    PoseDesc, Selection, Spacing, SurfaceDesc, SurfaceMethod,
};
use planish_scene::deformation::{Influence, Joint, MorphTarget, Skin};
use planish_scene::node::Placed;
use planish_scene::{Curve, Deformation, MeshPose};
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;

use crate::lab::{Easel, Lab};
use crate::world::{World, scene};

const SIZE: [u32; 2] = [96, 64];

fn options(density: Density, culling: Culling) -> FrameOptions {
    FrameOptions { density, selection: Selection::Dynamic, culling, object_lod: false }
}

/// Numbers that look random, from -1 to 1.
fn noise(seed: u32) -> f32 {
    let mixed = seed.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995;
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b);
    ((mixed ^ mixed >> 13) & 0xffff) as f32 / 32_767.5 - 1.0
}

/// Two morph targets that overlap, and a skin of three joints; every fifth vertex has none, every third one alone.
fn deformation(mesh: &ControlMesh) -> Deformation {
    let vertex_count = mesh.positions.len() as u32;
    let morph = |seed: u32, step: usize| {
        let vertices: Vec<u32> = (0..vertex_count).step_by(step).collect();
        let offset = |vertex: &u32| std::array::from_fn(|c| 0.2 * noise(seed + 3 * vertex + c as u32));
        MorphTarget { name: String::new(), offsets: vertices.iter().map(offset).collect(), vertices }
    };
    let mut skin = Skin {
        joints: (0..3).map(|node| Joint { node, inverse_bind: DAffine3::IDENTITY }).collect(),
        first: vec![0],
        influences: Vec::new(),
    };
    for vertex in 0..vertex_count {
        let of_vertex: &[(u32, f32)] = match vertex {
            v if v % 5 == 4 => &[],
            v if v % 3 == 0 => &[(1, 1.0)],
            _ => &[(0, 0.25), (2, 0.5), (1, 0.25)],
        };
        skin.influences.extend(of_vertex.iter().map(|&(joint, weight)| Influence { joint, weight }));
        skin.first.push(skin.influences.len() as u32);
    }
    Deformation {
        morphs: vec![morph(1, 2), morph(77, 3)],
        weights: Some(Curve::constant(vec![0.75, -0.4])),
        skin: Some(skin),
        points: None,
    }
}

/// Its pose with joints turned by so many radians.
fn pose(deformation: &Deformation, angle: f64) -> MeshPose {
    let joint = |i: u32| {
        let turn = DQuat::from_axis_angle(DVec3::new(0.3, 1.0, 0.2 * f64::from(i)).normalize(), angle * f64::from(i));
        let to_world =
            DAffine3::from_rotation_translation(turn, DVec3::new(0.1 * angle * f64::from(i), 0.2 * angle, 0.0));
        Placed { to_world, is_visible: true }
    };
    deformation.pose(0.0, &[0, 1, 2].map(joint), &DAffine3::IDENTITY)
}

/// A surface of one mesh and two objects, the second hidden, that deforms so.
struct Puppet {
    world: World,
    mesh: ControlMesh,
    deformation: Deformation,
    objects: Vec<ObjectDesc>,
}

impl Puppet {
    fn new(lab: &Lab, name: &str, desc: SurfaceDesc) -> Self {
        let (meshes, _) = scene(name, false);
        let mesh = meshes.into_iter().next().expect("a mesh");
        let to_world = Affine3A::from_quat(Quat::from_rotation_x(0.4));
        let seen = ObjectDesc { to_world, ..ObjectDesc::identity(0) };
        let objects = vec![seen, ObjectDesc { is_hidden: true, ..ObjectDesc::identity(0) }];
        let mut world = World::with_desc(&lab.device, name, vec![mesh.clone()], objects.clone(), desc, None);
        let deformation = deformation(&mesh);
        world.surface.set_deformations(&lab.device, &[Some(desc_of(&deformation))]).expect("tables");
        Self { world, mesh, deformation, objects }
    }

    fn set_pose(&mut self, angle: f64) -> Vec<[f32; 3]> {
        let pose = pose(&self.deformation, angle);
        let joints = columns(&pose);
        let desc = PoseDesc { points: None, weights: &pose.weights, joints: &joints };
        self.world.surface.set_pose(0, &desc).expect("a pose");
        self.deformation.deform(&self.mesh.positions, &pose)
    }

    fn set_next_pose(&mut self, angle: f64) -> Vec<[f32; 3]> {
        let pose = pose(&self.deformation, angle);
        let joints = columns(&pose);
        let desc = PoseDesc { points: None, weights: &pose.weights, joints: &joints };
        self.world.surface.set_next_pose(0, &desc).expect("a pose");
        self.deformation.deform(&self.mesh.positions, &pose)
    }
}

fn desc_of(deformation: &Deformation) -> DeformationDesc<'_> {
    let skin = deformation.skin.as_ref().expect("a skin");
    DeformationDesc {
        morphs: deformation.morphs.iter().map(|m| (m.vertices.as_slice(), m.offsets.as_slice())).collect(),
        first_influence: &skin.first,
        influences: skin.influences.iter().map(|influence| (influence.joint, influence.weight)).collect(),
        joint_count: skin.joints.len() as u32,
    }
}

fn columns(pose: &MeshPose) -> Vec<[[f32; 3]; 4]> {
    let columns = |map: &Affine3A| {
        [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis, map.translation].map(|axis| axis.to_array())
    };
    pose.joints.iter().map(columns).collect()
}

fn lab() -> Lab {
    Lab::with_needs(|spacing| FrameNeeds { deforms: true, moves: true, tex_coords: true, ..FrameNeeds::all(spacing) })
}

fn camera(puppet: &Puppet) -> FrameCamera {
    puppet.world.camera(Vec3::new(2.5, 2.0, 4.5), Vec3::ZERO, SIZE)
}

/// The captured vertices' bits, triangle by triangle in one order.
fn bits(vertices: &[CapturedVertex]) -> Vec<Vec<u32>> {
    let words = |triangle: &[CapturedVertex]| bytemuck::cast_slice::<_, u32>(triangle).to_vec();
    let mut triangles: Vec<Vec<u32>> = vertices.chunks_exact(3).map(words).collect();
    triangles.sort_unstable();
    triangles
}

#[test]
fn deformed_points_and_boxes_are_the_twin_s_bit_for_bit() {
    let lab = lab();
    for name in ["genus_2", "ngon_5"] {
        let mut puppet = Puppet::new(&lab, name, SurfaceDesc { level: 3, ..SurfaceDesc::default() });
        let camera = camera(&puppet);
        for angle in [0.0, 0.7, 2.0] {
            let expected = puppet.set_pose(angle);
            let options = options(Density::EdgePixels(4.0), Culling::Off);
            lab.run(&mut puppet.world.surface, Spacing::FractionalOdd, &camera, &options);
            let points = puppet.world.surface.download_points(&lab.device).expect("points");
            assert_eq!(points[..expected.len()], expected, "{name} {angle}");
            let objects = puppet.world.surface.download_objects(&lab.device).expect("objects");
            let low = expected.iter().fold([f32::INFINITY; 3], |low, p| std::array::from_fn(|c| low[c].min(p[c])));
            let high =
                expected.iter().fold([f32::NEG_INFINITY; 3], |high, p| std::array::from_fn(|c| high[c].max(p[c])));
            assert_eq!((objects[0].low, objects[0].high), (low, high), "{name} {angle}");
        }
    }
    lab.assert_silent();
}

#[test]
fn a_frame_of_a_cage_that_deforms_is_that_of_the_deformed_cage() {
    let lab = lab();
    for (name, method) in [("genus_2", SurfaceMethod::Dfas), ("ngon_5", SurfaceMethod::Fas)] {
        let desc = SurfaceDesc { level: 3, method, ..SurfaceDesc::default() };
        let mut puppet = Puppet::new(&lab, name, desc);
        let camera = camera(&puppet);
        for object_lod in [false, true] {
            // Far out of the box that the cage has at rest: what is culled is decided by where it is now.
            let positions = puppet.set_pose(1.5);
            // A density of a whole object is divided on the CPU for what stands still, and by the kernel for what deforms.
            let is_divided_twice = object_lod && !lab.is_exact();
            let density = if is_divided_twice { Density::Tess(5.3) } else { Density::EdgePixels(5.0) };
            let options = FrameOptions { object_lod, ..options(density, Culling::Unseen) };
            let passes = lab.dump_passes(&desc, Spacing::FractionalOdd);
            lab.run(&mut puppet.world.surface, Spacing::FractionalOdd, &camera, &options);
            let deformed = lab.dump(&puppet.world.surface, &passes);
            let mesh = ControlMesh { positions, ..puppet.mesh.clone() };
            let mut still = World::with_desc(&lab.device, name, vec![mesh], puppet.objects.clone(), desc, None);
            lab.run(&mut still.surface, Spacing::FractionalOdd, &camera, &options);
            let expected = lab.dump(&still.surface, &passes);
            assert!(!expected.is_empty());
            assert!(bits(&deformed) == bits(&expected), "{name} {object_lod}");
        }
    }
    lab.assert_silent();
}

/// What images of all layers hold of a pixel.
struct Pixel {
    ptex_face: u32,
    uv: [f64; 2],
    position: DVec3,
    motion: [f64; 2],
}

fn pixels(words: &[Vec<u32>]) -> Vec<Option<Pixel>> {
    let float = |word: u32| f64::from(f32::from_bits(word));
    let pixel = |at: usize| {
        let [position, ids, motion] = [2, 3, 5].map(|layer| &words[layer][4 * at..4 * at + 4]);
        (ids[0] != planish_render::NO_SURFACE).then(|| Pixel {
            ptex_face: ids[0],
            uv: [float(ids[2]), float(ids[3])],
            position: DVec3::new(float(position[0]), float(position[1]), float(position[2])),
            motion: [float(motion[0]), float(motion[1])],
        })
    };
    (0..words[3].len() / 4).map(pixel).collect()
}

fn pixel_of(camera: &FrameCamera, p: DVec3) -> [f64; 2] {
    let clip = camera.view_projection().as_dmat4() * p.extend(1.0);
    [(0.5 + 0.5 * clip.x / clip.w) * f64::from(SIZE[0]), (0.5 - 0.5 * clip.y / clip.w) * f64::from(SIZE[1])]
}

fn in_world(to_world: &Affine3A, [x, y, z]: [f64; 3]) -> DVec3 {
    let m = &to_world.matrix3;
    let [i, j, k, origin] = [m.x_axis, m.y_axis, m.z_axis, to_world.translation].map(|axis| axis.as_dvec3());
    i * x + j * y + k * z + origin
}

#[test]
fn motion_is_where_the_same_parameters_are_seen_at_the_next_moment() {
    let lab = lab();
    for (name, method) in
        [("genus_2", SurfaceMethod::Dfas), ("crease_2_3", SurfaceMethod::Fas), ("ngon_5", SurfaceMethod::Uniform)]
    {
        let level = if method == SurfaceMethod::Uniform { 4 } else { 6 };
        let desc = SurfaceDesc { level, method, ..SurfaceDesc::default() };
        let mut puppet = Puppet::new(&lab, name, desc);
        if method == SurfaceMethod::Uniform {
            // It draws one mesh where it is.
            let mesh = vec![puppet.mesh.clone()];
            puppet.objects = vec![ObjectDesc::identity(0)];
            puppet.world = World::with_desc(&lab.device, name, mesh, puppet.objects.clone(), desc, None);
            let deformation = puppet.deformation.clone();
            let tables = puppet.world.surface.set_deformations(&lab.device, &[Some(desc_of(&deformation))]);
            tables.expect("tables");
        }
        puppet.world.surface.prepare_motion(&lab.device, &[&puppet.mesh]).expect("room");
        let camera = camera(&puppet);
        let next_camera = puppet.world.camera(Vec3::new(2.6, 2.05, 4.4), Vec3::new(0.02, 0.0, 0.0), SIZE);
        let positions = puppet.set_pose(0.2);
        let next_positions = puppet.set_next_pose(0.25);
        let mut next_objects = puppet.objects.clone();
        if method != SurfaceMethod::Uniform {
            next_objects[0].to_world = Affine3A::from_quat(Quat::from_rotation_x(0.45));
        }
        puppet.world.surface.set_motion(&puppet.objects, &next_objects, &next_camera).expect("motion");
        let easel = Easel::with_layers(&lab, &desc, Spacing::Equal, SIZE, Layers::GeometryAndColors);
        let words = lab.draw(&mut puppet.world.surface, &easel, &camera, &options(Density::Tess(48.0), Culling::Off));
        let evaluator = |positions| Evaluator::new(&ControlMesh { positions, ..puppet.mesh.clone() }).expect("a cage");
        let (mut now, mut then) = (evaluator(positions), evaluator(next_positions));
        let (mut seen, mut largest) = (0, 0.0_f64);
        for pixel in pixels(&words).into_iter().flatten() {
            let seen_at = |evaluator: &mut Evaluator, object: &ObjectDesc, camera: &FrameCamera| {
                let point = evaluator.evaluate(pixel.ptex_face, pixel.uv[0], pixel.uv[1]).expect("a point");
                pixel_of(camera, in_world(&object.to_world, point.position))
            };
            let from = seen_at(&mut now, &puppet.objects[0], &camera);
            let to = seen_at(&mut then, &next_objects[0], &next_camera);
            for c in 0..2 {
                largest = largest.max((to[c] - from[c] - pixel.motion[c]).abs());
            }
            seen += 1;
        }
        assert!(seen > 500, "{name}: {seen} pixels");
        // Within triangles motion is interpolated.
        assert!(largest < 0.01, "{name}: {largest} pixels");
    }
    lab.assert_silent();
}

#[test]
fn what_does_not_deform_moves_rigidly_with_every_kind_of_patch() {
    for (desc, needs_gregory) in [
        (SurfaceDesc { level: 3, ..SurfaceDesc::default() }, false),
        (SurfaceDesc { method: SurfaceMethod::Gregory, ..SurfaceDesc::default() }, true),
    ] {
        let lab =
            Lab::with_needs(|spacing| FrameNeeds { moves: true, gregory: needs_gregory, ..FrameNeeds::all(spacing) });
        let (meshes, _) = scene("genus_2", false);
        let now = ObjectDesc { to_world: Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)), ..ObjectDesc::identity(0) };
        let step = Affine3A::from_translation(Vec3::new(0.1, -0.05, 0.2)) * Affine3A::from_rotation_y(0.05);
        let next = ObjectDesc { to_world: step * now.to_world, ..now };
        let mut world = World::with_desc(&lab.device, "genus_2", meshes, vec![now], desc, None);
        let camera = world.camera(Vec3::new(2.5, 2.0, 4.5), Vec3::ZERO, SIZE);
        world.surface.set_motion(&[now], &[next], &camera).expect("motion");
        let easel = Easel::with_layers(&lab, &desc, Spacing::Equal, SIZE, Layers::GeometryAndColors);
        let words = lab.draw(&mut world.surface, &easel, &camera, &options(Density::Tess(8.0), Culling::Off));
        let seen: Vec<Pixel> = pixels(&words).into_iter().flatten().collect();
        assert!(seen.len() > 500);
        // Hardware interpolates with fewer digits than a software driver: what is promised holds on both.
        let bound = if lab.is_exact() { 1e-3 } else { 1e-2 };
        for pixel in seen {
            let then = step.transform_point3(pixel.position.as_vec3()).as_dvec3();
            let (now, then) = (pixel_of(&camera, pixel.position), pixel_of(&camera, then));
            for c in 0..2 {
                assert!((then[c] - now[c] - pixel.motion[c]).abs() < bound, "{then:?} {now:?} {:?}", pixel.motion);
            }
        }
        lab.assert_silent();
    }
}
