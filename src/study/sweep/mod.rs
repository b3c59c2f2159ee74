//! `coralpipe sweep`: many runs from one plan. Those on the same mesh that differ in loads and friction only share their
//! matrices and march together; what is done already is not done again.

mod batch;
mod group;
mod job;
mod plan;
mod report;
mod shelf;
mod table;

use super::cost::Cost;
use super::finished::{ended, finished};
use super::run;
use super::screen::Screen;
use crate::results::folder::summary;
use crate::{Error, Result};
use group::Ended;
use job::{Failure, Job, Meshes};
use plan::{Plan, Variant};
use report::Report;
use shelf::Shelf;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use table::Row;

/// What the command line asks for.
#[derive(Debug, Clone)]
pub struct SweepRequest {
    pub plan: PathBuf,
    pub out: Option<PathBuf>,
    /// whatever the size of all runs together
    pub large: bool,
    pub quiet: bool,
}

/// JSON Schema of a plan, for editors.
pub fn schema() -> serde_json::Value {
    crate::model::case::schema_of_file::<Plan>()
}

/// `coralpipe sweep`: runs what is not done yet, each into a folder of its own, and returns the table, which is also
/// written to `sweep.csv`. A run that cannot start or has no end leaves the others alone.
///
/// Errors: a bad plan, a foreign folder, no run that could start (nothing is written then); some runs without an end
/// (the others are done), an interrupt, a full disk.
pub fn command(request: &SweepRequest) -> Result<String> {
    let screen = Screen::new(request.quiet);
    let plan = Plan::read(&request.plan)?;
    let variants = plan.variants()?;
    let name = request.plan.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = request.out.clone().unwrap_or_else(|| Path::new("output").join(name));
    Shelf::refuse_foreign(&folder)?;

    let (jobs, refused) = jobs(&plan, &variants, &folder, &screen)?;
    let count = jobs.len();
    let mut rows: Vec<Row> = variants.iter().map(Row::new).collect();
    let to_do = not_done(jobs, &mut rows, plan.frames);
    if to_do.len() == count {
        refuse_hopeless(&to_do, &variants)?;
    }
    let costs = to_do.iter().map(|job| Cost::of_run(&job.case, &job.meshed.mesh, plan.frames));
    let warning = Cost::together(costs).map(|cost| cost.allowed(&folder, request.large)).transpose()?.flatten();
    warning.iter().for_each(|warning| screen.warn(warning));
    let shelf = Shelf::open(&folder, &request.plan)?;
    shelf.before.iter().for_each(|sentence| screen.say(sentence));
    let replaced = to_do.iter().filter(|job| replaces(job)).count();
    let (to_do, groups) = (to_do.len(), group::groups(to_do));
    screen.say(&format!(
        "{} runs, {} done before; {to_do} to do over {} factors",
        variants.len(),
        count - to_do,
        groups.len()
    ));
    if replaced > 0 {
        screen.say(&format!(
            "{replaced} of them replace results of another case, mesh or program in {}: --out DIR keeps both",
            folder.display()
        ));
    }

    run::begin_to_write();
    let mut report = Report::start(&screen, &shelf, rows, to_do)?;
    refused.into_iter().for_each(|failure| report.fail(failure));
    let report = Mutex::new(report);
    let tell = |batch: Ended| report.lock().expect("no thread panics with it").take(batch);
    let solved = groups.into_iter().try_for_each(|group| group::solve(&group, plan.frames, &tell));
    report.into_inner().expect("no thread panicked with it").close(solved)
}

/// The runs whose case can be read and whose mesh can be made, and what keeps the others from that, by row.
///
/// Errors: there is none, or two are the same.
fn jobs(plan: &Plan, variants: &[Variant], folder: &Path, screen: &Screen) -> Result<(Vec<Job>, Vec<Failure>)> {
    let mut meshes = Meshes::default();
    let (mut jobs, mut refused) = (Vec::new(), Vec::new());
    for (number, variant) in variants.iter().enumerate() {
        match Job::new(number, variant, plan, folder, &mut meshes, screen) {
            Ok(job) => jobs.push(job),
            Err(why) => refused.push(Failure { number, why }),
        }
    }
    let told: Vec<Error> = refused.iter().map(|failure| of_run(variants, failure)).collect();
    match told.first() {
        Some(why) if jobs.is_empty() => return Err(why.clone()),
        _ => told.iter().for_each(|why| screen.say(&why.to_string())),
    }
    job::refuse_equal(&jobs)?;
    Ok((jobs, refused))
}

/// Error: none has a model; the first says why. Nothing is written then.
fn refuse_hopeless(jobs: &[Job], variants: &[Variant]) -> Result<()> {
    let why_not = |job: &Job| job.model().err().map(|why| of_run(variants, &Failure { number: job.number, why }));
    let whys: Vec<Error> = jobs.iter().map_while(why_not).collect();
    if whys.len() < jobs.len() { Ok(()) } else { whys.into_iter().next().map_or(Ok(()), Err) }
}

/// With the name of the run, if there are several.
fn of_run(variants: &[Variant], Failure { number, why }: &Failure) -> Error {
    match variants {
        [_] => why.clone(),
        _ => Error::input(format!("{}: {why}", variants[*number].name)),
    }
}

/// Puts into each row what is known of its run, and returns the jobs to do.
fn not_done(jobs: Vec<Job>, rows: &mut [Row], frames: bool) -> Vec<Job> {
    let is_to_do = |job: &Job| match finished(&job.folder, &job.inputs, frames) {
        Some(summary) => {
            rows[job.number].take(&summary);
            false
        }
        None => true,
    };
    let mut jobs = jobs;
    jobs.retain(is_to_do);
    jobs
}

/// Whether there is a result of another run in its folder.
fn replaces(job: &Job) -> bool {
    summary(&job.folder).is_some() && ended(&job.folder, &job.inputs).is_none()
}
