//! Tuples of text: the reader takes what a short one lacks from memory that nobody has written.
use openusd::usda::token::Token;

use crate::gltf::fault::Fault;

/// Numbers of tuples have a role, or a plain type, before their count.
const STEMS: [&str; 11] =
    ["int", "half", "float", "double", "point", "normal", "vector", "color", "texCoord", "matrix", "frame"];
/// Tokens that are looked back at.
const BACK: usize = 3;

/// Counts the elements of tuples, token by token.
#[derive(Default)]
pub struct Tuples<'a> {
    /// What came before, the last first.
    last: [Option<Token<'a>>; BACK],
    /// Elements that a tuple of the property has, if it has any.
    size: Option<usize>,
    open: Vec<Open>,
}

/// An open bracket.
struct Open {
    kind: Kind,
    /// What is directly in it, but for commas.
    items: usize,
    has_brackets: bool,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Of so many elements, if that is known.
    Tuple(Option<usize>),
    List,
    Spline,
    Other,
}

impl<'a> Tuples<'a> {
    /// Refuses what closes a tuple of too few or too many.
    pub fn token(&mut self, token: &Token<'a>, place: &str) -> Result<(), Fault> {
        match token {
            Token::Punctuation(bracket @ ('(' | '[' | '{')) => {
                let kind = self.kind(*bracket);
                if let Some(open) = self.open.last_mut() {
                    open.has_brackets = true;
                }
                self.open.push(Open { kind, items: 0, has_brackets: false });
            }
            Token::Punctuation(')' | ']' | '}') => {
                let Some(open) = self.open.pop() else { return Ok(()) };
                if let Open { kind: Kind::Tuple(Some(size)), items, has_brackets: false } = open
                    && items != size
                {
                    return Err(Fault::new(place, format!("a tuple of {items}"), format!("{size} elements")));
                }
            }
            Token::Punctuation(_) => {}
            _ => {
                let is_in_value = matches!(self.around(), Some(Kind::Tuple(_) | Kind::List));
                if let Some(open) = self.open.last_mut() {
                    open.items += 1;
                }
                if !is_in_value && is_name(token) {
                    self.named();
                }
            }
        }
        self.last.rotate_right(1);
        self.last[0] = Some(token.clone());
        Ok(())
    }

    /// A name after a type is a property's.
    fn named(&mut self) {
        let is_array = self.is_back(0, ']') && self.is_back(1, '[');
        self.size = match self.last[if is_array { 2 } else { 0 }] {
            Some(Token::Identifier(name)) => tuple_size(name),
            _ => return,
        };
    }

    fn is_back(&self, back: usize, mark: char) -> bool {
        self.last[back] == Some(Token::Punctuation(mark))
    }

    fn around(&self) -> Option<Kind> {
        self.open.last().map(|open| open.kind)
    }

    /// What a bracket opens.
    fn kind(&self, bracket: char) -> Kind {
        let is_value = ['=', ':', ',', ';', '[', '('].iter().any(|&mark| self.is_back(0, mark));
        match bracket {
            '[' => Kind::List,
            '{' if self.last[1] == Some(Token::Spline) && self.is_back(0, '=') => Kind::Spline,
            '{' => Kind::Other,
            _ if self.around() == Some(Kind::Spline) => Kind::Tuple(self.spline_size()),
            // Commas may be left out.
            _ if is_value || (self.is_back(0, ')') && matches!(self.around(), Some(Kind::Tuple(_) | Kind::List))) => {
                Kind::Tuple(self.size)
            }
            _ => Kind::Other,
        }
    }

    /// Elements of a tuple in a spline: loops have five, tangents two, and what a spline does beyond its ends one.
    fn spline_size(&self) -> Option<usize> {
        match (&self.last[0], &self.last[1]) {
            (Some(Token::Punctuation(':') | Token::NamespacedIdentifier("loop:")), _) => Some(5),
            (Some(Token::Identifier("pre")), _) | (_, Some(Token::Identifier("post"))) => Some(2),
            _ => None,
        }
    }
}

/// Elements of the tuples of a type; none if its values are no tuples.
fn tuple_size(name: &str) -> Option<usize> {
    if matches!(name, "quath" | "quatf" | "quatd") {
        return Some(4);
    }
    let rest = STEMS.iter().find_map(|stem| name.strip_prefix(stem))?;
    let (count, kind) = rest.split_at_checked(1)?;
    ["", "h", "f", "d"].contains(&kind).then(|| count.parse().ok()).flatten()
}

/// Whether a token may name a property: keywords may.
fn is_name(token: &Token) -> bool {
    !matches!(token, Token::Magic(_) | Token::String(_) | Token::Number(_) | Token::PathRef(_) | Token::AssetRef(_))
}
