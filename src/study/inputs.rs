//! What a run is made from, for its summary, and what the results that it replaces were made from.

use super::content::sha256;
use super::mesh::Meshed;
use super::run::Request;
use crate::model::case::Case;
use crate::results::folder::summary;
use crate::results::summary::Inputs;
use std::path::Path;

/// The hash of the mesh is that of the bytes that were parsed: the file may be another one by now.
pub fn made_from(case: &Case, meshed: &Meshed, request: &Request) -> Inputs {
    Inputs {
        case: case.path().display().to_string(),
        case_sha256: sha256(case.json().to_string().as_bytes()),
        effective_case: case.json().clone(),
        set: request.sets.clone(),
        geo: request.geo.clone(),
        mesh: meshed.path.display().to_string(),
        mesh_sha256: meshed.sha256.clone(),
        mesh_unit: case.mesh_unit().to_string(),
        bonded: request.bonded,
        coralpipe: env!("CARGO_PKG_VERSION"),
    }
}

/// Says so where the folder holds results of other options: those of another geometry or other values are easily lost.
pub fn replaced(folder: &Path, inputs: &Inputs) -> Option<String> {
    let old = summary(folder)?;
    let new = serde_json::to_value(inputs).ok()?;
    let options = ["geo", "set", "bonded", "mesh"];
    options.iter().any(|key| old["inputs"][key] != new[key]).then(|| {
        format!(
            "the results in {} are of another run ({}); this one ({}) replaces them once it is done: --out DIR keeps both",
            folder.display(),
            options_of(&old["inputs"]),
            options_of(&new)
        )
    })
}

/// As on the command line: `--geo spacing=3 --bonded`.
fn options_of(inputs: &serde_json::Value) -> String {
    let geo = inputs["geo"].as_object().into_iter().flatten().map(|(name, value)| format!("--geo {name}={value}"));
    let sets =
        inputs["set"].as_array().into_iter().flatten().map(|set| format!("--set {}", set.as_str().unwrap_or("?")));
    let bonded = (inputs["bonded"] == true).then(|| "--bonded".to_string());
    let words: Vec<String> = geo.chain(sets).chain(bonded).collect();
    let mesh = inputs["mesh"].as_str().unwrap_or("an unknown mesh");
    if words.is_empty() { format!("mesh {mesh}") } else { format!("mesh {mesh}, {}", words.join(" ")) }
}
