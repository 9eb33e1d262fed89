//! A scene's meshes and objects on the GPU: their tables, and the buffers that frames fill.

use std::ops::Range;
use std::time::Instant;

use planish_gpu::Device;
use planish_shaders as shaders;
use planish_shaders::{DeviceAddress, DrawHead, FrameCounts, FrameData, FrameInput, ListHead, Object, SceneData};
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::{HierarchicalEdit, VertexInterpolation};
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::scheme::Scheme;
use planish_subdiv::tables::{BasisCache, BasisCounts, BasisOptions, MeshRanges, NoCache, Tables, TexTree};

use crate::buffers::{FrameBuffers, ListBuffers, TableBuffers};
use crate::camera::FrameCamera;
use crate::colors::ColorBuffers;
use crate::deform::DeformBuffers;
use crate::density::frame_input;
use crate::displacement::{DisplacementDesc, Maps, TexCoordBuffers};
use crate::error::Error;
use crate::lists::{Capacities, Phases, Status};
use crate::marks::Marks;
use crate::motion::MotionBuffers;
use crate::objects::{CageFacts, MeshFacts, ObjectDesc};
use crate::options::{Culling, EndCap, FrameOptions, GregoryPoints, SurfaceMethod, TableNormals, TableWeights};
use crate::upload::address;

/// What to make of cages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceDesc {
    /// Surface method.
    pub method: SurfaceMethod,
    /// No irregularity is isolated deeper ([`crate::density::isolation_level`]).
    pub level: u32,
    /// Which creases are patches of their own.
    pub crease_patches: CreasePatches,
    /// What irregular faces of the deepest level are drawn as.
    pub end_cap: EndCap,
    /// Meshes may be displaced ([`Surface::displace`]).
    pub displaced: bool,
    /// How the control points of Gregory patches are made.
    pub gregory_points: GregoryPoints,
    /// Subdivision scheme; all methods but [`SurfaceMethod::Table`] know Catmull-Clark alone.
    pub scheme: Scheme,
    /// Where normals of surfaces by table come from.
    pub table_normals: TableNormals,
    /// How weights of tables are stored.
    pub table_weights: TableWeights,
}

impl SurfaceDesc {
    /// Whether some irregular faces are Gregory patches.
    pub fn has_gregory_patches(&self) -> bool {
        let is_capped = self.end_cap == EndCap::Gregory && self.method != SurfaceMethod::Uniform;
        self.method.is_one_patch_a_face() || is_capped
    }

    /// Whether faces are those of Catmull-Clark's scheme, which texture coordinates are subdivided by.
    pub fn has_tex_coords(&self) -> bool {
        self.scheme == Scheme::CatmullClark && !self.method.is_substitute()
    }

    /// Whether normals are made of those of vertices.
    pub fn has_vertex_normals(&self) -> bool {
        self.basis_options().is_some_and(|options| options.ring_level.is_some())
    }

    /// What is made of cages whose faces are grids.
    pub fn basis_options(&self) -> Option<BasisOptions> {
        let &Self { method, scheme, table_normals, .. } = self;
        if method.is_substitute() {
            // Faces as they are: Loop and Stam's are triangles and quads.
            let scheme = if method == SurfaceMethod::Pn { Scheme::Loop } else { Scheme::LoopStam };
            let level = SUBSTITUTE_LEVEL;
            return Some(BasisOptions { scheme, steps: 0, level, ring_level: Some(0), has_weights: false });
        }
        let (steps, ring_level) = match table_normals {
            TableNormals::Tangents => (1, None),
            TableNormals::Geometric => (1, Some(1)),
            TableNormals::Subdivision(start) => (start.clamp(1, 2), Some(start.min(2))),
        };
        let options = BasisOptions { scheme, steps, level: TABLE_LEVEL + 1 - steps, ring_level, has_weights: true };
        (method == SurfaceMethod::Table).then_some(options)
    }

    /// Whether regular patches may have a semi-sharp crease.
    pub(crate) fn has_creased_patches(&self) -> bool {
        self.method != SurfaceMethod::Uniform && self.crease_patches == CreasePatches::Single
    }
}

/// Times of the work that is done once a topology, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PreprocessTimes {
    /// Refinement.
    pub topology: f64,
    /// Stencils, limit rows and patches.
    pub tables: f64,
    /// Buffers made and filled.
    pub upload: f64,
}

/// Bytes of GPU memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryBytes {
    /// What depends on connectivity alone.
    pub tables: u64,
    /// Points of all levels and limit points.
    pub points: u64,
    /// Objects, densities, marks, lists and draws.
    pub lists: u64,
}

/// The tables of meshes, and how long they took.
#[derive(Clone, Debug)]
pub struct Preprocessed {
    /// The tables of all meshes.
    pub tables: Tables,
    /// Each mesh's part of them.
    pub meshes: Vec<MeshRanges>,
    /// Times; `upload` is 0.
    pub times: PreprocessTimes,
    /// Where tables of configurations came from, of method `table`.
    pub basis_counts: BasisCounts,
}

/// Level of tables after one step: 32 segments a side of a face, 64 a side of the cage's.
const TABLE_LEVEL: u32 = 5;
/// Level of grids of substitutes: as many segments a side of the cage's faces.
const SUBSTITUTE_LEVEL: u32 = 6;

/// Refuses faces that a substitute has no patch for.
fn check_substitute(mesh: &ControlMesh, method: SurfaceMethod, scheme: Scheme) -> Result<(), Error> {
    let found = (0..).zip(&mesh.face_sizes).find(|(_, sides)| method.is_substitute() && !scheme.accepts(**sides));
    match found {
        None => Ok(()),
        Some((face, &sides)) => {
            let method = if method == SurfaceMethod::Pn { "pn" } else { "flat and phong" };
            Err(Error::SubstituteFace { method, face, sides, accepted: scheme.accepted() })
        }
    }
}

/// Refuses what schemes that are there to compare with have no part in.
fn refuse_rival(desc: &SurfaceDesc, is_asked: bool, what: &'static str) -> Result<(), Error> {
    match desc.method.rival().filter(|_| is_asked) {
        Some(rival) => Err(Error::Rival { method: rival.name(), what }),
        None => Ok(()),
    }
}

fn has_vertex_colors(mesh: &ControlMesh) -> bool {
    mesh.colors.as_ref().is_some_and(|colors| colors.interpolation == VertexInterpolation::Vertex)
}

/// Refines cages and builds their tables, on one thread of the CPU.
pub fn preprocess(meshes: &[&ControlMesh], desc: &SurfaceDesc) -> Result<Preprocessed, Error> {
    preprocess_cached(meshes, desc, &NoCache)
}

/// As [`preprocess`]; tables of limit weights that a cache has are not made again.
pub fn preprocess_cached(
    meshes: &[&ControlMesh],
    desc: &SurfaceDesc,
    cache: &dyn BasisCache,
) -> Result<Preprocessed, Error> {
    let options = RefineOptions {
        max_level: desc.level,
        uniform: desc.method == SurfaceMethod::Uniform,
        crease_patches: desc.crease_patches,
        displaced: desc.displaced,
        gregory: desc.has_gregory_patches(),
        rival: desc.method.rival(),
        gregory_stencils: desc.method == SurfaceMethod::Gregory && desc.gregory_points == GregoryPoints::Stencil,
        ignores_channels: !desc.displaced,
    };
    refuse_rival(desc, desc.displaced, "displacement map")?;
    if desc.method.is_grid() && meshes.iter().any(|mesh| has_vertex_colors(mesh)) {
        return Err(Error::SubdividedColors);
    }
    refuse_rival(
        desc,
        meshes.iter().any(|mesh| has_vertex_colors(mesh)),
        "colours that are subdivided as positions are",
    )?;
    let mut times = PreprocessTimes::default();
    let mut basis_counts = BasisCounts::default();
    let mut parts: Vec<Tables> = Vec::with_capacity(meshes.len());
    for (index, mesh) in meshes.iter().enumerate() {
        let start = Instant::now();
        // Poses of one character, say: tables know nothing of positions.
        if let Some(twin) = meshes[..index].iter().position(|earlier| mesh.has_tables_of(earlier)) {
            parts.push(parts[twin].clone());
            times.tables += milliseconds(start);
            continue;
        }
        if let Some(options) = desc.basis_options() {
            check_substitute(mesh, desc.method, options.scheme)?;
            let (tables, counts) = Tables::of_basis_cached(mesh, &options, cache)?;
            parts.push(tables);
            basis_counts.read += counts.read;
            basis_counts.built += counts.built;
            times.tables += milliseconds(start);
            continue;
        }
        let refinement = Refinement::new(mesh, options)?;
        times.topology += milliseconds(start);
        let start = Instant::now();
        parts.push(Tables::new(&refinement));
        times.tables += milliseconds(start);
    }
    let start = Instant::now();
    let (tables, meshes) = Tables::merge(parts)?;
    times.tables += milliseconds(start);
    Ok(Preprocessed { tables, meshes, times, basis_counts })
}

/// Meshes and objects on the GPU. Everything is kept alive by the surface: it must outlive the frames recorded with it.
pub struct Surface {
    pub(crate) desc: SurfaceDesc,
    pub(crate) tables: Tables,
    pub(crate) meshes: Vec<MeshRanges>,
    pub(crate) objects: Vec<Object>,
    /// The mesh of each object.
    pub(crate) object_meshes: Vec<usize>,
    pub(crate) phases: Phases,
    pub(crate) buffers: TableBuffers,
    pub(crate) frame: FrameBuffers,
    pub(crate) lists: ListBuffers,
    capacities: Capacities,
    pub(crate) maps: Maps,
    pub(crate) tex_coords: TexCoordBuffers,
    pub(crate) colors: ColorBuffers,
    pub(crate) deform: Option<DeformBuffers>,
    pub(crate) motion: Option<MotionBuffers>,
    /// What is known of each mesh's cage, and by how much its map displaces.
    pub(crate) cage_facts: Vec<CageFacts>,
    pub(crate) displacement_bounds: Vec<f32>,
    pub(crate) next_camera: Option<FrameCamera>,
    pub(crate) crop: Option<[u32; 4]>,
    marks: Marks,
    density_scales: Vec<f32>,
    sub_pixel_bits: u32,
    times: PreprocessTimes,
    /// Address of the materials that have holes, or 0.
    materials: u64,
}

impl Surface {
    /// Uploads what [`preprocess`] made of the meshes, and their cages' positions.
    pub fn new(
        device: &Device,
        meshes: &[&ControlMesh],
        objects: &[ObjectDesc],
        desc: SurfaceDesc,
        made: Preprocessed,
    ) -> Result<Self, Error> {
        Self::with_capacity(device, meshes, objects, desc, made, None)
    }

    /// As [`Self::new`], with lists of at most so many entries to begin with. For tests of lists that overflow.
    pub fn with_capacity(
        device: &Device,
        meshes: &[&ControlMesh],
        objects: &[ObjectDesc],
        desc: SurfaceDesc,
        made: Preprocessed,
        capacity: Option<u32>,
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let Preprocessed { tables, meshes: ranges, mut times, .. } = made;
        let facts: Vec<MeshFacts> =
            meshes.iter().zip(&ranges).map(|(mesh, range)| MeshFacts::new(mesh, range, desc.scheme)).collect();
        let (gpu_objects, sizes) = crate::objects::objects(objects, &facts, &ranges);
        let phases = Phases::new(&tables);
        let marks = Marks::new(&phases);
        let density_scales = density_scales(meshes, &ranges, tables.cage_point_count);
        let capacities = Capacities::new(objects, &ranges, device.is_software(), capacity);
        let buffers = TableBuffers::new(device, &tables, &marks, &density_scales, desc.table_weights)?;
        let frame = FrameBuffers::new(device, &tables, &gpu_objects, &sizes, &marks)?;
        let lists = ListBuffers::new(device, &capacities, &phases, desc.method)?;
        let tex_coords = if desc.displaced && desc.method == SurfaceMethod::Gregory {
            TexCoordBuffers::of_tables_and_tree(device, &tables, &tex_tree(meshes, &ranges)?)?
        } else {
            TexCoordBuffers::of_tables(device, &tables)?
        };
        let colors = ColorBuffers::none(device)?;
        times.upload = milliseconds(start);
        let sub_pixel_bits = device.limits().sub_pixel_bits;
        let mut surface = Self {
            desc,
            tables,
            meshes: ranges,
            objects: gpu_objects,
            object_meshes: objects.iter().map(|object| object.mesh).collect(),
            phases,
            buffers,
            frame,
            lists,
            capacities,
            maps: Maps::default(),
            tex_coords,
            colors,
            deform: None,
            motion: None,
            cage_facts: facts.iter().map(|facts| facts.cage).collect(),
            displacement_bounds: vec![0.0; meshes.len()],
            next_camera: None,
            crop: None,
            marks,
            density_scales,
            sub_pixel_bits,
            times,
            materials: 0,
        };
        surface.write_scene()?;
        for (mesh, cage) in meshes.iter().enumerate() {
            surface.set_cage(mesh, &cage.positions)?;
        }
        let edits: Vec<HierarchicalEdit> = meshes.iter().flat_map(|mesh| mesh.edits.iter().cloned()).collect();
        surface.set_edits(&edits)?;
        Ok(surface)
    }

    /// Sets the positions of a cage's vertices, for all frames submitted from now on.
    ///
    /// # Panics
    /// If there are not as many positions as cage vertices.
    pub fn set_cage(&mut self, mesh: usize, positions: &[[f32; 3]]) -> Result<(), Error> {
        let ranges = &self.meshes[mesh];
        let range = &ranges.cage_points;
        assert_eq!(positions.len(), range.len(), "positions of cage {mesh}");
        if positions.is_empty() {
            return Ok(());
        }
        self.frame.cage.write(cage_offset(ranges), positions)?;
        // Objects are culled by the boxes around their cages, which have moved along.
        let neighbours = &self.tables.slots.neighbours;
        let edges = (0..range.len() as u32)
            .flat_map(|vertex| neighbours.of(ranges.slots.start + vertex).iter().map(move |&other| [vertex, other]));
        let facts = CageFacts::new(positions, edges);
        self.cage_facts[mesh] = facts;
        for (object, _) in self.objects.iter_mut().zip(&self.object_meshes).filter(|(_, of)| **of == mesh) {
            facts.set(object);
        }
        Ok(self.frame.objects.write(0, &self.objects)?)
    }

    /// Gives a mesh, which has this cage, a displacement map. Frames must be recorded anew then.
    ///
    /// # Panics
    /// If the surface was not made to be displaced.
    pub fn displace(
        &mut self,
        device: &Device,
        mesh: usize,
        cage: &ControlMesh,
        map: &DisplacementDesc<'_>,
    ) -> Result<(), Error> {
        assert!(self.desc.displaced, "a surface that is made to be displaced");
        let place = self.maps.add(device, map, cage, &self.tables.slots, &self.meshes[mesh])?;
        self.displacement_bounds[mesh] = map.bound;
        for (object, _) in self.objects.iter_mut().zip(&self.object_meshes).filter(|(_, of)| **of == mesh) {
            crate::objects::displace(object, place, map.bound);
        }
        self.frame.objects.write(0, &self.objects)?;
        self.write_scene()
    }

    /// Gives the meshes, which have these cages, their texture coordinates where nothing is displaced. Frames must be recorded anew then.
    pub fn set_tex_coords(&mut self, device: &Device, meshes: &[&ControlMesh]) -> Result<(), Error> {
        // They are part of the tables; or other schemes' faces are not those that they lie on.
        if self.desc.displaced || !self.desc.has_tex_coords() {
            return Ok(());
        }
        self.tex_coords = TexCoordBuffers::of_tree(device, &tex_tree(meshes, &self.meshes)?)?;
        self.write_scene()
    }

    /// Gives the meshes, which have these cages, their colours; until then all are white. Frames must be recorded anew then.
    pub fn set_colors(&mut self, device: &Device, meshes: &[&ControlMesh]) -> Result<(), Error> {
        self.colors = ColorBuffers::new(device, meshes, &self.meshes, &self.tables)?;
        for (object, &mesh) in self.objects.iter_mut().zip(&self.object_meshes) {
            crate::objects::color(object, meshes[mesh].colors.as_ref().map(|colors| colors.interpolation));
        }
        self.frame.objects.write(0, &self.objects)?;
        self.write_scene()
    }

    /// Says where the materials are that have holes ([`crate::FrameNeeds::cutouts`]).
    pub(crate) fn set_materials(&mut self, address: u64) -> Result<(), Error> {
        self.materials = address;
        self.write_scene()
    }

    /// Sets the values of the hierarchical edits that set or move points, for all frames submitted from now on: only
    /// their offsets are uploaded. The edits are the meshes', one mesh after the other in their order, with other values.
    ///
    /// # Panics
    /// If there are fewer edits than the meshes had.
    pub fn set_edits(&self, edits: &[HierarchicalEdit]) -> Result<(), Error> {
        let offsets: Vec<[f32; 3]> = self.tables.point_edits(edits).iter().map(|edit| edit.offset).collect();
        if !offsets.is_empty() {
            self.frame.edit_offsets.write(0, &offsets)?;
        }
        Ok(())
    }

    /// Draws a part of the image alone: left, top, width and height in pixels. What is drawn there is what it is in the whole image, and
    /// what lies outside is culled where anything is. Frames must be recorded anew then.
    pub fn set_crop(&mut self, crop: Option<[u32; 4]>) {
        self.crop = crop;
    }

    /// The part of the image that is drawn; none: all of it.
    pub fn crop(&self) -> Option<[u32; 4]> {
        self.crop
    }

    /// Sets what all frames submitted from now on are to be: seen by this camera, selected and culled so. A recording of draws has
    /// its camera's matrix besides.
    pub fn set_frame(&self, camera: &FrameCamera, options: &FrameOptions) -> Result<(), Error> {
        self.frame.input.write(0, &[self.frame_input(camera, options)?])?;
        let next = self.next_camera.as_ref().unwrap_or(camera);
        let data = FrameData {
            scene: address(&self.frame.scene),
            world_to_camera: camera.world_to_camera.to_cols_array_2d(),
            next_view_projection: next.view_projection().to_cols_array_2d(),
        };
        Ok(self.frame.data.write(0, &[data])?)
    }

    /// What [`Self::set_frame`] tells the kernels. Of methods that are there to compare with nothing is culled, whatever is asked.
    pub fn frame_input(&self, camera: &FrameCamera, options: &FrameOptions) -> Result<FrameInput, Error> {
        let mut options = *options;
        if self.desc.method.rival().is_some() {
            // What is tested are the points of Gregory patches.
            options.culling = Culling::Off;
        }
        let input = frame_input(camera, &options, self.desc.level, self.objects.len() as u32, self.sub_pixel_bits)?;
        Ok(match self.crop {
            Some(crop) => FrameInput {
                view: crate::emit::emit_view(&camera.cropped(crop), options.culling, self.sub_pixel_bits),
                ..input
            },
            None => input,
        })
    }

    /// Makes room for what did not fit in the last frame's lists; whether there was anything. Frames must be recorded anew then.
    pub fn grow(&mut self, device: &Device) -> Result<bool, Error> {
        let Some(grown) = self.capacities.grown(&self.status()?) else { return Ok(false) };
        self.lists = ListBuffers::new(device, &grown, &self.phases, self.desc.method)?;
        self.capacities = grown;
        self.write_scene()?;
        Ok(true)
    }

    pub(crate) fn write_scene(&self) -> Result<(), Error> {
        let (tables, frame, lists) = (&self.buffers, &self.frame, &self.lists);
        let data = SceneData {
            frame_input: address(&frame.input),
            objects: address(&frame.objects),
            points: address(&frame.points),
            limits: address(&frame.limits),
            patches: address(&tables.patches),
            seams: address(&tables.seams),
            irregular: address(&tables.irregular),
            gregory: address(&tables.gregory),
            spokes: address(&frame.spoke_points),
            spoke_middles: address(&frame.spoke_middles),
            stencils: address(&tables.stencil_faces),
            stencil_points: address(&tables.stencil_rings),
            stencil_weights: address(&tables.stencil_weights),
            table_normals: address(&tables.basis.normals),
            table_patches: address(&tables.basis.patches),
            table_edges: address(&tables.basis.edges),
            table_controls: address(&tables.basis.controls),
            table_weights: address(&tables.basis.weights),
            table_tangents: address(&tables.basis.tangents),
            short_weights: address(&tables.basis.weights),
            short_tangents: address(&tables.basis.tangents),
            ptex_faces: address(&tables.ptex_faces),
            neighbour_first: address(&tables.neighbours[0]),
            neighbours: address(&tables.neighbours[1]),
            ring_first: address(&tables.rings[0]),
            rings: address(&tables.rings[1]),
            density_scales: address(&tables.density_scales),
            star_first: address(&tables.stars[0]),
            star_marks_of: address(&tables.stars[1]),
            maps: self.maps.tables.as_ref().map_or_else(DeviceAddress::null, |[maps, _]| address(maps)),
            texel_counts: self.maps.tables.as_ref().map_or_else(DeviceAddress::null, |[_, counts]| address(counts)),
            tex_coords: address(&self.tex_coords.values),
            patch_tex_coords: address(&self.tex_coords.patches),
            face_tex_coords: address(&self.tex_coords.faces),
            tex_nodes: address(&self.tex_coords.nodes),
            tex_roots: address(&self.tex_coords.roots),
            point_colors: address(&self.colors.points),
            limit_colors: address(&self.colors.limits),
            gregory_colors: address(&self.colors.gregory),
            next_points: self.motion.as_ref().map_or_else(DeviceAddress::null, |next| address(&next.points)),
            next_limits: self.motion.as_ref().map_or_else(DeviceAddress::null, |next| address(&next.limits)),
            slot_colors: address(&self.colors.slots),
            limit_seats: address(&tables.limit_seats),
            limit_tangents: address(&frame.limit_tangents),
            densities: address(&frame.densities),
            split_edges: address(&frame.split_edges),
            star_marks: address(&frame.star_marks),
            marks: address(&frame.marks),
            mark_groups: address(&tables.mark_groups),
            in_use: address(&frame.in_use),
            chunks: address(&lists.chunks),
            active_faces: address(&lists.active),
            patch_items: address(&lists.items[0]),
            leaf_items: address(&lists.items[1]),
            cut_items: address(&lists.items[2]),
            cut_gregory_items: address(&lists.items[3]),
            heads: address(&lists.heads),
            draw_heads: address(&lists.draw_heads),
            entries: address(&lists.entries),
            draws: address(&lists.draws),
            counts: address(&frame.counts),
            chunk_first: self.capacities.first_chunks(),
            first_active: self.capacities.first_active(),
            mark_group_count: self.marks.groups.len() as u32,
            first_limit_mark: self.marks.first_limit,
            table_level: self.tables.basis.level,
            table_steps: self.tables.basis.steps,
            short_scale: tables.basis.short_scale,
            materials: [self.materials as u32, (self.materials >> 32) as u32],
            ..SceneData::default()
        };
        Ok(frame.scene.write(0, &[data])?)
    }

    /// What the surface was made as.
    pub fn desc(&self) -> &SurfaceDesc {
        &self.desc
    }

    /// The tables of all meshes.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// Each mesh's part of the tables.
    pub fn meshes(&self) -> &[MeshRanges] {
        &self.meshes
    }

    /// The objects, as the kernels read them.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// Scale of the density at each cage point.
    pub fn density_scales(&self) -> &[f32] {
        &self.density_scales
    }

    /// How much fits into the lists.
    pub fn capacities(&self) -> &Capacities {
        &self.capacities
    }

    /// The phases of subdivision.
    pub fn phases(&self) -> &Phases {
        &self.phases
    }

    /// Times of the work done once.
    pub fn times(&self) -> PreprocessTimes {
        self.times
    }

    /// Bytes of GPU memory in use.
    pub fn memory(&self) -> MemoryBytes {
        let frame = &self.frame;
        let points = frame.cage.size() + frame.points.size() + frame.limits.size();
        let lists = frame.all().iter().chain(&self.lists.all()).map(|buffer| buffer.size()).sum::<u64>() - points;
        MemoryBytes { tables: self.buffers.all().iter().map(|buffer| buffer.size()).sum(), points, lists }
    }

    /// What the last frame that was waited for left in its lists.
    pub fn status(&self) -> Result<Status, Error> {
        let counts: Vec<FrameCounts> = self.frame.counts_read.read(0, 1)?;
        let draw_heads: Vec<DrawHead> = self.lists.draw_heads_read.read(0, crate::lists::KIND_COUNT)?;
        Ok(Status {
            heads: self.lists.heads_read.read::<ListHead>(0, crate::lists::LIST_COUNT)?,
            draw_heads: std::array::from_fn(|kind| draw_heads[kind]),
            counts: counts[0],
        })
    }

    /// The points of all levels as the last frame left them; waits for the device. For tests.
    pub fn download_points(&self, device: &Device) -> Result<Vec<[f32; 3]>, Error> {
        Ok(device.download(&self.frame.points, 0, self.tables.point_count() as usize)?)
    }

    /// The objects as the last frame left them; waits for the device. For tests.
    pub fn download_objects(&self, device: &Device) -> Result<Vec<Object>, Error> {
        Ok(device.download(&self.frame.objects, 0, self.objects.len())?)
    }

    /// The limit points as the last frame left them; waits for the device. For tests.
    pub fn download_limits(&self, device: &Device) -> Result<Vec<shaders::LimitPoint>, Error> {
        Ok(device.download(&self.frame.limits, 0, self.tables.limit_point_count() as usize)?)
    }

    /// The spokes of limit points as the last frame left them; waits for the device. For tests.
    pub fn download_spokes(&self, device: &Device) -> Result<Vec<shaders::SpokePoint>, Error> {
        Ok(device.download(&self.frame.spoke_points, 0, self.tables.gregory.spoke_count() as usize)?)
    }

    /// The middles of spokes of ACC or Pm-patches as the last frame left them; waits for the device. For tests.
    pub fn download_spoke_middles(&self, device: &Device) -> Result<Vec<[f32; 3]>, Error> {
        Ok(device.download(&self.frame.spoke_middles, 0, self.tables.gregory.rival_spokes.len())?)
    }

    /// The normals of the points of all levels as the last frame left them; waits for the device. For tests.
    pub fn download_vertex_normals(&self, device: &Device) -> Result<Vec<[f32; 3]>, Error> {
        Ok(device.download(&self.buffers.basis.normals, 0, self.tables.point_count() as usize)?)
    }

    /// Densities of all objects' slots as the last frame left them; waits for the device.
    pub fn download_densities(&self, device: &Device) -> Result<Vec<shaders::SlotDensity>, Error> {
        let count = self.frame.densities.size() as usize / size_of::<shaders::SlotDensity>();
        Ok(device.download(&self.frame.densities, 0, count)?)
    }

    /// Rows in use of each phase, in ascending order, and then limit points, as the last frame listed them; waits for the
    /// device. For tests.
    pub fn download_rows_in_use(&self, device: &Device) -> Result<Vec<Vec<u32>>, Error> {
        let status = self.status()?;
        let mut phases = Vec::new();
        for (phase, first) in self.phases.first_items().into_iter().enumerate() {
            let count = status.heads[crate::lists::LIST_PHASES + phase].count as usize;
            let mut rows: Vec<u32> = device.download(&self.frame.in_use, 4 * u64::from(first), count)?;
            rows.sort_unstable();
            phases.push(rows);
        }
        Ok(phases)
    }

    /// The patches of a kind that the last frame listed to draw; waits for the device.
    pub fn download_entries(&self, device: &Device, range: Range<u32>) -> Result<Vec<shaders::DrawEntry>, Error> {
        let offset = u64::from(range.start) * size_of::<shaders::DrawEntry>() as u64;
        Ok(device.download(&self.lists.entries, offset, range.len())?)
    }
}

/// Where a mesh's cage begins in the buffer of all.
pub(crate) fn cage_offset(ranges: &MeshRanges) -> u64 {
    u64::from(ranges.cage_points.start) * size_of::<[f32; 3]>() as u64
}

/// The trees of the meshes' first channels.
fn tex_tree(meshes: &[&ControlMesh], ranges: &[MeshRanges]) -> Result<TexTree, Error> {
    let trees = meshes.iter().zip(ranges);
    let trees: Result<Vec<_>, Error> =
        trees.map(|(mesh, ranges)| Ok((ranges.ptex_faces.len() as u32, TexTree::new(mesh)?))).collect();
    Ok(TexTree::merged(&trees?))
}

/// Scales of the densities at all cage points.
fn density_scales(meshes: &[&ControlMesh], ranges: &[MeshRanges], count: u32) -> Vec<f32> {
    let mut scales = vec![1.0; count as usize];
    for (mesh, range) in meshes.iter().zip(ranges) {
        for (vertex, &scale) in mesh.density.iter().enumerate() {
            scales[range.cage_points.start as usize + vertex] = scale;
        }
    }
    scales
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
