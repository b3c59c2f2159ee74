//! A mesh that fits its script and parameters: made by gmsh where it does not, taken as it is where it does.

use super::constants::Expression;
use super::content::{Content, sha256};
use super::gmsh::Gmsh;
use super::script::Script;
use crate::input::{self, Kind};
use crate::model::mesh::Mesh;
use crate::model::msh;
use crate::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What stands beside `X.msh` in `X.json`: what the mesh was made from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    script: String,
    /// of the script and, behind it, the files it includes
    script_sha256: String,
    /// every constant's value in force; a default that is a formula stands as its text
    parameters: BTreeMap<String, serde_json::Value>,
    gmsh: String,
    mesh_sha256: String,
}

/// How a mesh came to be there.
#[derive(Debug, Clone, PartialEq)]
pub struct Meshing {
    pub mesh: PathBuf,
    /// of the mesh: what was compared with the record, or made
    pub content: Content,
    pub script: PathBuf,
    /// version of the gmsh that made the mesh
    pub gmsh: String,
    pub outcome: Outcome,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// script, parameters and mesh are as recorded: gmsh was not needed
    Unchanged,
    Made {
        seconds: f64,
        /// why the mesh that was there, if any, did not do
        reason: String,
        /// what gmsh warned of
        warnings: Vec<String>,
    },
}

impl fmt::Display for Meshing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mesh, script) = (self.mesh.display(), self.script.display());
        match &self.outcome {
            Outcome::Unchanged => {
                write!(
                    f,
                    "{mesh} is taken as it is: {script} and its parameters have not changed since gmsh {} made it",
                    self.gmsh
                )
            }
            Outcome::Made { seconds, reason, .. } => {
                write!(f, "{mesh} was made from {script} by gmsh {} in {seconds:.2} s ({reason})", self.gmsh)
            }
        }
    }
}

/// Sees to it that `mesh` is what `script` gives with `parameters`; the record of that is `mesh` with extension `json`.
///
/// Errors: an unreadable script, unknown parameters or values out of bounds, no gmsh where it is needed, gmsh's own
/// errors, an empty mesh, a folder that cannot be written to. A mesh that was there survives them all.
pub fn ensure_mesh(script: &Path, parameters: &BTreeMap<String, f64>, mesh: &Path) -> Result<Meshing> {
    ensure_mesh_with(script, parameters, mesh, || Gmsh::find(script.parent().unwrap_or(Path::new(""))))
}

/// [`ensure_mesh`] with another way to find gmsh, called only if it is needed.
pub fn ensure_mesh_with(
    script: &Path,
    parameters: &BTreeMap<String, f64>,
    mesh: &Path,
    find: impl FnOnce() -> Result<Gmsh>,
) -> Result<Meshing> {
    let source = Script::read(script)?;
    let old = Content::read(mesh).ok();
    let mut wanted = Record {
        script: msh::file_name(script),
        script_sha256: sha256(&source.bytes),
        parameters: source.values(parameters)?.into_iter().map(|(name, value)| (name, json(value))).collect(),
        gmsh: String::new(),
        mesh_sha256: old.as_ref().map(|old| old.sha256.clone()).unwrap_or_default(),
    };
    let record_file = mesh.with_extension("json");
    let record = read_record(&record_file)?;
    let meshing = |gmsh, content, outcome| Meshing { mesh: mesh.into(), content, script: script.into(), gmsh, outcome };
    let reason = match (record, old) {
        (_, None) => "there was no mesh".into(),
        (None, Some(_)) => format!("there was no record {} of what the mesh was made from", record_file.display()),
        (Some(record), Some(old)) => match difference(&record, &wanted) {
            None => return Ok(meshing(record.gmsh, old, Outcome::Unchanged)),
            Some(difference) => difference,
        },
    };
    let gmsh = find().map_err(|e| {
        Error::input(format!("{} must be made from {} ({reason}), but {e}", mesh.display(), script.display()))
    })?;
    let start = Instant::now();
    let made = make(&gmsh, script, parameters, mesh)?;
    wanted.gmsh.clone_from(&made.version);
    wanted.mesh_sha256.clone_from(&made.content.sha256);
    let text = serde_json::to_string_pretty(&wanted).expect("a record has only texts and finite numbers") + "\n";
    replace(&record_file, text.as_bytes())?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(meshing(made.version, made.content, Outcome::Made { seconds, reason, warnings: made.warnings }))
}

struct Made {
    version: String,
    warnings: Vec<String>,
    content: Content,
}

/// Lets gmsh write under a temporary name beside `mesh`, and takes the result only if it is a plane mesh.
fn make(gmsh: &Gmsh, script: &Path, parameters: &BTreeMap<String, f64>, mesh: &Path) -> Result<Made> {
    let temporary = temporary_name(mesh);
    check_writable(&temporary)?;
    let made = make_at(gmsh, script, parameters, mesh, &temporary);
    // already renamed if all went well
    let _ = std::fs::remove_file(&temporary);
    made
}

fn make_at(
    gmsh: &Gmsh,
    script: &Path,
    parameters: &BTreeMap<String, f64>,
    mesh: &Path,
    temporary: &Path,
) -> Result<Made> {
    let said = gmsh.mesh(script, parameters, temporary)?;
    let name = msh::file_name(mesh);
    let warned = match said.warnings.join("; ") {
        none if none.is_empty() => none,
        warnings => format!("; gmsh warned: {warnings}"),
    };
    let failed =
        |e: &dyn fmt::Display| Error::input(format!("gmsh made no usable mesh from {}: {e}{warned}", script.display()));
    let bytes = std::fs::read(temporary).map_err(|e| failed(&e))?;
    if bytes.is_empty() {
        return Err(failed(&"it ended without an error, but wrote nothing"));
    }
    msh::parse(&bytes, &name).and_then(|read| Mesh::from_msh(&read, &name)).map_err(|e| failed(&e))?;
    std::fs::rename(temporary, mesh).map_err(|e| not_writable(mesh, &e))?;
    Ok(Made { version: said.version, warnings: said.warnings, content: Content::of(bytes) })
}

/// What of the record is not as wanted; none if nothing is.
fn difference(record: &Record, wanted: &Record) -> Option<String> {
    if record.script_sha256 != wanted.script_sha256 {
        return Some("the script has changed".into());
    }
    let changed = |(name, value): (&String, &serde_json::Value)| match record.parameters.get(name) {
        Some(old) if is_same(old, value) => None,
        Some(old) => Some(format!("{name} was {old}, is {value}")),
        None => Some(format!("{name} is {value}")),
    };
    let changes: Vec<String> = wanted.parameters.iter().filter_map(changed).collect();
    match changes.is_empty() {
        false => Some(changes.join(", ")),
        true => (record.mesh_sha256 != wanted.mesh_sha256).then(|| "the mesh is not the one that was recorded".into()),
    }
}

/// Equal texts, or numbers equal but for the last digit, which reading JSON may change.
fn is_same(a: &serde_json::Value, b: &serde_json::Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= 4.0 * f64::EPSILON * b.abs(),
        _ => a == b,
    }
}

/// None if there is no such file.
///
/// Errors: the file is something else, say a case file: it must not be written over.
fn read_record(file: &Path) -> Result<Option<Record>> {
    let Ok(bytes) = input::read(file, Kind::Record) else {
        return Ok(None);
    };
    serde_json::from_slice(&bytes).map(Some).map_err(|_| {
        Error::input(format!(
            "{} stands where the record of the mesh belongs, but is none: move it away, or let the mesh lie elsewhere",
            file.display()
        ))
    })
}

fn json(value: Expression) -> serde_json::Value {
    match value {
        Expression::Number(number) => number.into(),
        Expression::Formula(text) => text.into(),
    }
}

/// `meshes/x.msh` -> `meshes/.x.msh.PROCESS`: in the same folder, so that renaming is one step.
fn temporary_name(file: &Path) -> PathBuf {
    file.with_file_name(format!(".{}.{}", msh::file_name(file), std::process::id()))
}

fn check_writable(temporary: &Path) -> Result<()> {
    let folder = temporary.parent().unwrap_or(Path::new(""));
    let created = if folder.as_os_str().is_empty() { Ok(()) } else { std::fs::create_dir_all(folder) };
    created.and_then(|()| std::fs::write(temporary, "")).map_err(|e| not_writable(folder, &e))
}

fn replace(file: &Path, content: &[u8]) -> Result<()> {
    let temporary = temporary_name(file);
    let written = std::fs::write(&temporary, content).and_then(|()| std::fs::rename(&temporary, file));
    written.map_err(|e| not_writable(file, &e))
}

fn not_writable(place: &Path, e: &std::io::Error) -> Error {
    let place = if place.as_os_str().is_empty() { Path::new(".") } else { place };
    Error::input(format!(
        "{} cannot be written to: {e}; meshes lie under the current folder: run in one that can be written, or give a mesh by \
         --mesh FILE.msh",
        place.display()
    ))
}
