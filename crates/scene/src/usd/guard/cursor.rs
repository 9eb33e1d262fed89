//! A place in a binary layer from which numbers are read.
use crate::gltf::fault::Fault;

/// Where numbers are read next, and what they are a part of.
#[derive(Clone, Copy)]
pub struct Cursor<'a> {
    bytes: &'a [u8],
    at: u64,
    place: &'a str,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8], at: u64, place: &'a str) -> Self {
        Self { bytes, at, place }
    }

    pub fn place(&self) -> &'a str {
        self.place
    }

    /// How many bytes the file has from here on.
    pub fn left(&self) -> u64 {
        (self.bytes.len() as u64).saturating_sub(self.at)
    }

    pub fn fault(&self, found: impl AsRef<str>, expected: impl Into<String>) -> Fault {
        Fault::new(self.place, found, expected)
    }

    pub fn bytes(&mut self, count: u64) -> Result<&'a [u8], Fault> {
        let end = self.at.checked_add(count).filter(|&end| end <= self.bytes.len() as u64);
        let bytes = end.and_then(|end| self.bytes.get(self.at as usize..end as usize));
        let bytes = bytes.ok_or_else(|| {
            let found = format!("{count} bytes from byte {} on", self.at);
            self.fault(found, format!("bytes within the {} of the file", self.bytes.len()))
        })?;
        self.at += count;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut array = [0; N];
        array.copy_from_slice(self.bytes(N as u64)?);
        Ok(array)
    }

    pub fn byte(&mut self) -> Result<u8, Fault> {
        self.array().map(|[byte]| byte)
    }

    pub fn u32(&mut self) -> Result<u32, Fault> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Result<u64, Fault> {
        self.array().map(u64::from_le_bytes)
    }

    /// A count of elements that take at least so many bytes each from here on.
    pub fn count(&mut self, bytes_each: u64) -> Result<u64, Fault> {
        let count = self.u64()?;
        self.check_count(count, bytes_each)?;
        Ok(count)
    }

    pub fn check_count(&self, count: u64, bytes_each: u64) -> Result<(), Fault> {
        let left = self.left();
        if count.checked_mul(bytes_each).is_some_and(|bytes| bytes <= left) {
            return Ok(());
        }
        let expected = format!("at most {}: the file has {left} bytes more", left / bytes_each.max(1));
        Err(self.fault(format!("{count} elements of {bytes_each} bytes or more"), expected))
    }

    /// Goes where an offset from the place of the offset says.
    pub fn jump(&mut self) -> Result<(), Fault> {
        let start = self.at;
        let offset = self.u64()?.cast_signed();
        let target = start.checked_add_signed(offset).filter(|&target| target <= self.bytes.len() as u64);
        self.at = target
            .ok_or_else(|| self.fault(format!("an offset of {offset} from byte {start}"), "one within the file"))?;
        Ok(())
    }
}
