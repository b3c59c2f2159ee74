//! The output folder of a case, and what becomes of the results of an earlier run.
//!
//! A new run moves them into `previous/` and removes that only when it is done: results survive a run that fails.

use super::file;
use crate::Result;
use std::path::{Path, PathBuf};

pub struct Folder {
    path: PathBuf,
    name: String,
}

/// Its presence says that the run came to its end.
const SUMMARY: &str = "summary.json";
const PREVIOUS: &str = "previous";

impl Folder {
    /// Makes the folder and clears it of the results of this case, kept in `previous/`.
    pub fn prepare(path: &Path, name: &str) -> Result<Folder> {
        file::create_folder(path)?;
        let folder = Folder { path: path.into(), name: name.into() };
        let move_aside = folder.path.join(SUMMARY).exists();
        if move_aside {
            folder.remove_previous()?;
            file::create_folder(&folder.path.join(PREVIOUS))?;
        }
        for entry in folder.entries() {
            let from = folder.path.join(&entry);
            if from.exists() {
                let done = match move_aside {
                    true => std::fs::rename(&from, folder.path.join(PREVIOUS).join(&entry)),
                    false => remove(&from),
                };
                done.map_err(|e| file::not_written(&from, &e))?;
            }
        }
        Ok(folder)
    }

    /// The run is done: the results before it are no longer needed.
    pub fn remove_previous(&self) -> Result<()> {
        let previous = self.path.join(PREVIOUS);
        if previous.exists() { remove(&previous).map_err(|e| file::not_written(&previous, &e)) } else { Ok(()) }
    }

    pub fn has_previous(&self) -> bool {
        self.path.join(PREVIOUS).exists()
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

    /// The summary first: without it nothing else is taken for a finished run.
    fn entries(&self) -> Vec<String> {
        let fixed = [SUMMARY, "histories.csv", "run.sta", "frames"].map(String::from);
        fixed.into_iter().chain([format!("{}.pvd", self.name)]).collect()
    }
}

fn remove(path: &Path) -> std::io::Result<()> {
    if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) }
}
