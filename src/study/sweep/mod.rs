//! `coralpipe sweep`: many runs from one plan. Those on the same mesh that differ in loads and friction only share their
//! matrices and march together; what is done already is not done again.

mod plan;
mod table;
mod together;

use super::inputs::inputs;
use super::mesh::{self, Meshed};
use super::run::{self, Request};
use super::screen::Screen;
use crate::model::case::Case;
use crate::model::hold::refuse_loose;
use crate::model::resolve::Model;
use crate::results::file;
use crate::results::summary::Inputs;
use crate::{Error, Result};
use plan::{Plan, Variant};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What the command line asks for.
#[derive(Debug, Clone)]
pub struct SweepRequest {
    pub plan: PathBuf,
    pub out: Option<PathBuf>,
    pub quiet: bool,
}

/// One run, its inputs known.
pub(super) struct Job {
    variant: Variant,
    title: String,
    inputs: Inputs,
    folder: PathBuf,
}

/// `coralpipe sweep`: runs what is not done yet, each into a folder of its own, and returns the table, which is also
/// written to `sweep.csv`.
///
/// Errors: bad input of any run (before the first one starts), no convergence of some (the others are done), an interrupt.
pub fn command(request: &SweepRequest) -> Result<String> {
    let screen = Screen::new(request.quiet);
    let plan = Plan::read(&request.plan)?;
    let variants = plan.variants()?;
    let name = request.plan.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = request.out.clone().unwrap_or_else(|| Path::new("output").join(name));

    let mut meshes: Vec<(String, Meshed)> = Vec::new();
    let mut groups: Vec<(String, Vec<(Job, Model)>)> = Vec::new();
    let mut done = 0;
    for variant in &variants {
        let (job, model, key) = prepare(&plan, variant, &folder, &mut meshes, &screen)
            .map_err(|e| Error::input(format!("{}: {e}", variant.name)))?;
        if is_done(&job) {
            done += 1;
            continue;
        }
        match groups.iter_mut().find(|(k, _)| *k == key) {
            Some((_, group)) => group.push((job, model)),
            None => groups.push((key, vec![(job, model)])),
        }
    }
    screen.say(&format!(
        "{} runs, {done} done before; {} to do over {} factors",
        variants.len(),
        variants.len() - done,
        groups.len()
    ));
    run::begin_to_write();
    let mut failures = Vec::new();
    for (_, group) in groups {
        if run::interrupted() {
            break;
        }
        let solved = together::solve(group, plan.frames).map_err(|why| kept(&why, &variants, &folder))?;
        for (job, error) in solved {
            screen.say(&format!("{}: {}", job.variant.name, error.as_ref().map_or("done".into(), Error::to_string)));
            failures.extend(error.map(|e| (job.variant.name, e)));
        }
    }
    let rows = table::rows(&variants, &folder);
    file::replace(&folder.join("sweep.csv"), table::csv(&rows).as_bytes())?;
    let table = table::text(&rows) + &format!("results in {}\n", folder.display());
    match failures.len() {
        _ if run::interrupted() => Err(Error::Interrupted(format!("interrupted; {table}run it again to go on"))),
        0 => Ok(table),
        n => Err(Error::NoConvergence(format!(
            "{n} of {} runs did not get to their end, the first of them {}: {}; the others are in {}",
            variants.len(),
            failures[0].0,
            failures[0].1,
            folder.display()
        ))),
    }
}

/// A sweep that cannot go on, and what of it is there.
fn kept(why: &Error, variants: &[Variant], folder: &Path) -> Error {
    let done = table::rows(variants, folder).iter().filter(|row| row.iter().any(|(_, cell)| cell == "done")).count();
    Error::input(format!(
        "{why}; {done} of {} runs are done and stay in {}: the same command goes on with the others",
        variants.len(),
        folder.display()
    ))
}

/// A run and its model, and what it must share with others to march with them.
fn prepare(
    plan: &Plan,
    variant: &Variant,
    folder: &Path,
    meshes: &mut Vec<(String, Meshed)>,
    screen: &Screen,
) -> Result<(Job, Model, String)> {
    let request = Request {
        case: plan.case.clone(),
        geo: variant.geo.clone(),
        sets: variant.sets.clone(),
        mesh: None,
        out: Some(folder.join(&variant.name)),
        bonded: plan.bonded,
        quiet: true,
    };
    let case = Case::read(&request.case, &request.sets)?;
    let geometry = format!("{:?} {:?}", case.geometry, variant.geo);
    if meshes.iter().all(|(of, _)| *of != geometry) {
        let meshed = mesh::obtain(&case, &variant.geo, None)?;
        screen.say(&meshed.told);
        meshes.push((geometry.clone(), meshed));
    }
    let meshed = &meshes.iter().find(|(of, _)| *of == geometry).expect("put there above").1;
    let model = run::model(&case, meshed, plan.bonded)?;
    refuse_loose(&model)?;
    let inputs = inputs(&case, &meshed.path, &request)?;
    let key = format!("{geometry} {}", without_loads(case.json()));
    let job = Job { variant: variant.clone(), title: case.title.clone(), inputs, folder: folder.join(&variant.name) };
    Ok((job, model, key))
}

/// The case without what changes no matrix: loads, friction, probes, titles, frames.
fn without_loads(case: &Value) -> Value {
    let mut rest = case.clone();
    for key in ["loads", "probes", "title", "output"] {
        rest.as_object_mut().map(|case| case.remove(key));
    }
    let interfaces = rest.get_mut("interfaces").and_then(Value::as_object_mut);
    for interface in interfaces.into_iter().flat_map(|all| all.values_mut()) {
        interface.as_object_mut().map(|keys| keys.remove("friction"));
    }
    rest
}

/// Whether the folder holds the end of just this run.
fn is_done(job: &Job) -> bool {
    let Some(summary) = table::summary(&job.folder) else { return false };
    let inputs = &summary["inputs"];
    summary["status"] == "done"
        && inputs["case_sha256"] == job.inputs.case_sha256.as_str()
        && inputs["mesh_sha256"] == job.inputs.mesh_sha256.as_str()
        && inputs["bonded"] == job.inputs.bonded
        && inputs["coralpipe"] == job.inputs.coralpipe
}
