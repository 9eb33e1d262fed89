//! A frame's images, read back.

use anyhow::{Context, Result};
use half::f16;
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, Encoder, Image, Recorded};
use planish_render::Targets;

use crate::aov::PackedLayers;

/// Pixels that are decoded at once, so that no second copy of the image is needed.
const CHUNK: usize = 1 << 20;

/// A buffer that the CPU reads, and the copy of an image into it.
struct ReadBack {
    buffer: Buffer,
    copy: Recorded,
    pixel_count: usize,
}

impl ReadBack {
    fn new(device: &Device, image: &Image) -> Result<Self> {
        let desc = BufferDesc { name: "read-back", kind: BufferKind::Readback, size: image.copy_size() };
        let buffer = Buffer::new(device, &desc)?;
        let mut encoder = Encoder::new(device, "read-back")?;
        encoder.copy_image_to_buffer(image, &buffer, 0);
        let [width, height] = image.extent();
        Ok(Self { buffer, copy: encoder.finish()?, pixel_count: width as usize * height as usize })
    }

    fn words(&self, device: &Device) -> Result<Vec<[u32; 4]>> {
        device.submit_and_wait(&self.copy)?;
        Ok(self.buffer.read(0, self.pixel_count)?)
    }

    fn floats(&self, device: &Device) -> Result<Vec<[f32; 4]>> {
        device.submit_and_wait(&self.copy)?;
        Ok(self.buffer.read(0, self.pixel_count)?)
    }
}

/// Averages the colour of several frames of equal weight.
pub struct ColorSum {
    read_back: ReadBack,
    sum: Vec<[f32; 4]>,
    frame_count: u32,
}

impl ColorSum {
    /// Starts with no frame.
    pub fn new(device: &Device, targets: &Targets) -> Result<Self> {
        Ok(Self { read_back: ReadBack::new(device, targets.color())?, sum: Vec::new(), frame_count: 0 })
    }

    /// Adds what the targets hold.
    pub fn add(&mut self, device: &Device) -> Result<()> {
        let Self { read_back, sum, frame_count } = self;
        device.submit_and_wait(&read_back.copy)?;
        sum.try_reserve_exact(read_back.pixel_count - sum.len())
            .with_context(|| format!("no memory for {} pixels", read_back.pixel_count))?;
        sum.resize(read_back.pixel_count, [0.0; 4]);
        let mut offset = 0;
        for pixels in sum.chunks_mut(CHUNK) {
            let colors: Vec<[u16; 4]> = read_back.buffer.read(offset, pixels.len())?;
            for (sum, color) in pixels.iter_mut().zip(&colors) {
                for (sum, &bits) in sum.iter_mut().zip(color) {
                    *sum += f16::from_bits(bits).to_f32();
                }
            }
            offset += size_of_val(colors.as_slice()) as u64;
        }
        *frame_count += 1;
        Ok(())
    }

    /// The average, and back to no frame.
    pub fn take(&mut self) -> Vec<[f32; 4]> {
        let scale = 1.0 / std::mem::take(&mut self.frame_count).max(1) as f32;
        let mut average = std::mem::take(&mut self.sum);
        average.iter_mut().flatten().for_each(|channel| *channel *= scale);
        average
    }
}

/// Reads the layers that the targets hold.
pub fn read_layers(device: &Device, targets: &Targets) -> Result<PackedLayers> {
    let [normal_depth, position_factor, ids, colors @ ..] = targets.layers() else {
        return Ok(PackedLayers::default());
    };
    Ok(PackedLayers {
        normal_depth: ReadBack::new(device, normal_depth)?.floats(device)?,
        position_factor: ReadBack::new(device, position_factor)?.floats(device)?,
        ids: ReadBack::new(device, ids)?.words(device)?,
        colors: colors.first().map_or(Ok(Vec::new()), |image| ReadBack::new(device, image)?.floats(device))?,
    })
}
