//! What the draws of a frame share, as the shaders read it.

use planish_gpu::{Buffer, Device};
use planish_shaders::{DrawPush, FrameData};

use crate::camera::FrameCamera;
use crate::density::FACTOR_COUNT;
use crate::error::Error;
use crate::surface::Surface;
use crate::upload::{address, mapped};

/// A frame's camera and densities on the GPU.
pub struct FrameConstants {
    buffer: Buffer,
}

impl FrameConstants {
    /// Makes room for them.
    pub fn new(device: &Device) -> Result<Self, Error> {
        Ok(Self { buffer: mapped::<FrameData>(device, "frame", 1)? })
    }

    /// Sets them, for all frames submitted from now on.
    pub fn set(&self, camera: &FrameCamera, factors: &[f32; FACTOR_COUNT]) -> Result<(), Error> {
        let [corner, dx, dy] = camera.rays();
        let data = FrameData {
            view_projection: camera.view_projection().to_cols_array_2d(),
            world_to_camera: camera.world_to_camera.to_cols_array_2d(),
            ray_corner: corner.to_array(),
            ray_dx: dx.to_array(),
            ray_dy: dy.to_array(),
            factors: *factors,
        };
        Ok(self.buffer.write(0, &[data])?)
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Push constants for the draw of the list entries from `first_entry` on.
    pub(crate) fn push(&self, surface: &Surface, first_entry: u32) -> DrawPush {
        let buffers = &surface.buffers;
        DrawPush {
            frame: address(&self.buffer),
            list: address::<planish_shaders::Indices>(&buffers.list).offset(u64::from(first_entry)),
            points: address(&buffers.points),
            patches: address(&buffers.patches),
            quads: address(&buffers.quads),
            midpoints: address(&buffers.midpoints),
            limits: address(&buffers.limits),
            first_patch_id: surface.tables.patches.len() as u32,
            ..DrawPush::default()
        }
    }
}
