use crate::{buffer, open};
use planish_gpu::{BufferKind, Encoder, Transfer};

#[test]
fn a_missing_barrier_is_reported() {
    let device = open();
    let buffer = buffer(&device, "twice filled", BufferKind::Device, 64);
    let mut encoder = Encoder::new(&device, "a lie").unwrap();
    // Called independent, but they write the same words.
    let fill = |value| Transfer::Fill { buffer: &buffer, offset: 0, size: 64, value };
    encoder.transfer(&[fill(1), fill(2)]);
    device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
    let messages = device.validation_messages();
    assert!(messages.iter().any(|message| message.contains("SYNC-HAZARD-WRITE-AFTER-WRITE")), "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("twice filled")), "{messages:?}");
}

#[test]
fn the_same_fills_in_two_passes_are_in_order() {
    crate::with_device(|device| {
        let buffer = buffer(device, "filled in order", BufferKind::Device, 64);
        let mut encoder = Encoder::new(device, "the truth").unwrap();
        encoder.fill_buffer(&buffer, 0, 64, 1);
        encoder.fill_buffer(&buffer, 0, 64, 2);
        device.submit_and_wait(&encoder.finish().unwrap()).unwrap();
        assert_eq!(device.download::<u32>(&buffer, 60, 1).unwrap(), [2]);
    });
}
