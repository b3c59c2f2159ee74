//! The table of a sweep: a row a run, from the summaries in the folders.

use super::plan::Variant;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

/// (column, value as it is written) of one run.
pub type Row = Vec<(String, String)>;

/// What a run left behind; none where there is nothing, or nothing whole.
pub fn summary(folder: &Path) -> Option<Value> {
    serde_json::from_str(&std::fs::read_to_string(folder.join("summary.json")).ok()?).ok()
}

/// Run, status, what was varied, frequencies, contact, all peaks (SI). Runs without an end have the first of these only.
pub fn rows(variants: &[Variant], folder: &Path) -> Vec<Row> {
    variants.iter().map(|variant| row(variant, summary(&folder.join(&variant.name)))).collect()
}

fn row(variant: &Variant, summary: Option<Value>) -> Row {
    let status = summary.as_ref().and_then(|s| s["status"].as_str()).unwrap_or("not run").to_string();
    let varied = variant.values.iter().map(|(name, value)| (name.clone(), plain(value)));
    let mut row: Row = [("run".to_string(), variant.name.clone()), ("status".into(), status.clone())]
        .into_iter()
        .chain(varied)
        .collect();
    let Some(summary) = summary.filter(|_| status == "done") else { return row };
    for k in 0..2 {
        row.push((format!("f{}", k + 1), plain(&summary["frequencies_hz"][k])));
    }
    for key in ["max_open", "max_slip"] {
        row.push((key.into(), plain(&summary["contact"][key])));
    }
    for (probe, peaks) in summary["peaks"].as_object().into_iter().flatten() {
        for (component, peak) in peaks.as_object().into_iter().flatten() {
            row.push((format!("{probe}.{component}"), plain(&peak["value"])));
        }
    }
    row
}

/// Without quotes.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// Comma-separated, the columns of the longest row.
pub fn csv(rows: &[Row]) -> String {
    let longest = rows.iter().max_by_key(|row| row.len());
    let columns: Vec<&String> = longest.into_iter().flatten().map(|(column, _)| column).collect();
    let quoted = |text: &str| match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_string(),
    };
    let mut text = columns.iter().map(|c| quoted(c)).collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let cell = |column: &&String| row.iter().find(|(c, _)| c == *column).map_or(String::new(), |(_, v)| quoted(v));
        text += &(columns.iter().map(cell).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

/// For the screen: run, status, gap, slip, and the first probe's peaks.
pub fn text(rows: &[Row]) -> String {
    let width = rows.iter().map(|row| row[0].1.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        let value = |column: &str| row.iter().find(|(c, _)| c == column).and_then(|(_, v)| v.parse::<f64>().ok());
        let _ = write!(text, "{:width$}  {:<14}", row[0].1, row[1].1);
        if let (Some(gap), Some(slip)) = (value("max_open"), value("max_slip")) {
            let _ = write!(text, " gap {:8.4} mm  slip {:8.4} mm", 1e3 * gap, 1e3 * slip);
        }
        if let Some((column, peak)) = row.iter().find(|(c, _)| c.ends_with(".uy")) {
            let _ = write!(text, "  {column} {:9.4} mm", 1e3 * peak.parse().unwrap_or(f64::NAN));
        }
        text.push('\n');
    }
    text
}
