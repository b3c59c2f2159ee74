//! The section `$PhysicalNames`.

use super::tokens::{Tokens, beginning};
use super::{Block, PhysicalName};
use crate::Result;

/// A line of the section.
pub(super) struct Named {
    /// none in MSH 2.0; also written as -1
    dimension: Option<usize>,
    tag: i64,
    name: String,
}

impl Named {
    /// The name for its dimension; for each dimension that has elements of that group where the file gives none.
    pub(super) fn of_dimensions(self, blocks: &[Block]) -> Vec<PhysicalName> {
        let Named { dimension, tag, name } = self;
        let has =
            |d: &usize| blocks.iter().any(|b| b.kind.dimension == *d && b.physicals.iter().any(|p| p.abs() == tag));
        let dimensions = dimension.map_or_else(|| (0..=3).filter(has).collect(), |d| vec![d]);
        dimensions.into_iter().map(|dimension| PhysicalName { dimension, tag, name: name.clone() }).collect()
    }
}

/// `count`, then `dimension tag "name"` a line, `tag "name"` in MSH 2.0; ASCII in binary files, too. A group whose name
/// is empty has none.
pub(super) fn physical_names(tokens: &mut Tokens) -> Result<Vec<Named>> {
    let count = tokens.unsigned(Tokens::ascii_integer)?;
    let mut names = Vec::new();
    for _ in 0..count {
        if tokens.at_end() {
            return Err(tokens.truncated());
        }
        let start = tokens.at();
        let line = tokens.line();
        match named(line) {
            Some(named) => names.push(named),
            None => {
                let found = beginning(line);
                let what = format!("expected dimension, tag and \"name\", found \"{found}\"");
                return Err(tokens.back_to(start).error(what));
            }
        }
    }
    names.retain(|named| !named.name.is_empty());
    Ok(names)
}

fn named(line: &[u8]) -> Option<Named> {
    let (first, rest) = leading_integer(line)?;
    let (dimension, tag, rest) = match leading_integer(rest) {
        Some((second, rest)) => (usize::try_from(first).ok(), second, rest),
        None => (None, first, rest),
    };
    let known = dimension.is_none_or(|d| d <= 3) && first >= -1;
    known.then(|| Named { dimension, tag, name: decoded(unquoted(rest)) })
}

fn leading_integer(text: &[u8]) -> Option<(i64, &[u8])> {
    let text = text.trim_ascii_start();
    let length = text.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(text.len());
    let number = std::str::from_utf8(&text[..length]).ok()?.parse().ok()?;
    Some((number, &text[length..]))
}

/// What stands between the first quote and the last; all of it where there are no quotes.
fn unquoted(text: &[u8]) -> &[u8] {
    let [first, last] = [text.iter().position(|&b| b == b'"'), text.iter().rposition(|&b| b == b'"')];
    match (first, last) {
        (Some(first), Some(last)) if first < last => &text[first + 1..last],
        _ => text.trim_ascii(),
    }
}

/// A name as text. Bytes that are not UTF-8 become `%E4`, so that names in other encodings stay apart and can be
/// written in a case; a `%` that could be mistaken for the beginning of one becomes `%25`.
fn decoded(name: &[u8]) -> String {
    let mut text = String::new();
    for chunk in name.utf8_chunks() {
        let valid = chunk.valid();
        for (at, letter) in valid.char_indices() {
            text.push(letter);
            if letter == '%' && looks_encoded(&valid.as_bytes()[at + 1..]) {
                text.push_str("25");
            }
        }
        chunk.invalid().iter().for_each(|byte| text += &format!("%{byte:02X}"));
    }
    text
}

/// Whether behind a `%` stands what an encoded byte has there: a byte outside ASCII, or `25` for the `%` itself.
fn looks_encoded(behind: &[u8]) -> bool {
    matches!(behind, [b'2', b'5', ..] | [b'8' | b'9' | b'A'..=b'F', b'0'..=b'9' | b'A'..=b'F', ..])
}

#[cfg(test)]
mod tests {
    use super::decoded;
    use std::collections::BTreeMap;

    #[test]
    fn names_of_different_bytes_are_different_texts() {
        // Latin-1, Windows-1251, UTF-8, and texts that look like their encoded forms
        let names: [&[u8]; 14] = [
            b"s\xe4nd",
            b"s\xe5nd",
            b"s\xc3\xa4nd",
            b"s%E4nd",
            b"s%25E4nd",
            b"s%2525E4nd",
            b"s%\xe4nd",
            b"\xef\xe5\xf1\xee\xea",
            b"\xef\xe5\xf1\xee\xea\xe8",
            b"50%",
            b"50%25",
            b"\xff",
            b"%FF",
            b"s\xef\xbf\xbdnd",
        ];
        let texts: BTreeMap<String, &[u8]> = names.iter().map(|&name| (decoded(name), name)).collect();
        assert_eq!(texts.len(), names.len(), "{texts:?}");
        assert_eq!([decoded(b"s\xe4nd"), decoded(b"50% clay, a%20b")], ["s%E4nd", "50% clay, a%20b"]);
    }
}
