//! The files that a mesh depends on beside its script: what gmsh reports, what the scripts name, and what gmsh looks
//! for by itself.

use super::content::Content;
use super::mentions::{Mentions, mentions};
use std::collections::{BTreeMap, BTreeSet};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// What a mesh was made from, beside the script.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sources {
    /// place of each file, seen from the script's folder or absolute, and its SHA-256; none where there was no file
    pub files: BTreeMap<String, Option<String>>,
    /// why the mesh may be stale though none of the files changes
    pub doubts: Vec<String>,
}

/// A file that gmsh parsed.
struct Parsed {
    key: String,
    /// its options are set before or after the script: it cannot keep gmsh from reporting what the script reads
    is_options: bool,
    mentions: Mentions,
}

/// Files that gmsh looks for in the user's home at every start.
const PERSONAL: [&str; 2] = [".gmshrc", ".gmsh-options"];

impl Sources {
    /// After gmsh, started at `since`, has `reported` that it read these files.
    pub fn after(script: &Path, reported: &[PathBuf], since: SystemTime) -> Sources {
        let folder = script.parent().unwrap_or(Path::new(""));
        let mut sources = Sources { files: BTreeMap::new(), doubts: Vec::new() };
        let mut waiting: Vec<PathBuf> = personal().into_iter().chain(reported.iter().cloned()).collect();
        waiting.push(script.into());
        let mut seen = BTreeSet::new();
        let mut parsed = Vec::new();
        while let Some(file) = waiting.pop() {
            if !seen.insert(file.clone()) {
                continue;
            }
            let Some(key) = key(&file, folder) else {
                sources.doubts.push(format!("the name of {} is not UTF-8 and cannot be recorded", file.display()));
                continue;
            };
            let content = content(&file);
            let is_special = content.is_none() && file.exists() && !file.is_dir();
            sources.doubts.extend(is_special.then(|| format!("what {key} holds cannot be recorded")));
            if file != script {
                sources.files.insert(key.clone(), content.as_ref().map(|c| c.sha256.clone()));
                sources.doubts.extend(changed_since(&file, since).then(|| format!("{key} changed while gmsh ran")));
            }
            let Some(content) = content else { continue };
            let mentions = mentions(&content.bytes);
            let beside = file.parent().unwrap_or(Path::new(""));
            waiting.extend(mentions.included.iter().chain(&mentions.read).map(|name| beside.join(name)));
            let is_options = file.extension().is_some_and(|e| e == "opt") || personal().contains(&file);
            waiting.extend((!is_options).then(|| options_of(&file)));
            parsed.push(Parsed { key, is_options, mentions });
        }
        let is_silenced = parsed.iter().any(|p| !p.is_options && p.mentions.is_silencing);
        let is_reported = !is_silenced && reported.iter().any(|file| file == script);
        sources.doubts.extend(parsed.iter().flat_map(|p| p.doubts(is_reported)));
        sources
    }
}

impl Parsed {
    fn doubts(&self, is_reported: bool) -> Vec<String> {
        // personal options are read before gmsh begins to report
        let composed = if is_reported && !self.key.starts_with("~/") { &[][..] } else { &self.mentions.composed };
        let words: BTreeSet<&String> = self.mentions.hidden.iter().chain(composed).collect();
        words.into_iter().map(|word| format!("what {} reads by {word} is not recorded", self.key)).collect()
    }
}

/// Which of the recorded files are not as they were, a sentence each.
pub(super) fn changes(files: &BTreeMap<String, Option<String>>, script: &Path) -> Vec<String> {
    let folder = script.parent().unwrap_or(Path::new(""));
    let change = |(key, old): (&String, &Option<String>)| {
        let now = content(&place(key, folder)).map(|content| content.sha256);
        match (old, now) {
            (None, Some(_)) => Some(format!("{key} is new")),
            (Some(_), None) => Some(format!("{key} is gone")),
            (old, now) => (*old != now).then(|| format!("{key} has changed")),
        }
    };
    files.iter().filter_map(change).collect()
}

/// None where there is no file, or a device or pipe that may give something else each time.
fn content(file: &Path) -> Option<Content> {
    if file.is_file() { Content::read(file).ok() } else { None }
}

/// `box.geo` -> `box.geo.opt`, which gmsh reads after the script, or a file that is merged, where it exists.
fn options_of(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".opt");
    name.into()
}

/// How a file is called in the record; none if its name is not UTF-8.
fn key(file: &Path, folder: &Path) -> Option<String> {
    if let Some(at) = personal().iter().position(|personal| personal == file) {
        return Some(format!("~/{}", PERSONAL[at]));
    }
    let place = match file.strip_prefix(folder) {
        Ok(inside) => inside.to_path_buf(),
        Err(_) => std::path::absolute(file).unwrap_or(file.into()),
    };
    place.into_os_string().into_string().ok()
}

fn place(key: &str, folder: &Path) -> PathBuf {
    match key.strip_prefix("~/").and_then(|name| PERSONAL.iter().position(|personal| *personal == name)) {
        Some(at) => personal().swap_remove(at),
        None => folder.join(key),
    }
}

/// The files of [`PERSONAL`], in the folder that gmsh takes for the user's home.
fn personal() -> Vec<PathBuf> {
    let set = ["GMSH_HOME", "HOME", "TMP", "TEMP"].iter().filter_map(std::env::var_os);
    let home = PathBuf::from(set.into_iter().find(|value| !value.is_empty()).unwrap_or_default());
    PERSONAL.iter().map(|name| home.join(name)).collect()
}

/// Whether a file's content, place or name changed after `since`.
fn changed_since(file: &Path, since: SystemTime) -> bool {
    let changed = |m: std::fs::Metadata| {
        let seconds = u64::try_from(m.ctime()).unwrap_or(0);
        UNIX_EPOCH + Duration::new(seconds, m.ctime_nsec() as u32)
    };
    file.metadata().is_ok_and(|m| changed(m) >= since)
}
