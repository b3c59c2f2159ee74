//! Names as XML can hold them.

/// For an attribute or a text: names may hold what XML does not allow there, or would make a blank of. Control
/// characters, which no XML can hold, become U+FFFD.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\t' | '\n' | '\r' => escaped += &format!("&#{};", character as u32),
            control if control.is_control() => escaped.push('\u{fffd}'),
            other => escaped.push(other),
        }
    }
    escaped
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
}
