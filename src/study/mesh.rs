//! Where the mesh of a case comes from: a file, or the case's script through gmsh.

use super::content::Content;
use super::meshing::{Outcome, ensure_mesh};
use super::run::Request;
use crate::escape::one_line;
use crate::model::case::{Case, MeshSource};
use crate::model::mesh::Mesh;
use crate::model::msh;
use crate::model::openings::Openings;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A mesh and its story.
#[derive(Debug)]
pub struct Meshed {
    pub mesh: Mesh,
    /// known to the runs of a sweep
    pub openings: Openings,
    pub path: PathBuf,
    /// of the bytes that became `mesh`
    pub sha256: String,
    /// one sentence: which mesh, made or found
    pub told: String,
    pub warnings: Vec<String>,
    pub took: Duration,
}

/// `--mesh` first, else the case's geometry with `--geo NAME=VALUE` on top of its parameters.
pub fn obtain(case: &Case, geo: &BTreeMap<String, f64>, file: Option<&Path>) -> Result<Meshed> {
    let start = Instant::now();
    let Source { path, content, told, warnings } = match (
        file,
        case.geometry.as_ref().and_then(|geometry| geometry.source.as_ref()),
    ) {
        (Some(path), _) if geo.is_empty() => found(path.to_path_buf())?,
        (Some(_), _) => return Err(Error::input("--geo changes a script's constants; it cannot be used with --mesh")),
        (None, Some(MeshSource::Mesh(path))) if geo.is_empty() => found(case.resolve(path))?,
        (None, Some(MeshSource::Mesh(path))) => {
            return Err(Error::input(format!(
                "--geo changes a script's constants; {} takes its mesh from {}",
                case.path().display(),
                path.display()
            )));
        }
        (None, Some(MeshSource::Script { script, parameters })) => {
            let all = parameters.iter().chain(geo).map(|(name, value)| (name.clone(), *value)).collect();
            made(&case.resolve(script), &all, mesh_path(case, geo))?
        }
        (None, None) => {
            return Err(Error::input(format!(
                "{} has no \"geometry\": write {{ \"script\": \"NAME.geo\" }} or {{ \"mesh\": \"NAME.msh\" }} there, or give \
                 --mesh FILE.msh",
                case.path().display()
            )));
        }
    };
    let name = msh::file_name(&path);
    let msh = msh::parse(&content.bytes, &name)?.scaled(case.mesh_unit().length());
    let mesh = Mesh::from_msh(&msh, &name)?;
    Ok(Meshed {
        mesh,
        openings: Openings::default(),
        path,
        sha256: content.sha256,
        told,
        warnings,
        took: start.elapsed(),
    })
}

/// A mesh before it is looked into.
struct Source {
    path: PathBuf,
    content: Content,
    told: String,
    warnings: Vec<String>,
}

fn found(path: PathBuf) -> Result<Source> {
    let content = Content::read(&path).map_err(|e| msh::not_read(&path, &e))?;
    Ok(Source { told: one_line(&format!("mesh {}", path.display())).into_owned(), path, content, warnings: vec![] })
}

fn made(script: &Path, parameters: &BTreeMap<String, f64>, path: PathBuf) -> Result<Source> {
    let meshing = ensure_mesh(script, parameters, &path)?;
    let told = one_line(&meshing.to_string()).into_owned();
    let warnings = match meshing.outcome {
        Outcome::Unchanged => vec![],
        Outcome::Unchecked { reason } => vec![format!("{} may be stale: {reason}", path.display())],
        Outcome::Made { warnings, .. } => warnings,
    };
    Ok(Source { path, content: meshing.content, told, warnings })
}

/// `coralpipe mesh`: makes the mesh, says which.
pub fn command(request: &Request) -> Result<String> {
    let case = Case::read(&request.case, &request.sets)?;
    let meshed = obtain(&case, &request.geo, request.mesh.as_deref())?;
    let warnings: String = meshed.warnings.iter().map(|w| format!("warning: {w}\n")).collect();
    Ok(format!("{warnings}{}\n", meshed.told))
}

/// `meshes/NAME.msh` under the working folder; changed constants stand in the name, so that the case's own mesh stays.
fn mesh_path(case: &Case, geo: &BTreeMap<String, f64>) -> PathBuf {
    let changes: String = geo.iter().map(|(name, value)| format!("_{name}{value}")).collect();
    PathBuf::from("meshes").join(format!("{}{changes}.msh", case.name()))
}
