//! Compressed blocks of binary layers: a `u64` of their size, a byte that counts chunks, and LZ4; integers are coded inside.
use super::budget::Budget;
use super::cursor::Cursor;
use crate::gltf::fault::Fault;

/// LZ4 repeats at most 255 bytes for a byte of its own, and a little for its first.
const BYTES_A_BYTE: u64 = 255;
const FIRST_BYTES: u64 = 64;

/// What integers take before LZ4, at least: the common difference, and two bits for each that differs by it.
fn least_coded(count: u64) -> u64 {
    if count == 0 { 0 } else { 4 + count.div_ceil(4) }
}

/// What integers take before LZ4, at most: four bytes more for each.
fn most_coded(count: u64) -> u64 {
    least_coded(count).saturating_add(count.saturating_mul(4))
}

/// The bytes of a block that holds at least so many when it is expanded.
fn block<'a>(cursor: &mut Cursor<'a>, least: u64) -> Result<&'a [u8], Fault> {
    let size = cursor.count(1)?;
    let most = size.saturating_mul(BYTES_A_BYTE).saturating_add(FIRST_BYTES);
    if size == 0 || least > most {
        let found = format!("a compressed block of {size} bytes for {least} or more");
        return Err(cursor.fault(found, format!("one that can hold them: at least {}", least / BYTES_A_BYTE + 1)));
    }
    cursor.bytes(size)
}

/// Steps over an array of compressed integers, of which each takes so many bytes when read.
pub fn skip_integers(cursor: &mut Cursor, count: u64, bytes_each: u64, budget: &mut Budget) -> Result<(), Fault> {
    // What it is unpacked to on the way counts too, and the list may grow by doubling.
    let bytes = count.saturating_mul(2 * bytes_each).saturating_add(most_coded(count));
    budget.charge(cursor.place(), bytes)?;
    block(cursor, least_coded(count)).map(|_| ())
}

/// Expands a block to at most so many bytes.
pub fn expand(cursor: &mut Cursor, most: u64, least: u64, budget: &mut Budget) -> Result<Vec<u8>, Fault> {
    budget.charge(cursor.place(), most)?;
    let block = block(cursor, least)?;
    let mut expanded = vec![0; most as usize];
    let content = match block {
        [0, content @ ..] => content,
        [chunks, ..] => {
            return Err(cursor.fault(format!("a block of {chunks} chunks"), "one in one piece, which is below 2 GiB"));
        }
        [] => return Err(cursor.fault("an empty block", "one byte or more")),
    };
    let size = lz4_flex::decompress_into(content, &mut expanded);
    let size = size.map_err(|error| cursor.fault(format!("a damaged block: {error}"), "one of LZ4"))?;
    expanded.truncate(size);
    Ok(expanded)
}

/// Expands integers of 32 bits.
pub fn integers(cursor: &mut Cursor, count: u64, budget: &mut Budget) -> Result<Vec<u32>, Fault> {
    // Twice: the crate's list of them may grow by doubling.
    budget.charge(cursor.place(), count.saturating_mul(8))?;
    let coded = expand(cursor, most_coded(count), least_coded(count), budget)?;
    decode(&coded, count as usize).ok_or_else(|| cursor.fault("integers that end early", format!("{count} of them")))
}

fn decode(coded: &[u8], count: usize) -> Option<Vec<u32>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let common = i32::from_le_bytes(*coded.first_chunk()?);
    let codes = coded.get(4..4 + count.div_ceil(4))?;
    let mut rest = coded.get(4 + codes.len()..)?;
    let mut last = 0_i32;
    let mut integers = Vec::with_capacity(count);
    for place in 0..count {
        let difference = match (codes[place / 4] >> (2 * (place % 4))) & 3 {
            0 => common,
            1 => take(&mut rest).map(i8::from_le_bytes)?.into(),
            2 => take(&mut rest).map(i16::from_le_bytes)?.into(),
            _ => take(&mut rest).map(i32::from_le_bytes)?,
        };
        last = last.wrapping_add(difference);
        integers.push(last.cast_unsigned());
    }
    Some(integers)
}

fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (first, others) = rest.split_first_chunk()?;
    *rest = others;
    Some(*first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_sums_of_coded_differences() {
        // The example of OpenUSD's integerCoding.cpp.
        let mut coded = 1_i32.to_le_bytes().to_vec();
        coded.extend([0b0001_0001, 0b1100_0001_u8]);
        let coded = [
            coded[..4].to_vec(),
            vec![0b1100_0001, 0b0001_0001],
            vec![123],
            100_000_i32.to_le_bytes().to_vec(),
            vec![0, 0],
        ]
        .concat();
        assert_eq!(decode(&coded, 7), Some(vec![123, 124, 125, 100_125, 100_125, 100_126, 100_126]));
        assert_eq!(decode(&coded[..coded.len() - 1], 7), None);
    }

    #[test]
    fn a_block_holds_what_it_claims() {
        let bytes = [&2_u64.to_le_bytes()[..], &[0, 0]].concat();
        let mut budget = Budget::new();
        let mut skip = |count| skip_integers(&mut Cursor::new(&bytes, 0, "array"), count, 4, &mut budget);
        assert!(skip(2000).is_ok());
        assert!(skip(3000).unwrap_err().found.starts_with("a compressed block of 2 bytes for 754"));
        assert!(skip(u64::MAX).unwrap_err().found.starts_with("content that expands to"));
    }
}
