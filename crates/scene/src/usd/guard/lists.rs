//! Values of a binary layer that hold others: lists, list operations, dictionaries and time samples.
use super::cursor::Cursor;
use super::kinds::Item;
use super::text;
use super::values::{VALUE_BYTES, Values};
use crate::gltf::fault::Fault;

/// Lists of a list operation, by the bit that says that it is there, in the order in which they are stored: explicit, added,
/// prepended, appended, deleted, ordered.
const LISTS: [u8; 6] = [1 << 1, 1 << 2, 1 << 5, 1 << 6, 1 << 3, 1 << 4];
/// What a reference and an entry of a map take in memory beside their content.
const REFERENCE_BYTES: u64 = 128;
/// Bytes of a layer's offset and scale.
const OFFSET_BYTES: u64 = 16;
/// Bytes of an entry of a dictionary: key, offset of the value, value.
const ENTRY_BYTES: u64 = 20;

impl Values<'_> {
    /// A list before which its length stands.
    pub fn items(&mut self, cursor: &mut Cursor, item: Item, depth: usize) -> Result<u64, Fault> {
        let count = cursor.count(self.least_bytes(item))?;
        if let Item::Number(size) = item {
            cursor.bytes(count * size)?;
            self.budget.charge(cursor.place(), count * size)?;
            return Ok(count);
        }
        if item == Item::Relocation {
            text::check_relocates(count, cursor.place())?;
        }
        for _ in 0..count {
            self.item(cursor, item, depth)?;
        }
        Ok(count)
    }

    fn least_bytes(&self, item: Item) -> u64 {
        match item {
            Item::Token | Item::String | Item::Path => 4,
            Item::Selection | Item::Relocation => 8,
            Item::Number(size) => size,
            Item::Reference => 8 + OFFSET_BYTES + 8,
            Item::Payload => 8 + self.payload_offset(),
        }
    }

    /// Payloads have offsets since version 0.8.
    fn payload_offset(&self) -> u64 {
        if self.version >= 8 { OFFSET_BYTES } else { 0 }
    }

    pub fn item(&mut self, cursor: &mut Cursor, item: Item, depth: usize) -> Result<(), Fault> {
        match item {
            Item::Number(size) => cursor.bytes(size).map(|_| ()),
            Item::Token => {
                let index = cursor.u32()?;
                self.token(cursor, index.into())
            }
            Item::String => self.next_string(cursor),
            Item::Path => self.next_path(cursor),
            Item::Selection => {
                self.budget.charge(cursor.place(), REFERENCE_BYTES)?;
                self.next_string(cursor)?;
                self.next_string(cursor)
            }
            Item::Relocation => {
                self.next_path(cursor)?;
                self.next_path(cursor)
            }
            Item::Reference | Item::Payload => {
                self.budget.charge(cursor.place(), REFERENCE_BYTES)?;
                self.next_string(cursor)?;
                self.next_path(cursor)?;
                if item == Item::Payload {
                    return cursor.bytes(self.payload_offset()).map(|_| ());
                }
                cursor.bytes(OFFSET_BYTES)?;
                self.dictionary(cursor, depth)
            }
        }
    }

    fn next_string(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        let index = cursor.u32()?;
        self.string(cursor, index.into())
    }

    fn next_path(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        let index = cursor.u32()?;
        self.path(cursor, index.into())
    }

    pub fn list_op(&mut self, cursor: &mut Cursor, item: Item, depth: usize) -> Result<(), Fault> {
        let lists = cursor.byte()?;
        let mut items: u64 = 0;
        for list in LISTS {
            if lists & list != 0 {
                items = items.saturating_add(self.items(cursor, item, depth)?);
            }
        }
        // Lists are merged by comparing all with all.
        self.budget.charge_pairs(cursor.place(), items)
    }

    pub fn dictionary(&mut self, cursor: &mut Cursor, depth: usize) -> Result<(), Fault> {
        let count = cursor.count(ENTRY_BYTES)?;
        for _ in 0..count {
            self.budget.charge(cursor.place(), VALUE_BYTES)?;
            self.next_string(cursor)?;
            cursor.jump()?;
            let value = cursor.u64()?;
            self.value(value, cursor.place(), depth + 1)?;
        }
        Ok(())
    }

    pub fn time_samples(&mut self, cursor: &mut Cursor, depth: usize) -> Result<(), Fault> {
        cursor.jump()?;
        let times = cursor.u64()?;
        self.value(times, cursor.place(), depth + 1)?;
        cursor.jump()?;
        let count = cursor.count(8)?;
        for _ in 0..count {
            let value = cursor.u64()?;
            self.value(value, cursor.place(), depth + 1)?;
        }
        Ok(())
    }
}
