//! Adds up the colours of a frame's samples on the device: `glsl/accumulate.comp`.

use planish_gpu::{Buffer, BufferDesc, BufferKind, ComputePipeline, Device, Encoder, Transfer};
use planish_shaders::AccumulatePush;

use crate::error::Error;
use crate::program::compute_pipeline;
use crate::targets::Targets;
use crate::upload::{address, array};

/// Pixels that are read back at once: a buffer for all of a large image would be as large as the sum.
const CHUNK: u32 = 1 << 16;

/// The sum of samples of equal weight. Nothing is read back until all are there.
pub struct Accumulation {
    pipeline: ComputePipeline,
    colors: Buffer,
    sum: Buffer,
    read_back: Buffer,
    pixel_count: u32,
}

impl Accumulation {
    /// For images of a size in pixels: 24 bytes a pixel.
    ///
    /// # Errors
    /// No memory, or the driver fails.
    pub fn new(device: &Device, size: [u32; 2]) -> Result<Self, Error> {
        let pixel_count = size[0] * size[1];
        let sum = array::<[f32; 4]>(device, "sum of samples", pixel_count)?;
        let size = u64::from(pixel_count.min(CHUNK)) * size_of::<[f32; 4]>() as u64;
        let read = BufferDesc { name: "sum read back", kind: BufferKind::Readback, size };
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
        let scale = 1.0 / sample_count.max(1) as f32;
        let mut mean: Vec<[f32; 4]> = Vec::with_capacity(self.pixel_count as usize);
        while let Some(left @ 1..) = self.pixel_count.checked_sub(mean.len() as u32) {
            let bytes = |pixels: usize| (pixels * size_of::<[f32; 4]>()) as u64;
            let count = left.min(CHUNK) as usize;
            let (from_offset, size) = (bytes(mean.len()), bytes(count));
            let mut encoder = Encoder::new(device, "sum read back")?;
            let (from, to) = (&self.sum, &self.read_back);
            encoder.transfer(&[Transfer::Copy { from, from_offset, to, to_offset: 0, size }]);
            device.submit_and_wait(&encoder.finish()?)?;
            let sums: Vec<[f32; 4]> = to.read(0, count)?;
            mean.extend(sums.iter().map(|sum| sum.map(|channel| channel * scale)));
        }
        Ok(mean)
    }
}
