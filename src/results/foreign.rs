//! Folders that hold somebody else's files are refused: else a slip such as `--out /` writes among them.

use super::file::is_part;
use super::previous::{MOVING, PREVIOUS};
use super::run_files::{STATUS, summary};
use super::{histories, ring_table, series};
use crate::{Error, Result};
use std::path::Path;

/// What may be in a folder before its first run: mode shapes, studies, and the log of a batch.
const BESIDE: [&str; 4] = ["modes", "domain", "converge", "batch.log"];

/// A folder that is not empty must show that what it holds was written by this program.
pub fn refuse_foreign(path: &Path) -> Result<()> {
    let has = |name: &str| path.join(name).exists();
    if has(STATUS)
        || has(PREVIOUS)
        || has(MOVING)
        || summary(path).is_some_and(|s| s["inputs"]["coralpipe"].is_string())
    {
        return Ok(());
    }
    refuse(path, "folder of results", |name| BESIDE.contains(&name) || is_of_a_run(path, name))
}

/// Frames of earlier results go when new ones are written, and a file of the user's beside them would go with them.
pub fn refuse_foreign_frames(path: &Path) -> Result<()> {
    match foreign_frame(&path.join("frames")) {
        None => Ok(()),
        Some(name) => Err(Error::input(format!(
            "{} holds {name}, which is no frame of this program, and a run replaces that folder: move it elsewhere, or choose \
             another folder with --out",
            path.join("frames").display()
        ))),
    }
}

/// A folder may hold nothing but files that are half-written: else it is none of this `kind`.
pub fn refuse_filled(path: &Path, kind: &str) -> Result<()> {
    refuse(path, kind, |_| false)
}

fn refuse(path: &Path, kind: &str, known: impl Fn(&str) -> bool) -> Result<()> {
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
    let mut foreign: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    foreign.retain(|name| !is_part(name) && !known(name));
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

/// Whether a file or folder is what a run that was cut short has left: empty, or begun as this program begins it.
pub fn is_of_a_run(folder: &Path, name: &str) -> bool {
    let path = folder.join(name);
    let begins = |start: &str| begins_with(&path, start);
    match name {
        "frames" => path.symlink_metadata().is_ok_and(|m| m.is_dir()) && holds_frames(&path),
        "histories.csv" => begins(histories::FIRST_COLUMN),
        "rings.csv" => begins(ring_table::HEADER),
        _ => name.ends_with(".pvd") && begins(series::BEGINNING),
    }
}

fn holds_frames(folder: &Path) -> bool {
    foreign_frame(folder).is_none()
}

/// The name of a file that is neither a frame nor on its way to be one.
fn foreign_frame(folder: &Path) -> Option<String> {
    let mut names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let is_frame = |name: &str| {
        let number = name.strip_suffix(".vtu").and_then(|n| n.rsplit_once('_')).map(|(_, number)| number);
        number.is_some_and(|n| n.len() >= 5 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let foreign = names.find(|name| !name.to_str().is_some_and(|name| is_frame(name) || is_part(name)));
    foreign.map(|name| name.to_string_lossy().into_owned())
}

/// Whether the file is empty or begins with `start`; of a write that was cut short, with a part of it.
fn begins_with(path: &Path, start: &str) -> bool {
    let read = || {
        use std::io::Read;
        let mut bytes = Vec::new();
        if !path.symlink_metadata()?.is_file() {
            return Err(std::io::ErrorKind::InvalidInput.into());
        }
        std::fs::File::open(path)?.take(start.len() as u64).read_to_end(&mut bytes).map(|_| bytes)
    };
    read().is_ok_and(|bytes: Vec<u8>| start.as_bytes().starts_with(&bytes))
}
