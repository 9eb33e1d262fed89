//! A frame's images, read back.

use anyhow::Result;
use half::f16;
use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, Encoder, Image, Recorded};
use planish_render::{Accumulation, Targets};

use crate::aov::PackedLayers;
use crate::console::WrongUsage;

/// Pixels that are decoded at once, so that no second copy of the image is needed.
const CHUNK: usize = 1 << 20;

/// A buffer that the CPU reads, and the copy of an image into it.
pub struct ReadBack {
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

    /// Four halves a pixel, which were copied before.
    fn halves(&self) -> Result<Vec<[f32; 4]>> {
        let mut pixels = Vec::with_capacity(self.pixel_count);
        while pixels.len() < self.pixel_count {
            let count = CHUNK.min(self.pixel_count - pixels.len());
            let halves: Vec<[u16; 4]> = self.buffer.read((pixels.len() * size_of::<[u16; 4]>()) as u64, count)?;
            pixels.extend(halves.iter().map(|pixel| pixel.map(|bits| f16::from_bits(bits).to_f32())));
        }
        Ok(pixels)
    }

    fn floats(&self, device: &Device) -> Result<Vec<[f32; 4]>> {
        device.submit_and_wait(&self.copy)?;
        Ok(self.buffer.read(0, self.pixel_count)?)
    }
}

/// Averages the colour of several frames of equal weight. Of one alone there is no sum, which would take three times the memory.
pub enum ColorSum {
    One(Box<ReadBack>),
    Several(Box<FrameSum>),
}

/// The sum of so many frames.
pub struct FrameSum {
    sum: Accumulation,
    clear: Recorded,
    add: Recorded,
    frame_count: u32,
}

impl ColorSum {
    /// For so many samples of what these targets hold.
    pub fn new(device: &Device, targets: &Targets, sample_count: usize) -> Result<Self> {
        if sample_count == 1 {
            return Ok(Self::One(Box::new(ReadBack::new(device, targets.color())?)));
        }
        let sum = Accumulation::new(device, targets.size())?;
        let mut clear = Encoder::new(device, "no sample")?;
        sum.record_clear(&mut clear);
        let mut add = Encoder::new(device, "a sample")?;
        sum.record(&mut add, targets);
        let (clear, add) = (clear.finish()?, add.finish()?);
        Ok(Self::Several(Box::new(FrameSum { sum, clear, add, frame_count: 0 })))
    }

    /// Back to no frame, whatever became of the last ones.
    pub fn begin(&mut self, device: &Device) -> Result<()> {
        if let Self::Several(several) = self {
            several.frame_count = 0;
            device.submit_and_wait(&several.clear)?;
        }
        Ok(())
    }

    /// Adds what the targets hold.
    pub fn add(&mut self, device: &Device) -> Result<()> {
        match self {
            Self::One(read_back) => device.submit_and_wait(&read_back.copy)?,
            Self::Several(several) => {
                several.frame_count += 1;
                device.submit_and_wait(&several.add)?
            }
        };
        Ok(())
    }

    /// The average.
    pub fn mean(&self, device: &Device) -> Result<Vec<[f32; 4]>> {
        match self {
            Self::One(read_back) => read_back.halves(),
            Self::Several(several) => Ok(several.sum.read(device, several.frame_count)?),
        }
    }
}

/// Reads the layers that the targets hold of a part of the image.
pub fn read_layers(device: &Device, targets: &Targets, crop: &Crop) -> Result<PackedLayers> {
    let [normal_depth, position_factor, ids, others @ ..] = targets.layers() else {
        return Ok(PackedLayers::default());
    };
    let floats = |image: &Image| anyhow::Ok(crop.pixels(&ReadBack::new(device, image)?.floats(device)?));
    let other = |place: usize| others.get(place).map_or(Ok(Vec::new()), floats);
    Ok(PackedLayers {
        normal_depth: floats(normal_depth)?,
        position_factor: floats(position_factor)?,
        ids: crop.pixels(&ReadBack::new(device, ids)?.words(device)?),
        colors: other(0)?,
        motion_st: other(1)?,
        first_faces: Vec::new(),
    })
}

/// The part of an image that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    part: Option<[u32; 4]>,
    full: [u32; 2],
}

impl Crop {
    /// The part asked for: left, top, width and height; none: all of it.
    pub fn new(part: Option<[u32; 4]>, full: [u32; 2]) -> Result<Self> {
        if let Some([x, y, width, height]) = part {
            let fits = |first: u32, count: u32, all: u32| first.checked_add(count).is_some_and(|end| end <= all);
            if !fits(x, width, full[0]) || !fits(y, height, full[1]) {
                let found = format!("--crop: found {x},{y},{width}x{height}");
                return Err(
                    WrongUsage(format!("{found}, expected a part of the image of {}x{}", full[0], full[1])).into()
                );
            }
        }
        Ok(Self { part, full })
    }

    /// The part, if it is not all.
    pub fn part(&self) -> Option<[u32; 4]> {
        self.part
    }

    /// Its width and height.
    pub fn size(&self) -> [u32; 2] {
        self.part.map_or(self.full, |[_, _, width, height]| [width, height])
    }

    /// The part's pixels of those of the whole image.
    pub fn pixels<T: Copy>(&self, all: &[T]) -> Vec<T> {
        let Some([x, y, width, height]) = self.part.map(|part| part.map(|pixels| pixels as usize)) else {
            return all.to_vec();
        };
        let rows = all.chunks_exact(self.full[0] as usize).skip(y).take(height);
        rows.flat_map(|row| &row[x..x + width]).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crop_has_the_pixels_of_its_part() {
        let crop = Crop::new(Some([1, 1, 2, 1]), [3, 3]).unwrap();
        assert_eq!((crop.pixels(&[0, 1, 2, 3, 4, 5, 6, 7, 8]), crop.size()), (vec![4, 5], [2, 1]));
        let whole = Crop::new(None, [3, 1]).unwrap();
        assert_eq!((whole.pixels(&[7, 8, 9]), whole.size()), (vec![7, 8, 9], [3, 1]));
        for part in [[2, 0, 2, 1], [0, 3, 1, 1], [u32::MAX, 0, 1, 1]] {
            let message = Crop::new(Some(part), [3, 3]).unwrap_err().to_string();
            assert!(message.contains("expected a part of the image of 3x3"), "{message}");
        }
    }
}
