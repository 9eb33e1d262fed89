//! The pass that shades a sample of a frame from its G-buffer and adds it to what came before: `glsl/shade.comp`.

use glam::Vec3;
use planish_gpu::{Buffer, BufferDesc, BufferKind, ComputePipeline, Device, Encoder, Transfer};
use planish_shaders::{IdWeight, ShadeFrame, ShadePush};

use super::shadows::Shadows;
use super::{Shading, albedo_table};
use crate::camera::FrameCamera;
use crate::error::Error;
use crate::program::compute_pipeline;
use crate::targets::{Layers, Targets};
use crate::upload::{address, array, mapped, table};

/// Ids that are told apart in a pixel, `ID_SLOTS` of `glsl/shared/shade_frame.glsl`.
pub const ID_SLOTS: usize = 8;

/// What a pixel shows of an id.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdCoverage {
    /// The id.
    pub id: u32,
    /// The share of its samples.
    pub weight: f32,
}

/// A frame that was shaded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadedFrame {
    /// Mean radiance and coverage of each pixel, rows from the top. Radiance is premultiplied; a visible environment covers.
    pub color: Vec<[f32; 4]>,
    /// Ids of objects in each pixel, most first, if they were asked for. Of more than [`ID_SLOTS`] in a pixel those that
    /// came last are left out.
    pub objects: Vec<Vec<IdCoverage>>,
    /// The same of materials; 0 where there is none.
    pub materials: Vec<Vec<IdCoverage>>,
}

/// The pass, with the sum of the samples so far.
pub struct ShadePass {
    pipeline: ComputePipeline,
    gbuffer: [Buffer; 4],
    albedo: Buffer,
    input: Buffer,
    sum: Buffer,
    ids: Option<[Buffer; 2]>,
    read_back: Buffer,
    size: [u32; 2],
}

impl ShadePass {
    /// For images of a size; with ids, objects and materials in each pixel are told apart.
    pub fn new(device: &Device, size: [u32; 2], has_ids: bool) -> Result<Self, Error> {
        let count = size[0] * size[1];
        let gbuffer = ["colours", "normals", "objects", "footprints"];
        let bytes = Layers::Shading.color_formats().into_iter().map(|format| format.bytes() * u64::from(count));
        let device_buffer = |name, size| Buffer::new(device, &BufferDesc { name, kind: BufferKind::Device, size });
        let gbuffer = gbuffer.into_iter().zip(bytes).map(|(name, bytes)| device_buffer(name, bytes));
        let gbuffer: Vec<Buffer> = gbuffer.collect::<Result<_, _>>()?;
        let slots = count * ID_SLOTS as u32;
        let id_buffer = |name| array::<IdWeight>(device, name, slots);
        let ids = if has_ids { Some([id_buffer("object ids")?, id_buffer("material ids")?]) } else { None };
        let largest = if has_ids { size_of::<IdWeight>() * ID_SLOTS } else { size_of::<[f32; 4]>() };
        let read = BufferDesc { name: "shaded", kind: BufferKind::Readback, size: u64::from(count) * largest as u64 };
        let Ok(gbuffer) = <[Buffer; 4]>::try_from(gbuffer) else { unreachable!("four targets") };
        Ok(Self {
            pipeline: compute_pipeline(device, &planish_shaders::shade_comp::PROGRAM)?,
            gbuffer,
            albedo: table(device, "albedo of GGX", &albedo_table::albedo_table())?,
            input: mapped::<ShadeFrame>(device, "shading of a frame", 1)?,
            sum: array::<[f32; 4]>(device, "radiance", count)?,
            ids,
            read_back: Buffer::new(device, &read)?,
            size,
        })
    }

    /// Records that nothing was shaded yet.
    pub fn record_clear(&self, encoder: &mut Encoder) {
        let fill = |buffer| Transfer::Fill { buffer, offset: 0, size: buffer.size(), value: 0 };
        let buffers: Vec<_> = std::iter::once(&self.sum).chain(self.ids.iter().flatten()).map(fill).collect();
        encoder.transfer(&buffers);
    }

    /// Says how the sample was seen and what lights it: before the recording of [`Self::record`] is submitted.
    pub fn set_sample(
        &self,
        camera: &FrameCamera,
        shading: &Shading,
        shadows: &Shadows,
        sample: u32,
    ) -> Result<(), Error> {
        shading.set_sample(sample)?;
        let [first, dx, dy] = view_rays(camera);
        let [colors, normals, objects, footprints] = &self.gbuffer;
        let ids = |which: usize| self.ids.as_ref().map_or_else(Default::default, |ids| address(&ids[which]));
        let frame = ShadeFrame {
            scene: shading.address(),
            colors: address(colors),
            normals: address(normals),
            objects: address(objects),
            footprints: address(footprints),
            sum: address(&self.sum),
            object_ids: ids(0),
            material_ids: ids(1),
            albedo: address(&self.albedo),
            lights: address(&shadows.lights),
            views: address(&shadows.views),
            depths: address(&shadows.depths),
            eye: camera.eye().to_array(),
            width: self.size[0],
            first_ray: first.to_array(),
            height: self.size[1],
            ray_dx: dx.to_array(),
            light_count: shadows.light_count(),
            ray_dy: dy.to_array(),
            has_ids: u32::from(self.ids.is_some()),
            environment: shading.environment(),
        };
        Ok(self.input.write(0, &[frame])?)
    }

    /// Records the shading of what the targets hold. The recording may be submitted for every sample, as long as lights need no more
    /// shadow maps than before.
    ///
    /// # Panics
    /// If the targets are of another size, or hold other layers.
    pub fn record(&self, encoder: &mut Encoder, targets: &Targets, shading: &Shading, shadows: &Shadows) {
        assert_eq!((targets.size(), targets.held()), (self.size, Layers::Shading), "targets of what is shaded");
        let images = std::iter::once(targets.color()).chain(targets.layers());
        let copies: Vec<_> =
            images.zip(&self.gbuffer).map(|(from, to)| Transfer::Image { from, to, to_offset: 0 }).collect();
        encoder.transfer(&copies);
        shading.keep(encoder);
        let own = self.gbuffer.iter().chain([&self.albedo, &self.input, &self.sum]).chain(self.ids.iter().flatten());
        own.chain([&shadows.lights, &shadows.views, &shadows.depths]).for_each(|buffer| encoder.keep(buffer));
        let push = ShadePush { frame: address(&self.input) };
        encoder.compute(&self.pipeline, &push, self.size[0] * self.size[1]);
    }

    /// Reads the mean of so many samples; waits for the device.
    pub fn read(&self, device: &Device, sample_count: u32) -> Result<ShadedFrame, Error> {
        let count = self.size[0] as usize * self.size[1] as usize;
        let scale = 1.0 / sample_count.max(1) as f32;
        let mut color: Vec<[f32; 4]> = self.fetch(device, &self.sum, count)?;
        color.iter_mut().flatten().for_each(|value| *value *= scale);
        let mut frame = ShadedFrame { color, ..ShadedFrame::default() };
        if let Some([objects, materials]) = &self.ids {
            let coverage = |weights: Vec<[IdWeight; ID_SLOTS]>| {
                weights.iter().map(|slots| coverage_of(slots, scale)).collect::<Vec<_>>()
            };
            frame.objects = coverage(self.fetch(device, objects, count)?);
            frame.materials = coverage(self.fetch(device, materials, count)?);
        }
        Ok(frame)
    }

    fn fetch<T: bytemuck::Pod>(&self, device: &Device, from: &Buffer, count: usize) -> Result<Vec<T>, Error> {
        let mut encoder = Encoder::new(device, "shaded")?;
        let size = (count * size_of::<T>()) as u64;
        encoder.transfer(&[Transfer::Copy { from, from_offset: 0, to: &self.read_back, to_offset: 0, size }]);
        device.submit_and_wait(&encoder.finish()?)?;
        Ok(self.read_back.read(0, count)?)
    }
}

/// A pixel's ids, most first.
fn coverage_of(slots: &[IdWeight; ID_SLOTS], scale: f32) -> Vec<IdCoverage> {
    let used = slots.iter().filter(|slot| slot.count > 0);
    let mut found: Vec<_> = used.map(|slot| IdCoverage { id: slot.id, weight: scale * slot.count as f32 }).collect();
    found.sort_by(|a, b| b.weight.total_cmp(&a.weight).then(a.id.cmp(&b.id)));
    found
}

/// The ray at depth 1 through the upper left corner of the image, and how it changes from pixel to pixel and from line to line: as the
/// projection has it, shifts of the lens and of the sample included.
fn view_rays(camera: &FrameCamera) -> [Vec3; 3] {
    let [dx, dy] = camera.pixel_steps();
    let projection = &camera.projection;
    let corner = Vec3::new(
        (-1.0 + projection.z_axis.x) / projection.x_axis.x,
        (1.0 + projection.z_axis.y) / projection.y_axis.y,
        -1.0,
    );
    let to_world = glam::Mat3::from_mat4(camera.world_to_camera).transpose();
    [to_world * corner, dx, dy]
}

#[cfg(test)]
mod tests {
    use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
    use glam::{Mat4, Vec2};

    use super::*;

    #[test]
    fn rays_meet_the_points_that_are_seen_in_their_pixels_also_of_shifted_samples() {
        let world_to_camera = look_at_mat4(Vec3::new(3.0, 2.0, 5.0), Vec3::new(0.5, 0.0, 0.0), Vec3::Y);
        let shifted = Mat4::from_translation(Vec3::new(0.2, -0.1, 0.0));
        let projection = shifted * perspective_infinite_reverse(0.8, 1.5, 0.1);
        let camera = FrameCamera { world_to_camera, projection, size: [300, 200] }.jittered(Vec2::new(0.3, -0.4));
        let [first, dx, dy] = view_rays(&camera);
        for at in [Vec2::new(0.5, 0.5), Vec2::new(120.0, 180.5)] {
            let point = camera.eye() + 7.0 * (first + at.x * dx + at.y * dy);
            let clip = camera.view_projection() * point.extend(1.0);
            let pixel = (clip.truncate() / clip.w).truncate() * Vec2::new(0.5, -0.5) + 0.5;
            assert!((pixel * Vec2::new(300.0, 200.0) - at).length() < 1e-3);
            assert!((clip.w - 7.0).abs() < 1e-4);
        }
    }

    #[test]
    fn coverage_is_sorted_and_unused_slots_are_left_out() {
        let slot = |id, count| IdWeight { id, count };
        let slots = [slot(7, 1), slot(9, 3), slot(0, 0), slot(0, 0), slot(0, 0), slot(0, 0), slot(0, 0), slot(0, 0)];
        let expected = [IdCoverage { id: 9, weight: 0.75 }, IdCoverage { id: 7, weight: 0.25 }];
        assert_eq!(coverage_of(&slots, 0.25), expected);
    }
}
