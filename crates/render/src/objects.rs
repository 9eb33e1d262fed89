//! Objects: meshes at places. Kernel `glsl/objects.comp` decides which of them may be seen.

use glam::{Affine3A, Vec3};
use planish_shaders::Object;
use planish_subdiv::ControlMesh;
use planish_subdiv::tables::MeshRanges;

/// [`Object::flags`], as `glsl/shared/scene.glsl` has them.
const IN_HULL: u32 = 1;
const HIDES_BACKS: u32 = 2;
const MIRRORED: u32 = 4;

/// A mesh at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectDesc {
    /// Which of the surface's meshes.
    pub mesh: usize,
    /// From the mesh's own space to the world.
    pub to_world: Affine3A,
    /// Whether the backs of its triangles are never seen: it is closed, opaque and seen from outside.
    pub hides_backs: bool,
}

impl ObjectDesc {
    /// A mesh where it is.
    pub fn identity(mesh: usize) -> Self {
        Self { mesh, to_world: Affine3A::IDENTITY, hides_backs: false }
    }

    /// Whether the transform mirrors.
    pub fn is_mirrored(&self) -> bool {
        self.to_world.matrix3.determinant() < 0.0
    }
}

/// What an object needs to know of its mesh, besides its place in the tables.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MeshFacts {
    low: Vec3,
    high: Vec3,
    in_hull: bool,
    ptex_face_count: u32,
}

impl MeshFacts {
    pub fn new(mesh: &ControlMesh, ranges: &MeshRanges) -> Self {
        let [low, high] = mesh.bounding_box().unwrap_or_default().map(Vec3::from);
        // Chaikin's rule has weights below 0, and edits move points anywhere.
        let in_hull = mesh.edits.is_empty() && mesh.options.creasing == planish_subdiv::mesh::Creasing::Uniform;
        Self { low, high, in_hull, ptex_face_count: ranges.ptex_faces.len() as u32 }
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
pub(crate) fn objects(
    descs: &[ObjectDesc],
    meshes: &[&ControlMesh],
    facts: &[MeshFacts],
    ranges: &[MeshRanges],
) -> (Vec<Object>, ObjectSizes) {
    let mut sizes = ObjectSizes::default();
    let mut first_face = 0;
    let mut objects = Vec::with_capacity(descs.len());
    for desc in descs {
        let (range, facts) = (&ranges[desc.mesh], &facts[desc.mesh]);
        let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
        objects.push(Object {
            to_world: columns(&desc.to_world),
            low: facts.low.to_array(),
            high: facts.high.to_array(),
            largest_edge: largest_edge(meshes[desc.mesh], &desc.to_world),
            displacement: 0.0,
            flags: flag(facts.in_hull, IN_HULL)
                | flag(desc.hides_backs, HIDES_BACKS)
                | flag(desc.is_mirrored(), MIRRORED),
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
        });
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

/// Length of a mesh's longest edge, in world space.
pub(crate) fn largest_edge(mesh: &ControlMesh, to_world: &Affine3A) -> f32 {
    let at = |vertex: u32| to_world.transform_point3(Vec3::from(mesh.positions[vertex as usize]));
    let mut largest = 0.0_f32;
    let mut first = 0;
    for &sides in &mesh.face_sizes {
        let face = &mesh.face_vertices[first..first + sides as usize];
        first += sides as usize;
        for (i, &vertex) in face.iter().enumerate() {
            largest = largest.max(at(vertex).distance(at(face[(i + 1) % face.len()])));
        }
    }
    largest
}

/// `to_world` of `glsl/shared/scene.glsl`, bit for bit where nothing is fused.
pub(crate) fn to_world(object: &Object, p: [f32; 3]) -> [f32; 3] {
    let m = &object.to_world;
    std::array::from_fn(|c| ((m[0][c] * p[0] + m[1][c] * p[1]) + m[2][c] * p[2]) + m[3][c])
}
