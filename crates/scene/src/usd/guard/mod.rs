//! What is checked before `openusd` reads a layer, and what becomes of its panics: it trusts counts and recurses as deep as a
//! layer nests, and neither memory that is not there nor a stack that is full can be caught.
//!
//! | module | idea |
//! |---|---|
//! | `resolver` | every layer that is opened is checked first |
//! | `package` | entries of packages |
//! | `arcs` | in how many places a prim is looked for |
//! | `stage` | prims are counted before they are composed |
//! | `budget` | how much all layers may expand to |
//! | `text` | nesting and lists of text |
//! | `tuples` | its tuples |
//! | `expressions` | variable expressions |
//! | `crate_file` | header and tables of binary layers |
//! | `paths` | their tree of paths |
//! | `values`, `lists`, `kinds` | their values |
//! | `blocks`, `cursor` | what these are read from |
//! | `panics` | a thread with room, whose panics are caught |
mod arcs;
mod blocks;
mod budget;
mod crate_file;
mod cursor;
mod expressions;
mod kinds;
mod lists;
mod package;
mod panics;
mod paths;
mod resolver;
mod stage;
mod text;
mod tuples;
mod values;

pub use package::entry;
pub use panics::{apart, silent};
pub use resolver::Findings;
pub use stage::Stage;

use crate::gltf::fault::Fault;
use budget::Budget;

/// Refuses a layer that nests too deep, or claims more than it can hold. What is neither binary nor a package is text.
fn check(bytes: &[u8], budget: &mut Budget) -> Result<(), Fault> {
    budget.add_layer(bytes.len());
    if bytes.starts_with(crate_file::MAGIC) {
        return crate_file::check(bytes, budget);
    }
    if package::is_package(bytes) {
        return package::check(bytes);
    }
    let text = std::str::from_utf8(bytes);
    let text = text.map_err(|error| {
        let found = format!("bytes that are no text, the first at {}", error.valid_up_to());
        Fault::new("", found, "a layer of USD: text, binary or a package")
    })?;
    text::check(text, budget)
}

#[cfg(test)]
mod tests;
