//! Where sections begin and end that are not read: post-processing data, comments, periodicity and whatever else follows.

use std::collections::HashMap;

/// Places of the lines that begin with `$`, after blanks if there are any, by what stands behind the `$`.
pub(super) struct Markers<'a>(HashMap<&'a [u8], Vec<usize>>);

impl<'a> Markers<'a> {
    /// One pass over the file from `from` on.
    pub(super) fn find(bytes: &'a [u8], from: usize) -> Markers<'a> {
        let mut places: HashMap<&[u8], Vec<usize>> = HashMap::new();
        let mut at = from;
        while let Some(offset) = bytes[at..].iter().position(|&b| b == b'$') {
            let dollar = at + offset;
            at = dollar + 1;
            let blank = |b: &u8| *b == b' ' || *b == b'\t';
            let before = bytes[..dollar].iter().rev().find(|b| !blank(b));
            if before.is_none_or(|&b| b == b'\n') {
                let rest = &bytes[dollar..];
                let length = rest.iter().take(LONGEST).position(|b| b.is_ascii_whitespace());
                let word = &rest[..length.unwrap_or(rest.len().min(LONGEST))];
                places.entry(section_name(word).unwrap_or_default()).or_default().push(dollar);
            }
        }
        Markers(places)
    }

    /// The place of the line that ends the section `name` whose content begins at `from`; none if it has no end, or
    /// if another section of that name begins before.
    pub(super) fn end_of(&self, name: &[u8], from: usize) -> Option<usize> {
        let end = self.next(&[b"End", name].concat(), from)?;
        let again = self.next(name, from);
        again.is_none_or(|begin| begin > end).then_some(end)
    }

    fn next(&self, word: &[u8], from: usize) -> Option<usize> {
        let places = self.0.get(word)?;
        places.get(places.partition_point(|&place| place < from)).copied()
    }
}

/// No section has a name of that many bytes; binary data may have no white space for long.
const LONGEST: usize = 200;

/// `Name` of a line `$Name`; blanks before it and words behind it do not matter.
pub(super) fn section_name(line: &[u8]) -> Option<&[u8]> {
    let rest = line.trim_ascii_start().strip_prefix(b"$")?;
    let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
    (length > 0).then_some(&rest[..length])
}
