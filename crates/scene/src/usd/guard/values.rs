//! Values of a binary layer: whatever a field names is walked as the reader would.
use super::blocks;
use super::budget::Budget;
use super::crate_file::STRING_BYTES;
use super::cursor::Cursor;
use super::kinds::{self, Kind, Packing};
use crate::gltf::fault::Fault;

/// How deep dictionaries and time samples may stand in each other.
const MAX_DEPTH: usize = 64;
/// What a value takes in memory beside its content, and an entry of a map.
pub const VALUE_BYTES: u64 = 160;
/// Arrays of fewer elements are never compressed.
const LEAST_COMPRESSED: u64 = 4;
/// Bits of a value beside its type and where it is.
const IS_ARRAY: u64 = 1 << 63;
const IS_INLINED: u64 = 1 << 62;
const IS_COMPRESSED: u64 = 1 << 61;
const PAYLOAD: u64 = (1 << 48) - 1;

/// What values refer to.
pub struct Values<'a> {
    pub bytes: &'a [u8],
    /// The minor one.
    pub version: u8,
    /// Lengths of tokens.
    pub tokens: &'a [u64],
    /// The token of every string.
    pub strings: &'a [u32],
    /// Lengths of paths.
    pub paths: &'a [u64],
    pub budget: &'a mut Budget,
}

impl Values<'_> {
    /// Checks the value of a field.
    pub fn check(&mut self, value: u64, place: &str) -> Result<(), Fault> {
        self.value(value, place, 0)
    }

    pub fn value(&mut self, value: u64, place: &str, depth: usize) -> Result<(), Fault> {
        if depth > MAX_DEPTH {
            let found = format!("values nested deeper than {MAX_DEPTH}");
            return Err(Fault::new(place, found, "fewer, and none in itself"));
        }
        self.budget.charge(place, VALUE_BYTES)?;
        let (is_array, is_inlined) = (value & IS_ARRAY != 0, value & IS_INLINED != 0);
        let mut cursor = Cursor::new(self.bytes, value & PAYLOAD, place);
        match kinds::kind((value >> 48) as u8) {
            Kind::Fixed(size, packing) if is_array => self.array(cursor, value, size, packing),
            Kind::Fixed(size, _) if !is_inlined => cursor.bytes(size).map(|_| ()),
            Kind::Token if is_array => {
                if let Some((count, _)) = self.array_count(&mut cursor, value, Packing::None)? {
                    self.indices(&mut cursor, count, Self::token)?;
                }
                Ok(())
            }
            Kind::Token => {
                let index = if is_inlined { value & u64::from(u32::MAX) } else { cursor.u64()? };
                self.token(&cursor, index)
            }
            // An empty one has no place; who reads it is told so.
            Kind::String | Kind::Asset if is_array && value & PAYLOAD == 0 => Ok(()),
            Kind::String | Kind::Asset if is_array => self.counted(&mut cursor, Self::string),
            Kind::Asset if is_inlined => self.token(&cursor, value & u64::from(u32::MAX)),
            Kind::String if is_inlined => self.string(&cursor, value & u64::from(u32::MAX)),
            Kind::String | Kind::Asset => {
                let index = cursor.u32()?;
                self.string(&cursor, index.into())
            }
            Kind::Dictionary if is_inlined => Ok(()),
            Kind::Dictionary => self.dictionary(&mut cursor, depth),
            Kind::TimeSamples if !is_inlined => self.time_samples(&mut cursor, depth),
            Kind::Doubles if !is_inlined => self.array(cursor, value, 8, Packing::Floats),
            // The crate looks at no bit of these.
            Kind::ListOp(kinds::Item::Payload) => self.list_op(&mut cursor, kinds::Item::Payload, depth),
            Kind::ListOp(item) if !is_inlined => self.list_op(&mut cursor, item, depth),
            Kind::List(item) if !is_inlined => self.items(&mut cursor, item, depth).map(|_| ()),
            Kind::Payload if !is_inlined => self.item(&mut cursor, kinds::Item::Payload, depth),
            // Inlined, or refused by the crate.
            _ => Ok(()),
        }
    }

    /// How many elements an array has, and whether they are compressed; none if it is empty.
    fn array_count(&self, cursor: &mut Cursor, value: u64, packing: Packing) -> Result<Option<(u64, bool)>, Fault> {
        if value & PAYLOAD == 0 {
            return Ok(None);
        }
        if self.version < 5 {
            // Its shape.
            cursor.u32()?;
        }
        let count = if self.version < 7 { cursor.u32()?.into() } else { cursor.u64()? };
        let since = match packing {
            Packing::None => u8::MAX,
            Packing::Integers => 5,
            Packing::Floats => 6,
        };
        let is_compressed = value & IS_COMPRESSED != 0 && self.version >= since && count >= LEAST_COMPRESSED;
        Ok(Some((count, is_compressed)))
    }

    fn array(&mut self, mut cursor: Cursor, value: u64, size: u64, packing: Packing) -> Result<(), Fault> {
        let Some((count, is_compressed)) = self.array_count(&mut cursor, value, packing)? else { return Ok(()) };
        if !is_compressed {
            cursor.check_count(count, size)?;
            // Twice: it is read, and turned into what is asked for.
            return self.budget.charge(cursor.place(), (count * size).saturating_mul(2));
        }
        if packing == Packing::Floats {
            match cursor.byte()? {
                // Whole numbers.
                b'i' => {}
                // A table of numbers, and which.
                b't' => {
                    let entries = u64::from(cursor.u32()?);
                    cursor.check_count(entries, size)?;
                    cursor.bytes(entries * size)?;
                    self.budget.charge(cursor.place(), entries * size)?;
                }
                code => return Err(cursor.fault(format!("numbers packed by {:?}", char::from(code)), "'i' or 't'")),
            }
        }
        blocks::skip_integers(&mut cursor, count, size, self.budget)
    }

    /// Numbers of 32 bits that name something.
    fn indices(
        &mut self,
        cursor: &mut Cursor,
        count: u64,
        check: fn(&mut Self, &Cursor, u64) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        cursor.check_count(count, 4)?;
        for _ in 0..count {
            let index = cursor.u32()?;
            check(self, cursor, index.into())?;
        }
        Ok(())
    }

    /// As many of them as a count before them says.
    fn counted(
        &mut self,
        cursor: &mut Cursor,
        check: fn(&mut Self, &Cursor, u64) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let count = cursor.u64()?;
        self.indices(cursor, count, check)
    }

    pub fn token(&mut self, cursor: &Cursor, index: u64) -> Result<(), Fault> {
        let length = self.tokens.get(usize::try_from(index).unwrap_or(usize::MAX));
        let Some(length) = length else {
            return Err(cursor.fault(format!("token {index}"), format!("one of {} tokens", self.tokens.len())));
        };
        self.budget.charge(cursor.place(), STRING_BYTES + length)
    }

    pub fn string(&mut self, cursor: &Cursor, index: u64) -> Result<(), Fault> {
        let token = self.strings.get(usize::try_from(index).unwrap_or(usize::MAX));
        let Some(&token) = token else {
            return Err(cursor.fault(format!("string {index}"), format!("one of {} strings", self.strings.len())));
        };
        self.token(cursor, token.into())
    }

    pub fn path(&mut self, cursor: &Cursor, index: u64) -> Result<(), Fault> {
        let length = self.paths.get(usize::try_from(index).unwrap_or(usize::MAX));
        let Some(length) = length else {
            return Err(cursor.fault(format!("path {index}"), format!("one of {} paths", self.paths.len())));
        };
        self.budget.charge(cursor.place(), STRING_BYTES + length)
    }
}
