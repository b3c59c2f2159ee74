//! From the file's text to a `Case`, or to one sentence: file, place in it, what is wrong, what exists.

use std::path::Path;

use serde_json::Value;

use super::duplicate::Unique;
use super::strict::Strict;
use super::{Analysis, Case, sentence, set, table};
use crate::input::{self, Kind};
use crate::{Error, Result};

impl Case {
    /// Reads a case file, with each of `sets` (`PATH=VALUE`) put in first.
    ///
    /// Any error is `Error::Input` with the file, the path inside it and what is wrong there.
    pub fn read(path: &Path, sets: &[String]) -> Result<Case> {
        let file = path.display();
        refuse_other_kinds(path)?;
        let text = input::read_text(path, Kind::Case).map_err(|why| unreadable(path, &why))?;
        let json = parse(&text).map_err(|why| Error::input(format!("{file}, {why}")))?;
        if let Some(sentence) = set::twice(sets) {
            return Err(Error::Input(sentence));
        }
        let written = json.clone();
        let json = sets.iter().try_fold(json, |json, setting| set::set(json, setting)).map_err(Error::Input)?;
        let origin = match sets {
            [] => file.to_string(),
            _ => format!("{file} with --set {}", sets.join(" --set ")),
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let case = from_json(json, folder).map_err(|why| {
            let new = sets.iter().filter_map(|setting| set::new_name(&written, setting)).collect::<String>();
            Error::input(format!("{origin}: {why}{new}"))
        })?;
        Ok(Case { path: path.into(), ..case })
    }
}

/// A mesh or a script in place of the case that names it.
fn refuse_other_kinds(path: &Path) -> Result<()> {
    let file = path.display();
    match path.extension().and_then(|e| e.to_str()) {
        Some("msh") => Err(Error::input(format!(
            "{file} is a mesh, and a case is needed, a .json that gives its groups materials, supports and loads: give the \
             mesh by CASE.json --mesh {file}; check {file} looks at the mesh alone"
        ))),
        Some("geo") => Err(Error::input(format!(
            "{file} is a geometry, and a case is needed, a .json that names it as {{ \"geometry\": {{ \"script\": \"{}\" }} }} and \
             gives its groups materials, supports and loads; geo/twin_pipes.json is one",
            path.file_name().unwrap_or_default().to_string_lossy()
        ))),
        Some(
            "inp" | "vtk" | "vtu" | "stl" | "unv" | "med" | "mesh" | "bdf" | "nas" | "cgns" | "ply" | "su2" | "off",
        ) => Err(Error::input(format!(
            "{file} is a mesh in another format, and a case is needed, a .json that gives its groups materials, supports and \
                 loads: convert the mesh, gmsh {file} -save -format msh41 -o NAME.msh, and name it in the case"
        ))),
        _ => Ok(()),
    }
}

fn from_json(json: Value, folder: &Path) -> std::result::Result<Case, String> {
    let json = with_tables(json, folder)?;
    let case: Case = serde_path_to_error::deserialize(Strict(&json)).map_err(|why| {
        let what = sentence::from_serde(&why.inner().to_string());
        match why.path().to_string().as_str() {
            "." => what,
            place => format!("{place}: {what}"),
        }
    })?;
    validate(&case, &json)?;
    Ok(Case { json: without_schema(json), ..case })
}

/// The place of the schema is no part of what is calculated.
fn without_schema(mut json: Value) -> Value {
    json.as_object_mut().map(|keys| keys.shift_remove("$schema"));
    json
}

fn with_tables(mut json: Value, folder: &Path) -> std::result::Result<Value, String> {
    if let Some(loads) = json.get_mut("loads") {
        *loads = table::inlined(loads.take(), folder)?;
    }
    Ok(json)
}

/// Relative: 0.3025 typed for (0.6 + 0.5)^2 / 4 must count as equal.
const ROUND_OFF: f64 = 1e-12;

/// What one value cannot know of another.
fn validate(case: &Case, json: &Value) -> std::result::Result<(), String> {
    let time = &case.time;
    if time.end < time.step {
        return Err(format!("time.end: it is {}, and must be at least one step ({})", time.end, time.step));
    }
    let (alpha, delta) = (time.newmark.alpha, time.newmark.delta);
    let least = (delta + 0.5).powi(2) / 4.0;
    if !(delta >= 0.5 && alpha >= least * (1.0 - ROUND_OFF)) {
        return Err(format!(
            "time.newmark: alpha = {alpha} with delta = {delta} is not unconditionally stable; \
             delta must be at least 0.5 and alpha at least (delta + 0.5)^2 / 4 = {least:.6}"
        ));
    }
    if time.hht != 0.0 && json["time"].get("newmark").is_some() {
        return Err("time.hht: it sets alpha and delta itself; leave time.newmark out, or hht".into());
    }
    if case.analysis == Analysis::Static && time.energy_tolerance.is_some() {
        return Err(
            "time.energy_tolerance: a static calculation has no time in which joints chatter; leave it out".into()
        );
    }
    if case.analysis == Analysis::Static && !case.initial.is_empty() {
        return Err("initial: a static calculation has no motion to start with; leave \"initial\" out".into());
    }
    if let Some(every) = case.output.every.filter(|every| *every < time.step) {
        return Err(format!("output.every: it is {every}, and must be at least one time step ({})", time.step));
    }
    for (i, probe) in case.probes.iter().enumerate() {
        let name = probe.name();
        if name.is_empty() {
            return Err(format!("probes[{i}]: a probe needs a name: its columns are called by it"));
        }
        if case.probes[..i].iter().any(|earlier| earlier.name() == name) {
            return Err(format!("probes[{i}]: there is a probe {name:?} already; every probe needs a name of its own"));
        }
    }
    Ok(())
}

/// `line 3, column 5: what is wrong`
fn parse(text: &str) -> std::result::Result<Value, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    serde_json::from_str::<Unique>(text).map(|Unique(json)| json).map_err(|why| {
        let message = why.to_string();
        let what = message.split(" at line ").next().unwrap_or_default();
        format!("line {}, column {}: this is not JSON: {what}", why.line(), why.column())
    })
}

fn unreadable(path: &Path, why: &std::io::Error) -> Error {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut cases: Vec<_> =
        entries.map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "json")).collect();
    cases.sort();
    let names: Vec<_> = cases.iter().map(|case| case.display().to_string()).collect();
    let there = match names.as_slice() {
        [] => String::new(),
        _ => format!("; there are: {}", names.join(", ")),
    };
    Error::input(format!("cannot read the case {}: {why}{there}", path.display()))
}
