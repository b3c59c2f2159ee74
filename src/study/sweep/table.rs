//! The table of a sweep: a row a run.

use super::plan::Variant;
use crate::number::readable;
use crate::results::csv;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// One run: what was varied, and what came out of it.
pub struct Row {
    pub name: String,
    /// "done", "no_convergence", "interrupted", "refused" (it cannot start) or "not run"
    pub status: String,
    /// (column, value as it is written)
    varied: Vec<(String, String)>,
    found: Vec<(String, String)>,
}

impl Row {
    pub fn new(variant: &Variant) -> Row {
        let varied = variant.values.iter().map(|(name, value)| (name.clone(), plain(value))).collect();
        Row { name: variant.name.clone(), status: "not run".into(), varied, found: vec![] }
    }

    pub fn is_done(&self) -> bool {
        self.status == "done"
    }

    /// Takes the status of a run's summary and, if it is done, its frequencies, contact, count of warnings and peaks
    /// (SI).
    pub fn take(&mut self, summary: &Value) {
        self.status = plain(&summary["status"]);
        if !self.is_done() {
            return;
        }
        let list = |key: &str| summary[key].as_array().map_or(&[][..], Vec::as_slice);
        let frequencies = list("frequencies_hz").iter().take(2).enumerate();
        self.found = frequencies.map(|(k, f)| (format!("f{}", k + 1), plain(f))).collect();
        for key in ["max_open", "max_slip"] {
            self.found.push((key.into(), plain(&summary["contact"][key])));
        }
        self.found.push((WARNINGS.into(), list("warnings").len().to_string()));
        for (probe, peaks) in summary["peaks"].as_object().into_iter().flatten() {
            for (component, peak) in peaks.as_object().into_iter().flatten() {
                self.found.push((format!("{probe}.{component}"), plain(&peak["value"])));
            }
        }
    }

    fn cells(&self) -> impl Iterator<Item = (&str, &str)> {
        let known = [("run", self.name.as_str()), ("status", self.status.as_str())];
        let others = self.varied.iter().chain(&self.found).map(|(column, value)| (column.as_str(), value.as_str()));
        known.into_iter().chain(others)
    }

    fn number(&self, column: &str) -> Option<f64> {
        self.found.iter().find(|(c, _)| c == column).and_then(|(_, v)| v.parse().ok())
    }
}

const WARNINGS: &str = "warnings";

/// Without quotes.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// How often; nothing where never.
pub fn warned(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => "1 warning".into(),
        n => format!("{n} warnings"),
    }
}

/// Comma-separated; every column that some row has, in order of first appearance.
pub fn csv(rows: &[Row]) -> String {
    let mut seen = BTreeSet::new();
    let columns: Vec<&str> = rows.iter().flat_map(Row::cells).map(|(c, _)| c).filter(|c| seen.insert(*c)).collect();
    let mut text = columns.iter().map(|c| csv::cell(c)).collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let cell = |column: &&str| row.cells().find(|(c, _)| c == column).map_or("".into(), |(_, v)| csv::cell(v));
        text += &(columns.iter().map(cell).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

/// For the screen: run, status, gap, slip, the first probe's peak, and a mark where there are warnings.
pub fn text(rows: &[Row]) -> String {
    let width = rows.iter().map(|row| row.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        let mut line = format!("{:width$}  {:<14}", row.name, row.status);
        if let (Some(gap), Some(slip)) = (row.number("max_open"), row.number("max_slip")) {
            let _ = write!(line, " gap {} mm  slip {} mm", readable(1e3 * gap), readable(1e3 * slip));
        }
        if let Some((column, peak)) = row.found.iter().find(|(c, _)| c.ends_with(".uy")) {
            let _ = write!(line, "  {column} {} mm", readable(1e3 * peak.parse().unwrap_or(f64::NAN)));
        }
        let _ = write!(line, "  {}", warned(row.number(WARNINGS).unwrap_or(0.) as usize));
        text += line.trim_end();
        text.push('\n');
    }
    text
}
