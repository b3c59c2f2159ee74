//! Files that are whole or not there: written under another name, then renamed.

use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// Writes `content` so that a reader, or a kill at any moment, finds the old file or the new one.
pub fn replace(path: &Path, content: &[u8]) -> Result<()> {
    let part = part_of(path);
    std::fs::write(&part, content).and_then(|()| std::fs::rename(&part, path)).map_err(|e| {
        let _ = std::fs::remove_file(&part);
        not_written(path, &e)
    })
}

/// A hidden name beside it that no file of the user's has: `.histories.csv.4711.part`.
fn part_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

pub fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|e| not_written(path, &e))
}

pub fn not_written(path: &Path, why: &std::io::Error) -> Error {
    Error::input(format!("{} cannot be written: {why}; choose another folder with --out", path.display()))
}
