//! The table that is printed.

use std::fmt::Write;

/// An amount beside another one.
pub struct Row {
    pub what: &'static str,
    pub unknowns: usize,
    pub joint_points: usize,
    pub value: String,
    pub beside: String,
    pub reference: String,
    pub ratio: f64,
    /// what the ratio should not exceed, where there is a goal
    pub goal: Option<f64>,
}

const HEADINGS: [&str; 8] = ["what", "unknowns", "joint points", "median", "beside", "median", "ratio", "goal"];

impl Row {
    fn cells(&self) -> [String; 8] {
        let count = |n: usize| if n == 0 { String::new() } else { n.to_string() };
        [
            self.what.into(),
            count(self.unknowns),
            count(self.joint_points),
            self.value.clone(),
            self.beside.clone(),
            self.reference.clone(),
            format!("{:.2}", self.ratio),
            self.goal.map_or(String::new(), |g| format!("<= {g}{}", if self.ratio <= g { "" } else { " MISSED" })),
        ]
    }
}

/// Three digits at least.
pub fn seconds(s: f64) -> String {
    let digits = |x: f64| if x < 10. { 2 } else { 1 };
    if s < 1. { format!("{:.*} ms", digits(1e3 * s), 1e3 * s) } else { format!("{s:.*} s", digits(s)) }
}

/// Machine and table, in Markdown with straight columns.
pub fn text(rows: &[Row]) -> String {
    let lines: Vec<[String; 8]> = [HEADINGS.map(String::from)].into_iter().chain(rows.iter().map(Row::cells)).collect();
    let width: Vec<usize> = (0..8).map(|c| lines.iter().map(|l| l[c].len()).max().unwrap_or(0)).collect();
    let mut text = format!("{}\n\n", machine());
    for (number, cells) in lines.iter().enumerate() {
        for (cell, width) in cells.iter().zip(&width) {
            let _ = write!(text, "| {cell:width$} ");
        }
        text += "|\n";
        if number == 0 {
            width.iter().for_each(|w| text += &format!("|{}", "-".repeat(w + 2)));
            text += "|\n";
        }
    }
    text
}

fn machine() -> String {
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        processors.lines().find_map(|l| l.strip_prefix("model name")).map(|l| l.trim_start_matches([' ', '\t', ':']));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{}, {cores} cores; coralpipe {}", name.unwrap_or("a processor"), env!("CARGO_PKG_VERSION"))
}
