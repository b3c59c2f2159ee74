//! The two files of a run that say what the others are worth.

use crate::input::{self, Kind};
use serde_json::Value;
use std::path::Path;

/// Written last: its presence says that the run came to an end, its status to which.
pub const SUMMARY: &str = "summary.json";
/// Written first: its presence says that the other files are a run's.
pub const STATUS: &str = "run.sta";

/// The summary of the last run that came to an end in a folder; none if there is none that can be read.
pub fn summary(folder: &Path) -> Option<Value> {
    serde_json::from_slice(&input::read(&folder.join(SUMMARY), Kind::Record).ok()?).ok()
}
