//! Shadow maps: the surface as lights see it, drawn by the same stages and passes as for the eye, with a density of its own.

use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, Encoder, Image, ImageDesc};

use super::lights::{PlacedLights, SceneSphere, place, shadow_view};
use super::{LightDesc, Shading};
use crate::camera::FrameCamera;
use crate::draw::DrawPasses;
use crate::error::Error;
use crate::frame::FrameStages;
use crate::options::{Culling, Density, FrameNeeds, FrameOptions};
use crate::surface::{Surface, SurfaceDesc};
use crate::targets::DEPTH_FORMAT;
use crate::upload::mapped;

/// Lights of a scene at most; of more the last ones do not shine.
pub const MAX_LIGHTS: usize = 256;
/// Maps of a scene at most; lights beyond cast no shadows.
pub const MAX_SHADOW_VIEWS: usize = 64;
/// Edges of triangles in maps, in texels.
const EDGE_TEXELS: f32 = 6.0;

/// The lights of a frame and their shadow maps.
pub struct Shadows {
    passes: DrawPasses,
    depth: Image,
    /// Of all maps, one after the other; made when there are any.
    pub(crate) depths: Buffer,
    pub(crate) lights: Buffer,
    pub(crate) views: Buffer,
    cameras: Vec<FrameCamera>,
    light_count: u32,
    size: u32,
}

impl Shadows {
    /// For surfaces that are made so; maps have `size` texels a side, at least 16.
    ///
    /// Densities from a light may be higher than those from the eye: `needs.cuts` should be set.
    pub fn new(device: &Device, surface: &SurfaceDesc, needs: &FrameNeeds, size: u32) -> Result<Self, Error> {
        let size = size.max(16);
        let depth = ImageDesc { name: "shadow", format: DEPTH_FORMAT, extent: [size; 2] };
        Ok(Self {
            passes: DrawPasses::of_depth(device, surface, needs)?,
            depth: Image::new(device, &depth)?,
            depths: Buffer::new(device, &BufferDesc { name: "shadow maps", kind: BufferKind::Device, size: 4 })?,
            lights: mapped::<planish_shaders::Light>(device, "lights", MAX_LIGHTS as u32)?,
            views: mapped::<planish_shaders::ShadowView>(device, "shadow views", MAX_SHADOW_VIEWS as u32)?,
            cameras: Vec::new(),
            light_count: 0,
            size,
        })
    }

    /// Sets the lights of what is shaded from now on, and says how many shadow maps have to be drawn for them. With a sample's number
    /// each is at another point of its extent; without, in the middle. `scene` holds all that casts shadows.
    pub fn set_lights(
        &mut self,
        device: &Device,
        lights: &[LightDesc],
        scene: &SceneSphere,
        sample: Option<u32>,
    ) -> Result<usize, Error> {
        let PlacedLights { mut lights, mut views } = place(lights, scene, sample, self.size);
        lights.truncate(MAX_LIGHTS);
        for light in &mut lights {
            let last = u64::from(light.first_view) + u64::from(light.view_count);
            if last > MAX_SHADOW_VIEWS as u64 {
                light.first_view = u32::MAX;
            }
        }
        views.truncate(MAX_SHADOW_VIEWS);
        let texels = self.size * self.size;
        let bytes = views.len() as u64 * 4 * u64::from(texels);
        if self.depths.size() < bytes {
            let desc = BufferDesc { name: "shadow maps", kind: BufferKind::Device, size: bytes };
            self.depths = Buffer::new(device, &desc)?;
        }
        let gpu_views: Vec<_> = (0..).zip(&views).map(|(i, view)| shadow_view(view, i * texels)).collect();
        self.lights.write(0, &lights)?;
        self.views.write(0, &gpu_views)?;
        self.light_count = lights.len() as u32;
        self.cameras = views;
        Ok(self.cameras.len())
    }

    /// Number of lights that shine.
    pub(crate) fn light_count(&self) -> u32 {
        self.light_count
    }

    /// Whether lights with an extent make every sample's maps others.
    pub fn varies(lights: &[LightDesc]) -> bool {
        let has_extent = |light: &LightDesc| match light.kind {
            super::LightKind::Distant { angle } => angle > 0.0,
            super::LightKind::Point { radius, .. } | super::LightKind::Spot { radius, .. } => radius > 0.0,
        };
        lights.iter().any(|light| has_extent(light) && light.intensity != [0.0; 3])
    }

    /// Sets the surface's frame to be seen from a map's light ([`Surface::set_frame`]): before the recording of [`Self::record`] is
    /// submitted.
    pub fn set_frame(&self, surface: &Surface, view: usize, options: &FrameOptions) -> Result<(), Error> {
        let density = match options.density {
            // As fine as is asked for.
            Density::Tess(_) => options.density,
            Density::EdgePixels(_) => Density::EdgePixels(EDGE_TEXELS),
        };
        // Backs are hidden from the eye, not from lights.
        let culling = if options.culling == Culling::Off { Culling::Off } else { Culling::Unseen };
        surface.set_frame(&self.cameras[view], &FrameOptions { density, culling, ..*options })
    }

    /// Records the drawing of a map: the stages from cages to draw lists, the draws, and the copy of their depth.
    pub fn record(
        &self,
        encoder: &mut Encoder,
        surface: &Surface,
        stages: &FrameStages,
        shading: &Shading,
        view: usize,
    ) {
        shading.keep(encoder);
        stages.record(encoder, surface);
        self.passes.record_depth(encoder, surface, &self.cameras[view], &self.depth);
        let offset = view as u64 * 4 * u64::from(self.size) * u64::from(self.size);
        encoder.copy_image_to_buffer(&self.depth, &self.depths, offset);
        FrameStages::record_end(encoder, surface);
    }
}
