//! Tables of loads in files of their own, read into the case before anything else looks at it.

use std::path::Path;

use serde_json::{Value, json};

use crate::input::{self, Kind};
use crate::model::units::{ForceDensity, LineForce, Pressure, Time};
use crate::number::short;

/// Value in SI of a unit, or the sentence that there is no such unit.
type Unit = fn(&str) -> Result<f64, String>;

/// The units of a kind of load.
fn units_of(kind: &str) -> Option<Unit> {
    match kind {
        "pressure" | "traction" => Some(Pressure::factor),
        "body_force" => Some(ForceDensity::factor),
        "force" => Some(LineForce::factor),
        _ => None,
    }
}

/// `loads` with every `{ "law": "table", "file": F }` replaced by its `times` and `values` in SI; F starts at `folder`.
///
/// The error begins with the place in the case, `loads.top.pressure`, then comes the file's line.
pub fn inlined(loads: Value, folder: &Path) -> Result<Value, String> {
    within(loads, folder, "loads", None)
}

/// `unit`: of the load that this is the law of, if it is one.
fn within(json: Value, folder: &Path, place: &str, unit: Option<Unit>) -> Result<Value, String> {
    match json {
        Value::Object(map) if map.get("law").and_then(Value::as_str) == Some("table") => {
            let file = map.get("file").and_then(Value::as_str).map(|file| folder.join(file));
            let (Some(file), Some(unit)) = (file, unit) else { return Ok(Value::Object(map)) };
            if let Some(key) =
                ["times", "values"].iter().find(|key| map.get(**key).is_some_and(|given| !given.is_null()))
            {
                return Err(format!(
                    "{place}: a \"table\" has both \"file\" and \"{key}\": times and values stand here or in the file, so leave \
                     one out"
                ));
            }
            let (times, values) = read(&file, unit).map_err(|why| format!("{place}: {why}"))?;
            let others = map.into_iter().filter(|(key, _)| key != "file");
            Ok(others.chain([("times".into(), json!(times)), ("values".into(), json!(values))]).collect())
        }
        Value::Object(map) => {
            let inner = map.into_iter().map(|(key, value)| {
                let inner = within(value, folder, &format!("{place}.{key}"), units_of(&key))?;
                Ok((key, inner))
            });
            inner.collect::<Result<_, String>>().map(Value::Object)
        }
        Value::Array(list) => {
            let inner =
                list.into_iter().enumerate().map(|(i, value)| within(value, folder, &format!("{place}[{i}]"), None));
            inner.collect::<Result<_, String>>().map(Value::Array)
        }
        other => Ok(other),
    }
}

/// What a line is, for sentences.
const LINE: &str =
    "a line is a time and a value, as 0.5, 120: a comma, a semicolon or blanks between, a decimal point, no quotes";

/// A line's number and what stands on it before `#`.
type Line<'a> = (usize, &'a str);

/// Two columns, a time and a value, with commas, semicolons or blanks between; `#` starts a comment, and the first line may
/// be a heading. Units in the heading, as in `t [ms], p [kPa]`, hold for the columns; without them they are SI.
fn read(file: &Path, unit: Unit) -> Result<(Vec<f64>, Vec<f64>), String> {
    let name = file.display();
    let text = input::read_text(file, Kind::Table).map_err(|why| format!("cannot read the table {name}: {why}"))?;
    let text = text.trim_start_matches('\u{feff}');
    let at = |(number, why): (usize, String)| format!("{name}, line {number}: {why}");
    let lines: Vec<Line> = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let heading = lines.first().filter(|(_, line)| is_heading(line));
    let first = lines.first().map_or(0, |(number, _)| *number);
    if !heading.is_some_and(|(_, line)| line.contains('[')) {
        no_units_in_comments(text, first, unit).map_err(at)?;
    }
    let factors = match heading {
        Some((number, line)) => factors(line, unit).map_err(|why| at((*number, why)))?,
        None => [1.; 2],
    };
    let rows = rows(&lines[usize::from(heading.is_some())..], factors).map_err(at)?;
    match rows.len() {
        0 | 1 => Err(format!("{name}: a table needs two lines of numbers or more, and it has {}; {LINE}", rows.len())),
        _ => Ok(rows.into_iter().map(|[time, value]| (time, value)).unzip()),
    }
}

/// A first line that begins with a digit, a sign or a point is data, and refused as such if it cannot be read: a heading is
/// left out. One that begins otherwise is a heading if it has units in brackets, or if no word of it is or begins as a
/// number.
fn is_heading(line: &str) -> bool {
    let is_number = |word: &str| {
        word.starts_with(|c: char| c.is_numeric() || "+-.\u{2212}".contains(c)) || word.parse::<f64>().is_ok()
    };
    let mut words = columns(line);
    !words.next().is_some_and(is_number) && (line.contains('[') || !words.any(is_number))
}

/// (time, value) of each line in SI; `factors` are the values in SI of the columns' units.
fn rows(lines: &[Line], factors: [f64; 2]) -> Result<Vec<[f64; 2]>, (usize, String)> {
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for &(number, line) in lines {
        let row = row(line).map_err(|why| (number, why))?;
        let before = rows.last().map_or(0., |[time, _]| *time);
        if row[0] < before || (row[0] == before && !rows.is_empty()) {
            let last = rows.last().map_or(String::new(), |[time, _]| format!(" after {}", short(*time)));
            let why = format!(
                "its time is {}{last}: the times of a table must ascend, each later than the one before, from 0 or later",
                short(row[0])
            );
            return Err((number, why));
        }
        rows.push(row);
    }
    let in_si = |row: [f64; 2]| [row[0] * factors[0], row[1] * factors[1]];
    let too_large = |row: &[f64; 2]| in_si(*row).iter().any(|number| !number.is_finite());
    match rows.iter().position(too_large) {
        Some(i) => Err((lines[i].0, format!("\"{}\" is more in SI units than a computer can hold", lines[i].1))),
        None => Ok(rows.into_iter().map(in_si).collect()),
    }
}

fn row(line: &str) -> Result<[f64; 2], String> {
    let number = |word: &str| {
        let finite = word.parse().ok().filter(|v: &f64| v.is_finite());
        finite.map(|v| v + 0.).ok_or_else(|| format!("\"{word}\" is no number; {LINE}"))
    };
    match columns(line).collect::<Vec<_>>()[..] {
        [time, value] => Ok([number(time)?, number(value)?]),
        [_] => Err(format!("\"{line}\" has one column, and not a time and a value; {LINE}")),
        ref words => Err(format!("\"{line}\" has {} columns, and not a time and a value; {LINE}", words.len())),
    }
}

/// Values in SI of the units between the heading's brackets, 1 where it gives none.
fn factors(heading: &str, unit: Unit) -> Result<[f64; 2], String> {
    let brackets: Vec<&str> =
        heading.split('[').skip(1).filter_map(|rest| Some(rest.split_once(']')?.0.trim())).collect();
    let strange = || {
        format!(
            "its heading is \"{heading}\": write a unit in square brackets to both columns, as t [ms], p [kPa], or one word for \
             each column, as t, p, where they are in SI"
        )
    };
    match brackets[..] {
        [time, value] => Ok([Time::factor(time)?, unit(value)?]),
        [] if columns(heading).count() == 2 && columns(heading).all(|word| is_name(word, unit)) => Ok([1.; 2]),
        _ => Err(strange()),
    }
}

/// A word without a unit in it: `t`, `pressure_2`, but not `p(kPa)`, `p/kPa`, `kPa`, `p_kPa`.
fn is_name(word: &str, unit: Unit) -> bool {
    let is_unit = |part: &str| Time::factor(part).is_ok() || unit(part).is_ok();
    word.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c)) && !word.split(['_', '-', '.']).any(is_unit)
}

/// Errors: a comment up to line `first`, where heading or numbers begin, holds units as a heading does.
fn no_units_in_comments(text: &str, first: usize, unit: Unit) -> Result<(), (usize, String)> {
    let is_unit = |word: &str| Time::factor(word.trim()).is_ok() || unit(word.trim()).is_ok();
    let has_units = |comment: &str| {
        let inside = comment.split(['[', '(']).skip(1).filter_map(|rest| Some(rest.split_once([']', ')'])?.0));
        inside.filter(|word| is_unit(word)).count() > 0
    };
    let comments = text.lines().enumerate().take(first).filter_map(|(i, line)| Some((i + 1, line.split_once('#')?.1)));
    match comments.into_iter().find(|(_, comment)| has_units(comment)) {
        None => Ok(()),
        Some((number, _)) => Err((
            number,
            "these units are in a comment, which is not read: take the # away, as in t [ms], p [kPa]".into(),
        )),
    }
}

fn columns(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty())
}
