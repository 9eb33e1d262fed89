//! Feature-adaptive refinement (FAS section 3.3): topology only, one level after another.
//!
//! Of each level the irregular faces are split, and those that hierarchical edits of finer levels reach. What the next
//! level must hold follows from their corners, the *core*:
//! around every core vertex, the child at that vertex of every face there. Then each child of a split face has its
//! whole one-ring, which is what a bicubic patch or a limit mask reads, and nothing else is made.

use std::collections::{HashMap, HashSet};

use crate::edits::{self, PathEdits};
use crate::error::Error;
use crate::face_varying::{Channel, ChannelLevel};
use crate::gregory::Rival;
use crate::mesh::{ControlMesh, Creasing, HierarchicalEdit, INFINITE_SHARPNESS, MAX_ELEMENTS};
use crate::rules;
use crate::sharpness::{SharpnessAtVertex, child_sharpness};
use crate::tables::Border;
use crate::topology::{Level, Location, NONE, NonManifold, VertexTag};

/// Deepest level: locations have 16 bits, and single precision points carry no more.
pub const MAX_LEVEL: u32 = 15;

/// Which creases are patches of their own, instead of being isolated to the last level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CreasePatches {
    /// None: to compare with.
    None,
    /// Infinitely sharp ones are boundaries of regular patches, where the faces between them are regular.
    #[default]
    Infinite,
    /// Those, and semi-sharp ones of one sharpness that pass a regular face along one edge, in closed form
    /// ([`crate::patch::crease_basis`]).
    Single,
}

/// What to refine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefineOptions {
    /// No irregularity is isolated deeper; at most [`MAX_LEVEL`].
    pub max_level: u32,
    /// Split every face of every level (the global refinement that FAS section 8.1 compares with).
    pub uniform: bool,
    /// Which creases are not refined.
    pub crease_patches: CreasePatches,
    /// The surface will be displaced: also where normals or texture coordinates differ on both sides of an edge, one of
    /// them is known to decide for both.
    pub displaced: bool,
    /// Irregular faces of `max_level`, where refinement ends, are drawn as Gregory patches.
    pub gregory: bool,
    /// Their control points have stencils over the cage's points ([`crate::tables::GregoryStencils`]).
    pub gregory_stencils: bool,
    /// They are patches of this scheme instead.
    pub rival: Option<Rival>,
    /// Face-varying channels are left out: the surface is not refined for their sake.
    pub ignores_channels: bool,
}

/// How a level came from the one before: its points in order are the children of `vertices`, `edges` and `faces`.
#[derive(Clone, Debug, Default)]
pub struct Split {
    /// Parent vertices, each with all its faces.
    pub vertices: Vec<u32>,
    /// One half-edge of each parent edge.
    pub edges: Vec<u32>,
    /// Parent faces.
    pub faces: Vec<u32>,
    /// For each child face, the parent half-edge that starts at the corner it holds.
    pub child_corners: Vec<u32>,
}

impl Split {
    /// Number of points that the split makes.
    pub fn point_count(&self) -> usize {
        self.vertices.len() + self.edges.len() + self.faces.len()
    }
}

/// A cage refined towards its irregularities.
#[derive(Clone, Debug)]
pub struct Refinement {
    /// Levels 0 to [`Self::last_level`].
    pub levels: Vec<Level>,
    /// `splits[k]` made level k + 1.
    pub splits: Vec<Split>,
    /// For each level the faces that are no patches of it, ascending: drawn ones that have no patch, or all with uniform
    /// refinement, and the forced ones.
    pub irregular_faces: Vec<Vec<u32>>,
    /// For each level those of them that were split: all of them, but from `max_level` on the forced ones alone.
    pub split_faces: Vec<Vec<u32>>,
    /// For each level the faces that are split at any density: drawn n-gons, and those that an edit of a finer level
    /// reaches.
    pub forced_faces: Vec<Vec<u32>>,
    /// The mesh's hierarchical edits.
    pub edits: Vec<HierarchicalEdit>,
    /// For each level the vertices that hierarchical edits move, and the number of the edit, in the edits' order.
    pub moved_points: Vec<Vec<(u32, u32)>>,
    /// The mesh's face-varying channels.
    pub(crate) face_varying: Vec<Channel>,
    /// The deepest level: `max_level`, or deeper where n-gons or edits ask for it.
    pub last_level: u32,
    /// What was asked for.
    pub options: RefineOptions,
}

impl Refinement {
    /// Refines a cage. A mesh with faces that are no quads is split once at least: their children are quads, and only
    /// then a limit mask exists at their corners. One with hierarchical edits is split down to the deepest of them.
    pub fn new(mesh: &ControlMesh, options: RefineOptions) -> Result<Self, Error> {
        if options.max_level > MAX_LEVEL {
            return Err(Error::MaxLevel { asked: options.max_level, max: MAX_LEVEL });
        }
        if options.gregory && !mesh.edits.is_empty() {
            return Err(Error::EditedGregory);
        }
        let mut levels = vec![Level::from_mesh(mesh)?];
        let has_non_quads = mesh.face_sizes.iter().any(|&n| n != 4);
        let last_level = options.max_level.max(u32::from(has_non_quads)).max(edits::deepest_level(mesh));
        let mut path_edits = PathEdits::new(mesh);
        let mut moved_points = vec![path_edits.apply(&mut levels[0])];
        let mut face_varying = if options.ignores_channels { Vec::new() } else { channels(mesh, &mut levels[0]) };
        let mut splits = Vec::new();
        let (mut irregular_faces, mut split_faces, mut forced_faces) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..=last_level {
            let level = &levels[k as usize];
            let mut forced = path_edits.forced_faces(level);
            forced.extend((0..level.drawn_count).filter(|&face| level.is_drawn(face) && level.sides(face) != 4));
            let mut irregular: Vec<u32> = (0..level.drawn_count)
                .filter(|&face| {
                    level.is_drawn(face) && (options.uniform || !is_leaf_patch(level, face, options, &face_varying))
                })
                .collect();
            irregular.extend(&forced);
            for faces in [&mut forced, &mut irregular] {
                faces.sort_unstable();
                faces.dedup();
            }
            if let Some(rival) = options.rival.filter(|_| k == 0) {
                rival.check(level, &irregular)?;
            }
            let split_here = if options.uniform || k < options.max_level { irregular.clone() } else { forced.clone() };
            if k < last_level {
                let core =
                    if split_here.len() < irregular.len() { core_beside_non_quads(level, &irregular) } else { vec![] };
                let (split, mut child) = split_level_around(level, &split_here, core, k + 1)?;
                path_edits.descend(level, &split_here);
                moved_points.push(path_edits.apply(&mut child));
                for channel in &mut face_varying {
                    let channel_level = channel.levels[k as usize].split(level, &split);
                    channel.levels.push(channel_level);
                }
                splits.push(split);
                levels.push(child);
            }
            irregular_faces.push(irregular);
            split_faces.push(if k < last_level { split_here } else { Vec::new() });
            forced_faces.push(forced);
        }
        let edits = mesh.edits.clone();
        let refinement = Self {
            levels,
            splits,
            irregular_faces,
            split_faces,
            forced_faces,
            edits,
            moved_points,
            face_varying,
            last_level,
            options,
        };
        // Rows average fewer than 8 indices: what the tables number stays within 32 bits.
        let count = refinement.splits.iter().map(|split| split.point_count() as u64).sum::<u64>();
        if 8 * count >= u64::from(u32::MAX) {
            return Err(Error::TooLarge { level: last_level, count: 8 * count });
        }
        // What borders of patches can name.
        let faces = refinement.levels.iter().map(|level| u64::from(level.drawn_count)).sum::<u64>();
        if faces >= Border::MAX_PATCHES {
            return Err(Error::TooLarge { level: last_level, count: faces });
        }
        Ok(refinement)
    }

    /// Which faces of a level are among these.
    pub(crate) fn flags(&self, level: u32, faces: &[u32]) -> Vec<bool> {
        let mut flags = vec![false; self.levels[level as usize].face_count() as usize];
        faces.iter().for_each(|&face| flags[face as usize] = true);
        flags
    }
}

/// Corners of quads at which no limit mask exists because a face there is no quad: one exists one level down.
fn core_beside_non_quads(level: &Level, faces: &[u32]) -> Vec<u32> {
    let quads = faces.iter().filter(|&&face| level.sides(face) == 4);
    let corners = quads.flat_map(|&face| level.vertices(face));
    corners.copied().filter(|&vertex| !level.tag(vertex).touches_only_quads()).collect()
}

/// Whether a face's limit is one patch of its level.
fn is_leaf_patch(level: &Level, face: u32, options: RefineOptions, channels: &[Channel]) -> bool {
    match options.crease_patches {
        CreasePatches::None => {
            level.is_regular(face) && !level.vertices(face).iter().any(|&v| level.tag(v).has_infinite_crease())
        }
        CreasePatches::Infinite => level.is_regular(face),
        CreasePatches::Single => {
            // Every channel has one level more than there are splits.
            let follows =
                |channel: &Channel| channel.levels.last().is_none_or(|last| last.follows_vertices(level, face));
            level.is_regular(face) || (level.single_crease(face).is_some() && channels.iter().all(follows))
        }
    }
}

/// A mesh's channels on level 0, whose vertices are tagged where a channel is not regular.
fn channels(mesh: &ControlMesh, level: &mut Level) -> Vec<Channel> {
    let channels = mesh.face_varying.iter().map(|channel| {
        let of_level = ChannelLevel::of_mesh(level, channel);
        let irregular: Vec<u32> = of_level.irregular_vertices(level).collect();
        irregular.into_iter().for_each(|vertex| {
            level.tags[vertex as usize] = level.tag(vertex).with_irregular_values();
        });
        Channel { name: channel.name.clone(), levels: vec![of_level] }
    });
    channels.collect()
}

/// Maps from the elements of a level to those of the next one that they become; [`NONE`] where they do not.
struct Children {
    /// Half-edge to the child face at its origin.
    faces: Vec<u32>,
    /// Half-edge to the place of its edge in [`Split::edges`].
    edges: Vec<u32>,
    /// Face to its place in [`Split::faces`].
    centres: Vec<u32>,
    /// Vertex to its place in [`Split::vertices`].
    vertices: Vec<u32>,
}

/// Splits the given faces of a level; returns what became of what, and the next level.
pub(crate) fn split_level(parent: &Level, faces: &[u32], child_level: u32) -> Result<(Split, Level), Error> {
    split_level_around(parent, faces, Vec::new(), child_level)
}

/// The same, with further core vertices besides the corners of the faces.
fn split_level_around(
    parent: &Level,
    faces: &[u32],
    further_core: Vec<u32>,
    child_level: u32,
) -> Result<(Split, Level), Error> {
    let mut split = Split::default();
    let half_edge_count = parent.origins.len();
    let mut children = Children {
        faces: vec![NONE; half_edge_count],
        edges: vec![NONE; half_edge_count],
        centres: vec![NONE; parent.face_count() as usize],
        vertices: vec![NONE; parent.tags.len()],
    };
    let mut locations = Vec::with_capacity(4 * faces.len());
    for &face in faces {
        let is_quad = parent.sides(face) == 4;
        let location = parent.locations[face as usize];
        for (i, half_edge) in (0..).zip(parent.half_edges(face)) {
            children.faces[half_edge as usize] = split.child_corners.len() as u32;
            split.child_corners.push(half_edge);
            locations.push(if is_quad {
                location.quarter(i)
            } else {
                Location { ptex_face: location.ptex_face + i, ..location }
            });
            add_core(&mut split, &mut children, parent.origin(half_edge));
        }
    }
    further_core.into_iter().for_each(|vertex| add_core(&mut split, &mut children, vertex));
    add_chaikin_ends(parent, &mut split, &mut children);
    collect_rings(parent, &mut split, &mut children);
    let half_edges = 4 * split.child_corners.len() as u64;
    if half_edges >= u64::from(MAX_ELEMENTS) {
        return Err(Error::TooLarge { level: child_level, count: half_edges });
    }
    let mut child = connect_children(parent, &split, &children);
    child.drawn_count = locations.len() as u32;
    child.locations = locations;
    if faces.iter().any(|&face| !parent.is_drawn(face)) {
        let hidden = |&face: &u32| std::iter::repeat_n(!parent.is_drawn(face), parent.sides(face) as usize);
        child.hidden = faces.iter().flat_map(hidden).collect();
    }
    tag_children(parent, &split, &children, &mut child);
    Ok((split, child))
}

fn add_core(split: &mut Split, children: &mut Children, vertex: u32) {
    if children.vertices[vertex as usize] == NONE {
        children.vertices[vertex as usize] = split.vertices.len() as u32;
        split.vertices.push(vertex);
    }
}

/// Chaikin's rule looks at all creases at both ends of an edge: where one end of a semi-sharp edge is core, the other
/// must have all its edges too.
fn add_chaikin_ends(parent: &Level, split: &mut Split, children: &mut Children) {
    if parent.options.creasing == Creasing::Uniform || parent.edge_sharpness.is_empty() {
        return;
    }
    for i in 0..split.vertices.len() {
        let vertex = split.vertices[i];
        if !parent.tag(vertex).is_semi_sharp() {
            continue;
        }
        for spoke in parent.all_spokes(vertex) {
            let end = parent.head(spoke);
            if rules::is_semi_sharp(parent.sharpness(spoke)) {
                add_core(split, children, end);
            }
        }
    }
}

/// Finds the edges and faces around the core, and the children of the faces that only support it.
fn collect_rings(parent: &Level, split: &mut Split, children: &mut Children) {
    for i in 0..split.vertices.len() {
        for spoke in parent.all_spokes(split.vertices[i]) {
            let face = parent.face(spoke);
            if children.faces[spoke as usize] == NONE {
                children.faces[spoke as usize] = split.child_corners.len() as u32;
                split.child_corners.push(spoke);
            }
            if children.centres[face as usize] == NONE {
                children.centres[face as usize] = split.faces.len() as u32;
                split.faces.push(face);
            }
            // The incoming edge is the next spoke's, except on the boundary, where it has no outgoing half-edge.
            for half_edge in [spoke, parent.previous(spoke)] {
                if children.edges[half_edge as usize] == NONE {
                    let edge = split.edges.len() as u32;
                    split.edges.push(half_edge);
                    children.edges[parent.twin(half_edge) as usize] = edge;
                    parent.sharing(&half_edge).iter().for_each(|&same| children.edges[same as usize] = edge);
                }
            }
        }
    }
}

/// The place of corner `j` of a child face (0: the parent's vertex, then counter-clockwise: edge point, centre, edge
/// point) among its half-edges. Children of quads are turned so that their u and v run as their parent's.
pub(crate) fn child_half_edge(child_face: u32, parent: &Level, parent_half_edge: u32, j: u32) -> u32 {
    let edges = parent.half_edges(parent.face(parent_half_edge));
    let turn = if edges.end - edges.start == 4 { parent_half_edge - edges.start } else { 0 };
    4 * child_face + (j + turn) % 4
}

fn connect_children(parent: &Level, split: &Split, children: &Children) -> Level {
    let half_edge_count = 4 * split.child_corners.len();
    let (mut origins, mut twins) = (vec![NONE; half_edge_count], vec![NONE; half_edge_count]);
    let first_edge = split.vertices.len() as u32;
    let first_face = first_edge + split.edges.len() as u32;
    let child_of = |corner: u32, j: u32| match children.faces[corner as usize] {
        NONE => NONE,
        face => child_half_edge(face, parent, corner, j),
    };
    for (face, &corner) in (0..).zip(&split.child_corners) {
        let previous = parent.previous(corner);
        let at = |j: u32| child_half_edge(face, parent, corner, j);
        origins[at(0) as usize] = children.vertices[parent.origin(corner) as usize];
        origins[at(1) as usize] = first_edge + children.edges[corner as usize];
        origins[at(2) as usize] = first_face + children.centres[parent.face(corner) as usize];
        origins[at(3) as usize] = first_edge + children.edges[previous as usize];
        let (twin, previous_twin) = (parent.twin(corner), parent.twin(previous));
        // Both halves of an edge of a core vertex are there; siblings only if their own corner is core.
        twins[at(0) as usize] = if twin == corner { at(0) } else { child_of(parent.next(twin), 3) };
        twins[at(1) as usize] = child_of(parent.next(corner), 2);
        twins[at(2) as usize] = child_of(previous, 1);
        twins[at(3) as usize] = if previous_twin == previous { at(3) } else { child_of(previous_twin, 0) };
    }
    Level::of_quads(origins, twins)
}

fn tag_children(parent: &Level, split: &Split, children: &Children, child: &mut Level) {
    let count = split.point_count();
    child.tags.reserve_exact(count);
    child.starts.reserve_exact(count);
    child.options = parent.options;
    let at = |corner: u32, j: u32| match children.faces[corner as usize] {
        NONE => NONE,
        face => child_half_edge(face, parent, corner, j),
    };
    let sharpness = ChildSharpness::of(parent, split);
    for &vertex in &split.vertices {
        child.tags.push(sharpness.vertex_tag(parent, vertex));
        child.starts.push(at(parent.starts[vertex as usize], 0));
    }
    for (&edge, ends) in split.edges.iter().zip(sharpness.edges()) {
        let shared_count = parent.sharing(&edge).len();
        let unpaired = parent.is_unpaired(edge);
        let tag = if shared_count > 1 {
            VertexTag::middle_of_non_manifold()
        } else {
            VertexTag::new(if unpaired { 2 } else { 4 }, unpaired, false, false)
        };
        let infinite = ends[0] >= INFINITE_SHARPNESS && !unpaired;
        let semi_sharp = ends.iter().any(|&s| rules::is_semi_sharp(s));
        child.tags.push(tag.with_sharpness(semi_sharp, infinite));
        // On the boundary the outgoing boundary half-edge runs to the edge's head; inside any will do.
        child.starts.push(if unpaired { at(parent.next(edge), 3) } else { at(edge, 1) });
    }
    for &face in &split.faces {
        child.tags.push(VertexTag::new(parent.sides(face), false, false, false));
        child.starts.push(parent.half_edges(face).map(|corner| at(corner, 2)).find(|&h| h != NONE).unwrap_or(NONE));
    }
    sharpness.hand_down(parent, split, &at, child);
    child.sum_semi_sharp_edges();
    child.non_manifold =
        parent.non_manifold.as_ref().map(|parts| Box::new(split_non_manifold(parts, parent, split, children, &at)));
}

/// Sharpness of the child edges along the edges of a split: nothing if all are smooth.
struct ChildSharpness {
    /// For each edge of the split, of the halves at the origin and at the head of its half-edge.
    ends: Vec<[f32; 2]>,
    edge_count: usize,
}

impl ChildSharpness {
    fn of(parent: &Level, split: &Split) -> Self {
        let mut ends = Vec::new();
        if !parent.edge_sharpness.is_empty() {
            ends.extend(split.edges.iter().map(|&edge| child_sharpness(parent, edge)));
        }
        Self { ends, edge_count: split.edges.len() }
    }

    fn edges(&self) -> impl Iterator<Item = [f32; 2]> {
        (0..self.edge_count).map(|i| self.ends.get(i).copied().unwrap_or_default())
    }

    fn vertex_tag(&self, parent: &Level, vertex: u32) -> VertexTag {
        let tag = parent.tag(vertex);
        if !tag.is_semi_sharp() {
            return tag.child();
        }
        let own = rules::less_sharp(parent.vertex_sharpness(vertex));
        let at_vertex = SharpnessAtVertex::of(parent, vertex);
        let edges = at_vertex.children(parent.options.creasing);
        let semi_sharp = rules::is_semi_sharp(own) || edges.iter().any(|&s| rules::is_semi_sharp(s));
        tag.child().with_sharpness(semi_sharp, tag.has_infinite_crease())
    }

    /// Writes the sharpness of the child level's half-edges and vertices; leaves it empty where all is smooth.
    fn hand_down(&self, parent: &Level, split: &Split, at: &impl Fn(u32, u32) -> u32, child: &mut Level) {
        if self.ends.iter().any(|ends| ends[0] > 0.0 || ends[1] > 0.0) {
            child.edge_sharpness = vec![0.0; child.origins.len()];
            for (&edge, ends) in split.edges.iter().zip(&self.ends) {
                let twin = parent.twin(edge);
                // Each half lies in a child on either side.
                let mut halves =
                    [(at(edge, 0), ends[0]), (at(parent.next(edge), 3), ends[1]), (NONE, 0.0), (NONE, 0.0)];
                if twin != edge {
                    halves[2] = (at(parent.next(twin), 3), ends[0]);
                    halves[3] = (at(twin, 0), ends[1]);
                }
                for (half_edge, sharpness) in halves {
                    if half_edge != NONE {
                        child.edge_sharpness[half_edge as usize] = sharpness;
                    }
                }
            }
        }
        let own = |&vertex: &u32| {
            let sharpness = parent.vertex_sharpness.get(vertex as usize).copied().unwrap_or(0.0);
            rules::less_sharp(sharpness)
        };
        if !parent.vertex_sharpness.is_empty() && split.vertices.iter().any(|v| own(v) > 0.0) {
            child.vertex_sharpness = split.vertices.iter().map(own).collect();
            child.vertex_sharpness.resize(split.point_count(), 0.0);
        }
    }
}

/// The edges and vertices that stay non-manifold one level down.
fn split_non_manifold(
    parts: &NonManifold,
    parent: &Level,
    split: &Split,
    children: &Children,
    at: &impl Fn(u32, u32) -> u32,
) -> NonManifold {
    let mut shared_edges = Vec::new();
    let (mut fans, mut creases) = (HashMap::new(), HashSet::new());
    let first_edge = split.vertices.len() as u32;
    for edge in &parts.shared_edges {
        let place = children.edges[edge[0] as usize];
        if place == NONE {
            continue;
        }
        let [a, b] = [parent.origin(edge[0]), parent.head(edge[0])];
        for end in [a, b] {
            let half = |&h: &u32| if parent.origin(h) == end { at(h, 0) } else { at(parent.next(h), 3) };
            let halves: Vec<u32> = edge.iter().map(half).filter(|&h| h != NONE).collect();
            if !halves.is_empty() {
                shared_edges.push(halves);
            }
        }
        // The middle has a fan of two faces in every face at the edge.
        let starts = edge.iter().map(|&h| at(parent.next(h), 3)).filter(|&h| h != NONE).collect();
        fans.insert(first_edge + place, starts);
        creases.insert(first_edge + place);
    }
    for (&vertex, starts) in &parts.fans {
        let child = children.vertices[vertex as usize];
        if child != NONE {
            fans.insert(child, starts.iter().map(|&start| at(start, 0)).collect());
            if parts.creases.contains(&vertex) {
                creases.insert(child);
            }
        }
    }
    let mut parts = NonManifold::new(shared_edges, fans);
    parts.creases = creases;
    parts
}
