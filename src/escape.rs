//! Text from files, names and arguments made safe to print: nothing in it moves the cursor or begins a line.

use std::borrow::Cow;

/// Control characters, line breaks among them, as escapes: `\n`, `\u{1b}`.
pub fn one_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_unsafe)
}

/// Control characters as escapes, line breaks left as they are.
pub fn lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c != '\n' && is_unsafe(c))
}

/// A name in a table or a list: on one line, and a very long one without its middle.
pub fn name(name: &str) -> Cow<'_, str> {
    const SHOWN: usize = 80;
    let count = name.chars().count();
    if count <= SHOWN {
        return one_line(name);
    }
    let head: String = name.chars().take(SHOWN / 2).collect();
    let tail: String = name.chars().skip(count - SHOWN / 2).collect();
    Cow::Owned(format!("{}...{}", one_line(&head), one_line(&tail)))
}

fn escaped(text: &str, unsafe_char: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&unsafe_char) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match unsafe_char(c) {
            true => safe.extend(c.escape_debug()),
            false => safe.push(c),
        }
    }
    Cow::Owned(safe)
}

/// Controls (C0, C1, delete), and what Unicode has to change the direction of writing or to break lines.
fn is_unsafe(c: char) -> bool {
    let format = matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}');
    c.is_control() || format
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_become_escapes_and_letters_stay() {
        assert_eq!(one_line("a\u{1b}[31mX\0\r\nb\u{9b}\u{202e}"), r"a\u{1b}[31mX\0\r\nb\u{9b}\u{202e}");
        assert_eq!(lines("a\tb\nc\u{7f}"), "a\\tb\nc\\u{7f}");
        let plain = "sänd, песок, 砂, a\u{308}, \"quoted\" \\ back";
        assert!(matches!(one_line(plain), Cow::Borrowed(text) if text == plain));
    }

    #[test]
    fn a_long_name_keeps_its_beginning_and_its_end() {
        let long = format!("begin{}end", "x".repeat(10_000));
        let short = name(&long);
        assert_eq!(short.chars().count(), 83);
        assert!(short.starts_with("beginxxx") && short.ends_with("xxxend") && short.contains("x...x"));
        assert_eq!(name("pipe\n"), "pipe\\n");
    }
}
