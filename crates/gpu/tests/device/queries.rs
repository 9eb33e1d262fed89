use crate::draw::{CLEARS, Picture, Rectangle, rectangles};
use crate::with_device;
use planish_gpu::{Draw, Encoder, GraphicsPipelineDesc};

#[test]
fn statistics_count_what_the_tessellator_made() {
    with_device(|device| {
        let pipeline = rectangles(device, &GraphicsPipelineDesc::default());
        let picture = Picture::new(device);
        let corners = device.upload("corners", &[[-1.0_f32, -1.0], [1.0, 1.0]]).unwrap();
        let mut encoder = Encoder::new(device, "statistics").unwrap();
        for level in [1.0, 4.0] {
            picture.begin(&mut encoder, CLEARS, Some(1.0));
            encoder.begin_statistics(&format!("level {level}"));
            let push = Rectangle { corners: corners.address(), level, depth: 0.5 };
            encoder.draw(&pipeline, &push, Draw::Direct { vertex_count: 1, instance_count: 1 });
            encoder.end_statistics();
            encoder.end_rendering();
        }
        let report = device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let [(first, one), (second, four)] = &report.statistics[..] else { panic!("{:?}", report.statistics) };
        assert_eq!((&**first, &**second), ("level 1", "level 4"));
        assert_eq!((one.clipping_invocations, four.clipping_invocations), (2, 32));
        assert_eq!((one.clipping_primitives, four.clipping_primitives), (2, 32));
        assert_eq!((one.tessellation_control_patches, four.vertex_invocations), (1, 1));
        assert!(four.tessellation_evaluation_invocations >= 25, "{four:?}");
        assert!(four.fragment_invocations >= 128, "{four:?}");
        assert_eq!(four.compute_invocations, 0);
    });
}

#[test]
fn timestamps_start_at_zero_and_do_not_go_back() {
    with_device(|device| {
        let mut encoder = Encoder::new(device, "time").unwrap();
        let buffer = crate::buffer(device, "work", planish_gpu::BufferKind::Device, 1 << 20);
        for name in ["start", "fill", "again"] {
            encoder.timestamp(name);
            encoder.fill_buffer(&buffer, 0, buffer.size(), 0);
        }
        let report = device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let names: Vec<_> = report.timestamps.iter().map(|(name, _)| &**name).collect();
        assert_eq!(names, ["start", "fill", "again"]);
        assert_eq!(report.timestamps[0].1, 0.0);
        assert!(report.timestamps.is_sorted_by(|before, after| before.1 <= after.1), "{:?}", report.timestamps);
        let wall = report.wall.as_secs_f64() * 1e3;
        assert!(report.timestamps[2].1 <= wall, "{:?} in {wall} ms", report.timestamps);
    });
}
