//! Objects: meshes at places. Kernel `glsl/objects.comp` decides which of them may be seen.

use glam::{Affine3A, Vec3};
use planish_shaders::Object;
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::{FaceVaryingInterpolation, VertexInterpolation};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::MeshRanges;
use planish_subdiv::topology::NONE;

/// [`Object::flags`], as `glsl/shared/scene.glsl` has them.
const IN_HULL: u32 = 1;
const HIDES_BACKS: u32 = 2;
const MIRRORED: u32 = 4;
const LINEAR_TEX_COORDS: u32 = 8;
const VERTEX_COLORS: u32 = 16;
const VARYING_COLORS: u32 = 32;
const DEFORMS: u32 = 64;
const HIDDEN: u32 = 128;

/// A mesh at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectDesc {
    /// Which of the surface's meshes.
    pub mesh: usize,
    /// From the mesh's own space to the world.
    pub to_world: Affine3A,
    /// Whether the backs of its triangles are never seen: it is closed, opaque and seen from outside.
    pub hides_backs: bool,
    /// Whether it is left out.
    pub is_hidden: bool,
}

impl ObjectDesc {
    /// A mesh where it is.
    pub fn identity(mesh: usize) -> Self {
        Self { mesh, to_world: Affine3A::IDENTITY, hides_backs: false, is_hidden: false }
    }

    /// Whether the transform mirrors.
    pub fn is_mirrored(&self) -> bool {
        self.to_world.matrix3.determinant() < 0.0
    }
}

/// What an object needs to know of its cage's positions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CageFacts {
    /// The box around them.
    pub low: Vec3,
    pub high: Vec3,
    /// Length of the longest edge.
    pub largest_edge: f32,
}

impl CageFacts {
    /// Of positions, and the edges between them by their ends.
    pub fn new(positions: &[[f32; 3]], edges: impl Iterator<Item = [u32; 2]>) -> Self {
        let at = |vertex: u32| Vec3::from(positions[vertex as usize]);
        let Some(&first) = positions.first() else { return Self::default() };
        let start = (Vec3::from(first), Vec3::from(first));
        let (low, high) = positions.iter().fold(start, |(low, high), &p| (low.min(p.into()), high.max(p.into())));
        let largest_edge = edges.fold(0.0, |largest: f32, [a, b]| largest.max(at(a).distance(at(b))));
        Self { low, high, largest_edge }
    }

    /// Of a mesh.
    pub fn of_mesh(mesh: &ControlMesh) -> Self {
        let mut first = 0;
        let edges = mesh.face_sizes.iter().flat_map(|&sides| {
            let face = &mesh.face_vertices[first..first + sides as usize];
            first += sides as usize;
            (0..face.len()).map(move |i| [face[i], face[(i + 1) % face.len()]])
        });
        Self::new(&mesh.positions, edges)
    }

    /// Writes them into an object with such a cage.
    pub fn set(&self, object: &mut Object) {
        object.low = self.low.to_array();
        object.high = self.high.to_array();
        object.largest_edge = self.largest_edge * scale_of(object);
    }
}

/// How much longer an object's transform makes the axis that it makes longest.
fn scale_of(object: &Object) -> f32 {
    object.to_world[..3].iter().map(|&axis| Vec3::from(axis).length()).fold(0.0, f32::max)
}

/// Gives an object a displacement map, by which it is displaced by `bound` at most in its mesh's own units.
pub(crate) fn displace(object: &mut Object, map: u32, bound: f32) {
    object.map = map;
    // What directions and sums of directions round to is far less.
    object.displacement = bound * scale_of(object) * 1.0001;
}

/// Gives an object its mesh's colours, of which this is known; else it is white.
pub(crate) fn color(object: &mut Object, interpolation: Option<VertexInterpolation>) {
    object.flags &= !(VERTEX_COLORS | VARYING_COLORS);
    object.flags |= match interpolation {
        None => 0,
        Some(VertexInterpolation::Vertex) => VERTEX_COLORS,
        Some(VertexInterpolation::Varying) => VARYING_COLORS,
    };
}

/// Puts an object in its place. Its cage's facts are to be set again, as are its displacement and its motion.
pub(crate) fn place(object: &mut Object, desc: &ObjectDesc) {
    object.to_world = columns(&desc.to_world);
    object.motion = columns(&Affine3A::IDENTITY);
    object.flags &= !(HIDES_BACKS | MIRRORED | HIDDEN);
    object.flags |=
        flag(desc.hides_backs, HIDES_BACKS) | flag(desc.is_mirrored(), MIRRORED) | flag(desc.is_hidden, HIDDEN);
}

fn flag(is_set: bool, flag: u32) -> u32 {
    if is_set { flag } else { 0 }
}

/// Says that an object's cage deforms, or that it does not.
pub(crate) fn deform(object: &mut Object, deforms: bool) {
    object.flags = object.flags & !DEFORMS | flag(deforms, DEFORMS);
}

/// Whether it does.
pub(crate) fn deforms(object: &Object) -> bool {
    object.flags & DEFORMS != 0
}

/// What an object needs to know of its mesh, besides its place in the tables.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MeshFacts {
    pub cage: CageFacts,
    in_hull: bool,
    linear_tex_coords: bool,
    ptex_face_count: u32,
}

impl MeshFacts {
    pub fn new(mesh: &ControlMesh, ranges: &MeshRanges, scheme: Scheme) -> Self {
        // Chaikin's rule and some schemes have weights below 0, and edits move points anywhere.
        // Gregory patches may leave the hull too.
        let has_hull = mesh.edits.is_empty() && mesh.options.creasing == planish_subdiv::mesh::Creasing::Uniform;
        let in_hull = has_hull && ranges.spokes.is_empty() && scheme.is_within_hull();
        let linear_tex_coords = mesh.options.face_varying == FaceVaryingInterpolation::All;
        Self {
            cage: CageFacts::of_mesh(mesh),
            in_hull,
            linear_tex_coords,
            ptex_face_count: ranges.ptex_faces.len() as u32,
        }
    }
}

/// Where the objects' own parts of shared buffers begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ObjectSizes {
    /// Density slots of all objects.
    pub slots: u32,
    /// Bits of split edges of all objects.
    pub edges: u32,
}

/// The objects as the kernels read them.
pub(crate) fn objects(descs: &[ObjectDesc], facts: &[MeshFacts], ranges: &[MeshRanges]) -> (Vec<Object>, ObjectSizes) {
    let mut sizes = ObjectSizes::default();
    let mut first_face = 0;
    let mut objects = Vec::with_capacity(descs.len());
    for desc in descs {
        let (range, facts) = (&ranges[desc.mesh], &facts[desc.mesh]);
        let mut object = Object {
            flags: flag(facts.in_hull, IN_HULL) | flag(facts.linear_tex_coords, LINEAR_TEX_COORDS),
            first_slot: sizes.slots,
            first_mesh_slot: range.slots.start,
            vertex_count: range.cage_points.len() as u32,
            slot_count: range.slots.len() as u32,
            first_point: range.cage_points.start,
            first_ptex: range.ptex_faces.start,
            first_face,
            first_patch: range.patches[0].start,
            patch_count: range.patches[0].len() as u32,
            first_root: range.irregular[0].start,
            root_count: range.irregular[0].len() as u32,
            // Edges are numbered through all meshes; each object has its own bits.
            first_edge: sizes.edges.wrapping_sub(range.edges.start),
            map: NONE,
            ..Object::default()
        };
        place(&mut object, desc);
        facts.cage.set(&mut object);
        objects.push(object);
        first_face += facts.ptex_face_count;
        sizes.slots += range.slots.len() as u32;
        sizes.edges += range.edges.len() as u32;
    }
    (objects, sizes)
}

pub(crate) fn columns(transform: &Affine3A) -> [[f32; 3]; 4] {
    let m = &transform.matrix3;
    [m.x_axis, m.y_axis, m.z_axis, transform.translation].map(|axis| axis.to_array())
}

/// `to_world` of `glsl/shared/scene.glsl`, bit for bit where nothing is fused.
pub(crate) fn to_world(object: &Object, p: [f32; 3]) -> [f32; 3] {
    let m = &object.to_world;
    std::array::from_fn(|c| ((m[0][c] * p[0] + m[1][c] * p[1]) + m[2][c] * p[2]) + m[3][c])
}
