//! Dump: what the tessellation stages produce, captured by transform feedback.
//!
//! Lists are drawn in parts whose triangles fit a buffer of fixed size, so a dump of any size needs no more memory.

use bytemuck::{Pod, Zeroable};
use glam::Mat4;
use planish_gpu::{
    Buffer, BufferDesc, BufferKind, Device, Draw, DrawArguments, Encoder, Feature, Feedback, FeedbackList,
    GraphicsPipeline, Transfer,
};

use crate::camera::FrameCamera;
use crate::density::FACTOR_COUNT;
use crate::error::Error;
use crate::frame::FrameConstants;
use crate::lists::{PatchKind, draw_arguments};
use crate::options::{Spacing, SurfaceMethod, View};
use crate::pipelines::{Output, PipelineOptions, pipelines};
use crate::surface::{Surface, SurfaceDesc};
use crate::tessellation::{filling_triangle_count, patch_triangle_count};

/// Bytes that are captured at once.
const CAPTURE_BYTES: u64 = 64 << 20;
/// Vertices that fit.
const CAPTURE_VERTICES: u64 = CAPTURE_BYTES / size_of::<CapturedVertex>() as u64;

/// Captured points are in world space: nothing is projected that anybody sees.
const NO_CAMERA: FrameCamera =
    FrameCamera { world_to_camera: Mat4::IDENTITY, projection: Mat4::IDENTITY, size: [1, 1] };

/// A captured vertex: the layout that `glsl/shared/surface.glsl` gives the DUMP outputs. Three make a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CapturedVertex {
    /// Position on the limit surface.
    pub position: [f32; 3],
    /// Unit normal, or 0.
    pub normal: [f32; 3],
    /// Parameters in the Ptex face.
    pub uv: [f32; 2],
    /// Ptex face.
    pub ptex_face: u32,
    /// Level in bits 0-7, kind of patch in bits 8-15.
    pub level_and_kind: u32,
}

/// The passes that capture a surface.
pub struct DumpPasses {
    pipelines: Vec<(PatchKind, GraphicsPipeline)>,
    method: SurfaceMethod,
    spacing: Spacing,
    capture: Buffer,
    read_back: Buffer,
    counter: Buffer,
    arguments: Buffer,
}

impl DumpPasses {
    /// Makes pipelines and buffers; fails on a device without transform feedback.
    pub fn new(device: &Device, surface: &SurfaceDesc) -> Result<Self, Error> {
        let SurfaceDesc { method, spacing, .. } = *surface;
        if !device.has(Feature::TransformFeedback) {
            return Err(Error::NoTransformFeedback { device: device.name().to_owned() });
        }
        let options = PipelineOptions {
            method,
            spacing,
            output: Output::Dump,
            view: View::Shaded,
            cull_back: false,
            wire: false,
            creases: surface.has_creased_patches(),
        };
        let buffer = |name, kind, size| Buffer::new(device, &BufferDesc { name, kind, size });
        Ok(Self {
            pipelines: pipelines(device, &options)?,
            method,
            spacing,
            capture: buffer("capture", BufferKind::Device, CAPTURE_BYTES)?,
            read_back: buffer("captured", BufferKind::Readback, CAPTURE_BYTES)?,
            counter: buffer("capture counter", BufferKind::Device, 4)?,
            arguments: buffer("capture draw", BufferKind::Upload, size_of::<DrawArguments>() as u64)?,
        })
    }

    /// Captures all triangles, list by list, and hands them out in parts of whole triangles. The points must have been
    /// made by a submitted frame, with the same factors set.
    pub fn capture<E: From<Error>>(
        &self,
        device: &Device,
        surface: &Surface,
        frame: &FrameConstants,
        factors: &[f32; FACTOR_COUNT],
        mut sink: impl FnMut(&[CapturedVertex]) -> Result<(), E>,
    ) -> Result<(), E> {
        for pass in &self.pipelines {
            let range = surface.lists.ranges[pass.0 as usize].clone();
            let mut first = range.start;
            while first < range.end {
                let (count, triangles) = self.part(surface, pass.0, first, range.end, factors);
                let vertices = self.capture_part(device, surface, frame, pass, first, count, triangles)?;
                sink(&vertices)?;
                first += count;
            }
        }
        Ok(())
    }

    /// How many list entries from `first` on fit the buffer, and their triangles.
    fn part(
        &self,
        surface: &Surface,
        kind: PatchKind,
        first: u32,
        end: u32,
        factors: &[f32; FACTOR_COUNT],
    ) -> (u32, u64) {
        let (mut count, mut triangles) = (0, 0);
        for &entry in &surface.lists.entries[first as usize..end as usize] {
            let more = match kind {
                PatchKind::Filling => filling_triangle_count(self.method, self.spacing),
                _ => patch_triangle_count(&surface.tables.patches[entry as usize].info, factors, self.spacing),
            };
            if 3 * (triangles + more) > CAPTURE_VERTICES {
                break;
            }
            count += 1;
            triangles += more;
        }
        (count, triangles)
    }

    #[expect(clippy::too_many_arguments, reason = "one part is one place in one list of one surface")]
    fn capture_part(
        &self,
        device: &Device,
        surface: &Surface,
        frame: &FrameConstants,
        (kind, pipeline): &(PatchKind, GraphicsPipeline),
        first: u32,
        count: u32,
        triangles: u64,
    ) -> Result<Vec<CapturedVertex>, Error> {
        let arguments = draw_arguments(0, count, self.method, device.is_software());
        self.arguments.write(0, &[arguments])?;
        let push = frame.push(surface, *kind, &surface.buffers.list, first, &NO_CAMERA);
        let mut encoder = Encoder::new(device, "dump")?;
        let feedback = Feedback { name: "dump", targets: &[&self.capture], counters: &self.counter };
        let stride = size_of::<DrawArguments>() as u32;
        let draw = Draw::Indirect { arguments: &self.arguments, offset: 0, draw_count: 1, stride };
        encoder.transform_feedback(&feedback, &[FeedbackList { pipeline, push: bytemuck::bytes_of(&push), draw }]);
        let size = 3 * triangles * size_of::<CapturedVertex>() as u64;
        let (from, to) = (&self.capture, &self.read_back);
        encoder.transfer(&[Transfer::Copy { from, from_offset: 0, to, to_offset: 0, size }]);
        let report = device.submit_and_wait(&encoder.finish()?)?;
        let written = report.feedback.first().map_or(0, |(_, count)| count.written);
        if written != triangles {
            return Err(Error::TriangleCount { expected: triangles, found: written });
        }
        Ok(self.read_back.read(0, 3 * triangles as usize)?)
    }
}
