//! How a file is made.

use std::str::FromStr;

use crate::{Error, Result};

/// The level at which DWA's quantization is hardly seen, which OpenEXR takes where none is given.
const DEFAULT_DWA_LEVEL: f32 = 45.0;

/// How an EXR file is made of a film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExrOptions {
    /// How pixels are compressed; in a file of several parts and with a lossy method the colour's alone, and all else
    /// by ZIP.
    pub compression: Compression,
    /// A part for each layer, so that a reader need not decode what it does not want, instead of one part with all
    /// channels.
    pub multipart: bool,
}

/// How EXR files compress pixels. All but DWAA keep every bit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Compression {
    /// zlib, 16 rows a block: good for whole frames.
    #[default]
    Zip,
    /// zlib, one row a block: what compositors read fastest row by row.
    Zips,
    /// Wavelets and Huffman's code, 32 rows a block: best for grainy images.
    Piz,
    /// Run lengths, one row a block.
    Rle,
    /// None, one row a block.
    None,
    /// Lossy cosine transform of `R G B`, 32 rows a block; the level is the quantization error in hundred-thousandths.
    Dwaa(f32),
}

impl Compression {
    /// The names that [`Compression::from_str`] knows.
    pub const NAMES: &str = "zip, zips, piz, rle, none, dwaa or dwaa:LEVEL";

    /// What data takes beside a colour that is compressed so.
    pub(crate) fn lossless(self) -> Self {
        match self {
            Compression::Dwaa(_) => Compression::Zip,
            lossless => lossless,
        }
    }

    pub(crate) fn to_exr(self) -> exr::compression::Compression {
        match self {
            Compression::Zip => exr::compression::Compression::ZIP16,
            Compression::Zips => exr::compression::Compression::ZIP1,
            Compression::Piz => exr::compression::Compression::PIZ,
            Compression::Rle => exr::compression::Compression::RLE,
            Compression::None => exr::compression::Compression::Uncompressed,
            Compression::Dwaa(level) => exr::compression::Compression::DWAA(Some(level)),
        }
    }
}

impl FromStr for Compression {
    type Err = String;

    /// `zip`, `dwaa`, `dwaa:100` .. in any case.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let name = text.to_lowercase();
        match name.as_str() {
            "zip" => return Ok(Compression::Zip),
            "zips" => return Ok(Compression::Zips),
            "piz" => return Ok(Compression::Piz),
            "rle" => return Ok(Compression::Rle),
            "none" => return Ok(Compression::None),
            "dwaa" => return Ok(Compression::Dwaa(DEFAULT_DWA_LEVEL)),
            _ => {}
        }
        let level = name.strip_prefix("dwaa:").and_then(|level| level.parse().ok()).filter(|&level| is_level(level));
        level.map(Compression::Dwaa).ok_or_else(|| format!("found {text}, expected {}", Self::NAMES))
    }
}

/// Level 0 quantizes nothing but what half floats round.
fn is_level(level: f32) -> bool {
    level.is_finite() && level >= 0.0
}

impl ExrOptions {
    pub(crate) fn check(&self) -> Result<()> {
        match self.compression {
            Compression::Dwaa(level) if !is_level(level) => Err(Error::DwaLevel { level }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_in_any_case_and_others_refused() {
        for (text, expected) in [
            ("ZIP", Compression::Zip),
            ("zips", Compression::Zips),
            ("Piz", Compression::Piz),
            ("rle", Compression::Rle),
            ("none", Compression::None),
            ("dwaa", Compression::Dwaa(45.0)),
            ("DWAA:100.5", Compression::Dwaa(100.5)),
        ] {
            assert_eq!(text.parse(), Ok(expected));
        }
        for text in ["", "dwab", "dwaa:", "dwaa:-1", "dwaa:inf", "dwaa:nan", "zip:3"] {
            let expected = format!("found {text}, expected zip, zips, piz, rle, none, dwaa or dwaa:LEVEL");
            assert_eq!(text.parse::<Compression>(), Err(expected));
        }
    }
}
