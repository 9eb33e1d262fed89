use crate::shader::compile;
use crate::{buffer, with_device};
use bytemuck::{Pod, Zeroable};
use glslang::ShaderStage;
use planish_gpu::{
    BufferKind, Clear, ColorTarget, DepthTarget, DepthTest, Device, Draw, DrawArguments, Encoder, Format,
    GraphicsPipeline, GraphicsPipelineDesc, Image, ImageDesc, PolygonMode, RenderTargets, Stage, StageDesc, Topology,
};

/// An axis-aligned rectangle in clip space, drawn as one quad patch per instance.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Rectangle {
    pub corners: u64,
    pub level: f32,
    pub depth: f32,
}

const PUSH: &str = "
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Corners { vec2 v[]; };
    layout(push_constant, scalar) uniform Push { Corners corners; float level; float depth; };";

pub const VERTEX: &str = "
    layout(location = 0) out uint patch_index;
    void main() { patch_index = gl_VertexIndex + gl_InstanceIndex; gl_Position = vec4(0); }";

pub const CONTROL: &str = "
    layout(vertices = 1) out;
    layout(location = 0) in uint patch_index[];
    layout(location = 0) patch out vec4 bounds;
    void main() {
        bounds = vec4(corners.v[2 * patch_index[0]], corners.v[2 * patch_index[0] + 1]);
        gl_TessLevelOuter = float[4](level, level, level, level);
        gl_TessLevelInner = float[2](level, level);
    }";

const EVALUATION: &str = "
    layout(quads, equal_spacing, ccw) in;
    layout(location = 0) patch in vec4 bounds;
    void main() { gl_Position = vec4(mix(bounds.xy, bounds.zw, gl_TessCoord.xy), depth, 1); }";

const FRAGMENT: &str = "
    layout(location = 0) out vec4 color;
    layout(location = 1) out uint id;
    void main() { color = vec4(gl_FrontFacing ? 1 : 0, 0, depth, 1); id = uint(gl_PrimitiveID) + 7; }";

const FORMATS: [Format; 2] = [Format::Rgba32Float, Format::R32Uint];
const SIZE: [u32; 2] = [16, 8];

/// The SPIR-V of vertex, control and the given evaluation shader.
pub fn tessellation(evaluation: &str) -> [Vec<u32>; 3] {
    [
        compile(ShaderStage::Vertex, VERTEX),
        compile(ShaderStage::TesselationControl, &format!("{PUSH}{CONTROL}")),
        compile(ShaderStage::TesselationEvaluation, &format!("{PUSH}{evaluation}")),
    ]
}

pub fn stages<'a>(spirv: &'a [Vec<u32>], fragment: Option<&'a Vec<u32>>) -> Vec<StageDesc<'a>> {
    let kinds = [Stage::Vertex, Stage::TessellationControl, Stage::TessellationEvaluation, Stage::Fragment];
    let all = spirv.iter().chain(fragment);
    kinds.into_iter().zip(all).map(|(stage, spirv)| StageDesc { stage, spirv, spec: &[] }).collect()
}

pub fn rectangles(device: &Device, desc: &GraphicsPipelineDesc<'_>) -> GraphicsPipeline {
    let spirv = tessellation(EVALUATION);
    let fragment = compile(ShaderStage::Fragment, &format!("{PUSH}{FRAGMENT}"));
    let desc = GraphicsPipelineDesc {
        name: "rectangles",
        stages: &stages(&spirv, Some(&fragment)),
        push_size: size_of::<Rectangle>() as u32,
        topology: Topology::Patches { control_points: 1 },
        color_formats: &FORMATS,
        depth_format: Some(Format::Depth32Float),
        ..*desc
    };
    GraphicsPipeline::new(device, &desc).unwrap()
}

pub struct Picture {
    pub color: Image,
    pub id: Image,
    pub depth: Image,
}

impl Picture {
    pub fn new(device: &Device) -> Self {
        let image = |name, format| Image::new(device, &ImageDesc { name, format, extent: SIZE }).unwrap();
        let [color, id] = FORMATS;
        Self { color: image("color", color), id: image("id", id), depth: image("depth", Format::Depth32Float) }
    }

    pub fn begin(&self, encoder: &mut Encoder, clears: [Clear; 2], depth: Option<f32>) {
        encoder.begin_rendering(&RenderTargets {
            colors: &[
                ColorTarget { image: &self.color, clear: clears[0] },
                ColorTarget { image: &self.id, clear: clears[1] },
            ],
            depth: Some(DepthTarget { image: &self.depth, clear: depth }),
            extent: SIZE,
        });
    }
}

pub const CLEARS: [Clear; 2] = [Clear::Float([0.25; 4]), Clear::Uint([3; 4])];

#[test]
fn a_tessellated_patch_covers_its_pixels_and_shows_its_front() {
    with_device(|device| {
        let pipeline = rectangles(device, &GraphicsPipelineDesc { cull_back: true, ..Default::default() });
        let picture = Picture::new(device);
        // The upper left quarter: rows 0 to 3, columns 0 to 7.
        let corners = device.upload("corners", &[[-1.0_f32, 0.0], [0.0, 1.0]]).unwrap();
        let output = buffer(device, "output", BufferKind::Readback, 16 * 8 * (16 + 4 + 4));
        let mut encoder = Encoder::new(device, "draw").unwrap();
        picture.begin(&mut encoder, CLEARS, Some(1.0));
        let push = Rectangle { corners: corners.address(), level: 3.0, depth: 0.5 };
        encoder.draw(&pipeline, &push, Draw::Direct { vertex_count: 1, instance_count: 1 });
        encoder.end_rendering();
        encoder.copy_image_to_buffer(&picture.color, &output, 0);
        encoder.copy_image_to_buffer(&picture.id, &output, picture.color.copy_size());
        encoder.copy_image_to_buffer(&picture.depth, &output, picture.color.copy_size() + picture.id.copy_size());
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let colors = output.read::<[f32; 4]>(0, 128).unwrap();
        let ids = output.read::<u32>(128 * 16, 128).unwrap();
        let depths = output.read::<f32>(128 * 20, 128).unwrap();
        for (pixel, color) in colors.iter().enumerate() {
            let is_inside = pixel / 16 < 4 && pixel % 16 < 8;
            assert_eq!(*color, if is_inside { [1.0, 0.0, 0.5, 1.0] } else { [0.25; 4] }, "pixel {pixel}");
            assert_eq!(ids[pixel] == 3, !is_inside, "pixel {pixel}");
            assert_eq!(depths[pixel], 1.0, "depth is not written");
        }
    });
}

#[test]
fn indirect_draws_with_arguments_and_count_from_the_gpu_keep_the_nearest() {
    with_device(|device| {
        let near = GraphicsPipelineDesc { depth_test: DepthTest::Greater, depth_write: true, ..Default::default() };
        let pipeline = rectangles(device, &near);
        let picture = Picture::new(device);
        let corners = device.upload("corners", &[[-1.0_f32, -1.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0]]).unwrap();
        let one = DrawArguments { vertex_count: 1, instance_count: 1, first_vertex: 0, first_instance: 0 };
        // The right half, then the left half, then one that the count leaves out.
        let list = [DrawArguments { first_vertex: 1, ..one }, one, DrawArguments { instance_count: 9, ..one }];
        let source = device.upload("list", &list).unwrap();
        let arguments = buffer(device, "arguments", BufferKind::Device, source.size());
        let count = buffer(device, "count", BufferKind::Device, 4);
        let output = buffer(device, "output", BufferKind::Readback, picture.color.copy_size());
        let mut encoder = Encoder::new(device, "indirect").unwrap();
        encoder.copy_buffer(&source, &arguments);
        encoder.fill_buffer(&count, 0, 4, 2);
        picture.begin(&mut encoder, CLEARS, Some(0.0));
        let push = |depth| Rectangle { corners: corners.address(), level: 1.0, depth };
        let counted = Draw::IndirectCount {
            arguments: &arguments,
            offset: 0,
            count: &count,
            count_offset: 0,
            max_draw_count: 3,
            stride: 16,
        };
        encoder.draw(&pipeline, &push(0.5), counted);
        encoder.end_rendering();
        // A second rendering keeps what is there: only the left half is nearer.
        picture.begin(&mut encoder, [Clear::Keep; 2], None);
        let left = Draw::Indirect { arguments: &arguments, offset: 16, draw_count: 1, stride: 16 };
        let both = Draw::Indirect { arguments: &arguments, offset: 0, draw_count: 2, stride: 16 };
        encoder.draw(&pipeline, &push(0.75), left);
        encoder.draw(&pipeline, &push(0.25), both);
        encoder.end_rendering();
        encoder.copy_image_to_buffer(&picture.color, &output, 0);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        for (pixel, color) in output.read::<[f32; 4]>(0, 128).unwrap().iter().enumerate() {
            assert_eq!(color[2], if pixel % 16 < 8 { 0.75 } else { 0.5 }, "pixel {pixel}");
        }
    });
}

#[test]
fn lines_leave_the_inside_empty() {
    with_device(|device| {
        let pipeline =
            rectangles(device, &GraphicsPipelineDesc { polygon_mode: PolygonMode::Line, ..Default::default() });
        let picture = Picture::new(device);
        let corners = device.upload("corners", &[[-0.95_f32, -0.9], [0.95, 0.9]]).unwrap();
        let output = buffer(device, "output", BufferKind::Readback, picture.color.copy_size());
        let mut encoder = Encoder::new(device, "lines").unwrap();
        picture.begin(&mut encoder, CLEARS, Some(1.0));
        let push = Rectangle { corners: corners.address(), level: 1.0, depth: 0.5 };
        encoder.draw(&pipeline, &push, Draw::Direct { vertex_count: 1, instance_count: 1 });
        encoder.end_rendering();
        encoder.copy_image_to_buffer(&picture.color, &output, 0);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let colors = output.read::<[f32; 4]>(0, 128).unwrap();
        let drawn = colors.iter().filter(|color| **color != [0.25; 4]).count();
        assert!((40..90).contains(&drawn), "{drawn} pixels of two triangles' edges");
    });
}

#[test]
#[should_panic(expected = "formats of the targets")]
fn a_pipeline_for_other_targets_panics_before_the_driver_does() {
    with_device(|device| {
        let pipeline = rectangles(device, &GraphicsPipelineDesc::default());
        let picture = Picture::new(device);
        let mut encoder = Encoder::new(device, "mismatch").unwrap();
        let colors = [ColorTarget { image: &picture.color, clear: Clear::Keep }];
        encoder.begin_rendering(&RenderTargets { colors: &colors, depth: None, extent: SIZE });
        let push = Rectangle { corners: 0, level: 1.0, depth: 0.0 };
        encoder.draw(&pipeline, &push, Draw::Direct { vertex_count: 0, instance_count: 0 });
    });
}
