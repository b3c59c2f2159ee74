//! The output folder of a case, and what becomes of the results of an earlier run.
//!
//! A new run moves them into `previous/` and removes that only when it is done itself: finished results survive any
//! number of runs that fail, and a kill at any moment, of which the next run picks up the pieces.

use super::file;
use crate::Result;
use std::path::{Path, PathBuf};

pub struct Folder {
    path: PathBuf,
    name: String,
}

/// Its presence says that the run came to an end, its status to which.
const SUMMARY: &str = "summary.json";
/// The first file of a run: its presence says that the others are a run's.
pub const STATUS: &str = "run.sta";
const PREVIOUS: &str = "previous";
/// `previous/` while results are on their way there.
const MOVING: &str = "previous.part";

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
    pub fn prepare(path: &Path, name: &str) -> Result<Folder> {
        file::create_folder(path)?;
        let folder = Folder { path: path.into(), name: name.into() };
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

    pub fn write_summary(&self, content: &str) -> Result<()> {
        file::replace(&self.file(SUMMARY), content.as_bytes())
    }

    /// What runs have written here. The series before its frames, so that none is left that names missing ones; the status
    /// file last, since it tells that there is something.
    fn entries(&self) -> Vec<String> {
        let files = std::fs::read_dir(&self.path).into_iter().flatten().flatten();
        let series = files.filter_map(|f| f.file_name().into_string().ok()).filter(|name| name.ends_with(".pvd"));
        let others = [SUMMARY, "frames", "histories.csv", "rings.csv", STATUS].map(String::from);
        series.chain(others).filter(|entry| self.file(entry).exists()).collect()
    }
}

fn worth(folder: &Path) -> Worth {
    let summary = std::fs::read(folder.join(SUMMARY)).ok();
    match summary.and_then(|text| serde_json::from_slice::<serde_json::Value>(&text).ok()) {
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
