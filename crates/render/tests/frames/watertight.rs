//! Closed surfaces are closed: whatever is seen of them from wherever, all triangles meet edge to edge, to the bit.
//!
//! Each mesh is captured from as many random eyes as `PLANISH_SEAM_CAMERAS` says (1), with every selection and spacing; of the
//! meshes those whose names have one of the parts in `PLANISH_SEAM_SCENES`, between commas (all).

use std::cell::OnceCell;
use std::collections::{HashMap, HashSet};
use std::env;
use std::path::Path;

use glam::{Affine3A, Quat, Vec3};
use planish_render::lists::KIND_COUNT;
use planish_render::{
    CapturedVertex, Culling, Density, DumpPasses, FrameCamera, FrameNeeds, FrameOptions, ObjectDesc, PatchKind,
    Selection, Spacing, SurfaceDesc, SurfaceMethod, preprocess,
};
use planish_scene::displacement::{DisplacementLayout, DisplacementMap, DisplacementRequest, load_displacement};
use planish_subdiv::ControlMesh;
use planish_subdiv::gregory::Rival;
use planish_subdiv::mesh::{EditOperation, INFINITE_SHARPNESS};
use planish_subdiv::refine::CreasePatches;

use crate::lab::{Lab, SPACINGS};
use crate::random::Random;
use crate::world::{World, models, scene};

const SIZE: [u32; 2] = [96, 64];
const SELECTIONS: [Selection; 2] = [Selection::Dynamic, Selection::Static];
/// Lengths of edges in pixels, to begin with, and the most triangles of a cage and of one of its faces: what has more of both is
/// made coarser.
#[derive(Clone, Copy)]
struct Fineness {
    pixels: [f32; 2],
    triangles: usize,
    triangles_a_face: usize,
}

const MODERATE: Fineness = Fineness { pixels: [1.0, 12.0], triangles: 4000, triangles_a_face: 40 };
/// So fine that a patch that is denser than the others is cut.
const FINE: Fineness = Fineness { pixels: [0.02, 0.1], triangles: 50_000, triangles_a_face: 0 };
/// The same for faces that are thirds of others, or whole faces of small cages.
const FINEST: Fineness = Fineness { triangles: 160_000, ..FINE };
/// Isolation ends here: the finest patches have factors above 1, too.
const LEVEL: u32 = 4;
/// How far a texel displaces, over the diagonal of the bounding box.
const AMPLITUDE: f32 = 0.05;
/// Closed scenes that no check of edges says anything of, and why.
const SKIPPED: [(&str, &str); 2] =
    [("double_sided_quad", "its two faces lie on each other"), ("flat_pair", "its faces lie on each other")];

/// Of regular faces, with texture coordinates and without, with a sharp edge: one for each spacing.
const CUT: [&str; 3] = ["torus_32", "uv_torus", "crease_infinite"];
/// Of Gregory patches: quads, and triangles beside quads.
const CUT_GREGORY: [&str; 3] = ["cube", "mixed_triangles_quads", "tetrahedron"];

/// What must have the same bits for corners to be one point. Of zeros the sign does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Weld {
    Position,
    PositionAndNormal,
}

/// The point that each vertex is.
fn weld(vertices: &[CapturedVertex], by: Weld) -> Vec<u32> {
    let bits = |vector: [f32; 3]| vector.map(|value| if value == 0.0 { 0 } else { value.to_bits() });
    let mut points: HashMap<[[u32; 3]; 2], u32> = HashMap::with_capacity(vertices.len() / 4);
    let mut point_of = |vertex: &CapturedVertex| {
        let normal = if by == Weld::Position { [0; 3] } else { bits(vertex.normal) };
        let next = points.len() as u32;
        *points.entry([bits(vertex.position), normal]).or_insert(next)
    };
    vertices.iter().map(&mut point_of).collect()
}

/// All that keeps triangles from being a closed surface: edges of one triangle, of more than two, and of two on one side;
/// numbers that are none. A triangle of fewer than three points is none.
fn faults(vertices: &[CapturedVertex], by: Weld) -> Vec<String> {
    let mut faults = Vec::new();
    for vertex in vertices {
        let numbers = vertex.position.iter().chain(&vertex.normal).chain(&vertex.shading_normal);
        if !numbers.copied().all(f32::is_finite) {
            faults.push(format!("no number: {}", told(vertex)));
        }
    }
    let points = weld(vertices, by);
    let mut edges: HashMap<[u32; 2], [usize; 2]> = HashMap::with_capacity(vertices.len());
    for (triangle, &[a, b, c]) in points.as_chunks::<3>().0.iter().enumerate() {
        if a == b || b == c || c == a {
            continue;
        }
        for (edge, corners) in [([a, b], [0, 1]), ([b, c], [1, 2]), ([c, a], [2, 0])] {
            let corners = corners.map(|corner| 3 * triangle + corner);
            if let Some(other) = edges.insert(edge, corners) {
                let [one, other] = [corners, other].map(|ends| ends.map(|end| told(&vertices[end])).join(" to "));
                faults.push(format!("two triangles on one side of an edge: {one}; and {other}"));
            }
        }
    }
    let open = edges.iter().filter(|&(&[a, b], _)| !edges.contains_key(&[b, a])).map(|(_, corners)| corners);
    let mut open: Vec<[usize; 2]> = open.copied().collect();
    open.sort_unstable();
    let loose: HashSet<usize> = open.iter().flatten().copied().collect();
    for corners in open {
        let ends = corners.map(|end| {
            // The other side's, most likely.
            let away = |other: &usize| distance(&vertices[*other], &vertices[end]);
            let others = loose.iter().copied().filter(|&other| points[other] != points[end]);
            let nearest = others.min_by(|a, b| away(a).total_cmp(&away(b)).then(a.cmp(b)));
            let nearest = nearest.map_or(String::new(), |other| told(&vertices[other]));
            format!("{} (nearest: {nearest})", told(&vertices[end]))
        });
        faults.push(format!("an open edge: {}", ends.join(" to ")));
    }
    faults
}

fn distance(a: &CapturedVertex, b: &CapturedVertex) -> f32 {
    let away = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).distance(Vec3::from(b));
    away(a.position, b.position) + away(a.normal, b.normal)
}

fn told(vertex: &CapturedVertex) -> String {
    let CapturedVertex { ptex_face, uv: [u, v], level_and_kind, position, normal, .. } = vertex;
    let (level, kind) = (level_and_kind & 255, level_and_kind >> 8 & 255);
    format!("face {ptex_face} ({u}, {v}) level {level} kind {kind} at {position:?} normal {normal:?}")
}

/// Whether every edge has two faces that run opposite ways along it, and all faces are drawn.
fn is_closed(mesh: &ControlMesh) -> bool {
    let mut edges = HashSet::new();
    let mut first = 0;
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        first += sides as usize;
        if !(0..face.len()).all(|i| edges.insert([face[i], face[(i + 1) % face.len()]])) {
            return false;
        }
    }
    let makes_holes = mesh.edits.iter().any(|edit| edit.operation == EditOperation::Hole);
    edges.iter().all(|&[a, b]| edges.contains(&[b, a])) && mesh.holes.is_empty() && !makes_holes
}

/// Whether the surface has one normal at every point.
fn is_smooth(mesh: &ControlMesh) -> bool {
    let is_sharpened = |operation: EditOperation| {
        matches!(operation, EditOperation::SetEdgeSharpness(_) | EditOperation::AddEdgeSharpness(_))
    };
    mesh.creases.iter().all(|crease| crease.sharpness < INFINITE_SHARPNESS)
        && !mesh.edits.iter().any(|edit| is_sharpened(edit.operation))
}

/// The closed scenes of the repository, and the models beside it.
fn closed_meshes() -> Vec<(String, ControlMesh)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = std::fs::read_dir(&folder).expect("the scenes").map(|entry| entry.expect("a scene").path());
    let stems = files.filter(|path| path.extension().is_some_and(|extension| extension == "obj"));
    let mut names: Vec<String> =
        stems.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect();
    names.sort();
    let all = names.into_iter().map(|name| (name.clone(), scene(&name, false).0.remove(0))).chain(models());
    let mut meshes: Vec<(String, ControlMesh)> = all.filter(|(_, mesh)| is_closed(mesh)).collect();
    assert!(meshes.len() >= 38, "{} closed meshes", meshes.len());
    for (name, why) in SKIPPED {
        assert!(meshes.iter().any(|(closed, _)| closed == name), "{name} is not there");
        println!("skipped: {name}: {why}");
        meshes.retain(|(closed, _)| closed != name);
    }
    meshes.retain(|(name, _)| is_wanted(name));
    meshes
}

/// Whether what has this name is to be checked; of the empty name, whether all is.
fn is_wanted(name: &str) -> bool {
    env::var("PLANISH_SEAM_SCENES").map_or(true, |parts| parts.split(',').any(|part| name.contains(part)))
}

/// How many random eyes look at each mesh, with each selection and spacing.
fn camera_count() -> usize {
    env::var("PLANISH_SEAM_CAMERAS").map_or(1, |count| count.parse().expect("a number of cameras"))
}

/// From outside, from inside, and along the surface from close by.
fn random_camera(world: &World, random: &mut Random) -> FrameCamera {
    let [low, high] = world.bounds();
    let (middle, diagonal) = (0.5 * (low + high), (high - low).length());
    let any = |random: &mut Random| low + (high - low) * Vec3::from(std::array::from_fn(|_| random.part()));
    let (eye, target) = match random.bits() % 3 {
        0 => {
            let distance = random.between(0.55, 2.5);
            (middle + distance * diagonal * random.direction(), middle + 0.2 * (any(random) - middle))
        }
        1 => {
            let eye = middle + 0.6 * (any(random) - middle);
            (eye, eye + diagonal * random.direction())
        }
        _ => {
            let object = random.one_of(&world.objects);
            let vertex = Vec3::from(random.one_of(&world.meshes[object.mesh].positions));
            let outward = (object.to_world.transform_point3(vertex) - middle).normalize_or(Vec3::Y);
            let eye = object.to_world.transform_point3(vertex) + random.between(-0.02, 0.05) * diagonal * outward;
            (eye, eye + diagonal * outward.cross(random.direction()).normalize_or(Vec3::X))
        }
    };
    world.camera_of_angle(eye, target, random.between(30.0, 110.0), SIZE)
}

/// Values 0 or 1 at random, displacing outward: over texture coordinates if the mesh has them, else over Ptex faces.
pub fn noise(mesh: &ControlMesh, random: &mut Random) -> DisplacementMap {
    /// Segments of a Ptex face's tile.
    const SEGMENTS: u32 = 8;
    let [low, high] = mesh.bounding_box().expect("a box").map(Vec3::from);
    let (layout, [width, height]) = if mesh.face_varying.is_empty() {
        let count = mesh.ptex_face_count() as u32;
        let columns = (1..=count).find(|columns| columns * columns >= count).expect("faces");
        (DisplacementLayout::Faces, [columns, count.div_ceil(columns)].map(|count| count * (SEGMENTS + 1)))
    } else {
        (DisplacementLayout::Uv, [64, 64])
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("noise.png");
    let texels = (0..width * height).map(|_| 255 * (random.bits() >> 7 & 1) as u8).collect();
    image::GrayImage::from_raw(width, height, texels).expect("an image").save(&path).expect("a file");
    let scale = f64::from(AMPLITUDE * (high - low).length());
    let request = DisplacementRequest { layout, scale, ..DisplacementRequest::new(path) };
    let mesh = planish_scene::Mesh { control_mesh: mesh.clone(), ..planish_scene::Mesh::default() };
    load_displacement(&request, &mesh).expect("a map").0
}

/// A device, the dump passes of each spacing, and how much was checked with them.
struct Bench {
    lab: Lab,
    /// Without a level.
    desc: SurfaceDesc,
    /// Made when they are first used.
    passes: [OnceCell<DumpPasses>; 3],
    dumps: usize,
    triangles: usize,
    /// Patches and pieces drawn, of each kind.
    entries: [usize; KIND_COUNT],
    faults: Vec<String>,
}

impl Bench {
    fn new(lab: Lab, crease_patches: CreasePatches) -> Self {
        let FrameNeeds { displaced, gregory, rival, .. } = *lab.needs(Spacing::Equal);
        let method = match rival {
            Some(Rival::Acc) => SurfaceMethod::Acc,
            Some(Rival::Pm) => SurfaceMethod::Pm,
            None if gregory => SurfaceMethod::Gregory,
            None => SurfaceMethod::default(),
        };
        let desc = SurfaceDesc { method, crease_patches, displaced, ..SurfaceDesc::default() };
        Self {
            lab,
            desc,
            passes: [const { OnceCell::new() }; 3],
            dumps: 0,
            triangles: 0,
            entries: [0; KIND_COUNT],
            faults: Vec::new(),
        }
    }

    fn is_gregory(&self) -> bool {
        self.desc.method.is_one_patch_a_face()
    }

    /// Whether the method has patches for a mesh.
    fn can_draw(&self, mesh: &ControlMesh) -> bool {
        preprocess(&[mesh], &SurfaceDesc { level: 0, ..self.desc }).is_ok()
    }

    fn world(&self, name: &str, meshes: Vec<ControlMesh>, objects: Vec<ObjectDesc>, random: &mut Random) -> World {
        // Large models are detailed enough without irregularities of their own.
        let level = match meshes[0].face_sizes.len() {
            _ if self.is_gregory() => 0,
            1001.. => 2,
            _ => LEVEL,
        };
        let desc = SurfaceDesc { level, ..self.desc };
        let mut world = World::with_desc(&self.lab.device, name, meshes, objects, desc, None);
        if self.desc.displaced {
            for mesh in 0..world.meshes.len() {
                let map = noise(&world.meshes[mesh], random);
                world.displace(&self.lab.device, mesh, &map);
            }
        }
        world
    }

    /// The triangles of each object, from a random eye.
    fn dump(
        &mut self,
        world: &mut World,
        (spacing, selection): (Spacing, Selection),
        fineness: Fineness,
        random: &mut Random,
    ) -> (String, Vec<Vec<CapturedVertex>>) {
        let camera = random_camera(world, random);
        let faces: usize = world.objects.iter().map(|object| world.meshes[object.mesh].face_sizes.len()).sum();
        let mut pixels = random.between(fineness.pixels[0], fineness.pixels[1]);
        loop {
            let density = Density::EdgePixels(pixels);
            let options = FrameOptions { density, selection, culling: Culling::Off, object_lod: false };
            self.lab.run(&mut world.surface, spacing, &camera, &options);
            let entries = self.lab.unsorted_entries(&world.surface);
            let count: usize = entries.iter().flatten().map(|entry| entry.triangles as usize).sum();
            if count > fineness.triangles.max(fineness.triangles_a_face * faces) {
                pixels *= 1.3;
                continue;
            }
            self.dumps += 1;
            self.triangles += count;
            self.entries.iter_mut().zip(&entries).for_each(|(sum, entries)| *sum += entries.len());
            let passes =
                self.passes[spacing.constant() as usize].get_or_init(|| self.lab.dump_passes(&self.desc, spacing));
            let vertices = self.lab.dump(&world.surface, passes);
            let mut of_objects = vec![Vec::new(); world.objects.len()];
            let mut rest = vertices.as_slice();
            for entry in entries.iter().flatten() {
                let (own, others) = rest.split_at(3 * entry.triangles as usize);
                of_objects[entry.object as usize].extend_from_slice(own);
                rest = others;
            }
            assert!(rest.is_empty());
            let named = format!("{} {spacing:?} {selection:?} {density:?} {camera:?}", world.name);
            return (named, of_objects);
        }
    }

    /// Checks a world from as many random eyes as are asked for, with these spacings and all selections.
    fn check(&mut self, world: &mut World, spacings: &[Spacing], fineness: Fineness, random: &mut Random) {
        // Gregory patches are not selected.
        let selections = if self.is_gregory() { &SELECTIONS[..1] } else { &SELECTIONS[..] };
        let ways = spacings.iter().flat_map(|spacing| selections.iter().map(|selection| (*spacing, *selection)));
        for way in ways.flat_map(|way| std::iter::repeat_n(way, camera_count())) {
            let (named, of_objects) = self.dump(world, way, fineness, random);
            for (index, vertices) in of_objects.iter().enumerate() {
                assert!(!vertices.is_empty(), "{named}");
                // What is displaced goes one way from both sides of a sharp edge.
                let is_smooth = self.desc.displaced || is_smooth(&world.meshes[world.objects[index].mesh]);
                let welds = [Weld::Position, Weld::PositionAndNormal];
                for by in &welds[..if is_smooth { 2 } else { 1 }] {
                    let found = faults(vertices, *by);
                    if !found.is_empty() {
                        let some = found[..found.len().min(3)].join("\n  ");
                        let count = found.len();
                        self.faults.push(format!("{named}\nobject {index}, {by:?}: {count} faults\n  {some}"));
                    }
                }
            }
        }
    }

    fn finish(&self) {
        let Self { dumps, triangles, entries, .. } = self;
        println!("{dumps} dumps, {triangles} triangles, patches of each kind: {entries:?}");
        let some = self.faults[..self.faults.len().min(20)].join("\n");
        assert!(self.faults.is_empty(), "{} times not closed\n{some}", self.faults.len());
        self.lab.assert_silent();
    }
}

/// The closed meshes, each by itself; some with a face so dense that it is cut; and instances.
fn check_all(mut bench: Bench) {
    let mut meshes = closed_meshes();
    if bench.is_gregory() {
        meshes.retain(|(_, mesh)| mesh.edits.is_empty());
    }
    let cut = if bench.is_gregory() { CUT_GREGORY } else { CUT };
    for (name, mesh) in meshes {
        let mut random = Random::named(&name);
        if let Some(turn) = cut.iter().position(|cut| *cut == name) {
            // Beside a dense face patches are cut that have edges of one segment.
            let mut uneven = mesh.clone();
            uneven.density = vec![0.0; mesh.positions.len()];
            dense_face(&mesh).iter().for_each(|&corner| uneven.density[corner as usize] = 1.0);
            let mut world = bench.world(&name, vec![uneven], vec![ObjectDesc::identity(0)], &mut random);
            let fineness = if bench.is_gregory() { FINEST } else { FINE };
            bench.check(&mut world, &SPACINGS[turn..=turn], fineness, &mut random);
        }
        let mut world = bench.world(&name, vec![mesh], vec![ObjectDesc::identity(0)], &mut random);
        bench.check(&mut world, &SPACINGS, MODERATE, &mut random);
    }
    if is_wanted("instances") {
        let mut random = Random(17);
        let (meshes, objects) = instances();
        assert!(meshes.iter().all(is_closed) && objects.iter().any(ObjectDesc::is_mirrored));
        let mut world = bench.world("instances", meshes, objects, &mut random);
        bench.check(&mut world, &SPACINGS, MODERATE, &mut random);
    }
    bench.finish();
    if is_wanted("") {
        // Closed meshes of regular faces alone are few, and none of them is cut.
        let is_rare = |kind: PatchKind| bench.is_gregory() && kind == PatchKind::Cut;
        for &kind in PatchKind::of_method(bench.desc.method, bench.desc.end_cap).iter().filter(|&&kind| !is_rare(kind))
        {
            assert!(bench.entries[kind as usize] > 20, "{kind:?}: {:?}", bench.entries);
        }
    }
}

/// The corners of a triangle of a mesh, if it has one, else of a quad.
fn dense_face(mesh: &ControlMesh) -> &[u32] {
    let triangle = mesh.face_sizes.iter().position(|&sides| sides == 3).unwrap_or(0);
    let first: u32 = mesh.face_sizes[..triangle].iter().sum();
    &mesh.face_vertices[first as usize..][..mesh.face_sizes[triangle] as usize]
}

/// Closed meshes turned, scaled by other factors along each axis, and mirrored.
fn instances() -> (Vec<ControlMesh>, Vec<ObjectDesc>) {
    let meshes = ["mixed_triangles_quads", "uv_torus", "crease_2_3"].map(|name| scene(name, false).0.remove(0));
    let mut random = Random(3);
    let object = |index: usize| {
        let signs = [1.0, if index.is_multiple_of(2) { 1.0 } else { -1.0 }, 1.0];
        let scale = Vec3::from(signs.map(|sign: f32| sign * random.between(0.3, 2.0)));
        let turn = Quat::from_axis_angle(random.direction(), random.between(0.0, 6.0));
        let to_world = Affine3A::from_scale_rotation_translation(scale, turn, 4.0 * random.direction());
        ObjectDesc { to_world, ..ObjectDesc::identity(index % 3) }
    };
    (meshes.to_vec(), (0..6).map(object).collect())
}

#[test]
fn closed_meshes_are_closed_to_the_bit() {
    check_all(Bench::new(Lab::new(), CreasePatches::default()));
}

#[test]
fn closed_meshes_of_gregory_patches_are_closed_to_the_bit() {
    check_all(Bench::new(Lab::gregory(), CreasePatches::default()));
}

#[test]
fn closed_meshes_of_acc_and_pm_patches_are_closed_to_the_bit() {
    for rival in [Rival::Acc, Rival::Pm] {
        let mut bench = Bench::new(Lab::of_rival(rival), CreasePatches::default());
        let mut meshes = closed_meshes();
        meshes.retain(|(_, mesh)| bench.can_draw(mesh));
        assert!(meshes.len() > 5 || !is_wanted(""), "{} closed meshes of quads", meshes.len());
        for (name, mesh) in meshes {
            let mut random = Random::named(&name);
            if name == "cube" {
                let mut uneven = mesh.clone();
                uneven.density = vec![0.0; mesh.positions.len()];
                dense_face(&mesh).iter().for_each(|&corner| uneven.density[corner as usize] = 1.0);
                let mut world = bench.world(&name, vec![uneven], vec![ObjectDesc::identity(0)], &mut random);
                bench.check(&mut world, &[Spacing::FractionalOdd], FINEST, &mut random);
            }
            let mut world = bench.world(&name, vec![mesh], vec![ObjectDesc::identity(0)], &mut random);
            bench.check(&mut world, &SPACINGS, MODERATE, &mut random);
        }
        bench.finish();
        for kind in [PatchKind::Gregory, PatchKind::GregoryCut] {
            assert!(bench.entries[kind as usize] > 20 || !is_wanted(""), "{kind:?}: {:?}", bench.entries);
        }
    }
}

#[test]
fn displaced_closed_meshes_of_gregory_patches_are_closed_to_the_bit() {
    check_all(Bench::new(Lab::displaced_gregory(), CreasePatches::default()));
}

#[test]
fn displaced_closed_meshes_are_closed_to_the_bit() {
    check_all(Bench::new(Lab::displaced(), CreasePatches::default()));
}

#[test]
fn closed_meshes_with_patches_for_creases_are_closed_to_the_bit() {
    let mut bench = Bench::new(Lab::new(), CreasePatches::Single);
    let creased =
        |(_, mesh): &(String, ControlMesh)| mesh.creases.iter().any(|crease| crease.sharpness < INFINITE_SHARPNESS);
    for (name, mesh) in closed_meshes().into_iter().filter(creased) {
        let mut random = Random::named(&name);
        let mut world = bench.world(&name, vec![mesh], vec![ObjectDesc::identity(0)], &mut random);
        bench.check(&mut world, &[Spacing::FractionalOdd], MODERATE, &mut random);
    }
    bench.finish();
}

#[test]
fn patches_by_themselves_leave_cracks() {
    let lab = Lab::with_needs(|spacing| FrameNeeds { watertight: false, ..FrameNeeds::all(spacing) });
    let mut bench = Bench::new(lab, CreasePatches::default());
    let mut random = Random(1);
    let mesh = scene("adjacent_extraordinary", false).0.remove(0);
    let mut world = bench.world("adjacent_extraordinary", vec![mesh], vec![ObjectDesc::identity(0)], &mut random);
    let (_, of_objects) = bench.dump(&mut world, (Spacing::FractionalOdd, Selection::Dynamic), MODERATE, &mut random);
    let found = faults(&of_objects[0], Weld::Position);
    assert!(found.iter().any(|fault| fault.starts_with("an open edge")), "{found:?}");
    bench.lab.assert_silent();
}
