//! Tables of loads in files of their own, read into the case before anything else looks at it.

use std::path::Path;

use serde_json::{Value, json};

/// `loads` with every `{ "law": "table", "file": F }` replaced by its `times` and `values`; F starts at `folder`.
pub fn inlined(loads: Value, folder: &Path) -> Result<Value, String> {
    match loads {
        Value::Object(mut map) => {
            let file = map.get("file").and_then(Value::as_str).map(|file| folder.join(file));
            if let (Some(file), Some("table"), false) =
                (file, map.get("law").and_then(Value::as_str), map.contains_key("times") || map.contains_key("values"))
            {
                let (times, values) = read(&file)?;
                map.shift_remove("file");
                map.insert("times".into(), times);
                map.insert("values".into(), values);
                return Ok(Value::Object(map));
            }
            let inner = map.into_iter().map(|(key, value)| Ok((key, inlined(value, folder)?)));
            inner.collect::<Result<_, String>>().map(Value::Object)
        }
        Value::Array(list) => {
            let inner = list.into_iter().map(|value| inlined(value, folder));
            inner.collect::<Result<_, String>>().map(Value::Array)
        }
        other => Ok(other),
    }
}

/// Two columns, a time and a value, with commas, semicolons or blanks between; `#` starts a comment, and the first line may
/// be a heading. Units in the heading, as in `t [ms], p [kPa]`, hold for the columns; without them they are SI.
fn read(file: &Path) -> Result<(Value, Value), String> {
    let name = file.display();
    let text = std::fs::read_to_string(file).map_err(|why| format!("cannot read the table {name}: {why}"))?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let lines: Vec<_> = lines
        .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let heading = lines.first().filter(|(_, line)| columns(line).all(|word| word.parse::<f64>().is_err()));
    let units = match heading.map(|(_, line)| units(line)) {
        None => None,
        Some(units) if units.is_empty() => None,
        Some(units) if units.len() == 2 => Some([units[0], units[1]]),
        Some(_) => {
            return Err(format!(
                "{name}: its heading must give a unit to both columns, as t [ms], p [kPa], or to none"
            ));
        }
    };
    let rows = lines[usize::from(heading.is_some())..].iter().map(|(number, line)| {
        let row: Option<Vec<f64>> =
            columns(line).map(|word| word.parse().ok().filter(|v: &f64| v.is_finite())).collect();
        match row.as_deref() {
            Some([time, value]) => Ok((*time, *value)),
            _ => Err(format!("{name}, line {number}: \"{line}\" is not a time [s] and a value [SI]")),
        }
    });
    let (times, values): (Vec<f64>, Vec<f64>) = rows.collect::<Result<_, String>>()?;
    let with_unit = |numbers: Vec<f64>, i: usize| match units {
        None => json!(numbers),
        Some(units) => numbers.iter().map(|x| json!(format!("{x} {}", units[i]))).collect(),
    };
    Ok((with_unit(times, 0), with_unit(values, 1)))
}

/// What stands between brackets.
fn units(heading: &str) -> Vec<&str> {
    heading.split('[').skip(1).filter_map(|rest| Some(rest.split_once(']')?.0.trim())).collect()
}

fn columns(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty())
}
