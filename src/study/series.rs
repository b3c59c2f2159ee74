//! Runs of one case beside each other, each with other constants or keys: finished ones are not computed again.

use super::finished::finished;
use super::gmsh::VARIABLE;
use super::inputs::made_from;
use super::mesh;
use super::run::{self, Request};
use super::screen::tell;
use crate::escape::one_line;
use crate::model::case::{Case, MeshSource};
use crate::results::file;
use crate::results::folder::summary;
use crate::study::script::Script;
use crate::{Error, Result};
use serde_json::Value;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The runs of a study, each in a folder of its own under `folder`.
pub struct Series<'a> {
    pub request: &'a Request,
    pub folder: PathBuf,
    /// whether a run has written into the folder
    begun: Cell<bool>,
}

/// What one run has that the others have not.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Variant {
    /// of its folder
    pub name: String,
    pub geo: BTreeMap<String, f64>,
    /// PATH=VALUE
    pub sets: Vec<String>,
}

/// A finished run.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    pub folder: PathBuf,
    pub summary: Value,
}

impl Member {
    /// A number of the summary: `counts.unknowns`.
    pub fn number(&self, path: &str) -> f64 {
        path.split('.').fold(&self.summary, |value, key| &value[key]).as_f64().unwrap_or(f64::NAN)
    }

    pub fn unknowns(&self) -> u64 {
        self.summary["counts"]["unknowns"].as_u64().unwrap_or(0)
    }
}

impl<'a> Series<'a> {
    pub fn new(request: &'a Request, folder: PathBuf) -> Series<'a> {
        Series { request, folder, begun: Cell::new(false) }
    }

    /// Writes a file of the study itself; its path.
    pub fn write(&self, name: &str, content: &str) -> Result<String> {
        let path = self.folder.join(name);
        file::remove_parts_of(&path);
        file::replace(&path, content.as_bytes()).map(|()| one_line(&path.display().to_string()).into_owned())
    }

    /// Computes a variant, or takes what was computed: same case, mesh and program.
    ///
    /// Errors: those of a run; an interrupt also where it struck gmsh.
    pub fn run(&self, variant: &Variant) -> Result<Member> {
        let mut request = Request { quiet: true, out: Some(self.folder.join(&variant.name)), ..self.request.clone() };
        request.geo.extend(variant.geo.clone());
        request.sets.extend(variant.sets.iter().cloned());
        self.finish(&request).map_err(|error| match run::interrupted() {
            true => Error::Interrupted(format!("interrupted in the run {}; those before it are kept", variant.name)),
            false => within(&variant.name, error),
        })
    }

    fn finish(&self, request: &Request) -> Result<Member> {
        let case = Case::read(&request.case, &request.sets)?;
        let folder = request.folder(&case);
        let meshed = mesh::obtain(&case, &request.geo, request.mesh.as_deref())?;
        let inputs = made_from(&case, &meshed, request);
        let say = |sentence: &str| {
            if !self.request.quiet {
                tell(sentence)
            }
        };
        if let Some(summary) = finished(&folder, &inputs, true) {
            say(&format!("{}: taken as it is", folder.display()));
            return Ok(Member { folder, summary });
        }
        if self.begun.replace(true) && !self.folder.is_dir() {
            let lost = self.folder.display();
            return Err(Error::input(format!(
                "{lost} was removed while its runs were computed: give the command again"
            )));
        }
        say(&format!("{}: {} nodes", folder.display(), meshed.mesh.points.len()));
        run::command(request)?;
        let summary = summary(&folder).ok_or_else(|| Error::input(format!("{} has no summary", folder.display())))?;
        Ok(Member { folder, summary })
    }
}

fn within(name: &str, error: Error) -> Error {
    match error {
        Error::Input(s) => Error::Input(format!("in the run {name}: {s}")),
        Error::NoConvergence(s) => Error::NoConvergence(format!("in the run {name}: {s}")),
        Error::Interrupted(s) => Error::Interrupted(s),
    }
}

/// The script of a case that must have one, and the value of each of its constants in force.
///
/// Errors: the case's mesh is a file, or `--mesh` gives one: there is nothing to make another mesh from.
pub fn script(case: &Case, request: &Request, why: &str) -> Result<(Script, BTreeMap<String, f64>)> {
    let source = case.geometry.as_ref().and_then(|geometry| geometry.source.as_ref());
    let Some(MeshSource::Script { script, parameters }) = source.filter(|_| request.mesh.is_none()) else {
        return Err(Error::input(format!(
            "{why} needs a script to make other meshes from: write \"geometry\": {{ \"script\": \"NAME.geo\" }} in {}, \
             without --mesh; gmsh is found on PATH, in .venv, or by {VARIABLE}",
            case.path().display()
        )));
    };
    let script = Script::read(&case.resolve(script))?;
    let given = parameters.iter().chain(&request.geo).map(|(name, value)| (name.clone(), *value)).collect();
    let values = script.values(&given)?;
    let numbers = values.into_iter().filter_map(|(name, value)| Some((name, value.number()?))).collect();
    Ok((script, numbers))
}

/// The value of the constant that a study changes.
///
/// Errors: the script has no such constant, or its value is a formula.
pub fn constant(script: &Script, values: &BTreeMap<String, f64>, name: &str, option: &str) -> Result<f64> {
    values.get(name).copied().ok_or_else(|| {
        let known: Vec<&str> = values.keys().map(String::as_str).collect();
        Error::input(format!(
            "{} has no constant \"{name}\" with a number for a value, which {option} is to change; it has: {}; name \
             another by {option} NAME",
            script.path.display(),
            known.join(", ")
        ))
    })
}

/// A share as the user writes it: `1.74 %`, `0.0174`.
///
/// Errors: no number, or not between 0 and 1.
pub fn share(text: &str, option: &str) -> Result<f64> {
    let (number, scale) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.),
    };
    let value = number.trim().parse::<f64>().ok().map(|x| scale * x).filter(|x| 0. < *x && *x < 1.);
    value.ok_or_else(|| {
        Error::input(format!("{option} {text}: write a share greater than 0 and less than 1, as in 0.0174 or 1.74%"))
    })
}
