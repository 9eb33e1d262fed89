//! Variable expressions: text in backticks that the composer evaluates, and expressions inside it.

use crate::gltf::fault::Fault;

/// Brackets that an expression may open: the composer nests as deep.
const MAX_BRACKETS: usize = 400;
/// Expressions of a layer: the variable of one may be another, and so on.
const MAX_EXPRESSIONS: usize = 4096;

/// Counts expressions of a layer.
#[derive(Default)]
pub struct Expressions {
    count: usize,
}

impl Expressions {
    /// Refuses a text that is an expression too deep, or one too many.
    pub fn check(&mut self, text: &[u8], place: &str) -> Result<(), Fault> {
        if !text.starts_with(b"`") {
            return Ok(());
        }
        self.count += 1;
        let brackets = text.iter().filter(|byte| matches!(byte, b'(' | b'[' | b'{')).count();
        if brackets > MAX_BRACKETS || self.count > MAX_EXPRESSIONS {
            let found = format!("expression {} of {brackets} brackets", self.count);
            return Err(Fault::new(place, found, format!("at most {MAX_EXPRESSIONS}, of {MAX_BRACKETS} brackets")));
        }
        Ok(())
    }
}
