//! The record beside a mesh, `X.json` beside `X.msh`: what the mesh was made from.

use super::constants::Expression;
use super::content::sha256;
use super::script::Script;
use super::sources::{Sources, changes};
use crate::input::{self, Kind};
use crate::model::msh;
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    script: String,
    /// of the script alone
    script_sha256: String,
    /// the other files that gmsh read or looked for: place seen from the script's folder (`~/` for personal options), and
    /// SHA-256; null where there was no file. None in records of earlier versions.
    #[serde(default)]
    files: Option<BTreeMap<String, Option<String>>>,
    /// why the mesh may be stale though nothing recorded changes
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    doubts: Vec<String>,
    /// every constant's value in force; a default that is a formula stands as its text
    parameters: BTreeMap<String, serde_json::Value>,
    pub gmsh: String,
    mesh_sha256: String,
}

/// Why a mesh cannot be used as it is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Stale {
    Changed(String),
    /// nothing that is recorded changed, but not all that counts is recorded
    Doubtful(String),
}

impl Stale {
    pub fn reason(&self) -> &str {
        match self {
            Stale::Changed(reason) | Stale::Doubtful(reason) => reason,
        }
    }
}

impl Record {
    /// Of the script as it is now, before gmsh has run.
    ///
    /// Errors: parameters that the script does not have, or out of bounds.
    pub fn wanted(script: &Script, parameters: &BTreeMap<String, f64>) -> Result<Record> {
        let json = |value| match value {
            Expression::Number(number) => number.into(),
            Expression::Formula(text) => text.into(),
        };
        Ok(Record {
            script: msh::file_name(&script.path),
            script_sha256: sha256(&script.bytes),
            files: None,
            doubts: Vec::new(),
            parameters: script.values(parameters)?.into_iter().map(|(name, value)| (name, json(value))).collect(),
            gmsh: String::new(),
            mesh_sha256: String::new(),
        })
    }

    /// With what became known when gmsh made the mesh.
    pub fn made(self, gmsh: &str, sources: Sources, mesh_sha256: &str) -> Record {
        Record {
            files: Some(sources.files),
            doubts: sources.doubts,
            gmsh: gmsh.into(),
            mesh_sha256: mesh_sha256.into(),
            ..self
        }
    }

    /// None if there is no such file, or a power cut left only a part of it.
    ///
    /// Errors: the file is something else, say a case file: it must not be written over.
    pub fn read(file: &Path) -> Result<Option<Record>> {
        let Ok(bytes) = input::read(file, Kind::Record) else {
            return Ok(None);
        };
        match serde_json::from_slice(&bytes) {
            Ok(record) => Ok(Some(record)),
            Err(_) if bytes.iter().all(|&b| b == 0) => Ok(None),
            Err(e) if e.is_eof() && bytes.starts_with(b"{\n  \"script\":") => Ok(None),
            Err(_) => Err(Error::input(format!(
                "{} stands where the record of the mesh belongs, but is none: move it away, or let the mesh lie elsewhere",
                file.display()
            ))),
        }
    }

    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a record has only texts and finite numbers") + "\n"
    }

    /// Why the mesh with hash `mesh_sha256` that is there is not what is `wanted` of `script` now; none if it is.
    pub fn staleness(&self, wanted: &Record, script: &Path, mesh_sha256: &str) -> Option<Stale> {
        let mut changed = Vec::new();
        changed.extend((self.script_sha256 != wanted.script_sha256).then(|| "the script has changed".to_string()));
        changed.extend(self.files.iter().flat_map(|files| changes(files, script)));
        changed.extend(wanted.parameters.iter().filter_map(|(name, value)| self.parameter_change(name, value)));
        if changed.is_empty() && self.mesh_sha256 != mesh_sha256 {
            changed.push("the mesh is not the one that was recorded".into());
        }
        // who has personal options but no gmsh can still use a mesh that came without them
        let is_personal = |change: &String| change.starts_with("~/");
        match &self.files {
            _ if !changed.iter().all(is_personal) => Some(Stale::Changed(changed.join(", "))),
            _ if !changed.is_empty() => Some(Stale::Doubtful(changed.join(", "))),
            None => Some(Stale::Doubtful("the record does not list the files that gmsh read".into())),
            Some(_) if self.doubts.is_empty() => None,
            Some(_) => Some(Stale::Doubtful(self.doubts.join(", "))),
        }
    }

    fn parameter_change(&self, name: &str, value: &serde_json::Value) -> Option<String> {
        match self.parameters.get(name) {
            Some(old) if is_same(old, value) => None,
            Some(old) => Some(format!("{name} was {old}, is {value}")),
            None => Some(format!("{name} is {value}")),
        }
    }
}

/// Equal texts, or numbers equal but for the last digit, which reading JSON may change.
fn is_same(a: &serde_json::Value, b: &serde_json::Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= 4.0 * f64::EPSILON * b.abs(),
        _ => a == b,
    }
}
