//! `t NAME nints/nfloats/nstrings ints.. floats.. strings..`: names and values, not yet what they mean.
use super::lines::{Tokens, integer, number, quoted};
use super::warnings::Warnings;
use crate::error::Fault;

/// What a tag says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TagKind {
    Crease,
    Corner,
    Hole,
    InterpolateBoundary,
    FaceVaryingInterpolateBoundary,
    CreaseMethod,
    SmoothTriangles,
    VertexEdit,
    EdgeEdit,
    FaceEdit,
    Density,
    ColorInterpolation,
}

impl TagKind {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"crease" => Self::Crease,
            b"corner" => Self::Corner,
            b"hole" => Self::Hole,
            b"interpolateboundary" => Self::InterpolateBoundary,
            b"facevaryinginterpolateboundary" => Self::FaceVaryingInterpolateBoundary,
            b"creasemethod" => Self::CreaseMethod,
            b"smoothtriangles" => Self::SmoothTriangles,
            b"vertexedit" => Self::VertexEdit,
            b"edgeedit" => Self::EdgeEdit,
            b"faceedit" => Self::FaceEdit,
            b"density" => Self::Density,
            b"colorinterpolation" => Self::ColorInterpolation,
            _ => return None,
        })
    }
}

/// A tag's values.
pub struct Tag {
    pub kind: TagKind,
    pub line: u32,
    pub ints: Vec<i64>,
    /// None of them is NaN.
    pub floats: Vec<f64>,
    pub strings: Vec<String>,
}

impl Tag {
    /// Reads what follows the `t`. None, with a warning, for a name that is not known.
    pub fn read(line: u32, mut tokens: Tokens, warnings: &mut Warnings) -> Result<Option<Self>, Fault> {
        let name = tokens.next().ok_or_else(|| Fault::at(line, "no tag name", "t NAME ints/floats/strings .."))?;
        if name == b"facevaryingpropagatecorners" {
            warnings.push(Some(line), "tag `facevaryingpropagatecorners` has no effect: ignored");
            return Ok(None);
        }
        let Some(kind) = TagKind::from_name(name) else {
            warnings.push(Some(line), format!("unknown tag {}: ignored", quoted(name)));
            return Ok(None);
        };
        let counts = tokens.next().unwrap_or_default();
        let [int_count, float_count, string_count] = split_counts(counts)
            .ok_or_else(|| Fault::at(line, format!("{} as a tag's counts", quoted(counts)), "counts like 2/1/0"))?;
        let mut values = Values { line, counts, tokens, read_count: 0 };
        // The vectors grow with what is there, whatever the counts claim.
        let mut tag = Self { kind, line, ints: vec![], floats: vec![], strings: vec![] };
        for _ in 0..int_count {
            let token = values.next()?;
            tag.ints.push(integer(token).ok_or_else(|| Fault::at(line, quoted(token), "an integer"))?);
        }
        for _ in 0..float_count {
            let token = values.next()?;
            let float = number(token).filter(|float| !float.is_nan());
            tag.floats.push(float.ok_or_else(|| Fault::at(line, quoted(token), "a number"))?);
        }
        for _ in 0..string_count {
            tag.strings.push(String::from_utf8_lossy(values.next()?).into_owned());
        }
        values.end()?;
        Ok(Some(tag))
    }
}

/// `nints/nfloats/nstrings`.
fn split_counts(token: &[u8]) -> Option<[u64; 3]> {
    let mut parts = token.split(|&byte| byte == b'/').map(|part| u64::try_from(integer(part)?).ok());
    let counts = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(counts)
}

/// The values of a tag, which must be as many as its counts say.
struct Values<'a> {
    line: u32,
    counts: &'a [u8],
    tokens: Tokens<'a>,
    read_count: usize,
}

impl<'a> Values<'a> {
    fn next(&mut self) -> Result<&'a [u8], Fault> {
        let token = self.tokens.next().ok_or_else(|| self.wrong_count(self.read_count))?;
        self.read_count += 1;
        Ok(token)
    }

    fn end(mut self) -> Result<(), Fault> {
        match self.tokens.by_ref().count() {
            0 => Ok(()),
            surplus => Err(self.wrong_count(self.read_count + surplus)),
        }
    }

    fn wrong_count(&self, found: usize) -> Fault {
        Fault::at(self.line, format!("a tag with {found} values"), format!("as many as {} says", quoted(self.counts)))
    }
}
