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
use crate::draw::depth_options;
use crate::error::Error;
use crate::frame::draw_push;
use crate::lists::{PatchKind, draw_arguments};
use crate::options::{FrameNeeds, SurfaceMethod};
use crate::pipelines::{Output, PipelineOptions, pipelines};
use crate::surface::{Surface, SurfaceDesc};

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
    /// Position on the limit surface, or on the displaced surface.
    pub position: [f32; 3],
    /// Unit normal of the limit surface, along which it is displaced; or 0.
    pub normal: [f32; 3],
    /// Parameters in the Ptex face.
    pub uv: [f32; 2],
    /// Ptex face.
    pub ptex_face: u32,
    /// Level in bits 0-7, kind of patch in bits 8-15.
    pub level_and_kind: u32,
    /// Texture coordinates, if they were asked for.
    pub tex_coord: [f32; 2],
    /// Unit normal of the displaced surface, or 0; of others the normal.
    pub shading_normal: [f32; 3],
    /// Colour, if it was asked for; white where the mesh has none.
    pub color: [f32; 3],
}

/// The passes that capture a surface.
pub struct DumpPasses {
    pipelines: Vec<(PatchKind, GraphicsPipeline)>,
    capture: Buffer,
    read_back: Buffer,
    counter: Buffer,
    arguments: Buffer,
}

impl DumpPasses {
    /// Makes pipelines and buffers; fails on a device without transform feedback.
    pub fn new(device: &Device, surface: &SurfaceDesc, needs: &FrameNeeds) -> Result<Self, Error> {
        if !device.has(Feature::TransformFeedback) {
            return Err(Error::NoTransformFeedback { device: device.name().to_owned() });
        }
        let options = PipelineOptions {
            output: Output::Dump,
            tex_coords: needs.tex_coords,
            colors: needs.colors,
            cutouts: false,
            ..depth_options(surface, needs)
        };
        let buffer = |name, kind, size| Buffer::new(device, &BufferDesc { name, kind, size });
        Ok(Self {
            pipelines: pipelines(device, &options)?,
            capture: buffer("capture", BufferKind::Device, CAPTURE_BYTES)?,
            read_back: buffer("captured", BufferKind::Readback, CAPTURE_BYTES)?,
            counter: buffer("capture counter", BufferKind::Device, 4)?,
            arguments: buffer("capture draw", BufferKind::Upload, size_of::<DrawArguments>() as u64)?,
        })
    }

    /// Captures all triangles, list by list, and hands them out in parts of whole triangles: what the frame that was submitted
    /// last listed.
    pub fn capture<E: From<Error>>(
        &self,
        device: &Device,
        surface: &Surface,
        mut sink: impl FnMut(&[CapturedVertex]) -> Result<(), E>,
    ) -> Result<(), E> {
        for pass in &self.pipelines {
            let (mut first, triangles) = triangles_of(device, surface, pass.0)?;
            for part in parts(&triangles) {
                let count = part.len() as u32;
                let vertices = self.capture_part(device, surface, pass, first, count, part.iter().sum())?;
                sink(&vertices)?;
                first += count;
            }
        }
        Ok(())
    }

    fn capture_part(
        &self,
        device: &Device,
        surface: &Surface,
        (kind, pipeline): &(PatchKind, GraphicsPipeline),
        first: u32,
        count: u32,
        triangles: u64,
    ) -> Result<Vec<CapturedVertex>, Error> {
        // Uniform quads are found by their vertices, other patches by their place in the list.
        let is_uniform = surface.desc.method == SurfaceMethod::Uniform;
        let first_drawn = if is_uniform { first } else { 0 };
        let arguments = draw_arguments(first_drawn, count, surface.desc.method, device.is_software());
        self.arguments.write(0, &[arguments])?;
        let push = draw_push(surface, *kind, if is_uniform { 0 } else { first }, &NO_CAMERA);
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

/// How many triangles a dump of what the frame that was submitted last listed has; waits for the device.
pub fn listed_triangle_count(device: &Device, surface: &Surface) -> Result<u64, Error> {
    let kinds = PatchKind::of_method(surface.desc.method, surface.desc.end_cap);
    kinds.iter().map(|&kind| Ok(triangles_of(device, surface, kind)?.1.iter().sum::<u64>())).sum()
}

/// Where the entries of a kind begin that the last frame listed, and how many triangles are made of each.
fn triangles_of(device: &Device, surface: &Surface, kind: PatchKind) -> Result<(u32, Vec<u64>), Error> {
    if surface.desc.method == SurfaceMethod::Uniform {
        return Ok((0, vec![2; surface.tables.filling.len()]));
    }
    let head = surface.status()?.draw_heads[kind as usize];
    let entries = surface.download_entries(device, head.first..head.first + head.count.min(head.capacity))?;
    Ok((head.first, entries.iter().map(|entry| u64::from(entry.triangles)).collect()))
}

/// Runs of entries whose triangles fit the buffer.
fn parts(triangles: &[u64]) -> Vec<&[u64]> {
    let (mut parts, mut first, mut sum) = (Vec::new(), 0, 0);
    for (i, &count) in triangles.iter().enumerate() {
        if 3 * (sum + count) > CAPTURE_VERTICES {
            parts.push(&triangles[first..i]);
            (first, sum) = (i, 0);
        }
        sum += count;
    }
    if first < triangles.len() {
        parts.push(&triangles[first..]);
    }
    parts
}
