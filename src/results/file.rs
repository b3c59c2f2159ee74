//! Files that are whole or not there: written under another name, then renamed.

use crate::{Error, Result};
use std::io::{self, ErrorKind};
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
pub fn part_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

/// Whether the name is one that [`part_of`] gives.
pub fn is_part(name: &str) -> bool {
    process_of(name).is_some()
}

/// The process that writes, or wrote, a file of this hidden name.
fn process_of(name: &str) -> Option<&str> {
    let (_, process) = name.strip_prefix('.')?.strip_suffix(".part")?.rsplit_once('.')?;
    (!process.is_empty() && process.bytes().all(|b| b.is_ascii_digit())).then_some(process)
}

/// Removes what killed processes left half-written in a folder that is locked for this process.
pub fn remove_parts(folder: &Path) {
    for path in parts(folder, |_| true) {
        let _ = remove(&path);
    }
}

/// Removes what killed processes left half-written of one file, in a folder that several processes may use at once:
/// only parts whose process has ended, where the system shows its processes.
pub fn remove_parts_of(path: &Path) {
    let start = format!(".{}.", path.file_name().unwrap_or_default().to_string_lossy());
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let processes = Path::new("/proc");
    let has_ended = |name: &str| {
        process_of(name).is_some_and(|process| processes.join("self").exists() && !processes.join(process).exists())
    };
    for part in parts(folder, |name| name.starts_with(&start) && has_ended(name)) {
        let _ = remove(&part);
    }
}

fn parts(folder: &Path, chosen: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let parts = entries.filter(|entry| entry.file_name().to_str().is_some_and(|name| is_part(name) && chosen(name)));
    parts.map(|entry| entry.path()).collect()
}

/// The error of a file or folder that a run wrote and that is gone before the run ends.
pub fn lost(path: &Path) -> Error {
    Error::input(format!("{} was removed or replaced while the run was writing: run it again", path.display()))
}

pub fn create_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|e| not_written(path, &e))
}

/// Makes a folder in one that exists, if it is not there.
pub fn create_folder_within(path: &Path) -> Result<()> {
    match std::fs::create_dir(path) {
        Err(e) if e.kind() != ErrorKind::AlreadyExists || !path.is_dir() => Err(not_written(path, &e)),
        _ => Ok(()),
    }
}

/// Removes a file or a folder, if it is there. A folder loses its summary and its series first: a kill leaves no series
/// that names missing frames.
pub fn remove(path: &Path) -> Result<()> {
    let is_folder = path.symlink_metadata().is_ok_and(|m| m.is_dir());
    let removed = if is_folder { remove_folder(path) } else { std::fs::remove_file(path) };
    match removed {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(not_written(path, &e)),
        _ => Ok(()),
    }
}

fn remove_folder(path: &Path) -> io::Result<()> {
    let files: Vec<PathBuf> = std::fs::read_dir(path)?.flatten().map(|entry| entry.path()).collect();
    for ending in ["json", "pvd"] {
        for file in files.iter().filter(|file| file.extension().is_some_and(|e| e == ending) && file.is_file()) {
            std::fs::remove_file(file)?;
        }
    }
    std::fs::remove_dir_all(path)
}

pub fn not_written(path: &Path, why: &io::Error) -> Error {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty() && !p.exists());
    let (reason, remedy) = match (why.kind(), folder) {
        (ErrorKind::NotFound, Some(folder)) => {
            (format!("there is no folder {}, or it was removed meanwhile", folder.display()), "choose")
        }
        (ErrorKind::StorageFull, _) => (format!("the disk is full: {why}"), "free some space, or choose"),
        (ErrorKind::QuotaExceeded, _) => {
            (format!("the space that the system allows you is used up: {why}"), "free some space, or choose")
        }
        _ => (why.to_string(), "choose"),
    };
    Error::input(format!("{} cannot be written: {reason}; {remedy} another folder with --out", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_end_in_a_process_and_part_are_parts() {
        for name in [".histories.csv.4711.part", ".previous.1.part"] {
            assert!(is_part(name), "{name}");
        }
        for name in [".mine.part", "mine.27565.part", ".histories.csv.part", ".a.12x.part", ".part", ".a.7.part.bak"] {
            assert!(!is_part(name), "{name}");
        }
    }

    #[test]
    fn a_full_disk_and_a_lost_folder_are_named() {
        let told = |path: &str, kind: ErrorKind| not_written(Path::new(path), &kind.into()).to_string();
        assert!(told("/x.csv", ErrorKind::StorageFull).starts_with("/x.csv cannot be written: the disk is full: "));
        let lost = told("/nowhere/at/all.csv", ErrorKind::NotFound);
        assert!(lost.contains("there is no folder /nowhere/at, or it was removed meanwhile"), "{lost}");
    }
}
