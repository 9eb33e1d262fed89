//! What is checked before `openusd` reads a file, and what becomes of its panics: it trusts counts and recurses as deep as a text
//! nests, and neither memory that is not there nor a stack that is full can be caught.
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use crate::gltf::fault::Fault;

/// Deepest nesting of brackets in a text.
const MAX_NESTING: usize = 400;
/// What a binary file begins with, and its header: version and padding, place of the table of contents.
const MAGIC: &[u8] = b"PXR-USDC";
const CONTENTS_PLACE: usize = 16;
/// A section in the table of contents: name, start, size.
const NAME_BYTES: usize = 16;
const SECTION_BYTES: usize = NAME_BYTES + 16;
/// More sections than any version has.
const MAX_SECTIONS: u64 = 64;
/// Elements that a byte of a section may stand for: integers are compressed well.
const ELEMENTS_A_BYTE: u64 = 64;

/// Refuses a file that nests too deep, or claims more than it can hold.
pub fn check(bytes: &[u8]) -> Result<(), Fault> {
    if bytes.starts_with(MAGIC) {
        return check_sections(bytes);
    }
    if bytes.starts_with(b"#") { check_nesting(bytes) } else { Ok(()) }
}

/// Brackets of a text, those in strings and comments apart.
fn check_nesting(text: &[u8]) -> Result<(), Fault> {
    let (mut depth, mut line, mut quote, mut is_comment) = (0_usize, 1, None, false);
    let mut at = 0;
    while let Some(&byte) = text.get(at) {
        at += 1;
        match (byte, quote) {
            (b'\n', _) => {
                line += 1;
                is_comment = false;
            }
            (b'\\', Some(_)) => at += 1,
            (_, Some(open)) if byte == open => quote = None,
            (_, Some(_)) => {}
            _ if is_comment => {}
            (b'#', None) => is_comment = true,
            (b'"' | b'\'', None) => quote = Some(byte),
            (b'{' | b'(' | b'[', None) => depth += 1,
            (b'}' | b')' | b']', None) => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > MAX_NESTING {
            let found = format!("brackets nested deeper than {MAX_NESTING}");
            return Err(Fault::new(format!("line {line}"), found, "fewer"));
        }
    }
    Ok(())
}

/// The table of contents of a binary file, and how many elements each section claims.
fn check_sections(bytes: &[u8]) -> Result<(), Fault> {
    let refuse = |found: String, expected: &str| Err(Fault::new("table of contents", found, expected));
    let size = bytes.len() as u64;
    let contents = word(bytes, CONTENTS_PLACE).unwrap_or(u64::MAX);
    let Some(count) = usize::try_from(contents).ok().and_then(|place| word(bytes, place)) else {
        return refuse(format!("a place of {contents}"), &format!("less than {size}, the file's size"));
    };
    if count > MAX_SECTIONS {
        return refuse(format!("{count} sections"), "64 at most");
    }
    for section in 0..count as usize {
        let place = contents as usize + 8 + section * SECTION_BYTES + NAME_BYTES;
        let (Some(start), Some(length)) = (word(bytes, place), word(bytes, place + 8)) else {
            return refuse(format!("{count} sections"), "as many as the file has bytes for");
        };
        if start.checked_add(length).is_none_or(|end| end > size) {
            return refuse(format!("section {section} of {length} bytes from {start} on"), "one within the file");
        }
        let claimed = word(bytes, start as usize).filter(|_| length >= 8).unwrap_or_default();
        if claimed > ELEMENTS_A_BYTE * size {
            return refuse(format!("{claimed} elements in section {section}"), "fewer in a file of this size");
        }
    }
    Ok(())
}

fn word(bytes: &[u8], place: usize) -> Option<u64> {
    let bytes = bytes.get(place..place.checked_add(8)?)?;
    Some(u64::from_le_bytes(bytes.try_into().ok()?))
}

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs what may panic on malformed files; none if it did. Nothing is printed then: other threads' panics are told as ever.
pub fn silent<T>(read: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                before(panic);
            }
        }));
    });
    let outer = IS_GUARDED.replace(true);
    // Nothing of what was being read outlives this call.
    let result = catch_unwind(AssertUnwindSafe(read)).ok();
    IS_GUARDED.set(outer);
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nesting_is_counted_outside_of_strings_and_comments() {
        let open = |count: usize| format!("#usda 1.0\n{}", "def \"a\" {\n".repeat(count)).into_bytes();
        assert!(check(&open(400)).is_ok());
        let fault = check(&open(100_000)).unwrap_err();
        assert_eq!((fault.place.as_str(), fault.found.as_str()), ("line 402", "brackets nested deeper than 400"));
        let text =
            format!("#usda 1.0\n# {}\nstring a = \"{}\\\"{}\"\n", "[".repeat(500), "{".repeat(500), "(".repeat(500));
        assert!(check(text.as_bytes()).is_ok());
    }

    /// A binary file of one section that claims so many elements.
    fn binary(start: u64, claimed: u64) -> Vec<u8> {
        let mut bytes = [MAGIC, &[0; 8]].concat();
        bytes.extend(32_u64.to_le_bytes());
        bytes.extend(claimed.to_le_bytes());
        bytes.extend(1_u64.to_le_bytes());
        bytes.extend([0; NAME_BYTES]);
        bytes.extend(start.to_le_bytes());
        bytes.extend(8_u64.to_le_bytes());
        bytes
    }

    #[test]
    fn sections_lie_in_the_file_and_claim_no_more_than_it_could_hold() {
        assert!(check(&binary(24, 3)).is_ok());
        assert!(check(&binary(24, 1 << 40)).unwrap_err().found.starts_with("1099511627776 elements"));
        assert!(check(&binary(u64::MAX, 3)).unwrap_err().found.starts_with("section 0 of 8 bytes"));
        let whole = binary(24, 3);
        assert!((8..whole.len()).all(|length| check(&whole[..length]).is_err()));
    }

    #[test]
    fn a_panic_is_caught_and_the_next_call_runs() {
        assert_eq!(silent(|| -> u32 { panic!("malformed") }), None);
        assert_eq!(silent(|| 3), Some(3));
    }
}
