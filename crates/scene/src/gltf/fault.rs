//! What is wrong in one place of a file.
use crate::error::shown;

/// What is wrong in one place of a file: the element, what was found, what was expected.
#[derive(Debug, PartialEq)]
pub struct Fault {
    /// Line and column, or an element: `meshes[3].primitives[0]`; empty: the whole file.
    pub place: String,
    pub found: String,
    pub expected: String,
}

impl Fault {
    pub fn new(place: impl Into<String>, found: impl AsRef<str>, expected: impl Into<String>) -> Self {
        Self { place: place.into(), found: shown(found.as_ref()), expected: expected.into() }
    }

    /// An index into a list of the file that has no such element.
    pub fn index(place: impl Into<String>, list: &str, index: usize, count: usize) -> Self {
        let expected = match count {
            0 => format!("none: the file has no {list}"),
            _ => format!("0 to {}", count - 1),
        };
        Self::new(place, format!("{list} index {index}"), expected)
    }
}

/// The element of a list, or what is wrong with its index.
pub fn at<'a, T>(list: &'a [T], index: usize, name: &str, place: impl Fn() -> String) -> Result<&'a T, Fault> {
    list.get(index).ok_or_else(|| Fault::index(place(), name, index, list.len()))
}
