//! The folder of a sweep: the table, and a folder of results a run.

use crate::Result;
use crate::input::{self, Kind};
use crate::results::folder::claim;
use crate::results::{file, foreign};
use serde_json::{Value, json};
use std::fs::File;
use std::path::{Path, PathBuf};

pub struct Shelf {
    path: PathBuf,
    /// a sentence where the table that was there is another plan's
    pub before: Option<String>,
    /// for this process until it ends; none where the disk knows no locks
    _lock: Option<File>,
}

const TABLE: &str = "sweep.csv";
/// Its presence says that the folder is a sweep's, its content which plan's.
const RECORD: &str = "sweep.json";

impl Shelf {
    /// A folder that is not empty must be a sweep's.
    pub fn refuse_foreign(path: &Path) -> Result<()> {
        match plan_of(path) {
            Some(_) => Ok(()),
            None => foreign::refuse_filled(path, "folder of a sweep"),
        }
    }

    /// Errors: the folder cannot be written, is foreign, or another sweep writes into it.
    pub fn open(path: &Path, plan: &Path) -> Result<Shelf> {
        Shelf::refuse_foreign(path)?;
        file::create_folder(path)?;
        let lock = claim(path)?;
        let plan = std::path::absolute(plan).unwrap_or_else(|_| plan.into()).display().to_string();
        let before = plan_of(path).filter(|before| *before != plan).map(|before| {
            format!(
                "the table in {} is of another plan, {before}; that of this one replaces it: --out DIR keeps both",
                path.display()
            )
        });
        let record = json!({ "coralpipe": env!("CARGO_PKG_VERSION"), "plan": plan });
        file::replace(&path.join(RECORD), format!("{record:#}\n").as_bytes())?;
        Ok(Shelf { path: path.into(), before, _lock: lock })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn write_table(&self, csv: &str) -> Result<()> {
        file::replace(&self.path.join(TABLE), csv.as_bytes())
    }
}

/// The plan that the folder is of.
fn plan_of(folder: &Path) -> Option<String> {
    let record: Value = serde_json::from_slice(&input::read(&folder.join(RECORD), Kind::Record).ok()?).ok()?;
    record["coralpipe"].as_str().and(record["plan"].as_str()).map(String::from)
}
