//! The stages of a frame before anything is drawn: from cages to points, limit points and draw lists.

use planish_gpu::{Device, Encoder, Transfer};
use planish_shaders::DrawPush;

use crate::buffers::keep;
use crate::camera::FrameCamera;
use crate::deform::Deform;
use crate::emit::Emit;
use crate::error::Error;
use crate::limit::Limit;
use crate::lists::PatchKind;
use crate::options::{FrameNeeds, SurfaceMethod};
use crate::select::Select;
use crate::spokes::SpokeStage;
use crate::subdivide::Subdivide;
use crate::surface::Surface;
use crate::table::{EmitTable, VertexNormals};
use crate::upload::address;

/// The stages of a frame that make what is drawn.
pub struct FrameStages {
    deform: Option<Deform>,
    select: Select,
    subdivide: Subdivide,
    limit: Limit,
    spokes: Option<SpokeStage>,
    normals: Option<VertexNormals>,
    emit: EmitStage,
    needs: FrameNeeds,
}

/// The last of them.
enum EmitStage {
    Patches(Emit),
    Table(EmitTable),
}

impl FrameStages {
    /// Makes the pipelines.
    pub fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        Ok(Self {
            deform: needs.deforms.then(|| Deform::new(device)).transpose()?,
            select: Select::new(device, needs)?,
            subdivide: Subdivide::new(device)?,
            limit: Limit::new(device, needs)?,
            spokes: needs.gregory.then(|| SpokeStage::new(device, needs.rival.is_some())).transpose()?,
            normals: needs.vertex_normals.then(|| VertexNormals::new(device)).transpose()?,
            emit: if needs.grids {
                EmitStage::Table(EmitTable::new(device, needs)?)
            } else {
                EmitStage::Patches(Emit::new(device, needs)?)
            },
            needs: *needs,
        })
    }

    /// Records: cages to points, density, select, subdivide, limit, spokes of Gregory patches, emit. Takes the times `start`,
    /// `animate`, `density`, `select`, `subdivide`, `limit` (spokes are part of it) and `emit`; uniform refinement has no density, select
    /// and emit. How the frame is seen, selected and culled is what [`Surface::set_frame`] said last when it runs.
    ///
    /// # Panics
    /// If these are stages for other surfaces: with Gregory patches where it has none, or the other way round, or with other control
    /// points of them.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let (needs, desc) = (&self.needs, &surface.desc);
        assert_eq!(needs.gregory, desc.has_gregory_patches(), "stages and surface have Gregory patches");
        assert_eq!(needs.rival, desc.method.rival(), "stages and surface have patches of one scheme");
        assert_eq!(needs.grids, desc.method.is_grid(), "stages and surface have grids");
        assert_eq!(needs.vertex_normals, desc.has_vertex_normals(), "stages and surface have normals of vertices");
        assert!(!needs.gregory || needs.gregory_points == desc.gregory_points, "one way to make Gregory patches");
        keep(encoder, surface);
        encoder.timestamp("start");
        Select::record_start(encoder, surface);
        self.record_deform(encoder, surface);
        encoder.timestamp("animate");
        match desc.method {
            SurfaceMethod::Uniform => {}
            method if method.is_grid() => self.select.record_densities(encoder, surface),
            _ => self.select.record(encoder, surface),
        }
        self.subdivide.record(encoder, surface, &surface.frame.points);
        encoder.timestamp("subdivide");
        self.record_next(encoder, surface);
        // Last, as it says what the tangents of limit points are.
        self.limit.record(encoder, surface, &surface.frame.points, &surface.frame.limits);
        if let Some(spokes) = &self.spokes {
            spokes.record(encoder, surface);
        }
        if let Some(normals) = &self.normals {
            normals.record(encoder, surface);
        }
        encoder.timestamp("limit");
        match &self.emit {
            _ if desc.method == SurfaceMethod::Uniform => {}
            EmitStage::Patches(emit) => emit.record(encoder, surface),
            EmitStage::Table(emit) => emit.record(encoder, surface),
        }
    }

    /// Cages that deform, at this moment and the next.
    fn record_deform(&self, encoder: &mut Encoder, surface: &Surface) {
        let Some((deform, buffers)) = self.deform.as_ref().zip(surface.deform.as_ref()) else { return };
        deform.record(encoder, buffers, &buffers.pose, &surface.frame.points);
        if let Some(next) = &surface.motion {
            deform.record(encoder, buffers, &next.pose, &next.points);
        }
    }

    /// The points of the next moment, by the rows that this one uses.
    fn record_next(&self, encoder: &mut Encoder, surface: &Surface) {
        if let Some(next) = surface.motion.as_ref().filter(|_| self.needs.moves) {
            self.subdivide.record(encoder, surface, &next.points);
            self.limit.record(encoder, surface, &next.points, &next.limits);
        }
    }

    /// Records the copies that [`Surface::status`] and [`Surface::grow`] read: at the end of a frame.
    pub fn record_end(encoder: &mut Encoder, surface: &Surface) {
        let (frame, lists) = (&surface.frame, &surface.lists);
        let copy = |from, to| Transfer::Copy { from, from_offset: 0, to, to_offset: 0, size: from.size() };
        encoder.transfer(&[
            copy(&lists.heads, &lists.heads_read),
            copy(&lists.draw_heads, &lists.draw_heads_read),
            copy(&frame.counts, &frame.counts_read),
        ]);
    }
}

/// Push constants for the draw of a kind's entries, from place `first_entry` among all entries on.
pub(crate) fn draw_push(surface: &Surface, kind: PatchKind, first_entry: u32, camera: &FrameCamera) -> DrawPush {
    let (tables, frame) = (&surface.buffers, &surface.frame);
    let [dx, dy] = camera.pixel_steps();
    let [width, height] = camera.size;
    let (points, patches, first_patch_id) = match (surface.desc.method, kind) {
        (SurfaceMethod::Uniform, _) => (&frame.limits, &tables.quads, 0),
        (_, PatchKind::Filling) => (&frame.limits, &tables.irregular, surface.tables.patches.len() as u32),
        (_, PatchKind::Gregory | PatchKind::GregoryCut | PatchKind::Triangle | PatchKind::TriangleCut) => {
            (&frame.points, &tables.patches, surface.tables.patches.len() as u32)
        }
        _ => (&frame.points, &tables.patches, 0),
    };
    DrawPush {
        view_projection: camera.view_projection().to_cols_array_2d(),
        list: address::<planish_shaders::DrawEntries>(&surface.lists.entries).offset(first_entry.into()),
        points: address(points),
        patches: address(patches),
        frame: address(&frame.data),
        ray_dx: dx.to_array(),
        ray_dy: dy.to_array(),
        image_size: width | height << 16,
        first_patch_id,
    }
}
