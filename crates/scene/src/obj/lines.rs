//! Bytes to logical lines and tokens. Nothing here needs the file to be UTF-8.
use std::borrow::Cow;

/// Longest piece of a file that a message quotes, in bytes.
const QUOTE_LIMIT: usize = 40;

/// The logical lines of a file: a `\` at the end of a line joins the next one, a comment's does not.
pub struct Lines<'a> {
    rest: &'a [u8],
    next_number: u32,
}

/// A logical line.
pub struct Line<'a> {
    /// Number of its first line in the file, from 1.
    pub number: u32,
    text: Cow<'a, [u8]>,
}

impl<'a> Lines<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, next_number: 1 }
    }

    /// The next line of the file without its end (LF or CR LF).
    fn physical_line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&byte| byte == b'\n').unwrap_or(self.rest.len());
        let line = &self.rest[..end];
        self.rest = self.rest.get(end + 1..).unwrap_or_default();
        self.next_number = self.next_number.saturating_add(1);
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }
}

/// What stands before a `\` at the end of a line that has no comment.
fn continued(line: &[u8]) -> Option<&[u8]> {
    let start = line.strip_suffix(b"\\")?;
    let begins_comment = |(index, &byte): (usize, &u8)| byte == b'#' && (index == 0 || is_space(line[index - 1]));
    (!line.iter().enumerate().any(begins_comment)).then_some(start)
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let number = self.next_number;
        let first = self.physical_line()?;
        let Some(start) = continued(first) else {
            return Some(Line { number, text: Cow::Borrowed(first) });
        };
        let mut text = start.to_vec();
        while let Some(line) = self.physical_line() {
            text.push(b' ');
            match continued(line) {
                Some(start) => text.extend_from_slice(start),
                None => {
                    text.extend_from_slice(line);
                    break;
                }
            }
        }
        Some(Line { number, text: Cow::Owned(text) })
    }
}

impl Line<'_> {
    pub fn tokens(&self) -> Tokens<'_> {
        Tokens { rest: &self.text }
    }
}

/// The tokens of a line, up to a comment.
pub struct Tokens<'a> {
    rest: &'a [u8],
}

impl<'a> Iterator for Tokens<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|&byte| !is_space(byte))?;
        let rest = &self.rest[start..];
        if rest[0] == b'#' {
            self.rest = &[];
            return None;
        }
        let end = rest.iter().position(|&byte| is_space(byte)).unwrap_or(rest.len());
        self.rest = &rest[end..];
        Some(&rest[..end])
    }
}

/// ASCII white space.
fn is_space(byte: u8) -> bool {
    byte == b' ' || (b'\t'..=b'\r').contains(&byte)
}

/// A decimal number; `nan` and `inf` too, for the caller to refuse.
pub fn number(token: &[u8]) -> Option<f64> {
    std::str::from_utf8(token).ok()?.parse().ok()
}

/// A decimal integer.
pub fn integer(token: &[u8]) -> Option<i64> {
    leading_integer(token).filter(|(_, rest)| rest.is_empty()).map(|(value, _)| value)
}

/// The decimal integer with which a token begins, and what follows it.
pub fn leading_integer(token: &[u8]) -> Option<(i64, &[u8])> {
    let (negative, digits) = match token {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    let mut value = 0i64;
    let mut length = 0;
    while let Some(digit) = digits.get(length).map(|byte| byte.wrapping_sub(b'0')).filter(|&digit| digit < 10) {
        value = value.checked_mul(10)?.checked_add(i64::from(digit))?;
        length += 1;
    }
    (length > 0).then_some((if negative { -value } else { value }, &digits[length..]))
}

/// A piece of a file as a message shows it: in quotes, escaped and cut to a length.
pub fn quoted(token: &[u8]) -> String {
    let shown = String::from_utf8_lossy(&token[..token.len().min(QUOTE_LIMIT)]).escape_debug().to_string();
    let cut = if token.len() > QUOTE_LIMIT { ".." } else { "" };
    format!("`{shown}{cut}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<(u32, Vec<String>)> {
        let owned = |token: &[u8]| String::from_utf8_lossy(token).into_owned();
        Lines::new(text.as_bytes()).map(|line| (line.number, line.tokens().map(owned).collect())).collect()
    }

    fn strings(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    #[test]
    fn lines_may_end_in_lf_or_crlf_or_the_file() {
        assert_eq!(words("a b\r\n\n\tc  d"), [(1, strings(&["a", "b"])), (2, vec![]), (3, strings(&["c", "d"]))]);
    }

    #[test]
    fn backslash_joins_lines_and_numbers_count_on() {
        assert_eq!(words("a \\\nb\\\r\nc\nd"), [(1, strings(&["a", "b", "c"])), (4, strings(&["d"]))]);
        assert_eq!(words("a \\"), [(1, strings(&["a"]))]);
    }

    #[test]
    fn comments_end_a_line_and_are_never_continued() {
        assert_eq!(words("# C:\\dir\\\na # b \\\nc"), [(1, vec![]), (2, strings(&["a"])), (3, strings(&["c"]))]);
        assert_eq!(words("a#b"), [(1, strings(&["a#b"]))]);
    }

    #[test]
    fn integers_have_digits_and_fit_i64() {
        assert_eq!(integer(b"-12"), Some(-12));
        assert_eq!(integer(b"+7"), Some(7));
        assert_eq!(integer(b"9223372036854775807"), Some(i64::MAX));
        for bad in ["", "-", "1.0", "0x1", "9223372036854775808", "1e3"] {
            assert_eq!(integer(bad.as_bytes()), None, "{bad}");
        }
    }

    #[test]
    fn quotes_are_short_and_on_one_line() {
        assert_eq!(quoted(b"a\x1b\xffb"), "`a\\u{1b}\u{fffd}b`");
        assert_eq!(quoted(&[b'x'; 50]), format!("`{}..`", "x".repeat(40)));
    }
}
