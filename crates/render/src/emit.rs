//! The emit stage: which patches are drawn, in how many pieces, and the draws of them. Shaders: `glsl/emit.comp`, and
//! `glsl/finish_lists.comp`, which closes the lists. The twin for Gregory patches is in `emit_gregory.rs`.

use planish_gpu::{ComputePipeline, Device, Encoder, Feature, SpecConstant};
use planish_shaders as shaders;
use planish_shaders::{DrawEntry, EmitPush, EmitView, LimitPoint, Object, SpokePoint};
use planish_subdiv::patch::{PatchInfo, RegularPatch};
use planish_subdiv::selection::{Cut, density_at};
use planish_subdiv::tables::{GregoryKind, MeshRanges, Tables};
use planish_subdiv::topology::NONE;

use crate::camera::FrameCamera;
use crate::error::Error;
use crate::factors::{Grain, PatchFactors, triangle_count};
use crate::lists::{CHUNK, KIND_COUNT, LIST_BASE, LIST_CUT, LIST_CUT_GREGORY, LIST_LEAVES, LIST_PATCHES, PatchKind};
use crate::objects::to_world;
use crate::options::{Culling, FrameNeeds, GregoryPoints, Spacing};
use crate::program::{compute_pipeline, specialized_compute_pipeline};
use crate::select::head_offset;
use crate::surface::Surface;
use crate::upload::address;
use crate::visibility::{bezier_part, bezier_patch, is_patch_unseen, is_quad_unseen};

/// Vertices that a draw should generate on a software driver: on Mesa 22.3's, larger batches cost more by their square,
/// smaller ones by their number (`planish bench --tess`).
const BATCH_VERTICES: u32 = 512;

/// Vertices that a draw should generate on this device; 0: any number.
pub(crate) fn batch_vertices(device: &Device) -> u32 {
    if device.is_software() && device.has(Feature::DrawIndirectCount) { BATCH_VERTICES } else { 0 }
}

/// The stage's programs.
pub(crate) struct Emit {
    patches: ComputePipeline,
    leaves: Vec<ComputePipeline>,
    cut: Option<ComputePipeline>,
    cut_gregory: Option<ComputePipeline>,
    finish: ComputePipeline,
}

impl Emit {
    pub fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        let batch = batch_vertices(device);
        let spec = [
            SpecConstant { id: shaders::emit_patches_comp::SPEC_SPACING, bits: needs.spacing.constant() },
            SpecConstant { id: shaders::emit_patches_comp::SPEC_BATCH_VERTICES, bits: batch },
            SpecConstant { id: shaders::emit_patches_comp::SPEC_PLACED, bits: u32::from(needs.placed) },
            SpecConstant { id: shaders::emit_patches_comp::SPEC_CULL, bits: u32::from(needs.culls) },
        ];
        let pipeline = |module| specialized_compute_pipeline(device, module, CHUNK, &spec);
        // Filling quads are told from Gregory patches where there are both.
        let gregory = SpecConstant { id: shaders::emit_leaves_comp::SPEC_GREGORY, bits: u32::from(needs.gregory) };
        let leaf_spec: Vec<SpecConstant> = spec.into_iter().chain([gregory]).collect();
        let stencils = u32::from(needs.gregory_points == GregoryPoints::Stencil);
        let stencils = SpecConstant { id: shaders::emit_gregory_comp::SPEC_STENCIL, bits: stencils };
        let gregory_spec: Vec<SpecConstant> = spec.into_iter().chain([stencils]).collect();
        let gregory =
            || specialized_compute_pipeline(device, &shaders::emit_gregory_comp::PROGRAM, CHUNK, &gregory_spec);
        Ok(Self {
            patches: pipeline(&shaders::emit_patches_comp::PROGRAM)?,
            leaves: [
                (needs.filling || !needs.gregory).then(|| {
                    specialized_compute_pipeline(device, &shaders::emit_leaves_comp::PROGRAM, CHUNK, &leaf_spec)
                }),
                needs.gregory.then(gregory),
            ]
            .into_iter()
            .flatten()
            .collect::<Result<_, _>>()?,
            cut: if needs.cuts { Some(pipeline(&shaders::emit_cut_comp::PROGRAM)?) } else { None },
            cut_gregory: if needs.cuts && needs.gregory {
                Some(pipeline(&shaders::emit_gregory_cut_comp::PROGRAM)?)
            } else {
                None
            },
            finish: compute_pipeline(device, &shaders::finish_lists_comp::PROGRAM)?,
        })
    }

    /// Records the stage: a dispatch for each kind of list, of leaves one for filling quads and one for Gregory patches. Takes the time
    /// `emit`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let scene = address(&surface.frame.scene);
        let heads = &surface.lists.heads;
        let push = |list: usize| EmitPush { scene, list: list as u32, ..EmitPush::default() };
        encoder.compute_indirect(&self.patches, &push(LIST_BASE), heads, head_offset(LIST_BASE));
        encoder.compute_indirect_more(&self.patches, &push(LIST_PATCHES), heads, head_offset(LIST_PATCHES));
        for leaves in &self.leaves {
            encoder.compute_indirect_more(leaves, &push(LIST_LEAVES), heads, head_offset(LIST_LEAVES));
        }
        if let Some(cut) = &self.cut {
            encoder.compute_indirect(cut, &push(LIST_CUT), heads, head_offset(LIST_CUT));
        }
        if let Some(cut) = &self.cut_gregory {
            encoder.compute_indirect_more(cut, &push(LIST_CUT_GREGORY), heads, head_offset(LIST_CUT_GREGORY));
        }
        let push = shaders::finish_lists_comp::Push { heads: address(&surface.lists.draw_heads) };
        encoder.compute(&self.finish, &push, CHUNK);
        encoder.timestamp("emit");
    }
}

/// What a camera sees. The rasterizer rounds to `sub_pixel_bits` bits behind the point of a pixel.
pub fn emit_view(camera: &FrameCamera, culling: Culling, sub_pixel_bits: u32) -> EmitView {
    let clip = camera.view_projection();
    let [dx, dy] = camera.pixel_steps();
    // To the nearest point of the grid: both coordinates move by half a step at most.
    let snap_pixels = std::f32::consts::FRAC_1_SQRT_2 * (-(sub_pixel_bits as f32)).exp2();
    EmitView {
        eye: camera.eye().to_array(),
        clip_x: clip.row(0).truncate().to_array(),
        clip_y: clip.row(1).truncate().to_array(),
        clip_w: clip.row(3).truncate().to_array(),
        near: camera.near(),
        snap: snap_pixels * dx.length().max(dy.length()),
        cull: match culling {
            Culling::Off => 0,
            Culling::Unseen => 1,
            Culling::UnseenAndBacks => 2,
        },
    }
}

/// What the stage makes of one object: entries of each kind, ascending.
pub type Emitted = [Vec<DrawEntry>; KIND_COUNT];

/// What the twin needs to know of an object.
pub struct EmitInput<'a> {
    /// Tables of all meshes.
    pub tables: &'a Tables,
    /// The object's mesh.
    pub mesh: &'a MeshRanges,
    /// The object, and its number.
    pub object: (&'a Object, u32),
    /// What was selected of it.
    pub cut: &'a Cut,
    /// Densities of its slots.
    pub densities: &'a [f32],
    /// Points of all levels.
    pub points: &'a [[f32; 3]],
    /// Limit points.
    pub limits: &'a [LimitPoint],
    /// Spokes; none where no face is a Gregory patch.
    pub spokes: &'a [SpokePoint],
    /// The view.
    pub view: &'a EmitView,
    /// Spacing.
    pub spacing: Spacing,
}

/// CPU twin: bit for bit as the shaders make it where f32 arithmetic is not fused; lists are in ascending order.
pub fn emit(input: &EmitInput<'_>) -> Emitted {
    let mut emitted = Emitted::default();
    let mut is_split = vec![false; input.tables.edge_count as usize];
    input.cut.split_edges.iter().for_each(|&edge| is_split[edge as usize] = true);
    let split_edges = |edges: &[u32; 4]| {
        (0..4).fold(0, |mask, i| {
            let edge = edges[i];
            mask | u32::from(edge != NONE && is_split[edge as usize]) << i
        })
    };
    let patches = input.mesh.patches[0].clone().chain(input.cut.patches.iter().copied());
    for place in patches {
        let patch = &input.tables.patches[place as usize];
        input.patch(place, patch, split_edges(&patch.edges), &mut emitted);
    }
    for leaf in &input.cut.leaves {
        let face = &input.tables.irregular[leaf.face as usize];
        let split_edges = split_edges(&face.edges);
        match input.tables.gregory.faces.get(leaf.face as usize).filter(|face| face.kind != GregoryKind::None) {
            Some(gregory) => input.gregory_leaf(leaf.face, gregory, split_edges, &mut emitted),
            None => input.leaf(leaf.face, face, split_edges, &mut emitted),
        }
    }
    for entries in &mut emitted {
        entries.sort_by_key(|entry| (entry.place, entry.flags));
    }
    emitted
}

impl EmitInput<'_> {
    pub(crate) fn is_culled(&self) -> bool {
        self.view.cull != 0
    }

    /// OBJECT_HIDES_BACKS and not OBJECT_MIRRORED.
    pub(crate) fn culls_back(&self) -> bool {
        self.view.cull == 2 && self.object.0.flags & 6 == 2
    }

    pub(crate) fn entry(&self, place: u32, flags: u32, triangles: u32, factors: &PatchFactors) -> DrawEntry {
        let PatchFactors { low, high, inner, .. } = *factors;
        DrawEntry { place, object: self.object.1, flags, triangles, low, high, inner }
    }

    pub(crate) fn factors(&self, info: &PatchInfo, split_edges: u32) -> PatchFactors {
        let corners = self.tables.ptex_faces[(self.mesh.ptex_faces.start + info.location.ptex_face) as usize];
        PatchFactors::new(|u, v| density_at(self.densities, corners, u, v), info, split_edges, self.spacing)
    }

    fn patch(&self, place: u32, patch: &RegularPatch, split_edges: u32, emitted: &mut Emitted) {
        let factors = self.factors(&patch.info, split_edges);
        let pieces = factors.cut_count();
        let displacement = self.object.0.displacement;
        // The tangents of a patch with a semi-sharp crease are not those of its control points: it is always drawn.
        let is_tested = self.is_culled() && patch.sharpness == 0.0;
        let mut points = patch.points.map(|point| to_world(self.object.0, self.points[point as usize]));
        reflect_points(&mut points, patch.info.boundary);
        let bezier = bezier_patch(&points);
        let cull_back = self.culls_back() && pieces == 1;
        if is_tested && is_patch_unseen(&bezier, self.view, &factors.grain(), cull_back, displacement) {
            return;
        }
        if pieces == 1 {
            let kind = if split_edges == 0 { PatchKind::Regular } else { PatchKind::Transition };
            return emitted[kind as usize].push(self.entry(place, split_edges, factors.triangle_count(), &factors));
        }
        for i in 0..pieces * pieces {
            let piece = [i % pieces, i / pieces];
            let own = factors.piece(pieces, piece);
            let mut part = bezier;
            bezier_part(&mut part, own.low, own.high);
            let grain = Grain { grain: 1.0, reach: 0.0, skew: 0.0, is_uneven: false };
            if !(is_tested && is_patch_unseen(&part, self.view, &grain, false, displacement)) {
                let flags = split_edges | piece[0] << 4 | piece[1] << 12 | pieces << 20;
                let triangles = triangle_count(own.counts, own.inner);
                emitted[PatchKind::Cut as usize].push(self.entry(place, flags, triangles, &factors));
            }
        }
    }

    fn leaf(&self, place: u32, face: &planish_subdiv::tables::IrregularFace, split_edges: u32, emitted: &mut Emitted) {
        let position = |limit: u32| to_world(self.object.0, self.limits[limit as usize].position);
        let points = std::array::from_fn(|i| {
            let is_split_middle = i >= 4 && split_edges >> (i - 4) & 1 != 0;
            position(if is_split_middle { face.midpoints[i - 4] } else { face.limits[i % 4] })
        });
        let displacement = self.object.0.displacement;
        if self.is_culled() && is_quad_unseen(&points, split_edges, self.view, self.culls_back(), displacement) {
            return;
        }
        let triangles = if split_edges == 0 { 2 } else { 4 + split_edges.count_ones() };
        let entry = DrawEntry { place, object: self.object.1, flags: split_edges, triangles, ..DrawEntry::default() };
        emitted[PatchKind::Filling as usize].push(entry);
    }
}

/// `reflect_points` of `glsl/shared/control_points.glsl`.
fn reflect_points(p: &mut [[f32; 3]; 16], boundary: u8) {
    let mut set = |is_boundary: bool, at: usize, near: usize, far: usize| {
        if is_boundary {
            p[at] = std::array::from_fn(|c| 2.0 * p[near][c] - p[far][c]);
        }
    };
    for row in [0, 4, 8, 12] {
        set(boundary & 8 != 0, row, row + 1, row + 2);
        set(boundary & 2 != 0, row + 3, row + 2, row + 1);
    }
    for column in 0..4 {
        set(boundary & 1 != 0, column, 4 + column, 8 + column);
        set(boundary & 4 != 0, 12 + column, 8 + column, 4 + column);
    }
}
