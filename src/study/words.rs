//! The words of a Gmsh script, cut as Gmsh's own lexer cuts them.

/// A word of the script; comments and white space are left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Word<'a> {
    Name(&'a str),
    Number(&'a str),
    /// between double or single quotes
    Text(&'a str),
    Symbol(char),
}

impl Word<'_> {
    pub(super) fn is(&self, symbol: char) -> bool {
        *self == Word::Symbol(symbol)
    }

    pub(super) fn source(&self) -> String {
        match self {
            Word::Name(s) | Word::Number(s) => (*s).to_string(),
            Word::Text(s) => format!("\"{s}\""),
            Word::Symbol(c) => c.to_string(),
        }
    }
}

/// The words of `source`, one after the other.
#[derive(Clone)]
pub(super) struct Words<'a> {
    rest: &'a str,
}

pub(super) fn words(source: &str) -> Words<'_> {
    Words { rest: source }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    fn next(&mut self) -> Option<Word<'a>> {
        loop {
            let rest = self.rest;
            let first = rest.chars().next()?;
            let (word, length) = if rest.starts_with("//") {
                // Gmsh's input ends a comment, or a text, at a zero byte too
                (None, rest.find(['\n', '\0']).unwrap_or(rest.len()))
            } else if let Some(comment) = rest.strip_prefix("/*") {
                let end = comment.find("*/").map_or(rest.len(), |end| end + 4);
                (None, rest.find('\0').map_or(end, |zero| end.min(zero)))
            } else if first == '"' || first == '\'' {
                let text = rest[1..].split([first, '\0']).next().unwrap_or_default();
                (Some(Word::Text(text)), (text.len() + 2).min(rest.len()))
            } else if first.is_ascii_alphabetic() || first == '_' {
                let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
                (Some(Word::Name(&rest[..end])), end)
            } else if number_length(rest) > 0 {
                let end = number_length(rest);
                (Some(Word::Number(&rest[..end])), end)
            } else {
                ((!first.is_whitespace() && first != '\0').then_some(Word::Symbol(first)), first.len_utf8())
            };
            self.rest = &rest[length..];
            if word.is_some() {
                return word;
            }
        }
    }
}

/// Bytes of the unsigned number `rest` begins with: `12`, `.5`, `1.5e-3`; 0 if it does not.
fn number_length(rest: &str) -> usize {
    let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(0);
    let mantissa = match rest[whole..].starts_with('.') {
        true if whole + digits(whole + 1) > 0 => whole + 1 + digits(whole + 1),
        _ => whole,
    };
    let exponent = rest[mantissa..].strip_prefix(['e', 'E']).map(|e| usize::from(e.starts_with(['+', '-'])) + 1);
    match exponent {
        Some(sign) if mantissa > 0 && digits(mantissa + sign) > 0 => mantissa + sign + digits(mantissa + sign),
        _ => mantissa,
    }
}
