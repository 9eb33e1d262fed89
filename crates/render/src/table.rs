//! Basis function tables on the GPU (Hollaender and Boubekeur 2010): faces of the cage subdivided once, and which of them are drawn
//! how finely. Shaders: `glsl/emit_table.comp`, `glsl/table_patch.tesc`, `glsl/table_patch.tese`.

use planish_gpu::{Buffer, ComputePipeline, Device, Encoder, SpecConstant};
use planish_shaders as shaders;
use planish_shaders::EmitPush;
use planish_subdiv::tables::{BasisEdge, BasisPatch, BasisTable};

use crate::error::Error;
use crate::lists::{CHUNK, LIST_BASE};
use crate::options::FrameNeeds;
use crate::program::{compute_pipeline, specialized_compute_pipeline};
use crate::select::head_offset;
use crate::surface::Surface;
use crate::upload::{address, table};

/// The tables.
pub(crate) struct BasisBuffers {
    pub patches: Buffer,
    pub edges: Buffer,
    pub controls: Buffer,
    pub weights: Buffer,
    pub tangents: Buffer,
}

impl BasisBuffers {
    pub fn new(device: &Device, basis: &BasisTable) -> Result<Self, Error> {
        Ok(Self {
            patches: table(device, "table patches", &basis.patches.iter().map(patch).collect::<Vec<_>>())?,
            edges: table(device, "table edges", &basis.edges.iter().map(edge).collect::<Vec<_>>())?,
            controls: table(device, "table controls", &basis.controls)?,
            weights: table(device, "basis functions", &basis.weights)?,
            tangents: table(device, "tangents of basis functions", &basis.tangents)?,
        })
    }

    pub fn all(&self) -> [&Buffer; 5] {
        [&self.patches, &self.edges, &self.controls, &self.weights, &self.tangents]
    }
}

fn patch(patch: &BasisPatch) -> shaders::TablePatch {
    shaders::TablePatch {
        corners: patch.corners,
        edges: patch.edges,
        first_control: patch.first_control,
        control_count: patch.control_count,
        first_weight: patch.first_weight,
        ptex_face: patch.ptex_face,
        corner_uvs: patch.corner_uvs,
        flags: patch.flags,
    }
}

fn edge(edge: &BasisEdge) -> shaders::TableEdge {
    shaders::TableEdge {
        first_control: edge.first_control,
        control_count: edge.control_count,
        first_weight: edge.first_weight,
    }
}

/// The emit stage of this method.
pub(crate) struct EmitTable {
    patches: ComputePipeline,
    finish: ComputePipeline,
}

impl EmitTable {
    pub fn new(device: &Device, needs: &FrameNeeds) -> Result<Self, Error> {
        let spec = [
            SpecConstant {
                id: shaders::emit_table_comp::SPEC_BATCH_VERTICES,
                bits: crate::emit::batch_vertices(device),
            },
            SpecConstant { id: shaders::emit_table_comp::SPEC_PLACED, bits: u32::from(needs.placed) },
            SpecConstant { id: shaders::emit_table_comp::SPEC_CULL, bits: u32::from(needs.culls) },
        ];
        Ok(Self {
            patches: specialized_compute_pipeline(device, &shaders::emit_table_comp::PROGRAM, CHUNK, &spec)?,
            finish: compute_pipeline(device, &shaders::finish_lists_comp::PROGRAM)?,
        })
    }

    /// Records the stage: two dispatches. Takes the time `emit`.
    pub fn record(&self, encoder: &mut Encoder, surface: &Surface) {
        let push = EmitPush { scene: address(&surface.frame.scene), list: LIST_BASE as u32, ..EmitPush::default() };
        encoder.compute_indirect(&self.patches, &push, &surface.lists.heads, head_offset(LIST_BASE));
        let push = shaders::finish_lists_comp::Push { heads: address(&surface.lists.draw_heads) };
        encoder.compute(&self.finish, &push, CHUNK);
        encoder.timestamp("emit");
    }
}
