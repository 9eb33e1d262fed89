//! `MurmurHash3_x86_32` by Austin Appleby (public domain), which Cryptomatte names objects by.

/// The hash of bytes with seed 0.
pub(crate) fn hash(bytes: &[u8]) -> u32 {
    let (blocks, tail) = bytes.as_chunks::<4>();
    let mut hash = blocks.iter().fold(0, |hash, &block| {
        let mixed: u32 = hash ^ scramble(u32::from_le_bytes(block));
        mixed.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    // Bytes beyond the last block, as if 0 followed; with none of them this changes nothing.
    let mut last = [0; 4];
    last[..tail.len()].copy_from_slice(tail);
    hash ^= scramble(u32::from_le_bytes(last));
    finalize(hash ^ bytes.len() as u32)
}

fn scramble(block: u32) -> u32 {
    block.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593)
}

fn finalize(hash: u32) -> u32 {
    let hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    let hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_hashes_come_out() {
        // Known values with seed 0, for each length of the tail.
        let known: [(&str, u32); 6] = [
            ("", 0),
            ("a", 0x3c25_69b2),
            ("aa", 0x3710_91a9),
            ("aaa", 0xb4d0_5fb7),
            ("test", 0xba6b_d213),
            ("Hello, world!", 0xc036_3e43),
        ];
        for (text, expected) in known {
            assert_eq!(hash(text.as_bytes()), expected, "{text:?}");
        }
    }
}
