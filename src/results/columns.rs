//! Tables that a run wrote, read back: `histories.csv` and `rings.csv`.

use super::csv;
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// A table of comma-separated cells under a line of names.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    path: PathBuf,
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Columns {
    pub fn read(path: &Path) -> Result<Columns> {
        let text = std::fs::read_to_string(path)
            .map_err(|why| Error::input(format!("{} cannot be read: {why}", path.display())))?;
        let mut rows = csv::rows(&text);
        let names = if rows.is_empty() { vec![] } else { rows.remove(0) };
        Ok(Columns { path: path.into(), names, rows })
    }

    /// The cells of a column.
    ///
    /// Errors: there is no such column.
    pub fn texts(&self, name: &str) -> Result<Vec<&str>> {
        let at = self.names.iter().position(|n| n == name).ok_or_else(|| {
            let (path, names) = (self.path.display(), self.names.join(", "));
            Error::input(format!("{path} has no column \"{name}\"; it has: {names}"))
        })?;
        Ok(self.rows.iter().map(|row| row.get(at).map_or("", String::as_str)).collect())
    }

    /// The numbers of a column.
    ///
    /// Errors: there is no such column, or it holds something else.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let number = |text: &&str| {
            text.parse().map_err(|_| {
                Error::input(format!("{}: \"{text}\" in column \"{name}\" is no number", self.path.display()))
            })
        };
        self.texts(name)?.iter().map(number).collect()
    }
}
