//! What the draws of a frame share, as the shaders read it.

use planish_gpu::{Buffer, Device};
use planish_shaders::{DrawPush, FrameData};

use crate::camera::FrameCamera;
use crate::density::FACTOR_COUNT;
use crate::error::Error;
use crate::lists::PatchKind;
use crate::surface::Surface;
use crate::upload::{address, mapped};

/// What a frame's draws read besides their push constants: the camera's place and the densities.
pub struct FrameConstants {
    buffer: Buffer,
}

impl FrameConstants {
    /// Makes room for them, and sets them.
    pub fn new(device: &Device, camera: &FrameCamera, factors: &[f32; FACTOR_COUNT]) -> Result<Self, Error> {
        let constants = Self { buffer: mapped::<FrameData>(device, "frame", 1)? };
        constants.set(camera, factors)?;
        Ok(constants)
    }

    /// Sets them, for all frames submitted from now on.
    pub fn set(&self, camera: &FrameCamera, factors: &[f32; FACTOR_COUNT]) -> Result<(), Error> {
        let data = FrameData { world_to_camera: camera.world_to_camera.to_cols_array_2d(), factors: *factors };
        Ok(self.buffer.write(0, &[data])?)
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Push constants for the draw of a kind's entries of a list from `first_entry` on.
    pub(crate) fn push(
        &self,
        surface: &Surface,
        kind: PatchKind,
        list: &Buffer,
        first_entry: u32,
        camera: &FrameCamera,
    ) -> DrawPush {
        let buffers = &surface.buffers;
        let [dx, dy] = camera.pixel_steps();
        let [width, height] = camera.size;
        let is_filling = kind == PatchKind::Filling;
        DrawPush {
            view_projection: camera.view_projection().to_cols_array_2d(),
            list: address::<planish_shaders::Indices>(list).offset(u64::from(first_entry)),
            points: address(if is_filling { &buffers.limits } else { &buffers.points }),
            patches: address(if is_filling { &buffers.quads } else { &buffers.patches }),
            frame: address(&self.buffer),
            ray_dx: dx.to_array(),
            ray_dy: dy.to_array(),
            image_size: width | height << 16,
            first_patch_id: if is_filling { surface.tables.patches.len() as u32 } else { 0 },
        }
    }
}
