//! The emit stage: bit for bit its CPU twin's, and without a trace in any image.

use std::path::{Path, PathBuf};

use glam::{DVec3, DVec4, Mat4, Vec3};
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, DeviceOptions, Encoder, Image};
use planish_render::emit::{Emitted, emit, emit_view};
use planish_render::tessellation::{filling_triangle_count, patch_triangle_count};
use planish_render::{
    CapturedVertex, DrawOptions, DrawPasses, DumpPasses, FrameCamera, FrameConstants, PatchKind, PointStages, Spacing,
    Surface, SurfaceDesc, SurfaceMethod, Targets, View, density, limit, preprocess, subdivide,
};
use planish_scene::{Camera, LoadOptions};
use planish_subdiv::ControlMesh;

/// Closed meshes that face outward.
const CLOSED: [&str; 6] =
    ["genus_2", "cube", "adjacent_extraordinary", "two_components", "valence_2_closed", "tetrahedron"];
/// Meshes with boundaries in all modes, holes in the surface, or far away.
const OPEN: [&str; 6] =
    ["boundary_valences", "boundary_none", "boundary_edge_only", "open_cylinder", "grid_8x8", "far_from_origin"];
/// Ways to tessellate: aligned rows, rings that are skewed, factors of 1, midpoints.
const WAYS: [(Spacing, f32); 5] = [
    (Spacing::Equal, 1.0),
    (Spacing::Equal, 8.0),
    (Spacing::Equal, 4.7),
    (Spacing::FractionalOdd, 5.3),
    (Spacing::FractionalEven, 3.4),
];
/// Directions from which meshes are seen, and distances in diagonals of the bounding box: from outside, along the axes so
/// that much is seen edge on, and so near that most is outside of the view.
const EYES: [([f32; 3], f32); 7] = [
    ([1.0, 0.6, 1.2], 1.1),
    ([-0.4, -1.0, 0.3], 0.9),
    ([1.0, 0.0, 0.0], 0.8),
    ([0.02, 0.03, -1.0], 1.3),
    ([0.3, 0.2, 1.0], 0.6),
    ([1.0, 1.0, -0.1], 0.55),
    ([-1.0, 0.9, 0.2], 4.0),
];
const SIZE: [u32; 2] = [96, 64];

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name).with_extension("obj")
}

/// Models beside the repository, where they are.
fn models() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    ["bigguy.obj", "monsterfrog.obj"].map(|name| folder.join(name)).into_iter().filter(|path| path.is_file()).collect()
}

/// Each mesh in two ways, and both in turn.
fn in_two_ways(paths: impl Iterator<Item = PathBuf>) -> impl Iterator<Item = (PathBuf, (Spacing, f32))> {
    paths.enumerate().flat_map(|(i, path)| [i, i + 2].map(|i| (path.clone(), WAYS[i % WAYS.len()])))
}

fn device() -> Device {
    let options = DeviceOptions { validation: true, selector: None, memory_budget: None };
    Device::open(&options).expect("a Vulkan device with the validation layer")
}

/// A mesh on a device.
struct Case {
    name: String,
    mesh: ControlMesh,
    surface: Surface,
    stages: PointStages,
    factors: [f32; density::FACTOR_COUNT],
}

impl Case {
    fn new(device: &Device, path: &Path, (spacing, factor): (Spacing, f32)) -> Self {
        let scene = planish_scene::load(path, &LoadOptions::default()).expect("a scene");
        let mesh = scene.meshes[0].control_mesh.clone();
        let level = density::isolation_level(factor, 10);
        let desc = SurfaceDesc { method: SurfaceMethod::Fas, spacing, level };
        let made = preprocess(&mesh, &desc).expect("tables");
        let factors = density::level_factors(factor, spacing, &made.tables).expect("factors");
        let surface = Surface::new(device, &mesh, desc, made, &factors).expect("upload");
        let name = format!("{} {spacing:?} {factor}", path.display());
        Self { name, mesh, surface, stages: PointStages::new(device).expect("pipelines"), factors }
    }

    /// What is seen from a direction, at a distance in diagonals of the bounding box.
    fn camera(&self, (direction, distance): ([f32; 3], f32), size: [u32; 2]) -> FrameCamera {
        let [low, high] = self.mesh.bounding_box().expect("points").map(Vec3::from);
        let (middle, diagonal) = (0.5 * (low + high), (high - low).length());
        let eye = middle + distance * diagonal * Vec3::from(direction).normalize();
        let camera = Camera::upright("test", eye, middle, 45.0, f64::from(diagonal)).expect("a camera");
        FrameCamera {
            world_to_camera: camera.view_matrix(),
            projection: Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0))
                * camera.projection_matrix(size[0] as f32 / size[1] as f32),
            size,
        }
    }

    /// Whether an eye is outside of the bounding box: backs of closed meshes are hidden from there.
    fn is_outside(&self, eye: Vec3) -> bool {
        let [low, high] = self.mesh.bounding_box().expect("points").map(Vec3::from);
        eye.cmplt(low).any() || eye.cmpgt(high).any()
    }

    /// The twin's result.
    fn twin(&self, camera: &FrameCamera, cull_back: bool, sub_pixel_bits: u32) -> Emitted {
        let surface = &self.surface;
        let points = subdivide::subdivide(surface.tables(), &self.mesh.positions);
        let limits = limit::limit(surface.tables(), &points);
        let view = emit_view(camera, cull_back, sub_pixel_bits);
        emit(surface.tables(), surface.lists(), surface.batches(), surface.emit_levels(), &points, &limits, &view)
    }

    /// Draws a frame.
    fn draw(&self, device: &Device, passes: &DrawPasses, targets: &Targets, camera: &FrameCamera) {
        let constants = FrameConstants::new(device, camera, &self.factors).expect("constants");
        let mut encoder = Encoder::new(device, "frame").expect("encoder");
        self.stages.record(&mut encoder, &self.surface);
        passes.record(&mut encoder, &self.surface, &constants, camera, targets);
        device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
    }

    /// For each entry of all lists whether it is drawn.
    fn kept(&self, emitted: &Emitted) -> Vec<bool> {
        let lists = self.surface.lists();
        let mut kept = vec![false; lists.entries.len()];
        for kind in PatchKind::ALL {
            let batches = self.surface.batches();
            let range = batches.ranges[kind as usize].clone();
            let draws = &emitted.draws[range.start as usize..range.end as usize];
            for (draw, source) in draws.iter().zip(batches.of_kind(kind)) {
                let first = (lists.ranges[kind as usize].start + draw.first_vertex) as usize;
                let mut rest = first..first + source.vertex_count as usize;
                for entry in &emitted.entries[first..first + draw.vertex_count as usize] {
                    let place = rest.find(|&place| lists.entries[place] == *entry);
                    kept[place.expect("entries of the batch, in order")] = true;
                }
            }
        }
        kept
    }
}

/// The passes of all options, made once.
struct Passes(Vec<(Spacing, bool, bool, DrawPasses)>);

impl Passes {
    fn new(device: &Device) -> Self {
        let spacings = [Spacing::Equal, Spacing::FractionalOdd, Spacing::FractionalEven];
        let all = spacings.into_iter().flat_map(|spacing| {
            [(false, false), (false, true), (true, false), (true, true)].map(|(cull_back, emit)| {
                let (method, view) = (SurfaceMethod::Fas, View::Shaded);
                let options = DrawOptions { method, spacing, view, layers: true, cull_back, emit };
                (spacing, cull_back, emit, DrawPasses::new(device, &options).expect("pipelines"))
            })
        });
        Self(all.collect())
    }

    fn get(&self, spacing: Spacing, cull_back: bool, emit: bool) -> &DrawPasses {
        let found = self.0.iter().find(|passes| (passes.0, passes.1, passes.2) == (spacing, cull_back, emit));
        &found.expect("all options").3
    }
}

/// What a batch's draw says beyond its end is nobody's business.
fn assert_same(case: &Case, found: &Emitted, expected: &Emitted, camera: &FrameCamera) {
    assert_eq!(found.draws, expected.draws, "{} from {}", case.name, camera.eye());
    assert_eq!(found.counts, expected.counts, "{} from {}", case.name, camera.eye());
    let (lists, batches) = (case.surface.lists(), case.surface.batches());
    for kind in PatchKind::ALL {
        let range = batches.ranges[kind as usize].clone();
        for draw in &expected.draws[range.start as usize..range.end as usize] {
            let first = (lists.ranges[kind as usize].start + draw.first_vertex) as usize;
            let range = first..first + draw.vertex_count as usize;
            assert_eq!(found.entries[range.clone()], expected.entries[range], "{} from {}", case.name, camera.eye());
        }
    }
}

#[test]
fn the_kernel_equals_its_twin_bit_for_bit() {
    let device = device();
    let (passes, targets) = (Passes::new(&device), Targets::new(&device, SIZE, true).expect("images"));
    let (mut kept, mut all) = ([0_u64; 3], [0_u64; 3]);
    for (path, way) in in_two_ways(CLOSED.iter().chain(&OPEN).chain(&["hero"]).map(|name| scene(name))) {
        let case = Case::new(&device, &path, way);
        for cull_back in [false, true] {
            let passes = passes.get(way.0, cull_back, true);
            for &eye in EYES.iter().step_by(2) {
                let camera = case.camera(eye, SIZE);
                case.draw(&device, passes, &targets, &camera);
                let found = case.surface.download_emitted(&device).expect("lists");
                assert_same(&case, &found, &case.twin(&camera, cull_back, device.limits().sub_pixel_bits), &camera);
                for (counts, sums) in [(&found.counts, &mut kept), (&case.surface.tables().counts, &mut all)] {
                    for level in counts {
                        sums[0] += u64::from(level.regular);
                        sums[1] += u64::from(level.transition);
                        sums[2] += u64::from(level.filling);
                    }
                }
            }
        }
    }
    for (kept, all) in kept.into_iter().zip(all) {
        assert!(kept > all / 4 && kept < all * 19 / 20, "{kept} of {all} patches are kept");
    }
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}

/// A triangle as the rasterizer takes it.
struct Projected<'a> {
    camera: &'a FrameCamera,
    sub_pixel_bits: u32,
}

impl Projected<'_> {
    fn clip(&self, vertex: &CapturedVertex) -> DVec4 {
        let point = DVec3::from(vertex.position.map(f64::from));
        self.camera.view_projection().as_dmat4() * point.extend(1.0)
    }

    /// Whether any of it may be seen, but for what hides it.
    fn is_seen(&self, triangle: &[CapturedVertex], cull_back: bool) -> bool {
        let clip: [DVec4; 3] = std::array::from_fn(|i| self.clip(&triangle[i]));
        let is_beyond = |distance: fn(&DVec4) -> f64| clip.iter().all(|corner| distance(corner) < 0.0);
        let planes: [fn(&DVec4) -> f64; 5] =
            [|c| c.w + c.x, |c| c.w - c.x, |c| c.w + c.y, |c| c.w - c.y, |c| c.w - c.z];
        !(planes.into_iter().any(is_beyond) || cull_back && self.is_turned(&clip))
    }

    /// Whether it shows its back, or nothing, after its corners were moved to the rasterizer's grid.
    fn is_turned(&self, clip: &[DVec4; 3]) -> bool {
        if clip.iter().any(|corner| corner.w < corner.z) {
            // Clipped: by the sides of its plane.
            let [a, b, c] = clip.map(|corner| DVec3::new(corner.x, corner.y, corner.w));
            return a.dot(b.cross(c)) <= 0.0;
        }
        let [width, height] = self.camera.size.map(f64::from);
        let steps = f64::from(1_u32 << self.sub_pixel_bits);
        let [a, b, c] = clip.map(|corner| {
            let grid = |place: f64, size: f64| (0.5 * place * size * steps).round();
            [grid(corner.x / corner.w, width), grid(corner.y / corner.w, height)]
        });
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0
    }
}

/// The captured triangles of every entry of all lists.
fn triangles(device: &Device, case: &Case) -> Vec<Vec<CapturedVertex>> {
    let surface = &case.surface;
    let (desc, tables) = (*surface.desc(), surface.tables());
    let camera = case.camera(EYES[0], SIZE);
    let constants = FrameConstants::new(device, &camera, &case.factors).expect("constants");
    let mut encoder = Encoder::new(device, "points").expect("encoder");
    case.stages.record(&mut encoder, surface);
    device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
    let mut vertices = Vec::new();
    let dump = DumpPasses::new(device, desc.method, desc.spacing).expect("pipelines");
    dump.capture(device, surface, &constants, &case.factors, |part| {
        vertices.extend_from_slice(part);
        Ok::<_, planish_render::Error>(())
    })
    .expect("capture");
    let mut rest = vertices.as_slice();
    let mut of_entries = Vec::new();
    for kind in PatchKind::ALL {
        for &entry in surface.lists().of_kind(kind) {
            let count = match kind {
                PatchKind::Filling => filling_triangle_count(desc.method, desc.spacing),
                _ => patch_triangle_count(&tables.patches[entry as usize].info, &case.factors, desc.spacing),
            };
            let (own, others) = rest.split_at(3 * count as usize);
            of_entries.push(own.to_vec());
            rest = others;
        }
    }
    assert!(rest.is_empty());
    of_entries
}

#[test]
fn no_triangle_of_a_patch_that_is_left_out_could_be_seen() {
    /// Of the patches that could be left out, the share that must be.
    const LEAST_SHARE: f64 = 0.85;
    let device = device();
    let sub_pixel_bits = device.limits().sub_pixel_bits;
    let (mut unseen, mut found) = (0_u32, 0_u32);
    for (name, is_closed) in CLOSED.iter().map(|name| (name, true)).chain(OPEN.iter().map(|name| (name, false))) {
        for way in WAYS {
            let case = Case::new(&device, &scene(name), way);
            let triangles = triangles(&device, &case);
            // Small images have large grids.
            for (eye, size) in EYES.into_iter().flat_map(|eye| [(eye, [640, 480]), (eye, [48, 32])]) {
                let camera = case.camera(eye, size);
                let cull_back = is_closed && case.is_outside(camera.eye());
                let projected = Projected { camera: &camera, sub_pixel_bits };
                let kept = case.kept(&case.twin(&camera, cull_back, sub_pixel_bits));
                for (place, own) in triangles.iter().enumerate() {
                    let is_seen = own.chunks_exact(3).any(|triangle| projected.is_seen(triangle, cull_back));
                    assert!(kept[place] || !is_seen, "{} from {}: entry {place} is left out", case.name, camera.eye());
                    if size[0] > 100 && !is_seen {
                        unseen += 1;
                        found += u32::from(!kept[place]);
                    }
                }
            }
        }
    }
    assert!(f64::from(found) > LEAST_SHARE * f64::from(unseen), "{found} of {unseen} patches are left out");
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}

/// Everything that an image holds.
fn words(device: &Device, image: &Image) -> Vec<u32> {
    let desc = BufferDesc { name: "image", kind: BufferKind::Readback, size: image.copy_size() };
    let buffer = Buffer::new(device, &desc).expect("a buffer");
    let mut encoder = Encoder::new(device, "read-back").expect("encoder");
    encoder.copy_image_to_buffer(image, &buffer, 0);
    device.submit_and_wait(&encoder.finish().expect("recording")).expect("submission");
    buffer.read(0, (image.copy_size() / 4) as usize).expect("pixels")
}

#[test]
fn images_are_the_same_bits_with_the_emit_stage_and_without() {
    let device = device();
    let (passes, targets) = (Passes::new(&device), Targets::new(&device, SIZE, true).expect("images"));
    let (mut drawn, mut all) = (0, 0);
    let closed: Vec<PathBuf> = CLOSED.map(scene).into_iter().chain(models()).collect();
    for (path, way) in in_two_ways(closed.iter().cloned().chain(OPEN.map(scene))) {
        let is_closed = closed.contains(&path);
        let case = Case::new(&device, &path, way);
        // Large models are seen from two places alone.
        let eyes = if case.mesh.face_sizes.len() > 1000 { &EYES[..2] } else { &EYES[..] };
        for &eye in eyes {
            let camera = case.camera(eye, SIZE);
            let cull_back = is_closed && case.is_outside(camera.eye());
            // The same rasterizer state on both sides: all that differs is which patches are drawn.
            let images = [false, true].map(|has_emit| {
                case.draw(&device, passes.get(way.0, cull_back, has_emit), &targets, &camera);
                let images = std::iter::once(targets.color()).chain(targets.layers());
                images.map(|image| words(&device, image)).collect::<Vec<_>>()
            });
            assert!(images[0] == images[1], "{} from {}", case.name, camera.eye());
            if cull_back {
                let counts = case.surface.download_visible_counts(&device).expect("counts");
                drawn += counts.iter().map(|level| level.regular + level.transition + level.filling).sum::<u32>();
                all += case.surface.lists().entries.len() as u32;
            }
        }
    }
    assert!(drawn < all * 7 / 10, "{drawn} of {all} patches of closed meshes are drawn");
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}
