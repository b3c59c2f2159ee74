//! `previous/`: the results of an earlier run, kept while a new one writes.
//!
//! At every moment, and so after a kill, they are whole in the folder or in `previous/`, and every series finds its
//! frames: each file gets a second name (a hard link, which takes no space) in `previous.part/`, one rename makes that
//! `previous/`, and only then the names in the folder go.

use super::file::{self, not_written};
use crate::Result;
use std::fs::Metadata;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::Path;

pub const PREVIOUS: &str = "previous";
/// `previous/` while results are on their way there.
pub const MOVING: &str = "previous.part";

/// Moves `entries` of the folder, in the order in which their names may go, into `previous/`, in place of what is
/// there. Continues where a kill stopped an earlier call.
pub fn keep(folder: &Path, entries: &[String]) -> Result<()> {
    let (previous, moving) = (folder.join(PREVIOUS), folder.join(MOVING));
    file::create_folder_within(&moving)?;
    // What says that results are whole comes last.
    match entries.iter().rev().try_for_each(|entry| link(&folder.join(entry), &moving.join(entry))) {
        Ok(()) => {}
        Err(e) if matches!(e.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded) => {
            return Err(not_written(&moving, &e));
        }
        Err(_) => rename_each(folder, entries)?,
    }
    remove(folder)?;
    std::fs::rename(&moving, &previous).map_err(|e| not_written(&previous, &e))?;
    entries.iter().try_for_each(|entry| file::remove(&folder.join(entry)))
}

/// On a disk without hard links, where a kill may leave some of the results here and some there until the next run.
fn rename_each(folder: &Path, entries: &[String]) -> Result<()> {
    entries.iter().try_for_each(|entry| {
        let from = folder.join(entry);
        rename(&from, &folder.join(MOVING).join(entry)).map_err(|e| not_written(&from, &e))
    })
}

/// A folder joins the one of that name which an earlier call may have left there.
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    if from.symlink_metadata()?.is_dir() && to.is_dir() {
        std::fs::read_dir(from)?.try_for_each(|entry| {
            let entry = entry?;
            rename(&entry.path(), &to.join(entry.file_name()))
        })?;
        return std::fs::remove_dir(from);
    }
    std::fs::rename(from, to)?;
    // Of two names of one file the system leaves both.
    if from.symlink_metadata().is_ok() { std::fs::remove_file(from) } else { Ok(()) }
}

/// A second name for a file, or for each file of a folder.
fn link(from: &Path, to: &Path) -> io::Result<()> {
    if !from.symlink_metadata()?.is_dir() {
        return match to.symlink_metadata() {
            Ok(old) if is_same(&old, &from.symlink_metadata()?) => Ok(()),
            Ok(_) => std::fs::remove_file(to).and_then(|()| std::fs::hard_link(from, to)),
            Err(_) => std::fs::hard_link(from, to),
        };
    }
    if !to.is_dir() {
        std::fs::create_dir(to)?;
    }
    std::fs::read_dir(from)?.try_for_each(|entry| {
        let entry = entry?;
        link(&entry.path(), &to.join(entry.file_name()))
    })
}

fn is_same(a: &Metadata, b: &Metadata) -> bool {
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

/// Removes `previous/`, if it is there, under a hidden name that the next run would clear.
pub fn remove(folder: &Path) -> Result<()> {
    let previous = folder.join(PREVIOUS);
    let hidden = file::part_of(&previous);
    match std::fs::rename(&previous, &hidden) {
        Ok(()) => file::remove(&hidden),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(()),
        Err(_) => file::remove(&previous),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Some frames are linked when linking fails: the others, and what else there is, are renamed to join them.
    #[test]
    fn results_of_which_some_are_linked_are_brought_together_by_renaming() {
        let folder = std::env::temp_dir().join(format!("coralpipe-{}-previous", std::process::id()));
        fs::create_dir_all(folder.join("frames")).unwrap();
        for name in ["frames/0.vtu", "frames/1.vtu", "run.sta"] {
            fs::write(folder.join(name), name).unwrap();
        }
        let moving = folder.join(MOVING);
        fs::create_dir_all(moving.join("frames")).unwrap();
        fs::hard_link(folder.join("frames/1.vtu"), moving.join("frames/1.vtu")).unwrap();
        rename_each(&folder, &["frames".into(), "run.sta".into()]).unwrap();
        for name in ["frames/0.vtu", "frames/1.vtu", "run.sta"] {
            assert_eq!(fs::read_to_string(moving.join(name)).unwrap(), name);
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "only {MOVING} is left");
        fs::remove_dir_all(folder).unwrap();
    }
}
