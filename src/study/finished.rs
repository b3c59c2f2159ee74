//! Runs that need not be made again.

use crate::results::folder::{is_whole, summary, tidy};
use crate::results::summary::Inputs;
use serde_json::Value;
use std::path::Path;

/// The summary of a run that is done, with all its files, made of just these inputs by this very program.
pub fn finished(folder: &Path, inputs: &Inputs, frames: bool) -> Option<Value> {
    let summary = ended(folder, inputs)?;
    let is_done = summary["status"] == "done" && is_whole(folder, &summary, frames);
    if is_done {
        tidy(folder);
    }
    is_done.then_some(summary)
}

/// The summary of a run of just these inputs by this very program, however it ended.
pub fn ended(folder: &Path, inputs: &Inputs) -> Option<Value> {
    let summary = summary(folder)?;
    let of = &summary["inputs"];
    let same = of["case_sha256"] == inputs.case_sha256.as_str()
        && of["mesh_sha256"] == inputs.mesh_sha256.as_str()
        && of["bonded"] == inputs.bonded
        && of["coralpipe"] == inputs.coralpipe;
    let written = |path: &Path| path.metadata().and_then(|m| m.modified()).ok();
    let program = written(&std::env::current_exe().ok()?)?;
    (same && written(&folder.join("summary.json"))? >= program).then_some(summary)
}
