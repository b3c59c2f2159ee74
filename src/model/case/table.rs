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
                map.insert("times".into(), json!(times));
                map.insert("values".into(), json!(values));
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

/// Two columns, a time [s] and a value [SI], with commas, semicolons or blanks between; `#` starts a comment, and the
/// first line may be a heading.
fn read(file: &Path) -> Result<(Vec<f64>, Vec<f64>), String> {
    let name = file.display();
    let text = std::fs::read_to_string(file).map_err(|why| format!("cannot read the table {name}: {why}"))?;
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let lines: Vec<_> = lines
        .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let heading = lines.first().is_some_and(|(_, line)| columns(line).all(|word| word.parse::<f64>().is_err()));
    let rows = lines[usize::from(heading)..].iter().map(|(number, line)| {
        let row: Option<Vec<f64>> =
            columns(line).map(|word| word.parse().ok().filter(|v: &f64| v.is_finite())).collect();
        match row.as_deref() {
            Some([time, value]) => Ok((*time, *value)),
            _ => Err(format!("{name}, line {number}: \"{line}\" is not a time [s] and a value [SI]")),
        }
    });
    rows.collect()
}

fn columns(line: &str) -> impl Iterator<Item = &str> {
    line.split([',', ';', ' ', '\t']).filter(|word| !word.is_empty())
}
