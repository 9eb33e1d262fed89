//! A mesh of the file becomes one cage, whatever primitives it has.
use std::collections::{BTreeSet, HashMap, HashSet};

use ::gltf::json::mesh;
use planish_subdiv::mesh::{
    ControlMesh, Corner, Crease, FaceVaryingChannel, MAX_ELEMENTS, VertexColors, VertexInterpolation,
};

use super::data::Data;
use super::faces::Faces;
use super::fault::Fault;
use super::primitive::{self, Primitive};
use super::quads;
use super::tags::{self, Tags};
use super::weld::{self, Welded};
use crate::LoadOptions;
use crate::obj::Warnings;

/// What the first channel of texture coordinates is called, as in USD; the set n is this and n.
const UV_NAME: &str = "st";
/// The colour of vertices of a primitive without colours, where others have some.
const WHITE: [f32; 3] = [1.0; 3];

/// A cage and what its primitives say beside.
pub struct Cage {
    pub control_mesh: ControlMesh,
    /// The material of every slot.
    pub slots: Vec<Option<usize>>,
    /// The slot of every face; empty: all are of the first.
    pub face_slots: Vec<u32>,
    pub primitives: Vec<Primitive>,
    pub welded: Welded,
    /// Whether triangles are left of which nothing says if they were quads.
    pub has_open_triangles: bool,
}

/// Makes the cage of a mesh; none if it has no triangles. `sets_of`: sets of texture coordinates that a material uses.
pub fn read(
    data: &Data,
    mesh: &mesh::Mesh,
    sets_of: impl Fn(usize) -> BTreeSet<u32>,
    place: &str,
    options: &LoadOptions,
    warnings: &mut Warnings,
) -> Result<Option<Cage>, Fault> {
    let tags = Tags::read(&mesh.extras, place)?;
    let mut texcoord_sets = BTreeSet::from([0]);
    for material in mesh.primitives.iter().filter_map(|primitive| primitive.material) {
        texcoord_sets.extend(sets_of(material.value()));
    }
    let mut primitives = Vec::new();
    for (index, primitive) in mesh.primitives.iter().enumerate() {
        let place = format!("{place}.primitives[{index}]");
        match primitive::read(data, primitive, &texcoord_sets, &place)? {
            Some(primitive) => primitives.push(primitive),
            None => warnings.push(None, format!("{place}: points or lines: left out")),
        }
    }
    refuse_too_many(&primitives, place)?;
    let (mut faces, slots) = faces_of(&primitives);
    if faces.sizes.is_empty() {
        return Ok(None);
    }
    refuse_different(&primitives, place)?;
    // Keys, maps and what they become.
    let vertex_count: usize = primitives.iter().map(|primitive| primitive.positions.len()).sum();
    data.spend(64 * (vertex_count + faces.corners.len()) as u64, place)?;
    let welded = if tags.weld { weld::weld(&primitives) } else { weld::keep(&primitives) };
    let mut builder = Builder { place, primitives: &primitives, welded: &welded, warnings };
    let face_map = faces.check(&welded, options.repair, place, builder.warnings)?;
    if faces.sizes.is_empty() {
        return Err(Fault::new(place, "no face that is left", "one or more"));
    }
    let mut control_mesh = builder.control_mesh(&tags, &face_map, &faces)?;
    let channels = builder.channels(&texcoord_sets);
    let is_open =
        |faces: &Faces| faces.sizes.iter().zip(&faces.is_pairable).any(|(&size, &is_open)| size == 3 && is_open);
    let has_open_triangles = is_open(&faces) && !options.quads;
    if options.quads && is_open(&faces) {
        pair(&mut faces, &welded, &channels, &mut control_mesh);
    }
    for channel in channels {
        let indices = faces.corners.iter().map(|&corner| channel.value_of[corner as usize]).collect();
        control_mesh.face_varying.push(FaceVaryingChannel { name: channel.name, values: channel.values, indices });
    }
    control_mesh.face_vertices = faces.corners.iter().map(|&corner| welded.vertex_of[corner as usize]).collect();
    control_mesh.face_sizes = faces.sizes;
    builder.drop_creases_without_edge(&mut control_mesh);
    control_mesh.validate().map_err(|error| Fault::new(place, error.to_string(), "a cage that can be subdivided"))?;
    let face_slots = if slots.len() > 1 { faces.slots } else { Vec::new() };
    Ok(Some(Cage { control_mesh, slots, face_slots, primitives, welded, has_open_triangles }))
}

fn refuse_too_many(primitives: &[Primitive], place: &str) -> Result<(), Fault> {
    let vertices: u64 = primitives.iter().map(|primitive| primitive.positions.len() as u64).sum();
    let corners: u64 = primitives.iter().map(|primitive| 3 * primitive.triangles.len() as u64).sum();
    if vertices.max(corners) < u64::from(MAX_ELEMENTS) {
        return Ok(());
    }
    Err(Fault::new(place, format!("{vertices} vertices and {corners} corners"), format!("fewer than {MAX_ELEMENTS}")))
}

/// Refuses primitives of which some move in ways that others do not.
fn refuse_different(primitives: &[Primitive], place: &str) -> Result<(), Fault> {
    for pair in primitives.windows(2) {
        let counts = [&pair[0], &pair[1]].map(|primitive| primitive.targets.len());
        if counts[0] != counts[1] {
            return Err(Fault::new(
                place,
                format!("primitives of {} and {} morph targets", counts[0], counts[1]),
                "equally many",
            ));
        }
        if pair[0].influences.is_empty() != pair[1].influences.is_empty() {
            return Err(Fault::new(place, "primitives with JOINTS_0 and without", "all with or all without"));
        }
    }
    Ok(())
}

/// The faces of all primitives, by file vertices, and the material of every slot.
fn faces_of(primitives: &[Primitive]) -> (Faces, Vec<Option<usize>>) {
    let (mut faces, mut slots, mut first) = (Faces::default(), Vec::new(), 0);
    for primitive in primitives {
        let slot = slots.iter().position(|&material| material == primitive.material).unwrap_or_else(|| {
            slots.push(primitive.material);
            slots.len() - 1
        });
        faces.add(&primitive.triangles, first, slot as u32, primitive.keeps_ngons);
        first += primitive.positions.len() as u32;
    }
    (faces, slots)
}

/// Texture coordinates: the different values, and which one every file vertex has.
struct Channel {
    name: String,
    values: Vec<[f32; 2]>,
    value_of: Vec<u32>,
}

struct Builder<'a> {
    place: &'a str,
    primitives: &'a [Primitive],
    welded: &'a Welded,
    warnings: &'a mut Warnings,
}

impl Builder<'_> {
    /// The cage but for its faces and their channels.
    fn control_mesh(&mut self, tags: &Tags, face_map: &[Option<u32>], faces: &Faces) -> Result<ControlMesh, Fault> {
        let positions: Vec<[f32; 3]> =
            self.primitives.iter().flat_map(|primitive| primitive.positions.iter().copied()).collect();
        let positions = self.welded.first_of.iter().map(|&vertex| positions[vertex as usize]).collect();
        let mut mesh =
            ControlMesh { positions, options: tags.options(), colors: self.colors(), ..ControlMesh::default() };
        for (index, &(a, b, value)) in tags.creases.iter().enumerate() {
            let place = format!("{}.extras.planish.creases[{index}]", self.place);
            let vertices = [self.vertex(a, &place)?, self.vertex(b, &place)?];
            mesh.creases.push(Crease { vertices, sharpness: tags::sharpness(value, &place)? });
        }
        for (index, &(vertex, value)) in tags.corners.iter().enumerate() {
            let place = format!("{}.extras.planish.corners[{index}]", self.place);
            let vertex = self.vertex(vertex, &place)?;
            mesh.corners.push(Corner { vertex, sharpness: tags::sharpness(value, &place)? });
        }
        for (index, &face) in tags.holes.iter().enumerate() {
            let place = format!("{}.extras.planish.holes[{index}]", self.place);
            match face_map.get(face as usize) {
                Some(Some(face)) => mesh.holes.push(*face),
                Some(None) => self.warnings.push(None, format!("{place}: face {face} was dropped: ignored")),
                None => return Err(Fault::index(place, "faces", face as usize, face_map.len())),
            }
        }
        debug_assert!(mesh.holes.iter().all(|&hole| (hole as usize) < faces.sizes.len()));
        Ok(mesh)
    }

    fn vertex(&self, file_vertex: u32, place: &str) -> Result<u32, Fault> {
        let vertex_of = &self.welded.vertex_of;
        let vertex = vertex_of.get(file_vertex as usize).copied();
        vertex.ok_or_else(|| Fault::index(place, "vertices", file_vertex as usize, vertex_of.len()))
    }

    /// The mean of the colours that a vertex has where it was split.
    fn colors(&mut self) -> Option<VertexColors> {
        if self.primitives.iter().all(|primitive| primitive.colors.is_none()) {
            return None;
        }
        let count = self.welded.first_of.len();
        let (mut sums, mut counts) = (vec![[0.0f64; 3]; count], vec![0u32; count]);
        let mut firsts: Vec<Option<[f32; 3]>> = vec![None; count];
        let mut differs = vec![false; count];
        let colors = self.primitives.iter().flat_map(|primitive| {
            (0..primitive.positions.len())
                .map(|vertex| primitive.colors.as_ref().map_or(WHITE, |colors| colors[vertex]))
        });
        for (&vertex, color) in self.welded.vertex_of.iter().zip(colors) {
            let vertex = vertex as usize;
            sums[vertex] = std::array::from_fn(|c| sums[vertex][c] + f64::from(color[c]));
            counts[vertex] += 1;
            differs[vertex] |= *firsts[vertex].get_or_insert(color) != color;
        }
        let different = differs.iter().filter(|&&differs| differs).count();
        if different > 0 {
            let text = format!("{}: {different} vertices have several colours: their mean is taken", self.place);
            self.warnings.push(None, text);
        }
        let value = |vertex: usize| match firsts[vertex] {
            Some(color) if !differs[vertex] => color,
            _ => sums[vertex].map(|sum| (sum / f64::from(counts[vertex].max(1))) as f32),
        };
        let values = (0..count).map(value).collect();
        Some(VertexColors { values, interpolation: VertexInterpolation::Varying })
    }

    /// The channels of texture coordinates, the first set first. Values of the same bits are one; corners without any, of
    /// materials that need none, have zeros.
    fn channels(&self, sets: &BTreeSet<u32>) -> Vec<Channel> {
        let used =
            sets.iter().filter(|set| self.primitives.iter().any(|primitive| primitive.texcoords.contains_key(set)));
        let channel = |&set: &u32| {
            let mut index_of: HashMap<[u32; 2], u32> = HashMap::new();
            let name = if set == 0 { UV_NAME.to_owned() } else { format!("{UV_NAME}{set}") };
            let mut channel = Channel { name, values: Vec::new(), value_of: Vec::new() };
            for primitive in self.primitives {
                let values = primitive.texcoords.get(&set);
                for vertex in 0..primitive.positions.len() {
                    let value = values.map_or([0.0; 2], |values| values[vertex]);
                    let index = *index_of.entry(value.map(f32::to_bits)).or_insert_with(|| {
                        channel.values.push(value);
                        channel.values.len() as u32 - 1
                    });
                    channel.value_of.push(index);
                }
            }
            channel
        };
        used.map(channel).collect()
    }

    /// Drops the creases whose two vertices no edge joins, as OpenSubdiv does.
    fn drop_creases_without_edge(&mut self, mesh: &mut ControlMesh) {
        if mesh.creases.is_empty() {
            return;
        }
        let edges = edges(mesh);
        mesh.creases.retain(|crease| {
            let is_edge = edges.contains(&sorted(crease.vertices));
            if !is_edge {
                let [a, b] = crease.vertices;
                let text = format!(
                    "{}: a crease from vertex {a} to {b} of the cage, which no edge joins: ignored",
                    self.place
                );
                self.warnings.push(None, text);
            }
            is_edge
        });
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn edges(mesh: &ControlMesh) -> HashSet<[u32; 2]> {
    let mut edges = HashSet::new();
    let mut rest = mesh.face_vertices.as_slice();
    for &size in &mesh.face_sizes {
        let (face, after) = rest.split_at(size as usize);
        rest = after;
        edges.extend(face.iter().zip(face.iter().cycle().skip(1)).map(|(&a, &b)| sorted([a, b])));
    }
    edges
}

/// Pairs triangles to quads, and renumbers holes.
fn pair(faces: &mut Faces, welded: &Welded, channels: &[Channel], mesh: &mut ControlMesh) {
    let value_of: Vec<Vec<u32>> = channels.iter().map(|channel| channel.value_of.clone()).collect();
    let around = quads::Around {
        welded,
        positions: &mesh.positions,
        channels: &value_of,
        creases: &mesh
            .creases
            .iter()
            .filter(|crease| crease.sharpness > 0.0)
            .map(|crease| sorted(crease.vertices))
            .collect(),
        holes: &mesh.holes.iter().copied().collect(),
    };
    let map = quads::pair(faces, &around);
    mesh.holes.iter_mut().for_each(|hole| *hole = map[*hole as usize]);
}
