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

/// Removes what a process that was killed left on its way into the folder.
pub fn remove_parts(folder: &Path) {
    let is_part = |name: &str| {
        let process = name.strip_prefix('.').and_then(|n| n.strip_suffix(".part")).and_then(|n| n.rsplit_once('.'));
        process.is_some_and(|(_, id)| !id.is_empty() && id.bytes().all(|b| b.is_ascii_digit()))
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(is_part) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

pub fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|e| not_written(path, &e))
}

pub fn not_written(path: &Path, why: &std::io::Error) -> Error {
    Error::input(format!("{} cannot be written: {why}; choose another folder with --out", path.display()))
}
