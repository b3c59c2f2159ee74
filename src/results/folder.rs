//! The output folder of a case, and what becomes of the results of an earlier run.
//!
//! A new run moves them into `previous/` and removes that only when it is done itself: finished results survive any
//! number of runs that fail, and a kill at any moment, of which the next run picks up the pieces.

use super::file;
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

/// Its presence says that the run came to an end, its status to which.
const SUMMARY: &str = "summary.json";
/// The first file of a run: its presence says that the others are a run's.
pub const STATUS: &str = "run.sta";
const PREVIOUS: &str = "previous";
/// `previous/` while results are on their way there.
const MOVING: &str = "previous.part";

/// What may be in a folder before its first run: mode shapes, and the log of a batch.
const BESIDE: [&str; 2] = ["modes", "batch.log"];

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
    /// Makes the folder and clears it of results: they go to `previous/`, unless better ones are there.
    ///
    /// Errors: it cannot be written, holds things that are no results, or another run writes into it.
    pub fn prepare(path: &Path, name: &str) -> Result<Folder> {
        file::create_folder(path)?;
        refuse_foreign(path)?;
        let folder = Folder { path: path.into(), name: name.into(), lock: lock(path)? };
        if folder.lock.is_some() {
            file::remove_parts(path);
        }
        let (previous, moving) = (folder.file(PREVIOUS), folder.file(MOVING));
        let here = worth(path);
        if moving.exists() || (here > Worth::Nothing && here >= worth(&previous)) {
            file::create_folder(&moving)?;
            for entry in folder.entries() {
                let from = folder.file(&entry);
                std::fs::rename(&from, moving.join(&entry)).map_err(|e| file::not_written(&from, &e))?;
            }
            remove(&previous)?;
            std::fs::rename(&moving, &previous).map_err(|e| file::not_written(&previous, &e))?;
        } else if here > Worth::Nothing {
            folder.entries().iter().try_for_each(|entry| remove(&folder.file(entry)))?;
        }
        Ok(folder)
    }

    /// The run is done: the results before it are no longer needed.
    pub fn remove_previous(&self) -> Result<()> {
        remove(&self.file(PREVIOUS))
    }

    pub fn has_previous(&self) -> bool {
        self.file(PREVIOUS).exists()
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
        file::replace(&self.file(SUMMARY), content.as_bytes())
    }

    /// What runs have written here. The series before its frames, so that none is left that names missing ones; the
    /// status file last, since it tells that there is something.
    fn entries(&self) -> Vec<String> {
        let files = std::fs::read_dir(&self.path).into_iter().flatten().flatten();
        let series = files.filter_map(|f| f.file_name().into_string().ok()).filter(|name| name.ends_with(".pvd"));
        let others = [SUMMARY, "frames", "histories.csv", "rings.csv", STATUS].map(String::from);
        series.chain(others).filter(|entry| self.file(entry).exists()).collect()
    }
}

/// The summary of the last run that came to an end there.
pub fn summary(folder: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(folder.join(SUMMARY)).ok()?).ok()
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

/// A folder that is not empty must show that its results are ours: else a slip such as `--out /` writes among other
/// things.
pub fn refuse_foreign(path: &Path) -> Result<()> {
    let ours = |name: &str| path.join(name).exists();
    if ours(STATUS)
        || ours(PREVIOUS)
        || ours(MOVING)
        || summary(path).is_some_and(|s| s["inputs"]["coralpipe"].is_string())
    {
        return Ok(());
    }
    refuse_filled(path, &BESIDE, "folder of results")
}

/// A folder may hold nothing that is not `beside`: else it is none of this `kind`.
pub fn refuse_filled(path: &Path, beside: &[&str], kind: &str) -> Result<()> {
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
    let mut foreign: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    foreign.retain(|name| !beside.contains(&name.as_str()));
    foreign.sort();
    let more = if foreign.len() > 4 { format!(" and {} more", foreign.len() - 4) } else { String::new() };
    match foreign.is_empty() {
        true => Ok(()),
        false => Err(Error::input(format!(
            "{} is no {kind}: it holds {}{more}; choose a new or an empty folder with --out",
            path.display(),
            foreign[..foreign.len().min(4)].join(", ")
        ))),
    }
}

/// Locks the folder for this process, which leaves no file behind; none where the disk knows no locks.
///
/// Error: another process has it.
pub fn lock(path: &Path) -> Result<Option<File>> {
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
        None if folder.join(STATUS).exists() => Worth::CutShort,
        None => Worth::Nothing,
    }
}

/// Removes a file or a folder, if it is there.
fn remove(path: &Path) -> Result<()> {
    let removed = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    match removed {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(file::not_written(path, &e)),
        _ => Ok(()),
    }
}
