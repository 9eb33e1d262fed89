use crate::shader::compile;
use crate::{buffer, with_device};
use bytemuck::{Pod, Zeroable};
use glslang::ShaderStage;
use planish_gpu::{
    BufferKind, ComputePipeline, ComputePipelineDesc, Device, DispatchArguments, Encoder, Error, SpecConstant,
};

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Scale {
    from: u64,
    to: u64,
    count: u32,
    padding: u32,
}

const SCALE: &str = "
    layout(local_size_x_id = 0) in;
    layout(constant_id = 1) const uint factor = 2;
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Numbers { uint v[]; };
    layout(push_constant, scalar) uniform Push { Numbers from; Numbers to; uint count; uint padding; };
    void main() {
        uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
        uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        if (i < count) to.v[i] = from.v[i] * factor;
    }";

fn scale_by(device: &Device, factor: u32, local_size: u32) -> ComputePipeline {
    let spirv = compile(ShaderStage::Compute, SCALE);
    let spec = [SpecConstant { id: 0, bits: local_size }, SpecConstant { id: 1, bits: factor }];
    let push_size = size_of::<Scale>() as u32;
    let desc = ComputePipelineDesc { name: "scale", spirv: &spirv, push_size, local_size, spec: &spec };
    ComputePipeline::new(device, &desc).unwrap()
}

#[test]
fn each_pass_sees_what_the_pass_before_wrote() {
    with_device(|device| {
        let (double, triple) = (scale_by(device, 2, 64), scale_by(device, 3, 64));
        let numbers: Vec<u32> = (0..1000).collect();
        let input = device.upload("numbers", &numbers).unwrap();
        let middle = buffer(device, "middle", BufferKind::Device, input.size());
        let output = buffer(device, "output", BufferKind::Readback, input.size());
        let push = |from: u64, to: u64| Scale { from, to, count: 1000, padding: 0 };
        let mut encoder = Encoder::new(device, "two passes").unwrap();
        encoder.compute(&double, &push(input.address(), middle.address()), 1000);
        encoder.compute(&triple, &push(middle.address(), output.address()), 1000);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let expected: Vec<u32> = numbers.iter().map(|number| number * 6).collect();
        assert_eq!(output.read::<u32>(0, 1000).unwrap(), expected);
        assert_eq!(device.download::<u32>(&middle, 4 * 999, 1).unwrap(), [1998]);
    });
}

#[test]
fn a_recording_can_be_submitted_again() {
    with_device(|device| {
        let double = scale_by(device, 2, 64);
        let numbers = buffer(device, "numbers", BufferKind::Upload, 4);
        numbers.write(0, &[7_u32]).unwrap();
        let at = numbers.address();
        let result = buffer(device, "result", BufferKind::Readback, 4);
        let mut encoder = Encoder::new(device, "again").unwrap();
        encoder.timestamp("start");
        encoder.compute(&double, &Scale { from: at, to: at, count: 1, padding: 0 }, 1);
        encoder.copy_buffer(&numbers, &result);
        encoder.timestamp("end");
        let recorded = encoder.finish().unwrap();
        for expected in [14, 28, 56] {
            let report = device.submit_and_wait(&recorded).unwrap();
            assert_eq!(result.read::<u32>(0, 1).unwrap(), [expected]);
            assert_eq!(report.timestamps.len(), 2);
        }
        numbers.write(0, &[1_u32]).unwrap();
        device.submit_and_wait(&recorded).unwrap();
        assert_eq!(result.read::<u32>(0, 1).unwrap(), [2]);
    });
}

#[test]
fn an_indirect_dispatch_reads_arguments_that_a_pass_before_wrote() {
    with_device(|device| {
        let double = scale_by(device, 2, 1);
        let one = device.upload("one", &[1_u32; 16]).unwrap();
        let arguments = buffer(device, "arguments", BufferKind::Device, 32);
        let output = buffer(device, "output", BufferKind::Readback, 4 * 16);
        let push = |to: u64, count| Scale { from: one.address(), to, count, padding: 0 };
        let mut encoder = Encoder::new(device, "indirect").unwrap();
        encoder.fill_buffer(&output, 0, output.size(), 0);
        // x = 2 groups by compute, then y = 1 and z = 1 by a fill.
        encoder.compute(&double, &push(arguments.address() + 16, 1), 1);
        encoder.fill_buffer(&arguments, 20, 8, 1);
        encoder.compute_indirect(&double, &push(output.address(), 16), &arguments, 16);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        assert_eq!(device.download::<DispatchArguments>(&arguments, 16, 1).unwrap()[0].x, 2);
        assert_eq!(output.read::<u32>(0, 4).unwrap(), [2, 2, 0, 0]);
    });
}

#[test]
fn independent_dispatches_run_without_a_barrier_between_them() {
    with_device(|device| {
        let (double, triple) = (scale_by(device, 2, 32), scale_by(device, 3, 32));
        let input = device.upload("input", &[5_u32; 100]).unwrap();
        let output = buffer(device, "output", BufferKind::Readback, 800);
        let push = |to: u64| Scale { from: input.address(), to, count: 100, padding: 0 };
        let mut encoder = Encoder::new(device, "independent").unwrap();
        encoder.begin_label("both");
        encoder.compute(&double, &push(output.address()), 100);
        encoder.compute_more(&triple, &push(output.address() + 400), 100);
        encoder.end_label();
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        assert_eq!(output.read::<u32>(396, 2).unwrap(), [10, 15]);
    });
}

#[test]
fn more_groups_than_one_row_holds_reach_every_thread() {
    with_device(|device| {
        const COUNT: u32 = 70_000;
        let double = scale_by(device, 2, 1);
        let input = device.upload("input", &(0..COUNT).collect::<Vec<_>>()).unwrap();
        let output = buffer(device, "output", BufferKind::Readback, input.size());
        let mut encoder = Encoder::new(device, "rows").unwrap();
        let push = Scale { from: input.address(), to: output.address(), count: COUNT, padding: 0 };
        encoder.compute(&double, &push, COUNT);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        let expected: Vec<u32> = (0..COUNT).map(|number| number * 2).collect();
        assert_eq!(output.read::<u32>(0, COUNT as usize).unwrap(), expected);
    });
}

#[test]
fn words_that_are_not_spirv_and_oversized_groups_are_errors() {
    with_device(|device| {
        let desc = ComputePipelineDesc { name: "bad", spirv: &[1, 2, 3], push_size: 0, local_size: 1, spec: &[] };
        assert!(matches!(ComputePipeline::new(device, &desc), Err(Error::NotSpirv { .. })));
        let huge = ComputePipelineDesc { local_size: 1 << 20, ..desc };
        let error = ComputePipeline::new(device, &huge).err().unwrap().to_string();
        assert!(error.starts_with("bad: maxComputeWorkGroupSize is 1048576"), "{error}");
    });
}
