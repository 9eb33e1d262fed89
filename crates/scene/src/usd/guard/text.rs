//! What a text layer nests and lists, told by the tokens that the reader itself sees: strings, comments and asset paths are what
//! they are to it.
use logos::Logos as _;
use openusd::usda::token::Token;

use super::budget::Budget;
use super::expressions::Expressions;
use super::tuples::Tuples;
use crate::gltf::fault::Fault;

/// Deepest nesting of brackets, and most names in a path.
pub const MAX_NESTING: usize = 400;
/// Relocations of a layer.
const MAX_RELOCATES: u64 = 256;
/// What a name takes in memory beside the path of the prim that it is in: two make a property.
const NAME_BYTES: u64 = 128;

/// An open bracket.
struct Open {
    bracket: char,
    /// What is directly in it so far and is compared with each other when it is read.
    items: u64,
    /// Length of the path of the prim that it is in.
    path: u64,
    /// Whether it holds relocations.
    is_relocates: bool,
}

/// What the next string names.
#[derive(Clone, Copy, PartialEq)]
enum Named {
    Nothing,
    Prim,
    /// No string: a block of relocations.
    Relocates,
}

struct Scan<'a> {
    budget: &'a mut Budget,
    open: Vec<Open>,
    expressions: Expressions,
    /// Lengths of what the next block is of.
    name: u64,
    named: Named,
    is_after_colon: bool,
}

/// Refuses a text that nests too deep, or lists too much of what is compared with each other.
pub fn check(text: &str, budget: &mut Budget) -> Result<(), Fault> {
    let mut scan = Scan {
        budget,
        open: Vec::new(),
        expressions: Expressions::default(),
        name: 0,
        named: Named::Nothing,
        is_after_colon: false,
    };
    let mut tuples = Tuples::default();
    let (mut line, mut counted) = (1, 0);
    for (token, span) in Token::lexer(text).spanned() {
        line += text.as_bytes()[counted..span.start].iter().filter(|&&byte| byte == b'\n').count();
        counted = span.start;
        let place = format!("line {line}");
        let Ok(token) = token else {
            let found: String = text[span.start..].chars().take(1).collect();
            return Err(Fault::new(place, format!("{found:?}"), "text that is USD"));
        };
        scan.token(&token, &place)?;
        tuples.token(&token, &place)?;
    }
    Ok(())
}

impl Scan<'_> {
    fn token(&mut self, token: &Token, place: &str) -> Result<(), Fault> {
        match token {
            Token::Punctuation(bracket @ ('(' | '[' | '{')) => self.opened(*bracket, place)?,
            Token::Punctuation(bracket @ (')' | ']' | '}')) => self.closed(*bracket, place)?,
            Token::Punctuation(_) | Token::Number(_) | Token::Magic(_) => {}
            Token::PathRef(path) => {
                check_names(path, place)?;
                self.listed(place)?;
            }
            Token::AssetRef(path) => {
                self.expressions.check(path.as_bytes(), place)?;
                self.listed(place)?;
            }
            Token::String(text) => {
                self.expressions.check(text.as_bytes(), place)?;
                if self.named == Named::Prim {
                    check_names(text, place)?;
                }
                self.name = text.len() as u64;
                // Lists of names are compared where they are of a prim itself: its schemas, its variants.
                let above = self.open.len().checked_sub(2).and_then(|above| self.open.get(above));
                if above.is_some_and(|above| above.bracket == '(') {
                    self.listed(place)?;
                }
            }
            // The name and the type of a prim are no property's.
            Token::Def | Token::Over | Token::Class => self.pay(place)?,
            Token::Identifier(_) if self.named == Named::Prim => self.pay(place)?,
            Token::Identifier("defaultPrim") => {}
            _ if !self.is_after_colon => {
                self.pay(place)?;
                self.listed(place)?;
            }
            _ => {}
        }
        self.is_after_colon = *token == Token::Punctuation(':');
        self.named = match token {
            Token::Def | Token::Over | Token::Class | Token::Identifier("defaultPrim") => Named::Prim,
            Token::Relocates => Named::Relocates,
            Token::Identifier(_) | Token::Punctuation('=') => self.named,
            _ => Named::Nothing,
        };
        Ok(())
    }

    fn path(&self) -> u64 {
        self.open.last().map_or(0, |open| open.path)
    }

    /// What one name takes.
    fn pay(&mut self, place: &str) -> Result<(), Fault> {
        self.budget.charge(place, NAME_BYTES + self.path())
    }

    /// One more item in the innermost bracket.
    fn listed(&mut self, place: &str) -> Result<(), Fault> {
        if let Some(open) = self.open.last_mut() {
            open.items += 1;
        }
        // A target is kept as a whole path.
        self.budget.charge(place, self.path())
    }

    fn opened(&mut self, bracket: char, place: &str) -> Result<(), Fault> {
        if self.open.len() >= MAX_NESTING {
            return Err(Fault::new(place, format!("brackets nested deeper than {MAX_NESTING}"), "fewer"));
        }
        let path = self.path() + if bracket == '{' { std::mem::take(&mut self.name) + 1 } else { 0 };
        self.open.push(Open { bracket, items: 0, path, is_relocates: self.named == Named::Relocates });
        Ok(())
    }

    fn closed(&mut self, bracket: char, place: &str) -> Result<(), Fault> {
        let closed = self.open.pop();
        let expected = match closed.as_ref().map(|closed| closed.bracket) {
            Some('(') => ')',
            Some('[') => ']',
            Some('{') => '}',
            _ => return Err(Fault::new(place, format!("{bracket:?}"), "a bracket that it closes")),
        };
        if expected != bracket {
            return Err(Fault::new(place, format!("{bracket:?}"), format!("{expected:?}")));
        }
        let items = closed.as_ref().map_or(0, |closed| closed.items);
        if closed.is_some_and(|closed| closed.is_relocates) {
            check_relocates(items / 2, place)?;
        }
        self.budget.charge_pairs(place, items)
    }
}

/// Refuses more relocations than the composer, which compares threes of them, can take in time.
pub fn check_relocates(count: u64, place: &str) -> Result<(), Fault> {
    if count > MAX_RELOCATES {
        return Err(Fault::new(place, format!("{count} relocations"), format!("at most {MAX_RELOCATES}")));
    }
    Ok(())
}

/// Refuses a path of too many names: its prims nest as deep.
fn check_names(path: &str, place: &str) -> Result<(), Fault> {
    let names = path.bytes().filter(|byte| matches!(byte, b'/' | b'{' | b'[')).count();
    if names > MAX_NESTING {
        return Err(Fault::new(place, format!("a path of {names} names"), format!("at most {MAX_NESTING}")));
    }
    Ok(())
}
