//! Where the mesh of a case comes from: a file, or the case's script through gmsh.

use super::meshing::{Outcome, ensure_mesh};
use super::run::Request;
use crate::model::case::{Case, Geometry};
use crate::model::mesh::Mesh;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A mesh and its story.
#[derive(Debug, Clone)]
pub struct Meshed {
    pub mesh: Mesh,
    pub path: PathBuf,
    /// one sentence: which mesh, made or found
    pub told: String,
    pub warnings: Vec<String>,
    pub took: Duration,
}

/// `--mesh` first, else the case's geometry with `--geo NAME=VALUE` on top of its parameters.
pub fn obtain(case: &Case, geo: &BTreeMap<String, f64>, file: Option<&Path>) -> Result<Meshed> {
    let start = Instant::now();
    let (path, told, warnings) = match (file, &case.geometry) {
        (Some(path), _) if geo.is_empty() => (path.to_path_buf(), None, vec![]),
        (Some(_), _) => return Err(Error::input("--geo changes a script's constants; it cannot be used with --mesh")),
        (None, Some(Geometry::Mesh(path))) if geo.is_empty() => (case.resolve(path), None, vec![]),
        (None, Some(Geometry::Mesh(path))) => {
            return Err(Error::input(format!(
                "--geo changes a script's constants; {} takes its mesh from {}",
                case.path().display(),
                path.display()
            )));
        }
        (None, Some(Geometry::Script { script, parameters })) => {
            let path = mesh_path(case, geo);
            let mut all = parameters.clone();
            all.extend(geo.clone());
            let meshing = ensure_mesh(&case.resolve(script), &all, &path)?;
            let warnings = match &meshing.outcome {
                Outcome::Unchanged => vec![],
                Outcome::Made { warnings, .. } => warnings.clone(),
            };
            (path, Some(meshing.to_string()), warnings)
        }
        (None, None) => {
            return Err(Error::input(format!(
                "{} has no \"geometry\": write {{ \"script\": \"NAME.geo\" }} or {{ \"mesh\": \"NAME.msh\" }} there, or give \
                 --mesh FILE.msh",
                case.path().display()
            )));
        }
    };
    let mesh = Mesh::read(&path)?;
    let told = told.unwrap_or_else(|| format!("mesh {}", path.display()));
    Ok(Meshed { mesh, path, told, warnings, took: start.elapsed() })
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
