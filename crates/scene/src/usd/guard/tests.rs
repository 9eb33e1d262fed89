//! Binary layers made by hand, each with one lie.
use super::budget::Budget;
use super::check;

/// Bytes of a binary layer, and where its sections are.
struct Made {
    bytes: Vec<u8>,
    sections: Vec<(&'static str, usize)>,
}

/// Literals of LZ4 in one piece, as a block.
fn block(content: &[u8]) -> Vec<u8> {
    let packed = lz4_flex::compress(content);
    [&(packed.len() as u64 + 1).to_le_bytes()[..], &[0], &packed].concat()
}

/// Integers coded as differences of 32 bits.
fn integers(values: &[i32]) -> Vec<u8> {
    let mut coded = vec![0; 4];
    coded.extend(vec![0xFF; values.len().div_ceil(4)]);
    let mut last = 0;
    for value in values {
        coded.extend((value - last).to_le_bytes());
        last = *value;
    }
    block(&coded)
}

fn counted(count: u64, blocks: &[Vec<u8>]) -> Vec<u8> {
    [count.to_le_bytes().to_vec(), blocks.concat()].concat()
}

impl Made {
    /// A layer of these values, which stand from byte 32 on.
    fn of(values: &[u8]) -> Self {
        let bytes = [b"PXR-USDC\0\x09\0\0\0\0\0\0", &[0; 16][..], values].concat();
        Self { bytes, sections: Vec::new() }
    }

    fn with(mut self, name: &'static str, content: &[u8]) -> Self {
        self.sections.push((name, self.bytes.len()));
        self.bytes.extend(content);
        self
    }

    fn tokens(self) -> Self {
        let content = [2_u64.to_le_bytes(), 4_u64.to_le_bytes()].concat();
        let content = [content, block(b"a\0b\0")].concat();
        self.with("TOKENS", &content).with("STRINGS", &[1_u64.to_le_bytes().to_vec(), vec![0; 4]].concat())
    }

    /// One field of a value.
    fn field(self, value: u64) -> Self {
        let content = counted(1, &[integers(&[0]), block(&value.to_le_bytes())]);
        self.with("FIELDS", &content)
    }

    /// Paths of entries: path, token, jump.
    fn paths(self, entries: &[[i32; 3]]) -> Self {
        let column = |c: usize| integers(&entries.iter().map(|entry| entry[c]).collect::<Vec<_>>());
        let count = entries.len() as u64;
        let content = counted(count, &[count.to_le_bytes().to_vec(), column(0), column(1), column(2)]);
        self.with("PATHS", &content)
    }

    /// What is wrong; empty if nothing is.
    fn fault(mut self) -> String {
        let contents = self.bytes.len() as u64;
        self.bytes[16..24].copy_from_slice(&contents.to_le_bytes());
        self.bytes.extend((self.sections.len() as u64).to_le_bytes());
        for (name, start) in &self.sections {
            let mut padded = [0; 16];
            padded[..name.len()].copy_from_slice(name.as_bytes());
            self.bytes.extend(padded);
            self.bytes.extend((*start as u64).to_le_bytes());
            self.bytes.extend(8_u64.to_le_bytes());
        }
        let fault = check(&self.bytes, &mut Budget::new()).err();
        fault.map_or_else(String::new, |fault| format!("{}: {}", fault.place, fault.found))
    }
}

fn assert_fault(made: Made, expected: &str) {
    let fault = made.fault();
    assert!(if expected.is_empty() { fault.is_empty() } else { fault.contains(expected) }, "{fault}, not {expected}");
}

/// A value of a type at a place.
const fn value(kind: u64, bits: u64, place: u64) -> u64 {
    kind << 48 | bits << 61 | place
}

const ARRAY: u64 = 4;
const COMPRESSED_ARRAY: u64 = 5;

#[test]
fn sections_claim_no_more_than_they_hold() {
    assert_fault(Made::of(&[]).tokens().field(value(3, 2, 7)).paths(&[[0, 0, -2]]), "");
    let huge = (1_u64 << 40).to_le_bytes();
    for name in ["TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS"] {
        let content = [&huge[..], &huge, &block(&[0; 100])].concat();
        assert_fault(Made::of(&[]).with(name, &content), name);
    }
    let old = |minor: u8| {
        let mut made = Made::of(&[]).tokens();
        made.bytes[9] = minor;
        made
    };
    assert_fault(old(3), "header: version 0.3");
    assert_fault(old(13), "header: version 0.13");
    assert_fault(Made::of(&[]).with("TOKENS", &[[1; 8], [255; 8]].concat()), "TOKENS");
    assert_fault(Made::of(&[]), "table of contents: 0 sections");
}

#[test]
fn paths_are_a_tree() {
    let made = || Made::of(&[]).tokens();
    // A root with two children, of which the first has a child.
    let tree = [[0, 0, -1], [1, 0, 2], [2, 1, -2], [3, 1, -2]];
    assert_fault(made().paths(&tree), "");
    let with = |at: usize, column: usize, value: i32| {
        let mut tree = tree;
        tree[at][column] = value;
        made().paths(&tree)
    };
    assert_fault(with(1, 2, 1), "PATHS: entry 2 in the tree twice");
    assert_fault(with(1, 2, i32::MAX), "PATHS: a jump to entry 2147483648");
    assert_fault(with(3, 2, 0), "PATHS: a jump to entry 4");
    assert_fault(with(3, 0, 4), "PATHS: entry 3 of path 4");
    assert_fault(with(2, 1, -2), "PATHS: token 2");
    let chain: Vec<[i32; 3]> = (0..500).map(|n| [n, 0, if n < 499 { -1 } else { -2 }]).collect();
    assert_fault(made().paths(&chain[..400]), "PATHS: a jump to entry 400");
    assert_fault(made().paths(&chain), "PATHS: a path of 401 names");
}

#[test]
fn arrays_lie_within_the_file() {
    let field =
        |count: u64, after: &[u8], value: u64| Made::of(&[&count.to_le_bytes(), after].concat()).tokens().field(value);
    let points = value(24, ARRAY, 32);
    assert_fault(field(2, &[0; 24], points), "");
    assert_fault(field(1 << 40, &[0; 24], points), "field 0 (a): 1099511627776 elements of 12 bytes");
    assert_fault(field(1 << 40, &[0; 24], value(11, ARRAY, 32)), "elements of 4 bytes");
    assert_fault(field(2, &[9; 24], value(11, ARRAY, 32)), "token 151587081");
    let integers = value(3, COMPRESSED_ARRAY, 32);
    assert_fault(field(8, &block(&[0; 6]), integers), "");
    assert_fault(field(1 << 20, &block(&[0; 6]), integers), "a compressed block of");
    assert_fault(field(1 << 40, &block(&[0; 6]), integers), "content that expands to");
    let floats = value(8, COMPRESSED_ARRAY, 32);
    assert_fault(field(8, &[b"i".to_vec(), block(&[0; 6])].concat(), floats), "");
    assert_fault(field(8, b"t\xFF\xFF\xFF\xFF", floats), "4294967295 elements of 4 bytes");
    assert_fault(field(8, b"x", floats), "numbers packed by 'x'");
    assert_fault(field(1, &[], value(27, 0, 1 << 40)), "32 bytes from byte 1099511627776");
}

#[test]
fn values_hold_others_but_not_themselves() {
    let word = |value: u64| value.to_le_bytes().to_vec();
    // A key, how far its value is from there, and the value.
    let dictionary = |value: u64| [word(1), vec![0; 4], word(8), word(value)].concat();
    let made = |content: &[u8], value: u64| Made::of(content).tokens().field(value);
    assert_fault(made(&dictionary(value(3, 2, 5)), value(31, 0, 32)), "");
    assert_fault(made(&dictionary(value(31, 0, 32)), value(31, 0, 32)), "values nested deeper than 64");
    assert_fault(made(&word(1 << 40), value(31, 0, 32)), "1099511627776 elements of 20 bytes");
    // As many entries as it likes, which are all the first.
    let back = [word(400), vec![0; 4], (-4_i64).to_le_bytes().to_vec(), vec![0; 9000]].concat();
    assert!(made(&back, value(31, 0, 32)).fault().contains("field 0 (a)"));
    // Time samples of which each is all of them.
    let times = value(48, 0, 0);
    let samples = [word(8), word(times), word(8), word(20), word(value(46, 0, 32)).repeat(20)].concat();
    assert_fault(made(&samples, value(46, 0, 32)), "values nested deeper than 64");
    for kind in (32..=41).chain([45, 49, 50, 54, 55, 58]) {
        let content = [vec![0xFF], vec![0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0], vec![0; 64]].concat();
        assert!(made(&content, value(kind, 0, 32)).fault().contains("elements of"), "{kind}");
    }
}

#[test]
fn text_that_is_compared_with_itself_is_bounded() {
    let check = |text: &str| check(text.as_bytes(), &mut Budget::new());
    let properties = |count: usize| format!("#usda 1.0\ndef \"a\" {{\n{}}}", "float a\n".repeat(count));
    assert!(check(&properties(10_000)).is_ok());
    assert!(check(&properties(100_000)).unwrap_err().found.starts_with("content that expands to"));
    // Paths as long as a whole file, many times.
    let long = format!("#usda 1.0\ndef \"{}\" {{\n{}}}", "a".repeat(100_000), "float a\n".repeat(10_000));
    assert!(check(&long).unwrap_err().found.starts_with("content that expands to"));
    assert!(check("#usda 1.0\ndef \"a\" { )").unwrap_err().found.contains("')'"));
    let expression = format!("#usda 1.0\n(subLayers = [@`{}`@])", "if(".repeat(500));
    assert!(check(&expression).unwrap_err().found.contains("500 brackets"));
}
