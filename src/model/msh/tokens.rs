//! The bytes of a mesh file and a place in them: numbers in ASCII or binary, lines, and sentences that say where.

use super::markers::{Markers, section_name};
use crate::{Error, Result};

/// How the numbers of a file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// Some editors put it before text in UTF-8.
pub(super) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

pub(super) struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    file: &'a str,
    /// the section being read, for messages
    pub(super) section: String,
    pub(super) encoding: Encoding,
    /// of sections that are not read; found when the first of them is met
    markers: Option<Markers<'a>>,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(bytes: &'a [u8], file: &'a str) -> Self {
        let (section, encoding) = (String::new(), Encoding::Ascii);
        let at = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Tokens { bytes, at, file, section, encoding, markers: None }
    }

    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Goes back to a place, where an error is then reported.
    pub(super) fn back_to(&mut self, at: usize) -> &Self {
        self.at = at;
        self
    }

    pub(super) fn is_binary(&self) -> bool {
        self.encoding != Encoding::Ascii
    }

    /// `FILE, $SECTION, line 12` (ASCII) or `FILE, $SECTION, byte 512` (binary).
    fn place(&self) -> String {
        let section = match self.section.as_str() {
            "" => String::new(),
            name => format!(", ${}", beginning(name.as_bytes())),
        };
        let at = self.at.min(self.bytes.len());
        if self.is_binary() {
            return format!("{}{section}, byte {at}", self.file);
        }
        let line = 1 + self.bytes[..at].iter().filter(|&&b| b == b'\n').count();
        format!("{}{section}, line {line}", self.file)
    }

    pub(super) fn error(&self, what: impl AsRef<str>) -> Error {
        Error::input(format!("{}: {}", self.place(), what.as_ref()))
    }

    /// A sentence on the whole file, without a place in it.
    pub(super) fn of_file(&self, what: impl AsRef<str>) -> Error {
        Error::input(format!("{}: {}", self.file, what.as_ref()))
    }

    pub(super) fn file(&self) -> &str {
        self.file
    }

    pub(super) fn truncated(&self) -> Error {
        self.error("the file ends here, in the middle of the section; it was cut off, make the mesh again")
    }

    pub(super) fn skip_space(&mut self) {
        let space = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.at += space;
    }

    pub(super) fn at_end(&mut self) -> bool {
        self.skip_space();
        self.at == self.bytes.len()
    }

    /// The next word between white space; an error at the end of the file.
    fn word(&mut self) -> Result<&'a [u8]> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.truncated());
        }
        self.at += length;
        Ok(&rest[..length])
    }

    fn expected(&mut self, what: &str, word: &[u8]) -> Error {
        self.at -= word.len();
        self.error(format!("expected {what}, found \"{}\"", beginning(word)))
    }

    /// The rest of the line without its end; moves behind it.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii_end()
    }

    /// The name of the next `$Name` line; text between sections is passed over, as Gmsh does. None at the end of the file.
    pub(super) fn next_section(&mut self) -> Option<String> {
        while !self.at_end() {
            let line = self.line();
            if let Some(name) = section_name(line).filter(|name| !name.starts_with(b"End")) {
                return Some(String::from_utf8_lossy(name).into_owned());
            }
        }
        None
    }

    /// The line `$EndNAME` of the section being read.
    pub(super) fn section_end(&mut self) -> Result<()> {
        let word = self.word()?;
        let end = format!("$End{}", self.section);
        match word == end.as_bytes() {
            true => Ok(()),
            false => Err(self.expected(&end, word)),
        }
    }

    /// Moves behind the `$EndNAME` line of a section that is not read. Where it has none, its content is passed over like
    /// text between sections.
    pub(super) fn skip_section(&mut self) {
        let markers = self.markers.get_or_insert_with(|| Markers::find(self.bytes, self.at));
        if let Some(end) = markers.end_of(self.section.as_bytes(), self.at) {
            self.at = end;
            self.line();
        }
    }

    /// `N` raw bytes of a binary file.
    pub(super) fn raw<const N: usize>(&mut self) -> Result<[u8; N]> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => Err(self.truncated()),
        }
    }

    /// Behind the end of an ASCII line that binary numbers follow.
    pub(super) fn end_line(&mut self) -> Result<()> {
        let start = self.at;
        match self.line() {
            rest if rest.trim_ascii().is_empty() => Ok(()),
            _ => {
                self.at = start;
                Err(self.error("expected the end of the line"))
            }
        }
    }

    /// An integer in ASCII, whatever the encoding of the file.
    pub(super) fn ascii_integer(&mut self) -> Result<i64> {
        let word = self.word()?;
        integer(word).ok_or_else(|| self.expected("an integer", word))
    }

    /// An `int`: 4 bytes in binary.
    #[inline]
    pub(super) fn int(&mut self) -> Result<i64> {
        match self.encoding {
            Encoding::Ascii => self.ascii_integer(),
            Encoding::LittleEndian => Ok(i32::from_le_bytes(self.raw()?).into()),
            Encoding::BigEndian => Ok(i32::from_be_bytes(self.raw()?).into()),
        }
    }

    /// A `size_t`: 8 bytes in binary.
    #[inline]
    pub(super) fn size(&mut self) -> Result<usize> {
        let value = match self.encoding {
            Encoding::Ascii => return self.unsigned(Self::ascii_integer),
            Encoding::LittleEndian => u64::from_le_bytes(self.raw()?),
            Encoding::BigEndian => u64::from_be_bytes(self.raw()?),
        };
        usize::try_from(value).map_err(|_| self.error(format!("{value} is too large")))
    }

    /// An integer of `read` that may not be negative.
    #[inline]
    pub(super) fn unsigned(&mut self, read: impl Fn(&mut Self) -> Result<i64>) -> Result<usize> {
        let value = read(self)?;
        usize::try_from(value).map_err(|_| self.error(format!("expected a tag or a count, found {value}")))
    }

    /// A `double`: 8 bytes in binary. May be infinite or not a number.
    #[inline]
    pub(super) fn real(&mut self) -> Result<f64> {
        match self.encoding {
            Encoding::Ascii => {
                let word = self.word()?;
                real(word).ok_or_else(|| self.expected("a number", word))
            }
            Encoding::LittleEndian => Ok(f64::from_le_bytes(self.raw()?)),
            Encoding::BigEndian => Ok(f64::from_be_bytes(self.raw()?)),
        }
    }

    /// Coordinates of a node: three finite numbers.
    #[inline]
    pub(super) fn xyz(&mut self) -> Result<[f64; 3]> {
        let xyz = [self.real()?, self.real()?, self.real()?];
        match xyz.iter().all(|x| x.is_finite()) {
            true => Ok(xyz),
            false => Err(self.error(format!("a node lies at {xyz:?}, which is no place"))),
        }
    }

    /// `count` if that many things of at least `bytes` bytes (in binary; in ASCII of two bytes a number) still fit in
    /// the file: no memory is asked for on the word of a corrupt count.
    pub(super) fn checked_count(&self, count: usize, numbers: usize, bytes: usize, things: &str) -> Result<usize> {
        let left = self.bytes.len() - self.at;
        let least = if self.is_binary() { bytes } else { 2 * numbers };
        match count.checked_mul(least) {
            Some(needed) if needed <= left => Ok(count),
            _ => Err(self.error(format!(
                "{count} {things} are announced, but only {left} bytes follow; the file is cut off or corrupt, make the mesh again"
            ))),
        }
    }
}

/// The first characters of a word or a line, as messages show them.
pub(super) fn beginning(text: &[u8]) -> String {
    const SHOWN: usize = 24;
    let shown: String = String::from_utf8_lossy(text).chars().take(SHOWN).collect();
    let more = if String::from_utf8_lossy(text).chars().count() > SHOWN { "..." } else { "" };
    format!("{}{more}", shown.escape_debug())
}

fn integer(word: &[u8]) -> Option<i64> {
    let digits = word.strip_prefix(b"-").unwrap_or(word);
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0;
    for b in digits {
        if !b.is_ascii_digit() {
            return None;
        }
        value = 10 * value + i64::from(b - b'0');
    }
    Some(if digits.len() < word.len() { -value } else { value })
}

fn real(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
