//! A cage on the GPU: its tables, and the buffers that its frames fill.

use std::time::Instant;

use planish_gpu::{Buffer, Device, DrawArguments, Encoder, Transfer};
use planish_shaders::{EmitCounts, EmitLevel};
use planish_subdiv::ControlMesh;
use planish_subdiv::mesh::HierarchicalEdit;
use planish_subdiv::patch::{FillingQuad, PatchInfo, RegularPatch};
use planish_subdiv::refine::{CreasePatches, RefineOptions, Refinement};
use planish_subdiv::tables::{PatchCounts, Tables};

use crate::density::FACTOR_COUNT;
use crate::edit_points::targets;
use crate::emit::{Emitted, emit_levels, patch_counts};
use crate::error::Error;
use crate::limit::Limit;
use crate::lists::{Batches, DrawShape, Lists, PatchKind};
use crate::options::{Spacing, SurfaceMethod};
use crate::subdivide::Subdivide;
use crate::tessellation::filling_segment_count;
use crate::upload::{array, mapped, table};

/// What to make of a cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceDesc {
    /// Surface method.
    pub method: SurfaceMethod,
    /// Spacing: fractional-even needs the limits of edges' middles.
    pub spacing: Spacing,
    /// Level that irregularities are isolated to ([`crate::density::isolation_level`]).
    pub level: u32,
    /// Which creases are patches of their own.
    pub crease_patches: CreasePatches,
}

impl SurfaceDesc {
    /// Whether regular patches may have a semi-sharp crease.
    pub(crate) fn has_creased_patches(&self) -> bool {
        self.method == SurfaceMethod::Fas && self.crease_patches == CreasePatches::Single
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
    /// Render lists and indirect draws, and what the emit stage makes of them.
    pub lists: u64,
}

/// The tables of a cage, and how long they took.
#[derive(Clone, Debug)]
pub struct Preprocessed {
    /// The tables.
    pub tables: Tables,
    /// Times; `upload` is 0.
    pub times: PreprocessTimes,
}

/// Refines a cage and builds its tables, on one thread of the CPU.
pub fn preprocess(mesh: &ControlMesh, desc: &SurfaceDesc) -> Result<Preprocessed, Error> {
    let start = Instant::now();
    let options = RefineOptions {
        max_level: desc.level,
        uniform: desc.method == SurfaceMethod::Uniform,
        midpoints: filling_segment_count(desc.method, desc.spacing) == 2,
        crease_patches: desc.crease_patches,
    };
    let refinement = Refinement::new(mesh, options)?;
    let topology = milliseconds(start);
    let start = Instant::now();
    let tables = Tables::new(&refinement);
    let times = PreprocessTimes { topology, tables: milliseconds(start), upload: 0.0 };
    Ok(Preprocessed { tables, times })
}

pub(crate) struct Buffers {
    pub cage: Buffer,
    pub points: Buffer,
    pub rows: Buffer,
    pub indices: Buffer,
    pub weights: Buffer,
    pub edit_targets: Buffer,
    pub edit_offsets: Buffer,
    pub limits: Buffer,
    pub limit_rows: Buffer,
    pub limit_indices: Buffer,
    pub limit_weights: Buffer,
    pub patches: Buffer,
    pub quads: Buffer,
    pub list: Buffer,
    pub draws: Buffer,
    /// What the emit stage makes of the list.
    pub visible_list: Buffer,
    /// What it makes of the draws.
    pub visible_draws: Buffer,
    /// Patches of `visible_list`, by kind.
    pub visible_counts: Buffer,
    pub emit_levels: Buffer,
}

/// A cage on the GPU. Everything is kept alive by the surface: it must outlive the frames recorded with it.
pub struct Surface {
    pub(crate) desc: SurfaceDesc,
    pub(crate) tables: Tables,
    pub(crate) lists: Lists,
    pub(crate) batches: Batches,
    pub(crate) emit_levels: Vec<EmitLevel>,
    pub(crate) buffers: Buffers,
    times: PreprocessTimes,
    memory: MemoryBytes,
}

impl Surface {
    /// Uploads what [`preprocess`] made, and the cage's positions.
    /// `factors` are those of [`crate::density::level_factors`].
    pub fn new(
        device: &Device,
        mesh: &ControlMesh,
        desc: SurfaceDesc,
        made: Preprocessed,
        factors: &[f32; FACTOR_COUNT],
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let Preprocessed { tables, mut times } = made;
        let lists = Lists::new(&tables);
        let shape =
            DrawShape { method: desc.method, spacing: desc.spacing, factors, is_software: device.is_software() };
        let batches = lists.batches(&tables, &shape);
        let emit_levels = emit_levels(&tables, factors, desc.spacing);
        let (entry_count, draw_count) = (lists.entries.len() as u32, batches.draws.len() as u32);
        let stencils = &tables.stencils;
        let limits = &tables.limits;
        let buffers = Buffers {
            cage: mapped::<planish_shaders::Points>(device, "cage", tables.cage_point_count)?,
            points: array::<planish_shaders::Points>(device, "points", tables.point_count())?,
            rows: table(device, "stencil rows", &rows(&stencils.rows))?,
            indices: table(device, "stencil indices", &stencils.indices)?,
            weights: table(device, "stencil weights", &stencils.weights)?,
            edit_targets: table(device, "edit targets", &targets(&tables.edits))?,
            edit_offsets: mapped::<planish_shaders::Points>(device, "edit offsets", tables.edits.len() as u32)?,
            limits: array::<planish_shaders::LimitPoint>(device, "limit points", tables.limit_point_count())?,
            limit_rows: table(device, "limit rows", &rows(&limits.rows))?,
            limit_indices: table(device, "limit indices", &limits.indices)?,
            limit_weights: table(device, "limit weights", &limits.weights)?,
            patches: table(device, "patches", &patches(&tables))?,
            quads: filling_quads(device, &tables)?,
            list: table(device, "render lists", &lists.entries)?,
            draws: table(device, "draws", &batches.draws)?,
            visible_list: array::<u32>(device, "visible lists", entry_count)?,
            visible_draws: array::<DrawArguments>(device, "visible draws", draw_count)?,
            visible_counts: array::<EmitCounts>(device, "visible counts", PatchKind::ALL.len() as u32)?,
            emit_levels: table(device, "emit levels", &emit_levels)?,
        };
        times.upload = milliseconds(start);
        let memory = buffers.memory();
        let surface = Self { desc, tables, lists, batches, emit_levels, buffers, times, memory };
        surface.set_cage(&mesh.positions)?;
        surface.set_edits(&mesh.edits)?;
        Ok(surface)
    }

    /// Sets the positions of the cage's vertices, for all frames submitted from now on.
    ///
    /// # Panics
    /// If there are more positions than cage vertices.
    pub fn set_cage(&self, positions: &[[f32; 3]]) -> Result<(), Error> {
        if !positions.is_empty() {
            self.buffers.cage.write(0, positions)?;
        }
        Ok(())
    }

    /// Sets the values of the hierarchical edits that set or move points, for all frames submitted from now on: only
    /// their offsets are uploaded. The edits are the mesh's, in their order, with other values.
    ///
    /// # Panics
    /// If there are fewer edits than the mesh had.
    pub fn set_edits(&self, edits: &[HierarchicalEdit]) -> Result<(), Error> {
        let offsets: Vec<[f32; 3]> = self.tables.point_edits(edits).iter().map(|edit| edit.offset).collect();
        if !offsets.is_empty() {
            self.buffers.edit_offsets.write(0, &offsets)?;
        }
        Ok(())
    }

    /// What the surface was made as.
    pub fn desc(&self) -> &SurfaceDesc {
        &self.desc
    }

    /// The tables.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// The render lists.
    pub fn lists(&self) -> &Lists {
        &self.lists
    }

    /// The draws of the render lists.
    pub fn batches(&self) -> &Batches {
        &self.batches
    }

    /// How the patches of each level are tessellated.
    pub fn emit_levels(&self) -> &[EmitLevel] {
        &self.emit_levels
    }

    /// Times of the work done once.
    pub fn times(&self) -> PreprocessTimes {
        self.times
    }

    /// Bytes of GPU memory in use.
    pub fn memory(&self) -> MemoryBytes {
        self.memory
    }

    /// The points of all levels as the last frame left them; waits for the device. For tests.
    pub fn download_points(&self, device: &Device) -> Result<Vec<[f32; 3]>, Error> {
        Ok(device.download(&self.buffers.points, 0, self.tables.point_count() as usize)?)
    }

    /// The limit points as the last frame left them; waits for the device. For tests.
    pub fn download_limits(&self, device: &Device) -> Result<Vec<planish_shaders::LimitPoint>, Error> {
        Ok(device.download(&self.buffers.limits, 0, self.tables.limit_point_count() as usize)?)
    }

    /// How many patches of each level the last frame that had an emit stage has drawn; waits for the device.
    pub fn download_visible_counts(&self, device: &Device) -> Result<Vec<PatchCounts>, Error> {
        let counts = device.download(&self.buffers.visible_counts, 0, PatchKind::ALL.len())?;
        Ok(patch_counts(&counts, self.tables.counts.len()))
    }

    /// What the emit stage of the last frame made; waits for the device. For tests.
    pub fn download_emitted(&self, device: &Device) -> Result<Emitted, Error> {
        let buffers = &self.buffers;
        Ok(Emitted {
            entries: device.download(&buffers.visible_list, 0, self.lists.entries.len())?,
            draws: device.download(&buffers.visible_draws, 0, self.batches.draws.len())?,
            counts: self.download_visible_counts(device)?,
        })
    }
}

/// The stages that make a frame's points, before anything is drawn.
pub struct PointStages {
    subdivide: Subdivide,
    limit: Limit,
}

impl PointStages {
    /// Makes the pipelines.
    pub fn new(device: &Device) -> Result<Self, Error> {
        Ok(Self { subdivide: Subdivide::new(device)?, limit: Limit::new(device)? })
    }

    /// Records: cage to points, subdivide, limit. Takes the times `start`, `subdivide` and `limit`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        surface.buffers.keep(encoder);
        encoder.timestamp("start");
        let Buffers { cage, points, visible_counts, .. } = &surface.buffers;
        encoder.transfer(&[
            Transfer::Copy { from: cage, from_offset: 0, to: points, to_offset: 0, size: cage.size() },
            Transfer::Fill { buffer: visible_counts, offset: 0, size: visible_counts.size(), value: 0 },
        ]);
        self.subdivide.record(encoder, surface);
        encoder.timestamp("subdivide");
        self.limit.record(encoder, surface);
        encoder.timestamp("limit");
    }
}

impl Buffers {
    fn all(&self) -> [&Buffer; 19] {
        [
            &self.cage,
            &self.points,
            &self.rows,
            &self.indices,
            &self.weights,
            &self.edit_targets,
            &self.edit_offsets,
            &self.limits,
            &self.limit_rows,
            &self.limit_indices,
            &self.limit_weights,
            &self.patches,
            &self.quads,
            &self.list,
            &self.draws,
            &self.visible_list,
            &self.visible_draws,
            &self.visible_counts,
            &self.emit_levels,
        ]
    }

    fn keep(&self, encoder: &mut Encoder) {
        self.all().into_iter().for_each(|buffer| encoder.keep(buffer));
    }

    fn memory(&self) -> MemoryBytes {
        let points = self.cage.size() + self.points.size() + self.limits.size();
        let visible = [&self.visible_list, &self.visible_draws, &self.visible_counts, &self.emit_levels];
        let visible: u64 = visible.iter().map(|buffer| buffer.size()).sum();
        let lists = self.list.size() + self.draws.size() + visible;
        let all: u64 = self.all().iter().map(|buffer| buffer.size()).sum();
        MemoryBytes { tables: all - points - lists, points, lists }
    }
}

fn rows(rows: &[planish_subdiv::stencil::StencilRow]) -> Vec<planish_shaders::StencilRow> {
    rows.iter()
        .map(|row| planish_shaders::StencilRow {
            first_index: row.first_index,
            first_weight: row.first_weight,
            count: row.count,
        })
        .collect()
}

fn info(info: &PatchInfo) -> planish_shaders::PatchInfo {
    let [ptex_face, corner, flags] = info.pack();
    planish_shaders::PatchInfo { ptex_face, corner, flags }
}

fn patches(tables: &Tables) -> Vec<planish_shaders::RegularPatch> {
    let patch = |p: &RegularPatch| planish_shaders::RegularPatch {
        points: p.points,
        info: info(&p.info),
        sharpness: p.sharpness,
    };
    tables.patches.iter().map(patch).collect()
}

fn filling_quads(device: &Device, tables: &Tables) -> Result<Buffer, Error> {
    if tables.filling_midpoints.is_empty() {
        let quad = |q: &FillingQuad| planish_shaders::FillingQuad { corners: q.corners, info: info(&q.info) };
        return table(device, "filling quads", &tables.filling.iter().map(quad).collect::<Vec<_>>());
    }
    let quads = tables.filling.iter().zip(&tables.filling_midpoints).map(|(quad, &midpoints)| {
        planish_shaders::FillingQuadMidpoints { corners: quad.corners, midpoints, info: info(&quad.info) }
    });
    table(device, "filling quads with midpoints", &quads.collect::<Vec<_>>())
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
