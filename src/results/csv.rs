//! Cells of comma-separated tables, as RFC 4180 writes them.

use std::borrow::Cow;

/// A name as a cell: in quotes, the quotes within it doubled, where a comma, a quote, a line break, a semicolon or a
/// blank at either end would otherwise be read as something else. The name itself is never changed.
pub fn cell(text: &str) -> Cow<'_, str> {
    match text.contains([',', '"', '\n', '\r', ';', '\t']) || text.trim() != text {
        true => format!("\"{}\"", text.replace('"', "\"\"")).into(),
        false => text.into(),
    }
}

/// The rows of a table, each with its cells. A line break within quotes belongs to its cell.
pub fn rows(table: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut cell) = (vec![], vec![], String::new());
    let mut quoted = false;
    let mut characters = table.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if quoted && characters.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' if quoted || cell.is_empty() => quoted = !quoted,
            ',' if !quoted => row.push(std::mem::take(&mut cell)),
            '\r' if !quoted && characters.peek() == Some(&'\n') => {}
            '\n' if !quoted => {
                row.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut row));
            }
            other => cell.push(other),
        }
    }
    if !cell.is_empty() || !row.is_empty() {
        row.push(cell);
        rows.push(row);
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4180, 2.5 to 2.7.
    #[test]
    fn a_name_is_quoted_only_where_a_reader_would_split_or_trim_it() {
        let plain = ["pipe_left", "=1+1", "Rohr Ø 1.2", "左管", "-", "a:b"];
        plain.iter().for_each(|name| assert_eq!(cell(name), *name));
        let quoted = [("a, b", "\"a, b\""), ("1\" pipe", "\"1\"\" pipe\""), ("a;b", "\"a;b\""), (" a", "\" a\"")];
        quoted.iter().for_each(|(name, written)| assert_eq!(cell(name), *written));
        assert_eq!(cell("two\nlines"), "\"two\nlines\"");
    }

    #[test]
    fn whatever_name_is_written_is_read_back() {
        let names = ["pipe, left", "\"", "\"\"", ",", "two\r\nlines", "a;b", "=cmd()", "Straße", " ", "x\"y,z\n"];
        let table = names.map(|name| format!("0.5,{},1\n", cell(name))).concat();
        let read = rows(&table);
        assert_eq!(read.len(), names.len());
        for (row, name) in read.iter().zip(names) {
            assert_eq!(row, &["0.5", name, "1"]);
        }
        // lines that end the other way, and a last line without an end
        assert_eq!(rows("a,b\r\n1,\"2\"\r\n3,"), [["a", "b"], ["1", "2"], ["3", ""]]);
        assert_eq!(rows(""), Vec::<Vec<String>>::new());
    }
}
