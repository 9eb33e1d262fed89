//! How much the layers of a stage may hold when they are expanded.
use crate::gltf::fault::Fault;

/// What any stage may expand to, whatever its size, bytes. What is counted holds the room that integers are unpacked in; widening
/// and checking them takes as much again: of a megabyte that is (32 + 128) * 2 MiB, below 512 MiB with the program itself.
const FLOOR: u64 = 32 << 20;
/// What every byte of a layer may expand to. Meshes take 12, prims with transforms 20, and prims that have nothing but a name in
/// sequence 50, measured on a hundred thousand of each.
const BYTES_A_BYTE: u64 = 128;
/// Pairs of items of a list that are compared in the time that a byte is expanded in.
const PAIRS_A_BYTE: u64 = 64;

/// What is left for a stage; all its layers share one.
#[derive(Debug)]
pub struct Budget {
    left: u64,
}

impl Budget {
    pub fn new() -> Self {
        Self { left: FLOOR }
    }

    /// Adds what a layer of so many bytes may expand to.
    pub fn add_layer(&mut self, size: usize) {
        self.left = self.left.saturating_add((size as u64).saturating_mul(BYTES_A_BYTE));
    }

    /// Takes so many bytes, or says that what is at a place expands to too much.
    pub fn charge(&mut self, place: &str, bytes: u64) -> Result<(), Fault> {
        let Some(left) = self.left.checked_sub(bytes) else {
            let found = format!("content that expands to {bytes} bytes where {} are left", self.left);
            let expected = format!("at most {} MiB and {BYTES_A_BYTE} times the bytes of all layers", FLOOR >> 20);
            return Err(Fault::new(place, found, expected));
        };
        self.left = left;
        Ok(())
    }

    /// Takes what a list of so many items costs where each is compared with each.
    pub fn charge_pairs(&mut self, place: &str, items: u64) -> Result<(), Fault> {
        self.charge(place, items.saturating_mul(items) / PAIRS_A_BYTE)
    }
}
