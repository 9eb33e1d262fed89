//! The buffers of a surface: tables that depend on connectivity, what every frame fills, and lists that may grow.

use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, DrawArguments, Encoder};
use planish_shaders as shaders;
use planish_shaders::{DrawEntry, DrawHead, FrameCounts, FrameData, FrameInput, ListHead, ListItem, Object, SceneData};
use planish_subdiv::patch::{FillingQuad, PatchInfo, RegularPatch};
use planish_subdiv::tables::{
    Border, GregoryFace, GregoryKind, GregoryStencils, IndexLists, IrregularFace, PatchSeams, RivalSpokeRows, Spoke,
    StencilFace, Tables,
};
use planish_subdiv::topology::NONE;

use crate::displacement::limit_seats;
use crate::edit_points::targets;
use crate::error::Error;
use crate::lists::{Capacities, KIND_COUNT, LIST_COUNT, LIST_PHASES, Phases, sum_of};
use crate::marks::Marks;
use crate::objects::ObjectSizes;
use crate::options::{SurfaceMethod, TableWeights};
use crate::table::BasisBuffers;
use crate::upload::{array, mapped, table};

/// What depends on connectivity alone.
pub(crate) struct TableBuffers {
    pub rows: Buffer,
    pub indices: Buffer,
    pub weights: Buffer,
    pub edit_targets: Buffer,
    pub limit_rows: Buffer,
    pub limit_indices: Buffer,
    pub limit_weights: Buffer,
    pub patches: Buffer,
    pub seams: Buffer,
    pub limit_seats: Buffer,
    pub irregular: Buffer,
    pub gregory: Buffer,
    pub spoke_ranges: Buffer,
    pub spokes: Buffer,
    pub rival_spokes: Buffer,
    pub spoke_indices: Buffer,
    pub spoke_weights: Buffer,
    pub stencil_faces: Buffer,
    pub stencil_rings: Buffer,
    pub stencil_weights: Buffer,
    pub quads: Buffer,
    pub ptex_faces: Buffer,
    pub neighbours: [Buffer; 2],
    pub rings: [Buffer; 2],
    pub stars: [Buffer; 2],
    pub density_scales: Buffer,
    pub mark_groups: Buffer,
    pub basis: BasisBuffers,
}

impl TableBuffers {
    pub fn new(
        device: &Device,
        tables: &Tables,
        marks: &Marks,
        density_scales: &[f32],
        table_weights: TableWeights,
    ) -> Result<Self, Error> {
        let (stencils, limits) = (&tables.stencils, &tables.limits);
        let gregory_stencils = &tables.gregory.stencils;
        let needs_spokes = tables.gregory.needs_spokes();
        let star_marks = IndexLists { first: tables.stars.first.clone(), indices: marks.of_stars(tables) };
        Ok(Self {
            rows: table(device, "stencil rows", &rows(&stencils.rows))?,
            indices: table(device, "stencil indices", &stencils.indices)?,
            weights: table(device, "stencil weights", &stencils.weights)?,
            edit_targets: table(device, "edit targets", &targets(&tables.edits))?,
            limit_rows: table(device, "limit rows", &rows(&limits.rows))?,
            limit_indices: table(device, "limit indices", &limits.indices)?,
            limit_weights: table(device, "limit weights", &limits.weights)?,
            patches: table(device, "patches", &tables.patches.iter().map(patch).collect::<Vec<_>>())?,
            limit_seats: table(device, "limit seats", &limit_seats(tables))?,
            seams: table(device, "seams", &tables.seams.iter().map(seams).collect::<Vec<_>>())?,
            irregular: table(device, "irregular faces", &tables.irregular.iter().map(irregular).collect::<Vec<_>>())?,
            gregory: table(device, "Gregory faces", &tables.gregory.faces.iter().map(gregory).collect::<Vec<_>>())?,
            spoke_ranges: table(device, "spoke ranges", only_if(needs_spokes, &tables.gregory.of_limit))?,
            spokes: table(
                device,
                "spokes",
                &only_if(needs_spokes, &tables.gregory.spokes).iter().map(spoke).collect::<Vec<_>>(),
            )?,
            rival_spokes: table(
                device,
                "spokes of ACC or Pm-patches",
                &tables.gregory.rival_spokes.iter().map(rival_spoke).collect::<Vec<_>>(),
            )?,
            spoke_indices: table(device, "spoke indices", only_if(needs_spokes, &tables.gregory.indices))?,
            spoke_weights: table(device, "spoke weights", only_if(needs_spokes, &tables.gregory.weights))?,
            stencil_faces: table(device, "stencil faces", &stencil_faces(gregory_stencils))?,
            stencil_rings: table(device, "stencil rings", &gregory_stencils.rings)?,
            stencil_weights: table(device, "Gregory stencil weights", &gregory_stencils.weights)?,
            quads: table(device, "filling quads", &tables.filling.iter().map(quad).collect::<Vec<_>>())?,
            ptex_faces: table(device, "Ptex faces", &tables.ptex_faces)?,
            neighbours: lists(device, "neighbours", &tables.slots.neighbours)?,
            rings: lists(device, "rings", &tables.slots.rings)?,
            stars: lists(device, "stars", &star_marks)?,
            density_scales: table(device, "density scales", density_scales)?,
            mark_groups: table(device, "mark groups", &marks.groups)?,
            basis: BasisBuffers::new(device, tables, table_weights)?,
        })
    }

    pub fn all(&self) -> Vec<&Buffer> {
        let mut all = vec![
            &self.rows,
            &self.indices,
            &self.weights,
            &self.edit_targets,
            &self.limit_rows,
            &self.limit_indices,
            &self.limit_weights,
            &self.patches,
            &self.seams,
            &self.limit_seats,
            &self.irregular,
            &self.gregory,
            &self.spoke_ranges,
            &self.spokes,
            &self.rival_spokes,
            &self.spoke_indices,
            &self.spoke_weights,
            &self.stencil_faces,
            &self.stencil_rings,
            &self.stencil_weights,
            &self.quads,
            &self.ptex_faces,
            &self.density_scales,
            &self.mark_groups,
        ];
        all.extend(self.neighbours.iter().chain(&self.rings).chain(&self.stars));
        all.extend(self.basis.all());
        all
    }
}

/// What every frame fills, of a size that never changes.
pub(crate) struct FrameBuffers {
    pub scene: Buffer,
    pub input: Buffer,
    pub data: Buffer,
    pub objects: Buffer,
    pub cage: Buffer,
    pub edit_offsets: Buffer,
    pub points: Buffer,
    pub limits: Buffer,
    pub limit_tangents: Buffer,
    pub spoke_points: Buffer,
    pub spoke_middles: Buffer,
    pub densities: Buffer,
    pub split_edges: Buffer,
    pub star_marks: Buffer,
    pub marks: Buffer,
    pub in_use: Buffer,
    pub counts: Buffer,
    pub counts_read: Buffer,
}

impl FrameBuffers {
    pub fn new(
        device: &Device,
        tables: &Tables,
        objects: &[Object],
        sizes: &ObjectSizes,
        marks: &Marks,
    ) -> Result<Self, Error> {
        let object_buffer = mapped::<Object>(device, "objects", objects.len() as u32)?;
        object_buffer.write(0, objects)?;
        let spoke_count = if tables.gregory.needs_spokes() { tables.gregory.spoke_count() } else { 0 };
        let tangent_count = tables.limit_seats.len().max(tables.gregory.of_limit.len());
        let all_rows: Vec<u32> = Phases::new(tables).rows.iter().flat_map(|&[first, n]| first..first + n).collect();
        Ok(Self {
            scene: mapped::<SceneData>(device, "scene", 1)?,
            input: mapped::<FrameInput>(device, "frame input", 1)?,
            data: mapped::<FrameData>(device, "frame", 1)?,
            objects: object_buffer,
            cage: mapped::<shaders::Points>(device, "cage", tables.cage_point_count)?,
            edit_offsets: mapped::<shaders::Points>(device, "edit offsets", tables.edits.len() as u32)?,
            points: array::<shaders::Points>(device, "points", tables.point_count())?,
            limits: array::<shaders::LimitPoint>(device, "limit points", tables.limit_point_count())?,
            limit_tangents: array::<shaders::LimitTangents>(device, "limit tangents", tangent_count as u32)?,
            spoke_points: array::<shaders::SpokePoint>(device, "spoke points", spoke_count)?,
            spoke_middles: array::<shaders::Points>(device, "spoke middles", tables.gregory.rival_spokes.len() as u32)?,
            densities: array::<shaders::SlotDensity>(device, "densities", sizes.slots)?,
            split_edges: array::<u32>(device, "split edges", sizes.edges.div_ceil(32))?,
            star_marks: array::<u32>(device, "star marks", tables.stars.count().div_ceil(32))?,
            marks: array::<u32>(device, "marks", marks.word_count)?,
            // All of them, for the method that selects nothing.
            in_use: table(device, "rows in use", &all_rows)?,
            counts: array::<FrameCounts>(device, "counts", 1)?,
            counts_read: read_back::<FrameCounts>(device, "counts", 1)?,
        })
    }

    pub fn all(&self) -> [&Buffer; 18] {
        [
            &self.scene,
            &self.input,
            &self.data,
            &self.objects,
            &self.cage,
            &self.edit_offsets,
            &self.points,
            &self.limits,
            &self.limit_tangents,
            &self.spoke_points,
            &self.spoke_middles,
            &self.densities,
            &self.split_edges,
            &self.star_marks,
            &self.marks,
            &self.in_use,
            &self.counts,
            &self.counts_read,
        ]
    }
}

/// Lists that may grow.
pub(crate) struct ListBuffers {
    pub chunks: Buffer,
    pub active: Buffer,
    /// Patches of finer levels, leaves, patches that are cut, Gregory patches that are.
    pub items: [Buffer; 4],
    pub entries: Buffer,
    pub draws: Buffer,
    pub heads: Buffer,
    pub empty_heads: Buffer,
    pub heads_read: Buffer,
    pub draw_heads: Buffer,
    pub empty_draw_heads: Buffer,
    pub draw_heads_read: Buffer,
}

impl ListBuffers {
    pub fn new(
        device: &Device,
        capacities: &Capacities,
        phases: &Phases,
        method: SurfaceMethod,
    ) -> Result<Self, Error> {
        let row_counts: Vec<u32> = phases.rows.iter().map(|&[_, count]| count).collect();
        let mut heads = capacities.heads(&row_counts);
        if method == SurfaceMethod::Uniform || method.is_grid() {
            // Every row is in use.
            for (head, &count) in heads[LIST_PHASES..].iter_mut().zip(&row_counts) {
                let groups = planish_gpu::groups_for(count, crate::lists::CHUNK);
                *head = ListHead { groups_x: groups.x, groups_y: groups.y, count, ..*head };
            }
        }
        let [patches, leaves, cut, cut_gregory] = capacities.items;
        Ok(Self {
            chunks: array::<ListItem>(device, "chunks", sum_of(&capacities.chunks))?,
            active: array::<ListItem>(device, "active faces", sum_of(&capacities.active))?,
            items: [
                array::<ListItem>(device, "patch items", patches)?,
                array::<ListItem>(device, "leaf items", leaves)?,
                array::<ListItem>(device, "cut items", cut)?,
                array::<ListItem>(device, "cut Gregory items", cut_gregory)?,
            ],
            entries: array::<DrawEntry>(device, "draw lists", sum_of(&capacities.entries))?,
            draws: array::<DrawArguments>(device, "draws", sum_of(&capacities.draws))?,
            heads: array::<ListHead>(device, "list heads", LIST_COUNT as u32)?,
            empty_heads: table(device, "empty list heads", &heads)?,
            heads_read: read_back::<ListHead>(device, "list heads", LIST_COUNT)?,
            draw_heads: array::<DrawHead>(device, "draw heads", KIND_COUNT as u32)?,
            empty_draw_heads: table(device, "empty draw heads", &capacities.draw_heads())?,
            draw_heads_read: read_back::<DrawHead>(device, "draw heads", KIND_COUNT)?,
        })
    }

    pub fn all(&self) -> Vec<&Buffer> {
        let mut all = vec![
            &self.chunks,
            &self.active,
            &self.entries,
            &self.draws,
            &self.heads,
            &self.empty_heads,
            &self.heads_read,
            &self.draw_heads,
            &self.empty_draw_heads,
            &self.draw_heads_read,
        ];
        all.extend(&self.items);
        all
    }
}

/// Keeps all of a surface's buffers alive as long as a recording.
pub(crate) fn keep(encoder: &mut Encoder, surface: &crate::surface::Surface) {
    let all = surface.buffers.all().into_iter().chain(surface.frame.all()).chain(surface.lists.all());
    let all = all.chain(surface.maps.all()).chain(surface.tex_coords.all()).chain(surface.colors.all());
    let all = all.chain(surface.deform.iter().flat_map(|deform| deform.all()));
    let all = all.chain(surface.motion.iter().flat_map(|motion| motion.all()));
    all.for_each(|buffer| encoder.keep(buffer));
}

/// A table, or nothing where it is not needed.
fn only_if<T>(is_needed: bool, table: &[T]) -> &[T] {
    if is_needed { table } else { &[] }
}

fn read_back<T>(device: &Device, name: &str, count: usize) -> Result<Buffer, Error> {
    let size = (count * size_of::<T>()) as u64;
    Ok(Buffer::new(device, &BufferDesc { name, kind: BufferKind::Readback, size })?)
}

fn lists(device: &Device, name: &str, lists: &IndexLists) -> Result<[Buffer; 2], Error> {
    Ok([table(device, name, &lists.first)?, table(device, name, &lists.indices)?])
}

fn rows(rows: &[planish_subdiv::stencil::StencilRow]) -> Vec<shaders::StencilRow> {
    rows.iter().map(row).collect()
}

fn row(row: &planish_subdiv::stencil::StencilRow) -> shaders::StencilRow {
    shaders::StencilRow { first_index: row.first_index, first_weight: row.first_weight, count: row.count }
}

fn info(info: &PatchInfo) -> shaders::PatchInfo {
    let [ptex_face, corner, flags] = info.pack();
    shaders::PatchInfo { ptex_face, corner, flags }
}

fn patch(p: &RegularPatch) -> shaders::RegularPatch {
    shaders::RegularPatch {
        points: p.points,
        info: info(&p.info),
        sharpness: p.sharpness,
        edges: p.edges,
        seams: p.seams,
    }
}

fn seams(seams: &PatchSeams) -> shaders::PatchSeams {
    shaders::PatchSeams { limits: seams.limits, borders: seams.borders.map(|border| border.map_or(NONE, Border::pack)) }
}

fn irregular(face: &IrregularFace) -> shaders::IrregularFace {
    shaders::IrregularFace {
        info: info(&face.info),
        children: face.children,
        edges: face.edges,
        stars: face.stars,
        limits: face.limits,
        midpoints: face.midpoints,
        // FACE_FORCED, FACE_HIDDEN and FACE_STAR_LIMITS_SHIFT.
        flags: u32::from(face.is_forced) | u32::from(face.is_hidden) << 1 | u32::from(face.star_limits) << 2,
    }
}

/// GREGORY_.. of `glsl/shared/tables.glsl`.
fn gregory(face: &GregoryFace) -> shaders::GregoryFace {
    let kind = match face.kind {
        GregoryKind::None => 0,
        GregoryKind::Quad => 1,
        GregoryKind::PartOfNgon => 2,
        GregoryKind::PartOfTriangle(part) => 3 + u32::from(part),
    };
    shaders::GregoryFace {
        limits: face.limits,
        first: face.first,
        last: face.last,
        cosines: face.cosines,
        borders: face.borders.map(|border| border.map_or(NONE, Border::pack)),
        flags: kind | u32::from(face.sharp) << 4,
        owners: face.owners.map(|owner| shaders::EdgeOwner { faces: owner.faces, flags: owner.flags }),
        part_before: face.part_before,
    }
}

fn stencil_faces(stencils: &GregoryStencils) -> Vec<shaders::GregoryStencil> {
    let face = |face: &StencilFace| {
        let Some(table) = stencils.connectivities.get(face.connectivity as usize) else {
            return shaders::GregoryStencil::default();
        };
        shaders::GregoryStencil {
            corners: face.corners.map(|corner| if corner == NONE { face.corners[0] } else { corner }),
            first_point: face.first_point,
            point_count: table.point_count,
            first_weight: table.first_weight,
            spoke_edges: face.spoke_edges.into(),
        }
    };
    stencils.faces.iter().map(face).collect()
}

fn spoke(spoke: &Spoke) -> shaders::Spoke {
    let [before, after] = spoke.neighbours;
    shaders::Spoke {
        along: spoke.along,
        direct: spoke.direct,
        end: spoke.end,
        is_projected: u32::from(spoke.is_projected),
        before,
        after,
        row: row(&spoke.row),
    }
}

fn rival_spoke(spoke: &RivalSpokeRows) -> shaders::RivalSpoke {
    shaders::RivalSpoke {
        edge: row(&spoke.edge),
        across: row(&spoke.across),
        beside: row(&spoke.beside),
        middle: row(&spoke.middle),
    }
}

fn quad(q: &FillingQuad) -> shaders::FillingQuad {
    shaders::FillingQuad { corners: q.corners, info: info(&q.info) }
}
