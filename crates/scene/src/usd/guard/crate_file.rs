//! What a binary layer claims, checked over its bytes: header, table of contents, and tables of tokens, strings, fields, paths
//! and specs. Everything that the reader would allocate is taken from a budget first.
use super::blocks;
use super::budget::Budget;
use super::cursor::Cursor;
use super::expressions::Expressions;
use super::paths;
use super::values::Values;
use crate::gltf::fault::Fault;

/// What a binary layer begins with.
pub const MAGIC: &[u8] = b"PXR-USDC";
/// The header: this, version and padding, place of the table of contents.
const VERSION_PLACE: u64 = 8;
const CONTENTS_PLACE: u64 = 16;
/// Minor versions that are read: before 0.4 tables are not compressed.
const VERSIONS: std::ops::RangeInclusive<u8> = 4..=12;
/// More sections than any version has.
const MAX_SECTIONS: u64 = 63;
const NAME_BYTES: u64 = 16;
/// What a string, a field and a spec take in memory beside their content.
pub const STRING_BYTES: u64 = 32;
const FIELD_BYTES: u64 = 24;
const SPEC_BYTES: u64 = 160;
/// Fields that one prim or property may have: they are searched one by one.
const MAX_FIELDS: usize = 1024;

/// Where a table is.
#[derive(Clone, Copy)]
struct Section {
    start: u64,
}

struct File<'a> {
    bytes: &'a [u8],
    sections: Vec<(&'a [u8], Section)>,
    budget: &'a mut Budget,
}

/// Refuses a binary layer that claims more than it holds.
pub fn check(bytes: &[u8], budget: &mut Budget) -> Result<(), Fault> {
    let version = version(bytes)?;
    let sections = sections(bytes)?;
    let mut file = File { bytes, sections, budget };
    let tokens = file.tokens()?;
    let strings = file.strings(tokens.len())?;
    let (names, values) = file.fields()?;
    file.field_sets()?;
    let paths = match file.section("PATHS") {
        Some(cursor) => paths::check(cursor, &tokens, file.budget)?,
        None => Vec::new(),
    };
    file.specs(&paths)?;
    let lengths: Vec<u64> = tokens.iter().map(|token| token.len() as u64).collect();
    let mut values_of =
        Values { bytes, version, tokens: &lengths, strings: &strings, paths: &paths, budget: file.budget };
    for (index, &value) in values.iter().enumerate() {
        let name = names.get(index).and_then(|&name| tokens.get(name as usize));
        let name = name.map_or_else(|| "no name".into(), |name| String::from_utf8_lossy(name));
        values_of.check(value, &format!("field {index} ({name})"))?;
    }
    Ok(())
}

fn version(bytes: &[u8]) -> Result<u8, Fault> {
    let mut header = Cursor::new(bytes, VERSION_PLACE, "header");
    let (major, minor) = (header.byte()?, header.byte()?);
    if major == 0 && VERSIONS.contains(&minor) {
        return Ok(minor);
    }
    let expected = format!("0.{} to 0.{}", VERSIONS.start(), VERSIONS.end());
    Err(header.fault(format!("version {major}.{minor}"), expected))
}

fn sections(bytes: &[u8]) -> Result<Vec<(&[u8], Section)>, Fault> {
    let contents = Cursor::new(bytes, CONTENTS_PLACE, "header").u64()?;
    let mut cursor = Cursor::new(bytes, contents, "table of contents");
    let count = cursor.u64()?;
    if !(1..=MAX_SECTIONS).contains(&count) {
        return Err(cursor.fault(format!("{count} sections"), format!("1 to {MAX_SECTIONS}")));
    }
    let mut sections = Vec::new();
    for section in 0..count {
        let name = cursor.bytes(NAME_BYTES)?;
        let name = name.split(|&byte| byte == 0).next().unwrap_or_default();
        let (start, length) = (cursor.u64()?, cursor.u64()?);
        if start.checked_add(length).is_none_or(|end| end > bytes.len() as u64) {
            let found = format!("section {section} of {length} bytes from {start} on");
            return Err(cursor.fault(found, format!("one within the {} bytes of the file", bytes.len())));
        }
        sections.push((name, Section { start }));
    }
    Ok(sections)
}

impl<'a> File<'a> {
    /// The first section of a name, as the reader finds it.
    fn section(&self, name: &'static str) -> Option<Cursor<'a>> {
        let found = self.sections.iter().find(|(found, _)| *found == name.as_bytes());
        found.map(|(_, section)| Cursor::new(self.bytes, section.start, name))
    }

    fn tokens(&mut self) -> Result<Vec<Box<[u8]>>, Fault> {
        let Some(mut cursor) = self.section("TOKENS") else { return Ok(Vec::new()) };
        let (count, size) = (cursor.u64()?, cursor.u64()?);
        // Every token ends in a zero byte.
        if count > size {
            return Err(cursor.fault(format!("{count} tokens in {size} bytes"), "one byte or more for each"));
        }
        // Twice, and as many strings: they are copied out of what was expanded.
        self.budget.charge(cursor.place(), size.saturating_add(count.saturating_mul(STRING_BYTES)))?;
        let expanded = blocks::expand(&mut cursor, size, size, self.budget)?;
        let Some(content) = expanded.strip_suffix(&[0]) else {
            return if expanded.is_empty() && count == 0 {
                Ok(Vec::new())
            } else {
                Err(cursor.fault("tokens without an end", "a zero byte after each"))
            };
        };
        let tokens: Vec<Box<[u8]>> = content.split(|&byte| byte == 0).map(Box::from).collect();
        if tokens.len() as u64 != count || expanded.len() as u64 != size {
            let found = format!("{} tokens of {} bytes", tokens.len(), expanded.len());
            return Err(cursor.fault(found, format!("{count} of {size} bytes, as it says")));
        }
        let mut expressions = Expressions::default();
        tokens.iter().try_for_each(|token| expressions.check(token, cursor.place()))?;
        Ok(tokens)
    }

    /// The token of every string.
    fn strings(&mut self, tokens: usize) -> Result<Vec<u32>, Fault> {
        let Some(mut cursor) = self.section("STRINGS") else { return Ok(Vec::new()) };
        let count = cursor.count(4)?;
        self.budget.charge(cursor.place(), 16 * count)?;
        let mut strings = Vec::with_capacity(count as usize);
        for string in 0..count {
            let token = cursor.u32()?;
            if token as usize >= tokens {
                return Err(
                    cursor.fault(format!("string {string} of token {token}"), format!("one of {tokens} tokens"))
                );
            }
            strings.push(token);
        }
        Ok(strings)
    }

    /// Names and values of all fields.
    fn fields(&mut self) -> Result<(Vec<u32>, Vec<u64>), Fault> {
        let Some(mut cursor) = self.section("FIELDS") else { return Ok(Default::default()) };
        let count = cursor.u64()?;
        let names = blocks::integers(&mut cursor, count, self.budget)?;
        self.budget.charge(cursor.place(), count.saturating_mul(FIELD_BYTES))?;
        let values = blocks::expand(&mut cursor, count.saturating_mul(8), 0, self.budget)?;
        let (values, _) = values.as_chunks();
        Ok((names, values.iter().copied().map(u64::from_le_bytes).collect()))
    }

    /// Lists of fields: each ends in a marker.
    fn field_sets(&mut self) -> Result<(), Fault> {
        let Some(mut cursor) = self.section("FIELDSETS") else { return Ok(()) };
        let count = cursor.u64()?;
        self.budget.charge(cursor.place(), count.saturating_mul(16))?;
        let fields = blocks::integers(&mut cursor, count, self.budget)?;
        let longest = fields.split(|&field| field == u32::MAX).map(<[u32]>::len).max().unwrap_or_default();
        if longest > MAX_FIELDS {
            return Err(cursor.fault(format!("a set of {longest} fields"), format!("at most {MAX_FIELDS}")));
        }
        Ok(())
    }

    fn specs(&mut self, paths: &[u64]) -> Result<(), Fault> {
        let Some(mut cursor) = self.section("SPECS") else { return Ok(()) };
        let count = cursor.u64()?;
        self.budget.charge(cursor.place(), count.saturating_mul(SPEC_BYTES))?;
        for path in blocks::integers(&mut cursor, count, self.budget)? {
            let Some(length) = paths.get(path as usize) else {
                return Err(cursor.fault(format!("path {path}"), format!("one of {} paths", paths.len())));
            };
            self.budget.charge(cursor.place(), *length)?;
        }
        blocks::integers(&mut cursor, count, self.budget)?;
        blocks::integers(&mut cursor, count, self.budget).map(|_| ())
    }
}
