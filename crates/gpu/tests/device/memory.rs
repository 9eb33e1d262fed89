use crate::{buffer, open, with_device};
use planish_gpu::{
    Buffer, BufferDesc, BufferKind, ComputePipeline, Device, DeviceOptions, Encoder, Error, Format, GraphicsPipeline,
    Image, ImageDesc, Recorded,
};

#[test]
fn an_allocation_over_the_budget_is_an_error_and_costs_nothing() {
    let budget = Some(1 << 20);
    let options = DeviceOptions { validation: true, memory_budget: budget, ..DeviceOptions::default() };
    let device = Device::open(&options).unwrap();
    let first = buffer(&device, "first", BufferKind::Device, 600 << 10);
    let desc = BufferDesc { name: "second", kind: BufferKind::Device, size: 600 << 10 };
    let error = Buffer::new(&device, &desc).err().unwrap();
    assert!(matches!(error, Error::OutOfBudget { budget: 1_048_576, .. }), "{error}");
    assert!(device.memory_used() >= first.size() && device.memory_used() < 2 * first.size());
    drop(first);
    assert_eq!(device.memory_used(), 0);
    buffer(&device, "second", BufferKind::Device, 600 << 10);
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}

#[test]
fn the_budget_is_below_the_largest_heap() {
    let device = open();
    assert!(device.memory_budget() < device.limits().largest_heap);
    let desc = BufferDesc { name: "huge", kind: BufferKind::Device, size: 1 << 40 };
    let error = Buffer::new(&device, &desc).err().unwrap();
    assert!(matches!(error, Error::OutOfBudget { .. } | Error::OverLimit { .. }), "{error}");
}

#[test]
fn mapped_access_outside_of_a_buffer_or_of_another_kind_is_an_error() {
    with_device(|device| {
        let upload = buffer(device, "upload", BufferKind::Upload, 8);
        assert!(matches!(upload.write(4, &[0_u32; 2]), Err(Error::OutOfRange { end: 12, size: 8, .. })));
        assert!(matches!(upload.read::<u32>(0, 1), Err(Error::NotMapped { .. })));
        let readback = buffer(device, "read-back", BufferKind::Readback, 8);
        assert!(matches!(readback.read::<u64>(0, usize::MAX), Err(Error::OutOfRange { .. })));
        assert!(matches!(readback.write(0, &[0_u8]), Err(Error::NotMapped { .. })));
        assert_eq!(readback.address() % 16, 0);
    });
}

#[test]
fn a_large_upload_arrives_in_pieces_and_whole() {
    with_device(|device| {
        // 20 MiB: more than is staged at once.
        let values: Vec<u32> = (0..5 << 20).collect();
        let buffer = device.upload("large", &values).unwrap();
        assert!(device.download::<u32>(&buffer, 0, values.len()).unwrap() == values);
    });
}

#[test]
fn an_empty_buffer_has_an_address() {
    with_device(|device| {
        let empty = device.upload::<u32>("empty", &[]).unwrap();
        assert_eq!(empty.size(), 0);
        assert_ne!(empty.address(), 0);
    });
}

#[test]
fn an_image_too_large_for_the_device_is_an_error() {
    with_device(|device| {
        let extent = [device.limits().max_image_extent + 1, 1];
        let error = Image::new(device, &ImageDesc { name: "wide", format: Format::Rgba8Unorm, extent }).err();
        assert!(matches!(error, Some(Error::UnsupportedImage { .. })));
        let error = Image::new(device, &ImageDesc { name: "none", format: Format::R32Uint, extent: [4, 0] }).err();
        assert!(matches!(error, Some(Error::UnsupportedImage { .. })));
    });
}

#[test]
fn handles_can_be_sent_to_and_shared_with_other_threads() {
    fn is_send_and_sync<T: Send + Sync>() {}
    is_send_and_sync::<(Device, Buffer, Image, ComputePipeline, GraphicsPipeline, Recorded, Encoder)>();
}

#[test]
fn objects_may_outlive_every_other_handle_of_their_device() {
    let device = open();
    let buffer = buffer(&device, "orphan", BufferKind::Readback, 64);
    drop(device);
    assert_eq!(buffer.read::<u8>(0, 64).unwrap().len(), 64);
}
