//! Which physical group a name of the case means.
//!
//! Names are unique within a dimension only, as in Gmsh. A use that asks for points, curves or surfaces says which group
//! is meant; where it does not, `curve:left` does.

use super::mesh::{Group, Mesh, SIDE};
use crate::escape;
use crate::{Error, Result};

/// What the groups of a dimension consist of, and what stands before a name that is meant in that dimension only.
const KINDS: [(&str, &str); 3] = [("points", "point:"), ("curves", "curve:"), ("surfaces", "surface:")];

/// So many names are listed where one is not found.
const LISTED: usize = 40;

impl Group {
    /// Whether `name` in a case can mean this group: its name, also with `point:`, `curve:` or `surface:` before it.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || name.strip_prefix(KINDS[self.dimension].1).is_some_and(|rest| rest == self.name)
    }

    /// `curves`
    pub fn kind(&self) -> &'static str {
        KINDS[self.dimension].0
    }

    /// `curve:left`
    pub fn full_name(&self) -> String {
        format!("{}{}", KINDS[self.dimension].1, self.name)
    }
}

impl Mesh {
    /// The group of that name, with at least one cell, where a use does not say of which dimension.
    ///
    /// Errors: there is none (the sentence lists those that exist), it is empty, or groups of several dimensions have the
    /// name and not the same nodes.
    pub fn group(&self, name: &str) -> Result<&Group> {
        let called = self.called(name);
        let filled: Vec<&Group> = called.iter().copied().filter(|g| !g.cells.is_empty()).collect();
        let Some(&largest) = filled.last() else {
            return Err(called.first().map_or_else(|| self.no_group(name), |group| self.empty(group)));
        };
        let nodes = self.nodes_of(largest);
        match filled.iter().all(|group| self.nodes_of(group) == nodes) {
            true => Ok(largest),
            false => Err(self.unclear(name, &filled)),
        }
    }

    /// The group of that name and dimension, with at least one cell; `what` is the role it was given, for the sentence.
    pub fn group_of(&self, name: &str, dimension: usize, what: &str) -> Result<&Group> {
        let called = self.called(name);
        match called.iter().find(|g| g.dimension == dimension) {
            Some(group) if !group.cells.is_empty() => Ok(group),
            Some(group) => Err(Error::input(format!("{what} \"{name}\": {}", self.empty(group)))),
            None => match called.last() {
                None => Err(Error::input(format!("{what} \"{name}\": {}", self.no_group(name)))),
                Some(_) => {
                    let kinds: Vec<String> = called.iter().map(|g| format!("one of {}", g.kind())).collect();
                    Err(Error::input(format!(
                        "{what} \"{name}\" needs a group of {}; in {} it is {}",
                        KINDS[dimension].0,
                        self.name,
                        kinds.join(" and ")
                    )))
                }
            },
        }
    }

    /// Whether any group has the name, of whatever dimension.
    pub fn has_group(&self, name: &str) -> bool {
        !self.called(name).is_empty()
    }

    /// By dimension; a group whose whole name it is comes before those whose dimension stands before the name. A side of an
    /// interface that is closed is the group itself.
    fn called(&self, name: &str) -> Vec<&Group> {
        let exact: Vec<&Group> = self.groups.iter().filter(|g| g.name == name).collect();
        if !exact.is_empty() {
            return exact;
        }
        let side_of = name.split_once(SIDE).map(|(group, _)| group).filter(|group| self.bonded.contains(*group));
        self.groups.iter().filter(|g| g.is_called(side_of.unwrap_or(name))).collect()
    }

    fn empty(&self, group: &Group) -> Error {
        let cause = self.remarks.first().map_or(String::new(), |remark| format!(": {remark}"));
        Error::input(format!("the physical group \"{}\" in {} has no elements{cause}", group.name, self.name))
    }

    fn unclear(&self, name: &str, groups: &[&Group]) -> Error {
        let kinds: Vec<String> = groups.iter().map(|g| format!("a group of {}", g.kind())).collect();
        let ways: Vec<String> = groups.iter().map(|g| format!("\"{}\"", g.full_name())).collect();
        Error::input(format!(
            "\"{name}\" is {} in {}, and not all of the same nodes: write {}",
            kinds.join(" and "),
            self.name,
            ways.join(" or ")
        ))
    }

    fn no_group(&self, name: &str) -> Error {
        let mut names: Vec<&str> = self.groups.iter().filter(|g| !g.is_a_side()).map(|g| g.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        let hint = names.iter().find_map(|other| lookalike(name, other)).unwrap_or_default();
        let more = names.len().saturating_sub(LISTED);
        let mut listed: Vec<String> = names.iter().take(LISTED).map(|name| escape::name(name).into_owned()).collect();
        listed.extend((more > 0).then(|| format!("and {more} more")));
        let have = if listed.is_empty() { "no groups at all".into() } else { listed.join(", ") };
        let name = escape::name(name);
        Error::input(format!("no physical group \"{name}\" in {}; it has: {have}{hint}", self.name))
    }
}

/// A hint where two names look the same and are not: letters with accents are one character or two in Unicode, and
/// bytes that are not UTF-8 are shown as `%E4`.
fn lookalike(wanted: &str, existing: &str) -> Option<String> {
    let spelled = |name: &str| {
        name.chars()
            .map(|c| if c.is_ascii() { c.to_string() } else { c.escape_unicode().to_string() })
            .collect::<String>()
    };
    if without_accents(wanted).is_some_and(|letters| without_accents(existing) == Some(letters)) {
        return Some(format!(
            " (\"{existing}\" looks like \"{wanted}\" and is spelled {}, not {}: copy it from the geometry)",
            spelled(existing),
            spelled(wanted)
        ));
    }
    (existing.contains('%') && without_bytes(wanted) == without_bytes(existing)).then(|| {
        format!(
            " (\"{existing}\" is not UTF-8 in the mesh: write it in this form, or save the geometry in UTF-8 and mesh again)"
        )
    })
}

/// The letters that a name has in common with its other normal form: in one an accented letter is one character outside
/// ASCII, in the other a letter and a combining mark.
fn without_accents(name: &str) -> Option<String> {
    let is_mark = |c: char| matches!(c, '\u{300}'..='\u{36f}');
    if name.is_ascii() {
        return None;
    }
    let letters: Vec<char> = name.chars().collect();
    let accented = |i: usize| letters.get(i + 1).is_some_and(|&next| is_mark(next));
    let kept = letters.iter().enumerate().filter(|&(_, &c)| !is_mark(c));
    Some(kept.map(|(i, &c)| if accented(i) || ('\u{c0}'..='\u{24f}').contains(&c) { '\u{300}' } else { c }).collect())
}

/// A name without what is outside ASCII, or stands for bytes outside ASCII.
fn without_bytes(name: &str) -> String {
    let mut rest = name;
    let mut kept = String::new();
    while let Some(c) = rest.chars().next() {
        let behind = &rest[c.len_utf8()..];
        let code = behind.get(..2).filter(|_| c == '%').and_then(|code| u8::from_str_radix(code, 16).ok());
        rest = if code.is_some_and(|byte| byte >= 0x80) { &behind[2..] } else { behind };
        if c.is_ascii() && rest.len() == behind.len() {
            kept.push(c);
        }
    }
    kept
}
