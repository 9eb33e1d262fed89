//! Reads SPIR-V as a stream of instructions: the numbers of the specification by name, and a reader that never panics.
//!
//! The build script and the crate itself (`precise`) share this file. Numbers are those of the SPIR-V 1.6
//! specification, section 3.

use std::fmt;

/// Opcodes (specification, section 3.52).
pub mod op {
    pub const NAME: u32 = 5;
    pub const MEMBER_NAME: u32 = 6;
    pub const EXECUTION_MODE: u32 = 16;
    pub const TYPE_BOOL: u32 = 20;
    pub const TYPE_INT: u32 = 21;
    pub const TYPE_FLOAT: u32 = 22;
    pub const TYPE_VECTOR: u32 = 23;
    pub const TYPE_MATRIX: u32 = 24;
    pub const TYPE_IMAGE: u32 = 25;
    pub const TYPE_SAMPLER: u32 = 26;
    pub const TYPE_SAMPLED_IMAGE: u32 = 27;
    pub const TYPE_ARRAY: u32 = 28;
    pub const TYPE_RUNTIME_ARRAY: u32 = 29;
    pub const TYPE_STRUCT: u32 = 30;
    pub const TYPE_POINTER: u32 = 32;
    pub const CONSTANT: u32 = 43;
    pub const CONSTANT_COMPOSITE: u32 = 44;
    pub const SPEC_CONSTANT_TRUE: u32 = 48;
    pub const SPEC_CONSTANT_FALSE: u32 = 49;
    pub const SPEC_CONSTANT: u32 = 50;
    pub const SPEC_CONSTANT_COMPOSITE: u32 = 51;
    pub const FUNCTION: u32 = 54;
    pub const VARIABLE: u32 = 59;
    pub const DECORATE: u32 = 71;
    pub const MEMBER_DECORATE: u32 = 72;
    pub const EXECUTION_MODE_ID: u32 = 331;
    pub const TYPE_ACCELERATION_STRUCTURE: u32 = 5341;
}

/// Decorations (section 3.20).
pub mod decoration {
    pub const SPEC_ID: u32 = 1;
    pub const ROW_MAJOR: u32 = 4;
    pub const ARRAY_STRIDE: u32 = 6;
    pub const MATRIX_STRIDE: u32 = 7;
    pub const BUILT_IN: u32 = 11;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const OFFSET: u32 = 35;
}

/// Built-in variables (section 3.21).
pub mod built_in {
    pub const WORKGROUP_SIZE: u32 = 25;
}

/// Execution modes (section 3.6).
pub mod execution_mode {
    pub const LOCAL_SIZE: u32 = 17;
    pub const LOCAL_SIZE_ID: u32 = 38;
}

/// Storage classes (section 3.7).
pub mod storage_class {
    pub const UNIFORM_CONSTANT: u32 = 0;
    pub const UNIFORM: u32 = 2;
    pub const PUSH_CONSTANT: u32 = 9;
    pub const STORAGE_BUFFER: u32 = 12;
    pub const PHYSICAL_STORAGE_BUFFER: u32 = 5349;
}

/// Dimensionalities of an image (section 3.8).
pub mod dim {
    pub const BUFFER: u32 = 5;
    pub const SUBPASS_DATA: u32 = 6;
}

/// The first word of a module.
pub const MAGIC: u32 = 0x0723_0203;
/// Words before the first instruction: magic, version, generator, bound, schema.
const HEADER_WORDS: usize = 5;

/// What is wrong with a SPIR-V module, and at which word of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpirvError {
    /// Index of the word that could not be read.
    pub word: usize,
    /// What was expected there.
    pub message: String,
}

impl fmt::Display for SpirvError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "malformed SPIR-V at word {}: {}", self.word, self.message)
    }
}

impl std::error::Error for SpirvError {}

/// One instruction: its opcode, its operands (result type and result id among them) and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Instruction<'a> {
    pub opcode: u32,
    pub operands: &'a [u32],
    pub word: usize,
}

impl<'a> Instruction<'a> {
    /// Operand `index`, or an error naming this instruction.
    pub fn operand(&self, index: usize) -> Result<u32, SpirvError> {
        let found = self.operands.get(index).copied();
        found.ok_or_else(|| self.error(format!("opcode {} has no operand {index}", self.opcode)))
    }

    /// The operands from `index` on.
    pub fn rest(&self, index: usize) -> Result<&'a [u32], SpirvError> {
        let found = self.operands.get(index..);
        found.ok_or_else(|| self.error(format!("opcode {} has no operand {index}", self.opcode)))
    }

    /// The NUL-terminated string that starts at operand `index`.
    pub fn string(&self, index: usize) -> Result<String, SpirvError> {
        let bytes: Vec<u8> = self.rest(index)?.iter().flat_map(|word| word.to_le_bytes()).collect();
        let end = bytes.iter().position(|&byte| byte == 0);
        let end = end.ok_or_else(|| self.error("string without end".into()))?;
        let text = std::str::from_utf8(&bytes[..end]);
        text.map(str::to_owned).map_err(|_| self.error("string is not UTF-8".into()))
    }

    /// An error at this instruction.
    pub fn error(&self, message: String) -> SpirvError {
        SpirvError { word: self.word, message }
    }
}

/// The instructions of a module in order. Ends after the first error.
pub struct Instructions<'a> {
    words: &'a [u32],
    at: usize,
}

/// Checks the header of `words` and returns the instructions after it.
pub fn instructions(words: &[u32]) -> Result<Instructions<'_>, SpirvError> {
    if words.first() != Some(&MAGIC) {
        return Err(SpirvError { word: 0, message: "the first word is not SPIR-V's magic number".into() });
    }
    if words.len() < HEADER_WORDS {
        return Err(SpirvError { word: words.len(), message: "the header is cut off".into() });
    }
    Ok(Instructions { words, at: HEADER_WORDS })
}

impl<'a> Iterator for Instructions<'a> {
    type Item = Result<Instruction<'a>, SpirvError>;

    fn next(&mut self) -> Option<Self::Item> {
        let word = self.at;
        let first = *self.words.get(word)?;
        let (opcode, count) = (first & 0xffff, (first >> 16) as usize);
        if count == 0 || count > self.words.len() - word {
            self.at = self.words.len();
            let message = format!("opcode {opcode} claims {count} words, {} are left", self.words.len() - word);
            return Some(Err(SpirvError { word, message }));
        }
        self.at = word + count;
        Some(Ok(Instruction { opcode, operands: &self.words[word + 1..self.at], word }))
    }
}
