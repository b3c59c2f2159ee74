//! Names as XML can hold them.

/// For an attribute or a text: names may hold what XML does not allow there, or would make a blank of.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in possible(text).chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\t' | '\n' | '\r' => escaped += &format!("&#{};", character as u32),
            other => escaped.push(other),
        }
    }
    escaped
}

/// With U+FFFD for characters that no XML can hold, escaped or not: control characters but tab and line ends, U+FFFE and
/// U+FFFF.
pub fn possible(text: &str) -> String {
    let is_possible =
        |c: char| matches!(c, '\t' | '\n' | '\r') || !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if is_possible(c) { c } else { '\u{fffd}' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// XML 1.0, 2.2, 2.4 and 3.3.3.
    #[test]
    fn an_attribute_holds_any_name() {
        assert_eq!(escaped("a&b<c\"d\te\nf\rg ü'>"), "a&amp;b&lt;c&quot;d&#9;e&#10;f&#13;g ü'&gt;");
        assert_eq!(escaped("bell\u{7}"), "bell\u{fffd}");
    }

    #[test]
    fn characters_that_no_xml_holds_are_replaced() {
        assert_eq!(possible("\u{1b}[31mred\u{fffe}\u{ffff}\u{b}\t"), "\u{fffd}[31mred\u{fffd}\u{fffd}\u{fffd}\t");
    }
}
