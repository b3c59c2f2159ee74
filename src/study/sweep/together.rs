//! Runs that share their matrices, marched together over one factor by as many threads as there are processors.

use super::Job;
use crate::model::resolve::Model;
use crate::results::folder::Folder;
use crate::results::summary::{Summary, Timing};
use crate::solve::march::March;
use crate::solve::step::MOST_TOGETHER;
use crate::solve::system::State;
use crate::study::prepare::Prepared;
use crate::study::recorder::{Ending, Recorder};
use crate::study::run::{at_start, interrupted, new_march, under_gravity};
use crate::study::unsettled;
use crate::{Error, Result};
use std::num::NonZero;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

/// A run that is ready to begin.
struct Ready {
    job: Job,
    prepared: Prepared,
    /// equilibrium under gravity
    rest: State,
}

/// Solves all, each into its folder; a run without an end is told by its error.
///
/// # Errors
/// A results folder cannot be written.
pub fn solve(group: Vec<(Job, Model)>, frames: bool) -> Result<Vec<(Job, Option<Error>)>> {
    let started = Instant::now();
    let mut ready: Vec<Ready> = Vec::new();
    let mut ended = Vec::new();
    for (job, model) in group {
        let prepared = match ready.first() {
            None => Prepared::beside(Path::new(&job.inputs.mesh), model),
            Some(first) => first.prepared.with_loads_of(model),
        };
        match prepared.and_then(|mut prepared| Ok((under_gravity(&mut prepared)?, prepared))) {
            Ok((rest, prepared)) => ready.push(Ready { job, prepared, rest }),
            Err(error) => ended.push((job, Some(error))),
        }
    }
    let Some(first) = ready.first() else { return Ok(ended) };
    let lead = new_march(&first.prepared)?;

    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let together = ready.len().div_ceil(threads).min(MOST_TOGETHER);
    let queue = Mutex::new(ready.chunks(together));
    let errors = Mutex::new(Vec::new());
    let work = || {
        loop {
            let Some(runs) = queue.lock().expect("no thread panics with it").next() else { return Ok(()) };
            let solved = march_together(runs, &lead, frames, started)?;
            errors.lock().expect("likewise").extend(solved);
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|w| w.join().expect("a worker returns its errors"))
    })?;
    let mut errors: Vec<(String, Error)> = errors.into_inner().expect("no thread panicked with it");
    drop(lead);
    ended.extend(ready.into_iter().map(|Ready { job, .. }| {
        let error = errors.iter().position(|(name, _)| *name == job.variant.name).map(|i| errors.swap_remove(i).1);
        (job, error)
    }));
    Ok(ended)
}

/// A run on its way.
struct Running<'a> {
    run: &'a Ready,
    march: March<'a>,
    recorder: Recorder<'a>,
    folder: &'a Folder,
}

/// Up to [`MOST_TOGETHER`] runs from beginning to end: (name, error) of those that do not get there.
fn march_together(runs: &[Ready], lead: &March, frames: bool, started: Instant) -> Result<Vec<(String, Error)>> {
    let (mut begun, mut errors) = (Vec::new(), Vec::new());
    for run in runs {
        match at_start(&run.prepared, run.rest.clone()) {
            Err(error) => errors.push((run.job.variant.name.clone(), error)),
            Ok((state, origin)) => begun.push((run, state, origin)),
        }
    }
    let folder = |run: &Ready| Folder::prepare(&run.job.folder, &run.job.variant.name);
    let folders: Vec<Folder> = begun.iter().map(|(run, ..)| folder(run)).collect::<Result<_>>()?;
    let (mut running, mut states) = (Vec::new(), Vec::new());
    for ((run, state, origin), folder) in begun.into_iter().zip(&folders) {
        let march = lead.sharing_factor(&run.prepared.system);
        let recorder = Recorder::start(&run.prepared, folder, &state, origin, frames)?;
        running.push(Running { run, march, recorder, folder });
        states.push(state);
    }
    let steps = runs.first().map_or(0, |r| r.prepared.model.time.steps);
    for number in 1..=steps {
        if running.is_empty() {
            return Ok(errors);
        }
        if interrupted() {
            for (run, state) in running.into_iter().zip(states) {
                let sentence = format!("interrupted at t = {} s, after step {} of {steps}", state.time, number - 1);
                errors.push((run.run.job.variant.name.clone(), Error::Interrupted(sentence)));
                run.finish(Ending::Interrupted, started)?;
            }
            return Ok(errors);
        }
        let mut marches: Vec<&mut March> = running.iter_mut().map(|r| &mut r.march).collect();
        let advanced = March::advance_together(&mut marches, &states.iter().collect::<Vec<_>>());
        let (mut going_on, mut next) = (Vec::new(), Vec::new());
        for ((mut run, steps), old) in running.into_iter().zip(advanced).zip(states) {
            match steps {
                Ok(steps) => {
                    next.push(run.recorder.record(number, old, steps)?);
                    going_on.push(run);
                }
                Err(why) => {
                    let error = unsettled::in_step(&run.run.prepared, &why, old.time, number);
                    errors.push((run.run.job.variant.name.clone(), error));
                    run.finish(Ending::NoConvergence, started)?;
                }
            }
        }
        (running, states) = (going_on, next);
    }
    for run in running {
        let folder = run.folder;
        run.finish(Ending::Done, started)?;
        folder.remove_previous()?;
    }
    Ok(errors)
}

impl Running<'_> {
    fn finish(self, ending: Ending, started: Instant) -> Result<Summary> {
        let Job { inputs, title, .. } = &self.run.job;
        let mut summary = self.recorder.finish(ending, inputs.clone(), title, Timing::default())?;
        // Shared with all that marched along.
        summary.timing.total_s = started.elapsed().as_secs_f64();
        self.folder.write_summary(&summary.to_json())?;
        Ok(summary)
    }
}
