//! Where the time of a run went.

use std::fmt;

use serde::Serialize;

use crate::stats::GpuStats;

/// Milliseconds of all samples of all frames; writing overlaps the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Split {
    /// Poses on the CPU and the GPU.
    pub animate: f64,
    /// Densities, selection and lists.
    pub select: f64,
    /// Points and limit points.
    pub subdivide: f64,
    /// Tessellation and rasterization.
    pub draw: f64,
    /// Shadow maps, shading and sums of samples.
    pub shade: f64,
    /// Images to the CPU.
    pub read_back: f64,
    /// Encoding and writing files, on a thread of its own.
    pub write: f64,
    /// How much of it rendering waited for.
    pub write_waited: f64,
    /// From the first frame to the last file.
    pub wall: f64,
}

impl Split {
    /// Adds what the device needed for a sample.
    pub fn add(&mut self, gpu: &GpuStats) {
        self.animate += gpu.animate;
        self.select += gpu.density + gpu.select + gpu.emit;
        self.subdivide += gpu.subdivide + gpu.limit;
        self.draw += gpu.draw;
        self.shade += gpu.shade;
    }
}

impl fmt::Display for Split {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { animate, select, subdivide, draw, shade, read_back, write, write_waited, wall } = self;
        write!(
            formatter,
            "{wall:.0} ms: animate {animate:.1}, select {select:.1}, subdivide {subdivide:.1}, draw {draw:.1}, shade {shade:.1}, \
             read-back {read_back:.1}, write {write:.1} of which {write_waited:.1} were waited for"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_is_part_of_one_share() {
        let gpu = GpuStats {
            animate: 1.0,
            density: 2.0,
            select: 4.0,
            subdivide: 8.0,
            limit: 16.0,
            emit: 32.0,
            draw: 64.0,
            shade: 128.0,
            total: 255.0,
        };
        let mut split = Split::default();
        split.add(&gpu);
        assert_eq!(
            (split.animate, split.select, split.subdivide, split.draw, split.shade),
            (1.0, 38.0, 24.0, 64.0, 128.0)
        );
        let sum = split.animate + split.select + split.subdivide + split.draw + split.shade;
        assert_eq!(sum, gpu.total);
    }
}
