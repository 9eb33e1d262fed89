//! What a header may claim: refused before anything is allocated for it.
use crate::error::Fault;

/// Most texels in a row or a column of a file.
pub const MAX_SIDE: u64 = 16384;
/// Most numbers in a map, all tiles and levels together: 4 GiB.
const MAX_VALUES: u64 = 1 << 30;
/// Most bytes that a decoder may need for one file.
pub const MAX_DECODED_BYTES: u64 = 1 << 32;
/// Most bytes that one byte of a file may stand for: DEFLATE reaches 1032, LZW with codes of 12 bits for strings of up to
/// 4096 bytes less than 2048 in the mean.
const MAX_EXPANSION: u64 = 2048;
/// What a header and the like may take of a file without being counted.
const HEADER_BYTES: u64 = 1024;

/// Refuses images without texels, too large ones, and those that the file is too short for. `texel_bytes` counts all
/// channels that are decoded.
pub fn check_claim(width: u64, height: u64, texel_bytes: u64, file_bytes: u64) -> Result<(), Fault> {
    let sides = 1..=MAX_SIDE;
    if !sides.contains(&width) || !sides.contains(&height) {
        return Err(Fault::whole(
            format!("an image of {width} x {height} texels"),
            format!("1 to {MAX_SIDE} texels a side"),
        ));
    }
    let decoded = (width * height).saturating_mul(texel_bytes);
    if decoded > MAX_DECODED_BYTES {
        return Err(Fault::whole(
            format!("an image of {width} x {height} texels of {texel_bytes} bytes"),
            format!("at most {MAX_DECODED_BYTES} bytes when decoded"),
        ));
    }
    if decoded > file_bytes.saturating_add(HEADER_BYTES).saturating_mul(MAX_EXPANSION) {
        return Err(Fault::whole(
            format!("{file_bytes} bytes for an image of {width} x {height} texels"),
            "a file that is not cut short",
        ));
    }
    Ok(())
}

/// Refuses a map of more values than there may be.
pub fn check_values(value_count: u64) -> Result<(), Fault> {
    if value_count > MAX_VALUES {
        let found = format!("a map of {value_count} values or more, with all tiles and levels");
        return Err(Fault::whole(found, format!("at most {MAX_VALUES}")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_that_a_file_cannot_keep_are_refused() {
        let refused = |width, height, file_bytes| check_claim(width, height, 12, file_bytes).is_err();
        assert!(refused(0, 1, 100) && refused(1, 0, 100));
        assert!(refused(16385, 1, 1 << 40) && refused(u64::MAX, u64::MAX, u64::MAX));
        assert!(refused(16384, 16384, 100) && !refused(16384, 16384, 3 << 20));
        assert!(check_claim(16384, 16384, 17, u64::MAX).is_err());
        assert!(!refused(1, 1, 0));
    }
}
