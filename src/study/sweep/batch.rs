//! Up to [`MOST_TOGETHER`](crate::solve::step::MOST_TOGETHER) runs over one factor, marched together from beginning to
//! end.

use super::group::{Ended, Tell};
use super::job::Job;
use crate::results::folder::Folder;
use crate::results::grid::Grid;
use crate::results::summary::Timing;
use crate::solve::march::{Accepted, March};
use crate::solve::system::State;
use crate::study::prepare::Prepared;
use crate::study::recorder::{Ending, Recorder};
use crate::study::run::{at_start, interrupted, under_gravity};
use crate::study::unsettled;
use crate::{Error, Result};
use std::sync::Arc;
use std::time::Instant;

/// A run that is ready to begin.
struct Ready<'a> {
    job: &'a Job,
    prepared: Prepared,
    folder: Folder,
}

/// A run on its way.
struct Running<'a, 'b> {
    run: &'a Ready<'b>,
    march: March<'a>,
    recorder: Recorder<'a>,
    /// of the batch
    began: Instant,
}

/// Each into its folder, with the matrices of `lead`, the factor of `march` and, where frames are asked for, their
/// `grid`.
///
/// # Errors
/// Results cannot be written. What keeps single runs from their end is told.
pub fn solve(jobs: &[Job], lead: &Prepared, march: &March, grid: Option<&Arc<Grid>>, tell: Tell) -> Result<()> {
    let (mut ended, mut ready, mut starts) = (vec![], vec![], vec![]);
    for job in jobs {
        match begin(job, lead) {
            Ok((run, start)) => {
                ready.push(run);
                starts.push(start);
            }
            Err(why) => ended.push((job, Err(why))),
        }
    }
    let solved = march_all(&ready, starts, march, grid, &mut ended);
    tell(ended);
    solved
}

fn march_all<'a>(
    ready: &[Ready<'a>],
    starts: Vec<Start>,
    march: &March,
    grid: Option<&Arc<Grid>>,
    ended: &mut Ended<'a>,
) -> Result<()> {
    let began = Instant::now();
    let (mut running, mut states) = (Vec::new(), Vec::new());
    for (run, (state, origin)) in ready.iter().zip(starts) {
        let start = Accepted::start(&run.prepared.system, state, &origin);
        let recorder = Recorder::start(&run.prepared, &run.folder, &start, origin, grid.cloned())?;
        running.push(Running { run, march: march.sharing_factor(&run.prepared.system), recorder, began });
        states.push(start);
    }
    let steps = ready.first().map_or(0, |run| run.prepared.model.time.steps);
    for number in 1..=steps {
        if running.is_empty() {
            break;
        }
        if interrupted() {
            let why = || Error::Interrupted("interrupted".into());
            return running.into_iter().try_for_each(|run| run.finish(Ending::Interrupted, Some(why()), ended));
        }
        (running, states) = step(running, states, number, ended)?;
    }
    running.into_iter().zip(&states).try_for_each(|(run, last)| match run.march.may_end_at(last) {
        Ok(()) => run.finish(Ending::Done, None, ended),
        Err(why) => {
            let why = unsettled::at_end(&run.run.prepared, &why);
            run.finish(Ending::NoConvergence, Some(why), ended)
        }
    })
}

/// The state at t = 0, and the one that displacements are counted from.
type Start = (State, State);

fn begin<'a>(job: &'a Job, lead: &Prepared) -> Result<(Ready<'a>, Start)> {
    let mut prepared = lead.with_loads_of(job.model()?)?;
    let rest = under_gravity(&mut prepared)?;
    let start = at_start(&prepared, rest)?;
    let folder = Folder::prepare(&job.folder, &job.name)?;
    Ok((Ready { job, prepared, folder }, start))
}

/// One step of all; those whose joints do not settle are left behind.
fn step<'a, 'b>(
    mut running: Vec<Running<'a, 'b>>,
    states: Vec<Accepted>,
    number: usize,
    ended: &mut Ended<'b>,
) -> Result<(Vec<Running<'a, 'b>>, Vec<Accepted>)> {
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
                let why = unsettled::in_step(&run.run.prepared, &why, old.state().time, number);
                run.finish(Ending::NoConvergence, Some(why), ended)?;
            }
        }
    }
    Ok((going_on, next))
}

impl<'b> Running<'_, 'b> {
    fn finish(self, ending: Ending, why: Option<Error>, ended: &mut Ended<'b>) -> Result<()> {
        let Ready { job, folder, .. } = self.run;
        let mut summary = self.recorder.finish(ending, job.inputs.clone(), &job.case.title, Timing::default())?;
        // Shared with all that marched along.
        summary.timing.total_s = self.began.elapsed().as_secs_f64();
        folder.write_summary(&summary.to_json())?;
        if why.is_none() {
            folder.remove_previous()?;
        }
        ended.push((job, why.map_or(Ok(summary), Err)));
        Ok(())
    }
}
