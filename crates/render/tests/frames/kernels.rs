//! Compute kernels against their CPU twins, bit for bit.

use std::collections::HashSet;

use glam::Vec3;
use planish_gpu::Encoder;
use planish_render::lists::{CHUNK, LIST_ACTIVE, LIST_BASE, LIST_CUT, LIST_LEAVES, LIST_MIDDLES, LIST_PATCHES};
use planish_render::lists::{LEVEL_COUNT, LIST_ROOTS, LIST_VERTICES};
use planish_render::{
    Culling, Density, FrameCamera, FrameNeeds, FrameOptions, FrameStages, ObjectDesc, PatchKind, Selection, Spacing,
    Status, Surface, SurfaceDesc, SurfaceMethod, limit, preprocess, subdivide,
};
use planish_subdiv::selection::{Cut, PatchCounts};
use planish_subdiv::tables::IrregularFace;
use planish_subdiv::topology::NONE;

use crate::lab::{Lab, SPACINGS};
use crate::twin::Twin;
use crate::world::{World, scene};

/// Every kind of feature; with the level that faces are refined to at most.
const SCENES: [(&str, u32); 16] = [
    ("adjacent_extraordinary", 6),
    ("boundary_valences", 4),
    ("valence_40", 5),
    ("ngon_40", 5),
    ("nonmanifold_book_5", 6),
    ("nonmanifold_sectors", 6),
    ("edit_footprints", 3),
    ("edit_hole_ngon", 6),
    ("hole_ngon", 0),
    ("crease_mixed_3", 6),
    ("mixed_triangles_quads", 7),
    ("cube_all_semisharp", 6),
    ("edit_vertex_layers", 6),
    ("smooth_triangles_creased", 5),
    ("chaikin_crossing", 6),
    ("several.json", 5),
];
const SIZE: [u32; 2] = [96, 64];
/// The last has more segments than the tessellator makes.
const DENSITIES: [Density; 3] = [Density::EdgePixels(16.0), Density::EdgePixels(4.0), Density::Tess(100.0)];
const CULLINGS: [Culling; 3] = [Culling::Off, Culling::Unseen, Culling::UnseenAndBacks];

/// What the frames together had.
#[derive(Debug, Default)]
struct Found {
    entries: [usize; 4],
    counts: [u32; 3],
    truncated: u32,
    objects_left_out: usize,
    faces_unseen: usize,
}

/// A frame, and all that is known of it.
struct Frame<'a> {
    lab: &'a Lab,
    world: &'a World,
    status: &'a Status,
    twin: &'a Twin,
    named: String,
}

/// What is drawn here.
const KINDS: &[PatchKind] = PatchKind::ALL.split_at(4).0;

impl Frame<'_> {
    fn check(&self, found: &mut Found) {
        self.check_densities();
        self.check_selection(found);
        self.check_points();
        self.check_entries(found);
    }

    fn check_densities(&self) {
        let all = self.world.surface.download_densities(&self.lab.device).expect("densities");
        for (object, twin) in self.world.surface.objects().iter().zip(&self.twin.objects) {
            let Some(expected) = twin.slot_densities() else { continue };
            let mut slots = all[object.first_slot as usize..][..object.slot_count as usize].to_vec();
            slots[object.vertex_count as usize..].iter_mut().for_each(|slot| slot.outside = 0);
            assert_eq!(slots, expected, "densities: {}", self.named);
        }
        assert_eq!(self.status.density(), self.twin.density, "largest density: {}", self.named);
    }

    fn check_selection(&self, found: &mut Found) {
        let (surface, heads) = (&self.world.surface, &self.status.heads);
        let objects = || surface.objects().iter().zip(&self.twin.objects);
        let chunks = |of: fn(&planish_shaders::Object) -> u32| {
            let seen = objects().filter(|(_, twin)| twin.cut.is_some());
            seen.map(|(object, _)| of(object).div_ceil(CHUNK)).sum::<u32>()
        };
        let known = |of: fn(&planish_shaders::Object) -> u32| {
            let known = objects().filter(|(_, twin)| twin.densities.is_some());
            known.map(|(object, _)| of(object).div_ceil(CHUNK)).sum::<u32>()
        };
        let patches: usize = self.twin.cuts().map(|cut| cut.patches.len()).sum();
        let leaves: usize = self.twin.cuts().map(|cut| cut.leaves.len()).sum();
        for (list, count) in [
            (LIST_VERTICES, known(|object| object.vertex_count)),
            (LIST_MIDDLES, known(|object| object.slot_count - object.vertex_count)),
            (LIST_ROOTS, chunks(|object| object.root_count)),
            (LIST_BASE, chunks(|object| object.patch_count)),
            (LIST_PATCHES, patches as u32),
            (LIST_LEAVES, leaves as u32),
        ] {
            assert_eq!(heads[list].count, count, "list {list}: {}", self.named);
        }
        let mut active = [0_u32; LEVEL_COUNT];
        for face in self.twin.cuts().flat_map(|cut| &cut.refined) {
            let face = &surface.tables().irregular[*face as usize];
            let finer = face.children.iter().filter(|&&child| child != NONE && child & IrregularFace::IRREGULAR != 0);
            active[usize::from(face.info.level) + 1] += finer.count() as u32;
        }
        for (level, count) in active.into_iter().enumerate().skip(1) {
            assert_eq!(heads[LIST_ACTIVE + level].count, count, "faces of level {level}: {}", self.named);
        }
        let truncated = self.twin.cuts().map(|cut| cut.truncated).sum::<u32>();
        assert_eq!(self.status.counts.truncated, truncated, "{}", self.named);
        found.truncated += truncated;
        found.objects_left_out += self.twin.objects.iter().filter(|twin| twin.cut.is_none()).count();
        found.faces_unseen += self.twin.cuts().map(|cut| self.unseen_faces(cut)).sum::<usize>();
    }

    /// Faces that are refined though they cannot be seen.
    fn unseen_faces(&self, cut: &Cut) -> usize {
        let is_unseen = |face: &&u32| {
            let children = self.world.surface.tables().irregular[**face as usize].children;
            let mut patches = children.iter().filter(|&&child| child & IrregularFace::IRREGULAR == 0);
            patches.next().is_some_and(|patch| cut.patches.binary_search(patch).is_err())
        };
        cut.refined.iter().filter(is_unseen).count()
    }

    /// Which rows and limit points are in use, and what they hold.
    fn check_points(&self) {
        let surface = &self.world.surface;
        let sorted = |mut all: Vec<u32>| {
            all.sort_unstable();
            all.dedup();
            all
        };
        let rows = sorted(self.twin.cuts().flat_map(|cut| cut.rows.iter().flatten().flatten().copied()).collect());
        let limits = sorted(self.twin.cuts().flat_map(|cut| cut.limits.iter().copied()).collect());
        let in_use = surface.download_rows_in_use(&self.lab.device).expect("rows");
        let phases = surface.phases();
        for (phase, &[first, count]) in phases.rows[..phases.limits()].iter().enumerate() {
            let of_phase: Vec<u32> = rows.iter().copied().filter(|row| (first..first + count).contains(row)).collect();
            assert_eq!(in_use[phase], of_phase, "rows of phase {phase}: {}", self.named);
        }
        assert_eq!(in_use[phases.limits()], limits, "limit points: {}", self.named);
        let points = surface.download_points(&self.lab.device).expect("points");
        let first = surface.tables().cage_point_count;
        for place in (0..first).chain(rows.iter().map(|row| first + row)) {
            assert_eq!(points[place as usize], self.twin.points[place as usize], "point {place}: {}", self.named);
        }
        let found = surface.download_limits(&self.lab.device).expect("limit points");
        for place in limits.into_iter().map(|place| place as usize..place as usize + 1) {
            self.lab.assert_limits(&found[place.clone()], &self.twin.limits[place], &self.named);
        }
    }

    fn check_entries(&self, found: &mut Found) {
        let entries = self.lab.entries(&self.world.surface);
        for &kind in KINDS {
            let (entries, expected) = (&entries[kind as usize], &self.twin.entries[kind as usize]);
            assert_eq!(entries, expected, "{kind:?} patches: {}", self.named);
            found.entries[kind as usize] += entries.len();
        }
        let tables = self.world.surface.tables();
        let mut drawn = [PatchCounts::default(); LEVEL_COUNT];
        for &kind in KINDS {
            let mut last = None;
            for entry in &entries[kind as usize] {
                if last.replace((entry.object, entry.place)) == Some((entry.object, entry.place)) {
                    continue;
                }
                let level = match kind {
                    PatchKind::Filling => tables.irregular[entry.place as usize].info.level,
                    _ => tables.patches[entry.place as usize].info.level,
                };
                let counts = &mut drawn[usize::from(level)];
                match kind {
                    PatchKind::Filling => counts.filling += 1,
                    _ if entry.flags & 15 != 0 => counts.transition += 1,
                    _ => counts.regular += 1,
                }
            }
        }
        let counts = self.status.patch_counts(LEVEL_COUNT);
        // Patches that are cut count even if no piece of them is seen.
        let cut: HashSet<_> = entries[3].iter().map(|entry| (entry.object, entry.place)).collect();
        let unseen = self.status.heads[LIST_CUT].count - cut.len() as u32;
        let mut excess = 0;
        for (level, (counts, drawn)) in counts.iter().zip(&drawn).enumerate() {
            assert_eq!(counts.filling, drawn.filling, "level {level}: {}", self.named);
            assert!(counts.regular >= drawn.regular && counts.transition >= drawn.transition, "{}", self.named);
            excess += counts.regular - drawn.regular + counts.transition - drawn.transition;
            found.counts[0] += counts.regular;
            found.counts[1] += counts.transition;
            found.counts[2] += counts.filling;
        }
        assert_eq!(excess, unseen, "patches of all levels: {}", self.named);
    }
}

/// Frames from all cameras at all densities, culled in all ways; spacings and selections in turn.
fn check_world(lab: &Lab, world: &mut World, turn: usize, found: &mut Found) {
    for (c, camera) in world.cameras(SIZE).into_iter().enumerate() {
        for (d, &density) in DENSITIES.iter().enumerate() {
            for (k, &culling) in CULLINGS.iter().enumerate() {
                let spacing = SPACINGS[(c + d + k + turn) % 3];
                let selection = if (c + k + turn).is_multiple_of(2) { Selection::Dynamic } else { Selection::Static };
                let options =
                    FrameOptions { density, selection, culling, object_lod: (c + d + turn).is_multiple_of(8) };
                check_frame(lab, world, (c + d + k, spacing), &camera, &options, found);
            }
        }
    }
}

fn check_frame(
    lab: &Lab,
    world: &mut World,
    (number, spacing): (usize, Spacing),
    camera: &FrameCamera,
    options: &FrameOptions,
    found: &mut Found,
) {
    world.move_cages(number);
    let status = lab.run(&mut world.surface, spacing, camera, options);
    let twin = Twin::new(lab, world, spacing, camera, options);
    let named = format!("{} from {} {spacing:?} {options:?}", world.name, camera.eye());
    Frame { lab, world, status: &status, twin: &twin, named }.check(found);
}

#[test]
fn kernels_equal_their_twins_bit_for_bit() {
    let lab = Lab::new();
    let mut found = Found::default();
    for (turn, (name, level)) in SCENES.into_iter().enumerate() {
        check_world(&lab, &mut World::of_scene(&lab.device, name, level, turn % 2 == 0), turn, &mut found);
    }
    println!("{found:?}");
    assert!(found.entries.iter().all(|&count| count > 10_000), "{found:?}");
    assert!(found.counts.iter().all(|&count| count > 10_000), "{found:?}");
    assert!(found.truncated > 1000 && found.faces_unseen > 1000, "{found:?}");
    lab.assert_silent();
}

#[test]
fn kernels_equal_their_twins_for_objects_that_are_turned_scaled_mirrored_and_out_of_view() {
    let lab = Lab::new();
    let mut found = Found::default();
    let mut world = World::of_objects(&lab.device, 5, None);
    check_world(&lab, &mut world, 0, &mut found);
    check_world(&lab, &mut world, 1, &mut found);
    assert!(found.entries.iter().all(|&count| count > 1000), "{found:?}");
    assert!(found.objects_left_out > 40 && found.truncated > 100, "{found:?}");
    lab.assert_silent();
}

#[test]
fn uniform_points_and_limit_points_equal_their_twins_bit_for_bit() {
    let lab = Lab::new();
    for name in ["ngon_5", "boundary_none", "crease_2_3"] {
        let mut mesh = scene(name, false).0.remove(0);
        let desc = SurfaceDesc { method: SurfaceMethod::Uniform, level: 3, ..SurfaceDesc::default() };
        let made = preprocess(&[&mesh], &desc).expect("tables");
        let objects = [ObjectDesc::identity(0)];
        let mut surface = Surface::new(&lab.device, &[&mesh], &objects, desc, made).expect("upload");
        let stages = FrameStages::new(&lab.device, &FrameNeeds::all(Spacing::Equal)).expect("pipelines");
        let mut encoder = Encoder::new(&lab.device, "points").expect("encoder");
        stages.record(&mut encoder, &surface);
        let recorded = encoder.finish().expect("recording");
        // Twice with different cages: every frame starts from its own.
        for _ in 0..2 {
            mesh.positions.iter_mut().for_each(|p| *p = [p[0] + 0.25 * p[1], p[1], p[2] - 0.25]);
            surface.set_cage(0, &mesh.positions).expect("cage");
            lab.device.submit_and_wait(&recorded).expect("submission");
            let points = subdivide::subdivide(surface.tables(), &mesh.positions);
            assert_eq!(surface.download_points(&lab.device).expect("points"), points);
            let limits = limit::limit(surface.tables(), &points);
            lab.assert_limits(&surface.download_limits(&lab.device).expect("limits"), &limits, name);
        }
    }
    lab.assert_silent();
}

#[test]
fn an_object_is_where_its_cage_is_and_not_where_it_was() {
    let lab = Lab::new();
    let mut world = World::of_scene(&lab.device, "ngon_5", 3, false);
    let [low, high] = world.bounds();
    let shift = 40.0 * (high - low).length() * Vec3::X;
    for position in &mut world.meshes[0].positions {
        *position = (Vec3::from(*position) + shift).to_array();
    }
    world.surface.set_cage(0, &world.meshes[0].positions).expect("cage");
    let camera = world.camera_from(([1.0, 0.6, 1.2], 1.1), SIZE);
    let options = FrameOptions { culling: Culling::Unseen, ..FrameOptions::default() };
    lab.run(&mut world.surface, Spacing::Equal, &camera, &options);
    assert!(lab.entries(&world.surface).iter().flatten().count() > 20, "nothing is seen");
    lab.assert_silent();
}
