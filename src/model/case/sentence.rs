//! What the JSON reader says, turned into sentences.

/// The known name most like `word`, if any is like it.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |name: &str| strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase());
    let best = known.into_iter().min_by_key(|name| distance(name))?;
    (distance(best) <= 1 + word.chars().count() / 4).then_some(best)
}

/// A sentence from a message of serde's: `unknown field`, `missing field`, `unknown variant`, `invalid type`.
pub fn from_serde(message: &str) -> String {
    let names = |head: &str| Some(message.strip_prefix(head)?.split_once("`, expected ").unwrap_or_default());
    if let Some((key, known)) = names("unknown field `") {
        return unknown("there is no key", key, "the keys are", known);
    }
    if let Some((word, known)) = names("unknown variant `") {
        return unknown("there is no", word, "there are", known);
    }
    match message.strip_prefix("missing field `") {
        Some(key) => format!("the key \"{}\" is missing", key.trim_end_matches('`')),
        None => plain_types(message),
    }
}

/// A sentence for a name that must be that of a `noun`: `"linaer" is no law (did you mean "linear"?); there are: ...`
pub fn of_noun(noun: &str, message: &str) -> String {
    match message.strip_prefix("unknown variant `").and_then(|rest| rest.split_once("`, expected ")) {
        Some((word, known)) => {
            let (hint, known) = hint_and_list(word, known);
            format!("\"{word}\" is no {noun}{hint}; there are: {known}")
        }
        None => from_serde(message),
    }
}

/// `known` is serde's list: names between backticks.
fn unknown(there_is_no: &str, word: &str, there_are: &str, known: &str) -> String {
    let (hint, known) = hint_and_list(word, known);
    format!("{there_is_no} \"{word}\"{hint}; {there_are}: {known}")
}

/// ` (did you mean "linear"?)` where a name is near, and all names.
fn hint_and_list(word: &str, known: &str) -> (String, String) {
    let known: Vec<_> = known.split('`').skip(1).step_by(2).filter(|name| *name != "$schema").collect();
    let hint = nearest(word, known.iter().copied()).map(|name| format!(" (did you mean \"{name}\"?)"));
    (hint.unwrap_or_default(), known.join(", "))
}

/// `invalid type: string "abc", expected f64` -> `string "abc" stands where a number is expected`
fn plain_types(message: &str) -> String {
    let heads = ["invalid type: ", "invalid value: ", "invalid length "];
    let stated = heads.iter().find_map(|head| message.strip_prefix(head));
    let Some((found, expected)) = stated.and_then(|rest| rest.rsplit_once(", expected ")) else {
        return message.into();
    };
    let expected = match expected {
        "f64" => "a number",
        "usize" => "a whole number from 0 on",
        "a map" => "an object",
        "map with a single key" => "an object with exactly one key",
        "string or map" => "one of the known words",
        "a sequence" => "a list",
        "a boolean" => "true or false",
        "path string" => "a path",
        // every list of fixed length in a case has two entries: x and y, or two modes
        "an array of length 2" | "fewer elements in array" => "a list of two",
        other => other,
    };
    let found = match found {
        "map" => "an object".into(),
        "sequence" => "a list".into(),
        length if message.starts_with("invalid length") => format!("a list of {length}"),
        other => other.replace('`', ""),
    };
    format!("{found} stands where {expected} is expected")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelled_name_finds_its_neighbour_and_a_strange_one_finds_none() {
        let known = ["layer_1", "pipe_left", "surface"];
        for (word, expected) in [
            ("layer1", Some("layer_1")),
            ("Surface", Some("surface")),
            ("srface", Some("surface")),
            ("pipe_rigth", None),
            ("base", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, known), expected, "{word}");
        }
        assert_eq!(nearest("x", []), None);
    }

    #[test]
    fn a_list_of_another_length_is_told_how_long_it_must_be() {
        let read = |text: &str| serde_json::from_value::<[f64; 2]>(serde_json::from_str(text).unwrap()).unwrap_err();
        for (text, length) in [("[1, 0, 0]", 3), ("[1]", 1), ("[]", 0)] {
            let sentence = from_serde(&read(text).to_string());
            assert_eq!(sentence, format!("a list of {length} stands where a list of two is expected"));
        }
    }

    #[test]
    fn a_key_with_backticks_is_still_quoted_whole() {
        let sentence = from_serde("unknown field `a`b`, expected one of `law`, `peak`");
        assert_eq!(sentence, "there is no key \"a`b\"; the keys are: law, peak");
    }
}
