//! The constants that the `DefineConstant` blocks of a Gmsh script declare.

use super::words::Word;

/// A constant of `DefineConstant` that `gmsh -setnumber` can set.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    pub name: String,
    /// ONELAB's `Name "..."`: label and unit for people
    pub label: Option<String>,
    pub default: Expression,
    pub min: Option<Expression>,
    pub max: Option<Expression>,
}

/// The right-hand side of a constant; only plain numbers are understood here, the rest is Gmsh's.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    Number(f64),
    Formula(String),
}

impl std::fmt::Display for Expression {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Expression::Number(value) => write!(f, "{value}"),
            Expression::Formula(text) => f.write_str(text),
        }
    }
}

impl Expression {
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Expression::Number(value) => Some(*value),
            Expression::Formula(_) => None,
        }
    }
}

/// The numbers of all `DefineConstant[ ... ]` blocks.
pub(super) fn constants(words: &[Word]) -> Vec<Constant> {
    let is_block = |w: &[Word]| w[0] == Word::Name("DefineConstant") && (w[1].is('[') || w[1].is('('));
    let starts = words.windows(2).enumerate().filter(|(_, w)| is_block(w)).map(|(i, _)| i + 1);
    starts.flat_map(|start| block(&words[start..=closing(words, start)])).collect()
}

/// Index of the bracket that closes the one at `open`; the last word if none does.
fn closing(words: &[Word], open: usize) -> usize {
    let mut depth = 0_usize;
    for (i, word) in words.iter().enumerate().skip(open) {
        match word {
            Word::Symbol('[' | '(' | '{') => depth += 1,
            Word::Symbol(']' | ')' | '}') => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return i;
        }
    }
    words.len() - 1
}

/// `[ name = value, name = {value, options} name = ... ]`: Gmsh lets the comma between two constants be left out.
fn block(words: &[Word]) -> Vec<Constant> {
    let begins = |i: usize| {
        let assigned = words.get(i + 1).is_some_and(|w| w.is('=')) && !words.get(i + 2).is_some_and(|w| w.is('='));
        matches!(words[i], Word::Name(_)) && assigned
    };
    let mut constants = Vec::new();
    let mut i = 1;
    while i + 1 < words.len() {
        let Word::Name(name) = words[i] else {
            i = if matches!(words[i], Word::Symbol('{' | '(' | '[')) { closing(words, i) + 1 } else { i + 1 };
            continue;
        };
        if !begins(i) {
            // `name` alone is 0; `name() = ...` is a list, `name~{i}` a computed name
            let alone = words[i + 1].is(',') || i + 2 == words.len();
            let default = Expression::Number(0.0);
            constants.extend(alone.then(|| Constant { name: name.into(), label: None, default, min: None, max: None }));
            i += 1;
            continue;
        }
        let mut end = i + 2;
        while end + 1 < words.len() && !words[end].is(',') && !begins(end) {
            end = if matches!(words[end], Word::Symbol('{' | '(' | '[')) { closing(words, end) + 1 } else { end + 1 };
        }
        constants.extend(constant(name, &words[(i + 2).min(end)..end]));
        i = end.max(i + 1);
    }
    constants
}

/// `value` or `{value, Name "label", Min a, Max b, ...}`; none if the value is a text or a list.
fn constant(name: &str, value: &[Word]) -> Option<Constant> {
    let inner = match value {
        [first, inner @ .., last] if first.is('{') && last.is('}') => inner,
        plain => plain,
    };
    let parts = split_at_commas(inner);
    let option = |key: &str| {
        let found = parts[1..].iter().find(|p| p.first() == Some(&Word::Name(key)));
        found.map(|part| &part[1..])
    };
    let label = option("Name").and_then(|p| match p {
        [Word::Text(text), ..] => Some((*text).into()),
        _ => None,
    });
    let text = |w: &Word| matches!(w, Word::Text(_)) || w.is('{');
    if parts[0].is_empty() || parts[0].iter().any(text) {
        return None;
    }
    let (default, min, max) = (expression(parts[0]), option("Min").map(expression), option("Max").map(expression));
    Some(Constant { name: name.into(), label, default, min, max })
}

/// The parts between commas outside of brackets; at least one.
fn split_at_commas<'a, 'w>(words: &'w [Word<'a>]) -> Vec<&'w [Word<'a>]> {
    let mut parts = Vec::new();
    let (mut start, mut i) = (0, 0);
    while i < words.len() {
        if words[i].is(',') {
            parts.push(&words[start..i]);
            start = i + 1;
        }
        i = if matches!(words[i], Word::Symbol('{' | '(' | '[')) { closing(words, i) + 1 } else { i + 1 };
    }
    parts.push(&words[start.min(words.len())..]);
    parts
}

fn expression(words: &[Word]) -> Expression {
    let text: String = words.iter().map(Word::source).collect();
    match text.trim_start_matches('+').parse() {
        Ok(value) if words.iter().any(|w| matches!(w, Word::Number(_))) => Expression::Number(value),
        _ => Expression::Formula(text),
    }
}
