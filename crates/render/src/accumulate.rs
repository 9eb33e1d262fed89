//! Adds up the colours of a frame's samples on the device: `glsl/accumulate.comp`.

use planish_gpu::{Buffer, BufferDesc, BufferKind, ComputePipeline, Device, Encoder, Transfer};
use planish_shaders::AccumulatePush;

use crate::error::Error;
use crate::program::compute_pipeline;
use crate::targets::Targets;
use crate::upload::{address, array};

/// The sum of samples of equal weight. Nothing is read back until all are there.
pub struct Accumulation {
    pipeline: ComputePipeline,
    colors: Buffer,
    sum: Buffer,
    read_back: Buffer,
    pixel_count: u32,
}

impl Accumulation {
    /// For images of a size in pixels: 40 bytes a pixel.
    ///
    /// # Errors
    /// No memory, or the driver fails.
    pub fn new(device: &Device, size: [u32; 2]) -> Result<Self, Error> {
        let pixel_count = size[0] * size[1];
        let sum = array::<[f32; 4]>(device, "sum of samples", pixel_count)?;
        let read = BufferDesc { name: "sum read back", kind: BufferKind::Readback, size: sum.size() };
        Ok(Self {
            pipeline: compute_pipeline(device, &planish_shaders::accumulate_comp::PROGRAM)?,
            colors: array::<[u16; 4]>(device, "colours of a sample", pixel_count)?,
            read_back: Buffer::new(device, &read)?,
            sum,
            pixel_count,
        })
    }

    /// Records that there is no sample yet.
    pub fn record_clear(&self, encoder: &mut Encoder) {
        encoder.fill_buffer(&self.sum, 0, self.sum.size(), 0);
    }

    /// Records that the colours that the targets hold are added: once for every sample.
    ///
    /// # Panics
    /// If the targets are of another size.
    pub fn record(&self, encoder: &mut Encoder, targets: &Targets) {
        let [width, height] = targets.size();
        assert_eq!(width * height, self.pixel_count, "targets of another size");
        encoder.copy_image_to_buffer(targets.color(), &self.colors, 0);
        [&self.colors, &self.sum].into_iter().for_each(|buffer| encoder.keep(buffer));
        let push = AccumulatePush {
            colors: address(&self.colors),
            sum: address(&self.sum),
            count: self.pixel_count,
            ..AccumulatePush::default()
        };
        encoder.compute(&self.pipeline, &push, self.pixel_count);
    }

    /// Reads the mean of so many samples, rows from the top; waits for the device.
    ///
    /// # Errors
    /// The device is lost.
    pub fn read(&self, device: &Device, sample_count: u32) -> Result<Vec<[f32; 4]>, Error> {
        let mut encoder = Encoder::new(device, "sum read back")?;
        let size = self.sum.size();
        let copy = Transfer::Copy { from: &self.sum, from_offset: 0, to: &self.read_back, to_offset: 0, size };
        encoder.transfer(&[copy]);
        device.submit_and_wait(&encoder.finish()?)?;
        let mut mean: Vec<[f32; 4]> = self.read_back.read(0, self.pixel_count as usize)?;
        let scale = 1.0 / sample_count.max(1) as f32;
        mean.iter_mut().flatten().for_each(|channel| *channel *= scale);
        Ok(mean)
    }
}
