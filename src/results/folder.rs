//! The output folder of a case, and what becomes of the results of an earlier run.
//!
//! A new run moves them into `previous/` and removes that only when it is done itself: finished results survive any
//! number of runs that fail, and a kill at any moment, after which the next run continues or clears what is left.

use super::file;
use super::foreign::{is_of_a_run, refuse_foreign, refuse_foreign_frames};
use super::previous::{self, MOVING, PREVIOUS};
use super::run_files::SUMMARY;
pub use super::run_files::{STATUS, summary};
use crate::{Error, Result};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

pub struct Folder {
    path: PathBuf,
    name: String,
    /// the folder itself, locked for this process until it ends, however it ends; none where the disk knows no locks
    lock: Option<File>,
}

/// How much the results in a folder are worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Worth {
    Nothing,
    /// a run that was killed
    CutShort,
    /// a run that was interrupted or found no convergence
    Ended,
    Done,
}

impl Folder {
    /// Clears a folder, which is made if its parent exists, of results: they go to `previous/`, unless better ones are
    /// there.
    ///
    /// Errors: it cannot be written, holds things that are no results, or another run writes into it.
    pub fn prepare(path: &Path, name: &str) -> Result<Folder> {
        file::create_folder_within(path)?;
        refuse_foreign(path)?;
        refuse_foreign_frames(path)?;
        let folder = Folder { path: path.into(), name: name.into(), lock: claim(path)? };
        let (here, entries) = (worth(path), folder.entries());
        if folder.file(MOVING).exists() || (here > Worth::Nothing && here >= worth(&folder.file(PREVIOUS))) {
            previous::keep(path, &entries)?;
        } else if here > Worth::Nothing {
            entries.iter().try_for_each(|entry| file::remove(&folder.file(entry)))?;
        }
        Ok(folder)
    }

    /// The run is done: the results before it are no longer needed.
    pub fn remove_previous(&self) -> Result<()> {
        previous::remove(&self.path)
    }

    pub fn has_previous(&self) -> bool {
        self.file(PREVIOUS).exists()
    }

    /// Error: the folder was removed or replaced since the run began, or one of the `files` it wrote there.
    pub fn refuse_lost(&self, files: &[&str]) -> Result<()> {
        let lost = match &self.lock {
            Some(lock) if !is_at(lock, &self.path) => Some(self.path.clone()),
            _ => files.iter().map(|name| self.file(name)).find(|file| !file.exists()),
        };
        lost.map_or(Ok(()), |path| Err(file::lost(&path)))
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The tables and the series that a run has written, with their sizes [bytes].
    pub fn sizes(&self) -> BTreeMap<String, u64> {
        let names = self.entries().into_iter().filter(|name| name != SUMMARY);
        names.filter_map(|name| size(&self.file(&name)).map(|bytes| (name, bytes))).collect()
    }

    pub fn write_summary(&self, content: &str) -> Result<()> {
        self.refuse_lost(&[])?;
        file::replace(&self.file(SUMMARY), content.as_bytes())
    }

    /// What runs have written here, in the order in which it may go: the summary, which says that the others are whole,
    /// the series before its frames, and the status file last, since it says that there is something.
    fn entries(&self) -> Vec<String> {
        let files = std::fs::read_dir(&self.path).into_iter().flatten().flatten();
        let series = files.filter_map(|f| f.file_name().into_string().ok()).filter(|name| name.ends_with(".pvd"));
        let others = ["frames", "histories.csv", "rings.csv", STATUS].map(String::from);
        let all = [SUMMARY.to_string()].into_iter().chain(series).chain(others);
        all.filter(|entry| self.file(entry).symlink_metadata().is_ok()).collect()
    }
}

/// Whether the folder that is open is the one at this path.
fn is_at(open: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: std::io::Result<std::fs::Metadata>| found.ok().map(|m| (m.dev(), m.ino()));
    identity(open.metadata()) == identity(path.metadata())
}

/// Clears a folder whose run is done of what a kill may have left in it; not while a run writes into it. What cannot be
/// removed stays: the results are whole all the same.
pub fn tidy(path: &Path) {
    if let Ok(Some(_lock)) = claim(path) {
        let _ = previous::remove(path).and_then(|()| file::remove(&path.join(MOVING)));
    }
}

/// Whether all that a summary names is there and whole; frames count only where they are asked for.
pub fn is_whole(folder: &Path, summary: &Value, frames: bool) -> bool {
    let Some(files) = summary["files"].as_object() else { return false };
    let count = || std::fs::read_dir(folder.join("frames")).map_or(0, |entries| entries.count() as u64);
    let written = summary["frames"].as_u64();
    files.iter().all(|(name, bytes)| (name.ends_with(".pvd") && !frames) || size(&folder.join(name)) == bytes.as_u64())
        && (!frames || written.is_some_and(|written| written > 0 && count() >= written))
}

/// Of a file [bytes].
fn size(path: &Path) -> Option<u64> {
    path.metadata().ok().filter(|m| m.is_file()).map(|m| m.len())
}

/// Locks a folder for this process and clears it of files that killed processes left half-written; none where the disk
/// knows no locks.
///
/// Error: another process has it.
pub fn claim(path: &Path) -> Result<Option<File>> {
    let lock = lock(path)?;
    if lock.is_some() {
        file::remove_parts(path);
    }
    Ok(lock)
}

/// Locks the folder for this process, which leaves no file behind; none where the disk knows no locks.
///
/// Error: another process has it.
fn lock(path: &Path) -> Result<Option<File>> {
    let Ok(folder) = File::open(path) else { return Ok(None) };
    match folder.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Error::input(format!(
            "another run is writing into {}: let it end, or choose another folder with --out",
            path.display()
        ))),
        Err(TryLockError::Error(_)) => Ok(None),
        Ok(()) => Ok(Some(folder)),
    }
}

fn worth(folder: &Path) -> Worth {
    match summary(folder) {
        Some(summary) if summary["status"] == "done" => Worth::Done,
        Some(_) => Worth::Ended,
        None if folder.join(STATUS).exists() || has_part_of_a_run(folder) => Worth::CutShort,
        None => Worth::Nothing,
    }
}

fn has_part_of_a_run(folder: &Path) -> bool {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    names.into_iter().any(|name| name.to_str().is_some_and(|name| is_of_a_run(folder, name)))
}
