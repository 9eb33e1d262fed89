//! Cuts of the irregular faces: balanced, complete and small, whatever the densities.

use std::collections::{HashMap, HashSet};

use planish_generate::random::Random;
use planish_subdiv::ControlMesh;
use planish_subdiv::eval::Evaluator;
use planish_subdiv::mesh::{BoundaryInterpolation, Corner, EditOperation, HierarchicalEdit};
use planish_subdiv::patch::PatchInfo;
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::selection::{Cut, PatchCounts, Selection, SlotDensities, deepest_cut, density_rings, select};
use planish_subdiv::tables::{NGON, Tables};
use planish_subdiv::topology::NONE;

use crate::cages::{cone, cube, merged, pole, prism, random, seamed, sheet};

/// Random cages, each with several densities.
const CAGE_COUNT: u64 = 400;

pub fn tables(mesh: &ControlMesh, max_level: u32) -> Tables {
    tables_with(mesh, max_level, CreasePatches::default())
}

fn tables_with(mesh: &ControlMesh, max_level: u32, crease_patches: CreasePatches) -> Tables {
    let options = RefineOptions { max_level, crease_patches, ..RefineOptions::default() };
    Tables::new(&Refinement::new(mesh, options).expect("a legal cage"))
}

fn all_visible(tables: &Tables, density: &[f32]) -> SlotDensities {
    density_rings(tables, &tables.ranges(), density, &vec![0; density.len()])
}

/// The dynamic cut of all of some tables.
fn cut(tables: &Tables, density: &[f32]) -> Cut {
    select(tables, &tables.ranges(), &all_visible(tables, density), Selection::Dynamic)
}

/// Densities that differ by little or by a lot.
pub fn densities(kind: u64, count: usize, random: &mut Random) -> Vec<f32> {
    let spike = random.below(count);
    let any = |random: &mut Random, exponents: f64| 10.0_f64.powf(exponents * random.unit()) as f32;
    match kind {
        0 => vec![any(random, 2.0); count],
        1 => (0..count).map(|vertex| if vertex == spike { 1e4 } else { 0.5 }).collect(),
        2 => (0..count).map(|_| any(random, 4.0)).collect(),
        3 => (0..count).map(|_| if random.percent(10) { 3.0 } else { 1.0 }).collect(),
        4 => (0..count).map(|_| if random.percent(30) { 3.0 * 4.0 } else { 4.0 }).collect(),
        5 => (0..count).map(|_| 1.0 + random.unit() as f32 * 3.0).collect(),
        // On both sides of what is refined alone, and of what the faces around refine.
        6 => (0..count).map(|_| random.pick(&[1.0, 1.0, 1.0, 2.99, 3.01, 4.5])).collect(),
        _ => (0..count).map(|_| random.pick(&[1.0, 2.99])).collect(),
    }
}

/// What is drawn, with its split edges.
fn drawn(tables: &Tables, cut: &Cut) -> Vec<(PatchInfo, u8)> {
    let split_edges: HashSet<u32> = cut.split_edges.iter().copied().collect();
    let level_0 = tables.patch_ranges[0].clone();
    let patches = level_0.chain(cut.patches.iter().copied()).map(|place| {
        let patch = &tables.patches[place as usize];
        (patch.info, (0..4).fold(0, |mask, i| mask | u8::from(split_edges.contains(&patch.edges[i])) << i))
    });
    let leaves = cut.leaves.iter().map(|leaf| (tables.irregular[leaf.face as usize].info, leaf.split));
    patches.chain(leaves).collect()
}

/// Units along a side of a Ptex face, or along an edge of the cage.
const SIDE: u64 = 1 << 20;

/// A line that edges of drawn faces lie on: within a Ptex face, on an edge of the cage, or from the middle of an edge to
/// that of an n-gon.
type Line = (u8, u32, u32, u64);

/// The line of an edge of a drawn face, where it begins there and how long it is.
fn segment(tables: &Tables, info: &PatchInfo, edge: usize) -> (Line, u64, u64) {
    let l = info.location;
    let length = SIDE >> l.depth;
    let (u, v) = (u64::from(l.u) * length, u64::from(l.v) * length);
    let (is_along_u, across, start) =
        [(true, v, u), (false, u + length, v), (true, v + length, u), (false, u, v)][edge];
    let corners = tables.ptex_faces[l.ptex_face as usize];
    let is_ngon = corners[2] & NGON != 0;
    let on_cage = |ends: [usize; 2]| {
        let [a, b] = ends.map(|i| corners[i]);
        let (start, length) = if is_ngon { (start / 2, length / 2) } else { (start, length) };
        let start = if a < b { start } else { SIDE - start - length };
        ((1, a.min(b), a.max(b), 0), start, length)
    };
    match (is_along_u, across) {
        (true, 0) => on_cage([0, 1]),
        (false, 0) => on_cage([0, 3]),
        (true, SIDE) if !is_ngon => on_cage([3, 2]),
        (false, SIDE) if !is_ngon => on_cage([1, 2]),
        (_, SIDE) => {
            let other = corners[if is_along_u { 3 } else { 1 }];
            let (low, high) = (corners[0].min(other), corners[0].max(other));
            ((2, low, high, u64::from(corners[2])), start, length)
        }
        _ => ((u8::from(is_along_u) + 3, l.ptex_face, 0, across), start, length),
    }
}

/// Every edge of what is drawn has the same edge across, or two halves of it, and then knows so.
fn assert_balanced(tables: &Tables, cut: &Cut, has_holes: bool) {
    let mut lines: HashMap<Line, Vec<(u64, u64, bool)>> = HashMap::new();
    for (info, split) in drawn(tables, cut) {
        for edge in 0..4 {
            let (line, start, length) = segment(tables, &info, edge);
            lines.entry(line).or_default().push((start, length, split >> edge & 1 != 0));
        }
    }
    for (line, edges) in &lines {
        for &(start, length, is_split) in edges {
            let within =
                |other: &&(u64, u64, bool)| other.0 < start + length && start < other.0 + other.1 && other.1 < length;
            let shorter: Vec<u64> = edges.iter().filter(within).map(|other| other.1).collect();
            assert!(shorter.iter().all(|&other| 2 * other == length), "{line:?}: {edges:?}");
            let has_shorter = !shorter.is_empty();
            assert!(is_split == has_shorter || is_split && has_holes, "{line:?}: {edges:?}");
        }
    }
}

/// Area that is drawn of each Ptex face; nothing overlaps.
fn areas(tables: &Tables, cut: &Cut) -> Vec<f64> {
    let mut areas = vec![0.0; tables.ptex_faces.len()];
    let infos = drawn(tables, cut).into_iter().map(|(info, _)| info.location);
    let locations: Vec<_> = infos.map(|l| (l.ptex_face, l.u, l.v, l.depth)).collect();
    let all: HashSet<_> = locations.iter().copied().collect();
    assert_eq!(all.len(), locations.len(), "a face is drawn twice");
    for &(ptex_face, u, v, depth) in &locations {
        areas[ptex_face as usize] += (-2.0 * f64::from(depth)).exp2();
        for above in 1..=depth {
            assert!(
                !all.contains(&(ptex_face, u >> above, v >> above, depth - above)),
                "a face and its child are drawn"
            );
        }
    }
    areas
}

fn indices_of(row: planish_subdiv::stencil::StencilRow, indices: &[u32]) -> &[u32] {
    &indices[row.first_index as usize..][..row.count as usize]
}

/// Numbers of points in use and of those needed; whatever is drawn or in use reads only points in use.
fn assert_complete(tables: &Tables, cut: &Cut) -> [usize; 2] {
    let mut in_use = vec![false; tables.point_count() as usize];
    in_use[..tables.cage_point_count as usize].fill(true);
    let rows: Vec<u32> = cut.rows.iter().flatten().flatten().copied().collect();
    rows.iter().for_each(|&row| in_use[(row + tables.cage_point_count) as usize] = true);
    for &row in &rows {
        let read = indices_of(tables.stencils.rows[row as usize], &tables.stencils.indices);
        assert!(read.iter().all(|&point| in_use[point as usize]), "row {row} reads a point that is not made");
    }
    let mut needed: HashSet<u32> = HashSet::new();
    for &patch in &cut.patches {
        needed.extend(tables.patches[patch as usize].points);
    }
    let mut limits: HashSet<u32> = HashSet::new();
    for leaf in &cut.leaves {
        let face = &tables.irregular[leaf.face as usize];
        limits.extend(face.limits);
        limits.extend((0..4).filter(|i| leaf.split >> i & 1 != 0).map(|i| face.midpoints[i]));
    }
    assert!(!limits.contains(&NONE), "a limit point is missing");
    // Corners of patches that others share.
    for patch in tables.patch_ranges[0].clone().chain(cut.patches.iter().copied()) {
        let seams = tables.seams.get(tables.patches[patch as usize].seams as usize);
        limits.extend(seams.into_iter().flat_map(|seams| seams.limits).filter(|&limit| limit != NONE));
    }
    let mut sorted: Vec<u32> = limits.into_iter().collect();
    sorted.sort_unstable();
    assert_eq!(sorted, cut.limits);
    for &limit in &cut.limits {
        needed.extend(indices_of(tables.limits.rows[limit as usize], &tables.limits.indices));
    }
    assert!(needed.iter().all(|&point| in_use[point as usize]), "a point that is drawn is not made");
    let mut stack: Vec<u32> = needed.iter().copied().collect();
    while let Some(point) = stack.pop() {
        if let Some(row) = point.checked_sub(tables.cage_point_count) {
            let read = indices_of(tables.stencils.rows[row as usize], &tables.stencils.indices);
            stack.extend(read.iter().filter(|&&point| needed.insert(point)));
        }
    }
    let needed = needed.iter().filter(|&&point| point >= tables.cage_point_count).count();
    [rows.len(), needed]
}

#[test]
fn neighbours_differ_by_a_level_and_every_point_in_use_is_made() {
    let (mut in_use, mut needed, mut worst) = (0, 0, (1.0_f64, 0));
    for seed in 0..CAGE_COUNT {
        let mesh = if seed % 3 == 1 { seamed(random(seed), seed) } else { random(seed) };
        let mut generator = Random::new(seed);
        let crease_patches = generator.pick(&[CreasePatches::None, CreasePatches::Infinite, CreasePatches::Single]);
        let tables = tables_with(&mesh, [0, 1, 3, 6][seed as usize % 4], crease_patches);
        let has_hole_edits = mesh.edits.iter().any(|edit| edit.operation == EditOperation::Hole);
        let has_holes =
            has_hole_edits || !mesh.holes.is_empty() || mesh.options.boundary == BoundaryInterpolation::None;
        let full = areas(&tables, &deepest_cut(&tables, &tables.ranges()));
        let mut evaluator = Evaluator::new(&mesh).expect("a legal cage");
        for (ptex_face, &area) in (0..).zip(&full).filter(|_| !has_hole_edits) {
            let is_drawn = evaluator.evaluate(ptex_face, 0.3, 0.6).is_some();
            assert!((area - f64::from(u8::from(is_drawn))).abs() < 1e-12, "seed {seed}, Ptex face {ptex_face}: {area}");
        }
        for kind in 0..8 {
            let density = densities(kind, mesh.positions.len(), &mut generator);
            let cut = cut(&tables, &density);
            assert_balanced(&tables, &cut, has_holes);
            assert_eq!(areas(&tables, &cut), full, "seed {seed}, densities {kind}");
            let counts = assert_complete(&tables, &cut);
            (in_use, needed) = (in_use + counts[0], needed + counts[1]);
            let ratio = counts[0] as f64 / counts[1].max(1) as f64;
            if ratio > worst.0 {
                worst = (ratio, seed);
            }
        }
    }
    println!("points in use {in_use}, needed {needed}: {}; worst {worst:?}", in_use as f64 / needed as f64);
    assert!(in_use as f64 <= 1.25 * needed as f64);
}

#[test]
fn the_mean_of_an_n_gon_does_not_surprise_the_faces_around() {
    for n in [3, 5, 6, 8, 9, 40] {
        // One side of the prism is barely a leaf by its own corners; the others make the mean of the n-gon as large as can be.
        let mesh = prism(n);
        let tables = tables(&mesh, 6);
        for other in [1.9, 2.01, 2.5, 2.99, 3.01, 5.0] {
            let density: Vec<f32> = (0..2 * n).map(|vertex| if vertex % n < 2 { 1.0 } else { other }).collect();
            let cut = cut(&tables, &density);
            assert_balanced(&tables, &cut, false);
            assert_complete(&tables, &cut);
        }
    }
}

#[test]
fn culled_faces_leave_all_points_of_the_others() {
    for seed in 0..CAGE_COUNT {
        let mesh = random(seed);
        let mut random = Random::new(seed);
        let tables = tables(&mesh, [0, 1, 4][seed as usize % 3]);
        let ranges = tables.ranges();
        for kind in 0..4 {
            let density = densities(kind, mesh.positions.len(), &mut random);
            let outside: Vec<u32> = mesh.positions.iter().map(|p| u32::from(p[0] > 0.1 * kind as f32)).collect();
            let slots = density_rings(&tables, &ranges, &density, &outside);
            let some = select(&tables, &ranges, &slots, Selection::Dynamic);
            let all = cut(&tables, &density);
            assert_complete(&tables, &some);
            assert_eq!((&some.refined, &some.split_edges), (&all.refined, &all.split_edges));
            assert!(some.leaves.iter().all(|leaf| all.leaves.contains(leaf)));
            assert!(some.patches.iter().all(|patch| all.patches.binary_search(patch).is_ok()));
        }
    }
}

#[test]
fn a_face_is_culled_only_if_all_that_shapes_it_is_outside() {
    // A strip of quads, all of them irregular; a face reads the faces that touch it.
    let mut mesh = sheet(12, 1);
    mesh.corners = (0..26).map(|vertex| Corner { vertex, sharpness: 3.5 }).collect();
    let tables = tables(&mesh, 3);
    let drawn_with = |outside: &[u32]| {
        let slots = density_rings(&tables, &tables.ranges(), &[1.0; 26], outside);
        let cut = select(&tables, &tables.ranges(), &slots, Selection::Dynamic);
        assert!(cut.stars.is_empty());
        cut.leaves.iter().map(|leaf| leaf.face).collect::<Vec<u32>>()
    };
    assert_eq!(drawn_with(&[0; 26]), (0..12).collect::<Vec<u32>>());
    assert!(drawn_with(&[3; 26]).is_empty());
    // Of two planes, each with some vertex of it inside, none culls a face.
    let halves: Vec<u32> = (0..26).map(|vertex| if vertex % 13 < 6 { 1 } else { 2 }).collect();
    assert_eq!(drawn_with(&halves), [4, 5, 6]);
    let mut all_but_one = [1; 26];
    all_but_one[0] = 0;
    assert_eq!(drawn_with(&all_but_one), [0, 1]);
}

#[test]
fn an_n_gon_is_culled_as_its_whole_one_ring() {
    for n in [3, 5, 8, 9, 40] {
        // One vertex inside: of the far n-gon all corners are neighbours of the near one's.
        let mesh = prism(n);
        let tables = tables(&mesh, 2);
        let mut outside = vec![1; mesh.positions.len()];
        let slots = density_rings(&tables, &tables.ranges(), &vec![1.0; 2 * n as usize], &outside);
        assert!(slots.ring_outside.iter().all(|&outside| outside == 1));
        outside[0] = 0;
        let slots = density_rings(&tables, &tables.ranges(), &vec![1.0; 2 * n as usize], &outside);
        assert!(slots.ring_outside[2 * n as usize..].iter().all(|&outside| outside == 0));
    }
}

#[test]
fn rings_are_the_largest_densities_around() {
    for n in [3, 4, 5, 8, 9, 40] {
        let mesh = prism(n);
        let tables = tables(&mesh, 2);
        let mut density = vec![1.0; mesh.positions.len()];
        density[2] = 8.0;
        let slots = all_visible(&tables, &density);
        let wide = if n > 4 { 12.0 } else { 8.0 };
        // Vertices of the n-gon with the dense one, across from it, and away from it.
        assert_eq!((slots.ring[0], slots.ring[2]), (wide, wide));
        let across = [n + 1, n + 2, n + 3].map(|v| if v < 2 * n { v } else { v - n });
        assert!(across.iter().all(|&v| slots.ring[v as usize] == 8.0));
        if n > 4 {
            assert_eq!(slots.ring[n as usize], 1.5);
        }
        if n != 4 {
            let ngons = 2 * n as usize;
            assert_eq!(slots.ring[ngons..], [wide, if n > 4 { 1.5 } else { 1.0 }]);
            assert_eq!(slots.density[ngons..], [(7.0 + n as f32) / n as f32, 1.0]);
        }
    }
}

/// A density that asks for so many levels.
fn density_of_depth(depth: u32) -> f32 {
    0.9 * (1_u32 << depth) as f32
}

#[test]
fn an_isolated_vertex_has_the_theorys_counts_at_any_depth() {
    for n in [3, 5, 6, 7, 40, 360] {
        let mesh = pole(n, 3);
        let tables = tables(&mesh, 8);
        for depth in 0..8 {
            let cut = cut(&tables, &vec![density_of_depth(depth); mesh.positions.len()]);
            let mut expected = vec![PatchCounts::default(); 9];
            if depth == 0 {
                expected[0] = PatchCounts { regular: 8 * n, transition: 0, filling: n, ..PatchCounts::default() };
            } else {
                // Nine faces a sector, of which one is refined and two border it.
                expected[0] = PatchCounts { regular: 6 * n, transition: 2 * n, filling: 0, ..PatchCounts::default() };
                expected[1..depth as usize].fill(PatchCounts {
                    regular: n,
                    transition: 2 * n,
                    filling: 0,
                    ..PatchCounts::default()
                });
                expected[depth as usize] =
                    PatchCounts { regular: 3 * n, transition: 0, filling: n, ..PatchCounts::default() };
            }
            assert_eq!(cut.counts, expected, "valence {n}, depth {depth}");
            // A leaf at level 0 is made of cage points.
            let points: Vec<usize> = cut.rows.iter().map(|level| level.iter().map(Vec::len).sum()).collect();
            let expected = |k: u32| if k == 0 || k > depth { 0 } else { 12 * n as usize + 1 };
            assert!((2..9).all(|k| points[k as usize] == expected(k)), "valence {n}, depth {depth}: {points:?}");
            // The vertex, and the ring of its faces on every level: patches share corners with them.
            let rings = depth as usize + 1;
            assert_eq!((cut.limits.len(), cut.truncated), (2 * n as usize * rings + 1, 0));
        }
    }
}

#[test]
fn each_isolated_vertex_has_a_depth_of_its_own() {
    let (left, right) = (pole(5, 3), pole(7, 3));
    let mesh = merged(&left, &right);
    let tables = tables(&mesh, 8);
    let both = tables_counts(&mesh, &tables, left.positions.len(), [6, 2]);
    let one = |mesh: &ControlMesh, depth: u32| {
        let tables = self::tables(mesh, 8);
        cut(&tables, &vec![density_of_depth(depth); mesh.positions.len()]).counts
    };
    for ((both, a), b) in both.iter().zip(one(&left, 6)).zip(one(&right, 2)) {
        let sum = [a.regular + b.regular, a.transition + b.transition, a.filling + b.filling];
        assert_eq!([both.regular, both.transition, both.filling], sum);
    }
}

fn tables_counts(mesh: &ControlMesh, tables: &Tables, first_right: usize, depths: [u32; 2]) -> Vec<PatchCounts> {
    let depth = |vertex: usize| density_of_depth(depths[usize::from(vertex >= first_right)]);
    cut(tables, &(0..mesh.positions.len()).map(depth).collect::<Vec<_>>()).counts
}

#[test]
fn a_static_cut_is_the_deepest_of_as_many_levels() {
    for seed in 0..60 {
        let mesh = random(seed);
        let deep = tables(&mesh, 6);
        for level in 0..=6 {
            let slots = all_visible(&deep, &vec![0.0; mesh.positions.len()]);
            let rule = Selection::Static { frame_density: density_of_depth(level) };
            let cut = select(&deep, &deep.ranges(), &slots, rule);
            let shallow = tables(&mesh, level);
            let mut expected = deepest_cut(&shallow, &shallow.ranges()).counts;
            expected.resize(cut.counts.len(), PatchCounts::default());
            assert_eq!(cut.counts, expected, "seed {seed}, level {level}");
            assert_balanced(&deep, &cut, true);
            assert_complete(&deep, &cut);
            let is_deeper = |place: &u32| deep.irregular[*place as usize].info.level >= 1;
            assert!(level > 0 || !cut.refined.iter().any(|place| is_deeper(place) && mesh.edits.is_empty()));
        }
    }
}

#[test]
fn leaves_that_the_end_of_refinement_keeps_are_counted() {
    let mesh = cube();
    let counted = |max_level: u32, density: f32, selection: Selection| {
        let tables = tables(&mesh, max_level);
        select(&tables, &tables.ranges(), &all_visible(&tables, &[density; 8]), selection).truncated
    };
    assert_eq!(counted(0, 1.0, Selection::Dynamic), 0);
    assert_eq!(counted(0, 1.1, Selection::Dynamic), 6);
    assert_eq!(counted(3, 8.0, Selection::Dynamic), 0);
    assert_eq!(counted(3, 8.1, Selection::Dynamic), 24);
    assert_eq!(counted(3, 0.0, Selection::Static { frame_density: 8.1 }), 24);
}

#[test]
fn only_what_is_dense_is_refined() {
    // A strip of sharp vertices: its far end knows nothing of the dense one.
    let mut mesh = sheet(40, 1);
    let mut dense = vec![0.5; mesh.positions.len()];
    dense[0] = 1000.0;
    mesh.edits = vec![HierarchicalEdit { path: vec![39, 0], operation: EditOperation::SetVertexSharpness(3.0) }];
    mesh.corners = (0..82).map(|vertex| Corner { vertex, sharpness: 3.5 }).collect();
    let tables = tables(&mesh, 6);
    let cut = cut(&tables, &dense);
    assert_balanced(&tables, &cut, false);
    let faces: HashSet<u32> =
        cut.refined.iter().map(|&place| tables.irregular[place as usize].info.location.ptex_face).collect();
    assert_eq!(faces.iter().copied().max(), Some(1));
}

#[test]
fn leaf_edges_are_those_beside_the_end_of_refinement() {
    for seed in 0..CAGE_COUNT {
        let mesh = random(seed);
        let max_level = seed as u32 % 4;
        let tables = tables(&mesh, max_level);
        let ranges = tables.ranges();
        // Everything that a frame may draw: lines of leaves that are never refined, and their halves.
        let mut ends = HashSet::new();
        for face in tables.irregular.iter().filter(|face| !face.is_forced && u32::from(face.info.level) >= max_level) {
            for edge in 0..4 {
                let (line, start, length) = segment(&tables, &face.info, edge);
                ends.extend([(line, start, length), (line, start, length / 2), (line, start + length / 2, length / 2)]);
            }
        }
        let cut = deepest_cut(&tables, &ranges);
        for patch in ranges.patches[0].clone().chain(cut.patches).map(|place| &tables.patches[place as usize]) {
            for edge in 0..4 {
                let is_end = ends.contains(&segment(&tables, &patch.info, edge));
                assert_eq!(patch.info.leaf >> edge & 1 != 0, is_end, "seed {seed}: {:?}, edge {edge}", patch.info);
            }
            assert_eq!(patch.info.transition, 0);
        }
    }
}

#[test]
fn tables_are_linear_in_valence_and_in_the_sides_of_a_face() {
    let sizes = |mesh: &ControlMesh| {
        let tables = tables(mesh, 3);
        let cut = cut(&tables, &vec![4.0; mesh.positions.len()]);
        assert_complete(&tables, &cut);
        [
            tables.stencils.indices.len(),
            tables.limits.indices.len(),
            tables.stars.indices.len(),
            tables.slots.rings.indices.len(),
            tables.slots.neighbours.indices.len(),
            tables.irregular.len(),
        ]
    };
    for make in [|n| pole(n, 1), prism, cone] {
        let (small, large) = (sizes(&make(500)), sizes(&make(5000)));
        for (small, large) in small.into_iter().zip(large) {
            assert!(large < 11 * small, "{small} became {large}");
        }
    }
}
