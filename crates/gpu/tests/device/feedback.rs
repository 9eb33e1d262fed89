use crate::draw::{Rectangle, stages, tessellation};
use crate::{buffer, with_device};
use bytemuck::bytes_of;
use planish_gpu::{
    Buffer, BufferKind, Device, Draw, DrawArguments, Encoder, Feedback, FeedbackCount, FeedbackList, GraphicsPipeline,
    GraphicsPipelineDesc, Topology,
};

const CAPTURE: &str = "
    layout(quads, equal_spacing, ccw) in;
    layout(location = 0) patch in vec4 bounds;
    layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 12) out vec3 point;
    layout(location = 1, xfb_buffer = 1, xfb_offset = 0, xfb_stride = 8) out vec2 uv;
    void main() {
        uv = gl_TessCoord.xy;
        point = vec3(mix(bounds.xy, bounds.zw, uv), depth);
        gl_Position = vec4(point, 1);
    }";

fn capture(device: &Device) -> GraphicsPipeline {
    let spirv = tessellation(CAPTURE);
    let desc = GraphicsPipelineDesc {
        name: "capture",
        stages: &stages(&spirv, None),
        push_size: size_of::<Rectangle>() as u32,
        topology: Topology::Patches { control_points: 1 },
        rasterizer_discard: true,
        ..GraphicsPipelineDesc::default()
    };
    GraphicsPipeline::new(device, &desc).unwrap()
}

/// Triangles of a quad patch of level `n`.
const fn triangles(n: u64) -> u64 {
    2 * n * n
}

/// Captures three draws of two lists: levels 2 and 2, then 3, at depths 1 and 2. Returns the count.
fn record(device: &Device, points: &Buffer, uvs: &Buffer, counters: &Buffer) -> FeedbackCount {
    let pipeline = capture(device);
    let corners = device.upload("corners", &[[0.0_f32, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]).unwrap();
    let two = [0, 1].map(|first_vertex| DrawArguments {
        vertex_count: 1,
        instance_count: 1,
        first_vertex,
        first_instance: 0,
    });
    let arguments = device.upload("arguments", &two).unwrap();
    let first = Rectangle { corners: corners.address(), level: 2.0, depth: 1.0 };
    let second = Rectangle { corners: corners.address(), level: 3.0, depth: 2.0 };
    let mut encoder = Encoder::new(device, "feedback").unwrap();
    encoder.transform_feedback(
        &Feedback { name: "capture", targets: &[points, uvs], counters },
        &[
            FeedbackList {
                pipeline: &pipeline,
                push: bytes_of(&first),
                draw: Draw::Indirect { arguments: &arguments, offset: 0, draw_count: 2, stride: 16 },
            },
            FeedbackList {
                pipeline: &pipeline,
                push: bytes_of(&second),
                draw: Draw::Direct { vertex_count: 1, instance_count: 1 },
            },
        ],
    );
    let report = device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
    assert_eq!(report.feedback.len(), 1);
    assert_eq!(report.feedback[0].0, "capture");
    report.feedback[0].1
}

#[test]
fn lists_are_appended_through_the_counters() {
    with_device(|device| {
        let points = buffer(device, "points", BufferKind::Readback, 12 * 300);
        let uvs = buffer(device, "uvs", BufferKind::Readback, 8 * 300);
        let counters = buffer(device, "counters", BufferKind::Readback, 8);
        let count = record(device, &points, &uvs, &counters);
        let expected = 2 * triangles(2) + triangles(3);
        assert_eq!(count, FeedbackCount { written: expected, needed: expected });
        let vertices = 3 * expected as u32;
        assert_eq!(counters.read::<u32>(0, 2).unwrap(), [12 * vertices, 8 * vertices]);

        let points = points.read::<[f32; 3]>(0, vertices as usize).unwrap();
        let uvs = uvs.read::<[f32; 2]>(0, vertices as usize).unwrap();
        let patch = 3 * triangles(2) as usize;
        for (vertex, (point, uv)) in points.iter().zip(&uvs).enumerate() {
            // Both lists start at corner 0; the second draw of the first list starts at corner 2.
            let is_second_draw = (patch..2 * patch).contains(&vertex);
            let origin = if is_second_draw { 2.0 } else { 0.0 };
            let depth = if vertex < 2 * patch { 1.0 } else { 2.0 };
            let expected = [origin + uv[0], origin + uv[1], depth];
            let error = (0..3).map(|axis| (point[axis] - expected[axis]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-6, "vertex {vertex}: {point:?} instead of {expected:?}");
        }
        // The patches are whole: their triangles' areas add up, all counter-clockwise.
        let areas = points.chunks(3).map(|triangle| {
            let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
            let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
            assert!(area > 0.0, "{triangle:?}");
            area
        });
        assert!((areas.sum::<f32>() - 3.0).abs() < 1e-4);
    });
}

#[test]
fn what_does_not_fit_is_counted_and_not_written() {
    with_device(|device| {
        let room = 20;
        let points = buffer(device, "points", BufferKind::Readback, 36 * room);
        let uvs = buffer(device, "uvs", BufferKind::Readback, 8 * 300);
        let counters = buffer(device, "counters", BufferKind::Readback, 8);
        let count = record(device, &points, &uvs, &counters);
        assert_eq!(count, FeedbackCount { written: room, needed: 2 * triangles(2) + triangles(3) });
        assert_eq!(counters.read::<u32>(0, 1).unwrap(), [36 * room as u32]);
    });
}

#[test]
fn without_lists_nothing_is_written() {
    with_device(|device| {
        let target = buffer(device, "target", BufferKind::Device, 12);
        let counters = device.upload("counters", &[7_u32]).unwrap();
        let mut encoder = Encoder::new(device, "nothing").unwrap();
        encoder.transform_feedback(&Feedback { name: "none", targets: &[&target], counters: &counters }, &[]);
        let report = device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        assert_eq!(report.feedback, [("none".to_owned(), FeedbackCount::default())]);
        assert_eq!(device.download::<u32>(&counters, 0, 1).unwrap(), [0]);
    });
}
