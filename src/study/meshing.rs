//! A mesh that fits its script and parameters: made by gmsh where it does not, taken as it is where it does.

use super::content::Content;
use super::gmsh::Gmsh;
use super::record::{Record, Stale};
use super::script::Script;
use super::sources::Sources;
use super::temporary::{Temporary, is_full, remove_leftovers};
use crate::model::mesh::Mesh;
use crate::model::msh;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

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
    /// script, all that gmsh read, parameters and mesh are as recorded: gmsh was not needed
    Unchanged,
    /// as `Unchanged`, but not all that counts is recorded, and there is no gmsh to make the mesh again
    Unchecked { reason: String },
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
            Outcome::Unchecked { reason } => {
                write!(f, "{mesh} is used as it is, since there is no gmsh to make it again ({reason})")
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
    remove_leftovers(mesh);
    let wanted = Record::wanted(&Script::read(script)?, parameters)?;
    let old = Content::read(mesh).ok();
    let record_file = mesh.with_extension("json");
    let record = Record::read(&record_file)?;
    let meshing = |gmsh, content, outcome| Meshing { mesh: mesh.into(), content, script: script.into(), gmsh, outcome };
    let (stale, kept) = match (record, old) {
        (_, None) => (Stale::Changed("there was no mesh".into()), None),
        (None, Some(_)) => {
            let missing = format!("there was no record {} of what the mesh was made from", record_file.display());
            (Stale::Changed(missing), None)
        }
        (Some(record), Some(old)) => match record.staleness(&wanted, script, &old.sha256) {
            None => return Ok(meshing(record.gmsh, old, Outcome::Unchanged)),
            Some(stale) => (stale, Some(meshing(record.gmsh, old, Outcome::Unchanged))),
        },
    };
    let gmsh = match (find(), &stale, &kept) {
        (Ok(gmsh), ..) => gmsh,
        (Err(_), Stale::Doubtful(reason), Some(kept)) => {
            return Ok(Meshing { outcome: Outcome::Unchecked { reason: reason.clone() }, ..kept.clone() });
        }
        (Err(e), ..) => {
            let (mesh, script, reason) = (mesh.display(), script.display(), stale.reason());
            return Err(Error::input(format!("{mesh} must be made from {script} ({reason}), but {e}")));
        }
    };
    let start = Instant::now();
    let made = make(&gmsh, script, parameters, mesh)?;
    let record = wanted.made(&made.version, made.sources, &made.content.sha256);
    replace(&record_file, record.to_json().as_bytes())?;
    let seconds = start.elapsed().as_secs_f64();
    let is_same = kept.is_some_and(|kept| kept.content == made.content);
    let reason = match stale {
        Stale::Doubtful(reason) if is_same => format!("{reason}; the new mesh equals the old one"),
        Stale::Doubtful(reason) | Stale::Changed(reason) => reason,
    };
    Ok(meshing(made.version, made.content, Outcome::Made { seconds, reason, warnings: made.warnings }))
}

struct Made {
    version: String,
    warnings: Vec<String>,
    sources: Sources,
    content: Content,
}

/// Lets gmsh write under a temporary name beside `mesh`, and takes the result only if it is a plane mesh.
fn make(gmsh: &Gmsh, script: &Path, parameters: &BTreeMap<String, f64>, mesh: &Path) -> Result<Made> {
    let folder = mesh.parent().unwrap_or(Path::new(""));
    let created = if folder.as_os_str().is_empty() { Ok(()) } else { std::fs::create_dir_all(folder) };
    let temporary = created.and_then(|()| Temporary::beside(mesh)).map_err(|e| not_writable(folder, &e))?;
    let made = make_at(gmsh, script, parameters, mesh, temporary.path());
    // gmsh itself does not notice that what it writes does not arrive
    let made = made.map_err(|error| temporary.fullness().map_or(error, |e| not_writable(folder, &e)))?;
    temporary.rename(mesh).map_err(|e| not_writable(mesh, &e))?;
    Ok(made)
}

fn make_at(
    gmsh: &Gmsh,
    script: &Path,
    parameters: &BTreeMap<String, f64>,
    mesh: &Path,
    temporary: &Path,
) -> Result<Made> {
    let since = SystemTime::now();
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
    let sources = Sources::after(script, &said.read, since);
    Ok(Made { version: said.version, warnings: said.warnings, sources, content: Content::of(bytes) })
}

fn replace(file: &Path, content: &[u8]) -> Result<()> {
    let write = || {
        let temporary = Temporary::beside(file)?;
        std::fs::write(temporary.path(), content)?;
        temporary.rename(file)
    };
    write().map_err(|e| not_writable(file, &e))
}

fn not_writable(place: &Path, e: &std::io::Error) -> Error {
    let place = if place.as_os_str().is_empty() { Path::new(".") } else { place };
    if is_full(e) {
        return Error::input(format!(
            "the disk is full: the mesh does not fit into {} ({e}); free some space there, or run in a folder on another disk",
            place.display()
        ));
    }
    Error::input(format!(
        "{} cannot be written to: {e}; meshes lie under the current folder: run in one that can be written, or give a mesh by \
         --mesh FILE.msh",
        place.display()
    ))
}
