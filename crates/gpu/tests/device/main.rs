//! The backend on a real device, with validation and its synchronization checks on.
//! Without a device or the validation layer these tests fail: Mesa's lavapipe and the layer are packages away.

mod compute;
mod draw;
mod feedback;
mod memory;
mod queries;
mod refusal;
mod shader;
mod validation;

use planish_gpu::{Buffer, BufferDesc, BufferKind, Device, DeviceOptions};

/// Opens the default device and checks after the test that validation had nothing to say.
fn with_device(test: impl FnOnce(&Device)) {
    let device = open();
    test(&device);
    assert_eq!(device.validation_messages(), Vec::<String>::new());
}

fn open() -> Device {
    let options = DeviceOptions { validation: true, ..DeviceOptions::default() };
    Device::open(&options).unwrap_or_else(|error| panic!("these tests need a Vulkan device: {error}"))
}

fn buffer(device: &Device, name: &str, kind: BufferKind, size: u64) -> Buffer {
    Buffer::new(device, &BufferDesc { name, kind, size }).unwrap()
}
